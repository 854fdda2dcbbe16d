"""What the lines above a matrix of heights say: how far its points lie apart, and the unit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from tribolab.units import conversion

_LONGEST = 300  # characters of a line that are looked at
_UNIT = (
    r"(?:[npuµμ]m|mm|cm|m|Å|microns?|(?:nano|micro|milli)met(?:er|re)s?|微米|纳米|毫米)(?![^\W\d_])"
)
_EASTERN = {"微米": "um", "纳米": "nm", "毫米": "mm"}
_IN_KEY = re.compile(rf"[\[(]\s*({_UNIT})\s*[\])]|(?<![^\W\d_])({_UNIT})[\s:=,;]*$")
_OF_UNIT = "units?|einheit(?:en)?|unit[eéà]s?|unidad(?:es)?|单位|単位"
_HEIGHTS = (
    r"heights?|höhen?|hoehen?|hauteurs?|alturas?|altezz[ae]|topograph\w*|elevations?|高[さ度]"
    r"|(?<![^\W\d_])z(?![^\W\d_])"
)
_SAYS_UNIT = re.compile(rf"(?:{_OF_UNIT})\W.*?(?<![^\W\d_])(?P<unit>{_UNIT})\W*$", re.IGNORECASE)
_SAYS_HEIGHTS = re.compile(
    rf"(?:{_HEIGHTS})\W*(?:[\[(]|\b(?:in|en|are)\b)\s*(?P<unit>{_UNIT})\W*$", re.IGNORECASE
)
_ABOUT_HEIGHTS = re.compile(rf"{_HEIGHTS}|values?|data", re.IGNORECASE)
_ACROSS = re.compile(r"(?i)(?<![^\W\d_])(?:xy|x|y)(?![^\W\d_])|lateral|横|縦")
_FACTOR = re.compile(
    r"(?i)(?:(?<![^\W\d_])z|height)[\s_-]*(?:scale|scaling|factor|calibration|magnification)"
)
_ALONG_Z = re.compile(r"(?i)(?<![^\W\d_])z(?![^\W\d_])|vertical (?:range|scan|step|resolution)")
_X = re.compile(
    r"(?i)(?<![^\W\d_])x(?![^\W\d_])|horizontal|width|breite|largeur|ancho|larghezza|宽|幅|横"
    r"|columns?|spalten|colonnes?|columnas|列"
)
_Y = re.compile(
    r"(?i)(?<![^\W\d_])y(?![^\W\d_])|vertical|height|höhe|hauteur|alto|altezza|高|縦"
    r"|rows?|lines|zeilen|lignes|filas|righe|行"
)
_PITCH = re.compile(
    r"(?i)pixel[\s_-]*(?:size|pitch|spacing|width|height|gr(?:ö|oe)(?:ß|ss)e|abstand)"
    r"|(?:size|pitch|spacing|taille|tama[nñ]o|dimension[ei]?|größe)\s*(?:of|de[lr]?|du|di)?"
    r"\s*p[ií]xels?|lateral[\s_-]*(?:sampling|spacing|pitch)"
    r"|xy[\s_-]*(?:calibration|キャリブレーション|校准|校正)|camera[\s_-]*res"
    r"|(?<![^\W\d_])(?:sampling|point|data|[xy])[\s_-]*"
    r"(?:pitch|spacing|increment|step|interval|distance)"
    r"|(?:pitch|spacing|increment|step|interval)[\s_-]*\(?[xy](?![^\W\d_])|punkt(?:e|ab)\w*abstand"
    r"|punktabstand|(?:distance|pas|paso|passo)\s+(?:entre|de|di|tra)\s+p\w+"
    r"|像素(?:尺寸|大小|间距)|点间距|ピクセル(?:サイズ|ピッチ)|画素(?:サイズ|ピッチ)|点間隔"
)
_EXTENT = re.compile(
    r"(?i)field[\s_-]*(?:of[\s_-]*)?view|(?<![^\W\d_])fov(?![^\W\d_])"
    r"|(?:scan|image|map|measure\w*|stitched)[\s_-]*(?:size|area|range|field|width|height|length)"
    r"|(?<![^\W\d_])[xy][\s_-]*(?:size|range|length|extent|width)"
    r"|(?:size|range|length|extent)[\s_-]*\(?[xy](?![^\W\d_])"
    r"|^\W*(?:width|height|breite|höhe|largeur|hauteur|ancho|alto|larghezza|altezza)\W*$"
    r"|bildfeld|messfeld|sehfeld|bildgr(?:ö|oe)(?:ß|ss)e|scanbereich|champ|zone (?:de )?mesur"
    r"|campo|[aá]rea (?:de |di )?(?:medi|escan|misura|scansione)"
    r"|视野|視野|视场|扫描(?:范围|尺寸)|测量(?:范围|区域)|測定(?:範囲|領域)|画像サイズ"
)
_COUNT = re.compile(
    r"(?i)points?|pixels?|columns?|rows?|lines|spalten|zeilen|punkte|bildpunkte|lignes|colonnes?"
    r"|filas|columnas|righe|píxeles|horizontal|vertical|(?<![^\W\d_])[xy][\s_-]*size|像素数?|点数"
    r"|画素数|列|行|横|縦"
)


class MatrixHeader(NamedTuple):
    """What stands above a matrix: pitch along x and y [m], unit of heights [m], rows and columns.

    None is what it does not say, or says in two ways.
    """

    dx: float | None
    dy: float | None
    height: float | None
    rows: int | None
    columns: int | None


class _Said(NamedTuple):
    """A line with numbers: its words, the numbers, and their unit, "" without."""

    key: str
    numbers: tuple[float, ...]
    units: tuple[str, ...]


def header_of(lines: Iterable[str], shape: tuple[int, int], mark: str) -> MatrixHeader:
    """Understand the lines above a matrix.

    Parameters
    ----------
    lines
        The lines.
    shape
        Rows and columns of the matrix, by which an extent becomes a pitch.
    mark
        Decimal mark.

    Examples
    --------
    >>> said = header_of(["Field of view: 20 x 10 um", "Heights [nm]"], (5, 10), ".")
    >>> round(said.dx * 1e6, 9), round(said.dy * 1e6, 9), said.height
    (2.0, 2.0, 1e-09)
    """
    texts = [line[:_LONGEST].replace('"', " ").strip() for line in lines]
    said = [part for text in texts if (part := _said(text, mark)) is not None]
    pitch = _places(said, _PITCH, (1, 1))
    extent = _places(said, _EXTENT, shape)
    dx, dy = (first or second for first, second in zip(pitch, extent, strict=True))
    rows, columns = _counts(said)
    scaled = any(_FACTOR.search(part.key) and part.numbers[0] != 1.0 for part in said)
    return MatrixHeader(dx, dy, None if scaled else _height_unit(texts), rows, columns)


def _said(text: str, mark: str) -> _Said | None:
    number = rf"(?<![\w.])[-+]?\d+(?:[{mark}]\d+)?(?:[eE][-+]?\d+)?"
    first = re.search(number, text)
    if first is None:
        return None
    key = text[: first.start()]
    numbers, units = [], []
    for match in re.finditer(rf"({number})[\s,;]*[(\[]?({_UNIT})?", text[first.start() :]):
        numbers.append(float(match[1].replace(mark, ".")))
        units.append(match[2] or "")
    if len(numbers) > 2:  # a date, a time, a row of results
        return None
    in_key = _IN_KEY.search(key)
    usual = units[-1] or ((in_key[1] or in_key[2]) if in_key else "")
    return _Said(key, tuple(numbers), tuple(unit or usual for unit in units))


def _places(
    said: list[_Said], words: re.Pattern[str], shape: tuple[int, int]
) -> tuple[float | None, float | None]:
    """Return the pitch along x and y [m] that lines of such words say."""
    rows, columns = (max(number, 1) for number in shape)
    along: tuple[set[float], set[float]] = set(), set()
    for part in said:
        if not words.search(part.key) or _ALONG_Z.search(part.key) or not part.units[0]:
            continue
        lengths = [n * _metres(u) for n, u in zip(part.numbers, part.units, strict=True)]
        if not min(lengths) > 0:
            continue
        x, y = bool(_X.search(part.key)), bool(_Y.search(part.key))
        if len(lengths) == 2:
            along[0].add(lengths[0] / columns)
            along[1].add(lengths[1] / rows)
        elif x != y:
            along[0 if x else 1].add(lengths[0] / (columns if x else rows))
        elif rows == columns:  # of a field that is not square one length may be either side
            for axis in along:
                axis.add(lengths[0] / columns)
    dx, dy = (values.pop() if len(values) == 1 else None for values in along)
    return dx, dy


def _counts(said: list[_Said]) -> tuple[int | None, int | None]:
    """Return the numbers of rows and columns."""
    along: tuple[set[int], set[int]] = set(), set()
    for part in said:
        whole = all(n == int(n) and n > 0 for n in part.numbers) and not any(part.units)
        if not whole or not _COUNT.search(part.key):
            continue
        x, y = bool(_X.search(part.key)), bool(_Y.search(part.key))
        if len(part.numbers) == 2:
            along[1].add(int(part.numbers[0]))
            along[0].add(int(part.numbers[1]))
        elif x != y:
            along[1 if x else 0].add(int(part.numbers[0]))
    rows, columns = (values.pop() if len(values) == 1 else None for values in along)
    return rows, columns


def _height_unit(texts: list[str]) -> float | None:
    """Return the unit of the heights [m], if just one is said."""
    own: set[float] = set()
    any_unit: set[float] = set()
    for text in texts:
        match = _SAYS_HEIGHTS.search(text) or _SAYS_UNIT.search(text)
        if match is None or any(sign.isdigit() for sign in text):
            continue
        of_heights = bool(_ABOUT_HEIGHTS.search(text))
        if not of_heights and _ACROSS.search(text):
            continue
        (own if of_heights else any_unit).add(_metres(match["unit"]))
    units = own or any_unit
    return units.pop() if len(units) == 1 else None


def _metres(unit: str) -> float:
    return conversion(_EASTERN.get(unit, unit.lower() if len(unit) > 2 else unit), "m")[0]
