"""Units of length stated in lines of text, for heights or positions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import (
    key_pattern,
    known_words,
    normalise_label,
    part_pattern,
    words_of,
)
from tribolab.units.conversion import conversion
from tribolab.units.spellings import unit_of_length

WORD = re.compile(r"[^\W\d_]+")
IN_BRACKETS = re.compile(r"[\[(]\s*$")
_SEPARATED = re.compile(r"(?:[:\uff1a=;,\t\[(]|\s{2})\s*$")
AXES = {"x": "x", "y": "y", "z": "z", "xy": "xy", "yx": "xy", "xyz": "xyz"}


class StatedUnit(NamedTuple):
    """Unit of length stated in a line, with the words before it."""

    words: str
    unit: str


def axes_of(key: str) -> set[str]:
    """Return the axes whose letters are in a name: "Step (X)", "dx", "XY".

    >>> sorted(axes_of("XY unit")), axes_of("delta x"), axes_of("dy [um]")
    (['x', 'y'], {'x'}, {'y'})
    """
    differences = part_pattern("difference")
    words = (re.sub(f"^{differences.pattern}(?=[xyz]+$)", "", word) for word in words_of(key))
    return {axis for word in words if word in AXES for axis in AXES[word]}


def stated_units(text: str) -> Iterator[StatedUnit]:
    """Yield each unit of length in a line with the words before it, except units of numbers.

    >>> [tuple(unit) for unit in stated_units("X e Y em mm, altura Z em um")]
    [('X e Y em ', 'mm'), (', altura Z em ', 'um')]
    >>> [tuple(unit) for unit in stated_units("Height (um) over x (um), 5 mm")]
    [('Height (', 'um'), (') over x (', 'um')]
    """
    begin = 0
    for word in WORD.finditer(text):
        if not (unit := unit_of_length(word[0])):
            continue
        before = text[begin : word.start()]
        bracketed = IN_BRACKETS.search(before) is not None
        before_unit = words_of(before)
        is_in = bool(before_unit) and part_pattern("in").fullmatch(before_unit[-1]) is not None
        of_unit = any(part_pattern("unit").fullmatch(word) for word in before_unit)
        ends = re.match(r"\s*(?:$|[\W_]*$|[\])]|[,;\t(])", text[word.end() :]) is not None
        apart = _SEPARATED.search(before) is not None or is_in or of_unit
        if (
            before_unit
            and not before.rstrip(" [(")[-1:].isdigit()
            and (bracketed or (apart and ends and word[0].lower() != "in"))
        ):
            yield StatedUnit(before, unit)
            begin = word.end()


def is_about_heights(words: str) -> bool:
    """Whether words name the heights: by their axis, or by a word for them."""
    if "z" in axes_of(words):
        return True
    [height] = [word for word in known_words("scan") if word.quantity == "height"]
    name = normalise_label(words)
    return any(stem in name for stem in height.stems) or bool(key_pattern("vertical").search(name))


def height_unit(units: Iterable[StatedUnit]) -> float | None:
    """Return the unit of the heights [m], if exactly one is stated."""
    own: set[float] = set()
    of_all: set[float] = set()
    other: set[float] = set()
    for words, unit in units:
        name, axes = normalise_label(words), axes_of(words)
        if is_about_heights(words) and not axes & {"x", "y"}:
            own.add(metres(unit))
        elif axes or key_pattern("not_height").search(name):
            continue
        else:
            of_unit = part_pattern("unit").search(name)
            (of_all if of_unit else other).add(metres(unit))
    return only_one(own or of_all or other)


def metres(unit: str) -> float:
    """Return a unit of length in m."""
    return conversion(unit, "m")[0]


def only_one(values: set[float]) -> float | None:
    """Return the only value of a set; None if it has none or several."""
    return next(iter(values)) if len(values) == 1 else None
