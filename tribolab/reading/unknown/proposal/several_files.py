"""One draft from several files of an instrument: what is not in all of them is optional."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tribolab.aliases import PathLike
from tribolab.errors import ReadError
from tribolab.reading.unknown.model import DraftColumn
from tribolab.reading.unknown.proposal.draft import Draft, draft_dialect

_Key = tuple[str | int, int]


def draft_of_examples(paths: Sequence[PathLike], name: str | None = None) -> Draft:
    """Draft one dialect from several example files.

    Parameters
    ----------
    paths
        The files; the first says how they are written.
    name
        Name of the dialect; made from the first file's name if not given.

    Returns
    -------
    Draft
        That of the first file, in which columns that are missing or empty in another file are
        optional, and those that only others have are added.

    Raises
    ------
    ReadError
        If a file cannot be drafted from, or is another kind of file than the first.
    """
    drafts = [draft_dialect(path, name) for path in paths]
    first = drafts[0]
    for other in drafts[1:]:
        if other.kind != first.kind:
            raise ReadError(
                f"this is a {other.kind} and {Path(paths[0]).name} a {first.kind}: one dialect "
                "cannot describe both",
                where=other.path,
            )
        if _way(other) != _way(first):
            raise ReadError(
                f"this is written otherwise than {Path(paths[0]).name} (delimiter, decimal mark or "
                "header): it wants a dialect of its own",
                where=other.path,
            )
    return _joined(drafts) if len(drafts) > 1 else first


def _way(draft: Draft) -> tuple[object, ...]:
    """How a file is written, as far as one dialect can say it only once."""
    layout = draft.layout
    if layout is None:
        return ()
    units = None if layout.heading is None else layout.heading.units is not None
    return layout.delimiter, layout.decimal, units, layout.header_line


def _joined(drafts: Sequence[Draft]) -> Draft:
    first = drafts[0]
    if first.layout is None or first.understood is None:
        return first
    in_use = [_in_use(draft) for draft in drafts]
    columns = [
        column._replace(optional=column.optional or column.quantity != "time")
        if column.used and not all(_key(column) in keys for keys in in_use)
        else column
        for column in first.understood.columns
    ]
    known = {_key(column) for column in columns}
    taken = {column.quantity for column in columns if column.used}
    for keys in in_use[1:]:
        for key, column in keys.items():
            if key in known and column.quantity not in taken and column.name is not None:
                at = next(i for i, mine in enumerate(columns) if _key(mine) == key)
                columns[at] = column._replace(place=columns[at].place, optional=True)
            elif key not in known and column.quantity not in taken and column.name is not None:
                columns.append(column._replace(place=len(columns) + 1, optional=True))
            else:
                continue
            known.add(key)
            taken.add(column.quantity)
    numbers = first.understood.numbers
    more = len(columns) - numbers.shape[1]
    numbers = np.hstack([numbers, np.full((len(numbers), max(more, 0)), np.nan)])
    words = (word for draft in drafts if draft.understood for word in draft.understood.missing)
    understood = first.understood._replace(
        columns=tuple(columns),
        numbers=numbers,
        missing=tuple(dict.fromkeys(words)),
        restart=any(draft.understood.restart for draft in drafts if draft.understood),
    )
    return first.with_understood(understood)


def _in_use(draft: Draft) -> dict[_Key, DraftColumn]:
    """Columns that hold numbers and are read."""
    understood = draft.understood
    if understood is None:
        return {}
    filled = np.isfinite(understood.numbers).any(axis=0)
    return {_key(c): c for c in understood.columns if c.used and filled[c.place - 1]}


def _key(column: DraftColumn) -> _Key:
    return (column.name if column.name is not None else column.place, column.occurrence)
