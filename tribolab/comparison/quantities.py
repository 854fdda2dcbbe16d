"""Differences of mean friction, shear stress and roughness, for a forest plot."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from tribolab.comparison.run_values import MatchedRuns, condition_text
from tribolab.core.coverage import NORMAL
from tribolab.metrology.differences import differences_of_groups, interval

_ROUGHNESS = {"rms_roughness": "_m", "rms_slope": ""}


def quantity_rows(
    conditions: Sequence[MatchedRuns],
    same: Sequence[bool],
    terms: Sequence[np.ndarray],
    first: Mapping[str, pd.DataFrame],
    second: Mapping[str, pd.DataFrame],
    by: str = "",
) -> pd.DataFrame:
    """Return mean friction, shear stress and roughness of both sides, with their differences.

    Parameters
    ----------
    conditions
        The runs at common speeds.
    same
        Whether the raw data of each condition are the same; its difference then has no error.
    terms
        Errors of each condition's differences that scatter does not include (term, point).
    first, second
        Tables of shear stresses and roughness, if any.
    by
        Column in which the two sides are meant to differ.

    Returns
    -------
    pandas.DataFrame
        A row for each quantity in SI: ``quantity``, ``of``, ``first``, ``second``, ``difference``,
        ``standard_error``, ``low`` and ``high`` at 95 %, ``low_90`` and ``high_90``; ``basis``
        states the components of the error.
    """
    rows = [_mean_friction(*each) for each in zip(conditions, same, terms, strict=True)]
    for name, make in (("shear_stress", _shear_stress), ("roughness", _roughness)):
        if name in first and name in second:
            rows += make(first[name], second[name], by)
    return pd.DataFrame(rows, columns=_COLUMNS)


_COLUMNS = [
    "quantity",
    "of",
    "first",
    "second",
    "difference",
    "standard_error",
    "low",
    "high",
    "low_90",
    "high_90",
    "basis",
]


def _row(
    quantity: str, of: str, values: tuple[float, float], error: float, freedom: float, basis: str
) -> list[object]:
    difference = np.array([values[1] - values[0]])
    ends = [
        float(end[0])
        for level in (0.95, 0.90)
        for end in interval(difference, np.array([error]), np.array([freedom]), level)
    ]
    return [quantity, of, *values, float(difference[0]), error, *ends, basis]


def _mean_friction(condition: MatchedRuns, same: bool, terms: np.ndarray) -> list[object]:
    """Return the mean friction at the speeds common to all runs; without any, at each run's own."""
    means = [np.nanmean(values, axis=1)[:, None] for values in (condition.first, condition.second)]
    everywhere = terms.mean(axis=1, keepdims=True)
    compared = differences_of_groups([(means[0], means[1])], not_in_scatter=[everywhere])
    values = float(compared.first[0]), float(compared.second[0])
    name = "friction_coefficient"
    if same:
        return _row(name, condition.condition, values, 0.0, 1.0, "same raw data")
    error, freedom = float(compared.standard_error[0]), float(compared.degrees_of_freedom[0])
    basis = "scatter of the runs" + (" and calibration" if everywhere.any() else "")
    return _row(name, condition.condition, values, error, freedom, basis)


def _matched_rows(
    first: pd.DataFrame, second: pd.DataFrame, keys: Sequence[str]
) -> list[tuple[pd.Series, pd.Series]]:
    """Return pairs of rows of two tables with the same keys; each row of the first once at most."""
    result = []
    for _, row in first.iterrows():
        for _, other in second.iterrows():
            if all(row[key] == other[key] or row[key] is other[key] for key in keys):
                result.append((row, other))
                break
    return result


def _shear_stress(first: pd.DataFrame, second: pd.DataFrame, by: str) -> list[list[object]]:
    rows = []
    load = "normal_force_N"
    keys = [key for key in ("surface", "medium", load) if key != by and key in first]
    for former, latter in _matched_rows(first, second, keys):
        errors = [float(row["shear_stress_error_Pa"]) for row in (former, latter)]
        where = {key: former[key] for key in keys}
        text = condition_text(
            where.get("surface"), where.get("medium"), float(where.get(load, np.nan))
        )
        values = float(former["shear_stress_Pa"]), float(latter["shear_stress_Pa"])
        error = math.hypot(*errors)
        rows.append(
            _row("shear_stress_Pa", text, values, error, np.inf, "statistical error of both fits")
        )
    return rows


def _roughness(first: pd.DataFrame, second: pd.DataFrame, by: str) -> list[list[object]]:
    rows = []
    keys = [key for key in ("surface",) if key != by]
    for former, latter in _matched_rows(first, second, keys):
        text = str(former["surface"]) if keys else f"{former['surface']} and {latter['surface']}"
        for name, unit in _ROUGHNESS.items():
            spread = [
                (float(row[f"{name}_high{unit}"]) - float(row[f"{name}_low{unit}"])) / (2 * NORMAL)
                for row in (former, latter)
            ]
            values = float(former[f"{name}{unit}"]), float(latter[f"{name}{unit}"])
            error = 0.0 if values[0] == values[1] else math.hypot(*spread)
            rows.append(_row(f"{name}{unit}", text, values, error, np.inf, "95 % bounds of both"))
    return rows
