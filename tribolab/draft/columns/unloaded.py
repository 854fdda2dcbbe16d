"""Words that the beginning of a record is without contact: there the sensors show their zero."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.draft.columns.turning import torque_of
from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.settings import numeric_settings
from tribolab.draft.stated.stated_zero import find_zero, zero_in_doubt
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import says
from tribolab.unit_names import unit_in_words
from tribolab.units import conversion

_LONGEST = 300  # characters of a line that are looked at
_FEWEST = 20  # samples that tell a zero
_LEFT = 0.12  # of the highest signal: so far from its first level, and there is contact
_SAFE = 0.9  # of the stretch: a load comes on gradually
_UNLOADED = re.compile(
    r"unloaded|\bno[\s-]?load(?!\s?cell)|without (?:a |any )?(?:load|contact)"
    r"|not (?:yet )?(?:loaded|in contact)"
    r"|no contact|out of contact|\blifted|lift(?:ed)?[\s-]?off|pin (?:is )?(?:up|off)"
    r"|before (?:loading|contact)"
    r"|unbelastet|ohne (?:last|kontakt|auflast|belastung)|lastfrei|abgehoben|leerlauf"
    r"|vor (?:dem )?belast"
    r"|[àa] vide|sans (?:charge|contact)|d[ée]gag[ée]|relev[ée]|soulev[ée]|sin (?:carga"
    r"|contacto)|en vac[ií]o"
    r"|levantad|a vuoto|senza (?:carico|contatto)|sollevat|sem (?:carga|contato|contacto)"
    r"|utan (?:last|kontakt|belastning)"
    r"|avlastad|obelastad|uden (?:last|belastning|kontakt)|uten (?:last|kontakt)"
    r"|zonder (?:last|belasting|contact)|onbelast"
    r"|ilman (?:kuormaa|kuormitusta)|bez (?:obci[ąa][żz]enia|kontaktu|zat[íi][žz]en[íi]"
    r"|nacisku)|nieobci[ąa][żz]on"
    r"|terhel[ée]s n[ée]lk[üu]l|y[üu]ks[üu]z|без (?:нагрузки|контакта)|до нагружения|холост"
    # "load 0 N"
    r"|(?:load|force|last|kraft|charge|carga|fuerza|carico|forza|belasting|belastning|kuorma"
    r"|obci[ąa][żz]enie|zat[íi][žz]en[íi]|нагрузка|载荷|荷重|하중)"
    r"\s{0,3}[:=]?\s{0,3}(?:of |de |di |von )?[-+]?0(?:[.,]0+)?\s{0,3}(?:m?N|k?gf?|kg)(?![^\W_])"
    r"|未加载|未加載|无载|空载|无负载|无接触|抬起|無負荷|無荷重|非接触|無接触|무부하|비접촉",
    re.IGNORECASE,
)
_START = re.compile(
    r"\bfirst\b|\bstart|\bbegin|\binitial|\bbefore\b|\bat rest before|\berste|anfang|beginn"
    r"|zu beginn|\bd[ée]but|premi[eè]r"
    r"|au d[ée]part|inicio|primer|inizio|prim[ioa]\b|in[ií]cio|primeir|f[öo]rsta|b[öo]rjan"
    r"|f[øo]rste|begynn|eerste"
    r"|alussa|ensimm|pierwsz|pocz[ąa]t|prvn|za[čc][áa]t|els[őo]|ilk|ba[şs]lang|перв|начал|开始|開始|最初|先頭|前|처음|시작"
    rf"|{STEP_WORD}\W{{0,3}}0(?!\d)",
    re.IGNORECASE,
)
# "first 3 s at rest, string slack (zero of the cell)"
_ZERO_THERE = re.compile(
    r"\b(?:zero|zéro|cero|null\w*|nul|nolla|nula)\b|零|ゼロ|ноль|нул[ья]|영점", re.I
)
_ROW = re.compile(r"\s*\"?(?P<number>[01])\"?\s*[,;\t]")  # of a programme: its first step
_LASTS = re.compile(
    r"(?<![\d.,])(?P<number>\d+(?:[.,]\d+)?)\s?(?P<unit>ms|secs?|seconds?|sekund\w*|segundos|secondes|secondi|s|min(?:utes?|uten)?|秒|сек\w*|с)(?![^\W\d_]*/|[^\W\d_a-z])"
)


def unloaded_words(layout: Layout) -> str:
    """Return the line that says that a record begins without contact; "" if none does.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    for line in layout.text_above():
        text = line.strip()[:_LONGEST]
        begins = _START.search(text)
        if _UNLOADED.search(text) and (begins or _ROW.match(text)):
            return text
        if begins and _ZERO_THERE.search(text) and _lasts(text):
            return text
    return ""


def with_zero(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Say where the zero of friction, or of a torque, is read, if words tell that there is none.

    Where the load is measured it tells the same, and all along the run.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
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
    told = list(_LASTS.finditer(line))
    if len(told) != 1:
        return 0.0
    unit = unit_in_words(told[0]["unit"])
    if not converts(unit, "s"):
        return 0.0
    return float(told[0]["number"].replace(",", ".")) * conversion(unit, "s")[0]


def _still_unloaded(signal: np.ndarray) -> int:
    """Return how many samples pass before a signal leaves the level that it begins with."""
    level = float(np.nanmedian(signal[:_FEWEST]))
    away = np.abs(signal - level)
    highest = float(np.nanpercentile(away, 90)) if np.isfinite(away).any() else 0.0
    left = away > _LEFT * highest
    # a spike is no contact: five in a row are
    held = np.convolve(left, np.ones(5), "valid") >= 5
    return int(np.argmax(held)) if highest > 0 and held.any() else 0
