"""Storage and loss modulus over frequency, from the files of rheometers and DMA instruments."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.errors import Cure, ReadError, UnitError, shown
from tribolab.quantities import unit_conversion
from tribolab.reading.lexicon.lexicon import known_words, names, normalise_label
from tribolab.reading.raw.opening import damage_told, isolated
from tribolab.reading.raw.source import check_regular, read_unchanged
from tribolab.turns import reciprocal
from tribolab.units import conversion

SHEAR_TO_TENSILE = 3.0  # E = 2 (1 + nu) G of an incompressible solid
_LARGEST = 32 << 20  # bytes of a table in text
_HEAD = 200  # rows among which the names stand
_LONGEST, _WIDEST = 80, 300  # letters of a name, and columns
_WORKBOOKS = (".xls", ".xlsx", ".xlsm", ".ods")
_PRIMES = str.maketrans({"\u2032": "'", "\u2019": "'", "\u00b4": "'", "\u2033": '"', "\u201d": '"'})
_UNIT = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$")  # behind "G' in"
_IN = re.compile(r"\bin$")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_COMMA, _POINT = (re.compile(rf"(?<![\d{s}])\d+{s}\d+(?![\d{s}])") for s in (",", r"\."))
_NO_UNIT = ("", "-", "1", "[]", "[-]", "[1]")
_SHEAR = re.compile(r"\bshear|schub|scher|torque|drehmoment", re.IGNORECASE)
_SAME_TEMPERATURE = 3.0  # K: what an oven leaves within one sweep
Row = list[str]


class ModulusTable(NamedTuple):
    """A modulus as a file holds it, sorted by frequency.

    `angular_frequency` [rad/s], `storage` and `loss` [Pa] of tension (n); `temperature` [C], NaN
    where the file has none; `remarks` say what was taken for granted.
    """

    angular_frequency: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    temperature: float
    remarks: tuple[str, ...]


class _Column(NamedTuple):
    place: int
    label: str
    concept: str
    unit: str


class _Table(NamedTuple):
    columns: dict[str, _Column]
    rows: list[Row]
    shear: bool
    decimal: str


def read_modulus_table(
    path: str | Path,
    sweep: int | str | None = None,
    sheet: str | None = None,
    unit: str | None = None,
) -> ModulusTable:
    """Read storage and loss modulus over frequency, in whatever way instruments write them.

    Parameters
    ----------
    path
        Delimited or aligned text in any common encoding, or a workbook. Wanted are columns of a
        frequency or angular frequency, and of two of: storage modulus, loss modulus, loss factor,
        complex modulus with its phase angle. Units stand in brackets or in a row of their own.
    sweep
        Which sweep of a file that holds several: its number from 0, or its temperature ("25 C").
    sheet
        Name of the workbook's sheet; if not given, the first that has such a table.
    unit
        Of the moduli, for a file that does not state it ("MPa").

    Returns
    -------
    ModulusTable
        Shear moduli are multiplied by 3, as for an incompressible solid.

    Raises
    ------
    ReadError
        If there is no such table, a unit is missing, or there are several sweeps and none is named.
    """
    path = Path(path)
    table = read_unchanged([path], lambda: _find_table(path, sheet))
    remarks: list[str] = []
    data = _in_si(table, unit, path.name, remarks)
    if data.shape[1] < 2:
        raise ReadError(f"{path.name}: the modulus has fewer than two rows of numbers")
    data = _one_sweep(data, sweep, path.name)
    if table.shear:
        data[1:3] *= SHEAR_TO_TENSILE
        remarks.append("the shear modulus is multiplied by 3, as for an incompressible solid")
    data = data[:, np.argsort(data[0], kind="stable")]
    return ModulusTable(data[0], data[1], data[2], float(np.median(data[3])), tuple(remarks))


def holds_modulus(path: str | Path) -> bool:
    """Whether a file holds a table of storage and loss modulus over frequency, by its beginning."""
    try:
        _find_table(Path(path), None, _HEAD)
    except (ReadError, OSError):  # whoever reads it says why it cannot be opened
        return False
    return True


def _find_table(path: Path, sheet: str | None, longest: int | None = None) -> _Table:
    check_regular(path)
    seen: dict[str, None] = {}
    workbook = path.suffix.lower() in _WORKBOOKS
    for rows, decimal in _workbook(path, sheet) if workbook else _text(path, longest):
        for place, row in enumerate(rows[:_HEAD]):
            if len(row) > _WIDEST:
                continue
            columns = _columns(row)
            seen |= dict.fromkeys(cell.strip() for cell in row if _concept(_bare(cell)[0]))
            if _enough(columns):
                return _table_below(rows, place, columns, decimal)
    # what a file that is no such table holds is not told: it may be anything
    said = shown(", ".join(seen), 200) or "none of them"
    raise ReadError(
        f"{path.name}: columns for frequency, storage and loss modulus are wanted, e.g. f, E', "
        f"E''; it has {said}"
    )


def _columns(row: Row) -> dict[str, _Column]:
    """Return the first column for each concept that a row names."""
    found: dict[str, _Column] = {}
    for place, cell in enumerate(row):
        label, unit = _bare(cell)
        if (concept := _concept(label)) and concept not in found:
            found[concept] = _Column(place, cell.strip(), concept, unit)
    return found


def _bare(cell: str) -> tuple[str, str]:
    """Separate a name from a unit in brackets behind it.

    >>> _bare("G' in [Pa]"), _bare('E" (MPa)'), _bare("Tan(delta)")
    (("G'", 'Pa'), ('E"', 'MPa'), ('Tan(delta)', ''))
    """
    cell = cell.strip()
    match = _UNIT.search(cell) if len(cell) <= _LONGEST else None
    if match is None or normalise_label(match[1]) in ("delta", "δ"):
        return cell, ""
    return _IN.sub("", cell[: match.start()].strip()).strip(), match[1].strip()


def _concept(label: str) -> str:
    """Return what of a modulus a name stands for; "" if nothing.

    >>> [_concept(label) for label in ("f", 'E"', "G'", "Tan(delta)", "|G*|", "Step time")]
    ['modulus_frequency', 'loss_modulus', 'storage_modulus', 'loss_factor', 'complex_modulus', '']
    """
    if len(label) > _LONGEST:
        return ""
    text = label.translate(_PRIMES).replace("''", "pp").replace('"', "pp").replace("'", "p")
    words = text.replace("*", "star").split()
    whole, without_symbol = (normalise_label(" ".join(part)) for part in (words, words[:-1]))
    for word in known_words("modulus"):
        if whole in word.symbols or {whole, without_symbol} & names(word.quantity):
            return word.quantity  # "Storage modulus E'" is its name and its symbol
    return "temperature" if whole in ("t", "temp", "ts", *names("temperature")) else ""


def _enough(columns: dict[str, _Column]) -> bool:
    frequency = {"angular_frequency", "modulus_frequency"} & set(columns)
    return bool(frequency) and any(set(pair) <= set(columns) for pair in _PAIRS)


_PAIRS = (
    ("storage_modulus", "loss_modulus"),
    ("storage_modulus", "loss_factor"),
    ("complex_modulus", "phase_angle"),
    ("complex_modulus", "loss_factor"),
)


def _table_below(rows: Sequence[Row], place: int, columns: dict[str, _Column], dec: str) -> _Table:
    """Return the columns with their units, and all rows of numbers below, also of later blocks."""
    numeric = [
        n for n in range(place + 1, len(rows)) if _numbers(rows[n], columns, dec) is not None
    ]
    first = numeric[0] if numeric else len(rows)
    units = next((row for row in rows[place + 1 : first] if any(cell.strip() for cell in row)), [])
    told = {
        concept: column
        if column.unit or column.place >= len(units)
        # a unit may stand in brackets, or bare
        else column._replace(unit=units[column.place].strip().strip("[]()").strip())
        for concept, column in columns.items()
    }
    labels = " ".join(rows[place])
    gs = normalise_label(told.get("storage_modulus", told.get("complex_modulus", _NONE)).label)
    tensile = gs.startswith("e") or "tensile" in labels.lower()
    shear = not tensile and (gs.startswith("g") or _SHEAR.search(labels) is not None)
    return _Table(told, [rows[n] for n in numeric], shear, dec)


_NONE = _Column(0, "", "", "")


def _numbers(row: Row, columns: dict[str, _Column], decimal: str) -> list[float] | None:
    """Return the numbers of a row in the columns' order; None where it is no row of the table."""
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


