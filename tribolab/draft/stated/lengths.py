"""Lengths that the text of a file states: of the track, of an arm, between a profile's points."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import Amount, numeric_settings, text_settings
from tribolab.draft.words.sentences import phrases, points_per_length
from tribolab.draft.words.stated_words import (
    ACROSS,
    ALONG,
    ARM,
    AT_ARM,
    DIAMETER,
    HEIGHT_UNIT,
    NO_HEIGHT,
    ON_RIM,
    ON_TRACK,
    OTHER_RADIUS,
    OUTER,
    PITCH,
    POINTS,
    PROFILE_LENGTH,
    RADIUS,
    RATE,
    SHAFT,
    TRAVERSE_SPEED,
    TURNING,
    UNIT,
    VERTICAL,
)
from tribolab.io.dialects.cells import split_name
from tribolab.reading.interpret.names import length_unit, matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.units import conversion

_ENDS = (
    re.compile(
        r"^x?(?:start|min|first|from|begin|anfang|debut|inicio|inizio)(?:x|position)?$|^xl$"
    ),
    re.compile(r"^x?(?:end|max|last|to|stop|ende|fin|final|fine)(?:x|position)?$|^xr$"),
)
_COUNT = re.compile(rf"^n$|{POINTS.pattern}")
_LONGEST = 200  # characters of a line that are looked at
# a ring's sides, in any language
_SIDES = (
    re.compile(
        r"inner|inside|innen|int[ei]r|interno|interieur|binnen|indre|inre|indvend|sisae|sisa|wewn|vnitr|belso|^ic|ic(?:cap|yaricap)"
        r"|внутр|内|내"
    ),
    re.compile(
        r"outer|outside|aussen|ext[ei]r|est?erno|exterieur|buiten|ydre|ytre|yttre|udvend|ulko|zewn|vnejs|kulso|kuelso"
        r"|^dis(?:cap|yaricap)|discap|наруж|внеш|外|외"
    ),
)
_WIDE = 1.5  # times the inner radius: two thirds of a per cent of the mean radius
_FEW_POINTS = 20  # of a profile
_UNEVEN = 0.1  # of the interval of heights that are taken by the clock
# units of heights under whatever name they stand
_USUAL = frozenset({"nm", "um", "µm", "μm", "mm", "pm", "Å", "angstrom", "microns", "micron"})


def find_pitch(layout: Layout) -> Amount | None:
    """Return the distance of a profile's points that the text before the heights states, or None.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    found = [
        value
        for value in numeric_settings(layout, bare=True)
        if value.source == "preamble" and PITCH.search(value.key) and _is_length(value)
    ]
    axes = {value.key[-1] for value in found}
    if not found or (layout.width == 1 and {"x", "y"} <= axes):  # heights of a map in one column
        return None
    return found[0]._replace(name="pitch", to="m")


def find_profile_length(layout: Layout) -> Amount | None:
    """Return the length of a whole profile that the text before the heights states, or None.

    Where the text also says how many points the profile has, and as many follow, nothing is
    guessed: they lie evenly over that length.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    values = [value for value in numeric_settings(layout, bare=True) if value.source == "preamble"]
    lengths = [v for v in values if PROFILE_LENGTH.search(v.key) and _is_length(v)]
    if len(lengths) != 1:
        return None
    points = layout.row_count
    counts = [v.number for v in values if v.unit is None and POINTS.search(v.key)]
    said = lengths[0]._replace(name="profile_length", to="m")
    if any(abs(count - points) <= 1 for count in counts):
        return said
    return said._replace(guess=f"the heights lie evenly over '{said.text}'")


def find_height_unit(layout: Layout) -> str:
    """Return the unit of heights that the text before them states in a line of its own, or "".

    One unit for a whole table ("Units: mm") is theirs, too, where no other is stated.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    said = [
        (normalise_label(key), length_unit(text)) for key, text in text_settings(layout, bare=True)
    ]
    said = [(key, unit) for key, unit in said if unit]
    own = {unit for key, unit in said if HEIGHT_UNIT.search(key) or _names_heights(key)}
    own |= _in_sentences(layout)
    if layout.width == 1 and not own:
        own = {unit for key, unit in said if UNIT.search(key)}
        own |= {unit for key, unit in said if unit in _USUAL and not NO_HEIGHT.search(key)}
    if len(own) > 1:
        return ""
    return own.pop() if own else _of_all(layout)


def _of_all(layout: Layout) -> str:
    """Return the unit of all lengths of a table of several columns: "Units: mm"; "" if none is."""
    said = [
        (normalise_label(key), length_unit(text)) for key, text in text_settings(layout, bare=True)
    ]
    units = {unit for key, unit in said if unit}
    stated = [unit for key, unit in said if unit and UNIT.search(key)]
    return stated[0] if layout.width > 1 and len(stated) == len(units) == 1 else ""


