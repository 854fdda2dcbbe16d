"""Earlier models that are kept because they cannot be computed now."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.campaign.store.kept import VERDICTS, kept_record
from tribolab.records.part_records import ModelRecord

if TYPE_CHECKING:
    from tribolab.campaign.store.new_catalogue import Store


def kept_model(store: Store, record: ModelRecord) -> ModelRecord:
    """Return the earlier record of a model that could not be computed now, if there is one.

    The outcome states that it is kept. Otherwise the record is returned unchanged.
    """
    now = record.outcome
    if now.status != "failed" or now.error in VERDICTS:
        return record
    known = store.before.get("model", now.name, ModelRecord)
    if known is None or not known.record.outcome.done:
        return record
    why = f"the model cannot be computed now ({now.reason})"
    return kept_record(store, "model", known.record, why) or record
