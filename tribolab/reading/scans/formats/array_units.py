"""What is said beside arrays by name: units of length, worth of a count, what stands for none."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np

from tribolab.errors import shown
from tribolab.reading.scans.formats.named_arrays import HeldArray

# units as files write them, and as we do
LENGTHS = {
    **{unit: unit for unit in ("m", "mm", "um", "nm", "pm", "cm", "angstrom", "inch", "mil")},
    **dict.fromkeys(("µm", "μm", "micron", "microns", "micrometer", "micrometre"), "um"),
    **dict.fromkeys(("meter", "metre", "meters", "metres"), "m"),
    **dict.fromkeys(("millimeter", "millimetre", "MM"), "mm"),
    **dict.fromkeys(("nanometer", "nanometre", "nanometers", "nanometres"), "nm"),
    **{"Å": "angstrom", "UM": "um", "NM": "nm"},
}
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+")
_AXES = {
    "x": frozenset("x xy lateral horizontal position pos".split()),
    "y": frozenset("y xy lateral horizontal position pos".split()),
    "z": frozenset("z height heights vertical topography depth value values data".split()),
}
UNITS = frozenset(
    "unit units einheit einheiten unité unités unidad unidades unità eenheid enhet enhed jednotka "
    "jednostka".split()
)
_JOINED = re.compile(r"(?i)^(?P<axis>xy|x|y|z)_?units?$|^units?_?(?P<after>xy|x|y|z)$")
_IN_WORDS = re.compile(
    r"(?i)(?<![^\W_])(?P<what>x\s?[,/&+]?\s?y|xy|x|y|z|heights?)\s*(?:in|are in|is in|[:=\[(/])?\s*"
    r"(?P<unit>[npuµμ]m|mm|cm|m|Å|microns?)(?![^\W_])"
)
_SCALE = re.compile(
    r"(?i)^(?:(?:z|height)_?)?(?:scale(?:_?factor)?|scaling|gain|factor|multiplier|increment|lsb|slope"
    r"|calibration|resolution)(?:_(?P<unit>[npuµμ]m|mm|m))?$"
)
_OFFSET = re.compile(r"(?i)^(?:add_?|z_?|height_?)?(?:offset|intercept)(?:_\w{1,2})?$")
_FILL = re.compile(
    r"(?i)^_?fill_?value$|missing|no_?data|invalid|^bad_?\w*$|^void\w*$|^lost$|undefined|^nan_?value$"
)
_OF_HEIGHTS = re.compile(r"(?i)^(?:z|heights?)_")


def tokens(name: str) -> frozenset[str]:
    """Return the words of an array's own name, in small letters.

    >>> sorted(tokens("scan/heightMap"))
    ['height', 'heightmap', 'map']
    """
    leaf = re.split(r"[./]", name)[-1]
    return frozenset(word.lower() for word in _WORD.findall(leaf)) | {leaf.lower()}


def stated_unit(texts: Mapping[str, str], axis: str) -> str | None:
    """Return the unit of length that texts beside the arrays say of an axis; None if none or two.

    >>> stated_unit({"info.unit_xy": "um", "info.unit_z": "nm"}, "z")
    'nm'
    >>> stated_unit({"comment": "x and y in um, z in nm"}, "z")
    'nm'
    """
    own, any_axis = set(), set()
    for key, text in texts.items():
        parts = re.split(r"[./]", key)[-2:]
        words = {word for part in parts for word in tokens(part)}
        joined = _JOINED.match(parts[-1])
        unit = LENGTHS.get(text.strip().strip("[]()"))
        if joined is not None:
            words = {"unit", (joined["axis"] or joined["after"]).lower()}
        if unit is not None and words & UNITS:
            others = frozenset().union(*(w for name, w in _AXES.items() if name != axis))
            if words & _AXES[axis]:
                own.add(unit)
            elif not words & others:
                any_axis.add(unit)
        if unit is None:
            own |= {
                LENGTHS[said["unit"].replace("Um", "um")]
                for said in _IN_WORDS.finditer(text)
                if said["unit"] in LENGTHS and axis in _axes_of(said["what"].lower())
            }
    units = own or any_axis
    return units.pop() if len(units) == 1 else None


def _axes_of(what: str) -> str:
    return "z" if what.startswith(("z", "h")) else what


def scaled(
    heights: HeldArray, z: np.ndarray, unit: str | None, beside: Iterable[HeldArray]
) -> tuple[np.ndarray, str | None, list[str]]:
    """Return heights as their attributes make them of counts, with their unit, and what was none.

    Parameters
    ----------
    heights
        As the file holds them, with their attributes: ``scale_factor`` and ``add_offset``, as CF
        says, or names like them, and what stands for no height.
    z
        The numbers, turned perhaps.
    unit
        Of the heights, if it is known.
    beside
        Other arrays: single numbers named ``z_scale`` belong to heights in counts.
    """
    said = {key: value for key, value in heights.attrs.items() if _is_number(value)}
    if heights.values.dtype.kind in "iu":
        singles = {a.name: float(a.values) for a in beside if a.values.ndim == 0}
        named = {re.split(r"[./]", key)[-1]: value for key, value in singles.items()}
        said = {k: v for k, v in named.items() if _OF_HEIGHTS.match(k) or _FILL.search(k)} | said
    z = z.copy()
    told = []
    for key, value in said.items():
        none = z == value
        if _FILL.search(key) and none.any():
            z[none] = np.nan
            told.append(f"height: {value:.9g} {int(none.sum())} times, as '{shown(key)}' says")
    for key, value in said.items():
        if (scale := _SCALE.match(key)) is not None and value:
            z *= value
            unit = LENGTHS[scale["unit"]] if scale["unit"] else unit
            break
    for key, value in said.items():
        if _OFFSET.match(key):
            z += value
            break
    return z, unit, told


def unit_of_scale(attrs: Mapping[str, object]) -> str | None:
    """Return the unit that the name of a scale says.

    >>> unit_of_scale({"z_scale_nm": 2.0})
    'nm'
    """
    scales = [scale for key in attrs if (scale := _SCALE.match(key)) and scale["unit"]]
    return LENGTHS[scales[0]["unit"]] if len(scales) == 1 else None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
