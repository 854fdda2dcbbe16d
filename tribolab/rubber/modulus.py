"""The complex modulus of rubber over frequency: a fractional Zener model, or a measured table."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from tribolab.errors import AnalysisError, Cure, ReadError, UnitError, shown
from tribolab.quantities import unit_conversion
from tribolab.reading.raw.opening import damage_told, isolated
from tribolab.reading.raw.source import check_regular, read_unchanged
from tribolab.turns import reciprocal
from tribolab.units import conversion, positive


class Modulus(Protocol):
    """Whatever gives the complex modulus E(omega) [Pa] at angular frequencies [rad/s]."""

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Complex modulus [Pa], with the shape of the frequencies; E(-omega) = conj(E(omega))."""
        ...


@dataclass(frozen=True)
class FractionalZener:
    """Rubber between a rubbery and a glassy plateau, with a power law of loss between them.

    Parameters
    ----------
    relaxed, unrelaxed
        Modulus of the rubber at zero and of the glass at infinite frequency [Pa].
    relaxation_time
        tau [s]; the loss modulus is largest at omega = 1/tau.
    exponent
        alpha [1], above 0 and at most 1; 1 is the standard linear solid.

    Notes
    -----
    ``E = E_0 + (E_inf - E_0) z/(1 + z)``, ``z = (i omega tau)^alpha``: analytic in the half-plane
    that causality asks for, so that storage and loss obey the Kramers-Kronig relations.

    Examples
    --------
    >>> solid = FractionalZener("1.5 MPa", "1 GPa", "1 ns", 0.5)
    >>> complex(solid(0.0))
    (1500000+0j)
    """

    relaxed: float
    unrelaxed: float
    relaxation_time: float
    exponent: float

    def __post_init__(self) -> None:
        """Turn text into SI floats and refuse what is no solid."""
        for name, unit in (("relaxed", "Pa"), ("unrelaxed", "Pa"), ("relaxation_time", "s")):
            object.__setattr__(self, name, positive(getattr(self, name), unit, name))
        if self.unrelaxed < self.relaxed:
            raise AnalysisError(
                f"unrelaxed: the glass cannot be softer than the rubber; got {self.unrelaxed:g} "
                f"below {self.relaxed:g} Pa"
            )
        if not 0 < self.exponent <= 1:
            raise AnalysisError(
                f"exponent: a value above 0 and at most 1 is wanted; got {self.exponent:g}"
            )

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        omega = np.asarray(angular_frequency, dtype=float)
        turn = np.exp(0.5j * np.pi * self.exponent)
        z = (np.abs(omega) * self.relaxation_time) ** self.exponent * turn
        modulus = self.relaxed + (self.unrelaxed - self.relaxed) * z / (1 + z)
        return np.where(omega < 0, np.conj(modulus), modulus)


# PDMS at 20 C as a stand-in: the paper shows its modulus in a picture only, itself interpolated
# between rubber and glass. Plateaus as stated there; a glass-transition frequency of about 1e9 Hz
# and an exponent of one half are usual for PDMS networks. Good for orders of magnitude.
PDMS_STAND_IN = FractionalZener(1.5e6, 1e9, 1e-10, 0.5)


@dataclass(frozen=True, eq=False)
class TabulatedModulus:
    """A measured modulus, interpolated in the logarithm of the frequency.

    Between entries storage and loss are power laws of the frequency (straight lines in its
    logarithm where the loss is not positive). Outside the table the storage modulus stays what it
    is at the end, and the loss falls as omega below and as 1/omega above, as for one relaxation.

    Parameters
    ----------
    angular_frequency
        [rad/s], strictly increasing, positive (n).
    storage, loss
        E' and E'' [Pa] (n).
    """

    angular_frequency: np.ndarray = field(repr=False)
    storage: np.ndarray = field(repr=False)
    loss: np.ndarray = field(repr=False)

    def __post_init__(self) -> None:
        """Check the table and keep copies nobody can change."""
        for name in ("angular_frequency", "storage", "loss"):
            values = np.array(getattr(self, name), dtype=float)
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        omega, storage, loss = self.angular_frequency, self.storage, self.loss
        if omega.ndim != 1 or omega.size < 2 or not omega.shape == storage.shape == loss.shape:
            raise AnalysisError("modulus: three columns of equal length, two or more rows, wanted")
        if not (np.all(np.diff(omega) > 0) and omega[0] > 0):
            raise AnalysisError("modulus: frequencies must be positive and increase strictly")
        if not (np.all(storage > 0) and np.all(np.isfinite(storage + loss)) and np.all(loss >= 0)):
            raise AnalysisError("modulus: E' must be positive, E'' not negative, both finite")

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        omega = np.asarray(angular_frequency, dtype=float)
        size, ends = np.abs(omega), self.angular_frequency[[0, -1]]
        at, nodes = np.log(np.clip(size, *ends)), np.log(self.angular_frequency)
        storage = np.exp(np.interp(at, nodes, np.log(self.storage)))
        if np.all(self.loss > 0):
            loss = np.exp(np.interp(at, nodes, np.log(self.loss)))
        else:
            loss = np.interp(at, nodes, self.loss)
        loss = loss * np.minimum(size / ends[0], 1) * ends[1] / np.maximum(size, ends[1])
        return storage + 1j * np.sign(omega) * loss

    @property
    def continued(self) -> Modulus:
        """The same table with its power laws of the last decades going on outside.

        What differs between the two is what the table does not tell.
        """
        return _Continued(self)


