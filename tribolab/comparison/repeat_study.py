"""Repeatability of a friction coefficient, within and between mounts, days and operators."""

from __future__ import annotations

import html
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from tribolab.comparison.labels import labelled_segments
from tribolab.comparison.run_values import (
    CONDITION,
    SPEED_COLUMN,
    VALUE,
    condition_text,
    segments_of,
    speed_levels,
)
from tribolab.core.errors import AnalysisError, shown
from tribolab.core.wording import many, speed_text
from tribolab.metrology.gauge_study import gauge_study
from tribolab.metrology.precision import LIMIT, mandel, mandel_limits, reproducibility_deviation
from tribolab.metrology.reml import variance_components
from tribolab.report.results_folder import Results

_POOLED = "all speeds"
FEW = 5  # number of levels of a factor below which its variance is very uncertain


@dataclass(frozen=True)
class Repeatability:
    """Variance components of a friction coefficient: within and between mounts, days, operators.

    Parameters
    ----------
    by
        The factors.
    table
        A row for each speed and one for all of them: mean, standard deviations within
        (``repeatability_std``) and between the levels of each factor (``between_..._std``), their
        total (``reproducibility_std``), the limits r and R of the difference of two single runs
        with 95 % coverage, and ``runs``. The row of all speeds is relative to the mean.
    mandel
        A row for each level of the first factor and condition with two runs or more at each: h and
        k with their limits at 1 %.
    method
        Method of estimation, in words.
    levels
        Number of levels of each factor.
    """

    by: tuple[str, ...]
    table: pd.DataFrame
    mandel: pd.DataFrame
    method: str
    levels: dict[str, int]

    def _repr_html_(self) -> str:
        """Return HTML of the method and of the table of components."""
        shown = self.table.to_html(index=False, float_format="{:.3g}".format)
        by = html.escape(", ".join(self.by))
        return f"<p><b>Repeatability by {by}</b>, {self.method}</p>{shown}"


def repeatability(
    table: pd.DataFrame | Results | str | Path, by: str | Sequence[str], *, value: str = VALUE
) -> Repeatability:
    """Return the variance between equal runs, and that between mounts, days and operators.

    Parameters
    ----------
    table
        Table of friction with a column for each factor, or a campaign file or results folder, whose
        `[[run]]` entries state operator, mount, day, specimen or other labels.
    by
        The factors, as a list or separated by commas. A nested factor (mounts within a day) is
        named with its parent: ``"day,day:mount"``.
    value
        Column to analyse.

    Returns
    -------
    Repeatability
        The components of variance.

    Raises
    ------
    AnalysisError
        If a factor is unknown, has one level only, or is confounded with another or with the runs.

    Notes
    -----
    One run is one observation, the mean of its strokes at a speed; each condition (surface, medium,
    load) has its own mean, to which the scatter of its runs is relative. For one factor crossed
    with the conditions and equal numbers of runs, the method is analysis of variance, with the
    interaction pooled if its p is above 0.25; otherwise it is restricted maximum likelihood
    (`variance_components`). ISO 5725-2: s_R^2 = s_r^2 + s_L^2, r = 2.8 s_r, R = 2.8 s_R. For all
    speeds together, variances relative to the squared mean are averaged, weighted by degrees of
    freedom.

    Examples
    --------
    >>> import pandas as pd
    >>> table = pd.DataFrame({
    ...     "run": list("abcdef"), "mount": [1, 1, 2, 2, 3, 3], "sliding_speed_m_s": 1e-3,
    ...     "friction_coefficient": [1.0, 1.2, 2.0, 2.2, 3.0, 3.2],
    ... })
    >>> row = repeatability(table, "mount").table.iloc[0]
    >>> f"{row.repeatability_std:.3f} {row.between_mount_std:.3f}"
    '0.141 0.995'
    """
    if isinstance(table, Results):
        table = labelled_segments(table.folder)
    elif not isinstance(table, pd.DataFrame):
        table = labelled_segments(table)
    names = tuple(part.strip() for part in by.split(",")) if isinstance(by, str) else tuple(by)
    renamed = table if value == VALUE else table.assign(**{VALUE: table[value]})
    segments = segments_of(renamed)
    runs = _per_run(segments, names)
    rows, methods = [], []
    for speed in np.unique(runs["level"]).tolist():
        row, method = _components_at(runs[runs["level"] == speed], names)
        rows.append({SPEED_COLUMN: speed, "speed": speed_text(speed), **row})
        methods.append(method)
    rows.append(_pool_speeds(rows, names))
    return Repeatability(
        names,
        pd.DataFrame(rows),
        _mandel(runs, names[0]),
        "; ".join(dict.fromkeys(methods)),
        {name: int(runs[name].nunique()) for name in names},
    )


