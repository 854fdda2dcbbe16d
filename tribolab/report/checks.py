"""What `tribolab check` shows: findings of several files, for a person or for a program."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.table import Table

from tribolab.errors import ConfigError, TribolabError
from tribolab.io.runs import group_files, read
from tribolab.qc.findings import Findings, exit_code
from tribolab.qc.run_checks import check_run

SCHEMA_VERSION = 1
UNREADABLE = 3
_STYLES = {"error": "bold red", "fail": "red", "suspect": "yellow", "skipped": "dim", "pass": ""}


@dataclass(frozen=True)
class Checked:
    """One run: its files, and what the checks found, or why it could not be read."""

    files: tuple[Path, ...]
    findings: Findings | None
    error: str = ""

    @property
    def name(self) -> str:
        """The name of the first file."""
        return self.files[0].name

    @property
    def status(self) -> str:
        """The gravest status, or "unreadable"."""
        return "unreadable" if self.findings is None else self.findings.status


def check_files(paths: Iterable[str | Path], instrument: str | Path | None = None) -> list[Checked]:
    """Read and check runs; a bad file never stops the others.

    Parameters
    ----------
    paths
        Raw files; the two logs of a run are one run.
    instrument
        Their instrument; recognised by the content when not given.

    Raises
    ------
    ConfigError
        If there is no such instrument.
    """
    checked = []
    for group in group_files([Path(path) for path in paths], instrument):
        try:
            run = read(group if len(group) > 1 else group[0], instrument)
        except ConfigError:
            raise  # a wrong instrument is wrong for every file
        except (TribolabError, OSError) as error:
            checked.append(Checked(tuple(group), None, str(error)))
            continue
        checked.append(Checked(tuple(group), check_run(run)))
    return checked


def code_of(checked: Sequence[Checked], fail_on: str) -> int:
    """Exit code: 3 if a file is unreadable or a check crashed, 1 from `fail_on` on, else 0."""
    code = exit_code({c.findings.status for c in checked if c.findings is not None}, fail_on)
    return UNREADABLE if any(c.findings is None for c in checked) else code


def findings_table(findings: Findings, everything: bool = False) -> Table:
    """Return the objections of one run, graver ones first; with `everything` all that was asked."""
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for row in findings.rows:
        status = row["status"]
        if not everything and status in ("pass", "skipped"):
            continue
        variable = f"{row['variable']}: " if row["variable"] else ""
        text = escape(f"{variable}{row['message']}")
        if row["cure"]:
            text += f"\n[dim]{escape(row['cure'])}[/dim]"
        table.add_row(status, row["check"], text, style=_STYLES[status])
    return table


def summary(checked: Checked) -> str:
    """Say in one line how many checks passed, were skipped, and objected."""
    if checked.findings is None:
        return f"{checked.name}: unreadable"
    by_check: dict[str, set[str]] = {}
    for check, result in checked.findings.results:
        by_check.setdefault(check.name, set()).add(result.status)
    objecting = {n for n, found in by_check.items() if found & {"suspect", "fail", "error"}}
    passed = {n for n, found in by_check.items() if "pass" in found} - objecting
    skipped = len(by_check) - len(objecting) - len(passed)
    parts = [f"{len(passed)} checks passed"]
    parts += [f"{len(objecting)} objected"] if objecting else []
    parts += [f"{skipped} had nothing to look at"] if skipped else []
    return f"{checked.name}: {checked.status} ({', '.join(parts)})"


def document(checked: Sequence[Checked], fail_on: str) -> dict[str, Any]:
    """Return everything as one JSON document; what is not known is null."""
    from tribolab import __version__

    return {
        "schema_version": SCHEMA_VERSION,
        "tribolab_version": __version__,
        "fail_on": fail_on,
        "exit_code": code_of(checked, fail_on),
        "runs": [
            {
                "name": c.name,
                "files": [str(path) for path in c.files],
                "status": c.status,
                "error": c.error,
                "findings": [] if c.findings is None else c.findings.rows,
            }
            for c in checked
        ],
    }
