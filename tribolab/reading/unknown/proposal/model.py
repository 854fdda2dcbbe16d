"""Interpretation of an unknown file, and the dialect drafted from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Literal, Self

import numpy as np

from tribolab.core.errors import TribolabError, shown
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.write import FILL_IN, dialect_toml
from tribolab.reading.runs.read_run import read_log
from tribolab.reading.unknown.columns.text_evidence import unused_force_columns
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import Kind, Understood
from tribolab.reading.unknown.proposal.dialect import Described, describe, dialect_of
from tribolab.reading.unknown.proposal.remarks import remarks_of
from tribolab.units.quantities import unit_conversion

SHOWN = 10  # rows shown as understood


@dataclass(frozen=True, eq=False)
class Drafted:
    """Interpretation of an unknown file.

    Attributes
    ----------
    path, name
        The file, and the name of the dialect.
    kind
        ``run``, ``scan``, or ``table``: numbers that are neither, for which there is no dialect.
    layout, understood
        Layout of the file and quantities of its columns; None for a file of results.
    answer
        For a table: what the file is, and what reads it.
    cells
        The first rows, as written in the file.
    known
        The known instrument that reads the file already; empty if there is none.
    unsaid
        What a file with heights only does not state: their pitch, or the height of one count.
    """

    path: Path
    name: str
    kind: Kind
    layout: Layout | None = None
    understood: Understood | None = None
    answer: str = ""
    cells: tuple[tuple[str, ...], ...] = ()
    known: str = ""
    unsaid: Literal["", "pitch", "count"] = ""

    @cached_property
    def _described(self) -> Described | None:
        if self.kind == "table" or self.layout is None or self.understood is None:
            return None
        return describe(self.layout, self.understood)

    @cached_property
    def dialect(self) -> Dialect | None:
        """The dialect; None for a table, or if the units of all columns are still missing.

        Raises
        ------
        ReadError
            If no dialect can describe the file.
        """
        found = self._described
        if found is None or not (found.columns or found.follows.symbols):
            return None
        return dialect_of(self.name, found)

    @cached_property
    def toml(self) -> str:
        """The dialect as TOML, with remarks as comments; empty for a table."""
        if self.dialect is None or self._described is None:
            return ""
        return dialect_toml(self.dialect, remarks_of(self._described))

    def with_understood(self, understood: Understood) -> Self:
        """Return a copy of the draft with another interpretation of the table."""
        return replace(self, kind=understood.kind, understood=understood)

    @property
    def labels(self) -> list[str]:
        """The names of the columns, as written in the file."""
        columns = self.understood.columns if self.understood else ()
        return [column.label for column in columns if column.label]

    @property
    def named(self) -> bool:
        """Whether names in a header, and not only numbers, give the columns' quantities."""
        columns = self.understood.columns if self.understood else ()
        if any(column.label and column.quantity for column in columns):
            return True
        if self.layout is None or self.understood is None or self.kind != "run":
            return False
        # formulas may use named columns, such as volts with a stated gain
        return any(c.label for _, c in what_follows(self.layout, self.understood).symbols)

    @property
    def guesses(self) -> tuple[str, ...]:
        """All guesses, from the layout of the file to stated values."""
        if self.layout is None or self.understood is None:
            return ()
        columns = [
            f"column {column.place}"
            + (f" '{shown(column.label)}': " if column.label else ": ")
            + guess
            for column in self.understood.columns
            for guess in column.guessed
        ]
        follows = what_follows(self.layout, self.understood)
        speed = [follows.speed.guess] if follows.speed is not None and follows.speed.guess else []
        used = {column.place for _, column in follows.symbols}
        speed += unused_force_columns(self.layout, self.understood.columns, used)
        return (
            *self.layout.notes,
            *self.layout.guesses,
            *self.understood.guesses,
            *columns,
            *speed,
            *(value.guess for value in follows.values if value.guess),
        )

    @property
    def to_fill_in(self) -> Mapping[int, str]:
        """What the user has to fill in, by line number of the TOML."""
        return {
            number: line.split(f"{FILL_IN}: ", 1)[1].removesuffix(", then remove the '#' below")
            for number, line in enumerate(self.toml.splitlines(), start=1)
            if FILL_IN in line
        }

    def first_rows(self, number: int = SHOWN) -> dict[str, np.ndarray]:
        """Return the first rows of each signal in SI units, by quantity."""
        if self.understood is None:
            return {}
        rows = {}
        for column in self.understood.columns:
            if column.used and column.quantity:
                scale, offset = unit_conversion(column.read_unit or "", column.quantity)
                values = self.understood.numbers[:number, column.place - 1]
                values = column.sign * (column.scale * values + column.offset)
                rows[column.quantity] = scale * values + offset
        return rows

    def signals(self) -> dict[str, np.ndarray]:
        """Return all signals in SI units, by quantity; of a short run also the derived ones.

        If the dialect can read the file, clock restarts are joined, as in any run.
        """
        if self.understood is None:
            return {}
        columns = self.first_rows(len(self.understood.numbers))
        dialect = self.dialect
        if self.kind != "run" or dialect is None or self.layout is None or not self.layout.whole:
            return columns
        try:
            log = read_log(self.path, dialect)
        except TribolabError:  # something still has to be filled in
            return columns
        read = {"time": log.time, **log.columns}
        return {name: read[name] for name in (*columns, *read) if name in read}
