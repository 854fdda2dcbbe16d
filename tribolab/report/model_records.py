"""What tables and report say of the models: shear stresses, curves, sensitivity, and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from tribolab.report.model_words import judgement
from tribolab.report.tables import frame
from tribolab.report.wording import plain_value, validity_of

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.outcome import ModelOutcome, Outcome

_95 = 1.959963984540054
STATISTICAL = "statistical only: the spectrum's error is not in it"
LABELS = ("surface", "medium", "normal_force_N")
_FITTED = (
    *("shear_stress_Pa", "shear_stress_error_Pa", "shear_stress_common_error_Pa"),
    *("shear_stress_total_error_Pa", "shear_stress_statistical_half_interval_Pa"),
    *("area_enhancement", "area_enhancement_error"),
    *("area_enhancement_low", "area_enhancement_high"),
    *("corrected_shear_stress_Pa", "corrected_shear_stress_error_Pa"),
    *("chi_square", "degrees_of_freedom", "chi_square_p_value", "birge_ratio", "runs_p_value"),
    *("valid_speed_low_m_s", "valid_speed_high_m_s", "residual_correlation", "interval_says"),
)
SHEAR_STRESS = [
    "curve",
    *LABELS,
    *_FITTED[:5],
    *("spectrum_error_low", "spectrum_error_high", "spectrum_error_from"),
    *("shear_stress_low_Pa", "shear_stress_high_Pa"),
    *_FITTED[5:],
    *("area_dry_over_wet", "ratio_to", "ratio", "ratio_error", "judgement"),
]
CURVE = [
    "curve",
    *LABELS,
    *("sliding_speed_m_s", "friction_coefficient", "friction_coefficient_couette"),
    *("friction_coefficient_pressure", "friction_coefficient_solid", "friction_without_factors"),
    *("minimum_separation_m", "central_separation_m", "contact_area_ratio", "solid_load_share"),
    *("residual", "load_balance", "flux_variation", "iterations", "cells"),
]
SENSITIVITY = [
    "curve",
    *LABELS,
    *("variation", "low", "high", "largest_change", "largest_change_speed_m_s"),
    *("largest_relative_change", "largest_relative_change_speed_m_s"),
    *("shear_stress_change_low", "shear_stress_change_high", "reason"),
]


@dataclass
class ModelRows:
    """Rows of one model; `fit` is None where no shear stress could be fitted."""

    model: ModelOutcome
    fit: dict[str, Any] | None
    curve: pd.DataFrame
    sensitivity: list[dict[str, Any]] = field(default_factory=list)
    not_varied: str = ""
    shift: tuple[float, float] | None = None
    validity: str = ""

    @property
    def labels(self) -> dict[str, Any]:
        """Columns that stand first in every table."""
        one = self.model
        values = one.curve, one.surface, one.medium, one.normal_force
        return dict(zip(("curve", *LABELS), values, strict=True))


def model_rows(outcome: Outcome, model: ModelOutcome) -> ModelRows:
    """Read the rows of a model that is done from its data file.

    Raises
    ------
    TribolabError
        If the file or one of its groups cannot be read.
    """
    from tribolab.fit.spectrum_error import shear_stress_shift
    from tribolab.io.netcdf import read_groups

    path = Path(outcome.folder) / model.data_file
    groups = read_groups(path, model.parts)
    curve = frame(groups["curve"], "sliding_speed").assign(cells=groups["curve"].attrs["cells"])
    rows = ModelRows(model, None, curve)
    rows.validity = validity_of(groups.values())
    if "fit" in groups:
        attrs = groups["fit"].attrs
        rows.fit = {key: attrs[key] for key in _FITTED}
        rows.fit["area_dry_over_wet"] = _dry_over_wet(outcome, model)
        rows.fit["judgement"] = judgement(groups["fit"])
    if "uncertainty" in groups:
        rows.sensitivity = _sensitivity(groups["uncertainty"])
        rows.not_varied = str(groups["uncertainty"].attrs["not_varied"])
        rows.shift = shear_stress_shift(groups["uncertainty"])
    return rows


def _dry_over_wet(outcome: Outcome, model: ModelOutcome) -> float | None:
    """Real contact area dry over that in the medium, at the same load; None if not known."""
    from tribolab.io.netcdf import read_netcdf
    from tribolab.plot.curves import is_dry

    mine = [s for s in outcome.surfaces if s.name == model.surface and "adhesion_loads" in s.parts]
    if not mine:
        return None
    found = read_netcdf(Path(outcome.folder) / mine[0].data_file, group="adhesion_loads")
    dry = [name for name in found.medium.values.tolist() if is_dry(name)]
    if not dry or model.medium not in found.medium.values:
        return None
    forces = found["normal_force"].values.ravel()
    at = int(np.argmin(np.abs(forces - model.normal_force)))
    area = found["contact_area_ratio"].isel(load=at)
    return float(area.sel(medium=dry[0]) / area.sel(medium=model.medium))


def _sensitivity(found: xr.Dataset) -> list[dict[str, Any]]:
    rows = []
    for name in found["variation"].values.tolist():
        one = found.sel(variation=name)
        rows.append(
            {
                "variation": name,
                "low": str(one["variation_low"].values),
                "high": str(one["variation_high"].values),
                "largest_change": float(one["largest_change"]),
                "largest_change_speed_m_s": float(one["largest_change_speed"]),
                "largest_relative_change": float(one["largest_relative_change"]),
                "largest_relative_change_speed_m_s": float(one["largest_relative_change_speed"]),
                "shear_stress_change_low": float(one["shear_stress_change_low"]),
                "shear_stress_change_high": float(one["shear_stress_change_high"]),
                "reason": str(one["variation_reason"].values),
            }
        )
    rows.sort(key=lambda row: -row["largest_change"])
    return rows


def complete(rows: Sequence[ModelRows]) -> None:
    """Add what needs several models: the spectrum's error and ratios between surfaces.

    The spectrum's error is known where the model's uncertainty was computed; at the other loads of
    the surface it is taken from there, since it moves the whole plateau by one factor.
    """
    fitted = [one for one in rows if one.fit is not None]
    for one in fitted:
        same = [
            other
            for other in rows
            if other.shift and (other.model.surface, other.model.medium) == _kind(one)
        ]
        source = one if one.shift else (same or [None])[0]
        low, high = source.shift if source else (None, None)
        names = ("", "statistical_half_interval_")
        stress, half = (one.fit[f"shear_stress_{k}Pa"] for k in names)
        if not source:
            one.fit["interval_says"] = f"{STATISTICAL}; {one.fit['interval_says']}"
        one.fit |= {
            "spectrum_error_low": low,
            "spectrum_error_high": high,
            "spectrum_error_from": "" if not source else source.model.curve,
            "shear_stress_low_Pa": stress - float(np.hypot(half, stress * (low or 0))),
            "shear_stress_high_Pa": stress + float(np.hypot(half, stress * (high or 0))),
        }
        if source:
            _add_spectrum(one.fit, (high - low) / (2 * _95))
    for one in fitted:
        one.fit |= {"ratio_to": "", "ratio": None, "ratio_error": None}
        # the others at the same load and in the same medium, in the order of the campaign
        alike = [
            other
            for other in fitted
            if (other.model.medium, other.model.normal_force)
            == (one.model.medium, one.model.normal_force)
        ]
        earlier = alike[: alike.index(one)]
        reference = earlier[-1] if earlier else None
        if reference and _is_known(reference.fit) and one.fit["shear_stress_Pa"] > 0:
            value, error = (
                [other.fit[f"corrected_shear_stress_{k}Pa"] for other in (one, reference)]
                for k in ("", "error_")
            )
            ratio = value[0] / value[1]
            parts = [e / v for e, v in zip(error, value, strict=True)]
            one.fit |= {
                "ratio_to": reference.model.surface,
                "ratio": ratio,
                "ratio_error": float(abs(ratio) * np.hypot(*parts)),
            }


def _add_spectrum(fit: dict[str, Any], relative: float) -> None:
    """Add the spectrum's relative standard error to those of the shear stresses."""
    for name in ("shear_stress_total_error_Pa", "corrected_shear_stress_error_Pa"):
        value = "corrected_shear_stress_Pa" if "corrected" in name else "shear_stress_Pa"
        fit[name] = float(np.hypot(fit[name], relative * fit[value]))


