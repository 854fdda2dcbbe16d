"""Amount of running-in to discard at the beginning of a run."""

from __future__ import annotations

from tribolab.core.errors import UnitError, shown
from tribolab.units.conversion import to_si

_CYCLES = ("cycle", "cycles")


def discard_amount(text: str) -> tuple[float, str]:
    """Return the amount to discard at the beginning of a run, and its unit "m", "s" or "cycles".

    Raises
    ------
    UnitError
        If it is not a distance, time or number of cycles.

    Examples
    --------
    >>> discard_amount("50 m"), discard_amount("2 min"), discard_amount("100 cycles")
    ((50.0, 'm'), (120.0, 's'), (100.0, 'cycles'))
    """
    number, _, unit = text.strip().partition(" ")
    if unit.strip() in _CYCLES:
        return to_si(number, "1", name="discard"), "cycles"
    for wanted in ("m", "s"):
        try:
            return to_si(text, wanted, name="discard"), wanted
        except UnitError:
            continue
    raise UnitError(f"discard: {shown(repr(text))} is no distance, time or number of cycles")
