"""Display of the interpretation of an unknown file, on the terminal or in a notebook."""

from __future__ import annotations

import io
import shlex
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from tribolab.core.errors import shown as cut
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.model import Follows
from tribolab.reading.unknown.model import DraftColumn
from tribolab.reading.unknown.proposal.model import SHOWN, Drafted
from tribolab.units.quantities import quantity

_PRE = '<pre style="font-family: monospace; line-height: 1.25">{code}</pre>'
_COLUMNS = 12  # columns of raw cells that are shown
_ABREAST = 5  # quantities that are shown side by side
_LISTED = 60  # columns that are listed; any others are listed only if their quantity is known


def print_draft(draft: Drafted, console: Console, *, rows: bool = True) -> None:
    """Print the interpretation of a file, its first rows, and the guesses."""
    kinds = {"run": "a run", "scan": "a scan", "table": "a table, neither a run nor a scan"}
    console.print(f"[bold]{escape(str(draft.path))}[/]: {kinds[draft.kind]}")
    for line in _written(draft):
        console.print(f"  {escape(line)}", soft_wrap=True)
    if draft.known:
        console.print(f"  the known instrument '{draft.known}' reads it already")
    if draft.understood is not None and draft.dialect:
        console.print(_columns_table(draft))
        print_signals(draft, console, rows=rows)
    else:
        console.print(_cells_table(draft))
    if draft.dialect and draft.guesses:
        console.print("guessed, so look at it:")
        for guess in draft.guesses:
            console.print(f"  - {escape(guess)}", soft_wrap=True)


def print_signals(draft: Drafted, console: Console, *, rows: bool = True) -> None:
    """Print the first rows in SI units, and the range of each signal."""
    signals = draft.signals()
    for table in _rows_tables(signals) if rows else ():
        console.print(table)
    if not draft.dialect:
        return
    table = _table("signals", "from", "to")
    for name, values in signals.items():
        known = values[np.isfinite(values)]
        ends = (f"{known.min():.4g}", f"{known.max():.4g}") if known.size else ("", "")
        table.add_row(_with_unit(name), *ends)
    console.print(table)


def draft_html(draft: Drafted) -> str:
    """Return the output of `print_draft` as HTML, with a list of what is to be filled in."""
    page = Console(record=True, file=io.StringIO(), width=110, force_jupyter=False, highlight=False)
    print_draft(draft, page)
    for line, what in draft.to_fill_in.items():
        page.print(f"fill in line {line} of the TOML: {escape(what)}", soft_wrap=True)
    return page.export_html(inline_styles=True, code_format=_PRE)


def print_next(draft: Drafted, written: Path, console: Console) -> None:
    """Print which lines to fill in, where the dialect was written, and the next command."""
    for line, what in draft.to_fill_in.items():
        console.print(f"fill in {escape(str(written))} line {line}: {escape(what)}", soft_wrap=True)
    console.print(f"written: {escape(str(written))}", soft_wrap=True)
    file, toml = shlex.quote(str(draft.path)), shlex.quote(str(written))
    command = "run" if draft.kind == "run" and not draft.to_fill_in else "info"
    console.print(
        f"next:  tribolab {command} {escape(file)} --instrument {escape(toml)}", soft_wrap=True
    )


