"""Numbers with a unit inside sentences of a header: "ring on disc, mean track radius 21.5 mm"."""

from __future__ import annotations

import re
from typing import NamedTuple

from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import is_unit
from tribolab.reading.lexicon.lexicon import normalise_label

_LONGEST = 300  # characters of a line that are looked at
_MOST = 8  # numbers of a line
_NUMBER = re.compile(
    r"(?<![\d.,A-Za-z_])(?P<number>[-+]?\d[\d.,]*(?:[eE][-+]?\d+)?)\s{0,3}"
    r"(?P<unit>[^\W\d_][^\s;,:()\[\]\"，；：（）、。]*|%|°[A-Za-z]?)"
)
_CUTS = re.compile(
    r"[;:,=|()\[\]：；，（）、。]|\.\s+(?=[^\W\d_a-zа-яё])"
    r"|\b(?:at|(?<!load )(?<!force )(?<!weight )on|and|with|bei|und|mit|et|con|avec)\b"
)
_ACROSS_BEHIND = re.compile(
    r"\s?(?:(o\.?d\b)|in dia|dia(?:m\w*)?\b|ø|⌀|durchm|di[aá]met)", re.IGNORECASE
)
_SIZE = re.compile(
    r"oe|⌀|dia|cap|capi|halkaisija|atmero|diam|diamet\w{1,3}|durchmesser|srednica|prumer|aussendurchmesser|外径|直径"
)
_LABEL = re.compile(r"\W*(?P<label>[^\W\d][^:;=\t：；]{0,40}?)[\s\"]*[:;=\t：；]")
_CAPITALS = 3  # letters of a unit that may be written large
_ENDS = " \t:=~≈＝：-–"
_LITTLE = frozenset(
    "a an the of is was are be in to about approx ca von ist war der die das de du des la le les "
    "el di del della il est era es under unter bajo sous sotto nominal constant konstante".split()
)
_POINTS = r"(?:points?|pts?|samples?|Punkte|punten|puntos|punti|pontos|pixels?|px)"
_UNIT_OF_LENGTH = r"(?P<unit>um|µm|μm|mm|nm)\b"
_PER = r"\s?(?:/|per|pro|par|por)\s?"
_PER_LENGTH = re.compile(
    rf"(?<![\d.,A-Za-z_])(?P<number>\d[\d.,]*)\s{{0,3}}{_POINTS}?{_PER}{_UNIT_OF_LENGTH}",
    re.IGNORECASE,
)
_LENGTH_HAS = re.compile(  # "Points per mm: 2000"
    rf"{_POINTS}{_PER}{_UNIT_OF_LENGTH}\W{{0,3}}[:=\t; ]\s*(?P<number>\d[\d.,]*)\s*$",
    re.IGNORECASE,
)


class Phrase(NamedTuple):
    """A number that a line of text states: what it calls it, its unit, a pattern that finds it.

    `key` is squeezed; it holds the words before the number, back to where another clause ends.
    """

    key: str
    number: str
    unit: str
    pattern: str
    line: str


def phrases(line: str) -> list[Phrase]:
    """Return the numbers with a unit that stand inside a line of text.

    Parameters
    ----------
    line
        One line above the table.

    Returns
    -------
    list of Phrase
        In the order of the line.

    Examples
    --------
    >>> [(said.key, said.number, said.unit) for said in phrases("mean radius 2 cm on a 50 mm disc")]
    [('meanradius', '2', 'cm'), ('', '50', 'mm')]
    >>> phrases("Comment: step 0 = head lifted")
    []
    """
    said: list[Phrase] = []
    done = 0
    line = line[:_LONGEST].strip()
    for match in _NUMBER.finditer(line):
        unit = match["unit"].rstrip(".!?")
        unit = unit if len(unit) < _CAPITALS or is_unit(unit) else unit.lower()  # "30 LBF"
        if len(said) == _MOST or not is_unit(unit):
            continue
        before = line[done : match.start()].rstrip(_ENDS)
        clauses = [clause for clause in _CUTS.split(before) if clause.strip()]
        words = clauses[-1] if clauses else ""
        key = "".join(
            normalise_label(w) for w in words.split() if normalise_label(w) not in _LITTLE
        )
        if _SIZE.fullmatch(key):  # "Shaft: Ø 80 mm" is that of the shaft
            key = f"{label_of(line)}diameter" if label_of(line) else key
        if behind := _ACROSS_BEHIND.match(line[match.end() :][:20]):
            key += "od" if behind[1] else "diameter"
        number = match["number"].rstrip(".,")
        said.append(Phrase(key, number, unit, pattern_behind(line[: match.start()]), line))
        done = match.end()
    return said


def label_of(line: str) -> str:
    """Return what stands before the first colon or cell of a line, squeezed; "" if nothing does.

    >>> label_of("Shaft: steel, Ø 80 mm"), label_of('"Anneau";"acier 4620"'), label_of("Ø 80 mm")
    ('shaft', 'anneau', '')
    """
    label = _LABEL.match(line[:_LONGEST])
    return normalise_label(label["label"]) if label else ""


def points_per_length(line: str) -> tuple[float, str] | None:
    """Return how many points of a profile a length has, and the length's unit, if a line says so.

    Parameters
    ----------
    line
        One line above the table.

    Examples
    --------
    >>> points_per_length("sampling 4 points/um")
    (4.0, 'um')
    >>> points_per_length("Punten per mm: 2000")
    (2000.0, 'mm')
    """
    match = _PER_LENGTH.search(line[:_LONGEST]) or _LENGTH_HAS.search(line[:_LONGEST])
    if match is None:
        return None
    try:
        number = float(match["number"].rstrip(".,").replace(",", "."))
    except ValueError:
        return None
    return (number, match["unit"]) if number > 0 else None


def pattern_behind(before: str) -> str:
    """Return a pattern for the number behind a line's beginning, in which numbers may be others.

    >>> re.search(pattern_behind("# cell 2: "), "# cell 3: 4.5 N")[1]
    '4.5'
    """
    parts = re.split(r"\d[\d.,]*", before.strip())
    return r"^\s*" + r"[\d.,]+".join(map(escaped, parts)) + r"\s*([-+]?\d[\d.,]*(?:[eE][-+]?\d+)?)"
