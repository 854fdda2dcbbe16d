"""Checks of raw files for `tribolab check`: runs, scans and results of roughness testers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.app.info.file_info import read_scan
from tribolab.campaign.engine.stage import Progress, Stage, perform
from tribolab.core.errors import ConfigError, TribolabError, message_for
from tribolab.core.wording import explain
from tribolab.qc.findings import FindingRow, Findings
from tribolab.qc.run.checks import check_run
from tribolab.reading.kinds import kind_of, repeats_by_name
from tribolab.reading.runs.logs import group_files
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown_run import is_run_file, read_run

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Checked:
    """Result of the checks of one run or scan, or the reason why it could not be read.

    Parameters
    ----------
    files
        Files of the run or scan.
    rows
        Rows of `Findings`; empty if it could not be read.
    status
        The most severe status, or "unreadable".
    summary
        Summary in one line, without the name.
    error
        Reason why it could not be read; "" if it was read.
    kind
        "run", "scan", "results" (of a roughness tester), or "file" if unknown.
    """

    files: tuple[Path, ...]
    rows: tuple[FindingRow, ...] = ()
    status: str = "unreadable"
    summary: str = ""
    error: str = ""
    kind: str = "run"

    @classmethod
    def of(cls, files: Iterable[Path], findings: Findings, kind: str = "run") -> Checked:
        """Return the result of the checks of some files, made from their findings."""
        # the file name is shown before the summary, which must not repeat it
        summary = findings.summary.removeprefix(findings.name).removeprefix(": ")
        return cls(tuple(files), tuple(findings.rows), findings.status, summary, kind=kind)

    @property
    def name(self) -> str:
        """Name of the first file."""
        return self.files[0].name


@dataclass(frozen=True)
class CheckTask:
    """Files to check together: a run, repeated scans with testers' results, or results alone."""

    kind: str
    files: tuple[Path, ...]
    results: tuple[Path, ...] = ()
    instrument: str | Path | None = None


def raw_files_of(paths: Sequence[Path]) -> list[tuple[list[Path], str | None]]:
    """Return the raw files, grouped by the instrument that a campaign file names for them.

    Parameters
    ----------
    paths
        Raw files, folders of raw files, and campaign files (for their runs and scans).

    Examples
    --------
    >>> raw_files_of([Path("a.csv"), Path("b.csv")])
    [([PosixPath('a.csv'), PosixPath('b.csv')], None)]
    """
    found: dict[str | None, list[Path]] = {}
    for path in paths:
        if path.is_dir() or path.suffix == ".toml":
            for files, instrument in _files_below(path):
                found.setdefault(instrument, []).extend(files)
        else:
            found.setdefault(None, []).append(path)
    return [(files, instrument) for instrument, files in found.items()]


def _files_below(path: Path) -> Iterator[tuple[Sequence[Path], str | None]]:
    """Yield groups of raw files in a folder or campaign, each with its instrument."""
    # imported late: single files need no campaign
    from tribolab.app.first_campaign import NAME
    from tribolab.app.raw_folder import files_in
    from tribolab.campaign.settings.files import instrument_of, own_python, scans_of
    from tribolab.campaign.settings.load import load_and_plan

    if path.is_dir() and not (path / NAME).exists():
        yield files_in(path), None
        return
    campaign, runs = load_and_plan(path)
    for run in runs:
        yield run.files, run.instrument
    for surface in campaign.surface:
        named = surface.instrument and instrument_of(campaign, surface.instrument)
        yield scans_of(campaign, surface), named
    if own_python(campaign):
        raise ConfigError(
            f"{path}: the campaign uses readers in Python, which are not run here",
            cure="check the raw files themselves: tribolab check FILES -i READER.py",
        )


