"""Formats of numbers: values with errors, durations, ranges."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tribolab.core.validity import together
from tribolab.core.wording import MINUS, number

UNITS = {"friction_coefficient": "", "half_loop": " N", "friction_force": " N"}
# quantities whose standard deviation and error have their unit
SPREAD_OF = {"half_loop": "friction_force"}
SYMBOLS = {"friction_coefficient": "µ", "half_loop": "half loop", "friction_force": "F"}


def error_text(value: float | None, error: float | None, unit: str = "") -> str:
    """Return value and error as text, rounded to the significant digits of the error.

    Examples
    --------
    >>> error_text(0.81234, 0.0042)
    '0.812 ± 0.004'
    >>> error_text(5.6312, None, " N")
    '5.63 N'
    """
    if value is None or not math.isfinite(value):
        return "–"
    if error is None or not math.isfinite(error) or error <= 0:
        return number(value) + unit
    # two digits of an error that begins with 1, else one
    place = math.floor(math.log10(error))
    decimals = min(max((error / 10**place < 1.95) - place, 0), 6)
    if round(error, decimals) == 0.0:  # smaller numbers are not written out
        return number(value) + unit
    text = f"{value:.{decimals}f} ± {error:.{decimals}f}".replace("-", MINUS)
    return f"({text}){unit}" if unit else text


def validity_of(groups: Iterable[Any]) -> str:
    """Return the limits of the theory that results exceed, as text; "" if none.

    Parameters
    ----------
    groups
        Datasets with the attribute ``validity_reasons``, see `tribolab.core.validity`.
    """
    return together([data.attrs for data in groups])["validity_reasons"]


def plain_value(value: Any) -> Any:
    """Convert a value for JSON: NaN and infinity become null, numpy becomes Python.

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