def _per_run(segments: pd.DataFrame, names: Sequence[str]) -> pd.DataFrame:
    """Return the mean of each run at each speed, with its condition and its factor levels."""
    known = segments.copy()
    wanted = dict.fromkeys(part for name in names for part in name.split(":"))
    for part in wanted:
        if part not in known:
            there = [c for c in known if c in ("operator", "mount", "day", "specimen")]
            raise AnalysisError(
                f"nothing says which {shown(part)} a run belongs to; write it in [[run]] of the "
                f"campaign file{'; there is ' + ', '.join(there) if there else ''}"
            )
        if known[part].isna().any():
            run = known.loc[known[part].isna(), "run"].iloc[0]
            raise AnalysisError(f"run {shown(run)}: nothing says which {shown(part)} it belongs to")
    for name in names:
        parts = [known[part].astype(str).tolist() for part in name.split(":")]
        known[name] = [" / ".join(levels) for levels in zip(*parts, strict=True)]
    known["condition"] = [
        condition_text(*row) for row in known[CONDITION].itertuples(index=False, name=None)
    ]
    known["level"] = speed_levels(known[SPEED_COLUMN].to_numpy(dtype=float))
    groups = known.groupby(["run", "level", "condition", *names], sort=False)[VALUE]
    return groups.mean().reset_index()


def _components_at(runs: pd.DataFrame, names: Sequence[str]) -> tuple[dict[str, float], str]:
    """Return the variance components at one speed, and the method of their estimation."""
    for name in names:
        levels = runs[name].nunique()
        if levels < 2:
            raise AnalysisError(
                f"all runs at {speed_text(float(runs['level'].iloc[0]))} have the same "
                f"{shown(name)}: there is nothing to compare"
            )
        if levels == len(runs):
            raise AnalysisError(
                f"every run has a level of {shown(name)} of its own, which cannot be separated "
                "from repeatability; measure twice without changing it, or leave it out"
            )
    for first, other in itertools.combinations(names, 2):
        if _is_alias(runs, first, other):
            raise AnalysisError(
                f"{shown(first)} and {shown(other)} change together and cannot be separated; "
                "leave one out"
            )
    runs = runs.assign(**{VALUE: _scale_conditions(runs)})
    cube = _balanced_cube(runs, names)
    if cube is not None:
        study = gauge_study(cube)
        within = study.repeatability
        between = {names[0]: study.appraisers, f"{names[0]} x condition": study.interaction}
        if study.pooled:
            between.pop(f"{names[0]} x condition")
        with_it = "" if not study.pooled else ", the interaction with conditions pooled"
        method = f"analysis of variance{with_it}"
    else:
        fitted = variance_components(
            runs[VALUE].to_numpy(dtype=float),
            [runs[name].to_numpy() for name in names],
            runs["condition"].to_numpy(),
        )
        within, between = fitted.residual, dict(zip(names, fitted.factors, strict=True))
        method = "restricted maximum likelihood"
    freedom = len(runs) - runs["condition"].nunique() - sum(runs[n].nunique() - 1 for n in names)
    return _row(runs, float(within), between, max(1, freedom)), method


def _scale_conditions(runs: pd.DataFrame) -> pd.Series:
    """Return values scaled to equal means of all conditions, which keeps their relative scatter."""
    means = runs.groupby("condition")[VALUE].transform("mean")
    return runs[VALUE] / means.where(means != 0, 1.0) * runs[VALUE].mean()


