"""Earlier results that are kept because what they were made from cannot be read now.

A file that is empty, locked or away for an hour must not take good results with it. What is kept
says so, and since when; it is dropped when the campaign no longer names its files.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from tribolab.records.parts import Finding, ModelOutcome, SurfaceOutcome

Part = TypeVar("Part", SurfaceOutcome, ModelOutcome)

# The files were read, and the answer is about what is in them: it stands.
VERDICTS = ("AnalysisError",)
GONE = "it is not there"


def kept_text(path: Path, why: str) -> str:
    """Return since when a part is kept, as its data file knows it, and why."""
    from tribolab.io.netcdf import opened

    try:
        with opened(path) as file:
            when = str(getattr(file, "history", "")).split(" ")[0]
    except (OSError, RuntimeError):
        when = ""
    return f"kept from {when or 'before'}: {why}"


def kept_outcome(before: Part, text: str) -> Part:
    """Return an earlier outcome with a finding that it is kept, and why."""
    findings = (*_others(before.findings, before.kept), Finding("fail", text))
    return replace(before, findings=findings, reused=False, kept=text)


def _others(findings: Iterable[Finding], kept: str) -> list[Finding]:
    return [finding for finding in findings if finding.message != kept]