class Checks(Stage[CheckTask, "list[Checked]", "list[Checked]"]):
    """Tasks of `tribolab check`: one for each run and for each set of repeated scans.

    Parameters
    ----------
    paths, instrument, repeats
        As for `check_files`.
    """

    name = "checks"

    def __init__(
        self, paths: Iterable[str | Path], instrument: str | Path | None, repeats: bool | None
    ) -> None:
        self.groups = [tuple(g) for g in group_files([Path(p) for p in paths], instrument)]
        self._instrument = instrument
        self._repeats = repeats

    def plan(self) -> list[CheckTask]:
        """Return a task for each run, each set of repeated scans, and each tester's result."""
        kinds = {
            group: _kind_of(group[0], self._instrument) if len(group) == 1 else "run"
            for group in self.groups
        }
        scans = [g[0] for g, kind in kinds.items() if kind not in ("run", "results")]
        results = [g[0] for g, kind in kinds.items() if kind == "results"]
        sets = [scans] if self._repeats else [[path] for path in scans]
        if self._repeats is None:
            sets = repeats_by_name(scans)
        tasks = [CheckTask("run", g, (), self._instrument) for g, k in kinds.items() if k == "run"]
        for files in filter(None, sets):
            own = tuple(r for r in results if any(_are_results_of(r, scan) for scan in files))
            tasks.append(CheckTask("scan", tuple(files), own, self._instrument))
        alone = [r for r in results if not any(_are_results_of(r, scan) for scan in scans)]
        return [*tasks, *(CheckTask("results", (path,)) for path in alone)]

    @staticmethod
    def work(task: CheckTask) -> list[Checked]:
        """Read and check the files of a task."""
        return _WORK[task.kind](task)

    def failed(self, task: CheckTask, error: BaseException) -> list[Checked]:
        """Return the reason why files could not be checked."""
        if isinstance(error, ConfigError):
            raise error  # the instrument is wrong for every file
        groups = [task.files] if task.kind == "run" else [(file,) for file in task.files]
        return [Checked(files, error=_error_text(error), kind="file") for files in groups]

    def keep(self, task: CheckTask, place: int, record: list[Checked]) -> list[Checked]:
        """Return the results of the checks unchanged, because nothing is stored."""
        return record


def _error_text(error: BaseException) -> str:
    """Return why a file cannot be read; for an unexpected error also where it was raised."""
    foreseen = isinstance(error, TribolabError | OSError)
    return message_for(error, "terminal") if foreseen else explain(error)[0]


def _kind_of(path: Path, instrument: str | Path | None) -> str:
    kind = kind_of(path, instrument)
    return "run" if kind == "unknown" and is_run_file(path) else kind


def check_files(
    paths: Iterable[str | Path],
    instrument: str | Path | None = None,
    *,
    repeats: bool | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> list[Checked]:
    """Read and check runs, scans and results of roughness testers; a bad file does not stop others.

    Parameters
    ----------
    paths
        Raw files of any kind; two logs of one run are checked as one run.
    instrument
        Their instrument; by default recognised by content.
    repeats
        Whether all scans are of one surface, so that they are compared with each other. By default,
        scans are compared if their names differ only in the last number.
    executor
        Executor; without one everything is done in this process.
    progress
        Called as ``progress(stage, done, total)``.

    Raises
    ------
    ConfigError
        If the instrument does not exist.
    """
    stage = Checks(paths, instrument, repeats)
    done = perform(stage, executor, progress)
    place = {file: number for number, group in enumerate(stage.groups) for file in group}

    def first(one: Checked) -> int:
        file = one.files[0]
        if file in place:
            return place[file]
        # imported late for a quick start
        from tribolab.reading.scan_files import file_of

        return place[file_of(file)]

    return sorted((c for part in done for c in part), key=first)


def _check_run(task: CheckTask) -> list[Checked]:
    run = read_run(list(task.files) if len(task.files) > 1 else task.files[0], task.instrument)
    return [Checked.of(task.files, check_run(run))]


def _check_scans(task: CheckTask) -> list[Checked]:
    # imported late for a quick start
    from tribolab.qc.scan.sets import check_scan_set

    scans: dict[Path, xr.Dataset] = {}
    results: dict[Path, xr.Dataset] = {}
    checked = []
    for path in (*task.files, *task.results):
        try:
            if path in task.results:
                results[path] = read_tester_results(path)
            else:
                scans |= read_scan(path, task.instrument)
        except ConfigError:
            raise
        except (TribolabError, OSError) as error:
            checked.append(Checked((path,), error=_error_text(error), kind="file"))
    if scans:
        own = [[r for path, r in results.items() if _are_results_of(path, file)] for file in scans]
        judged = check_scan_set(list(scans.values()), results=own)
        checked += [Checked.of((f,), found, "scan") for f, found in zip(scans, judged, strict=True)]
    return checked


def _check_results(task: CheckTask) -> list[Checked]:
    # imported late for a quick start
    from tribolab.qc.scan.sets import check_results

    return [Checked.of(task.files, check_results(read_tester_results(task.files[0])), "results")]


_WORK = {"run": _check_run, "scan": _check_scans, "results": _check_results}


def _are_results_of(results: Path, scan: Path) -> bool:
    """Whether a file of results has the same folder and base name as a scan."""
    return results.parent == scan.parent and results.stem.casefold() == scan.stem.casefold()
