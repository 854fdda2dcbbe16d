"""Results of earlier runs, back in a notebook: tables as they were written, data when asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.errors import ReadError, nearest, shown
from tribolab.report import tables

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


class Results(Mapping[str, "pd.DataFrame"]):
    """The tables of a results folder by name, read when asked for; `data` gives a data file.

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
        return tables.read(self._files[name])

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
        from tribolab.io.netcdf import read_netcdf

        known = {path.stem: path for path in sorted((self.folder / "data").glob("*.nc"))}
        if name not in known:
            raise ReadError(
                f"{self.folder}: there are no data of '{shown(name)}'{nearest(name, known)}"
            )
        return read_netcdf(known[name], group=group)


def read_results(path: str | Path) -> Results | xr.Dataset:
    r"""Read a results folder; or the file of results that a roughness tester wrote.

    Parameters
    ----------
    path
        A folder that `tribolab run` wrote, or a tester's file.

    Returns
    -------
    Results or xarray.Dataset
        Of a folder its tables by name, and its data; of a file what
        `tribolab.io.scans.results.read_tester_results` says.

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
        from tribolab.io.scans.results import read_tester_results

        return read_tester_results(path)
    if not (path / "tables").is_dir():
        raise ReadError(
            f"{path}: no folder of results: it has no tables/; name the folder that 'tribolab run' "
            "wrote, e.g. results"
        )
    return Results(path)
