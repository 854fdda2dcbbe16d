"""Comparison of fitted shear stresses with the true ones of the virtual rig."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from tribolab.records.parts import Row
from tribolab.report import tables
from tribolab.rig import read_truth

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import Outcome

_COLUMNS = [
    *("curve", "surface", "medium", "normal_force_N"),
    *("found_Pa", "found_low_Pa", "found_high_Pa", "true_Pa"),
    *("relative_difference", "within_interval"),
]


def compare_shear_stress(outcome: Outcome, folder: str | Path) -> pd.DataFrame:
    """Compare the fitted shear stresses of a simulated campaign with the true ones.

    Parameters
    ----------
    outcome
        Results with tables in ``outcome.folder``.
    folder
        The simulated campaign's folder.

    Returns
    -------
    pandas.DataFrame
        A row per fit whose curve follows the model in the rig: found with its 95 % interval, true,
        relative difference, and 1 if the truth is within the interval.
    """
    path = Path(outcome.folder) / "tables" / "shear_stress.csv"
    if not path.is_file():
        return pd.DataFrame(columns=_COLUMNS)
    true = {
        (run["surface"], run["medium"], run["normal_force_N"]): run["law"]["shear_stress"]
        for run in read_truth(folder).facts["runs"].values()
        if "shear_stress" in run["law"]
    }
    rows: list[Row] = []
    for fit in tables.read_csv(path).to_dict("records"):
        known = true.get((fit["surface"], fit["medium"], fit["normal_force_N"]))
        if known is None:
            continue
        low, high = fit["shear_stress_low_Pa"], fit["shear_stress_high_Pa"]
        rows.append(
            {name: fit[name] for name in _COLUMNS[:4]}
            | {
                "found_Pa": fit["shear_stress_Pa"],
                "found_low_Pa": low,
                "found_high_Pa": high,
                "true_Pa": known,
                "relative_difference": fit["shear_stress_Pa"] / known - 1,
                "within_interval": int(low <= known <= high),
            }
        )
    return pd.DataFrame(rows, columns=_COLUMNS)