def _written(draft: Drafted) -> list[str]:
    layout = draft.layout
    if layout is None:
        return []
    rows = sum(len(block.rows) for block in layout.blocks)
    if layout.held is not None:
        sheet = f", sheet '{layout.held.sheet}'" if layout.held.sheet else ""
        return [f"the first {rows} rows of {layout.width} columns ({layout.held.form}{sheet})"]
    more = "" if layout.whole else ", and more: only the first megabyte was looked at"
    tables = f" in {len(layout.blocks)} tables" if len(layout.blocks) > 1 else ""
    if layout.others:
        tables += f"; {layout.others} more in the file, which are not read"
    marks = f"numbers parted by {layout.delimiter_name}, decimal "
    marks += "comma" if layout.decimal == "," or layout.quoted else "point"
    marks += " in quotes" if layout.quoted else ""
    if layout.heading is None:
        header = "no header" + (f", {layout.skip} lines before the numbers" if layout.skip else "")
    else:
        header = f"header in line {layout.heading.names + 1}"
        header += f", units in line {layout.heading.units + 1}" if layout.heading.units else ""
        header += ", repeated" if layout.repeats and len(layout.blocks) > 1 else ""
    bom = " with BOM" if layout.file.head.startswith(b"\xef\xbb\xbf") else ""
    return [
        f"{rows} rows of {layout.width} columns{tables}{more}",
        f"{layout.encoding}{bom}, lines end in {layout.line_ends}; {marks}; {header}",
    ]


def _table(*headings: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, header_style="bold")
    for heading in headings:
        table.add_column(heading, overflow="fold")
    return table


def _columns_table(draft: Drafted) -> Table:
    """Return a table with one row per column; columns without name and numbers are left out."""
    table = _table("column", "name in the file", "unit", "quantity", "remark")
    if draft.understood is None:
        return table
    filled = np.isfinite(draft.understood.numbers).any(axis=0)
    follows = what_follows(draft.layout, draft.understood) if draft.layout else Follows()
    used_as = {column.place: symbol for symbol, column in follows.symbols}
    named = [c for c in draft.understood.columns if c.label or filled[c.place - 1]]
    for number, column in enumerate(named):
        if number < _LISTED or column.quantity:
            meaning = escape(column.quantity or "") if column.used else ""
            unit = column.read_unit or ""
            table.add_row(
                str(column.place),
                escape(cut(column.label)),
                escape(unit),
                meaning,
                escape(_remark(column, used_as.get(column.place, ""))),
            )
    left = sum(1 for column in named[_LISTED:] if not column.quantity)
    if left:
        table.add_row("", f"... and {left} more", "", "", "not used")
    return table


def _remark(column: DraftColumn, used_as: str) -> str:
    if used_as:
        return f"used as {used_as}"
    if column.used or column.zero:  # `zero`: also a torque that gives the friction force
        return "guessed" if column.guessed else column.note
    return f"fill in {column.fill_in}" if column.fill_in else f"not used: {column.note}"


def _rows_tables(signals: Mapping[str, np.ndarray]) -> list[Table]:
    """Return tables of the first rows in SI units, with at most five quantities each."""
    rows = {name: values[:SHOWN] for name, values in signals.items()}
    names = list(rows)
    tables = []
    for start in range(0, len(names), _ABREAST):
        part = names[start : start + _ABREAST]
        table = _table("row", *(_with_unit(name) for name in part))
        for number in range(max(len(rows[name]) for name in part)):
            cells = [rows[name][number] for name in part]
            table.add_row(
                str(number + 1), *("" if np.isnan(value) else f"{value:.6g}" for value in cells)
            )
        tables.append(table)
    return tables


def _with_unit(name: str) -> str:
    unit = quantity(name).unit
    return name if unit == "1" else f"{name} {unit}"


def _cells_table(draft: Drafted) -> Table:
    """Return a table of the first rows as written in the file, with its header if it has one."""
    width = min(max((len(row) for row in draft.cells), default=0), _COLUMNS)
    heading = draft.layout.heading if draft.layout else None
    cells = list(heading.cells if heading else ()) + [""] * width
    units = list(heading.unit_cells if heading else ()) + [""] * width
    labels = [
        f"{cell} [{unit}]" if unit else cell for cell, unit in zip(cells, units, strict=False)
    ]
    table = _table(*(escape(cut(label)) for label in labels[:width]))
    table.show_header = heading is not None
    for row in draft.cells:
        table.add_row(*(escape(cut(cell)) for cell in row[:width]))
    return table
