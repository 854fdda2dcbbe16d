"""Words on figures and tables: axis labels with SI units, speeds, columns, names made harmless."""

from __future__ import annotations

import functools
import math
import re

from tribolab.quantities import quantity

MINUS = "\N{MINUS SIGN}"
_SUBSCRIPT = re.compile(r"_([A-Za-z0-9]{2,}|[A-Z0-9])")


def symbol(name: str) -> str:
    r"""Return the quantity's symbol as mathtext.

    Examples
    --------
    >>> symbol("normal_force")
    '$F_{\\mathrm{N}}$'
    """
    text = quantity(name).symbol
    return "$" + _SUBSCRIPT.sub(r"_{\\mathrm{\1}}", text) + "$" if text else ""


def unit(name: str) -> str:
    """Return the quantity's unit as it stands on an axis, ``""`` for a pure number.

    Examples
    --------
    >>> unit("sliding_speed"), unit("friction_coefficient")
    ('m/s', '')
    """
    text = quantity(name).unit
    if text == "1":
        return ""
    text = re.sub(r"^1/(\w+)$", r"\1$^{-1}$", text)
    return re.sub(r"(?<=[A-Za-z])(\d)$", r"$^{\1}$", text)


def label(name: str, long_name: str | None = None) -> str:
    """Return an axis label: long name, symbol, unit in brackets.

    Examples
    --------
    >>> label("sliding_speed")
    'sliding speed $v$ (m/s)'
    """
    words = [long_name or quantity(name).long_name, symbol(name)]
    if unit(name):
        words.append(f"({unit(name)})")
    return " ".join(word for word in words if word)


@functools.lru_cache(maxsize=256)
def column(name: str) -> str:
    """Return the name of a table's column: the variable's with its unit.

    Examples
    --------
    >>> column("sliding_speed"), column("friction_coefficient_std"), column("trend")
    ('sliding_speed_m_s', 'friction_coefficient_std', 'trend_1_s')
    """
    text = quantity(name).unit
    if text == "1":
        return name
    return name + "_" + re.sub(r"[^A-Za-z0-9]+", "_", text)


def number(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits and no needless zeros or exponents.

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
    """Return a number with so many significant digits, zeros kept, as columns of numbers want.

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
    """Return a sliding speed [m/s] with the prefix a reader would choose.

    A speed just below 1 um/s stays in um/s, since it was meant to be 1 um/s.

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


def force_text(force: float) -> str:
    """Return a force [N] as text, e.g. ``"31 N"``."""
    return f"{number(force)} N" if math.isfinite(force) else "load unknown"


@functools.lru_cache(maxsize=1)
def _known_characters() -> frozenset[int]:
    from matplotlib.font_manager import findfont, get_font

    return frozenset(get_font(findfont("DejaVu Sans")).get_charmap())


def plain(text: object) -> str:
    r"""Make a name from a user's file safe to draw: no mathtext, no unknown letters, one line.

    A letter that the figures' font does not have is drawn as a box; the page beside the figure
    has the name in full.

    Examples
    --------
    >>> plain("load $31$")
    'load \\$31\\$'
    """
    line = "".join(c if c.isprintable() else " " for c in str(text))
    line = "".join(c if ord(c) in _known_characters() else "□" for c in line)
    line = line if len(line) <= 40 else line[:38] + "…"
    return line.replace("$", r"\$")