def _in_si(table: _Table, unit: str | None, name: str, remarks: list[str]) -> np.ndarray:
    """Return angular frequency, storage, loss and temperature (4, n) of tension or shear."""
    rows = [_numbers(row, table.columns, table.decimal) for row in table.rows]
    values = np.array([row for row in rows if row is not None], dtype=float).reshape(
        -1, len(table.columns)
    )
    data = dict(zip(table.columns, values.T, strict=True))
    found = table.columns.get("angular_frequency") or table.columns["modulus_frequency"]
    omega = data[found.concept] * _to_angular(found, name, remarks)
    moduli = {
        concept: data[concept] * _scale(table.columns[concept], "Pa", unit, name)
        for concept in ("storage_modulus", "loss_modulus", "complex_modulus")
        if concept in data
    }
    if "storage_modulus" in moduli and "loss_modulus" in moduli:
        storage, loss = moduli["storage_modulus"], moduli["loss_modulus"]
    elif "storage_modulus" in moduli:
        storage = moduli["storage_modulus"]
        loss = storage * data["loss_factor"]
    else:
        phase = (
            np.arctan(data["loss_factor"])
            if "loss_factor" in data
            else data["phase_angle"] * _phase_scale(table.columns["phase_angle"], name)
        )
        storage, loss = (moduli["complex_modulus"] * f(phase) for f in (np.cos, np.sin))
    temperature = data.get("temperature", np.full(len(omega), np.nan))
    result = np.stack([omega, storage, loss, temperature])
    return result[:, np.isfinite(result[:3]).all(axis=0)]