def _is_known(fit: dict[str, Any]) -> bool:
    """Whether a shear stress stands out from its error: a ratio to another says nothing."""
    return fit["corrected_shear_stress_Pa"] > 2 * fit["corrected_shear_stress_error_Pa"]


def _kind(one: ModelRows) -> tuple[str, str]:
    return one.model.surface, one.model.medium


def shear_stress_table(rows: Sequence[ModelRows]) -> pd.DataFrame:
    """Return all fits, a row each."""
    fits = [one.labels | one.fit for one in rows if one.fit is not None]
    return pd.DataFrame(fits, columns=SHEAR_STRESS)


def curve_table(rows: Sequence[ModelRows]) -> pd.DataFrame:
    """Return all model curves, a row per speed."""
    points = [one.labels | row for one in rows for row in one.curve.to_dict("records")]
    return pd.DataFrame(points, columns=CURVE)


def sensitivity_table(rows: Sequence[ModelRows]) -> pd.DataFrame:
    """Return what moves the curves, a row per variation."""
    varied = [one.labels | row for one in rows for row in one.sensitivity]
    return pd.DataFrame(varied, columns=SENSITIVITY)


def model_record(model: ModelOutcome, rows: ModelRows | None) -> dict[str, Any]:
    """Return a model for report.json."""
    fit = None if rows is None or rows.fit is None else rows.fit
    return plain_value(
        {
            "name": model.name,
            "curve": model.curve,
            "status": model.status,
            "reason": model.reason,
            "error": model.error,
            "surface": model.surface,
            "medium": model.medium,
            "normal_force_N": model.normal_force,
            "data_file": model.data_file,
            "reused": model.reused,
            "kept": model.kept,
            "seconds": model.seconds,
            "fit": fit,
            "sensitivity": rows.sensitivity if rows else [],
            "not_varied": rows.not_varied if rows else "",
            "validity": rows.validity if rows else "",
        }
    )
