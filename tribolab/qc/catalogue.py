"""Generated page raw_data_schema/CHECKS.md: all checks with their limits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Never

from tribolab.qc.register import Check
from tribolab.qc.run.checks import RUN_CHECKS
from tribolab.qc.scan.checks import SCAN_CHECKS

CHECKS_PAGE = "CHECKS.md"
_HEAD = """# The checks

The checks that `tribolab check` and `tribolab run` apply to every run and scan. Set limits in the
campaign file under `[qc]`, as text with a unit or as numbers in SI: `limits.spikes.noise = 10`;
`skip = ["hum"]` disables a check. The result is pass, suspect, fail, skipped (with the reason) or
error (with the message). In a campaign, `repeats` also compares the runs of one condition with each
other and with the repeatability under all other conditions. This page is generated from the code.
"""


def catalogue() -> str:
    """Return the page CHECKS.md: each check's question, remedy, and limits with reasons.

    Examples
    --------
    >>> "### spikes" in catalogue()
    True
    """
    parts = [
        _HEAD,
        "## Checks of runs\n",
        *_chapter(RUN_CHECKS),
        "## Checks of scans\n",
        *_chapter(SCAN_CHECKS),
    ]
    return "\n".join(parts)


def _chapter(checks: Mapping[str, Check[Never]]) -> list[str]:
    lines = []
    for check in checks.values():
        lines += [f"### {check.name}\n", f"{check.question} {check.cure}\n"]
        if check.limits:
            lines += ["| limit | default | unit | reason |", "| --- | --- | --- | --- |"]
            for name, limit in check.limits.items():
                lines.append(f"| {name} | {limit.value:g} | {limit.unit} | {limit.reason} |")
            lines.append("")
    return lines
