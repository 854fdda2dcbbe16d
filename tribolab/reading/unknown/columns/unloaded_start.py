"""Words that the beginning of a record is without contact: there the sensors show their zero."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.reading.interpret.phrases import phrases
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import key_pattern, says
from tribolab.reading.numbers import decimal, numbers_in
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.header.zero import find_zero, zero_in_doubt
from tribolab.reading.unknown.layout.step_marks import STEP_WORD
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.unit_names import unit_in_words
from tribolab.units import conversion

_LONGEST = 300  # characters of a line that are looked at
_FEWEST = 20  # samples that tell a zero
_LEFT = 0.12  # of the highest signal: so far from its first level, and there is contact
_SAFE = 0.9  # of the stretch: a load comes on gradually
_STEP_ZERO = re.compile(rf"{STEP_WORD}\W{{0,3}}0(?!\d)", re.IGNORECASE)
_ROW = re.compile(r"\s*\"?(?P<number>[01])\"?\s*[,;\t]")  # of a programme: its first step


def unloaded_words(layout: Layout) -> str:
    """Return the line that says that a record begins without contact; "" if none does.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    """
    for line in layout.text_above():
        text = line.strip()[:_LONGEST]
        begins = says("at_start", text) or _STEP_ZERO.search(text)
        if _says_unloaded(text) and (begins or _ROW.match(text)):
            return text
        # "first 3 s at rest, string slack (zero of the cell)"
        if begins and says("zero_word", text) and _lasts(text):
            return text
    return ""


def _says_unloaded(text: str) -> bool:
    """Whether a line says that nothing presses: in words, or as a load of zero.

    >>> [_says_unloaded(line) for line in ("step 0: load 0 N", "no load cell", "no load")]
    [True, False, True]
    """
    if says("without_contact", text.replace("load cell", "loadcell")):
        return True
    load = key_pattern("load")
    return any(decimal(said.number) == 0 and load.search(said.key) for said in phrases(text))


def with_zero(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Say where the zero of friction, or of a torque, is read, if words tell that there is none.

    Where the load is measured it tells the same, and all along the run.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    held = {c.quantity for c in columns if c.used or c.quantity == "normal_force"}
    line = unloaded_words(layout)
    force = next((c for c in columns if c.used and c.quantity == "friction_force"), None)
    signal = force or (None if "friction_coefficient" in held else torque_of(columns))
    if not line or signal is None or "normal_force" in held:
        return list(columns)
    values = numeric_settings(layout)
    unit = "N" if force is not None else "N m"
    stated = find_zero(layout, values, unit) or zero_in_doubt(layout, values, unit)
    if stated is not None and not says("zero_not_taken_off", line):
        return list(columns)
    rows = _still_unloaded(numbers[:, signal.place - 1])
    time = next((c for c in columns if c.used and c.quantity == "time" and not c.form), None)
    if time is not None and (lasts := _lasts(line)):
        clock = numbers[:, time.place - 1] * conversion(time.read_unit or "s", "s")[0]
        rows = min(rows, int(np.searchsorted(clock[:rows] - clock[0], lasts)))
    rows = int(_SAFE * rows)
    if rows < _FEWEST:
        return list(columns)
    told = signal._replace(zero=f"first {rows} samples", note=f"its zero is there: '{line}'")
    return [told if c.place == signal.place else c for c in columns]


def _lasts(line: str) -> float:
    """Return how long [s] a line says that something lasts; 0 if it does not say it once.

    >>> _lasts("first 10 s without load"), _lasts("begins unloaded")
    (10.0, 0.0)
    """
    said = [(n.value, unit_in_words(n.unit)) for n in numbers_in(line)]
    told = [(number, unit) for number, unit in said if converts(unit, "s")]
    return told[0][0] * conversion(told[0][1], "s")[0] if len(told) == 1 else 0.0


def _still_unloaded(signal: np.ndarray) -> int:
    """Return how many samples pass before a signal leaves the level that it begins with."""
    level = float(np.nanmedian(signal[:_FEWEST]))
    away = np.abs(signal - level)
    highest = float(np.nanpercentile(away, 90)) if np.isfinite(away).any() else 0.0
    left = away > _LEFT * highest
    # a spike is no contact: five in a row are
    held = np.convolve(left, np.ones(5), "valid") >= 5
    return int(np.argmax(held)) if highest > 0 and held.any() else 0
