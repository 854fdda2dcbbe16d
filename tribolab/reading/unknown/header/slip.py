"""A slide-roll ratio or a rotation stated above a table, and its speed."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.unit_texts import is_per_minute
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, part_pattern, role_of
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.step_marks import STEP_WORD
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_STEP = re.compile(rf"^{STEP_WORD}\d*n?$")


def find_slide_roll_ratio(values: Sequence[Amount]) -> Amount | None:
    """Return the slide-to-roll ratio that a file states as a number or in per cent, or None."""
    fitting = [v for v in values if not v.own_unit or v.is_in("1")]
    ratio = Amounts(fitting).only("slide_roll_ratio")
    if ratio is None:
        return None
    return ratio._replace(name="slide_roll_ratio_stated", unit=ratio.own_unit or "1", to="1")


def as_entrainment_speed(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Take a speed next to a slide-to-roll ratio for the mean one of both surfaces.

    Returns
    -------
    list of DraftColumn
        A speed that no word calls the mean one is a guess.
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
    """Return the one rotation speed that the text states, as a value of the dialect."""
    turns = [value for value in values if _is_rotation(value)]
    return turns[0]._replace(unit="rpm", to="rad/s", name="rotation") if len(turns) == 1 else None


def _is_rotation(value: Amount) -> bool:
    step = value.source == "step" and _STEP.search(value.key) is not None
    named = key_pattern("rotation_speed").search(value.key) is not None
    return (named or step) and is_per_minute(value.own_unit or "")
