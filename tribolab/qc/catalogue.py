"""Catalogue of all checks and their limits (raw_data_schema/CHECKS.md)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Never

from tribolab.qc.register import Check
from tribolab.qc.run.checks import RUN_CHECKS
from tribolab.qc.scan.checks import SCAN_CHECKS

CHECKS_PAGE = "CHECKS.md"
_HEAD = """# The checks

What `tribolab check` and `tribolab run` ask of every run and scan. Limits are set in the campaign
file under `[qc]`, as text with a unit or as numbers in SI: `limits.spikes.noise = 10`;
`skip = ["hum"]` leaves a check out. Each answers pass, suspect, fail, skipped (and why) or error
(and which). In a campaign `repeats` also compares the runs of one condition with each other, and
with how well runs repeat under all other conditions. This page is made from the code, and a test
keeps the two equal.
"""


def catalogue() -> str:
    """Page of all checks: question, limits with units and reasons, and what to do.

    Examples
    --------
    >>> "### spikes" in catalogue()
    True
    """
    parts = [_HEAD, "## On runs\n", *_chapter(RUN_CHECKS), "## On scans\n", *_chapter(SCAN_CHECKS)]
    return "\n".join(parts)


def _chapter(checks: Mapping[str, Check[Never]]) -> list[str]:
    lines = []
    for check in checks.values():
        lines += [f"### {check.name}\n", f"{check.question} {check.cure}\n"]
        if check.limits:
            lines += ["| limit | default | unit | why |", "| --- | --- | --- | --- |"]
            for name, limit in check.limits.items():
                lines.append(f"| {name} | {limit.value:g} | {limit.unit} | {limit.reason} |")
            lines.append("")
    return lines
