"""Formats of numbers, counts, speeds and reasons in texts."""

from __future__ import annotations

import math
import traceback
from collections.abc import Iterable
from pathlib import Path

from tribolab.core.errors import TribolabError, brief, shown

MINUS = "\N{MINUS SIGN}"


def number(value: float, digits: int = 3) -> str:
    """Return a number with the given significant digits, without superfluous zeros or exponents.

    Examples
    --------
    >>> number(10.0), number(0.000215), number(-21400.0)
    ('10', '0.000215', '−21400')
    """
    if not math.isfinite(value):
        return "–"
    if value and not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{digits}g}".replace("-", MINUS)
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value)))) if value else 0
    text = f"{value:.{decimals}f}".replace("-", MINUS)
    return text.rstrip("0").rstrip(".") if "." in text else text


def aligned(value: float, digits: int = 3) -> str:
    """Return a number with the given significant digits, with trailing zeros for columns.

    Examples
    --------
    >>> aligned(0.8), aligned(2000.0), aligned(float("nan"))
    ('0.800', '2000', '–')
    """
    if not math.isfinite(value):
        return "–"
    large = 10**digits <= abs(value) < 1e6
    text = f"{value:.0f}" if large else f"{value:#.{digits}g}".rstrip(".")
    return text.replace("-", MINUS)


def speed_text(speed: float) -> str:
    """Return a sliding speed [m/s] as text with a suitable unit prefix.

    A speed just below 1 um/s is given in um/s, since its set-point was 1 um/s.

    Examples
    --------
    >>> speed_text(0.999e-6), speed_text(2.15e-3), speed_text(float("nan"))
    ('0.999 µm/s', '2.15 mm/s', 'speed unknown')
    """
    if not math.isfinite(speed):
        return "speed unknown"
    for factor, prefix in ((1e-9, "nm/s"), (1e-6, "µm/s"), (1e-3, "mm/s")):
        if abs(speed) < 950 * factor:
            return f"{number(speed / factor)} {prefix}"
    return f"{number(speed)} m/s"


def force_text(force: float | None) -> str:
    """Return a force [N] as text, e.g. ``"31 N"``; None means an unknown force."""
    if force is None or not math.isfinite(force):
        return "load unknown"
    return f"{number(force)} N"


LOAD_STATED, LOAD_MEASURED, LOAD_VARIES = "stated", "measured", "varies"


def load_label(load: float | None) -> float | None:
    """Return a load [N] rounded to four digits; runs with equal values share a curve.

    >>> load_label(14.709975), load_label(None)
    (14.71, None)
    """
    return load and float(f"{load:.4g}")


def load_text(load: float | None, load_from: str) -> str:
    """Return the load [N] of a run or curve as text, marked if it was measured and not set.

    Examples
    --------
    >>> load_text(31.0, LOAD_STATED), load_text(15.0, LOAD_MEASURED), load_text(None, LOAD_VARIES)
    ('31 N', '15 N measured', 'several loads')
    """
    if load is None:
        return "several loads" if load_from else force_text(load)
    return f"{force_text(load)} measured" if load_from == LOAD_MEASURED else force_text(load)


def span(values: Iterable[float | None], unit: str = "") -> str:
    """Return a range as text, or a single number if both ends would look equal.

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
    """Return a range of sliding speeds as text.

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
    """Return a duration as text in a suitable unit.

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


def signed_percent(share: float | None) -> str:
    """Return a deviation in percent with its sign, with one decimal below ten percent."""
    if share is None:
        return ""
    if abs(share) < 0.0005:  # neither +0.0 nor -0.0
        return "0.0 %"
    text = f"{100 * share:+.{1 if abs(share) < 0.0995 else 0}f} %"
    return text.replace("-", MINUS)


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
    """Return the number of bytes as text, e.g. ``"1.2 MB"``."""
    for limit, factor, unit in ((1e3, 1, "B"), (1e6, 1e3, "kB"), (math.inf, 1e6, "MB")):
        if count < limit:
            return f"{number(count / factor)} {unit}"
    raise AssertionError("unreachable: every count is below infinity")


class Count(int):
    """Count that formats itself with the matching noun.

    Examples
    --------
    >>> f"{Count(1):gap|gaps} and {Count(3):sample is|samples are} missing"
    '1 gap and 3 samples are missing'
    """

    def __format__(self, nouns: str) -> str:
        """Return the count with the singular or plural of "one|many"."""
        singular, _, more = nouns.partition("|")
        return f"{int(self)} {singular if self == 1 else more}" if nouns else str(int(self))


_PACKAGE = Path(__file__).resolve().parents[1]


def explain(error: BaseException) -> tuple[str, str]:
    """Return the message of an error on one line, and the name of its class.

    The message is worded for the records of a campaign; unexpected errors include file and line.
    """
    name = type(error).__name__
    if isinstance(error, TribolabError):
        return " ".join(error.message_for("campaign").split()), name
    text = brief(error) if str(error) else ""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{shown(Path(str(error.filename)).name)}: {error.strerror.lower()}", name
    where = ""
    if frames := traceback.extract_tb(error.__traceback__):
        ours = [frame for frame in frames if Path(frame.filename).is_relative_to(_PACKAGE)]
        frame = (ours or frames)[-1]
        file = Path(frame.filename)
        place = file.relative_to(_PACKAGE).as_posix() if ours else file.name
        where = f" at {place}:{frame.lineno}"
    return f"crashed with {name}{where}: {text}" if text else f"crashed with {name}{where}", name


_DRY = {"dry", "none", "air"}


def is_dry(medium: str) -> bool:
    """Return whether the name of a medium means a dry contact.

    Examples
    --------
    >>> is_dry("Dry"), is_dry("glycerol")
    (True, False)
    """
    return medium.strip().lower() in _DRY
