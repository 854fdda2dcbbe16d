"""What the text of a file states of a profile: pitch, length, units, tip, traverse speed."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import length_unit, matches
from tribolab.reading.interpret.phrases import phrases
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import alternatives, key_pattern, normalise_label
from tribolab.reading.numbers import decimal, numbers_in
from tribolab.reading.unknown.header.settings import numeric_settings, text_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.units import conversion

_LONGEST = 200  # characters of a line that are looked at
_FEW_POINTS = 20  # of a profile
_UNEVEN = 0.1  # of the interval of heights that are taken by the clock
_TIP_RADII = (1e-9, 1e-3)  # m, the smallest and the largest
# units of heights under whatever name they stand
_USUAL = frozenset({"nm", "um", "µm", "\u03bcm", "mm", "pm", "Å", "angstrom", "microns", "micron"})
_POINTS = alternatives("surface_point")
# "4 points/um", "2000 per mm" as the unit of a number; "Points per mm: 2000" before it
_PER_LENGTH = re.compile(rf"{_POINTS}?/(?P<unit>\w+)", re.IGNORECASE)
_LENGTH_HAS = re.compile(
    rf"{_POINTS}\s?{alternatives('per')}\s?(?P<unit>\w+)\W{{0,3}}[:=\t; ]\s*$", re.IGNORECASE
)
_HEIGHTS_IN = re.compile(
    rf"(?<![^\W\d_]){alternatives('heights_in')}\s+{alternatives('in')}\s+"
    r"(?P<unit>[^\W\d]{1,12})(?![^\W_])",
    re.IGNORECASE,
)


def find_pitch(layout: Layout) -> Amount | None:
    """Return the distance of a profile's points that the text before the heights states, or None.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    """
    found = _above(layout).of("pitch", unit="m")
    axes = {value.key[-1] for value in found}
    if not found or (layout.width == 1 and {"x", "y"} <= axes):  # heights of a map in one column
        return None
    return found[0]._replace(name="pitch", to="m")


def find_profile_length(layout: Layout) -> Amount | None:
    """Return the length of a whole profile that the text before the heights states, or None.

    It is no guess if the text also says how many points the profile has, and as many follow.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
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
    """Return what the text before a profile states of it, each under the name that checks know.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    placed
        Whether heights have positions, with which a stated distance can be compared.

    Returns
    -------
    list of Amount
        ``tip_radius``, ``stated_length``, ``stated_pitch`` and ``stated_points``, if they are
        stated just once.
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
    counts = [v for v in values.of("points", unit="") if v.number == round(v.number)]
    if len(counts) == 1:
        found.append(counts[0]._replace(name="stated_points", unit="1", to="1"))
    return found


def find_height_unit(layout: Layout) -> str:
    """Return the unit of heights that the text before them states in a line of its own, or "".

    One unit for a whole table ("Units: mm") is theirs, too, if no other is stated.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    """
    said = _length_units(layout)
    own = {unit for key, unit in said if _means("height_unit")(key) or _names_heights(key)}
    names = layout.heading.cells if layout.heading is not None and layout.width == 1 else ()
    lines = (*layout.text_above(bare=True), *names)
    sentences = (_HEIGHTS_IN.search(line[:_LONGEST]) for line in lines)
    own |= {unit for match in sentences if match and (unit := length_unit(match["unit"]))}
    if layout.width == 1 and not own:
        own = {unit for key, unit in said if _means("unit")(key)}
        own |= {unit for key, unit in said if unit in _USUAL and not _means("not_height")(key)}
    if len(own) > 1:
        return ""
    return own.pop() if own else _unit_of_all(layout)


def find_unit_along(layout: Layout) -> str:
    """Return the unit of positions that the text before them states in a line of its own, or "".

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    """
    units = {unit for key, unit in _length_units(layout) if _means("along")(key)}
    if len(units) > 1:
        return ""
    return units.pop() if units else _unit_of_all(layout)


def find_point_density(layout: Layout) -> str:
    """Return the distance of a profile's points if the text says how many a length has, or "".

    A traverse at a stated speed that is sampled at a stated rate says it, too, and so do a stated
    start and end with the number of points.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    """
    stated = (points_per_length(line) for line in layout.text_above(bare=True))
    number, unit = next((density for density in stated if density), (0.0, ""))
    if number:
        return f"{1 / number:.12g} {unit}"
    values = _above(layout)
    speed, rate = values.only("traverse_speed", unit="m/s"), values.only("sampling_rate", unit="Hz")
    if speed and rate and speed.si("m/s") > 0 and rate.si("Hz") > 0:
        return f"{1e6 * speed.si('m/s') / rate.si('Hz'):.12g} um"
    return _between_ends(layout, values)


