"""Names of what drives strokes to and fro: their length, half of it, and how often they come."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.file.header import converts
from tribolab.draft.words.roles import without_role
from tribolab.draft.words.words import or_term, squeezed

_END_TO_END = (
    r"(?:peak(?:to|2)?peak|pkpk|pp|endtoend|spitze(?:zu)?spitze|crete(?:a)?crete|pic{1,2}o(?:a)?pic{1,2}o"
    r"|szczytszczyt|vrcholvrchol|huippuhuippu|top(?:til|tot|till)?top(?:p)?|tepedentepeye|размах)"
)
STROKE = or_term(
    rf"^(?:{_END_TO_END})?(?:total|full|whole|set|nominal|gesamt)?(?:stroke|strokelength|slaglengte|hub|hublaenge|course"
    r"|carrera|corsa|curso|skok|zdvih|strok|slaglangd|loekethossz|iskunpituus|ход|行程|ストローク)"
    rf"(?:total|totale|length|laenge|intera|completa|uzunlugu)?(?:{_END_TO_END})?$"
    r"|^(?:longueur|longitud|lunghezza|comprimento|dlugosc|delka|длина)"
    r"(?:dela|de|da|di|do|della)?(?:course|carrera|corsa|curso|skoku|zdvihu|хода)"
    rf"(?:{_END_TO_END})?$|^总?行程长?度?$",
    "stroke",
)
HALF_STROKE = re.compile(
    r"^(?:half(?:the)?stroke(?:length)?|(?:stroke|motion)?amplitude(?:of(?:the)?(?:motion|stroke))?"
    r"|halbhub|demicourse)$"
)
END_TO_END = re.compile(
    r"peak\W?to\W?peak|\bpk\W?pk\b|\bp\W?p\b|spitze\W{1,3}(?:zu\W)?spitze|crête\W{1,2}(?:à\W)?crête"
    r"|pic{1,2}o\W{1,2}(?:a\W)?pic{1,2}o|top\W{1,2}top",
    re.IGNORECASE,
)
FREQUENCY = or_term(
    r"^(?:f|(?:stroke|oscillation|reciprocating|test|drive|motion|hub|schwing|crank)?"
    r"(?:frequency|freq|frequenz|speed|rotation)|频率|周波数"
    r"|(?:frequence|frecuencia|frequenza|frequencia|frequentie|frekvens|frekvence|frekans|taajuus"
    r"|czestotliwosc|frekvencia|частота|주파수)(?:de\w*|di\w*|do\w*|ruchu|pohybu|хода|oscil\w*)?"
    r"|reciprocation|oscillation|strokerate|cyclerate|frequencyof(?:motion|reciprocation))$",
    "frequency",
)


def is_length(name: str) -> bool:
    """Whether a name is that of a stroke's length.

    >>> is_length("Stroke"), is_length("Set stroke length"), is_length("Stroke No")
    (True, True, False)
    """
    return bool(STROKE.search(squeezed(name)) or STROKE.search(squeezed(without_role(name))))


def is_frequency(name: str, unit: str | None) -> bool:
    """Whether a name and a unit are those of how often strokes come.

    >>> is_frequency("Frequency", "Hz"), is_frequency("Speed", "mm/s")
    (True, False)
    """
    return bool(unit and converts(unit, "Hz") and FREQUENCY.search(squeezed(without_role(name))))


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
