"""Columns of the friction table: one value for each segment, with errors and remarks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.untyped import Json
from tribolab.friction.mean_error.estimates import Estimate, undetermined_remark, wander_remark
from tribolab.friction.mean_error.freedom import with_freedom
from tribolab.friction.run_out import turn_remark
from tribolab.friction.zero.parts import ZeroReference


def column(estimates: list[Estimate], name: str) -> np.ndarray:
    """Return one field of the estimates as an array (segment)."""
    return np.array([getattr(estimate, name) for estimate in estimates], dtype=float)


def error_columns(
    estimates: list[Estimate], whole: Callable[[np.ndarray], np.ndarray]
) -> dict[str, np.ndarray]:
    """Return standard error, degrees of freedom and U95: of the mean over the path, and beyond it.

    `whole` turns errors by scatter into full errors, which include those of the zero and the load.
    """
    errors: dict[str, np.ndarray] = {}
    for end, name in (("", "friction_coefficient"), ("_beyond", "friction_coefficient_beyond")):
        wide = NORMAL * whole(column(estimates, f"u95{end}") / NORMAL)
        sem, dof = with_freedom(whole(column(estimates, f"sem{end}")), wide)
        errors |= {f"{name}_sem": sem, f"{name}_dof": dof, f"{name}_U95": wide}
    return errors


def remark_on(estimate: Estimate) -> str:
    """Return the reason why an error is large, as text; else ""."""
    wide = undetermined_remark(estimate) or wander_remark(estimate)
    return "; ".join(filter(None, (turn_remark(estimate.turns), wide)))


def correlation_columns(estimates: list[Estimate]) -> dict[str, np.ndarray]:
    """Return effective samples, autocorrelation time and p value of the trend (segment)."""
    names = ("effective_samples", "autocorrelation_time", "trend_p_value")
    return {name: column(estimates, name) for name in names}


def segment_table(
    data: dict[str, np.ndarray],
    remarks: np.ndarray,
    zero: ZeroReference,
    run: xr.Dataset,
    middle: str,
) -> xr.Dataset:
    """Return the friction of the segments as a dataset, with the source and doubts of the zero."""
    columns = data | {"zero_from": zero.zero_from, "remark": remarks}
    table = xr.Dataset({name: ("segment", values) for name, values in columns.items()})
    attrs: Json = {"offset": zero.method, "zero_doubts": list(zero.doubts)}
    if middle:
        attrs["middle_of_loop"] = middle
    if np.isfinite(zero.stated):
        attrs["zero_stated"] = zero.stated
    if "uncertainty" in run.attrs:
        attrs["uncertainty"] = run.attrs["uncertainty"]
    return table.assign_attrs(attrs)
