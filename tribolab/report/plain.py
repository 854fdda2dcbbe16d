"""Numbers as people write them: rounded as they were meant."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from tribolab.words import number

_PREFIXES = ((1e-9, "nm/s"), (1e-6, "µm/s"), (1e-3, "mm/s"), (1.0, "m/s"))


def plain_speed(speed: float | None) -> str:
    """Return a sliding speed [m/s] to two digits, with the prefix a reader would choose.

    Examples
    --------
    >>> plain_speed(0.999e-6), plain_speed(9.994e-5), plain_speed(4.64e-6), plain_speed(9.996e-4)
    ('1 µm/s', '100 µm/s', '4.6 µm/s', '1 mm/s')
    """
    if speed is None or not math.isfinite(speed):
        return "speed unknown"
    if speed == 0:
        return "0 m/s"
    rounded = float(f"{speed:.2g}")
    factor, prefix = next(
        (pair for pair in _PREFIXES if abs(rounded) < 999.5 * pair[0]), _PREFIXES[-1]
    )
    return f"{number(rounded / factor, 3)} {prefix}"


_SPEED = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?) (nm/s|µm/s|mm/s|m/s)\b")


def plain_speeds(text: str) -> str:
    """Return a text in which sliding speeds are written as people write them.

    Examples
    --------
    >>> plain_speeds("from 0.999 µm/s to 99.9 µm/s, 2.15 mm/s")
    'from 1 µm/s to 100 µm/s, 2.2 mm/s'
    """
    factors = {prefix: factor for factor, prefix in _PREFIXES}
    return _SPEED.sub(lambda found: plain_speed(float(found[1]) * factors[found[2]]), text)


def listed(words: Sequence[str]) -> str:
    """Return words as a sentence lists them.

    Examples
    --------
    >>> listed(["31 N", "91 N", "131 N"]), listed(["31 N"])
    ('31 N, 91 N and 131 N', '31 N')
    """
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"
