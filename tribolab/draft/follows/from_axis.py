"""The radius of a track as the distance of a stage from the axis, whose place the text states."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.reading.interpret.unit_texts import converts
from tribolab.units import conversion

_LONGEST = 400  # characters of a line that are looked at
_AXIS = re.compile(
    r"\baxis\b|\baxle\b|cent(?:er|re)\b|\bspindle\b|achse|mittelpunkt|zentrum|drehpunkt|\baxe\b|\bcentr[eo]\b|\beje\b"
    r"|\basse\b|\beixo\b|\bas\b|centrum|oś\b|\bos[ay]\b|středu?|ось|оси|центр|轴心|轴线|中心|回転軸|축",
    re.IGNORECASE,
)
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?"


class FromAxis(NamedTuple):
    """A radius by a column of places: the column, the formula of it as "stage", and the line."""

    column: DraftColumn
    formula: str
    text: str


def radius_from_axis(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> FromAxis | None:
    """Return the radius that a column of places has, where the text says at which the axis is.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    found = []
    for column in columns:
        name, unit, say = bare_name(column)
        if column.used or not name or unit is None or not converts(unit, "m"):
            continue
        at = re.compile(
            rf"(?<![^\W_]){re.escape(name)}\s*(?:=|:|at|is|bei|von|à|en|a)\s*(?P<number>{_NUMBER})\s?(?P<unit>[^\W\d_]{{1,2}})(?![^\W_])",
            re.IGNORECASE,
        )
        for line in layout.text_above():
            told = at.search(line[:_LONGEST])
            if told is None or not converts(told["unit"], "m"):
                continue
            clause = re.split(r"[.;]\s", line[: told.start()])[-1]
            if _AXIS.search(clause):
                found.append((column, unit if say else None, unit, told, line.strip()))
    if len(found) != 1:
        return None
    column, own, unit, told, text = found[0]
    place = float(told["number"].replace(",", "."))
    scale = conversion(unit, "m")[0]
    apart = scale * numbers[:, column.place - 1] - place * conversion(told["unit"], "m")[0]
    stated = f"'{told['number'].replace(',', '.')} {told['unit']}'"
    formula = f"(stage - {stated})" if np.nanmedian(apart) > 0 else f"({stated} - stage)"
    return FromAxis(column._replace(unit=own), formula, text)