def _scale(column: _Column, si_unit: str, stated: str | None, name: str) -> float:
    unit = column.unit if column.unit not in _NO_UNIT else (stated or "")
    if not unit:
        raise ReadError(
            f"{name}: the unit of column '{shown(column.label)}' is not stated; units are read "
            "from brackets, or from the row below the names",
            cure=Cure(
                notebook="say it with unit='MPa'",
                terminal="write it behind the name in brackets, e.g. 'Storage modulus [MPa]'",
                campaign='say it: modulus_unit = "MPa" in [contact]',
            ),
        )
    try:
        return conversion(unit, si_unit)[0]
    except UnitError as error:
        raise ReadError(f"{name}: column '{shown(column.label)}': {error}") from error


def _phase_scale(column: _Column, name: str) -> float:
    return _scale(column, "rad", "deg", name)


def _to_angular(column: _Column, name: str, remarks: list[str]) -> float:
    """Scale to rad/s; a name that says omega and a unit that does not say radians contradict."""
    angular, unit = column.concept == "angular_frequency", column.unit
    if unit in _NO_UNIT:
        unit = "rad/s" if angular else "Hz"
        remarks.append(f"'{shown(column.label)}' has no unit and is taken for {unit}")
    known = reciprocal(unit)
    if angular and known is not None and known.counts == "cycles":
        raise ReadError(
            f"{name}: column '{shown(column.label)}': the name says radians, the unit "
            f"'{shown(unit)}' cycles, a factor of 2 pi apart; write 'rad/s' as the unit, or 'f' as "
            "the name"
        )
    try:
        if angular or "rad" in unit:
            return unit_conversion(unit, "angular_frequency")[0]
        return 2 * np.pi * unit_conversion(unit, "frequency")[0]
    except UnitError as error:
        raise ReadError(f"{name}: column '{shown(column.label)}': {error}") from error


