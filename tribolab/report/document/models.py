"""Tables of the mixed-lubrication models: fitted shear stress, computed curve, sensitivity."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from tribolab.core.coverage import NORMAL
from tribolab.core.untyped import Json
from tribolab.records.models.model_rows import MODEL_LABELS
from tribolab.records.part_records import ModelRows

if TYPE_CHECKING:
    from tribolab.records.part_records import ModelRecord
    from tribolab.records.parts import ModelOutcome, Row

_STATISTICAL = "statistical only: the spectrum's error is not in it"
MODEL_COLUMNS = {  # columns that need other models or the surface, and their meanings
    "area_dry_over_wet": "real contact area, dry divided by in the medium",
    "judgement": "where measurement and model differ, in words",
    "spectrum_error_low": "relative change of the shear stress due to the uncertain spectrum, down",
    "spectrum_error_high": "the same, up",
    "spectrum_error_from": "curve for which it was computed, or empty",
    "shear_stress_low_Pa": "limit of the 95 % interval, with the uncertainty of the spectrum",
    "shear_stress_high_Pa": "",
    "ratio_to": "surface whose corrected shear stress is the denominator, or empty",
    "ratio": "",
    "ratio_error": "",
}
SHEAR_STRESS = [
    *("curve", *MODEL_LABELS),
    *("shear_stress_Pa", "shear_stress_error_Pa", "shear_stress_low_Pa", "shear_stress_high_Pa"),
    *("corrected_shear_stress_Pa", "corrected_shear_stress_error_Pa", "area"),
    *("valid_speed_low_m_s", "valid_speed_high_m_s", "judgement"),
]
_CURVE = [
    "curve",
    *MODEL_LABELS,
    *("sliding_speed_m_s", "friction_coefficient", "friction_coefficient_couette"),
    *("friction_coefficient_pressure", "friction_coefficient_solid", "friction_without_factors"),
    *("minimum_separation_m", "central_separation_m", "contact_area_ratio", "solid_load_share"),
    *("residual", "load_balance", "flux_variation", "iterations", "cells"),
]
SENSITIVE = {  # columns of the sensitivity to one input, and their meanings
    "variation": "",
    "low": "",
    "high": "",
    "largest_change": "change of the friction coefficient divided by the peak of the curve",
    "largest_change_speed_m_s": "",
    "largest_relative_change": "",
    "largest_relative_change_speed_m_s": "",
    "shear_stress_change_low": "relative change of the fitted shear stress at the lower end",
    "shear_stress_change_high": "",
    "reason": "",
}


@dataclass(frozen=True, kw_only=True)
class ModelRow(ModelRows):
    """Mixed-lubrication model of one curve, its fit, and its rows in the tables."""

    model: ModelOutcome
    fit: Json | None

    @property
    def labels(self) -> Row:
        """Curve, surface, medium and load: the first columns of every table of models."""
        model = self.model
        values = model.curve, model.surface, model.medium, model.normal_force
        return dict(zip(("curve", *MODEL_LABELS), values, strict=True))


def model_rows_of(records: Iterable[ModelRecord]) -> dict[str, ModelRow]:
    """Return the rows of all models that have results, by name, completed by `complete`."""
    rows = {}
    for record in records:
        if record.rows is None:
            continue
        fit = None
        if record.rows.fit is not None:
            fit = {k: math.nan if v is None else v for k, v in record.rows.fit.items()}
        known = vars(record.rows) | {"fit": fit}
        rows[record.outcome.name] = ModelRow(model=record.outcome, **known)
    complete(list(rows.values()))
    return rows


def complete(rows: Sequence[ModelRow]) -> None:
    """Add to each fit the error due to the spectrum, and the stress ratio to an earlier surface.

    The error due to the spectrum is known at the load at which the model's uncertainty was
    computed. It scales the whole plateau, so it is also used at the other loads of the surface.
    """
    fitted = [(row.model, row.fit) for row in rows if row.fit is not None]
    shifts = [(row.model, row.shift) for row in rows if row.shift is not None]
    for model, fit in fitted:
        known = [pair for pair in shifts if _kind(pair[0]) == _kind(model)]
        own = [pair for pair in known if pair[0] is model]
        stress, half = (fit[f"shear_stress_{k}Pa"] for k in ("", "statistical_half_interval_"))
        if known:
            source, (low, high) = (own or known)[0]
            fit |= {"spectrum_error_low": low, "spectrum_error_high": high}
            fit["spectrum_error_from"] = source.curve
            _add_spectrum(fit, (high - low) / (2 * NORMAL))
        else:
            low = high = 0.0
            fit |= dict.fromkeys(("spectrum_error_low", "spectrum_error_high"))
            fit["spectrum_error_from"] = ""
            fit["interval_says"] = f"{_STATISTICAL}; {fit['interval_says']}"
        fit["shear_stress_low_Pa"] = stress - float(np.hypot(half, stress * low))
        fit["shear_stress_high_Pa"] = stress + float(np.hypot(half, stress * high))
    for place, (model, fit) in enumerate(fitted):
        fit |= {"ratio_to": "", "ratio": None, "ratio_error": None}
        # models earlier in the campaign, at the same load and in the same medium
        earlier = [
            (other, of)
            for other, of in fitted[:place]
            if (other.medium, other.normal_force) == (model.medium, model.normal_force)
        ]
        if not earlier:
            continue
        reference, first_fit = earlier[-1]
        if _is_known(first_fit) and fit["shear_stress_Pa"] > 0:
            value, error = (
                [of[f"corrected_shear_stress_{k}Pa"] for of in (fit, first_fit)]
                for k in ("", "error_")
            )
            ratio = value[0] / value[1]
            parts = [e / v for e, v in zip(error, value, strict=True)]
            fit |= {
                "ratio_to": reference.surface,
                "ratio": ratio,
                "ratio_error": float(abs(ratio) * np.hypot(*parts)),
            }


def _add_spectrum(fit: Json, relative: float) -> None:
    """Combine the spectrum's error with those of the shear stress and of its corrected value."""
    for name in ("shear_stress_total_error_Pa", "corrected_shear_stress_error_Pa"):
        value = "corrected_shear_stress_Pa" if "corrected" in name else "shear_stress_Pa"
        fit[name] = float(np.hypot(fit[name], relative * fit[value]))


def _is_known(fit: Json) -> bool:
    """Whether a corrected shear stress exceeds twice its error, so that ratios to it make sense."""
    return fit["corrected_shear_stress_Pa"] > 2 * fit["corrected_shear_stress_error_Pa"]


def _kind(model: ModelOutcome) -> tuple[str, str]:
    return model.surface, model.medium


def shear_stress_table(rows: Sequence[ModelRow]) -> pd.DataFrame:
    """Return the table of fitted shear stresses, a row per curve."""
    fits = [row.labels | row.fit for row in rows if row.fit is not None]
    return pd.DataFrame(fits, columns=SHEAR_STRESS)


def model_curve_table(rows: Sequence[ModelRow]) -> pd.DataFrame:
    """Return the table of computed curves, a row per model and speed."""
    points = [model.labels | row for model in rows for row in model.curve]
    return pd.DataFrame(points, columns=_CURVE)
