"""Earlier results that are kept because their source files cannot be read now.

A file that is temporarily empty, locked or missing must not discard good results. Kept results
state the date of the earlier analysis. If the campaign no longer names their files, they are
dropped.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError
from tribolab.records.part_records import ModelRecord, SurfaceRecord
from tribolab.records.parts import Finding

PartRecord = TypeVar("PartRecord", SurfaceRecord, ModelRecord)

# final errors: the files were read, and the error concerns their content
VERDICTS = ("AnalysisError", "ConfigError")
GONE = "it is not there"


def kept_text(path: Path, why: str) -> str:
    """Return the text on why a part is kept, with the date of its data file."""
    from tribolab.reading.netcdf.netcdf import read_groups  # imported late for a quick start

    try:
        root = read_groups(path, [None], only={"": ()})[None]
        when = RunAttributes.from_attrs(root.attrs).history.split(" ")[0]
    except ReadError:
        when = ""
    return f"kept from {when or 'before'}: {why}"


def kept_record(
    store: Store, kind: str, earlier: PartRecord, why: str, data_file: str = ""
) -> PartRecord | None:
    """Return an earlier record with a finding on why it is kept.

    Parameters
    ----------
    store
        Store into which the data file of the earlier record is linked.
    kind, earlier
        Kind in the catalogue, and the record.
    why
        Reason in words.
    data_file
        New name of the file; by default unchanged.

    Returns
    -------
    SurfaceRecord, ModelRecord or None
        None if the data file was changed.
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
