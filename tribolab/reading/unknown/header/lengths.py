"""Lengths that a file states of a run: the radius of the track, a ring's sides, an arm."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.lexicon.lexicon import key_pattern, mentions, normalise_label
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_MAX_LINE = 200  # characters of a line that are looked at


def slides_on_rim(layout: Layout) -> bool:
    """Whether a file states that the track is the outside of the rotating part (block on ring)."""
    texts = (layout.file.path.stem, *layout.text_above())
    return any(mentions("slides_on_rim", text[:_MAX_LINE]) for text in texts)


def find_radius(values: Sequence[Amount], *, rim: bool = False) -> Amount | None:
    """Return the radius of the track, if just one of a file's amounts is one, or its diameter.

    It has a `guess` if it is only a radius "R", or the size of what turns. If the track is the
    `rim` of what turns, that size is its radius.
    """
    lengths = _lengths(values).of(but=("other_radius",))
    across = _scaled(lengths.of("diameter"), "track_radius", 0.5)
    radii = lengths.of("track_radius")
    sure = (
        radii.of("on_track")
        or radii.of(but=("turning",))
        or radii.of("of_mean")  # of a ring, the radius at which it rubs
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
    """Return the inner and outer radius of a ring that slides on its face, or their diameters."""
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
    """Return the arm of a torque, if just one of a file's amounts is one."""
    return _lengths(values).only("arm")


def is_at_arm(column: DraftColumn) -> bool:
    """Whether a column's name is a force on an arm, which gives a torque."""
    return bool(key_pattern("force_at_arm").search(normalise_label(split_name(column.label)[0])))


def confirm_lever_arm_force(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Let a force that is named as one on an arm be no guess if the text states the arm."""
    held = [c for c in columns if c.used and c.quantity == "friction_force" and is_at_arm(c)]
    if len(held) != 1 or find_arm(numeric_settings(layout)) is None:
        return list(columns)
    return [c._replace(guessed=(), options=()) if c is held[0] else c for c in columns]


def _lengths(values: Sequence[Amount]) -> Amounts:
    return Amounts(value._replace(to="m") for value in Amounts(values).of(unit="m"))


def _scaled(values: Amounts, name: str, scale: float) -> Amounts:
    return Amounts(value._replace(name=name, scale=scale) for value in values)
