"""The report's part on models: tables written, records and figures planned."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.report import model_records, tables
from tribolab.report.model_figures import ModelFigure, plan_model_figures
from tribolab.report.model_records import model_record, model_rows
from tribolab.report.part_rows import rows_of

if TYPE_CHECKING:
    from tribolab.campaign.outcome import Outcome


def write_models(
    outcome: Outcome, findings: list[dict[str, str]]
) -> tuple[list[dict[str, Any]], list[ModelFigure]]:
    """Write the tables of the models; return their records and the figures to draw.

    What was found about the models is added to `findings`.
    """
    rows = rows_of(
        outcome.models,
        lambda model: model_rows(outcome, model),
        findings,
        kind="model",
        prefix="model_",
    )
    every = list(rows.values())
    model_records.complete(every)
    folder = Path(outcome.folder)
    if outcome.models:
        stresses = model_records.shear_stress_table(every)
        for name, table in (
            ("shear_stress", stresses),
            ("stribeck_model", model_records.curve_table(every)),
            ("model_sensitivity", model_records.sensitivity_table(every)),
        ):
            tables.write(table, folder / "tables" / f"{name}.csv")
    records = [model_record(model, rows.get(model.name)) for model in outcome.models]
    return records, plan_model_figures(outcome, every)