def _one_sweep(data: np.ndarray, sweep: int | str | None, name: str) -> np.ndarray:
    """Return the sweep asked for; a new one begins where the frequency turns back."""
    steps = np.sign(np.diff(data[0]))
    usual = np.sign(np.sum(steps)) or 1.0
    sweeps = np.split(data, np.flatnonzero(steps != usual) + 1, axis=1)
    if sweep is None and len(sweeps) == 1:
        return data
    if sweep is None and np.unique(data[0]).size == data.shape[1]:
        return data  # a master curve whose rows are in no order
    if isinstance(sweep, str):
        return _at_temperature(sweeps, sweep, name)
    if sweep is None or not 0 <= sweep < len(sweeps):
        last = len(sweeps) - 1
        warm = [float(np.median(s[3])) for s in sweeps]
        if np.isfinite(warm).all():
            between = f"at {min(warm):.3g} to {max(warm):.3g} C "
        else:
            between = ""
        raise ReadError(
            f"frequencies repeat, {len(sweeps)} sweeps {between}are in it",
            where=name,
            cure=Cure(
                notebook=f"name one with sweep=0 to {last}, or give a master curve",
                terminal="give a master curve",
                campaign=f"name one with sweep = 0 to {last} in [contact], or give a master curve",
            ),
        )
    return sweeps[sweep]


def _at_temperature(sweeps: Sequence[np.ndarray], wanted: str, name: str) -> np.ndarray:
    kelvin = conversion(re.sub(r"[-+\d.\s]+", "", wanted) or "degC", "K")
    number = _NUMBER.match(wanted.strip())
    if number is None:
        raise ReadError(f"{name}: sweep '{shown(wanted)}': a temperature is wanted, e.g. \"25 C\"")
    celsius = float(number[0]) * kelvin[0] + kelvin[1] - 273.15
    apart = [abs(float(np.median(sweep[3])) - celsius) for sweep in sweeps]
    best = int(np.argmin(apart)) if np.isfinite(apart).any() else 0
    if not apart[best] <= _SAME_TEMPERATURE:
        raise ReadError(f"{name}: no sweep at {celsius:.4g} C is in it")
    return sweeps[best]


def _text(path: Path, longest: int | None) -> Iterator[tuple[list[Row], str]]:
    """Yield the rows of a text for each delimiter that may be its own."""
    try:
        with path.open("rb") as file:
            raw = file.read(_LARGEST + 1 if longest is None else 400 * longest)
    except OSError as error:
        raise ReadError(f"{path}: the file cannot be opened: {error}") from error
    if len(raw) > _LARGEST:
        raise ReadError(f"{path.name}: {path.stat().st_size >> 20} MB are no table of a modulus")
    lines = _decoded(raw).splitlines()[:longest]
    for delimiter in ("\t", ";", ",", "  ", " "):
        if delimiter.isspace() and delimiter != "\t":  # columns are aligned
            rows = [re.split(rf"\s{{{len(delimiter)},}}", line.strip()) for line in lines]
        else:
            try:
                rows = list(csv.reader(lines, delimiter=delimiter))
            except csv.Error:
                continue
        comma = delimiter != "," and any(map(_COMMA.search, lines))
        yield rows, "," if comma and not any(map(_POINT.search, lines)) else "."


def _decoded(raw: bytes) -> str:
    for mark, encoding in (
        (codecs.BOM_UTF8, "utf-8-sig"),
        (codecs.BOM_UTF16_LE, "utf-16"),
        (codecs.BOM_UTF16_BE, "utf-16"),
    ):
        if raw.startswith(mark):
            return raw.decode(encoding, errors="replace")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def _workbook(path: Path, sheet: str | None) -> Iterator[tuple[list[Row], str]]:
    for cells in _sheets(path, sheet):
        yield cells, "."


@isolated("pandas", "python_calamine")
def _sheets(path: Path, sheet: str | None) -> list[list[Row]]:
    # late: a library that takes long to load, in the child alone
    import pandas as pd

    wanted = None if sheet is None else [sheet]
    with damage_told(path, "workbook"):
        found = pd.read_excel(path, sheet_name=wanted, dtype=object, header=None, engine="calamine")
    return [
        [["" if c is None or c != c else str(c) for c in row] for row in one.to_numpy(dtype=object)]
        for one in found.values()
    ]
