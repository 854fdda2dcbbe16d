"""Stated amounts of a run: track radius, ring, lever arm, load, slide-roll ratio, rotation."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, part_pattern, role_of
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import is_per_minute
from tribolab.reading.unknown.header.factors import contacts_in
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.header import STEP_WORD
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.spellings import WEIGHTS

_STEP = re.compile(rf"^{STEP_WORD}\d*n?$")


def find_radius(values: Sequence[Amount], *, rim: bool = False) -> Amount | None:
    """Return the track radius, if a file states exactly one radius or diameter of a track.

    The radius has a `guess` if the text only states a radius "R", or the size of the rotating
    body. With `rim`, the track is the rim of the rotating body.
    """
    lengths = _lengths(values).of(but=("other_radius",))
    across = _scaled(lengths.of("diameter"), "track_radius", 0.5)
    radii = lengths.of("track_radius")
    sure = (
        radii.of("on_track")
        or radii.of(but=("turning",))
        or radii.of("of_mean")  # the mean radius of a ring
        or across.of("track_diameter")
    )
    if sure:
        return sure.only()
    if rim and (outer := Amounts((*radii, *across)).only("outer")):
        return outer
    whole = [v for v in lengths if v in radii or v.key == "r"]
    perhaps = [v._replace(guess=f"'{v.text}' is the radius of the track") for v in whole]
    perhaps = perhaps or [
        v._replace(guess=f"'{v.text}' is twice the radius of the track")
        for v in across
        if v.means("turning", "shaft") or v.key == "d"
    ]
    return Amounts(perhaps).only()


def find_ring(values: Sequence[Amount]) -> tuple[Amount, Amount] | None:
    """Return the inner and outer radius of a ring that slides on its face, or None."""
    for concept, scale in (("track_radius", 1.0), ("diameter", 0.5)):
        sizes = _lengths(values).of(concept)
        inner, outer = sizes.only("inner_side"), sizes.only("outer_side")
        if inner is None or outer is None or not 0 < inner.si("m") < outer.si("m"):
            continue
        return (
            inner._replace(name="inner_radius", scale=scale),
            outer._replace(name="outer_radius", scale=scale),
        )
    return None


def find_arm(values: Sequence[Amount]) -> Amount | None:
    """Return the lever arm of the torque, if a file states exactly one lever arm."""
    return _lengths(values).only("arm")


def is_at_arm(column: DraftColumn) -> bool:
    """Whether a column's name means a force at the end of a lever arm."""
    return bool(key_pattern("force_at_arm").search(normalise_label(split_name(column.label)[0])))


def confirm_lever_arm_force(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns; a force on a lever arm is certain if the text states the arm."""
    held = [c for c in columns if c.used and c.quantity == "friction_force" and is_at_arm(c)]
    if len(held) != 1 or find_arm(numeric_settings(layout)) is None:
        return list(columns)
    return [c._replace(guessed=(), options=()) if c is held[0] else c for c in columns]


def _lengths(values: Sequence[Amount]) -> Amounts:
    return Amounts(value._replace(to="m") for value in Amounts(values).of(unit="m"))


def _scaled(values: Amounts, name: str, scale: float) -> Amounts:
    return Amounts(value._replace(name=name, scale=scale) for value in values)


def find_load(values: Sequence[Amount]) -> Amount | None:
    """Return the load stated above the table, as a force; None if there are several or none.

    If the text states no load, the load in the file name is used. Zero is not a load.
    """
    contacts = next(filter(None, (contacts_in(v.text) for v in values if not v.own_unit)), 1)
    fitting = Amounts(
        value._replace(
            name="set_normal_force",
            unit=_force_unit(value),
            to=None,
            scale=value.scale * (contacts if value.means("per_contact") else 1),
        )
        for value in Amounts(values).of("load", unit="N")
        # "step 0: no contact (load 0 N)" is no load to divide the friction by
        if value.source != "file name" and (value.source == "step" or value.value != 0)
    )
    if not fitting:
        named = (v for v in values if v.source == "file name" and v.name == "set_normal_force")
        return next(named, None)
    return fitting.only()


def _force_unit(value: Amount) -> str:
    return WEIGHTS.get(value.own_unit or "", value.own_unit or "")


def find_slide_roll_ratio(values: Sequence[Amount]) -> Amount | None:
    """Return the slide-roll ratio that a file states as a number or in per cent, or None."""
    fitting = [v for v in values if not v.own_unit or v.is_in("1")]
    ratio = Amounts(fitting).only("slide_roll_ratio")
    if ratio is None:
        return None
    return ratio._replace(name="slide_roll_ratio_stated", unit=ratio.own_unit or "1", to="1")


def as_entrainment_speed(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns; the speed is the entrainment speed if there is a slide-roll ratio.

    This is a guess unless its name says that it is a mean speed.
    """
    speeds = [c for c in columns if c.used and c.quantity == "sliding_velocity"]
    in_column = any(c.used and c.quantity == "slide_roll_ratio" for c in columns)
    if len(speeds) != 1 or not (in_column or find_slide_roll_ratio(numeric_settings(layout))):
        return list(columns)
    name = split_name(speeds[0].label)[0]
    plain = normalise_label(name)
    if role_of(name) == "set" or part_pattern("of_sliding").search(plain):
        return list(columns)
    sure = part_pattern("of_mean_speed").search(plain)
    mean = speeds[0]._replace(
        quantity="rolling_speed",
        guessed=() if sure else ("it is the mean speed of both surfaces, as a ratio is stated",),
        options=() if sure else ("sliding_velocity",),
    )
    return [mean if column is speeds[0] else column for column in columns]


def stated_rotation(values: Sequence[Amount]) -> Amount | None:
    """Return the only rotation speed that the text states, as a value of the dialect."""
    turns = [value for value in values if _is_rotation(value)]
    return turns[0]._replace(unit="rpm", to="rad/s", name="rotation") if len(turns) == 1 else None


def _is_rotation(value: Amount) -> bool:
    step = value.source == "step" and _STEP.search(value.key) is not None
    named = key_pattern("rotation_speed").search(value.key) is not None
    return (named or step) and is_per_minute(value.own_unit or "")
