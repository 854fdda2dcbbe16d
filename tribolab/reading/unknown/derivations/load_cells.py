"""Loads that several cells carry together: left and right, A and B, 1 and 2."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.quantities import unit_conversion
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.header.load import find_load, stated_number
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn

_LONGEST = 300  # characters of a line or name that are looked at
ADDS = "one of several loads that add up"
# endings or beginnings of names: of the first and of the other; whether they surely carry together
_SIDES = (
    (
        "left|links|li|l|gauche|sinistr[ao]|sx|izq\\w*|izquierd[ao]|venster|vanster|лев\\w*|左",
        "right|rechts|re|r|droite?|destr[ao]|dx|der\\w*|derech[ao]|hoger|hoeger|прав\\w*|右",
        True,
    ),
    ("front|vorne?|avant|前", "rear|back|hinten|arriere|后|後", True),
    ("a", "b", False),
    ("1|i|one", "2|ii|two", False),
)
_SUM = re.compile(
    r"\bsum(?:me|s|a|ma|men)?\b|\bsumm(?:an|e|ed|iert)\b|\badd(?:ed|s)?\b|together"
    r"|\bin total\b|\btotal (?:normal )?load|zusammen|addier|gesamtlast"
    r"|somme|ensemble|somma|insieme|suma\b|juntos|soma\b|tillsammans|summen|samen|yhteens|razem|součet|spolu"
    r"|összeg|toplam|сумм|вместе|之和|总和|合计|合計|総和|합계",
    re.IGNORECASE,
)
_SAME = 0.2  # of a stated load


def adding_up(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Let two loads whose names are those of sides be the normal force together.

    Names of sides say so, and so does a text that speaks of their sum, or a stated load that is it;
    of others it is asked. Where the stated load is that of each, they do not add up.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    loads = [c for c in columns if _is_load(c)]
    pairs = [
        (one, other, sure)
        for one in loads
        for other in loads
        for sure in [_are_sides(one, other)]
        if sure is not None and one.read_unit == other.read_unit
    ]
    others = [c for c in columns if c.used and c.quantity == "normal_force"]
    if len(pairs) != 1 or any(c not in pairs[0] for c in others):
        return list(columns)
    one, other, sure = pairs[0]
    told = _told_by_load(layout, (one, other), numbers)
    if told is False:
        return list(columns)
    sure = sure or bool(told) or any(_SUM.search(t[:_LONGEST]) for t in layout.text_above())
    guess = f"the normal force is the sum of columns {one.place} and {other.place}"
    plain = {
        c.place: c._replace(
            quantity="normal_force", used=False, guessed=(), options=(), fill_in="", note=ADDS
        )
        for c in (one, other)
    }
    if not sure:
        plain[one.place] = plain[one.place]._replace(
            guessed=(guess,), options=(f"column {one.place}", f"column {other.place}")
        )
    return [plain.get(c.place, c) for c in columns]


def loads_that_add(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns of loads that add up, as they stand in a formula.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    return [
        c._replace(unit=unit if say else None)
        for c in columns
        if not c.used and c.note == ADDS
        for _, unit, say in [bare_name(c)]
    ]


def _is_load(column: DraftColumn) -> bool:
    name, unit, _ = bare_name(column)
    if not column.label or unit is None or len(name) > _LONGEST or not converts(unit, "N"):
        return False
    for called in (name, re.sub(r"[\W_]*[^\W_]{1,2}$", "", name)):
        options = matches(called, unit)
        if options and options[0].quantity == "normal_force":
            return True
    return False


def _are_sides(one: DraftColumn, other: DraftColumn) -> bool | None:
    """Whether two names differ by their sides alone, and surely mean them; None if they do not."""
    names = [normalise_label(bare_name(c)[0]) for c in (one, other)]
    for first, second, sure in _SIDES:
        for form in (r"^(?P<rest>.{{2,}}?)(?:{})$", r"^(?:{})(?P<rest>.{{2,}})$"):
            told = [
                re.match(form.format(p), n) for p, n in zip((first, second), names, strict=True)
            ]
            if told[0] and told[1] and told[0]["rest"] == told[1]["rest"]:
                return sure
    return None


def _told_by_load(
    layout: Layout, pair: tuple[DraftColumn, DraftColumn], numbers: np.ndarray
) -> bool | None:
    """Whether a stated load is the sum of both (True) or that of each (False); None if neither."""
    load = find_load(numeric_settings(layout))
    if load is None:
        return None
    stated = stated_number(load) * unit_conversion(load.unit or "N", "normal_force")[0]
    scale = unit_conversion(bare_name(pair[0])[1] or "N", "normal_force")[0]
    both = [scale * np.abs(numbers[:, c.place - 1]) for c in pair]
    sizes = [float(np.nanpercentile(values, 75)) for values in (both[0] + both[1], *both)]
    near = [abs(size - stated) < _SAME * stated for size in sizes]
    return True if near[0] else False if near[1] and near[2] else None
