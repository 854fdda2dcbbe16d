"""Data files of the reproduction, from which its figures are drawn."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.campaign.store.data_files import read_data
from tribolab.core.wording import speed_text
from tribolab.paper.work import data_file
from tribolab.plot import Trace
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.studies import xu2026

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from tribolab.figures.subjects.slip import Trace
    from tribolab.records.parts import CurveOutcome, RunOutcome

_KEPT = 64  # number of data sets kept in memory, because figures share them unchanged
SURFACES = tuple(xu2026.surfaces)
ROUGH = tuple(name for name in SURFACES if name != "Smooth")


@dataclass(frozen=True)
class PaperData:
    """Computed and simulated data of the reproduction, read on demand.

    Parameters
    ----------
    folder
        Folder of the results.
    runs, curves
        Simulated runs and their measured curves.
    fits
        Shear stresses fitted to the simulated curves, a row each.
    """

    folder: Path
    runs: tuple[RunOutcome, ...]
    curves: tuple[CurveOutcome, ...]
    fits: pd.DataFrame

    @property
    def forces(self) -> list[float]:
        """Normal forces [N] in glycerol, in increasing order."""
        return sorted({f for curve in self.curves if (f := curve.normal_force) is not None})

    def read(self, kind: str, surface: str, group: str) -> xr.Dataset:
        """Return a group of a task's data file."""
        return _read(data_file(self.folder, kind, surface), group)

    def dry(self, group: str) -> dict[str, xr.Dataset]:
        """Return a group of the dry contact for all surfaces."""
        return {name: self.read("dry", name, group) for name in SURFACES}

    def model(self, surface: str, force: float) -> xr.Dataset:
        """Return the computed Stribeck curve of a surface at a force [N], at the rig's speeds."""
        curve = self.read("wet", surface, f"curve_{force:g}N")
        v = curve["sliding_speed"]
        return curve.isel(sliding_speed=np.flatnonzero((v > 3e-7) & (v < 3e-2)))

    def measured(self, surface: str, medium: str, force: float | None = None) -> xr.Dataset:
        """Return a simulated measured curve, by default at the lowest force [N]."""
        force = self.forces[0] if force is None else force
        key = surface, medium, force
        for curve in self.curves:
            if (curve.surface, curve.medium, curve.normal_force) == key:
                labels = {"surface": surface, "medium": medium, "normal_force_N": force}
                return read_data(self.folder / curve.data_file).assign_attrs(labels)
        raise LookupError(f"no simulated curve of {surface}, {medium}, {force:g} N")

    def trace(self, surface: str, medium: str, speed: float) -> Trace:
        """Return the forward stroke at the lowest force whose speed is nearest to `speed` [m/s]."""
        run = next(
            run
            for run in self.runs
            if (run.surface, run.medium, run.normal_force) == (surface, medium, self.forces[0])
        )
        signals, segments, friction = (
            _read(self.folder / run.data_file, group) for group in ("run", "segments", "friction")
        )
        v = segments["sliding_speed"].values
        off = np.abs(np.log(v / speed)) + (segments["direction"].values < 0)
        segment = int(np.nanargmin(off))
        label = f"{surface}, {medium}, {speed_text(float(f'{v[segment]:.2g}'))}"
        return Trace(label, signals, segments, friction, segment, surface)


@functools.lru_cache(_KEPT)
def _read(path: Path, group: str) -> xr.Dataset:
    return read_netcdf(path, group=group)