def points_per_length(line: str) -> tuple[float, str] | None:
    """Return how many points of a profile a length has, and the length's unit, if a line says so.

    Parameters
    ----------
    line
        One line above the table.

    Examples
    --------
    >>> points_per_length("sampling 4 points/um")
    (4.0, 'um')
    >>> points_per_length("Punten per mm: 2000")
    (2000.0, 'mm')
    """
    line = line[:_LONGEST]
    for number in numbers_in(line):
        match = _PER_LENGTH.fullmatch(number.unit) or _LENGTH_HAS.search(line[: number.start])
        if match and converts(match["unit"], "m") and number.value > 0:
            return number.value, match["unit"]
    return None


def _between_ends(layout: Layout, values: Amounts) -> str:
    """Return the distance of points that lie between a stated start and end; "" if unknown."""
    points = layout.row_count
    counts = {v.number for v in values.of(unit="") if v.means("points") or v.key == "n"}
    start = values.only("start_of_trace", unit="m")
    end = values.only("end_of_trace", unit="m")
    if start is None or end is None or not any(abs(count - points) < 1 for count in counts):
        return ""
    apart = (end.si("m") - start.si("m")) / (points - 1)
    return f"{1e6 * apart:.12g} um" if apart > 0 else ""


def pitch_of_clock(layout: Layout, time: np.ndarray, *, of_sensor: bool = False) -> str:
    """Return the distance of points that a sensor takes by the clock on its way; "" if unknown.

    Parameters
    ----------
    layout
        From `text_layout.find_layout`, whose text states how fast the sensor goes.
    time
        When each height was taken [s].
    of_sensor
        As for `find_traverse_speed`.
    """
    speed = find_traverse_speed(layout, of_sensor=of_sensor)
    step = seconds_apart(time)
    return f"{1e6 * speed * step:.12g} um" if speed > 0 and step > 0 else ""


def find_traverse_speed(layout: Layout, *, of_sensor: bool = False) -> float:
    """Return how fast a sensor goes over the surface [m/s], if the text says it once; else 0.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    of_sensor
        Whether the file is known to be of a sensor on its way: any one speed is that of it.
    """
    values = _above(layout)
    stated = values.only("traverse_speed", unit="m/s")
    if stated is not None and stated.si("m/s") > 0:
        return stated.si("m/s")
    said = [
        (phrase.key, decimal(phrase.number) * conversion(phrase.unit, "m/s")[0])
        for line in layout.text_above(bare=True)
        for phrase in phrases(line)
        if converts(phrase.unit, "m/s")
    ]
    named = {speed for key, speed in said if _means("traverse_speed")(key)}
    if of_sensor and not named:
        named = {speed for _, speed in said} | {v.si("m/s") for v in values.of(unit="m/s")}
    return named.pop() if len(named) == 1 else 0.0


def seconds_apart(time: np.ndarray) -> float:
    """Return the interval between a profile's points [s]; 0 if it is not even.

    Parameters
    ----------
    time
        When each height was taken [s].
    """
    steps = np.diff(time)
    if steps.size < _FEW_POINTS or not np.isfinite(steps).all():
        return 0.0
    step = float(steps.mean())
    return step if step > 0 and float(np.abs(steps - step).max()) < _UNEVEN * step else 0.0


def _above(layout: Layout) -> Amounts:
    return numeric_settings(layout, bare=True).of(source="preamble")


def _means(concept: str) -> Callable[[str], re.Match[str] | None]:
    return key_pattern(concept).search


def _length_units(layout: Layout) -> list[tuple[str, str]]:
    texts = text_settings(layout, bare=True)
    said = ((normalise_label(key), length_unit(text)) for key, text in texts)
    return [(key, unit) for key, unit in said if unit]


def _unit_of_all(layout: Layout) -> str:
    """Return the unit of all lengths of a table of several columns: "Units: mm"; "" if none is."""
    said = _length_units(layout)
    stated = [unit for key, unit in said if _means("unit")(key)]
    one = len(stated) == len({unit for _, unit in said}) == 1
    return stated[0] if layout.width > 1 and one else ""


def _names_heights(key: str) -> bool:
    """Whether what a line calls so is the height, and not a size across the surface."""
    if _means("not_height")(key):
        return False
    options = matches(key, None, scan=True)
    return bool(_means("vertical")(key) or (options and options[0].quantity == "height"))
