"""Earlier results that are kept because what they were made from cannot be read now.

A file that is empty, locked or away for an hour must not take good results with it. What is kept
says so, and since when; it is dropped when the campaign no longer names its files.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from tribolab.campaign.store.catalogue import Store
from tribolab.core.errors import ReadError
from tribolab.records.part_records import ModelRecord, SurfaceRecord
from tribolab.records.parts import Finding

PartRecord = TypeVar("PartRecord", SurfaceRecord, ModelRecord)

# The files were read, and the answer is about what is in them: it stands.
VERDICTS = ("AnalysisError", "ConfigError")
GONE = "it is not there"


def kept_text(path: Path, why: str) -> str:
    """Return since when a part is kept, as its data file knows it, and why."""
    # late: starting stays quick
    from tribolab.reading.netcdf.netcdf import read_groups

    try:
        root = read_groups(path, [None], only={"": ()})[None]
        when = str(root.attrs.get("history", "")).split(" ")[0]
    except ReadError:
        when = ""
    return f"kept from {when or 'before'}: {why}"


def kept_record(
    store: Store, kind: str, earlier: PartRecord, why: str, data_file: str = ""
) -> PartRecord | None:
    """Return an earlier record with a finding that it is kept, and why.

    Parameters
    ----------
    store
        It has the data file of the earlier record linked among the new ones.
    kind, earlier
        Where it stood in the catalogue, and the record.
    why
        In words.
    data_file
        How the file is called now; by default as before.

    Returns
    -------
    SurfaceRecord, ModelRecord or None
        None if the data file is not as it was written.
    """
    before = earlier.outcome
    if store.previous is None:
        return None
    text = kept_text(store.previous / before.data_file, why)
    now = data_file or before.data_file
    if not store.link(kind, before.name, before.data_file, now):
        return None
    findings: list[Finding] = [f for f in before.findings if f.message != before.kept]
    findings.append(Finding("fail", text))
    outcome = replace(before, findings=tuple(findings), reused=False, kept=text, data_file=now)
    return replace(earlier, outcome=outcome)
