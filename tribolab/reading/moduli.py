"""Storage and loss modulus against frequency, from files of rheometers and DMA instruments."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import Cure, ReadError, UnitError, shown
from tribolab.reading.modulus_tables import (
    HEAD,
    NO_UNIT,
    Column,
    Table,
    find_table,
    numbers_of,
    scale_of,
)
from tribolab.reading.raw.source import read_unchanged
from tribolab.units.conversion import to_si
from tribolab.units.quantities import unit_conversion
from tribolab.units.reciprocals import reciprocal

SHEAR_TO_TENSILE = 3.0  # E = 2 (1 + nu) G of an incompressible solid
_SAME_FREQUENCY = 1e-3  # relative difference of equal set-points due to rounding
_SAME_TEMPERATURE = 3.0  # K, variation of the oven temperature within one sweep


class ModulusTable(NamedTuple):
    """Tensile storage and loss modulus from a file, sorted by frequency.

    `angular_frequency` [rad/s], `storage` and `loss` [Pa] have dims (n); `temperature` [C] is NaN
    if the file states none; `remarks` list assumptions.
    """

    angular_frequency: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    temperature: float
    remarks: tuple[str, ...]


def read_modulus_table(
    path: str | Path,
    sweep: int | str | None = None,
    sheet: str | None = None,
    unit: str | None = None,
) -> ModulusTable:
    """Read storage and loss modulus against frequency from an export of any instrument.

    Parameters
    ----------
    path
        Delimited or aligned text in any common encoding, or a workbook. Required are columns of
        frequency or angular frequency, and of two of: storage modulus, loss modulus, loss factor,
        complex modulus with its phase angle. Units are in brackets or in a row of their own.
    sweep
        Which of several sweeps in the file: its number from 0, or its temperature ("25 C").
    sheet
        Name of the workbook's sheet; if not given, the first that has such a table.
    unit
        Unit of the moduli ("MPa"), for a file that does not state it.

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
    table = read_unchanged([path], lambda: find_table(path, sheet))
    remarks: list[str] = []
    data = _in_si(table, unit, path.name, remarks)
    if data.shape[1] < 2:
        raise ReadError(f"{path.name}: the modulus has fewer than two rows of numbers")
    data = _possible(_one_sweep(data, sweep, path.name), path.name, remarks)
    if table.shear:
        data[1:3] *= SHEAR_TO_TENSILE
        remarks.append("the shear modulus is multiplied by 3, as for an incompressible solid")
    elif table.shear is None:
        remarks.append("the names say neither shear nor tension: taken for moduli of tension")
    data = data[:, np.argsort(data[0], kind="stable")]
    return ModulusTable(data[0], data[1], data[2], float(np.median(data[3])), tuple(remarks))


def is_modulus_file(path: str | Path) -> bool:
    """Whether the first rows of a file are a table of storage and loss modulus."""
    try:
        find_table(Path(path), None, HEAD)
    except (ReadError, OSError):  # the reader of the file reports why it cannot be opened
        return False
    return True


def _in_si(table: Table, unit: str | None, name: str, remarks: list[str]) -> np.ndarray:
    """Return angular frequency [rad/s], both moduli [Pa] and temperature as rows (4, n)."""
    rows = [numbers_of(row, table.columns, table.decimal) for row in table.rows]
    values = np.array([row for row in rows if row is not None], dtype=float).reshape(
        -1, len(table.columns)
    )
    data = dict(zip(table.columns, values.T, strict=True))
    found = table.columns.get("angular_frequency") or table.columns["modulus_frequency"]
    omega = data[found.concept] * _to_angular(found, name, remarks)
    cure = Cure(
        notebook="say it with unit='MPa'",
        terminal=f'state it in a campaign file: modulus_file = "{name}", modulus_unit = "MPa" in '
        "[contact]",
        campaign='state it: modulus_unit = "MPa" in [contact]',
    )
    moduli = {
        concept: data[concept] * scale_of(table.columns[concept], "Pa", name, unit or "", cure)
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
            else data["phase_angle"] * scale_of(table.columns["phase_angle"], "rad", name, "deg")
        )
        storage, loss = (moduli["complex_modulus"] * f(phase) for f in (np.cos, np.sin))
    temperature = data.get("temperature", np.full(len(omega), np.nan))
    result = np.stack([omega, storage, loss, temperature])
    return result[:, np.isfinite(result[:3]).all(axis=0)]


