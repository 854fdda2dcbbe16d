"""Information on named arrays: units of length, scale of counts, sentinels."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.lexicon.lexicon import keys_of, normalise_label, words_of
from tribolab.reading.scans.formats.named_arrays import NamedArray
from tribolab.reading.scans.unit_words import axes_of, is_about_heights, stated_units
from tribolab.units.spellings import MICRO, unit_of_length

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+")
_LATERAL = frozenset("lateral horizontal position pos".split())
_VALUES = frozenset("depth topography value values data".split())
UNITS = frozenset(keys_of("unit"))
_JOINED = re.compile(r"(?i)^(xy|[xyz])(units?)$|^(units?)(xy|[xyz])$")  # "xunits"
_SCALE = re.compile(
    r"(?i)^(?:(?:z|height)_?)?(?:scale(?:_?factor)?|scaling|gain|factor|multiplier|increment|lsb|slope"
    rf"|calibration|resolution)(?:_(?P<unit>[npu{MICRO}]m|mm|m))?$"
)
_OFFSET = re.compile(r"(?i)^(?:add_?|z_?|height_?)?(?:offset|intercept)(?:_\w{1,2})?$")
_FILL = re.compile(
    r"(?i)^_?fill_?value$|missing|no_?data|invalid|^bad_?\w*$|^void\w*$|^lost$|undefined|^nan_?value$"
)
_OF_HEIGHTS = re.compile(r"(?i)^(?:z|heights?)_")


def tokens(name: str) -> frozenset[str]:
    """Return the normalised words of an array's own name.

    >>> sorted(tokens("scan/heightMap"))
    ['height', 'heightmap', 'map']
    """
    leaf = re.split(r"[./]", name)[-1]
    return frozenset(normalise_label(word) for word in [*_WORD.findall(leaf), leaf])


def stated_unit(texts: Mapping[str, str], axis: str) -> str | None:
    """Return the unit of length that texts state for an axis; None without or with several.

    >>> stated_unit({"info.unit_xy": "um", "info.unit_z": "nm"}, "z")
    'nm'
    >>> stated_unit({"comment": "x and y in um, z in nm"}, "z")
    'nm'
    """
    own, of_any = set(), set()
    for key, text in texts.items():
        if not (unit := unit_of_length(text)):
            own |= {stated.unit for stated in stated_units(text) if axis in _axes(stated.words)}
            continue
        parts = (_JOINED.sub(r"\1\4 \2\3", part) for part in re.split(r"[./]", key)[-2:])
        words = " ".join(parts)
        if not UNITS & set(words_of(words)):
            continue
        named = _axes(words)
        if axis in named:
            own.add(unit)
        elif not named:
            of_any.add(unit)
    units = own or of_any
    return units.pop() if len(units) == 1 else None


def _axes(words: str) -> set[str]:
    """Return the axes named by words: by letter, or as lateral or height direction."""
    words_used = set(words_of(words))
    axes = axes_of(words) | ({"x", "y"} if words_used & _LATERAL else set())
    up = not axes and (is_about_heights(words) or words_used & _VALUES)
    return axes | {"z"} if up else axes


def scaled(
    heights: NamedArray, z: np.ndarray, unit: str | None, others: Iterable[NamedArray]
) -> tuple[np.ndarray, str | None, list[str]]:
    """Return heights scaled by their attributes, their unit, and the sentinels removed.

    Parameters
    ----------
    heights
        Heights in the file with their attributes: ``scale_factor`` and ``add_offset`` (CF) or
        similar names, and sentinels.
    z
        The numbers, possibly transposed.
    unit
        Unit of the heights, if known.
    others
        Other arrays: single numbers such as ``z_scale`` apply to heights in counts.
    """
    stated = {key: value for key, value in heights.attrs.items() if _is_number(value)}
    if heights.values.dtype.kind in "iu":
        singles = {a.name: float(a.values) for a in others if a.values.ndim == 0}
        named = {re.split(r"[./]", key)[-1]: value for key, value in singles.items()}
        stated = {
            k: v for k, v in named.items() if _OF_HEIGHTS.match(k) or _FILL.search(k)
        } | stated
    z = z.copy()
    lost = []
    for key, value in stated.items():
        none = z == value
        if _FILL.search(key) and none.any():
            z[none] = np.nan
            lost.append(f"height: {value:.9g} {int(none.sum())} times, as '{shown(key)}' says")
    for key, value in stated.items():
        if (scale := _SCALE.match(key)) is not None and value:
            z *= value
            unit = unit_of_length(scale["unit"]) if scale["unit"] else unit
            break
    for key, value in stated.items():
        if _OFFSET.match(key):
            z += value
            break
    return z, unit, lost


def unit_of_scale(attrs: Mapping[str, object]) -> str | None:
    """Return the unit in the name of a scale.

    >>> unit_of_scale({"z_scale_nm": 2.0})
    'nm'
    """
    scales = [scale for key in attrs if (scale := _SCALE.match(key)) and scale["unit"]]
    return unit_of_length(scales[0]["unit"]) if len(scales) == 1 else None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
