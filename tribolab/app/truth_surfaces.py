"""Roughness and contact as found from simulated scans, against the surfaces they were made of."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from tribolab.records.part_records import SurfaceRecord
from tribolab.report import tables

if TYPE_CHECKING:
    from tribolab.campaign.outcome import Outcome

COLUMNS = [
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
        Results whose data files lie in ``outcome.folder``.
    folder
        The simulated campaign's folder.

    Returns
    -------
    pandas.DataFrame
        A row per surface and quantity: rms_roughness_m and rms_slope of the whole spectrum,
        contact_area_ratio without adhesion at each load; `found` with its bounds, `true`, the
        relative difference, and 1 where the truth lies within the bounds.
    """
    from tribolab.contact.persson import contact_area_ratio
    from tribolab.rig import read_truth
    from tribolab.surface.self_affine import SelfAffine, rms_roughness, rms_slope, tabulate

    facts = read_truth(folder).facts
    rows: list[dict[str, Any]] = []

    def add(surface: str, quantity: str, force: float | None, found: list, true: float) -> None:
        value, low, high = found
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
        rough, ends = mine.roughness, ("", "_low", "_high")
        height = [rough[f"rms_roughness{end}_m"] for end in ends]
        add(surface.name, "rms_roughness_m", None, height, rms_roughness(spectrum))
        slope = [rough[f"rms_slope{end}"] for end in ends]
        add(surface.name, "rms_slope", None, slope, rms_slope(spectrum))
        system = facts["system"]
        modulus = system["youngs_modulus"] / (1 - system["poisson_ratio"] ** 2)
        for row in mine.contact:
            true = contact_area_ratio(row["pressure_Pa"], tabulate(spectrum), modulus)
            area = [row[f"contact_area_ratio{end}"] for end in ends]
            add(surface.name, "contact_area_ratio", row["normal_force_N"], area, float(true))
    return pd.DataFrame(rows, columns=COLUMNS)


def write_truth_surfaces(outcome: Outcome, folder: str | Path) -> pd.DataFrame:
    """Compare as `compare_surfaces`, and write ``tables/truth_surfaces.csv``."""
    table = compare_surfaces(outcome, folder)
    place = outcome.folder / "tables" / "truth_surfaces.csv"
    tables.write_csv(table, place, digits=9)
    return table
