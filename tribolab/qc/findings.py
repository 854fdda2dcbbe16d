"""Findings: what the checks said, as rows for a table, a terminal, a report or a program."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Never, NotRequired, TypedDict

import numpy as np

from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.core.wording import Count
from tribolab.qc.register import STATUSES, Check, Result

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_FAIL_ON = ("suspect", "fail", "never")


class FindingRow(TypedDict):
    """One result as a row; `value` is None where there is no number, limits are in SI.

    `decision` is there where a person settled an objection.
    """

    name: str
    check: str
    status: str
    noted: bool
    variable: str
    message: str
    where: str
    count: int
    value: float | None
    unit: str
    limits: dict[str, float]
    question: str
    cure: str
    decision: NotRequired[str]


def _gravest(statuses: Iterable[str]) -> str:
    there = {*statuses} - {"skipped"}
    return max(there, key=STATUSES.index, default="skipped")


@dataclass(frozen=True, repr=False)
class Findings:
    """What every check said about one run or one set of scans.

    Attributes
    ----------
    name
        What was checked, usually the file's name.
    results
        ``(check, result)`` pairs, at least one for every known check.
    flagged
        The data with their quality flags, where the checks set any.
    limits
        The limits that held, SI, by check and name.
    verdict
        "accepted" or "rejected" where a person decided on the run; else empty.
    """

    name: str
    results: tuple[tuple[Check[Never], Result], ...]
    flagged: xr.Dataset | None = field(default=None, repr=False)
    limits: Mapping[str, Mapping[str, float]] = field(default_factory=dict, repr=False)
    verdict: str = ""

    @property
    def marked(self) -> xr.Dataset:
        """The data with their quality flags.

        Raises
        ------
        LookupError
            If these checks set none: of an instrument's own results there are only the findings.
        """
        if self.flagged is None:
            raise LookupError(f"{self.name}: its checks set no flags")
        return self.flagged

    @property
    def rows(self) -> list[FindingRow]:
        """One dict for each result, graver ones first; numbers that are unknown are None."""
        rows: list[FindingRow] = [
            {
                "name": self.name,
                "check": check.name,
                "status": result.status,
                "noted": result.noted,
                "variable": result.variable,
                "message": result.message,
                "where": result.where,
                "count": result.count,
                "value": result.value if np.isfinite(result.value) else None,
                "unit": result.unit,
                "limits": dict(self.limits.get(check.name, {})),
                "question": check.question,
                "cure": (result.cure or check.cure) if result.status in ("suspect", "fail") else "",
            }
            for check, result in self.results
        ]
        for row, (_, result) in zip(rows, self.results, strict=True):
            if result.decision:
                row["decision"] = result.decision
        return sorted(rows, key=lambda row: -STATUSES.index(row["status"]))

    @property
    def table(self) -> pd.DataFrame:
        """The rows as a table: one line per check and variable."""
        # late: pandas takes long to load
        import pandas as pd

        columns = ["check", "status", "variable", "message", "value", "unit", "where", "cure"]
        return pd.DataFrame(self.rows, columns=["name", *columns])

    @property
    def status(self) -> str:
        """The gravest status; "pass" if at least one check passed and none objected.

        Where a person decided on the run it is "accepted" or "rejected"; objections that a person
        settled do not count.
        """
        return self.verdict or _gravest(r.status for _, r in self.results if not r.settled)

    @property
    def status_as_found(self) -> str:
        """The gravest status, whatever a person accepted."""
        return _gravest(result.status for _, result in self.results)

    def count(self) -> Mapping[str, int]:
        """Return how many results there are of each status."""
        statuses = [result.status for _, result in self.results]
        return {status: statuses.count(status) for status in STATUSES}

    @property
    def summary(self) -> str:
        """One line: the status, and how many checks passed, objected and were skipped."""
        by_check: dict[str, set[str]] = {}
        for check, result in self.results:
            by_check.setdefault(check.name, set()).add(result.status)
        objecting = {n for n, told in by_check.items() if told & {"suspect", "fail", "error"}}
        passed = {n for n, told in by_check.items() if "pass" in told} - objecting
        skipped = len(by_check) - len(objecting) - len(passed)
        parts = [f"{Count(len(passed)):check|checks} passed"]
        parts += [f"{len(objecting)} objected"] if objecting else []
        parts += [f"{skipped} had nothing to look at"] if skipped else []
        return f"{self.name}: {self.status} ({', '.join(parts)})"

    def told(self, everything: bool = False) -> list[tuple[str, str, str, str]]:
        """Status, check, message and cure of what is worth reading, graver ones first.

        Objections and notes; with `everything` all that was asked.
        """
        return told_of(self.rows, notes=True, everything=everything)

    def __repr__(self) -> str:
        """Return what `tribolab check` shows: a summary, and objections and notes with cures."""
        lines = [self.summary]
        for status, check, message, cure in self.told():
            lines.append(f"{status}  {check}  {message}")
            lines += [f"    {cure}"] if cure else []
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Objections and notes; everything that was asked, folded away."""
        # late: starting stays quick
        import html

        objections = self.table["status"].isin(("suspect", "fail", "error"))
        noted = np.array([row["noted"] for row in self.rows], dtype=bool)
        columns = ["check", "status", "variable", "message", "cure"]
        told = self.table.assign(status=self.table["status"].where(~noted, "note"))[columns]
        told = told[objections | noted]
        look = {"text-align": "left", "vertical-align": "top"}
        short, long = (
            rows.style.hide()
            .format(na_rep="", escape="html")
            .set_properties(subset=None, **look)
            .to_html()
            for rows in (told, self.table.drop(columns="name"))
        )
        counted = ", ".join(f"{count} {status}" for status, count in self.count().items() if count)
        return (
            f"<p><b>{html.escape(self.name)}: {self.status}</b></p>{short if len(told) else ''}"
            f"<details><summary>everything that was asked: {counted}</summary>{long}</details>"
        )