_HEIGHTS_IN = re.compile(
    r"(?<![^\W\d_])(?:heights?|ordinates?|z(?:[- ]values?)?|höhen?|hauteurs?|alturas?|cotas?"
    r"|altezz[ae]|quot[ae]|hoogtes?|ordinat[ae]|wysokości|výšky|höjder|høyder|højder|высоты)\s*"
    r"(?:(?:are|is|sind|ist|sont)\s+)?(?:in|en|w|v|i|em|в)\s+(?P<unit>[^\W\d]{1,12})(?![^\W_])",
    re.IGNORECASE,
)


def _in_sentences(layout: Layout) -> set[str]:
    """Return the units that sentences above the heights say of them: "heights in um"."""
    names = layout.heading.cells if layout.heading is not None and layout.width == 1 else ()
    said = (_HEIGHTS_IN.search(line[:_LONGEST]) for line in (*layout.text_above(bare=True), *names))
    return {unit for match in said if match and (unit := length_unit(match["unit"]))}


def find_unit_along(layout: Layout) -> str:
    """Return the unit of positions that the text before them states in a line of its own, or "".

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    said = [
        (normalise_label(key), length_unit(text)) for key, text in text_settings(layout, bare=True)
    ]
    units = {unit for key, unit in said if unit and ALONG.search(key)}
    if len(units) > 1:
        return ""
    return units.pop() if units else _of_all(layout)


def _names_heights(key: str) -> bool:
    """Whether what a line calls so is the height, and not a size across the surface."""
    if NO_HEIGHT.search(key):
        return False
    options = matches(key, None, scan=True)
    return bool(VERTICAL.search(key) or (options and options[0].quantity == "height"))


def find_point_density(layout: Layout) -> str:
    """Return the distance of a profile's points where the text says how many a length has, or "".

    A traverse at a stated speed that is sampled at a stated rate says it, too.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    stated = (points_per_length(line) for line in layout.text_above(bare=True))
    number, unit = next((density for density in stated if density), (0.0, ""))
    if number:
        return f"{1 / number:.12g} {unit}"
    return _sampled_on_the_way(layout) or _between_ends(layout)


def _between_ends(layout: Layout) -> str:
    """Return the distance of points that lie between a stated start and end; "" if unknown."""
    values = [v for v in numeric_settings(layout, bare=True) if v.source == "preamble"]
    counts = {v.number for v in values if v.own_unit is None and _COUNT.search(v.key)}
    ends = [[metres(v) for v in values if _is_length(v) and e.search(v.key)] for e in _ENDS]
    if any(len(stated) != 1 for stated in ends) or not any(
        abs(count - layout.row_count) < 1 for count in counts
    ):
        return ""
    apart = (ends[1][0] - ends[0][0]) / (layout.row_count - 1)
    return f"{1e6 * apart:.12g} um" if apart > 0 else ""


def _sampled_on_the_way(layout: Layout) -> str:
    values = [value for value in numeric_settings(layout, bare=True) if value.source == "preamble"]
    speed = _only(values, TRAVERSE_SPEED, "m/s")
    rate = _only(values, RATE, "Hz")
    return f"{1e6 * speed / rate:.12g} um" if speed > 0 and rate > 0 else ""


def pitch_of_clock(layout: Layout, time: np.ndarray, *, of_sensor: bool = False) -> str:
    """Return the distance of points that a sensor takes by the clock on its way; "" if unknown.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`, whose text states how fast the sensor goes.
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
        From `tribolab.draft.file.layout.find_layout`.
    of_sensor
        Whether the file is known to be of a sensor on its way: any one speed is that of it.
    """
    values = [value for value in numeric_settings(layout, bare=True) if value.source == "preamble"]
    if (speed := _only(values, TRAVERSE_SPEED, "m/s")) > 0:
        return speed
    said = [
        (phrase.key, _number(phrase.number) * conversion(phrase.unit, "m/s")[0])
        for line in layout.text_above(bare=True)
        for phrase in phrases(line)
        if converts(phrase.unit, "m/s")
    ]
    named = {speed for key, speed in said if TRAVERSE_SPEED.search(key)}
    if of_sensor and not named:
        every = ((v, v.unit or v.own_unit or "") for v in values)
        named = {speed for _, speed in said}
        named |= {v.number * conversion(u, "m/s")[0] for v, u in every if u and converts(u, "m/s")}
    return named.pop() if len(named) == 1 else 0.0


