"""Numbers with a unit inside sentences: "ring on disc, mean track radius 21.5 mm"."""

from __future__ import annotations

import re
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import (
    CLAUSE_END,
    alternatives,
    key_pattern,
    normalise_label,
    plain_text,
    plain_words,
    text_pattern,
)
from tribolab.reading.numbers import NUMBER, Number, decimal, number_pattern, numbers_in
from tribolab.reading.unit_texts import is_unit

LONGEST_LINE = 300  # characters of a line that are inspected
_MAX_OF_LINE = 8  # numbers of a line that are returned
_CAPITALS = 3  # fewest letters of a unit that may be written in capitals: LBF
_ENDS = " \t:=~≈＝：-–"
_CLAUSES = re.compile(
    rf"{CLAUSE_END}|\b(?:(?<!load )(?<!force )(?<!weight )on|{alternatives('clause')})\b"
)
_LABEL = re.compile(r"\W*(?P<label>[^\W\d][^:;=\t：；]{0,40}?)[\s\"]*[:;=\t：；]")
_TIMES_SIGNS = ("x", "X", "×")
_SINGLE = re.compile(
    rf"\W*(?P<key>[^\W\d][^:=\t;,\d]{{0,60}}?)\s*[:=\t;, ]\s*[x×]?\s?(?P<number>{NUMBER})"
    r"\s?(?P<unit>[x×]|[^\W\d]{1,12})?\W*(?:[(（].{0,80})?$",
    re.IGNORECASE,
)


class Phrase(NamedTuple):
    """Number with a unit in a line; `key` is the normalised text before it in the same clause."""

    key: str
    number: str
    unit: str
    pattern: str
    line: str


def phrases(line: str) -> list[Phrase]:
    """Return the numbers with units in a line of text, in order.

    Examples
    --------
    >>> [(said.key, said.number, said.unit) for said in phrases("mean radius 2 cm on a 50 mm disc")]
    [('meanradius', '2', 'cm'), ('', '50', 'mm')]
    >>> phrases("Comment: step 0 = head lifted")
    []
    """
    said: list[Phrase] = []
    done = 0
    line = line[:LONGEST_LINE].strip()
    for number in numbers_in(line):
        unit = _unit_of(number)
        if not unit or len(said) == _MAX_OF_LINE:
            continue
        before = line[done : number.start].rstrip(_ENDS)
        clauses = [clause for clause in _CLAUSES.split(before) if clause.strip()]
        words = (normalise_label(word) for word in clauses[-1].split()) if clauses else ()
        key = "".join(word for word in words if word not in plain_words("little"))
        if key_pattern("size_alone").search(key) and label_of(line):  # "Shaft: Ø 80 mm"
            key = f"{label_of(line)}diameter"
        behind = line[number.end :][:20]
        if re.match(r"\s?o\.?d\b", behind, re.IGNORECASE):
            key += "od"
        elif text_pattern("diameter_behind").match(plain_text(behind).lstrip()):
            key += "diameter"
        pattern = number_pattern(line[: number.start])
        said.append(Phrase(key, number.text, unit, pattern, line))
        done = number.end
    return said


def _unit_of(number: Number) -> str:
    """Return the unit of a number, LBF as lbf; "" if the word after the number is no unit."""
    for unit in (number.unit, number.unit.partition("/")[0]):
        unit = unit if len(unit) < _CAPITALS or is_unit(unit) else unit.lower()
        if unit and is_unit(unit):
            return unit
    return ""


def label_of(line: str) -> str:
    """Return the normalised label at the start of a line, before a colon or delimiter; else "".

    >>> label_of("Shaft: steel, Ø 80 mm"), label_of('"Anneau";"acier 4620"'), label_of("Ø 80 mm")
    ('shaft', 'anneau', '')
    """
    label = _LABEL.match(line[:LONGEST_LINE])
    return normalise_label(label["label"]) if label else ""


def single_number(line: str) -> tuple[str, float, str] | None:
    """Return label, number and following word of a line with exactly one number; else None.

    >>> single_number("Gain x 2,5 (set)"), single_number("Averaging: 8 samples")
    (('Gain', 2.5, ''), ('Averaging', 8.0, 'samples'))
    >>> single_number("12:30 Gain 5")
    """
    match = _SINGLE.match(line)
    if match is None:
        return None
    unit = match["unit"] or ""
    return match["key"], decimal(match["number"]), "" if unit in _TIMES_SIGNS else unit
