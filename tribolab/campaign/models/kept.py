"""Earlier models that are kept because they cannot be computed now."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tribolab.campaign.store.kept import VERDICTS, kept_outcome, kept_text
from tribolab.records.part_records import ModelRecord

if TYPE_CHECKING:
    from tribolab.campaign.store.catalogue import Store


def kept_model(store: Store, record: ModelRecord) -> tuple[ModelRecord, bool]:
    """Return the earlier record of a model that could not be computed now, if there is one.

    Returns
    -------
    tuple of ModelRecord and bool
        The record, and whether it is an earlier one.
    """
    now = record.outcome
    if now.status != "failed" or now.error in VERDICTS or store.previous is None:
        return record, False
    known = store.before.get("model", now.name, ModelRecord)
    if known is None or not known.record.outcome.done:
        return record, False
    before = known.record.outcome
    path = store.previous / before.data_file
    text = kept_text(path, f"the model cannot be computed now ({now.reason})")
    if not store.link("model", now.name, before.data_file, before.data_file):
        return record, False
    return replace(known.record, outcome=kept_outcome(before, text)), True
