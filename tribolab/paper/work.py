"""Tasks of the reproduction; each is computed in a worker process and has its own data file."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from tribolab.campaign.store.data_files import write_data
from tribolab.campaign.surfaces.scans import spectra_of_scans, usable_scans
from tribolab.campaign.surfaces.stage import sources_of_surface
from tribolab.core.errors import AnalysisError
from tribolab.core.provenance import made, sha256_of, source_attributes
from tribolab.fit.fit_settings import FitSettings
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.frames import rows_of
from tribolab.records.parts import Row
from tribolab.rig import Scatter
from tribolab.studies import xu2026
from tribolab.studies.comparison import compare_with_paper
from tribolab.studies.tables import dry_contact, lubricated

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.surfaces.plan import PlannedSurface
    from tribolab.records.parts import CurveOutcome

GroupsAndRows = tuple[dict[str, "xr.Dataset"], list[Row]]  # data by group, table rows
_LOWEST_WAVENUMBER = 423.0  # 1/m, lowest wavenumber of the stand-in spectra


@dataclass(frozen=True)
class PaperTask:
    """Task of the reproduction: `kind` is a key of `_KINDS`.

    Parameters
    ----------
    kind, surface
        Kind of task, and the surface.
    folder
        Folder of the results.
    forces
        Normal forces [N] at which the Stribeck curves are computed.
    curves
        Measured curves of the surface in glycerol.
    scans
        Surface with its simulated profiles.
    """

    kind: str
    surface: str
    folder: Path
    forces: tuple[float, ...] = ()
    curves: tuple[CurveOutcome, ...] = ()
    scans: PlannedSurface | None = None


def data_file(folder: Path, kind: str, surface: str) -> Path:
    """Return the path of a task's data file."""
    return folder / "data" / f"{kind}_{surface}.nc"


def compute(task: PaperTask) -> list[Row]:
    """Compute a task, write its data file, and return its table rows, if any."""
    groups, rows = _KINDS[task.kind](task)
    if groups:
        root = _root(task)
        write_data({None: root} | groups, data_file(task.folder, task.kind, task.surface))
    return rows


def _root(task: PaperTask) -> xr.Dataset:
    return xr.Dataset(
        attrs={"surface": task.surface, "references": xu2026.CITATION}
        | made(f"reproduce: {task.kind} {task.surface}", **_origin(task))
    )


def _origin(task: PaperTask) -> dict[str, str]:
    """Return attributes that name the sources of a task's result: files or published constants."""
    if task.scans is not None:
        config = {"campaign": task.scans.config_sha256, "q_low": _LOWEST_WAVENUMBER}
        return source_attributes(sources_of_surface(task.scans)) | {
            "config_sha256": sha256_of(config)
        }
    constants = (xu2026.system, xu2026.surface(task.surface))
    config = {"constants": [asdict(constant) for constant in constants], "forces": task.forces}
    return {"source": xu2026.CITATION, "config_sha256": sha256_of(config)}


def _published(task: PaperTask) -> GroupsAndRows:
    return {}, rows_of(compare_with_paper())


def _dry(task: PaperTask) -> GroupsAndRows:
    return dry_contact(task.surface), []


def _spectrum(task: PaperTask) -> GroupsAndRows:
    """Return the spectrum of the simulated profiles, extrapolated as in a campaign."""
    if task.scans is None:
        raise AnalysisError(f"{task.surface}: there are no scans to make a spectrum of")
    checked = usable_scans(task.scans)
    return spectra_of_scans(task.scans, checked.scans, _LOWEST_WAVENUMBER)[0], []


def _wet(task: PaperTask) -> GroupsAndRows:
    known = dict(xu2026.surface(task.surface).shear_stress)
    groups = lubricated(task.surface, task.forces)
    fitted = [] if task.surface == "Smooth" else [(c, c.normal_force) for c in task.curves]
    rows = [
        _fit(task, curve, force, known[force])
        for curve, force in fitted
        if force is not None and force in known
    ]
    return groups, rows


def _fit(task: PaperTask, curve: CurveOutcome, force: float, printed: float) -> Row:
    """Return a table row: the shear stress fitted to a simulated curve as in the paper."""
    fit = fit_shear_stress(
        read_netcdf(task.folder / curve.data_file),
        xu2026.contact,
        xu2026.psd(task.surface),
        xu2026.system.viscosity,
        xu2026.contact.load(force),
        # one run per load does not show the repeatability, but that of the rig is known
        settings=FitSettings(common_error=Scatter().repeat),
    )
    plain, corrected = (
        fit.curve[f"friction_per_shear_stress{other}"].values for other in ("", "_other")
    )
    return {
        "surface": task.surface,
        "normal_force_N": force,
        "printed_shear_stress_Pa": printed,
        # stress with the corrected area that fits the same solid friction best
        "printed_with_corrected_area_Pa": printed * (plain @ corrected) / (corrected @ corrected),
        "shear_stress_Pa": fit.shear_stress,
        "shear_stress_low_Pa": fit.shear_stress - fit.half_interval,
        "shear_stress_high_Pa": fit.shear_stress + fit.half_interval,
        "shear_stress_error_Pa": fit.total_error,
    }


_KINDS = {"published": _published, "dry": _dry, "spectrum": _spectrum, "wet": _wet}
