"""Sliding modes of several surfaces, media or loads."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.arrays.conditions import ConditionLabels, Conditions, labels_along
from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.html_list import html_list
from tribolab.regime.model import Mode
from tribolab.regime.verdict import SlidingMode, sliding_mode

_CURVES = ("friction_coefficient", "waveform", "friction_coefficient_low")


class SlidingModes(Conditions[SlidingMode]):
    """Sliding modes of several contacts: one `SlidingMode` for each condition."""

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with one row for each piece of evidence and each decisive measurement."""
        rows = [
            {**labels, "verdict": mode.verdict, "side": side, "text": text}
            for labels, mode in self
            for side, text in mode.entries
        ]
        return pd.DataFrame(rows, columns=[*self.results.dims, "verdict", "side", "text"])

    def __repr__(self) -> str:
        """Return each verdict as a sentence, with the evidence on both sides."""
        lines = []
        for labels, mode in self:
            lines.append(f"{_words(labels)}: {mode.text}")
            lines += [f"  {piece.side:8s}{piece.text}" for piece in mode.evidence]
            lines += [f"  decide  {text}" for text in mode.decide]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return HTML of each verdict, with the evidence on both sides below it."""
        return "".join(
            html_list(f"{_words(labels)}: {mode.text}", mode.entries) for labels, mode in self
        )


def sliding_modes(
    measured: xr.Dataset,
    model: xr.Dataset | None = None,
    slip: xr.Dataset | None = None,
    known: Mode | None = None,
    *,
    adhesion: xr.Dataset | None = None,
    band: xr.Dataset | None = None,
) -> SlidingModes:
    """Return the sliding modes of several contacts.

    Parameters
    ----------
    measured, model, slip, band
        As for `sliding_mode`, over further dims such as ``surface``; data without a dim apply to
        all its values.
    known
        Further properties, the same for all contacts.
    adhesion
        From `adhesion_uncertainty`, at the load: gamma_eff(1) of each contact with its bounds, and
        the contact area; they replace those of `known`.

    Returns
    -------
    SlidingModes

    Raises
    ------
    AnalysisError
        If there is only one curve.

    Examples
    --------
    >>> v = np.geomspace(1e-6, 1e-3, 4)
    >>> mu = xr.DataArray(np.ones((2, 4)), {"surface": ["a", "b"], "sliding_speed": v})
    >>> slip = xr.Dataset({"waveform": mu.copy(data=np.full((2, 4), "smooth sliding"))})
    >>> slip["drop"] = mu * np.nan
    >>> modes = sliding_modes(mu.to_dataset(name="friction_coefficient"), None, slip)
    >>> modes.sel(surface="a").verdict
    'no stick-slip'
    """
    holder = measured["friction_coefficient"]
    dims = [dim for dim in holder.dims if dim != "sliding_speed"]
    if not dims:
        raise AnalysisError(
            "measured: there is one curve, and no further dim",
            function="sliding_modes",
            cure=Cure(notebook="weigh it with sliding_mode"),
        )

    def assess(labels: ConditionLabels) -> SlidingMode | None:
        if (curve := _condition_part(measured, labels)) is None:
            return None
        return sliding_mode(
            curve,
            _condition_part(model, labels),
            _condition_part(slip, labels),
            _condition_mode(known or Mode(), adhesion, labels),
            band=_condition_part(band, labels),
            name=_words(labels),
        )

    return SlidingModes.of({dim: labels_along(holder, dim) for dim in dims}, assess)


def _condition_mode(
    known: Mode, adhesion: xr.Dataset | None, labels: Mapping[Hashable, object]
) -> Mode:
    mine = _condition_part(adhesion, labels)
    if mine is None:
        return known
    work = "macroscopic_work_of_adhesion"
    return replace(
        known,
        work_of_adhesion=float(mine[work]),
        work_of_adhesion_range=(float(mine[f"{work}_low"]), float(mine[f"{work}_high"])),
        area_ratio=float(mine["contact_area_ratio"]),
    )


def _condition_part(
    data: xr.Dataset | None, labels: Mapping[Hashable, object]
) -> xr.Dataset | None:
    """Return the part of the data for one condition; None if there is none."""
    if data is None:
        return None
    for dim, label in labels.items():
        if dim in data.dims:
            if label not in data[dim].values:
                return None
            data = data.sel({dim: label}, drop=True)
    curve = next((name for name in _CURVES if name in data), None)
    if curve is None or "sliding_speed" not in data.dims:
        return data
    data = data.isel(sliding_speed=_value_mask(data[curve]))
    return data if data.sizes["sliding_speed"] else None


def _value_mask(values: xr.DataArray) -> np.ndarray:
    """Return a mask of the entries at which a curve has a value or text."""
    return values.to_numpy() != "" if values.dtype.kind in "OU" else values.notnull().to_numpy()


def _words(labels: Mapping[Any, object]) -> str:
    return ", ".join(str(label) for label in labels.values())
