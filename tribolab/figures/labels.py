"""Texts of figures and tables: symbols, units, axis labels, column names, escaped names."""

from __future__ import annotations

import functools
import re

from tribolab.units.quantities import quantity

_SUBSCRIPT = re.compile(r"_([A-Za-z0-9]{2,}|[A-Z0-9])")


def symbol(name: str) -> str:
    r"""Return the symbol of a quantity in matplotlib's mathtext; "" if it has none.

    Examples
    --------
    >>> symbol("normal_force")
    '$F_{\\mathrm{N}}$'
    """
    text = quantity(name).symbol
    return "$" + _SUBSCRIPT.sub(r"_{\\mathrm{\1}}", text) + "$" if text else ""


def plain_symbol(name: str) -> str:
    """Return the symbol of a quantity as plain text; "" if it has a subscript.

    Examples
    --------
    >>> plain_symbol("friction_coefficient"), plain_symbol("sliding_speed"), plain_symbol("gap")
    ('µ', 'v', 'u')
    """
    text = _GREEK.get(quantity(name).symbol, quantity(name).symbol)
    return "" if re.search(r"[_\\{]", text) else text


def plain_unit(name: str) -> str:
    """Return the unit of a quantity as plain text; ``""`` for a pure number.

    Examples
    --------
    >>> plain_unit("psd_2d"), plain_unit("work_of_adhesion"), plain_unit("friction_coefficient")
    ('m⁴', 'J/m²', '')
    """
    text = quantity(name).unit
    return (
        "" if text == "1" else re.sub(r"(?<=[A-Za-z])\d", lambda m: m[0].translate(_RAISED), text)
    )


_GREEK = {"\\mu": "µ", "\\omega": "ω", "\\zeta": "ζ", "\\gamma": "γ", "\\xi": "ξ"}
_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def unit(name: str) -> str:
    """Return the unit of a quantity in mathtext; ``""`` for a pure number.

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
    """Return an axis label: long name, symbol, and unit in brackets.

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
    """Return the name of a table's column for a variable: the name with the unit at its end.

    Examples
    --------
    >>> column("sliding_speed"), column("friction_coefficient_std"), column("trend")
    ('sliding_speed_m_s', 'friction_coefficient_std', 'trend_1_s')
    """
    text = quantity(name).unit
    if text == "1":
        return name
    return name + "_" + re.sub(r"[^A-Za-z0-9]+", "_", text)


@functools.lru_cache(maxsize=1)
def _known_characters() -> frozenset[int]:
    # imported late: matplotlib loads slowly
    from matplotlib.font_manager import findfont, get_font

    return frozenset(get_font(findfont("DejaVu Sans")).get_charmap())


def plain(text: object, longest: int = 40) -> str:
    r"""Return a text as one short line for matplotlib; it contains no formula and no unknown sign.

    Characters that the font does not have become boxes.

    Examples
    --------
    >>> plain("load $31$")
    'load \\$31\\$'
    """
    line = "".join(c if c.isprintable() else " " for c in str(text))
    line = "".join(c if ord(c) in _known_characters() else "□" for c in line)
    line = line if len(line) <= longest else line[: longest - 2] + "…"
    return line.replace("$", r"\$")