def _is_alias(runs: pd.DataFrame, first: str, other: str) -> bool:
    pairs = runs[[first, other]].drop_duplicates()
    return len(pairs) == runs[first].nunique() == runs[other].nunique()


def _row(
    runs: pd.DataFrame, within: float, between: dict[str, float], freedom: int
) -> dict[str, float]:
    repeat = float(np.sqrt(within))
    spread = {name: float(np.sqrt(part)) for name, part in between.items()}
    total = reproducibility_deviation(repeat, list(spread.values()))
    return {
        "mean": float(runs[VALUE].mean()),
        "repeatability_std": repeat,
        **{f"between_{name}_std": value for name, value in spread.items()},
        "reproducibility_std": total,
        "repeatability_limit": LIMIT * repeat,
        "reproducibility_limit": LIMIT * total,
        "runs": len(runs),
        "degrees_of_freedom": freedom,
    }


def _balanced_cube(runs: pd.DataFrame, names: Sequence[str]) -> np.ndarray | None:
    """Return values (condition, level, run) of a balanced crossed factor; None if not balanced."""
    if len(names) != 1 or runs["condition"].nunique() < 2:
        return None
    groups = runs.groupby(["condition", names[0]])[VALUE]
    counts = groups.size().unstack()
    if counts.isna().any(axis=None) or counts.to_numpy().min() != counts.to_numpy().max():
        return None
    if int(counts.to_numpy()[0, 0]) < 2:
        return None
    return np.array([[groups.get_group((c, f)) for f in counts.columns] for c in counts.index])


def _pool_speeds(rows: Sequence[dict[str, object]], names: Sequence[str]) -> dict[str, object]:
    """Return the components pooled over all speeds, weighted by degrees of freedom."""
    table = pd.DataFrame(rows)
    weight = table["degrees_of_freedom"].to_numpy(dtype=float)
    columns = [c for c in map(str, table) if c.endswith(("_std", "_limit"))]
    relative = table[columns].fillna(0.0).div(table["mean"].abs(), axis=0) ** 2
    pooled = np.sqrt(relative.mul(weight, axis=0).sum() / weight.sum())
    return {
        SPEED_COLUMN: np.nan,
        "speed": _POOLED,
        "mean": 1.0,
        **{name: float(pooled[name]) for name in columns},
        "runs": int(table["runs"].sum()),
        "degrees_of_freedom": int(weight.sum()),
    }


def _mandel(runs: pd.DataFrame, name: str) -> pd.DataFrame:
    """Return Mandel's h and k of each level of a factor, in conditions with repeats."""
    rows = []
    conditions = runs[["condition", "level"]].drop_duplicates().sort_values(["condition", "level"])
    for condition, speed in conditions.itertuples(index=False, name=None):
        mine = runs[(runs["condition"] == condition) & (runs["level"] == speed)]
        groups = mine.groupby(name)[VALUE]
        count = groups.size()
        if len(count) < 3 or count.min() < 2:
            continue
        h, k = mandel(groups.mean().to_numpy(), groups.std().to_numpy())
        limits = mandel_limits(len(count), int(count.min()))
        for level, one_h, one_k in zip(count.index, h, k, strict=True):
            rows.append((condition, speed, str(level), one_h, one_k, *limits))
    heads = ["condition", SPEED_COLUMN, name, "h", "k", "h_limit", "k_limit"]
    return pd.DataFrame(rows, columns=heads)


def repeatability_verdict(study: Repeatability) -> str:
    """Return the result of a repeatability study as one sentence."""
    last = study.table.iloc[-1]
    parts = [f"within {100 * last.repeatability_std:.2g} %"]
    for name in study.by:
        parts.append(f"between levels of {name} {100 * last[f'between_{name}_std']:.2g} %")
    odd = 0 if study.mandel.empty else int(_is_odd(study.mandel).sum())
    marked = f"; {many(odd, 'result')} beyond Mandel's limits" if odd else ""
    return f"standard deviations relative to the mean: {', '.join(parts)}{marked}"


def _is_odd(table: pd.DataFrame) -> pd.Series:
    return (table["h"].abs() > table["h_limit"]) | (table["k"] > table["k_limit"])
