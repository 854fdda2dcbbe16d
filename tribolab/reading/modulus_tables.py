"""Search for a modulus table in a text or workbook: its columns, units and rows."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import Cure, ReadError, UnitError, shown
from tribolab.reading.lexicon.lexicon import known_words, names, normalise_label
from tribolab.reading.raw.containers.workbook import sheets_of
from tribolab.reading.raw.source import check_regular
from tribolab.reading.text.first_bytes import peek, text_of
from tribolab.reading.unit_texts import converts
from tribolab.units.conversion import conversion

HEAD = 200  # rows at the start of a file that may contain the column names
_LARGEST = 32 << 20  # bytes of a table in text
_MAX_NAME, _MAX_COLUMNS = 80, 300  # characters of a column name; columns of a row with names
_WORKBOOKS = (".xls", ".xlsx", ".xlsm", ".ods")
_PRIMES = str.maketrans({"\u2032": "'", "\u2019": "'", "\u00b4": "'", "\u2033": '"', "\u201d": '"'})
_UNIT = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$")  # the unit in brackets after a name
_IN = re.compile(r"\b(?:in|en)$")
_BARE_UNIT = re.compile(r"(.+?)(?:/|\s(?:in|en)\s)\s*([^\s/][^\s]*)")  # E'/MPa, G' in Pa
_COMMENT = re.compile(r"^\s*[#%]+\s?")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?")
_COMMA, _POINT = (re.compile(rf"(?<![\d{s}])\d+{s}\d+(?![\d{s}])") for s in (",", r"\."))
_SHEAR = re.compile(r"\bshear|schub|scher|torque|drehmoment", re.IGNORECASE)
# geometries of rheometers (TRIOS, RheoCompass), which measure shear
_TURNED = re.compile(
    r"plate[\s-]*plate|parallel[\s-]plate|platte[\s-]*platte|\bcone\b|kegel|couette|concentric"
    r"|\b(?:PP|CP|CC)\d{2}\b",
    re.IGNORECASE,
)
# loading modes of a DMA, which may also have plates
_PRESSED = re.compile(r"compress|tension|tensile|cantilever|bend|druck|zug", re.IGNORECASE)
NO_UNIT = ("", "-", "1", "[]", "[-]", "[1]")
Row = list[str]


class Column(NamedTuple):
    """Column of a table: its index in a row, its name, the concept of the name, and its unit."""

    place: int
    label: str
    concept: str
    unit: str


class Table(NamedTuple):
    """Table found in a file: columns by concept, rows of numbers as text, and the decimal mark.

    `shear` is True for shear moduli, False for tensile moduli, and None if neither is stated.
    """

    columns: dict[str, Column]
    rows: list[Row]
    shear: bool | None
    decimal: str


class TableKind(NamedTuple):
    """Kind of table: concept of a column name, choice of the columns, and words for messages."""

    concept: Callable[[str], str]
    needed: Callable[[dict[str, Column]], dict[str, Column]]
    wanted: str


def find_table(
    path: Path, sheet: str | None, longest: int | None = None, kind: TableKind | None = None
) -> Table:
    """Return the first table of a kind, by default storage and loss modulus against frequency.

    Parameters
    ----------
    path, sheet
        As for `read_modulus_table`.
    longest
        Number of lines of a text that are inspected; all if not given.
    kind
        Kind of the table; by default a modulus.

    Raises
    ------
    ReadError
        If the file contains no such table.
    """
    kind = kind or _MODULUS
    check_regular(path)
    seen: dict[str, None] = {}
    workbook = path.suffix.lower() in _WORKBOOKS
    for rows, decimal in _workbook(path, sheet) if workbook else _text(path, longest):
        for place, row in enumerate(rows[:HEAD]):
            if len(row) > _MAX_COLUMNS or not any(map(str.isalpha, "".join(row))):
                continue  # a row of numbers is no header
            columns = _columns(row, kind)
            seen |= dict.fromkeys(cell.strip() for cell in row if kind.concept(_bare(cell)[0]))
            if needed := kind.needed(columns):
                return _table_below(rows, place, needed, decimal)
    # the message lists only known names, as the file may contain anything
    names = shown(", ".join(seen), 200) or "none of them"
    raise ReadError(f"{path.name}: columns for {kind.wanted}; it has {names}")


def _columns(row: Row, kind: TableKind) -> dict[str, Column]:
    """Return the columns that a row of names describes; of several per concept, the first."""
    found: dict[str, Column] = {}
    for place, cell in enumerate(row):
        label, unit = _bare(cell)
        concept = kind.concept(label)
        if concept == "temperature" and unit and not converts(unit, "K"):
            continue  # "t in s" next to "T in °C" (HAAKE RheoWin)
        if concept and concept not in found:
            found[concept] = Column(place, cell.strip(), concept, unit)
    return found


def _bare(cell: str) -> tuple[str, str]:
    """Split a header cell into name and unit; the unit is "" if there is none.

    >>> _bare("G' in [Pa]"), _bare('E" (MPa)'), _bare("Tan(delta)"), _bare("E'/MPa")
    (("G'", 'Pa'), ('E"', 'MPa'), ('Tan(delta)', ''), ("E'", 'MPa'))
    >>> _bare("Gp_Pa"), _bare("omega_rad/s"), _bare("tan_delta")
    (('Gp', 'Pa'), ('omega', 'rad/s'), ('tan_delta', ''))
    """
    cell = cell.strip()
    if len(cell) > _MAX_NAME:
        return cell, ""
    match = _UNIT.search(cell)
    if match is not None and normalise_label(match[1]) not in ("d", "delta", "\u03b4"):
        return _IN.sub("", cell[: match.start()].strip()).strip(), match[1].strip()
    # NETZSCH writes "E'/MPa", RheoWin "G' in Pa"; "E''/E'" has no unit
    bare = _BARE_UNIT.fullmatch(cell)
    if bare and _concept(bare[1]) and not _concept(bare[2]):
        return bare[1].strip(), bare[2]
    name, _, unit = cell.partition("_")  # "Gp_Pa", "omega_rad/s"
    if _concept(name) and any(converts(unit, kind) for kind in ("Pa", "rad/s", "Hz", "K")):
        return name, unit
    return cell, ""


_SYMBOLS = ("Ep", "Epp", "Gp", "Gpp")


def _concept(label: str) -> str:
    """Return the concept of a modulus table that a name means; "" if it means none.

    >>> [_concept(label) for label in ("f", 'E"', "G'", "Tan(delta)", "|G*|", "Step time")]
    ['modulus_frequency', 'loss_modulus', 'storage_modulus', 'loss_factor', 'complex_modulus', '']
    """
    if len(label) > _MAX_NAME:
        return ""
    text = label.translate(_PRIMES).replace("''", "pp").replace('"', "pp").replace("'", "p")
    words = text.replace("*", "star").split()
    whole = normalise_label(" ".join(words))
    first, hyphen, rest = " ".join(words).partition("-")
    name = rest if hyphen and first in _SYMBOLS else ""
    bare = {normalise_label(" ".join(part)) for part in (words, words[:-1], [name]) if part}
    for word in known_words("modulus"):
        if whole in word.symbols or bare & names(word.quantity):
            return word.quantity  # "Storage modulus E'", Hitachi's "E'-Storage Modulus"
    return "temperature" if whole in ("t", "temp", "ts", *names("temperature")) else ""


def _needed(columns: dict[str, Column]) -> dict[str, Column]:
    """Return the columns of frequency, moduli and temperature; {} if they are incomplete."""
    frequency = [name for name in ("angular_frequency", "modulus_frequency") if name in columns]
    pair = next((pair for pair in _PAIRS if set(pair) <= set(columns)), ())
    if not frequency or not pair:
        return {}
    wanted = {frequency[0], *pair, "temperature"}
    return {name: column for name, column in columns.items() if name in wanted}


_MODULUS = TableKind(
    _concept, _needed, "frequency, storage and loss modulus are wanted, e.g. f, E', E''"
)
_PAIRS = (
    ("storage_modulus", "loss_modulus"),
    ("storage_modulus", "loss_factor"),
    ("complex_modulus", "phase_angle"),
    ("complex_modulus", "loss_factor"),
)


def _table_below(rows: Sequence[Row], place: int, columns: dict[str, Column], dec: str) -> Table:
    """Return the table below the names in row `place`, including the rows of later blocks."""
    named, columns = columns, _where_numbers_are(rows, place, columns)
    numeric = [
        n for n in range(place + 1, len(rows)) if numbers_of(rows[n], columns, dec) is not None
    ]
    first = numeric[0] if numeric else len(rows)
    below = (row for row in rows[place + 1 : first] if any(cell.strip() for cell in row))
    units = next((row for row in below if not all(map(_NUMBER.fullmatch, row))), [])
    found = {
        concept: column
        if column.unit or named[concept].place >= len(units)
        # the unit may be in brackets
        else column._replace(unit=units[named[concept].place].strip().strip("[]()").strip())
        for concept, column in columns.items()
    }
    labels = " ".join(rows[place])
    gs = normalise_label(found.get("storage_modulus", found.get("complex_modulus", _NONE)).label)
    tensile = gs.startswith("e") or "tensile" in labels.lower()
    above = " ".join(" ".join(row) for row in rows[:place])
    turned = _TURNED.search(above) and not _PRESSED.search(above)
    shear = True if gs.startswith("g") or _SHEAR.search(labels) or turned else None
    shear = False if tensile else shear
    return Table(found, [rows[n] for n in numeric], shear, dec)


def _where_numbers_are(
    rows: Sequence[Row], place: int, columns: dict[str, Column]
) -> dict[str, Column]:
    """Return the columns shifted left if rows have no cell below a leading "Interval data:".

    File: an export of RheoCompass whose rows begin with a number (imewei/rheojax).
    """
    numbers = (row for row in rows[place + 1 :] if row and all(map(_NUMBER.fullmatch, row)))
    if rows[place][0].strip().endswith(":") and len(next(numbers, [])) == len(rows[place]) - 1:
        return {concept: c._replace(place=c.place - 1) for concept, c in columns.items()}
    return columns


_NONE = Column(0, "", "", "")


def numbers_of(row: Row, columns: dict[str, Column], decimal: str) -> list[float] | None:
    """Return the numbers of a row in the order of the columns; None if a number is missing."""
    result = []
    for concept, column in columns.items():
        cell = row[column.place].strip() if column.place < len(row) else ""
        text = cell.replace(",", ".") if decimal == "," else cell
        if _NUMBER.fullmatch(text):
            result.append(float(text))
        elif concept == "temperature":
            result.append(np.nan)
        else:
            return None
    return result


def _text(path: Path, longest: int | None) -> Iterator[tuple[list[Row], str]]:
    """Yield the rows of a text split at each possible delimiter, with the decimal mark."""
    try:
        raw = path.read_bytes() if longest is None else peek(path).head[: 400 * longest]
    except OSError as error:
        raise ReadError(f"{path}: the file cannot be opened: {error}") from error
    if len(raw) > _LARGEST:
        raise ReadError(f"{path.name}: {path.stat().st_size >> 20} MB are no table of a modulus")
    lines = [_COMMENT.sub("", line) for line in text_of(raw).splitlines()[:longest]]
    lines = _with_names(lines, path.suffix.lower())
    for delimiter in ("\t", ";", ",", "  ", " "):
        if delimiter.isspace() and delimiter != "\t":  # aligned columns
            rows = [re.split(rf"\s{{{len(delimiter)},}}", line.strip()) for line in lines]
        else:
            try:
                rows = list(map(_apart, csv.reader(lines, delimiter=delimiter)))
            except csv.Error:
                continue
        comma = delimiter != "," and any(map(_COMMA.search, lines))
        yield rows, "," if comma and not any(map(_POINT.search, lines)) else "."


def _with_names(lines: list[str], suffix: str) -> list[str]:
    """Return the lines; for two formats without a row of column names, with names inserted.

    TA Universal Analysis (Q800) lists them as "Sig1<tab>Time (min)" above "StartOfData"; RepTate's
    .tts and .osc files contain omega [rad/s], G' and G'' [Pa], according to its manual.
    """
    if "StartOfData" in (bare := [line.strip() for line in lines]):
        signals = [_SIGNAL.fullmatch(line) for line in bare]
        names = "\t".join(found[1] for found in signals if found)
        return [names, *lines[bare.index("StartOfData") + 1 :]]
    if suffix in _REPTATE and len(lines) > 1 and _PARAMETERS.match(lines[0]):
        cells = lines[1].split()
        if len(cells) >= len(_OMEGA_MODULI) and all(map(_NUMBER.fullmatch, cells)):
            rows = ["\t".join(line.split()) for line in lines[1:]]
            return ["\t".join(_OMEGA_MODULI), *rows]
    return lines


_SIGNAL = re.compile(r"Sig\d+\s+(.+)")
_PARAMETERS = re.compile(r"\s*\w+\s*=[^;=]*;")
_REPTATE = (".tts", ".osc")
_OMEGA_MODULI = ("omega [rad/s]", "G' [Pa]", "G'' [Pa]")


def _apart(row: Row) -> Row:
    """Return a row, split at blanks if only numbers: RepTate writes blanks between numbers."""
    cells = row[0].split() if len(row) == 1 else row
    return cells if all(map(_NUMBER.fullmatch, cells)) else row


def _workbook(path: Path, sheet: str | None) -> Iterator[tuple[list[Row], str]]:
    cells = sheets_of(path)
    if sheet is not None and sheet not in cells:
        raise ReadError(f"there is no sheet '{shown(sheet)}'", where=path)
    for name, rows in cells.items():
        if sheet in (None, name):
            yield [["" if c is None else str(c) for c in row] for row in rows], "."


def scale_of(
    column: Column, si_unit: str, name: str, stated: str = "", cure: Cure | str = ""
) -> float:
    """Return the factor that converts the numbers of a column to an SI unit.

    Parameters
    ----------
    column
        The column.
    si_unit
        The SI unit.
    name
        Name of the file, for messages.
    stated
        Unit to use if the file states none.
    cure
        What to do if no unit is known.

    Raises
    ------
    ReadError
        If the unit of the column is unknown, or has another dimension.
    """
    unit = column.unit if column.unit not in NO_UNIT else stated
    if not unit:
        raise ReadError(
            f"{name}: the unit of column '{shown(column.label)}' is not stated; units are read "
            "from brackets, or from the row below the names",
            cure=cure,
        )
    try:
        return conversion(unit, si_unit)[0]
    except UnitError as error:
        raise ReadError(f"{name}: column '{shown(column.label)}': {error}") from error
