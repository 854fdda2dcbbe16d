"""What the text above a table states of levers, gains and contacts: a factor signals may miss."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.counts import WORTH
from tribolab.draft.words.levers import weight_on_lever
from tribolab.draft.words.sentences import phrases
from tribolab.draft.words.stated_words import LOAD
from tribolab.errors import shown
from tribolab.reading.lexicon.lexicon import normalise_label

_LONGEST = 200  # characters of a line that are looked at
_MOST_CONTACTS = 12
_FACTOR = re.compile(
    r"lever|hebel|arm\w*ratio|ratio\w*arm|levier|palanca|leva(?!l)|mechanicaladvantage"
    r"|scal(?:e|ing)(?:factor)?(?!d)|gain|multiplier|amplification|calibrationfactor|calfactor"
    r"|verstaerk|skalierung|kalibrierfaktor|倍率|增益|増幅|アンプ|放大|amplif|forstaerk|foerstaerk|forsterk"
    r"|vahvist|wzmocn|zesil|erosit|kazanc|усилен"
)
_RATIO = re.compile(
    r"ratio|transmission|uebersetzung|untersetzung|rapport|relacion|rapporto|比|gear|getriebe|reduc"
    r"|reduktor|riduz|riduttore|prevod|przeloz|przeklad|vaihde|valitys|utvaexl|utveksling|gearing|attetel"
    r"|aktarma|disli|передат|редукт|减速|変速|减速|増速"
)
_GEAR = re.compile(r"reduc|gear|getriebe|untersetz|uebersetz|riduz|reduktor|przeloz|减速|減速")
_NUMBER = r"\d+(?:[.,]\d+)?"
_ONE_TO = re.compile(rf"(?<![\d:.,])(?P<one>{_NUMBER})\s?:\s?(?P<other>{_NUMBER})(?![\d:])")
# "Multiply friction force by 1.25", "Kraft mit 2,5 multiplizieren"
_TIMES = re.compile(
    rf"(?:multipl|divid|scal)\w*\b[^\d.;]{{0,60}}?\b(?:by|with|mit|durch|par|por|per)\s?(?P<number>{_NUMBER})"
    rf"|\b(?:mit|durch)\s?(?P<before>{_NUMBER})\s\w{{0,12}}\s?(?:zu\s)?(?:multiplizier|dividier)",
    re.IGNORECASE,
)
_PLAIN = re.compile(
    rf"\W*(?P<key>[^\W\d][^:=\t;,\d]{{0,60}}?)\s*[:=\t;, ]\s*[x×]?\s?(?P<number>{_NUMBER}"
    r"(?:[eE][-+]?\d+)?)\s?[x×]?\W*(?:[(（].{0,80})?$",
    re.IGNORECASE,
)
_BODIES = (
    r"(?:contacts?|contact (?:points|pairs|spots)|pins|shoes|rollers|pads|balls|blocks|sliders"
    r"|kontakte?|kontaktstellen|stifte|kugeln|kl[öo]tze|pions|billes|patins|contactos|bolas"
    r"|patines|contatti|perni|sfere|pattini|接触点|销)"
)
_OF = r"(?:of|de|der|des|di|dei|delle)?"
_COUNT = rf"(?:numbers?|no|nr|n|n°|nº|num|#|anzahl|zahl|nombre|nb|n[úu]mero)\.?\s?{_OF}\s?(?:the )?"
_CONTACTS = re.compile(
    rf"(?:{_COUNT}{_BODIES}|^\W*{_BODIES})\s*[:=\t;, ]\s*(?P<after>\d{{1,2}})\W*$"
    rf"|(?<![\d.,])(?P<before>\d{{1,2}})\s{_BODIES}\b",
    re.IGNORECASE,
)


# of a scan: a factor of any name; the magnification of a lens changes no height
_OF_HEIGHTS = re.compile(
    r"fa[ck]t(?:or|eur)|fattore|fator|scal(?:e|ing)|skal|escala|echelle|massstab|multipl|gain|verstaerk"
    r"|(?:vertical|vertikal|vv|z|height|hoehen?)\w*(?:magnif|vergr|agrand|aument|ingrand)|系数|倍数|縦倍率"
)
_STEP_OF_GAUGE = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]z(?![^\W\d_])"
    r"|(?<![^\W\d_])(?:z|height|vertical|höhen?)[\s_-]*\w{0,4}(?:step|resol|auflös|incr|quant|digit|lsb|pas)"
    r"|(?<![^\W\d_])(?:lsb|quantum|quantization|quantisierung|digit)(?![^\W\d_])"
)
_ONE_UNIT = re.compile(r"(?<![\d.,])1(?:[.,]0+)?\s*[^\W\d]*\W*$")  # "z resolution: 1 nm"


def unapplied_factors(layout: Layout) -> list[str]:
    """Say what signals may still have to be multiplied by: levers, gains, scales, contacts.

    A factor of one, and a single contact, are not spoken of.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.

    Returns
    -------
    list of str
        A sentence for each line that states one.
    """
    said = (_missing(line[:_LONGEST].strip()) for line in layout.text_above())
    return [sentence for sentence in said if sentence]


def unapplied_height_factors(
    layout: Layout, heights: np.ndarray, columns: Sequence[DraftColumn]
) -> list[str]:
    """Say what heights may still have to be multiplied by: a factor, or what one step is worth.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    heights
        Their numbers as written. Of whole numbers a stated step of the gauge may be the unit.
    columns
        As they are understood: what one count is worth is known where their unit holds it.
    """
    weighed = any(column.used and column.counted and column.unit for column in columns)
    present = heights[np.isfinite(heights)]
    whole = bool(present.size) and bool((present == np.round(present)).all())
    said = []
    for line in layout.text_above(bare=True):
        text = line[:_LONGEST].strip()
        plain = _PLAIN.match(text)
        factor = (
            plain and _OF_HEIGHTS.search(normalise_label(plain["key"])) and _number(plain["number"])
        )
        step = whole and _STEP_OF_GAUGE.search(text) and not _ONE_UNIT.search(text)
        worth = WORTH.search(text)
        if (worth or step) and weighed:
            continue
        if (factor and factor != 1) or step or worth:
            said.append(f"heights are read as they stand, not times '{shown(text, 40)}'")
    return said


def _missing(line: str) -> str:
    """Say what a line states that the signals may not hold yet; "" if nothing.

    >>> _missing("Multiply friction force by 1.25")
    "signals are read as they stand, and not as the file says: 'Multiply friction force by 1.25'"

    >>> _missing("Lever 1:5"), _missing("Gain: 1"), _missing("Time 1:05")
    ("signals are read as they stand, not times 'Lever 1:5'", '', '')
    >>> _missing("Number of contacts: 2")
    "friction and load are both of all contacts, or both of one: 'Number of contacts: 2'"
    """
    contacts = _CONTACTS.search(line)
    if contacts and 1 < int(contacts["after"] or contacts["before"]) <= _MOST_CONTACTS:
        return f"friction and load are both of all contacts, or both of one: '{shown(line, 40)}'"
    if weight_on_lever(line):
        return ""  # the load is the weight times the lever
    for ratio in _ONE_TO.finditer(line):
        key = line[: ratio.start()]
        named = _begins_a_word(_FACTOR, key) or _begins_a_word(_RATIO, key)
        if named and any(LOAD.search(said.key) for said in phrases(line[ratio.end() :])):
            return ""  # what the lever makes of a weight is said behind it
        if named and _number(ratio["one"]) != _number(ratio["other"]):
            return f"signals are read as they stand, not times '{shown(line, 40)}'"
    times = _TIMES.search(line)
    if times and _number(times["number"] or times["before"]) != 1:
        return f"signals are read as they stand, and not as the file says: '{shown(line, 60)}'"
    plain = _PLAIN.match(line)
    if plain is None or _number(plain["number"]) == 1:
        return ""
    if _begins_a_word(_FACTOR, plain["key"]):
        return f"signals are read as they stand, not times '{shown(line, 40)}'"
    if _begins_a_word(_GEAR, plain["key"]):
        return f"speeds are read as they stand, not divided by '{shown(line, 40)}'"
    return ""


def _begins_a_word(pattern: re.Pattern[str], text: str) -> bool:
    """Whether a pattern of squeezed names is found at the start of a word.

    >>> _begins_a_word(_FACTOR, "Lever arm ratio"), _begins_a_word(_FACTOR, "File version")
    (True, False)
    """
    starts, end = set(), 0
    for word in re.split(r"[\W_]+", text):
        starts.add(end)
        end += len(normalise_label(word))
    return any(match.start() in starts for match in pattern.finditer(normalise_label(text)))


def _number(text: str) -> float:
    return float(text.replace(",", "."))
