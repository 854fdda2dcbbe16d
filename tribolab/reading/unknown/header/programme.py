"""A table of the steps to come, above the signals: how fast each turns or slides, under which load.

It is used if a column counts the steps.
"""

from __future__ import annotations

import re

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import (
    is_stroke_frequency,
    is_stroke_length,
    matches,
    split_unit,
)
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import converts, is_per_minute
from tribolab.reading.lexicon.lexicon import alternatives, normalise_label
from tribolab.reading.numbers import decimal
from tribolab.reading.text.cells import split_name, split_row
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.unit_names import unit_in_words

_LONGEST = 300  # characters of a line that are looked at
_FEWEST = 2  # steps of a programme
_FIRST = re.compile(
    rf"^\W*(?:{alternatives('step')}|no|nr|n|#)\W*(?:no|nr|number|nummer|#)?\W*$", re.IGNORECASE
)
_NOTHING = re.compile(rf"[-–—*/.]*|{alternatives('nothing')}", re.IGNORECASE)
_DELIMITERS = ("\t", ";", ",", "whitespace")


def find_programme(layout: Layout) -> list[Amount]:
    """Return what a table of steps above the signals says of each, as values of its own.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.

    Returns
    -------
    list of Amount
        With ``source`` "programme": rotations (rad/s), radii (m), speeds (m/s), forces (N), and
        lengths (m) and frequencies (Hz) of strokes.
    """
    lines = [line[:_LONGEST] for line in layout.text_above()]
    for index, line in enumerate(lines):
        for delimiter in _DELIMITERS:
            names = split_row(line, delimiter)
            if len(names) < 2 or not _FIRST.match(names[0]):
                continue
            if _steps_below(lines[index + 1 :], len(names), delimiter) >= _FEWEST:
                cells = list(enumerate(names))[1:]
                patterns = (_pattern(place, len(names), delimiter) for place, _ in cells)
                found = map(_of_cell, (cell for _, cell in cells), patterns)
                return [amount._replace(text=line.strip()) for amount in found if amount]
    return []


def _steps_below(lines: list[str], width: int, delimiter: str) -> int:
    """Return how many rows stand right below that count from one step to the next.

    Each holds numbers, but for marks of what a step has none of, and a last cell of remarks.
    """
    count, before = 0, -1.0
    for line in lines:
        cells = [cell.strip().strip('"') for cell in split_row(line, delimiter)]
        if len(cells) < width or not cells[0].isdigit() or not float(cells[0]) > before:
            break
        own = cells[:width] if _is_number(cells[width - 1]) else cells[: width - 1]
        if not all(_is_number(cell) or _NOTHING.fullmatch(cell) for cell in own):
            break
        if not any(_is_number(cell) for cell in own[1:]):
            break
        count, before = count + 1, float(cells[0])
    return count


def _is_number(cell: str) -> bool:
    return cell[-1:].isdigit() and decimal(cell) == decimal(cell)


def _of_cell(cell: str, pattern: str) -> Amount | None:
    """Return what a column of the programme is, if a run needs it."""
    name, unit = split_name(cell)
    name, unit = (name, unit) if unit is not None else split_unit(cell)
    unit = unit_in_words(unit) if unit else None
    if unit is None:
        return None
    turns = is_per_minute(unit)
    unit = "rpm" if turns else unit
    made = Amount("", pattern, unit, None, "", "programme", unit, key=normalise_label(name))
    if converts(unit, "rad/s") and (turns or not is_stroke_frequency(name, unit)):
        return made._replace(name="rotation", to="rad/s")
    if converts(unit, "rad/s"):
        return made._replace(name="frequency", to="Hz")
    if converts(unit, "m/s"):
        options = matches(name, unit)
        known = options and options[0].quantity in ("sliding_velocity", "set_speed")
        return made._replace(name="set_speed") if known else None
    if converts(unit, "N"):
        return made._replace(name="set_normal_force") if made.means("load") else None
    if converts(unit, "m") and is_stroke_length(name):
        return made._replace(name="stroke", to="m")
    if converts(unit, "m") and made.means("track_radius", "diameter"):
        scale = 0.5 if made.means("diameter") else 1.0
        return made._replace(name="track_radius", to="m", scale=scale)
    return None


def _pattern(place: int, width: int, delimiter: str) -> str:
    """Return what finds the number of a step, and the value that stands in a place of its row."""
    if delimiter == "whitespace":
        gap, cell = r"[ \t]+", r"\S+"
    else:
        mark = escaped(delimiter)
        gap, cell = rf"{mark}[ \t]*", rf"[^{mark}\n]*"
    number = r'"?([-+]?\d[\d.,eE+-]*)"?[ \t]*' if delimiter != "whitespace" else r"([-+]?\d\S*)"
    cells = [number if index == place else cell for index in range(1, width)]
    return rf'^[ \t]*"?(\d+)"?[ \t]*{gap}' + gap.join(cells) + r"[ \t\r]*$"
