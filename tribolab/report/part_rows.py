"""What the report shows of surfaces and models, read from their data files one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol, TypeVar

from tribolab.words import explain

Rows = TypeVar("Rows")


class Part(Protocol):
    """A surface or a model as a campaign ended it."""

    name: str
    findings: tuple[Any, ...]

    @property
    def done(self) -> bool:
        """Whether there are results."""


def rows_of(
    parts: Iterable[Part],
    read: Callable[[Any], Rows],
    findings: list[dict[str, str]],
    *,
    kind: str,
    prefix: str = "",
) -> dict[str, Rows]:
    """Read the rows of each part by its name; one that cannot be read does not stop the others.

    Parameters
    ----------
    parts
        Surfaces or models.
    read
        Returns what is shown of one that has results.
    findings
        Is added to: what was found about each, and what could not be read.
    kind, prefix
        What such a part is called in the findings; what is left out of its name there.
    """
    rows: dict[str, Rows] = {}
    for part in parts:
        where = f"{kind} {part.name.removeprefix(prefix)}"
        findings += [
            {"severity": f.severity, "run": "", "where": where, "message": f.message}
            for f in part.findings
        ]
        if not part.done:
            continue
        try:
            rows[part.name] = read(part)
        except Exception as error:  # recorded: the others have their place in the report
            message = explain(error)[0]
            findings.append({"severity": "error", "run": "", "where": where, "message": message})
    return rows
