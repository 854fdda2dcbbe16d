"""Names of what drives strokes to and fro: their length, half of it, and how often they come."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.words.stated_words import FREQUENCY, STROKE
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label, without_role

END_TO_END = re.compile(
    r"peak\W?to\W?peak|\bpk\W?pk\b|\bp\W?p\b|spitze\W{1,3}(?:zu\W)?spitze|crête\W{1,2}(?:à\W)?crête"
    r"|pic{1,2}o\W{1,2}(?:a\W)?pic{1,2}o|top\W{1,2}top",
    re.IGNORECASE,
)


def is_length(name: str) -> bool:
    """Whether a name is that of a stroke's length.

    >>> is_length("Stroke"), is_length("Set stroke length"), is_length("Stroke No")
    (True, True, False)
    """
    return bool(
        STROKE.search(normalise_label(name)) or STROKE.search(normalise_label(without_role(name)))
    )


def is_frequency(name: str, unit: str | None) -> bool:
    """Whether a name and a unit are those of how often strokes come.

    >>> is_frequency("Frequency", "Hz"), is_frequency("Speed", "mm/s")
    (True, False)
    """
    return bool(
        unit and converts(unit, "Hz") and FREQUENCY.search(normalise_label(without_role(name)))
    )


def lengths_beside_frequencies(named: Sequence[tuple[str, str | None]]) -> set[int]:
    """Return the places of columns that hold lengths of strokes and no positions.

    Parameters
    ----------
    named
        Names and units of the columns.

    Returns
    -------
    set
        From 0; empty unless another column says how often the strokes come.
    """
    if not any(is_frequency(name, unit) for name, unit in named):
        return set()
    return {place for place, (name, _) in enumerate(named) if is_length(name)}
