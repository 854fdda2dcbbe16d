"""What the lines above a matrix of heights say: how far its points lie apart, and the unit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from tribolab.units import conversion

_LONGEST = 300  # characters of a line that are looked at
UNIT = (
    r"(?:[npuµμ]m|mm|cm|m|Å|microns?|(?:nano|micro|milli)met(?:er|re)s?|微米|纳米|毫米)(?![^\W\d_])"
)
_UNITS = frozenset("nm pm um µm μm mm cm m Å".split())
_EASTERN = {"微米": "um", "纳米": "nm", "毫米": "mm"}
_IN_KEY = re.compile(rf"[\[(]\s*({UNIT})\s*[\])]|(?<![^\W\d_])({UNIT})[\s:=,;]*$")
_OF_UNIT = (
    r"units?|einheit(?:en)?|unit[eéà]s?|unidad(?:es)?|单位|単位|단위"
    r"|egys[ée]g\w*|jednostk\w|jednotk\w|enhet\w*|eenheid|yksikk\w|birim\w*|единиц\w*"
)
_IN = r"(?:in|en|are|em|i|v|w|в)"
_HEIGHTS = (
    r"heights?|höhen?|hoehen?|hauteurs?|alturas?|altezz[ae]|topograph\w*|elevations?|高[さ度]"
    r"|korkeu\w+|v[ýy][šs]k\w+|wysoko\w+|h(?:ö|o|oe)jd\w*|h[øo][yj]de\w*|hoogtes?|magass[áa]g\w*"
    r"|y(?:ü|ue|u)ksekli\w+|visin\w+|высот\w*|높이|高度|vert[iy][ck]?al\w*|depths?|tiefen?"
    r"|(?<![^\W\d_])z(?![^\W\d_])"
)
_SAYS_UNIT = re.compile(rf"(?:{_OF_UNIT})\W.*?(?<![^\W\d_])(?P<unit>{UNIT})\W*$", re.IGNORECASE)
_SAYS_HEIGHTS = re.compile(
    rf"(?:{_HEIGHTS})(?:[_ ]\w{{1,12}})?\W*(?:[\[(]|\b{_IN}\b)\s*(?P<unit>{UNIT})\W*(?:[,;(].*)?$",
    re.IGNORECASE,
)
# "korkeus: nm", an entry that is a unit and nothing else; not one of what lies across the surface
_IS_UNIT = re.compile(
    rf"^\W*(?P<key>[^\W\d][^:：=;\t]*?)\s*(?:[:：=;,\t]|\s{{2,80}})\W*(?P<unit>{UNIT})\W*$",
    re.IGNORECASE,
)
_NO_HEIGHT = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]?(?:xy|x|y)(?![^\W\d_])|lateral|horizont|pixel|spacing|pitch|step|sampl"
    r"|width|size|length|field|range|position|distan|abstand|wave|laser|filter|cut|radius|tip|横|縦|像素"
)
_ABOUT_HEIGHTS = re.compile(rf"{_HEIGHTS}|values?|data", re.IGNORECASE)
_ACROSS = re.compile(r"(?i)(?<![^\W\d_])(?:xy|x|y)(?![^\W\d_])|lateral|横|縦")
_FACTOR = re.compile(
    r"(?i)(?:(?<![^\W\d_])z|height)[\s_-]*(?:scale|scaling|factor|calibration|magnification)"
)
_ANY_FACTOR = re.compile(
    r"(?i)^(?!.*(?<![^\W\d_])[xy](?![^\W\d_]))(?!.*(?:lateral|pixel)).*(?:fa[ck]t(?:or|eur)|multipl"
    r"|scaling|skalierung|(?<![^\W\d_])scale(?![^\W\d_]))"
)
_STEP_OF_GAUGE = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]z(?![^\W\d_])"
    r"|(?<![^\W\d_])(?:z|height|vertical|höhen?)[\s_-]*(?:step|resol|auflös|incr|quant|digit|lsb)"
    r"|(?<![^\W\d_])lsb(?![^\W\d_])"
)
_ALONG_Z = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]?z(?![^\W\d_])|vertical (?:range|scan|step|resolution)"
)
_X = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]?x(?![^\W\d_])|horizontal|width|breite|largeur|ancho|larghezza|宽|幅|横"
    r"|columns?|(?<![^\W\d_])n_?cols?|spalten|colonnes?|columnas|oszlop\w*|kolumn\w*|sloupc\w*|列"
)
_Y = re.compile(
    r"(?i)(?<![^\W\d_])[dΔ]?y(?![^\W\d_])|vertical|height|höhe|hauteur|alto|altezza|高|縦"
    r"|rows?|lines|zeilen|lignes|filas|righe|sorok|rader|r[æa]kker|wiersz\w*|[řr][áa]d\w*|行"
)
_STEPS = (
    r"pitch|spacing|step|increment|schritt\w*|(?:punkt|raster)?abstand|pas|paso|passo|stap|afstand"
    r"|krok|rozte[čc]\w*|odst[ęe]p|avst[åa]nd|steg\w*|askel\w*|v[äa]li|l[ée]p[ée]s\w*|ad[ıi]m|шаг"
    r"|间距|步长|ピッチ|間隔|간격"
)
_PITCH = re.compile(
    r"(?i)pixel[\s_-]*(?:size|pitch|spacing|width|height|gr(?:ö|oe)(?:ß|ss)e|abstand|maat"
    r"|storlek|størrelse|afstand)"
    r"|(?:size|pitch|spacing|taille|tama[nñ]o|dimension[ei]?|größe)\s*(?:of|de[lr]?|du|di)?"
    r"\s*p[ií]xels?|lateral[\s_-]*(?:sampling|spacing|pitch)"
    r"|xy[\s_-]*(?:calibration|キャリブレーション|校准|校正)|camera[\s_-]*res"
    r"|(?<![^\W\d_])(?:sampling|point|data|[xy])[\s_-]*"
    r"(?:pitch|spacing|increment|step|interval|distance)"
    r"|(?:pitch|spacing|increment|step|interval)[\s_-]*\(?[xy](?![^\W\d_])|punkt(?:e|ab)\w*abstand"
    r"|punktabstand|(?:distance|pas|paso|passo)\s+(?:entre|de|di|tra)\s+p\w+"
    r"|(?<![^\W\d_])[dΔ][xy](?![^\W\d_])|^\W*(?:pitch|spacing|cell\s?size|grid\s?size)\W*$"
    rf"|(?:{_STEPS}).*(?<![^\W\d_])(?:xy|x|y)(?![^\W\d_])|(?<![^\W\d_])(?:xy|x|y)\W+(?:{_STEPS})"
    r"|k[ée]ppont\w*m[ée]ret|bildpunktgr\w+|pixels?torlek|pikselin?\s?koko|piksel\s?(?:boyutu|rozmiar)"
    r"|(?:rozmiar|velikost|dimensiune\w*|boyut\w*|размер)\s*(?:piksel\w*|pixel\w*|пиксел\w*)"
    r"|픽셀\s?(?:크기|간격)|像素(?:尺寸|大小|间距)|点间距|ピクセル(?:サイズ|ピッチ)|画素(?:サイズ|ピッチ)|点間隔"
)
_EXTENT = re.compile(
    r"(?i)field[\s_-]*(?:of[\s_-]*)?view|(?<![^\W\d_])fov(?![^\W\d_])"
    r"|(?:scan|image|map|measure\w*|stitched)[\s_-]*(?:size|area|range|field|width|height|length)"
    r"|(?<![^\W\d_])[xy][\s_-]*(?:size|range|length|extent|width)"
    r"|(?:size|range|length|extent)[\s_-]*\(?[xy](?![^\W\d_])"
    r"|^\W*(?:width|height|breite|höhe|largeur|hauteur|ancho|alto|larghezza|altezza)\W*$"
    r"|bildfeld|messfeld|sehfeld|bildgr(?:ö|oe)(?:ß|ss)e|scanbereich|champ|zone (?:de )?mesur"
    r"|m[åa]lefelt|m[åa]leomr[åa]de|synsfelt|m[äa]tf[äa]lt|m[äa]tomr[åa]de|mittausalue|kuva-?ala"
    r"|meetveld|beeldveld|pole (?:pomiar|widzen|m[ěe][řr]en)\w*|obszar pomiar\w*|zorn[ée] pole"
    r"|m[ée]r[ée]si (?:ter[üu]let|mez[őo])|l[áa]t[óo]mez[őo]|[öo]l[çc][üu]m alan\w*"
    r"|поле (?:зрения|измерен\w*)"
    r"|область (?:сканиров\w*|измерен\w*)|측정\s?(?:영역|범위)|시야"
    r"|campo|[aá]rea (?:de |di )?(?:medi|escan|misura|scansione)"
    r"|视野|視野|视场|扫描(?:范围|尺寸)|测量(?:范围|区域)|測定(?:範囲|領域)|画像サイズ"
)
# "Samps/line", "points per row": how many heights make a row
_OF_ROW = re.compile(
    r"(?i)(?:samp\w*|points?|pixels?|pts|values?|punkte|pixel)\s*(?:/|per|pro|je)\s*(?:line|row|zeile|linie|profile?)"
)
_COUNT = re.compile(
    r"(?i)samp\w*|points?|pixels?|punt(?:en|os|i)|pontos|punkt\w*|pist\w+|bod[ůy]?|точ\w+|columns?|n_?cols?|rows?|lines|spalten|zeilen|punkte|bildpunkte|lignes|colonnes?"
    r"|filas|columnas|righe|píxeles|horizontal|vertical|(?<![^\W\d_])[xy][\s_-]*size|像素数?|点数"
    r"|画素数|列|行|横|縦"
)

# "X-Achse", "Axe Y": what a line of several entries is about
_AXIS = re.compile(
    r"(?i)^\W*(?:ax[ei]s?|achse|eje|asse|as)?[\s_-]*(?P<axis>[xyz])[\s_-]*(?:ax[ei]s|achse)?$"
)
_CELL_NUMBER = re.compile(r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?")


class MatrixHeader(NamedTuple):
    """What stands above a matrix: pitch along x and y [m], unit of heights [m], rows and columns.

    None is what it does not say, or says in two ways. `stated` are names and numbers that stand
    alone, without a unit; `gauge_step` [m] is what whole numbers may be counted in;
    `without_unit` is a pitch or extent that has none: "cellsize 0.005".
    """

    dx: float | None
    dy: float | None
    height: float | None
    rows: int | None
    columns: int | None
    stated: tuple[tuple[str, float], ...] = ()
    gauge_step: float | None = None
    without_unit: str = ""


class _Said(NamedTuple):
    """A line with numbers: its words, the numbers, and their unit, "" without."""

    key: str
    numbers: tuple[float, ...]
    units: tuple[str, ...]


def header_of(
    lines: Iterable[str],
    shape: tuple[int, int],
    mark: str,
    *,
    commas_part: bool = False,
    x_unit: str = "",
) -> MatrixHeader:
    """Understand the lines above a matrix.

    Parameters
    ----------
    lines
        The lines.
    shape
        Rows and columns of the matrix, by which an extent becomes a pitch.
    mark
        Decimal mark of the matrix; the lines above may have the other one.
    commas_part
        Whether commas part cells, and are no decimal marks.
    x_unit
        Unit of a pitch or an extent that states none.

    Examples
    --------
    >>> said = header_of(["Field of view: 20 x 10 um", "Heights [nm]"], (5, 10), ".")
    >>> round(said.dx * 1e6, 9), round(said.dy * 1e6, 9), said.height
    (2.0, 2.0, 1e-09)
    """
    texts = [
        entry
        for line in lines
        for entry in _entries(line[:_LONGEST].replace('"', " ").strip(), commas_part=commas_part)
    ]
    said = [part for text in texts if (part := _said(text, mark, commas_part=commas_part))]
    bare = [part for part in said if _is_bare(part)]
    if x_unit:
        units = [_Said(p.key, p.numbers, (x_unit,) * len(p.numbers)) for p in bare]
        said = [units[bare.index(p)] if p in bare else p for p in said]
    pitch = _places(said, _PITCH, (1, 1))
    extent = _places(said, _EXTENT, shape, parted=True)
    dx, dy = (first or second for first, second in zip(pitch, extent, strict=True))
    rows, columns = _counts(said)
    scaled = any(
        part.numbers[0] != 1.0
        and (_FACTOR.search(part.key) or (_ANY_FACTOR.search(part.key) and not part.units[0]))
        for part in said
    )
    steps = {
        part.numbers[0] * _metres(part.units[0])
        for part in said
        if _STEP_OF_GAUGE.search(part.key) and part.units[0]
    }
    alone = tuple(
        (part.key.strip(" #%;,:=\t"), part.numbers[0])
        for part in said
        if len(part.numbers) == 1 and not part.units[0]
    )
    return MatrixHeader(
        dx,
        dy,
        None if scaled else _height_unit(texts),
        rows,
        columns,
        alone,
        max(steps, default=None),
        " ".join(f"{bare[0].key.strip(' #%;,:=')} {bare[0].numbers[0]:g}".split()) if bare else "",
    )


def _entries(text: str, *, commas_part: bool) -> list[str]:
    """Return the entries of a line about one axis, each with its name; any other line as it is.

    >>> _entries("Axe X;Points;256;Pas;3,2;um", commas_part=False)
    ['x Points: 256', 'x Pas: 3,2 um']
    >>> _entries("Axe Z;Unit;um;Step;0,1;nm", commas_part=False)
    ['z Unit: um', 'z Step: 0,1 nm']
    """
    cells = [cell.strip() for cell in re.split(r"[;\t,]" if commas_part else r"[;\t]", text)]
    about = _AXIS.match(cells[0])
    if about is None or len(cells) < 4:
        return [text]
    entries: list[list[str]] = []
    for cell in cells[1:]:
        if not entries or (
            len(entries[-1]) > 1 and not _CELL_NUMBER.fullmatch(cell) and cell not in _UNITS
        ):
            entries.append([cell])
        else:
            entries[-1].append(cell)
    return [f"{about['axis'].lower()} {key}: {' '.join(said)}" for key, *said in entries if said]


def _is_bare(part: _Said) -> bool:
    """Whether a line says a pitch or an extent across the surface without a unit."""
    across = _PITCH.search(part.key) or _EXTENT.search(part.key)
    whole = all(map(float.is_integer, part.numbers)) and _COUNT.search(part.key)
    return bool(across and not any(part.units) and not whole and not _ALONG_Z.search(part.key))


def _said(text: str, mark: str, *, commas_part: bool) -> _Said | None:
    marks = "." if commas_part else ".,"
    number = rf"(?<![\w.])[-+]?\d+(?:[{marks}]\d+)?(?:[eE][-+]?\d+)?"
    first = re.search(number, text)
    if first is None:
        return None
    key = text[: first.start()]
    numbers, units = [], []
    for match in re.finditer(rf"({number})[\s,;]*[(\[]?({UNIT})?", text[first.start() :]):
        numbers.append(_number(match[1], mark))
        units.append(match[2] or "")
    if len(numbers) > 2:  # a date, a time, a row of results
        return None
    in_key = _IN_KEY.search(key)
    usual = units[-1] or ((in_key[1] or in_key[2]) if in_key else "")
    return _Said(key, tuple(numbers), tuple(unit or usual for unit in units))


def _number(text: str, mark: str) -> float:
    """Return a number; NaN where its mark is not the table's and may part thousands: 1,024.

    >>> _number("2,5", "."), _number("1,024", ","), _number("1,024", ".")
    (2.5, 1.024, nan)
    """
    thousands = re.fullmatch(r"[-+]?[1-9]\d{0,2}[.,]\d{3}", text) and mark not in text
    return float("nan") if thousands else float(text.replace(",", "."))


def _places(
    said: list[_Said], words: re.Pattern[str], shape: tuple[int, int], *, parted: bool = False
) -> tuple[float | None, float | None]:
    """Return the pitch along x and y [m] that lines of such words say."""
    rows, columns = (max(number, 1) for number in shape)
    along: tuple[set[float], set[float]] = set(), set()
    for part in said:
        if not words.search(part.key) or _ALONG_Z.search(part.key) or not all(part.units):
            continue
        lengths = [n * _metres(u) for n, u in zip(part.numbers, part.units, strict=True)]
        if not min(lengths) > 0:
            continue
        x, y = bool(_X.search(part.key)), bool(_Y.search(part.key))
        if len(lengths) == 2:
            along[0].add(_part(lengths[0], columns, parted))
            along[1].add(_part(lengths[1], rows, parted))
        elif x != y:
            along[0 if x else 1].add(_part(lengths[0], columns if x else rows, parted))
        elif rows == columns:  # of a field that is not square one length may be either side
            for axis in along:
                axis.add(_part(lengths[0], columns, parted))
    dx, dy = (values.pop() if len(values) == 1 else None for values in along)
    return dx, dy


def _part(length: float, points: int, parted: bool) -> float:
    """Return the distance of points over a length, whose last one is its end or one step before."""
    pitches = [length / points, length / max(points - 1, 1)] if parted else [length]
    return min(pitches, key=lambda pitch: len(f"{pitch:.7g}"))


def _counts(said: list[_Said]) -> tuple[int | None, int | None]:
    """Return the numbers of rows and columns."""
    along: tuple[set[int], set[int]] = set(), set()
    for part in said:
        whole = all(n > 0 and n == round(n) for n in part.numbers) and not any(part.units)
        if not whole or not _COUNT.search(part.key):
            continue
        of_row = bool(_OF_ROW.search(part.key))
        x = of_row or bool(_X.search(part.key))
        y = not of_row and bool(_Y.search(part.key))
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
    other: set[float] = set()
    for text in texts:
        if any(sign.isdigit() for sign in text):
            continue
        match = _SAYS_HEIGHTS.search(text) or _SAYS_UNIT.search(text)
        if match is not None:
            of_heights = bool(_ABOUT_HEIGHTS.search(text))
            if of_heights or not _ACROSS.search(text):
                (own if of_heights else any_unit).add(_metres(match["unit"]))
        elif (entry := _IS_UNIT.search(text)) and not _NO_HEIGHT.search(entry["key"]):
            of_heights = bool(_ABOUT_HEIGHTS.search(entry["key"]))
            (own if of_heights else other).add(_metres(entry["unit"]))
    units = own or any_unit or other
    return units.pop() if len(units) == 1 else None


def _metres(unit: str) -> float:
    return conversion(_EASTERN.get(unit, unit.lower() if len(unit) > 2 else unit), "m")[0]