@dataclass(frozen=True, eq=False)
class _Continued:
    """A table whose storage and loss go on as over its first and last decade, up to a glass."""

    table: TabulatedModulus

    def __call__(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Complex modulus [Pa] at angular frequencies [rad/s] (any shape)."""
        size, table = np.abs(np.asarray(angular_frequency, dtype=float)), self.table
        nodes, moduli = np.log(table.angular_frequency), []
        with np.errstate(divide="ignore"):
            at = np.log(size)
        for values in (table.storage, np.maximum(table.loss, 1e-6 * table.storage)):
            logs = np.log(values)
            inside = np.interp(at, nodes, logs)
            for end, near in (
                (0, nodes <= nodes[0] + _DECADE),
                (-1, nodes >= nodes[-1] - _DECADE),
            ):
                near[[end, 1 if end == 0 else -2]] = True
                slope = float(np.clip(np.polyfit(nodes[near], logs[near], 1)[0], 0.0, 1.0))
                beyond = at < nodes[0] if end == 0 else at > nodes[-1]
                inside = np.where(beyond, logs[end] + slope * (at - nodes[end]), inside)
            moduli.append(np.minimum(np.exp(inside), max(_GLASS, float(values.max()))))
        return moduli[0] + 1j * np.sign(angular_frequency) * moduli[1]


_DECADE = np.log(10.0)
_GLASS = 3e9  # Pa, no polymer is stiffer
_LARGEST = 32 << 20  # bytes of a table in text
_COLUMNS = {
    "frequency": re.compile(r"f|freq(uency)?|omega|ω|w", re.IGNORECASE),
    "storage": re.compile(r"E'|E_?stor(age)?|storage[ _]modulus", re.IGNORECASE),
    "loss": re.compile(r"E''|E\"|E_?loss|loss[ _]modulus", re.IGNORECASE),
}


def read_modulus(
    path: str | Path, sweep: int | None = None, sheet: str | None = None
) -> TabulatedModulus:
    r"""Read storage and loss modulus from a DMA file, a master curve or one sweep of a raw file.

    Parameters
    ----------
    path
        Delimited text (a BOM does no harm) or a spreadsheet (.xls needs python-calamine): a row of
        names, a row of units, then numbers. Names known are f, freq, omega; E', E_stor, storage
        modulus; E'', E_loss, loss modulus.
    sweep
        Number of the sweep, from 0, where frequencies start anew (a raw file, one sweep for each
        temperature). Not for a master curve.
    sheet
        Name of the spreadsheet's sheet; if not given, the one that has the three columns.

    Returns
    -------
    TabulatedModulus
        Sorted by frequency, in rad/s and Pa.

    Raises
    ------
    ReadError
        If a column or its unit is missing, or the file has several sweeps and none is chosen.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "pdms.csv"
    ...     _ = file.write_text("f,E_stor,E_loss\nHz,MPa,MPa\n0.1,1.5,0.1\n10,1.8,0.3\n")
    ...     read_modulus(file).storage
    array([1500000., 1800000.])
    """
    path = Path(path)
    table = read_unchanged([path], lambda: _find_table(path, sheet))
    columns = {}
    for role, pattern in _COLUMNS.items():
        name = next(n for n in table.columns if pattern.fullmatch(n))
        unit = str(table[name].iloc[0]).strip()
        try:
            scale = _to_angular(name, unit) if role == "frequency" else conversion(unit, "Pa")[0]
        except UnitError as error:
            raise ReadError(
                f"{path.name}: column '{shown(name)}': {error}; units are read from the row "
                "below the names"
            ) from error
        numbers = pd.to_numeric(table[name].iloc[1:], errors="coerce").to_numpy(dtype=float)
        columns[role] = numbers * scale
    data = np.stack(list(columns.values()))
    data = data[:, np.isfinite(data).all(axis=0)]
    if np.unique(data[0]).size < data.shape[1] or sweep is not None:
        data = _one_sweep(data, sweep, path.name)
    return TabulatedModulus(*data[:, np.argsort(data[0])])


def _to_angular(name: str, unit: str) -> float:
    """Scale to rad/s; a name that says omega and a unit that does not say radians contradict."""
    angular = name.lower() in ("omega", "ω", "w")
    scale, _ = unit_conversion(unit, "angular_frequency" if angular else "frequency")
    if not angular:
        return 2 * np.pi * scale
    known = reciprocal(unit)
    if known is not None and known.counts == "cycles":
        raise UnitError(
            f"the name says radians, the unit '{shown(unit)}' cycles, a factor of 2 pi apart; "
            f"write 'rad/s' as the unit, or 'f' as the name"
        )
    return scale


def _one_sweep(data: np.ndarray, sweep: int | None, name: str) -> np.ndarray:
    """Return the sweep asked for; a new one begins where the frequency falls back."""
    sweeps = np.split(data, np.flatnonzero(np.diff(data[0]) <= 0) + 1, axis=1)
    if sweep is None or not 0 <= sweep < len(sweeps):
        raise ReadError(
            f"frequencies repeat, {len(sweeps)} sweeps are in it",
            where=name,
            cure=Cure(
                notebook=f"name one with sweep=0 to {len(sweeps) - 1}, or give a master curve",
                terminal="give a master curve",
                campaign="give a master curve as modulus_file of [contact]",
            ),
        )
    return sweeps[sweep]


def _find_table(path: Path, sheet: str | None) -> pd.DataFrame:
    """Return the table that has the three columns, its row of units first."""
    check_regular(path)
    if path.suffix.lower() in (".xls", ".xlsx", ".ods"):
        tables = [pd.DataFrame(t.cells, columns=t.names) for t in _workbook_tables(path, sheet)]
    else:
        tables = [_text_table(path)]
    for table in tables:
        table = table.rename(columns=lambda name: str(name).strip())
        if all(any(map(p.fullmatch, table.columns)) for p in _COLUMNS.values()):
            return table
    names = [str(name).strip() for name in tables[0].columns]
    # what a file that is no such table holds is not told: it may be anything
    known = any(pattern.fullmatch(name) for name in names for pattern in _COLUMNS.values())
    seen = shown(", ".join(names), 200) if known else "none of them"
    raise ReadError(
        f"{path.name}: columns for frequency, storage and loss modulus are wanted, e.g. f, E', "
        f"E''; it has {seen}"
    )


class _Cells(NamedTuple):
    """A sheet: the names of its columns, and the cells below them (row, column)."""

    names: list[str]
    cells: np.ndarray


@isolated("pandas", "python_calamine")
def _workbook_tables(path: Path, sheet: str | None) -> list[_Cells]:
    wanted = None if sheet is None else [sheet]
    with damage_told(path, "workbook"):
        sheets = pd.read_excel(path, sheet_name=wanted, dtype=object, engine="calamine")
    return [_Cells(list(map(str, s.columns)), s.to_numpy(dtype=object)) for s in sheets.values()]


def _text_table(path: Path) -> pd.DataFrame:
    if path.stat().st_size > _LARGEST:
        raise ReadError(f"{path.name}: {path.stat().st_size >> 20} MB are no table of a modulus")
    try:
        return pd.read_csv(path, sep=None, engine="python", dtype=str, encoding="utf-8-sig")
    except (ValueError, csv.Error) as error:  # not UTF-8, empty, or rows of different lengths
        raise ReadError(
            f"{path.name}: this is no table in text (UTF-8): one row of names, one of units, then "
            "numbers are wanted, with as many cells in each"
        ) from error
