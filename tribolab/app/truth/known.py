"""Comparison of all results of a simulated campaign with its true values, and truth.csv."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.app.truth.friction import TruthComparison, compare_with_truth
from tribolab.app.truth.shear_stress import compare_shear_stress
from tribolab.app.truth.surfaces import compare_surfaces
from tribolab.report import tables

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

TRUTH = "truth.csv"  # next to truth/


@dataclass(frozen=True)
class DemoComparison:
    """Segments, roughness and shear stresses of a simulated campaign next to the true values.

    Parameters
    ----------
    folder
        The campaign's folder.
    runs
        Segments next to the true ones.
    surfaces
        Roughness and contact next to the true ones.
    shear_stress
        Fitted shear stresses next to the true ones.
    """

    folder: Path
    runs: TruthComparison
    surfaces: pd.DataFrame
    shear_stress: pd.DataFrame


def compare_with_known(outcome: Outcome, folder: Path) -> DemoComparison:
    """Compare segments, roughness and shear stresses of a simulated campaign with the truth.

    Parameters
    ----------
    outcome
        The campaign's results.
    folder
        The simulated campaign's folder.
    """
    runs = compare_with_truth(outcome, folder)
    surfaces, stresses = compare_surfaces(outcome, folder), compare_shear_stress(outcome, folder)
    return DemoComparison(folder, runs, surfaces, stresses)


def write_comparison(compared: DemoComparison) -> None:
    """Write ``truth.csv`` next to ``truth/``: a row per segment, roughness and shear stress."""
    segments = pd.DataFrame(
        {
            "part": compared.runs.table["run"],
            "quantity": "friction_coefficient",
            "speed_m_s": compared.runs.table["true_sliding_speed_m_s"],
            "start_s": compared.runs.table["true_start_s"],
            "true": compared.runs.table["true_friction_coefficient"],
            "found": compared.runs.table["friction_coefficient"],
            "found_sem": compared.runs.table["friction_coefficient_sem"],
            "says": compared.runs.table["status"],
        }
    )
    surfaces = compared.surfaces.rename(columns={"surface": "part", "within_bounds": "says"})
    stresses = compared.shear_stress.rename(columns=lambda name: name.removesuffix("_Pa")).rename(
        columns={"curve": "part", "within_interval": "says"}
    )
    stresses = stresses.drop(columns=["surface", "medium"]).assign(quantity="shear_stress_Pa")
    bounded = pd.concat([surfaces, stresses]).drop(columns="relative_difference")
    bounded["says"] = bounded["says"].map({1: "within the bounds", 0: "outside of the bounds"})
    every = pd.concat([segments, bounded], ignore_index=True)
    tables.write_csv(every, compared.folder / TRUTH, digits=9)
