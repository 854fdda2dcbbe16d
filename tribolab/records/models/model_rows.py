"""Rows of one model: fit, curve, and sensitivities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribolab.core.wording import is_dry
from tribolab.records.frames import frame, plain_rows, traction_table
from tribolab.records.models.model_words import judgement
from tribolab.records.part_records import ModelRows
from tribolab.records.parts import Row
from tribolab.records.wording import plain_value, validity_of

if TYPE_CHECKING:
    import xarray as xr


MODEL_LABELS = ("surface", "medium", "normal_force_N")


FITTED = {  # columns of a fit, with their meaning if the name does not explain it
    "shear_stress_Pa": "effective, for the contact area by `area` and `adhesion`",
    "shear_stress_error_Pa": "standard error due to the errors of the points",
    "shear_stress_common_error_Pa": "standard error shared by all points: "
    "repeatability of a run's level",
    "shear_stress_total_error_Pa": "standard error from the points (with misfit and "
    "correlation), the common level, and the spectrum if spectrum_error_from is not empty",
    "shear_stress_statistical_half_interval_Pa": "half the 95 % interval without the "
    "uncertainty of the spectrum: statistical only",
    "area_enhancement": "real contact area with adhesion divided by that of the model",
    "area_enhancement_error": "standard error whose 95 % interval reaches the farther bound",
    "area_enhancement_low": "minimum within the bounds of spectrum and work of adhesion",
    "area_enhancement_high": "maximum within the bounds of spectrum and work of adhesion",
    "corrected_shear_stress_Pa": "shear stress for the contact area with adhesion",
    "corrected_shear_stress_error_Pa": "",
    "area": "theory of the contact area used for shear_stress_Pa",
    "adhesion": 'whether the contact area is "with" or "without" adhesion',
    "other_area": "the other theory of the contact area",
    "shear_stress_other_area_Pa": "effective, for the contact area of other_area",
    "measured_area_m2": "measured contact area (camera), or null",
    "hertz_area_m2": "area of the Hertz contact",
    "real_area_m2": "computed real contact area at the lowest speed",
    "measured_shear_stress_Pa": "friction force over measured area at the lowest speed, or null",
    "chi_square": "",
    "degrees_of_freedom": "",
    "chi_square_p_value": "",
    "birge_ratio": "",
    "runs_p_value": "probability of so few sign changes of the residuals by chance",
    "valid_speed_low_m_s": "limit of the widest speed range that one shear stress describes",
    "valid_speed_high_m_s": "",
    "residual_correlation": "correlation of the errors at neighbouring speeds, from the residuals",
    "interval_says": "contributions to the 95 % interval, and its quantiles",
}


LEFT_OUT = {  # columns of an effect that is not in the model, and their meanings
    "effect": "",
    "size": "estimated for this contact; empty if not known",
    "reason": "what the model assumes instead",
}


def model_rows(
    groups: Mapping[str, xr.Dataset],
    medium: str,
    normal_force: float,
    adhesion: xr.Dataset | None,
) -> ModelRows:
    """Return rows of a model from the groups of its data file.

    Parameters
    ----------
    groups
        ``curve``; if present: ``fit``, ``uncertainty``, ``left_out``, ``traction``.
    medium, normal_force
        Medium and load [N] of the model.
    adhesion
        Adhesion of the surface at the loads (medium, load); None if unknown.
    """
    from tribolab.fit.spectrum_error import shear_stress_shift  # imported late for a quick start

    curve = frame(groups["curve"], "sliding_speed").assign(cells=groups["curve"].attrs["cells"])
    rows = ModelRows(None, plain_rows(curve), validity=validity_of(groups.values()))
    if "fit" in groups:
        attrs = groups["fit"].attrs
        fit = {key: attrs[key] for key in FITTED}
        fit["area_dry_over_wet"] = _dry_over_wet(adhesion, medium, normal_force)
        fit["judgement"] = judgement(groups["fit"])
        rows = replace(rows, fit=plain_value(fit))
    if "uncertainty" in groups:
        varied = groups["uncertainty"]
        rows = replace(
            rows,
            sensitivity=tuple(plain_value(_sensitivity(varied))),
            not_varied=str(varied.attrs["not_varied"]),
            shift=shear_stress_shift(varied),
        )
    if "left_out" in groups:
        effects = groups["left_out"].to_dataframe().reset_index()
        rows = replace(rows, not_in_model=plain_rows(effects[list(LEFT_OUT)]))
    if "traction" in groups:
        rows = replace(rows, traction=plain_rows(traction_table(groups["traction"])))
    return rows


def _dry_over_wet(adhesion: xr.Dataset | None, medium: str, normal_force: float) -> float | None:
    """Return the dry real contact area divided by that in the medium; None if unknown."""
    if adhesion is None:
        return None
    dry = [name for name in adhesion.medium.values.tolist() if is_dry(name)]
    if not dry or medium not in adhesion.medium.values:
        return None
    forces = adhesion["normal_force"].values.ravel()
    at = int(np.argmin(np.abs(forces - normal_force)))
    area = adhesion["contact_area_ratio"].isel(load=at)
    return float(area.sel(medium=dry[0]) / area.sel(medium=medium))


def _sensitivity(band: xr.Dataset) -> list[Row]:
    rows = []
    for name in band["variation"].values.tolist():
        varied = band.sel(variation=name)
        rows.append(
            {
                "variation": name,
                "low": str(varied["variation_low"].values),
                "high": str(varied["variation_high"].values),
                "largest_change": float(varied["largest_change"]),
                "largest_change_speed_m_s": float(varied["largest_change_speed"]),
                "largest_relative_change": float(varied["largest_relative_change"]),
                "largest_relative_change_speed_m_s": float(varied["largest_relative_change_speed"]),
                "shear_stress_change_low": float(varied["shear_stress_change_low"]),
                "shear_stress_change_high": float(varied["shear_stress_change_high"]),
                "reason": str(varied["variation_reason"].values),
            }
        )
    rows.sort(key=lambda row: -row["largest_change"])
    return rows
