"""Results of earlier runs, back in a notebook: tables as they were written, data when asked for."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.errors import ReadError, brief, nearest, shown
from tribolab.core.untyped import Json
from tribolab.report import tables

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_OVER_SEGMENTS = ("friction", "segments", "stick_slip")


class Results(Mapping[str, "pd.DataFrame"]):
    """The tables of a results folder by name, read when asked for, and its data.

    `data` gives a part of one run, curve, surface or model, `runs` and `curves` all of them at
    once.

    Parameters
    ----------
    folder
        A folder that `tribolab run` wrote.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._files = {path.stem: path for path in sorted((folder / "tables").glob("*.csv"))}

    def __getitem__(self, name: str) -> pd.DataFrame:
        """Return a table, text as it was before it was made harmless for spreadsheets."""
        if name not in self._files:
            raise ReadError(
                f"{self.folder}: there is no table '{shown(name)}'{nearest(name, self._files)}"
            )
        return tables.read_csv(self._files[name])

    def __contains__(self, name: object) -> bool:
        """Say whether there is such a table."""
        return name in self._files

    def __iter__(self) -> Iterator[str]:
        """Go through the tables' names."""
        return iter(self._files)

    def __len__(self) -> int:
        """Return how many tables there are."""
        return len(self._files)

    def data(self, name: str, group: str | None = None) -> xr.Dataset:
        """Return a part of a run, curve, surface or model, e.g. ``data("x_01", "friction")``.

        Raises
        ------
        ReadError
            If there is no such data file.
        """
        # late: starting stays quick
        from tribolab.reading.netcdf.netcdf import read_netcdf

        known = {path.stem: path for path in sorted((self.folder / "data").glob("*.nc"))}
        if name not in known:
            raise ReadError(
                f"{self.folder}: there are no data of '{shown(name)}'{nearest(name, known)}"
            )
        return read_netcdf(known[name], group=group)

    @cached_property
    def _report(self) -> Json:
        path = self.folder / "report.json"
        try:
            report: Json = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise ReadError(f"{path}: the report cannot be read: {brief(error)}") from error
        return report

    def runs(self, group: str = "friction") -> xr.Dataset:
        """Return the segments of all runs side by side, read when asked for.

        Parameters
        ----------
        group
            ``"friction"``, ``"segments"`` or ``"stick_slip"``.

        Returns
        -------
        xarray.Dataset
            Over (run, segment), with the coordinates ``surface``, ``medium``, ``quality`` and
            ``nominal_normal_force`` [N] over (run), e.g. ``runs.groupby("surface").mean("run")`` or
            ``runs.where(runs.medium == "dry", drop=True)``. Where a run has fewer segments there
            is NaN. Runs that failed are not in it; segments that a person rejected are, and
            ``runs.where(runs.rejected != 1)`` leaves them out. Signals over time have no segments
            in common: `data` has those of one run.

        Raises
        ------
        ReadError
            If there is no such group, or a file cannot be read.
        """
        # late: starting stays quick
        from tribolab.report.compared import joined_runs

        if group not in _OVER_SEGMENTS:
            raise ReadError(
                f"{self.folder}: no results over segments are called '{shown(group)}'"
                f"{nearest(group, _OVER_SEGMENTS)}; there are {', '.join(_OVER_SEGMENTS)}, and "
                "data(name, group) has the rest of one run"
            )
        done = [run for run in self._report["runs"] if run["data_file"]]
        parts = {run["name"]: self._part(run["data_file"], group) for run in done}
        facts = {
            run["name"]: {**run, "normal_force": _number(run["nominal_normal_force_N"])}
            for run in done
        }
        return joined_runs(parts, facts)

    def curves(self) -> xr.Dataset:
        """Return all measured Stribeck curves on common axes, read when asked for.

        Returns
        -------
        xarray.Dataset
            ``friction_coefficient`` and the rest of `measured_stribeck_curve` over (surface,
            medium, normal_force, sliding_speed), so that
            ``curves.sel(surface="Sb-R", medium="dry")`` is what it says; NaN where nothing was
            measured. Speeds that differ by no more than a tenth stand together at their geometric
            mean, and ``measured_speed`` is each curve's own. A run of which neither surface nor
            medium is stated stands under its own name. `tribolab.plot.stribeck` draws them all.

        Raises
        ------
        ReadError
            If a file cannot be read.
        """
        # late: starting stays quick
        from tribolab.friction.joined import joined_curves

        files = {path.stem: path for path in (self.folder / "data").glob("*.nc")}
        known = [curve for curve in self._report["curves"] if curve["name"] in files]
        return joined_curves(
            [
                (
                    self._part(f"data/{curve['name']}.nc", None),
                    {
                        "surface": curve["surface"]
                        or ("" if curve["medium"] else curve["runs"][0]),
                        "medium": curve["medium"],
                        "normal_force": _number(curve["nominal_normal_force_N"]),
                    },
                )
                for curve in known
            ]
        )

    def _part(self, file: str, group: str | None) -> xr.Dataset:
        # late: starting stays quick
        from tribolab.reading.netcdf.netcdf import read_netcdf

        return read_netcdf(self.folder / file, group=group)


def _number(value: float | None) -> float:
    return float("nan") if value is None else float(value)


def read_results(path: str | Path) -> Results | xr.Dataset:
    r"""Read a results folder; or the file of results that a roughness tester wrote.

    Parameters
    ----------
    path
        A folder that `tribolab run` wrote, or a tester's file.

    Returns
    -------
    Results or xarray.Dataset
        Of a folder its tables by name, its data, and all its runs or curves at once
        (``results.runs()``, ``results.curves()``); of a file what
        `tribolab.reading.scans.results.read_tester_results` says.

    Raises
    ------
    ReadError
        If it is neither.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> (folder / "tables").mkdir()
    >>> _ = (folder / "tables" / "runs.csv").write_text("run,mu\n'=1+1,0.5\n")
    >>> read_results(folder)["runs"].to_dict("records")
    [{'run': '=1+1', 'mu': 0.5}]
    """
    path = Path(path)
    if not path.is_dir():
        # late: starting stays quick
        from tribolab.reading.scans.results import read_tester_results

        return read_tester_results(path)
    if not (path / "tables").is_dir():
        raise ReadError(
            f"{path}: no folder of results: it has no tables/; name the folder that 'tribolab run' "
            "wrote, e.g. results"
        )
    return Results(path)
