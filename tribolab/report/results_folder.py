"""Results folder as a mapping in a notebook: its tables and data, read when needed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.core.errors import ReadError, brief, nearest, shown
from tribolab.core.html_list import html_list
from tribolab.core.untyped import Json
from tribolab.core.wording import many
from tribolab.report import tables

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_OVER_SEGMENTS = ("friction", "segments", "stick_slip")


class Results(Mapping[str, "pd.DataFrame"]):
    """Results folder: its tables by name, and its data, all read when first needed.

    `data` returns data of one run, curve, surface or model; `runs` and `curves` those of all.

    Parameters
    ----------
    folder
        A folder that `tribolab run` wrote.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._files = {path.stem: path for path in sorted((folder / "tables").glob("*.csv"))}

    def __getitem__(self, name: str) -> pd.DataFrame:
        """Return a table; cells escaped for spreadsheets have their original text again."""
        if name not in self._files:
            raise ReadError(
                f"{self.folder}: there is no table '{shown(name)}'{nearest(name, self._files)}"
            )
        return tables.read_csv(self._files[name])

    def __contains__(self, name: object) -> bool:
        """Whether a table exists."""
        return name in self._files

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the tables."""
        return iter(self._files)

    def __len__(self) -> int:
        """Return the number of tables."""
        return len(self._files)

    def _repr_html_(self) -> str:
        """Return the tables with their columns as HTML, for display in a notebook."""
        columns = []
        for name, path in self._files.items():
            with path.open(encoding="utf-8") as lines:
                columns.append((name, lines.readline().strip().replace(",", ", ")))
        return html_list(f"{self.folder}: {many(len(self), 'table')}", columns)

    def data(self, name: str, group: str | None = None) -> xr.Dataset:
        """Return one group from the data file of a run, curve, surface or model.

        For example, ``data("x_01", "friction")`` returns the friction of the run x_01.

        Raises
        ------
        ReadError
            If the data file does not exist.
        """
        # imported late for a quick start
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
        """Return the segments of all runs in one dataset.

        Parameters
        ----------
        group
            ``"friction"``, ``"segments"`` or ``"stick_slip"``.

        Returns
        -------
        xarray.Dataset
            Variables (run, segment), with the coordinates ``surface``, ``medium``, ``quality`` and
            ``nominal_normal_force`` [N] (run), e.g. ``runs.groupby("surface").mean("run")`` or
            ``runs.where(runs.medium == "dry", drop=True)``. Missing segments are NaN. Failed runs
            are left out; segments rejected by a person are included, and ``runs.where(runs.rejected
            != 1)`` removes them. Signals over time are not included: use `data` for those of one
            run.

        Raises
        ------
        ReadError
            If the group does not exist, or a file cannot be read.
        """
        # imported late for a quick start
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
        """Return all measured Stribeck curves on common axes.

        Returns
        -------
        xarray.Dataset
            ``friction_coefficient`` and the other variables of `measured_stribeck_curve` over
            (surface, medium, normal_force, sliding_speed), e.g. ``curves.sel(surface="Sb-R",
            medium="dry")``; NaN where nothing was measured. Speeds that differ by at most a tenth
            are joined at their geometric mean, and ``measured_speed`` contains the original ones. A
            run without surface and medium appears under its own name. `tribolab.plot.stribeck`
            draws all curves.

        Raises
        ------
        ReadError
            If a file cannot be read.
        """
        # imported late for a quick start
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
        # imported late for a quick start
        from tribolab.reading.netcdf.netcdf import read_netcdf

        return read_netcdf(self.folder / file, group=group)


def _number(value: float | None) -> float:
    return float("nan") if value is None else float(value)


def read_results(path: str | Path) -> Results | xr.Dataset:
    r"""Read a results folder, or the results file of a roughness tester.

    Parameters
    ----------
    path
        A folder written by `tribolab run`, or a tester's file.

    Returns
    -------
    Results or xarray.Dataset
        For a folder its tables by name, its data, and all its runs or curves at once
        (``results.runs()``, ``results.curves()``); for a file the result of
        `tribolab.reading.scans.results.read_tester_results`.

    Raises
    ------
    ReadError
        If the path is neither.

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
        # imported late for a quick start
        from tribolab.reading.scans.results import read_tester_results

        return read_tester_results(path)
    if not (path / "tables").is_dir():
        raise ReadError(
            f"{path}: no folder of results: it has no tables/; name the folder that 'tribolab run' "
            "wrote, e.g. results"
        )
    return Results(path)
