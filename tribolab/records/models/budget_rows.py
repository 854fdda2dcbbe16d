"""Rows of the table of uncertainty budgets, for each point and each part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from tribolab.metrology.budget_parts import part_words
from tribolab.reading.dialect.uncertainty import Known
from tribolab.records.parts import Row
from tribolab.records.wording import plain_value

if TYPE_CHECKING:
    import xarray as xr


def budget_rows(curve: xr.Dataset, known: Mapping[str, Known]) -> Iterator[Row]:
    """Yield the parts of the uncertainty of each point of a curve, largest first.

    Parameters
    ----------
    curve
        With ``uncertainty_part`` (part, sliding_speed).
    known
        Stated uncertainties by the names of the parts.
    """
    parts, dof = curve["uncertainty_part"].values, curve["uncertainty_part_dof"].values
    inputs = curve["part"].values.astype(str).tolist()
    names = [part_words(name) for name in inputs]
    varies = [known[name].varies if name in known else "" for name in inputs]
    variance = np.sum(parts**2, axis=0)
    for j, speed in enumerate(curve["sliding_speed"].values.tolist()):
        for i in np.argsort(-np.abs(parts[:, j]), kind="stable"):
            share = parts[i, j] ** 2 / variance[j] if variance[j] > 0 else np.nan
            yield {
                "sliding_speed_m_s": speed,
                "part": names[i],
                "varies": varies[i],
                "contribution": plain_value(float(parts[i, j])),
                "share": plain_value(float(share)),
                "dof": plain_value(float(dof[i, j])),
            }
