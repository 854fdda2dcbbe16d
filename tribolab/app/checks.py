"""What `tribolab check` shows: findings of several files, for a person or for a program."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from tribolab.app.file_info import read_scan
from tribolab.app.streams import say
from tribolab.errors import ConfigError, TribolabError, told
from tribolab.io.kinds import kind_of, repeats_by_name
from tribolab.io.runs import group_files, read
from tribolab.io.scans.results import read_tester_results
from tribolab.qc.findings import Findings, exit_code
from tribolab.qc.run_checks import check_run

if TYPE_CHECKING:
    import xarray as xr

SCHEMA_VERSION = 1
UNREADABLE = 3
_STYLES = {
    "error": "bold red",
    "fail": "red",
    "suspect": "yellow",
    "skipped": "dim",
    "pass": "",
    "note": "",
}


@dataclass(frozen=True)
class Checked:
    """One run or scan: its files, and what the checks found, or why it could not be read.

    `kind` is "run", "scan", "results" (of a roughness tester), or "file" if it is not known.
    """

    files: tuple[Path, ...]
    findings: Findings | None
    error: str = ""
    kind: str = "run"

    @property
    def name(self) -> str:
        """The name of the first file."""
        return self.files[0].name

    @property
    def status(self) -> str:
        """The gravest status, or "unreadable"."""
        return "unreadable" if self.findings is None else self.findings.status


def check_files(
    paths: Iterable[str | Path],
    instrument: str | Path | None = None,
    *,
    repeats: bool | None = None,
) -> list[Checked]:
    """Read and check runs, scans and results of roughness testers; a bad file stops no other.

    Parameters
    ----------
    paths
        Raw files of any kind; the two logs of a run are one run.
    instrument
        Their instrument; recognised by the content when not given.
    repeats
        Whether the scans are of one surface, to be compared with each other. By default those are
        whose names differ in their last number only.

    Raises
    ------
    ConfigError
        If there is no such instrument.
    """
    groups = group_files([Path(path) for path in paths], instrument)
    kinds = {
        tuple(group): kind_of(group[0], instrument) if len(group) == 1 else "run"
        for group in groups
    }
    checked: dict[tuple[Path, ...], Checked] = {}
    scans: dict[Path, xr.Dataset] = {}
    results: dict[Path, xr.Dataset] = {}
    for group, kind in kinds.items():
        try:
            if kind == "results":
                results[group[0]] = read_tester_results(group[0])
            elif kind == "run":
                run = read(list(group) if len(group) > 1 else group[0], instrument)
                checked[group] = Checked(group, check_run(run))
            else:
                scans[group[0]] = read_scan(group[0], instrument)
        except ConfigError:
            raise  # a wrong instrument is wrong for every file
        except (TribolabError, OSError) as error:
            checked[group] = Checked(group, None, told(error, "terminal"), kind="file")
    every = list(scans)
    sets = (
        [every] if repeats else repeats_by_name(every) if repeats is None else [[p] for p in every]
    )
    for files in filter(None, sets):
        own = [[r for path, r in results.items() if _belongs(path, file)] for file in files]
        from tribolab.qc.scan_sets import check_scan_set

        found = check_scan_set([scans[file] for file in files], results=own)
        for file, findings in zip(files, found, strict=True):
            checked[(file,)] = Checked((file,), findings, kind="scan")
    for path, result in results.items():
        if not any(_belongs(path, file) for file in every):
            from tribolab.qc.scan_sets import check_results

            checked[(path,)] = Checked((path,), check_results(result), kind="results")
    return [checked[group] for group in kinds if group in checked]


def _belongs(results: Path, scan: Path) -> bool:
    """Whether results have the name of a scan beside them."""
    return results.parent == scan.parent and results.stem.casefold() == scan.stem.casefold()


def code_of(checked: Sequence[Checked], fail_on: str) -> int:
    """Exit code: 3 if a file is unreadable or a check crashed, 1 from `fail_on` on, else 0."""
    code = exit_code({c.findings.status for c in checked if c.findings is not None}, fail_on)
    return UNREADABLE if any(c.findings is None for c in checked) else code


def findings_table(findings: Findings, everything: bool = False) -> Table:
    """Return objections and notes, graver ones first; with `everything` all that was asked."""
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for status, check, message, cure in findings.told(everything):
        text = escape(message) + (f"\n[dim]{escape(cure)}[/dim]" if cure else "")
        table.add_row(status, check, text, style=_STYLES[status])
    return table


def show(checked: Sequence[Checked], everything: bool = False) -> None:
    """Print what the checks found on stdout, and on stderr why a file could not be read."""
    from tribolab.app import terminal

    for one in checked:
        if one.findings is None:
            say(f"{one.name}: unreadable")
            say(f"tribolab: {one.error}", to_stderr=True)
            continue
        # a run of two logs is called by the first, not by both
        head = one.findings.summary.removeprefix(one.findings.name)
        say(f"{one.name}{head}")
        table = findings_table(one.findings, everything)
        if table.row_count:
            terminal.console().print(table)


def as_json(checked: Sequence[Checked], fail_on: str) -> str:
    """Return `document` as strict JSON."""
    return json.dumps(document(checked, fail_on), indent=1, allow_nan=False)


def document(checked: Sequence[Checked], fail_on: str) -> dict[str, Any]:
    """Return everything as one JSON document; what is not known is null."""
    from tribolab.version import __version__

    return {
        "schema_version": SCHEMA_VERSION,
        "tribolab_version": __version__,
        "fail_on": fail_on,
        "exit_code": code_of(checked, fail_on),
        "runs": [
            {
                "name": c.name,
                "kind": c.kind,
                "files": [str(path) for path in c.files],
                "status": c.status,
                "error": c.error,
                "findings": [] if c.findings is None else c.findings.rows,
            }
            for c in checked
        ],
    }
