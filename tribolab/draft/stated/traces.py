"""What the text of a file states of a trace besides its heights: tip, length, number of points."""

from __future__ import annotations

from tribolab.draft.file.layout import Layout
from tribolab.draft.stated.lengths import metres
from tribolab.draft.stated.settings import Amount, numeric_settings
from tribolab.draft.words.stated_words import (
    ACROSS_TIP,
    OF_TRACE,
    PART_OF_TRACE,
    PITCH,
    POINTS,
    PROFILE_LENGTH,
    TIP,
)

_TIPS = (1e-9, 1e-3)  # m, of the smallest and largest radius of a tip


def find_stated(layout: Layout, *, placed: bool) -> list[Amount]:
    """Return what the text before a profile states of it, each under the name that checks know.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    placed
        Whether heights have positions, with which a stated distance can be compared.

    Returns
    -------
    list of Amount
        ``tip_radius``, ``stated_length``, ``stated_pitch`` and ``stated_points``, where they are
        stated just once.
    """
    values = [value for value in numeric_settings(layout, bare=True) if value.source == "preamble"]
    tips = [v for v in values if TIP.search(v.key) and _TIPS[0] < _radius(v) < _TIPS[1]]
    whole = [v for v in values if PROFILE_LENGTH.search(v.key) and metres(v) > 0]
    whole = [v for v in whole if not PART_OF_TRACE.search(v.key) and OF_TRACE.search(v.key)]
    pitches = [v for v in values if placed and PITCH.search(v.key) and metres(v) > 0]
    counts = [v for v in values if v.own_unit is None and POINTS.search(v.key)]
    counts = [v for v in counts if v.number == round(v.number)]
    named = {"stated_length": whole, "stated_pitch": pitches}
    found = [v[0]._replace(name=name, to="m") for name, v in named.items() if len(v) == 1]
    if len(tips) == 1:
        scale = 0.5 if ACROSS_TIP.search(tips[0].key) else 1.0
        found.append(tips[0]._replace(name="tip_radius", to="m", scale=scale))
    if len(counts) == 1:
        found.append(counts[0]._replace(name="stated_points", unit="1", to="1"))
    return found


def _radius(value: Amount) -> float:
    return metres(value) * (0.5 if ACROSS_TIP.search(value.key) else 1.0)
