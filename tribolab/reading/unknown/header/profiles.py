"""Pitch, length, units and stylus tip of a profile, as stated in the text of its file."""

from __future__ import annotations

import re
from collections.abc import Callable

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import length_unit, matches
from tribolab.reading.lexicon.lexicon import alternatives, key_pattern, normalise_label
from tribolab.reading.unknown.header.settings import numeric_settings, text_settings
from tribolab.reading.unknown.layout.text_layout import Layout

_TIP_RADII = (1e-9, 1e-3)  # m, the smallest and the largest
# units that mean heights whatever the setting is called
_USUAL = frozenset({"nm", "um", "µm", "\u03bcm", "mm", "pm", "Å", "angstrom", "microns", "micron"})
_HEIGHTS_IN = re.compile(
    rf"(?<![^\W\d_]){alternatives('heights_in')}\s+{alternatives('in')}\s+"
    r"(?P<unit>[^\W\d]{1,12})(?![^\W_])",
    re.IGNORECASE,
)


def find_pitch(layout: Layout) -> Amount | None:
    """Return the pitch of a profile as stated above the heights, or None."""
    found = _above(layout).of("pitch", unit="m")
    axes = {value.key[-1] for value in found}
    if not found or (layout.width == 1 and {"x", "y"} <= axes):  # heights of a map in one column
        return None
    return found[0]._replace(name="pitch", to="m")


def find_profile_length(layout: Layout) -> Amount | None:
    """Return the length of a whole profile as stated above the heights, or None.

    The length is certain if the text also states the number of points, and as many follow.
    """
    length = _above(layout).only("profile_length", unit="m")
    if length is None:
        return None
    said = length._replace(name="profile_length", to="m")
    counts = _above(layout).of("points")
    if any(v.unit is None and abs(v.number - layout.row_count) <= 1 for v in counts):
        return said
    return said._replace(guess=f"the heights lie evenly over '{said.text}'")


def find_stated(layout: Layout, *, placed: bool) -> list[Amount]:
    """Return stated properties of a profile under the names that the checks of scans use.

    These are ``tip_radius``, ``stated_length``, ``stated_pitch`` and ``stated_points``; any that
    is stated more than once is left out.
    """
    values = _above(layout)
    whole = values.of("profile_length", unit="m", but=("part_of_trace",)).of("length_of_trace")
    pitches = values.of("pitch", unit="m") if placed else Amounts()
    radii = [
        value._replace(scale=0.5 if value.means("tip_diameter") else 1.0)
        for value in values.of("tip_radius", unit="m")
    ]
    tips = [radius for radius in radii if _TIP_RADII[0] < radius.si("m") < _TIP_RADII[1]]
    named = {
        "stated_length": [v for v in whole if v.si("m") > 0],
        "stated_pitch": [v for v in pitches if v.si("m") > 0],
        "tip_radius": tips,
    }
    found = [v[0]._replace(name=name, to="m") for name, v in named.items() if len(v) == 1]
    counts = [v for v in values.of("points", unit="") if v.number % 1 == 0]
    if len(counts) == 1:
        found.append(counts[0]._replace(name="stated_points", unit="1", to="1"))
    return found


def find_height_unit(layout: Layout) -> str:
    """Return the unit of heights that a separate line above the table states, or "".

    A unit for the whole table ("Units: mm") is used if no other is stated.
    """
    said = _length_units(layout)
    own = {unit for key, unit in said if _means("height_unit")(key) or _names_heights(key)}
    names = layout.heading.cells if layout.heading is not None and layout.width == 1 else ()
    sentences = map(_HEIGHTS_IN.search, (*layout.sentences(bare=True), *names))
    own |= {unit for match in sentences if match and (unit := length_unit(match["unit"]))}
    if layout.width == 1 and not own:
        own = {unit for key, unit in said if _means("unit")(key)}
        own |= {unit for key, unit in said if unit in _USUAL and not _means("not_height")(key)}
    if len(own) > 1:
        return ""
    return own.pop() if own else _unit_of_all(layout)


def find_unit_along(layout: Layout) -> str:
    """Return the unit of positions that a separate line above the table states, or ""."""
    units = {unit for key, unit in _length_units(layout) if _means("along")(key)}
    if len(units) > 1:
        return ""
    return units.pop() if units else _unit_of_all(layout)


def _above(layout: Layout) -> Amounts:
    return numeric_settings(layout, bare=True).of(source="preamble")


def _means(concept: str) -> Callable[[str], re.Match[str] | None]:
    return key_pattern(concept).search


def _length_units(layout: Layout) -> list[tuple[str, str]]:
    texts = text_settings(layout, bare=True)
    said = ((normalise_label(key), length_unit(text)) for key, text in texts)
    return [(key, unit) for key, unit in said if unit]


def _unit_of_all(layout: Layout) -> str:
    """Return the only unit stated above a table of several columns: "Units: mm"; else ""."""
    said = _length_units(layout)
    stated = [unit for key, unit in said if _means("unit")(key)]
    one = len(stated) == len({unit for _, unit in said}) == 1
    return stated[0] if layout.width > 1 and one else ""


def _names_heights(key: str) -> bool:
    """Whether a normalised key means the height, and not a lateral size."""
    if _means("not_height")(key):
        return False
    options = matches(key, None, scan=True)
    return bool(_means("vertical")(key) or (options and options[0].quantity == "height"))
