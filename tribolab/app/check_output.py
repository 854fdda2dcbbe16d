"""Findings of `tribolab check` as a table, in lines, or as JSON."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rich.markup import escape
from rich.table import Table

from tribolab.app.checks import Checked
from tribolab.app.streams import say
from tribolab.core.untyped import Json
from tribolab.qc.findings import exit_code, finding_texts

_SCHEMA_VERSION = 1
_STYLES = {
    "error": "bold red",
    "fail": "red",
    "suspect": "yellow",
    "skipped": "dim",
    "pass": "",
    "note": "",
}
_UNREADABLE = 3


def code_of(checked: Sequence[Checked], fail_on: str) -> int:
    """Return the exit code: 3 if files are unreadable, 1 if checks reach `fail_on`, else 0."""
    code = exit_code({c.status for c in checked if not c.error}, fail_on)
    return _UNREADABLE if any(c.error for c in checked) else code


def checked_table(
    rows: Iterable[Mapping[str, Any]], *, notes: bool = False, everything: bool = False
) -> Table:
    """Return a table of suspect and failed checks, most severe first; all checks on request."""
    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for status, check, message, cure in finding_texts(rows, notes=notes, everything=everything):
        text = escape(message) + (f"\n[dim]{escape(cure)}[/dim]" if cure else "")
        table.add_row(status, check, text, style=_STYLES[status])
    return table


def show(checked: Sequence[Checked], *, notes: bool = False, everything: bool = False) -> None:
    """Print the findings to stdout, and the reasons for unreadable files to stderr.

    For several files, the last lines count files by status and name those with objections.
    """
    # imported late for a quick start
    from tribolab.app.console import console

    for checked_file in checked:
        if checked_file.error:
            say(f"{checked_file.name}: not read, so nothing was checked")
            say(f"tribolab: {checked_file.error}", to_stderr=True)
            continue
        say(f"{checked_file.name}: {checked_file.summary}")
        table = checked_table(checked_file.rows, notes=notes, everything=everything)
        if table.row_count:
            console().print(table)
    if len(checked) > 1:
        for line in count_lines(checked):
            say(line)


def count_lines(checked: Sequence[Checked]) -> list[str]:
    """Return a line with the number of files per status, and one with the files to look at.

    Examples
    --------
    >>> from pathlib import Path
    >>> files = [Checked((Path(f"{n}.csv"),), status=s) for n, s in enumerate(("pass", "fail"))]
    >>> count_lines(files)
    ['2 checked: 1 fail, 1 pass', 'to look at: 1.csv (fail)']
    """
    ranked = ("error", "unreadable", "fail", "suspect", "skipped", "pass")
    counts = Counter(c.status for c in checked)
    parts = [f"{counts[status]} {status}" for status in ranked if counts[status]]
    wanted = [s for s in ranked if s not in ("pass", "skipped")]
    names = [f"{c.name} ({s})" for s in wanted for c in checked if c.status == s]
    lines = [f"{len(checked)} checked: {', '.join(parts)}"]
    return [*lines, f"to look at: {', '.join(names)}"] if names else lines


def as_json(checked: Sequence[Checked], fail_on: str) -> str:
    """Return the findings on all checked files as JSON text without NaN."""
    return json.dumps(document(checked, fail_on), indent=1, allow_nan=False)


def document(checked: Sequence[Checked], fail_on: str) -> Json:
    """Return the findings on all checked files as plain data for JSON."""
    # imported late: looks up the installed package
    from tribolab.version import __version__

    return {
        "schema_version": _SCHEMA_VERSION,
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
                "findings": list(c.rows),
            }
            for c in checked
        ],
    }
