"""Whether the numbers of an unknown file stand otherwise than below a line of names."""

from __future__ import annotations

from tribolab.draft.file.header import names_any
from tribolab.draft.file.marks import Block
from tribolab.io.dialects.arranged import (
    Arrangement,
    below_names,
    groups_beside,
    holds_names,
    is_listed,
    listed_columns,
)

_FRICTION = ("friction_force", "friction_coefficient")
_FIRST = 400  # lines that tell


def arranged(lines: tuple[str, ...]) -> tuple[tuple[str, ...], Arrangement]:
    """Return lines whose numbers do not stand behind their names, and how they stood.

    Parameters
    ----------
    lines
        Those of the file.
    """
    if not holds_names(lines[:_FIRST]):
        return lines, "below names"
    return _anew(lines, "names in rows", ";")


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
    return None


def _anew(
    lines: tuple[str, ...], arrangement: Arrangement, delimiter: str
) -> tuple[tuple[str, ...], Arrangement]:
    told = below_names("\n".join(lines), arrangement, delimiter)
    return tuple(told.split("\n")), arrangement
