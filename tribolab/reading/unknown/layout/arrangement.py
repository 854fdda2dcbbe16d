"""Whether the numbers of an unknown file stand otherwise than below a line of names."""

from __future__ import annotations

from tribolab.reading.text.arrangements import (
    Arrangement,
    below_names,
    groups_beside,
    holds_names,
    is_listed,
    listed_columns,
)
from tribolab.reading.text.cells import split_name, split_row
from tribolab.reading.text.column_legend import explained
from tribolab.reading.text.long_table import is_long
from tribolab.reading.text.transposed import (
    fields_that_touch,
    groups_with_clocks,
    joined_names,
    rises,
    signals_in_rows,
)
from tribolab.reading.unknown.layout.header import names_any
from tribolab.reading.unknown.layout.step_marks import Block

_FRICTION = ("friction_force", "friction_coefficient")
_FIRST = 400  # lines that tell


def arranged(lines: tuple[str, ...]) -> tuple[tuple[str, ...], Arrangement]:
    """Return lines whose numbers do not stand behind their names, and how they stood.

    Parameters
    ----------
    lines
        Those of the file.
    """
    if holds_names(lines[:_FIRST]):
        return _anew(lines, "names in rows", ";")
    if is_long(lines):
        return _anew(lines, "a channel to a row", ";")
    if signals_in_rows(lines):
        return _anew(lines, "a signal to a row", "whitespace")
    if fields_that_touch(lines):
        return _anew(lines, "touching", "whitespace")
    return lines, "below names"


def arranged_table(
    lines: tuple[str, ...], block: Block, delimiter: str
) -> tuple[tuple[str, ...], Arrangement] | None:
    """Return lines with a table put below the names of its columns; None where it stands so.

    Parameters
    ----------
    lines
        Those of the file.
    block
        Its main table.
    delimiter
        What parts the cells.
    """
    heading = block.heading
    if heading is None or is_listed(lines[heading.names]):
        listed = block.width > 1 and listed_columns(lines[: block.start], block.width)
        return _anew(lines, "columns listed", delimiter) if listed else None
    groups = groups_beside(heading.cells)
    own = heading.cells[: -(-len(heading.cells) // groups)]
    # sensors of one record have no clock or way of their own
    told = any(names_any(cell, "time", "position") for cell in own)
    # the load of a machine that pulls is friction
    if groups > 1 and told and any(names_any(cell, *_FRICTION, "normal_force") for cell in own):
        return _anew(lines, "side by side", delimiter)
    if heading.aligned and _clocks_of_their_own(lines, block, delimiter):
        return _anew(lines, "clocks of their own", delimiter)
    if heading.aligned and delimiter != "whitespace" and _in_two_rows(lines, block, delimiter):
        return _anew(lines, "names in two rows", delimiter)
    if heading.units is None and heading.aligned:
        names = explained(lines[: heading.names], heading.cells)
        if _says_more(heading.cells, names):
            return _anew(lines, "names explained", delimiter)
    return None


def _clocks_of_their_own(lines: tuple[str, ...], block: Block, delimiter: str) -> bool:
    """Whether columns have times of their own before them, which proceed."""
    heading = block.heading
    groups = groups_with_clocks(heading.cells) if heading else []
    rows = [split_row(lines[k], delimiter) for k in block.rows[:_FIRST]] if groups else []
    return bool(groups) and all(
        rises([row[group[0]] if group[0] < len(row) else "" for row in rows]) for group in groups
    )


def _in_two_rows(lines: tuple[str, ...], block: Block, delimiter: str) -> bool:
    """Whether names that stand twice are told apart by the row above them."""
    heading = block.heading
    assert heading is not None  # whoever asks has looked
    places = [heading.names]
    if heading.units is not None and heading.units > heading.names + 1:
        places.append(heading.names + 1)  # the row above was taken for the names
    for place in places:
        above, names = (split_row(lines[k], delimiter) for k in (place - 1, place))
        if place and joined_names(above, names) != names:
            return True
    return False


def _says_more(names: tuple[str, ...], told: list[str]) -> bool:
    """Whether explanations say units, or what a column is whose name says nothing."""
    units = [split_name(name)[1] for name in told if name not in names]
    return any(units) and not any(split_name(name)[1] for name in names)


def _anew(
    lines: tuple[str, ...], arrangement: Arrangement, delimiter: str
) -> tuple[tuple[str, ...], Arrangement]:
    told = below_names("\n".join(lines), arrangement, delimiter)
    return tuple(told.split("\n")), arrangement
