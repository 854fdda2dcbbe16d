"""Numbers with units that a file or its name states, and queries for them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import key_pattern
from tribolab.reading.numbers import decimal
from tribolab.reading.unit_texts import converts
from tribolab.units.conversion import conversion
from tribolab.units.spellings import WEIGHTS


class Amount(NamedTuple):
    """Number stated by a file in a line of text, an attribute or the file name.

    Attributes
    ----------
    name
        Name of the value in a dialect.
    pattern
        Regular expression whose group 1 is the number in `text`.
    unit, to
        Its unit, and the SI unit of its dimension, if known.
    text
        The line, attribute or file name that states the number.
    source
        ``preamble``, ``step`` or ``file name``.
    own_unit
        The unit as written in the file, also where `unit` is None, as for weights.
    scale
        Factor on the number, e.g. 0.5 for a diameter if a radius is needed.
    key
        Normalised name in the file.
    guess
        Guess about the amount that the user has to confirm; "" if there is none.
    """

    name: str
    pattern: str
    unit: str | None
    to: str | None
    text: str
    source: str = "preamble"
    own_unit: str | None = None
    scale: float = 1.0
    key: str = ""
    guess: str = ""

    @property
    def number(self) -> float:
        """The number as written in the file; NaN if it cannot be read."""
        match = re.search(self.pattern, self.text)
        return decimal(match[1]) if match else float("nan")

    @property
    def value(self) -> float:
        """The number times `scale`, in `unit`; NaN if it cannot be read."""
        return self.scale * self.number

    def means(self, *concepts: str) -> bool:
        """Whether the amount's name in the file means any of the given concepts."""
        return any(key_pattern(concept).search(self.key) for concept in concepts)

    def is_in(self, si_unit: str) -> bool:
        """Whether the amount can be converted to the given SI unit; weights convert to newtons."""
        return converts(self._unit(si_unit), si_unit)

    def si(self, si_unit: str) -> float:
        """Return the amount in the given SI unit; NaN if its dimension differs."""
        if not self.is_in(si_unit):
            return float("nan")
        return self.scale * self.number * conversion(self._unit(si_unit), si_unit)[0]

    def _unit(self, si_unit: str) -> str:
        unit = self.unit or self.own_unit or ""
        return WEIGHTS.get(unit, unit) if si_unit == "N" else unit


class Amounts(tuple[Amount, ...]):
    """Amounts stated by a file, with queries by concept and unit."""

    __slots__ = ()

    def of(
        self, *concepts: str, unit: str | None = None, but: Sequence[str] = (), source: str = ""
    ) -> Amounts:
        """Return the amounts that mean any of the given concepts.

        Parameters
        ----------
        concepts
            Names in settings.toml; without concepts all amounts are returned.
        unit
            SI unit to which the amounts must convert; "" for amounts without unit.
        but
            Concepts to exclude.
        source
            Required source; "" for any.
        """
        return Amounts(
            one
            for one in self
            if (not concepts or one.means(*concepts))
            and (unit is None or (one.is_in(unit) if unit else one.own_unit is None))
            and not one.means(*but)
            and (not source or one.source == source)
        )

    def only(
        self, *concepts: str, unit: str | None = None, but: Sequence[str] = (), source: str = ""
    ) -> Amount | None:
        """Return the only amount that `of` finds; None if it finds none or several."""
        found = self.of(*concepts, unit=unit, but=but, source=source)
        return found[0] if len(found) == 1 else None


_SUFFIX = re.compile(r"\.[A-Za-z]\w{0,4}$")
_FORCE = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>N|mN)(?=_|$)")
# "T11_0.1m-s_10N.csv", "PAO_20N_100mms": m/s without its slash; but "100ms" is a time
_SPEED = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>[mu]?m-s|[mu]ms)(?=_|$)")


def amounts_of_name(name: str) -> list[Amount]:
    r"""Return the load in a file name, as a list; empty if there is none.

    Examples
    --------
    >>> [(a.name, a.number) for a in amounts_of_name("PTFE_3N_b.csv")]
    [('set_normal_force', 3.0)]
    """
    force = _force(_SUFFIX.sub("", name), name)
    return [] if force is None else [force]


def speed_of_name(name: str) -> Amount | None:
    """Return the speed in a file name, which may be another than the sliding speed.

    >>> speed_of_name("T11_0.1m-s_10N.csv").si("m/s"), speed_of_name("a_100ms.csv")
    (0.1, None)
    """
    match = _SPEED.search(_SUFFIX.sub("", name))
    if match is None:
        return None
    unit = match["unit"].removesuffix("s").removesuffix("-") + "/s"
    pattern = rf"(?:^|_)(\d+(?:\.\d+)?){match['unit']}(?:_|\.|$)"
    return Amount("set_speed", pattern, unit, "m/s", name, "file name", unit)


def _force(stem: str, name: str) -> Amount | None:
    match = _FORCE.search(stem)
    pattern = rf"_(\d+(?:\.\d+)?){match['unit']}(?:_|\.)" if match else ""
    if match is None or not re.search(pattern, name):
        return None
    unit = match["unit"]
    return Amount("set_normal_force", pattern, unit, None, name, "file name", unit)