def _to_angular(column: Column, name: str, remarks: list[str]) -> float:
    """Return the factor from a frequency column to rad/s; raise if name and unit contradict."""
    angular, unit = column.concept == "angular_frequency", column.unit
    if unit in NO_UNIT:
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


def _possible(data: np.ndarray, name: str, remarks: list[str]) -> np.ndarray:
    """Leave out rows with a negative modulus, which no passive solid has: the force was too small.

    File: a Mettler DMA below 0.1 Hz, with 0.3 % of the force at higher frequencies
    (MahdiTBT/DMA-analysis-suite).
    """
    if data[0].min() <= 0:
        raise ReadError(
            f"{name}: frequencies of zero or below, e.g. {data[0].min():.3g} rad/s: are they "
            "logarithms? write frequencies and moduli themselves"
        )
    good = (data[1] > 0) & (data[2] >= 0)
    if good.sum() < 2:
        raise ReadError(f"{name}: the moduli are negative, which no passive solid has")
    if not good.all():
        hertz = data[0, ~good] / (2 * np.pi)
        remarks.append(
            f"{(~good).sum()} rows with a negative modulus are left out ({hertz.min():.3g} to "
            f"{hertz.max():.3g} Hz): rows next to them were measured no better, check them"
        )
    return data[:, good]


def _one_sweep(data: np.ndarray, sweep: int | str | None, name: str) -> np.ndarray:
    """Return one sweep of the data; a new sweep begins where the frequency changes direction."""
    if np.ptp(data[0]) <= _SAME_FREQUENCY * data[0].max():
        hertz = float(np.median(data[0])) / (2 * np.pi)
        raise ReadError(
            f"{name}: every row is at {hertz:.3g} Hz, so that it is a sweep of stress, strain, "
            "temperature or time; a modulus over frequency is wanted"
        )
    steps = np.sign(np.diff(data[0]))
    usual = np.sign(np.sum(steps)) or 1.0
    sweeps = np.split(data, np.flatnonzero(steps != usual) + 1, axis=1)
    # RheoWin: 100 s at one frequency between two sweeps (PetrusKirsten/RheometerPlots)
    sweeps = [part for part in sweeps if part.shape[1] > 1] or sweeps
    data = np.concatenate(sweeps, axis=1)
    if sweep is None and len(sweeps) == 1:
        return data
    if sweep is None and np.unique(data[0]).size == data.shape[1]:
        return data  # a master curve with unordered rows
    if isinstance(sweep, str):
        return _at_temperature(sweeps, sweep, name)
    if sweep is None or not 0 <= sweep < len(sweeps):
        last = len(sweeps) - 1
        warm = [float(np.median(s[3])) for s in sweeps]
        ends = dict.fromkeys(f"{celsius:.3g}" for celsius in (min(warm), max(warm)))
        between = f"at {' to '.join(ends)} C " if np.isfinite(warm).all() else ""
        raise ReadError(
            f"frequencies repeat, {len(sweeps)} sweeps {between}are in it",
            where=name,
            cure=Cure(
                notebook=f"name one with sweep=0 to {last}, or give a master curve",
                terminal=f'name one in a campaign file: modulus_file = "{name}", '
                f"sweep = 0 to {last} in [contact], or give a master curve",
                campaign=f"name one with sweep = 0 to {last} in [contact], or give a master curve",
            ),
        )
    return sweeps[sweep]


def _at_temperature(sweeps: Sequence[np.ndarray], wanted: str, name: str) -> np.ndarray:
    text = wanted if any(map(str.isalpha, wanted)) else f"{wanted} degC"
    try:
        celsius = to_si(text, "K", "sweep") - 273.15
    except UnitError as error:
        what = f"{name}: sweep '{shown(wanted)}': a temperature is wanted, e.g. \"25 C\""
        raise ReadError(what) from error
    apart = [abs(float(np.median(sweep[3])) - celsius) for sweep in sweeps]
    best = int(np.argmin(apart)) if np.isfinite(apart).any() else 0
    if not apart[best] <= _SAME_TEMPERATURE:
        raise ReadError(f"{name}: no sweep at {celsius:.4g} C is in it")
    return sweeps[best]
