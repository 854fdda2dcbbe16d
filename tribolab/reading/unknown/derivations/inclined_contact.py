"""Inclined contacts, whose normal forces differ from the axial force.

For a ball on three plates or on three balls, the sum of the normal forces is the axial force
divided by the cosine of the angle between contact normals and axis.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.lexicon.lexicon import normalise_label, part_pattern, plain_text
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_DIAMETERS = ("d", "dia", "diameter", "durchmesser")
_OTHER_ANGLE = re.compile(r"(?<![\d.,])(?!45(?!\d))\d{2}(?:[.,]\d+)?\s?(?:°(?!\s?[CFK])|º|deg)")
# cosine and sine of the angle between contact normals and axis: the centres of four equal
# balls form a regular tetrahedron; plates and pyramids have 45 degrees (Anton Paar BC 12.7)
_ANGLES = {
    "four_ball": (math.sqrt(2 / 3), math.sqrt(1 / 3)),
    "three_plates": (math.sqrt(1 / 2), math.sqrt(1 / 2)),
    "inclined": (0.0, 0.0),
}


class Inclined(NamedTuple):
    """Inclined contacts: the text that states them, and cosine and sine of their angle to the axis.

    If the angle is unknown, both are 0 and `guess` is a question to the user.
    """

    text: str
    cosine: float
    sine: float
    guess: str = ""


def find_inclined(layout: Layout) -> Inclined | None:
    """Return the inclined contacts that the text above the table or the file name states."""
    texts = {text: plain_text(text) for text in layout.named_sentences}
    for kind, (cosine, sine) in _ANGLES.items():
        text = next((t for t, words in texts.items() if _pattern(kind).search(words)), "")
        if text and cosine and not (kind == "three_plates" and _OTHER_ANGLE.search(text)):
            return Inclined(text, cosine, sine)
        if text:
            guess = (
                f"'{shown(text, 40)}': the load on inclined contacts is the axial force over the "
                "cosine of their angle; the force is read as it stands"
            )
            return Inclined(text, 0.0, 0.0, guess)
    return None


@functools.cache
def _pattern(kind: str) -> re.Pattern[str]:
    """Return a pattern that finds a kind of contact in plain text: "ball on 3 plates"."""
    named = part_pattern(kind).pattern
    if kind == "four_ball":  # but not a bearing with four balls
        named = rf"{named}(?!s)(?!\w* (?:bearing|lager|screw))"
    return re.compile(rf"(?<!\w){named}")


def axial_force_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only load column if it is the axial force rather than the contacts' own."""
    held = [c for c in columns if c.used and c.quantity == "normal_force" and not c.optional]
    on_contacts = part_pattern("on_contacts")
    named = [c for c in held if not on_contacts.search(normalise_label(bare_name(c)[0]))]
    return named[0] if len(held) == len(named) == 1 else None


def _has_gap(columns: Sequence[DraftColumn]) -> bool:
    """Whether any column is the gap of a rheometer."""
    gap = part_pattern("gap")
    lengths = (bare_name(c) for c in columns)
    return any(
        gap.fullmatch(normalise_label(name)) and converts(unit or "", "m")
        for name, unit, _ in lengths
    )


def guesses_of_inclined(layout: Layout, columns: Sequence[DraftColumn]) -> list[str]:
    """Return guesses about the load of inclined contacts; empty if the load is known.

    A rheometer, which records its gap, measures the axial force. Its own coefficient allows for
    the angle, its normal force does not. File: an Anton Paar MCR, "Normal Force", "Torque", "Gap".
    """
    inclined = find_inclined(layout)
    held = {column.quantity for column in columns if column.used}
    if inclined is None and torque_of(columns) is not None and _has_gap(columns):
        axial = axial_force_of(columns)
        pattern = part_pattern("flat_contact")
        flat = any(pattern.search(plain_text(text)) for text in layout.named_sentences)
        name = shown(bare_name(axial)[0], 30) if axial is not None else ""
        said = (
            f"'{name}' is the load on the contact (if it is a ball on three plates, or a ball on "
            "disc, say so in the file's name)"
        )
        return [said] if axial is not None and not flat else []
    if inclined is None or "friction_coefficient" in held:
        return []
    if inclined.guess:
        return [inclined.guess]
    if "friction_force" in held and axial_force_of(columns) is not None:
        where = shown(inclined.text, 40)
        return [f"'{where}': the normal force is the axial one, of which the contacts carry more"]
    return []


def radius_of_ball(values: Sequence[Amount]) -> Amount | None:
    """Return the ball radius if exactly one radius or diameter of the ball is stated."""
    ball = part_pattern("contact_ball")
    sizes = [v for v in values if v.unit and converts(v.unit, "m")]
    sizes = [v for v in sizes if ball.search(v.key) or v.key in _DIAMETERS]
    if len(sizes) != 1:
        return None
    radius = sizes[0]._replace(name="ball_radius", to="m")
    return radius if re.search("radi|rayon", radius.key) else radius._replace(scale=0.5)