def _number(text: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return math.nan


def seconds_apart(time: np.ndarray) -> float:
    """Return what passes from one of a profile's points to the next [s]; 0 if it is not even.

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


def _only(values: Sequence[Amount], words: re.Pattern[str], si_unit: str) -> float:
    """Return what a text states once by such words, in SI; 0 if it does not."""
    units = [value.unit or value.own_unit or "" for value in values]
    told = [
        value.number * conversion(unit, si_unit)[0]
        for value, unit in zip(values, units, strict=True)
        if words.search(value.key) and converts(unit, si_unit)
    ]
    return told[0] if len(told) == 1 else 0.0


def slides_on_rim(layout: Layout) -> bool:
    """Whether a file says that the track is the outside of what turns, as in block on ring.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    texts = (layout.file.path.stem, *layout.text_above())
    return any(ON_RIM.search(text[:_LONGEST]) for text in texts)


def find_radius(values: Sequence[Amount], *, rim: bool = False) -> Amount | None:
    """Return the radius of the track, if just one of a file's values is one, or its diameter.

    Parameters
    ----------
    values
        From `numeric_settings`.
    rim
        Whether the track is the outside of what turns: its size is the track's.

    Returns
    -------
    Amount or None
        With a `guess` where it is only a radius "R", or the size of what turns.
    """
    lengths = [v._replace(to="m") for v in values if _is_length(v)]
    lengths = [v for v in lengths if not OTHER_RADIUS.search(v.key)]
    across = [v._replace(name="track_radius", scale=0.5) for v in lengths if ACROSS.search(v.key)]
    radii = [v for v in lengths if RADIUS.search(v.key)]
    sure = [v for v in radii if ON_TRACK.search(v.key)]
    sure = sure or [v for v in radii if not TURNING.search(v.key)]
    sure = sure or [v for v in across if DIAMETER.search(v.key)]
    if sure:
        return sure[0] if len(sure) == 1 else None
    outer = [v for v in (*radii, *across) if rim and OUTER.search(v.key)]
    if len(outer) == 1:
        return outer[0]
    whole = [v for v in lengths if v in radii or v.key == "r"]
    perhaps = [v._replace(guess=f"'{v.text}' is the radius of the track") for v in whole]
    perhaps = perhaps or [
        v._replace(guess=f"'{v.text}' is twice the radius of the track")
        for v in across
        if TURNING.search(v.key) or SHAFT.search(v.key) or v.key == "d"
    ]
    return perhaps[0] if len(perhaps) == 1 else None


def find_ring(values: Sequence[Amount]) -> tuple[Amount, Amount] | None:
    """Return the inner and the outer radius of a ring that slides on its face, or their diameters.

    Parameters
    ----------
    values
        From `numeric_settings`.

    Returns
    -------
    tuple or None
        With a `guess` where the ring is so wide that the mean of both is not the radius at which
        friction acts: the outer more than half as large again as the inner.
    """
    lengths = [v._replace(to="m") for v in values if _is_length(v)]
    for words, scale in ((RADIUS, 1.0), (ACROSS, 0.5)):
        sides = [
            [v for v in lengths if words.search(v.key) and side.search(v.key)] for side in _SIDES
        ]
        if [len(side) for side in sides] != [1, 1]:
            continue
        inner, outer = sides[0][0], sides[1][0]
        if not 0 < metres(inner) < metres(outer):
            continue
        wide = metres(outer) > _WIDE * metres(inner)
        guess = "friction acts at the mean of the inner and the outer radius" if wide else ""
        return (
            inner._replace(name="inner_radius", scale=scale),
            outer._replace(name="outer_radius", scale=scale, guess=guess),
        )
    return None


def find_arm(values: Sequence[Amount]) -> Amount | None:
    """Return the arm of a torque, if just one of a file's values is one.

    Parameters
    ----------
    values
        From `numeric_settings`.
    """
    arms = [v for v in values if _is_length(v) and ARM.search(v.key)]
    return arms[0]._replace(to="m") if len(arms) == 1 else None


def is_at_arm(column: DraftColumn) -> bool:
    """Whether a column's name says that its force is one on an arm, which makes a torque.

    Parameters
    ----------
    column
        Of a force.
    """
    return AT_ARM.search(normalise_label(split_name(column.label)[0])) is not None


def confirm_lever_arm_force(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Let a force that is named as one on an arm be no guess where the text states the arm.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    """
    held = [c for c in columns if c.used and c.quantity == "friction_force" and is_at_arm(c)]
    if len(held) != 1 or find_arm(numeric_settings(layout)) is None:
        return list(columns)
    return [c._replace(guessed=(), options=()) if c is held[0] else c for c in columns]


def _is_length(value: Amount) -> bool:
    return bool(value.unit and converts(value.unit, "m"))


def metres(value: Amount) -> float:
    """Return the length [m] that a value states; NaN where it is none."""
    return value.number * conversion(value.unit or "m", "m")[0] if _is_length(value) else math.nan
