"""A table of the steps to come, above the signals: how fast each turns or slides, under which load.

It is used where a column counts the steps.
"""

from __future__ import annotations

import re

from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.stated.settings import Amount
from tribolab.draft.words.stated_words import ACROSS, LOAD, PER_MINUTE, RADIUS
from tribolab.draft.words.strokes import is_frequency, is_length
from tribolab.io.dialects.cells import split_name, split_row
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.unit_names import unit_in_words

_LONGEST = 300  # characters of a line that are looked at
_FEWEST = 2  # steps of a programme
_FIRST = re.compile(
    rf"^\W*(?:{STEP_WORD}|no|nr|n|#)\W*(?:no|nr|number|nummer|#)?\W*$", re.IGNORECASE
)
_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?")
_SAID = {"m/s": "set_speed", "N": "set_normal_force"}
_TO = {"rad/s": "rotation", "m": "track_radius"}  # names of what is no quantity
_NOTHING = re.compile(r"[-–—*/.]*|n/?a|none|off|無|无|なし", re.IGNORECASE)
_DELIMITERS = ("\t", ";", ",", "whitespace")


def find_programme(layout: Layout) -> list[Amount]:
    """Return what a table of steps above the signals says of each, as values of its own.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.

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
                return _values(line.strip(), names, delimiter)
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
        own = cells[:width] if _NUMBER.fullmatch(cells[width - 1]) else cells[: width - 1]
        if not all(_NUMBER.fullmatch(cell) or _NOTHING.fullmatch(cell) for cell in own):
            break
        if not any(_NUMBER.fullmatch(cell) for cell in own[1:]):
            break
        count, before = count + 1, float(cells[0])
    return count


def _values(line: str, names: list[str], delimiter: str) -> list[Amount]:
    found = []
    for place, cell in enumerate(names[1:], start=1):
        name, unit = split_name(cell)
        name, unit = (name, unit) if unit is not None else split_unit(cell)
        unit = unit_in_words(unit) if unit else None
        turns = unit is not None and PER_MINUTE.fullmatch(unit)
        unit = "rpm" if turns else unit
        to = next((si for si in ("rad/s", "m/s", "N", "m") if unit and converts(unit, si)), None)
        key = normalise_label(name)
        if unit is None or to is None or (to == "N" and not LOAD.search(key)):
            continue
        kind = _TO.get(to, "")
        if to == "rad/s" and not turns and is_frequency(name, unit):
            to, kind = "Hz", "frequency"  # of strokes
        elif to == "m" and is_length(name):
            kind = "stroke"
        elif to == "m" and not (RADIUS.search(key) or ACROSS.search(key)):
            continue
        options = matches(name, unit)
        known = options[0].quantity if options else ""
        if to == "m/s" and known not in ("sliding_velocity", "set_speed"):
            continue
        found.append(
            Amount(
                _SAID.get(to) or kind,
                _pattern(place, len(names), delimiter),
                unit,
                None if to in _SAID else to,
                line,
                source="programme",
                own_unit=unit,
                scale=0.5 if kind == "track_radius" and ACROSS.search(key) else 1.0,
                key=key,
            )
        )
    return found


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
