"""What a dialect says of a file that holds columns by name."""

from __future__ import annotations

from pathlib import Path

from tribolab.io.dialects.cells import split_name
from tribolab.io.dialects.model import Dialect
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


def column_names(path: Path, dialect: Dialect) -> set[str]:
    """Return the names of a file's columns, with and without their units; none if it is damaged."""
    try:
        names, units = named(open_columns(path, dialect.format, layout_of(dialect)))
    except Exception:  # it cannot be this instrument's
        return set()
    return {*names, *(f"{n} [{u}]" for n, u in zip(names, units, strict=True) if u)}
