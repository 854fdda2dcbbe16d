"""What a dialect says of a file that holds columns by name."""

from __future__ import annotations

from pathlib import Path

from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.held_tables import HeldFile, HeldTable, open_sheets, open_tables
from tribolab.io.dialects.model import Dialect
from tribolab.io.dialects.patterns import guarded
from tribolab.io.tables.columnar import ColumnLayout, NamedColumns, open_columns


def layout_of(dialect: Dialect) -> ColumnLayout:
    """Return where a dialect says that columns and their names are."""
    header, binary = dialect.header, dialect.binary
    return ColumnLayout(
        sheet=header.sheet,
        line=header.line or 1,
        units_below=header.units == "row",
        skip=header.skip,
        record=binary.record if binary else None,
        offset=binary.offset if binary else 0,
    )


def named(table: NamedColumns) -> tuple[list[str], list[str | None]]:
    """Return names without units, and the units, of the file or in brackets behind the names."""
    split = [split_name(name) for name in table.names]
    units = [own or unit for (_, unit), own in zip(split, table.units, strict=True)]
    return [name for name, _ in split], units


def held_file(path: Path, dialect: Dialect) -> HeldFile:
    """Open a file of several tables as a dialect says where they are."""
    if dialect.format == "excel":
        wanted = [column.name for column in dialect.column if column.name]
        below = dialect.header.units == "row"
        return open_sheets(path, wanted, dialect.header.line or 1, units_below=below)
    return open_tables(path, dialect.format)


def steps_of(file: HeldFile, dialect: Dialect) -> list[HeldTable]:
    """Return the tables that are steps of the run, in their order."""
    assert dialect.tables is not None  # whoever asks has looked
    pattern = guarded(dialect.tables.steps)
    return [table for table in file.tables if pattern.search(table.name)]


def _label(name: str, unit: str | None) -> str:
    return f"{name} [{unit}]" if unit else name


def column_names(path: Path, dialect: Dialect) -> set[str]:
    """Return the names of a file's columns, with and without their units; none if it is damaged."""
    try:
        if dialect.tables is not None:
            tables = steps_of(held_file(path, dialect), dialect)
            return {x for t in tables[:1] for x in (*t.names, *map(_label, t.names, t.units))}
        names, units = named(open_columns(path, dialect.format, layout_of(dialect)))
    except Exception:  # it cannot be this instrument's
        return set()
    return {*names, *(f"{n} [{u}]" for n, u in zip(names, units, strict=True) if u)}
