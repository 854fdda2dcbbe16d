"""Numbers as a reader wants them: a value with its error, durations, ranges."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tribolab.plot.labels import MINUS, number, speed_text
from tribolab.validity import together

UNITS = {"friction_coefficient": "", "half_loop": " N", "friction_force": " N"}
# whose standard deviation and error are those of the quantity
SPREAD_OF = {"half_loop": "friction_force"}
SYMBOLS = {"friction_coefficient": "µ", "half_loop": "half loop", "friction_force": "F"}


def with_error(value: float | None, error: float | None, unit: str = "") -> str:
    """Return value and error with the digits that the error leaves meaningful.

    Examples
    --------
    >>> with_error(0.81234, 0.0042)
    '0.812 ± 0.004'
    >>> with_error(5.6312, None, " N")
    '5.63 N'
    """
    if value is None or not math.isfinite(value):
        return "–"
    if error is None or not math.isfinite(error) or error <= 0:
        return number(value) + unit
    # two digits of an error that begins with 1, else one
    place = math.floor(math.log10(error))
    decimals = min(max((error / 10**place < 1.95) - place, 0), 6)
    text = f"{value:.{decimals}f} ± {error:.{decimals}f}".replace("-", MINUS)
    return f"({text}){unit}" if unit else text


def validity_of(groups: Iterable[Any]) -> str:
    """Return why results are not sure, beyond the limits of the theory; "" where they are.

    Parameters
    ----------
    groups
        Datasets with the attribute ``validity_reasons``, see `tribolab.validity`.
    """
    return together([data.attrs for data in groups])["validity_reasons"]


def span(values: Iterable[float | None], unit: str = "") -> str:
    """Return smallest to largest, once if they look the same.

    Examples
    --------
    >>> span([0.2, 1.3, None])
    '0.2 to 1.3'
    """
    known = [v for v in values if v is not None and math.isfinite(v)]
    if not known:
        return "–"
    low, high = number(min(known)), number(max(known))
    return f"{low}{unit}" if low == high else f"{low} to {high}{unit}"


def speeds(values: Iterable[float | None]) -> str:
    """Return the range of sliding speeds.

    Examples
    --------
    >>> speeds([1e-2, 1e-6])
    '1 µm/s to 10 mm/s'
    """
    known = [v for v in values if v is not None and math.isfinite(v)]
    if not known:
        return "speed unknown"
    low, high = speed_text(min(known)), speed_text(max(known))
    return low if low == high else f"{low} to {high}"


def duration(seconds: float | None) -> str:
    """Return a duration in the unit that suits it.

    Examples
    --------
    >>> duration(12.34), duration(4000), duration(90000)
    ('12.3 s', '66.7 min', '25 h')
    """
    if seconds is None or not math.isfinite(seconds):
        return "–"
    for limit, factor, unit in ((120, 1, "s"), (7200, 60, "min"), (math.inf, 3600, "h")):
        if abs(seconds) < limit:
            return f"{number(seconds / factor)} {unit}"
    raise AssertionError("unreachable: every finite number is below infinity")


def percent(share: float | None) -> str:
    """Return a share as text, e.g. ``"2.1 %"``."""
    if share is None or not math.isfinite(share):
        return "–"
    return f"{number(100 * share, 2)} %"


def many(count: int, word: str) -> str:
    """Return a count with its noun.

    Examples
    --------
    >>> many(1, "run"), many(3, "run")
    ('1 run', '3 runs')
    """
    return f"{count} {word}" if count == 1 else f"{count} {word}s"


def size(count: int) -> str:
    """Return a number of bytes, e.g. ``"1.2 MB"``."""
    for limit, factor, unit in ((1e3, 1, "B"), (1e6, 1e3, "kB"), (math.inf, 1e6, "MB")):
        if count < limit:
            return f"{number(count / factor)} {unit}"
    raise AssertionError("unreachable: every count is below infinity")


def plain_value(value: Any) -> Any:
    """Return a value as JSON can hold it: NaN and infinity become null, numpy becomes Python.

    Examples
    --------
    >>> plain_value({"a": float("nan"), "b": (1, 2.5)})
    {'a': None, 'b': [1, 2.5]}
    """
    if isinstance(value, dict):
        return {str(key): plain_value(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain_value(item) for item in value]
    if hasattr(value, "tolist"):
        return plain_value(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, str | int | bool) or value is None:
        return value
    return str(value)
