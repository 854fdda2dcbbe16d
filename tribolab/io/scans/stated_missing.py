"""Numbers that a file's header states to stand where no height is: "no data: -99999"."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

_SAME = 2e-7  # relative: a number with single precision
_TWICE = 2
# what such an entry is called; an unknown word does, too, where the number lies far outside
_NAMED = re.compile(
    r"(?i)missing|no[\s_-]*(?:data|value)|invalid|\bbad\b|\bvoid\b|undefined|not[\s_-]*measured"
    r"|fehl(?:end|wert|stell)|ung(?:ü|ue)ltig|nicht[\s_-]*gemessen|manquant|non[\s_-]*mesur|invalide"
    r"|falt[ae]|ausente|perdid|inv[aá]lid|no[\s_-]*v[aá]lid|mancant|non[\s_-]*valid|ontbrek|ongeldig"
    r"|puuttu|saknad|ogiltig|mangl|ugyldig|chyb[eě]j|neplatn|\bbrak\b|hi[aá]nyz|eksik|ge[cç]ersiz"
    r"|пропу|отсутств|недейств|无效|無效|缺失|欠損|欠測|無効|결측|누락"
)
# a value, which may lie among the heights, and not how many are missing
_AS_VALUE = re.compile(
    r"(?i)no[\s_-]*data|value|wert|valeur|valor|arvo|värde|verdi|værdi|hodnota|warto|érték|de[ğg]er|знач|[値值]"
)
_COUNTS = re.compile(
    r"(?i)points?|pixels?|count|number|anzahl|zahl|punkt|nombre|n[uú]mero|quant|liczba|po[čc]et|antal|aantal"
    r"|say[ıi]s|числ|колич|点数|個数|个数|%|ratio|share|anteil"
)
# results, and what lies far outside without being no height
_RESULTS = re.compile(
    r"(?i)min|max|lowest|highest|peak|valley|pit|range|offset|origin|mean|average|mittel|tief|h(?:ö|oe)ch"
    r"|hoogst|laagst|moyen|pico|picco|最[大小高低]|平均|\bR\w{1,2}\b|\bS\w{1,2}\b"
)


def take_stated(
    values: np.ndarray, stated: Iterable[tuple[str, float]]
) -> list[tuple[str, float, int]]:
    """Put NaN where a number stands that the header states to stand for no height.

    Parameters
    ----------
    values
        Heights as the file writes them; changed in place.
    stated
        Names and numbers, without units, that the header states.

    Returns
    -------
    list of tuple
        The name, the number and how often it stood there. A number whose name is not known is one
        where it stands far outside of all other heights and is repeated.

    Examples
    --------
    >>> heights = np.array([1.0, -999.0, 3.0, -999.0])
    >>> take_stated(heights, [("rows", 3.0), ("puuttuva arvo", -999.0)]), heights.tolist()
    ([('puuttuva arvo', -999.0, 2)], [1.0, nan, 3.0, nan])
    """
    taken = []
    for name, number in stated:
        here = np.abs(values - number) <= _SAME * abs(number)
        count = int(here.sum())
        if not count or not _is_mark(values, here, name, number):
            continue
        values[here] = np.nan
        taken.append((name, number, count))
    return taken


def _is_mark(values: np.ndarray, here: np.ndarray, name: str, number: float) -> bool:
    """Whether a number that is stated lies outside of all others: "missing: 5" may count them.

    A value by its name may stand among them: "no data value: 0".
    """
    rest = values[~here & np.isfinite(values)]
    if not rest.size:
        return False
    low, high = float(rest.min()), float(rest.max())
    outside = max(low - number, number - high)
    if _NAMED.search(name):
        return outside > 0 or bool(_AS_VALUE.search(name) and not _COUNTS.search(name))
    return outside > high - low and int(here.sum()) >= _TWICE and not _RESULTS.search(name)
