"""Comparison of roughness and contact area with those of the simulated surfaces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.contact.persson import contact_area_ratio
from tribolab.records.part_records import SurfaceRecord
from tribolab.records.parts import Row, number_of
from tribolab.rig import read_truth
from tribolab.surface.self_affine import SelfAffine, rms_roughness, rms_slope, tabulate

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_COLUMNS = [
    "surface",
    "quantity",
    "normal_force_N",
    "found",
    "found_low",
    "found_high",
    "true",
    "relative_difference",
    "within_bounds",
]


def compare_surfaces(outcome: Outcome, folder: str | Path) -> pd.DataFrame:
    """Compare roughness, slope and contact area of a simulated campaign with the truth.

    Parameters
    ----------
    outcome
        Results with data files in ``outcome.folder``.
    folder
        The simulated campaign's folder.

    Returns
    -------
    pandas.DataFrame
        A row per surface and quantity: rms_roughness_m and rms_slope of the whole spectrum,
        contact_area_ratio without adhesion at each load; `found` with its bounds, `true`, the
        relative difference, and 1 if the truth is within the bounds.
    """
    facts = read_truth(folder).facts
    rows: list[Row] = []

    def add(surface: str, quantity: str, force: float | None, row: Row, true: float) -> None:
        value, low, high = (_known(row, name) for name in _with_bounds(quantity))
        rows.append(
            {
                "surface": surface,
                "quantity": quantity,
                "normal_force_N": force,
                "found": value,
                "found_low": low,
                "found_high": high,
                "true": true,
                "relative_difference": value / true - 1,
                "within_bounds": int(low <= true <= high),
            }
        )

    for surface in outcome.surfaces:
        entry = outcome.store.get("surface", surface.name, SurfaceRecord)
        mine = entry.record.rows if entry else None
        if mine is None or surface.name not in facts["surfaces"]:
            continue
        spectrum = SelfAffine(**facts["surfaces"][surface.name]["spectrum"])
        add(surface.name, "rms_roughness_m", None, mine.roughness, rms_roughness(spectrum))
        add(surface.name, "rms_slope", None, mine.roughness, rms_slope(spectrum))
        system = facts["system"]
        modulus = system["youngs_modulus"] / (1 - system["poisson_ratio"] ** 2)
        for row in mine.contact:
            true = contact_area_ratio(_known(row, "pressure_Pa"), tabulate(spectrum), modulus)
            force = number_of(row, "normal_force_N")
            add(surface.name, "contact_area_ratio", force, row, float(true))
    return pd.DataFrame(rows, columns=_COLUMNS)


def _with_bounds(column: str) -> list[str]:
    """Return the column names of a value and its two bounds, each name ending in the unit."""
    name, unit = (column.removesuffix("_m"), "_m") if column.endswith("_m") else (column, "")
    return [f"{name}{end}{unit}" for end in ("", "_low", "_high")]


def _known(row: Row, column: str) -> float:
    """Return a number of a row; NaN if unknown."""
    value = number_of(row, column)
    return float("nan") if value is None else value