def told_of(
    rows: Iterable[Mapping[str, Any]], *, notes: bool = False, everything: bool = False
) -> list[tuple[str, str, str, str]]:
    """Return status, check, message and cure of what is worth reading, graver ones first.

    Parameters
    ----------
    rows
        Of `Findings`.
    notes
        Whether notes on what is sound are worth it.
    everything
        Whether all is that was asked.
    """
    lines = []
    for row in rows:
        passed = row["status"] in ("pass", "skipped")
        note = passed and row["noted"]
        if everything or (note and notes) or not passed:
            variable = f"{row['variable']}: " if row["variable"] else ""
            decision = f"{row['decision']}: " if row.get("decision") else ""
            status = "note" if note or decision else row["status"]
            message = f"{decision}{variable}{row['message']}"
            lines.append((status, row["check"], message, "" if decision else row["cure"]))
    return lines


def exit_code(statuses: set[str], fail_on: str = "fail") -> int:
    """Exit code of a program that saw these statuses.

    Parameters
    ----------
    statuses
        Every status seen.
    fail_on
        "suspect", "fail" or "never": from which status on the program reports failure.

    Returns
    -------
    int
        3 if a check crashed, 1 if a status at or above `fail_on` was seen, else 0.

    Raises
    ------
    ConfigError
        If `fail_on` is none of the three.

    Examples
    --------
    >>> exit_code({"pass", "suspect"}), exit_code({"suspect"}, "suspect"), exit_code({"error"})
    (0, 1, 3)
    """
    if fail_on not in _FAIL_ON:
        raise ConfigError(f"fail_on: '{shown(fail_on)}' is not a level{nearest(fail_on, _FAIL_ON)}")
    if "error" in statuses:
        return 3
    if fail_on == "never":
        return 0
    return int(bool(statuses & set(STATUSES[STATUSES.index(fail_on) :])))
