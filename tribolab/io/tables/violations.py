"""What a check against a Table Schema found: every violation, and a screenful of them as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from tribolab.errors import shown

_SCREEN = 20  # violations that are shown


class Violation(NamedTuple):
    """One value that breaks a rule; `row` counts from 0 and is None where a whole column does."""

    row: int | None
    column: str
    value: Any
    constraint: str
    limit: Any

    def __str__(self) -> str:
        """Say what is wrong, in one line."""
        if self.constraint == "missing column":
            return f"column '{shown(self.column)}' is missing"
        where = f"column '{shown(self.column)}'" + ("" if self.row is None else f", row {self.row}")
        if self.constraint == "unique":
            return f"{where}: {_short(self.value)} stands there before"
        if self.constraint == "required":
            return f"{where}: a value is required"
        return f"{where}: {_short(self.value)}, but {self.constraint} is {_short(self.limit)}"


class Broken(NamedTuple):
    """All violations of one rule in one column: their rows and values."""

    column: str
    constraint: str
    limit: Any
    rows: np.ndarray
    values: Sequence[Any] | np.ndarray


class Violations(NamedTuple):
    """What was found, rule by rule; empty, and then false, if the data are as they should be."""

    broken: tuple[Broken, ...]

    def __bool__(self) -> bool:
        """Whether any rule is broken."""
        return bool(self.broken)

    @property
    def total(self) -> int:
        """Number of violations."""
        return sum(max(len(one.rows), 1) for one in self.broken)

    def first(self, number: int = _SCREEN) -> list[Violation]:
        """Return the first violations, of each rule at least one."""
        share = max(number // max(len(self.broken), 1), 1)
        found = []
        for one in self.broken:
            if len(one.rows) == 0:
                value = one.values[0] if len(one.values) else None
                found.append(Violation(None, one.column, value, one.constraint, one.limit))
                continue
            for row, value in zip(one.rows[:share].tolist(), one.values[:share], strict=True):
                found.append(Violation(row, one.column, value, one.constraint, one.limit))
        return found[:number]

    def table(self) -> pd.DataFrame:
        """Return every violation as a row: row, column, value, constraint, limit."""
        parts = [
            pd.DataFrame(
                {
                    "row": one.rows if len(one.rows) else [None],
                    "column": one.column,
                    "value": list(one.values) if len(one.values) else [None],
                    "constraint": one.constraint,
                    "limit": one.limit if np.ndim(one.limit) == 0 else str(one.limit),
                },
                dtype=object,
            )
            for one in self.broken
        ]
        names = ["row", "column", "value", "constraint", "limit"]
        return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=names)

    def __str__(self) -> str:
        """Say the first violations, a line each, and how many there are more."""
        shown = self.first()
        lines = [str(one) for one in shown]
        if self.total > len(shown):
            lines.append(f"and {self.total - len(shown):,} more".replace(",", " "))
        return "\n".join(lines) or "as the schema says"


def _short(value: Any) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "no value" if value is None else str(value)
