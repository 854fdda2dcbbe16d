"""A slide-to-roll ratio that the text above a table states, and whose speed it is of."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import Amount, numeric_settings
from tribolab.io.dialects.cells import split_name
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label, role_of

_RATIO = re.compile(
    r"^(?:srr|slide(?:to)?roll(?:ing)?(?:ratio)?|sliperatio|slipratio|schlupf|gleitrollverhaeltnis"
    r"|tauxdeglissement|rapportglissementroulement|滑滚比|滑滾比|すべり率)\w{0,3}$"
)
_MEAN = re.compile(
    r"mean|average|entrain|roll|mittl|moyen|medi[ao]|sredni|prumern|keskim|gjennomsn|gennemsn|medel|gemiddeld|atlag|ortalama"
    r"|средн|卷吸|平均|引き込み|평균"
)

_OF_SLIDING = re.compile(
    r"slid|gleit|gliss|desliz|strisc|scorr|slizg|kluz|skluz|glid|glij|liuku|csusz|kayma|скольж|滑动|滑り|すべり|미끄"
)


def find_slide_roll_ratio(values: Sequence[Amount]) -> Amount | None:
    """Return the slide-to-roll ratio that a file states as a number or in per cent, or None.

    Parameters
    ----------
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    """
    fitting = [
        value._replace(name="slide_roll_ratio_stated", unit=value.own_unit or "1", to="1")
        for value in values
        if _RATIO.search(value.key) and (not value.own_unit or converts(value.own_unit, "1"))
    ]
    return fitting[0] if len(fitting) == 1 else None


def as_entrainment_speed(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Take a speed beside a slide-to-roll ratio for the mean one of both surfaces.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.

    Returns
    -------
    list of DraftColumn
        A speed that no word calls the mean one is a guess.
    """
    speeds = [c for c in columns if c.used and c.quantity == "sliding_velocity"]
    in_column = any(c.used and c.quantity == "slide_roll_ratio" for c in columns)
    if len(speeds) != 1 or not (
        in_column or find_slide_roll_ratio(numeric_settings(layout)) is not None
    ):
        return list(columns)
    name = split_name(speeds[0].label)[0]
    if role_of(name) == "set" or _OF_SLIDING.search(normalise_label(name)):
        return list(columns)
    sure = _MEAN.search(normalise_label(name)) is not None
    mean = speeds[0]._replace(
        quantity="rolling_speed",
        guessed=() if sure else ("it is the mean speed of both surfaces, as a ratio is stated",),
        options=() if sure else ("sliding_velocity",),
    )
    return [mean if column is speeds[0] else column for column in columns]
