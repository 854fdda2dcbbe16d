"""Violations of a Table Schema, complete and as a short text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from tribolab.core.errors import shown

_SCREEN = 20  # violations shown


class Violation(NamedTuple):
    """Value that violates a rule; `row` counts from 0 and is None for a whole column."""

    row: int | None
    column: str
    value: object
    constraint: str
    limit: object

    def __str__(self) -> str:
        """Return the violation as one line."""
        if self.constraint == "missing column":
            return f"column '{shown(self.column)}' is missing"
        where = f"column '{shown(self.column)}'" + ("" if self.row is None else f", row {self.row}")
        if self.constraint == "unique":
            return f"{where}: {_short(self.value)} stands there before"
        if self.constraint == "required":
            return f"{where}: a value is required"
        return f"{where}: {_short(self.value)}, but {self.constraint} is {_short(self.limit)}"


class Broken(NamedTuple):
    """All violations of one rule in one column, with rows and values."""

    column: str
    constraint: str
    limit: object
    rows: np.ndarray
    values: Sequence[object] | np.ndarray


class Violations(NamedTuple):
    """All violations, by rule; empty and false if the data conform."""

    broken: tuple[Broken, ...]

    def __bool__(self) -> bool:
        """Whether any rule is broken."""
        return bool(self.broken)

    @property
    def total(self) -> int:
        """Number of violations."""
        return sum(max(len(broken.rows), 1) for broken in self.broken)

    def first(self, number: int = _SCREEN) -> list[Violation]:
        """Return the first violations, at least one for each rule."""
        share = max(number // max(len(self.broken), 1), 1)
        violations = []
        for rule in self.broken:
            if len(rule.rows) == 0:
                value = rule.values[0] if len(rule.values) else None
                violations.append(Violation(None, rule.column, value, rule.constraint, rule.limit))
                continue
            for row, value in zip(rule.rows[:share].tolist(), rule.values[:share], strict=True):
                violations.append(Violation(row, rule.column, value, rule.constraint, rule.limit))
        return violations[:number]

    def table(self) -> pd.DataFrame:
        """Return every violation as a row: row, column, value, constraint, limit."""
        parts = [
            pd.DataFrame(
                {
                    "row": broken.rows if len(broken.rows) else [None],
                    "column": broken.column,
                    "value": list(broken.values) if len(broken.values) else [None],
                    "constraint": broken.constraint,
                    "limit": str(broken.limit) if _is_many(broken.limit) else broken.limit,
                },
                dtype=object,
            )
            for broken in self.broken
        ]
        names = ["row", "column", "value", "constraint", "limit"]
        return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=names)

    def __str__(self) -> str:
        """Return the first violations, a line each, and the number of further ones."""
        shown = self.first()
        lines = [str(violation) for violation in shown]
        if self.total > len(shown):
            lines.append(f"and {self.total - len(shown):,} more".replace(",", " "))
        return "\n".join(lines) or "as the schema says"


def _is_many(limit: object) -> bool:
    return isinstance(limit, list | tuple | np.ndarray)


def _short(value: object) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "no value" if value is None else str(value)
