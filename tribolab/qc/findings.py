"""Findings of the checks, for a table, the terminal, the report or a program."""

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
    """Result of one check as a dictionary, with limits in SI; `value` is None without a number.

    `decision` is present if a person settled an objection.
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


def _worst_status(statuses: Iterable[str]) -> str:
    there = {*statuses} - {"skipped"}
    return max(there, key=STATUSES.index, default="skipped")


@dataclass(frozen=True, repr=False)
class Findings:
    """Results of all checks on one run, or on the scans of one surface.

    Attributes
    ----------
    name
        Name of the checked run or scans, usually the file's name.
    results
        ``(check, result)`` pairs, at least one for every known check.
    flagged
        The data with their quality flags, if the checks set any.
    limits
        The limits used, SI, by check and name.
    verdict
        "accepted" or "rejected" if a person decided on the run; else empty.
    """

    name: str
    results: tuple[tuple[Check[Never], Result], ...]
    flagged: xr.Dataset | None = field(default=None, repr=False)
    limits: Mapping[str, Mapping[str, float]] = field(default_factory=dict, repr=False)
    verdict: str = ""

    @property
    def marked(self) -> xr.Dataset:
        """Checked data with their quality flags.

        Raises
        ------
        LookupError
            If the checks set no flags, as for an instrument's own results.
        """
        if self.flagged is None:
            raise LookupError(f"{self.name}: its checks set no flags")
        return self.flagged

    @property
    def rows(self) -> list[FindingRow]:
        """Results as dictionaries, worst first; unknown numbers are None."""
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
                "limits": {
                    name: limit
                    for name, limit in self.limits.get(check.name, {}).items()
                    if np.isfinite(limit)  # a limit that is not set is NaN
                },
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
        """Table with one row for each check and variable."""
        # imported late: pandas loads slowly
        import pandas as pd

        columns = ["check", "status", "variable", "message", "value", "unit", "where", "cure"]
        return pd.DataFrame(self.rows, columns=["name", *columns])

    @property
    def status(self) -> str:
        """Worst status of all checks; "pass" if at least one check passed and none objected.

        If a person decided on the run it is "accepted" or "rejected"; settled objections do not
        count.
        """
        return self.verdict or _worst_status(r.status for _, r in self.results if not r.settled)

    @property
    def status_as_found(self) -> str:
        """Worst status of all checks, before any decisions of the user."""
        return _worst_status(result.status for _, result in self.results)

    def count(self) -> Mapping[str, int]:
        """Return the number of results of each status."""
        statuses = [result.status for _, result in self.results]
        return {status: statuses.count(status) for status in STATUSES}

    @property
    def summary(self) -> str:
        """Status and numbers of checks that passed, objected and were skipped, in one line."""
        by_check: dict[str, set[str]] = {}
        for check, result in self.results:
            by_check.setdefault(check.name, set()).add(result.status)
        objecting = {
            n for n, statuses in by_check.items() if statuses & {"suspect", "fail", "error"}
        }
        passed = {n for n, statuses in by_check.items() if "pass" in statuses} - objecting
        skipped = len(by_check) - len(objecting) - len(passed)
        parts = [f"{Count(len(passed)):check|checks} passed"]
        parts += [f"{len(objecting)} with findings"] if objecting else []
        parts += [f"{skipped} skipped"] if skipped else []
        return f"{self.name}: {self.status} ({', '.join(parts)})"

    def messages(self, everything: bool = False) -> list[tuple[str, str, str, str]]:
        """Return status, check, message and remedy of each objection and note, worst first.

        With `everything`, return the results of all checks.
        """
        return finding_texts(self.rows, notes=True, everything=everything)

    def __repr__(self) -> str:
        """Return the text of `tribolab check`: summary, then objections and notes with remedies."""
        lines = [self.summary]
        for status, check, message, cure in self.messages():
            lines.append(f"{status}  {check}  {message}")
            lines += [f"    {cure}"] if cure else []
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return an HTML table of objections and notes; the other results are collapsed."""
        # imported late: needed in notebooks only
        import html

        objections = self.table["status"].isin(("suspect", "fail", "error"))
        noted = np.array([row["noted"] for row in self.rows], dtype=bool)
        columns = ["check", "status", "variable", "message", "cure"]
        listed = self.table.assign(status=self.table["status"].where(~noted, "note"))[columns]
        listed = listed[objections | noted]
        look = {"text-align": "left", "vertical-align": "top"}
        short, long = (
            rows.style.hide()
            .format(na_rep="", escape="html")
            .set_properties(subset=None, **look)
            .to_html()
            for rows in (listed, self.table.drop(columns="name"))
        )
        counted = ", ".join(f"{count} {status}" for status, count in self.count().items() if count)
        return (
            f"<p><b>{html.escape(self.name)}: {self.status}</b></p>{short if len(listed) else ''}"
            f"<details><summary>all checks: {counted}</summary>{long}</details>"
        )


def finding_texts(
    rows: Iterable[Mapping[str, Any]], *, notes: bool = False, everything: bool = False
) -> list[tuple[str, str, str, str]]:
    """Return status, check, message and remedy of each objection or note, worst first.

    Parameters
    ----------
    rows
        Rows of `Findings`.
    notes
        Whether to include notes on passed checks.
    everything
        Whether to include the results of all checks.
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
    """Return the exit code of a program, from the statuses of its checks.

    Parameters
    ----------
    statuses
        Every status seen.
    fail_on
        "suspect", "fail" or "never": lowest status for which the program reports failure.

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
