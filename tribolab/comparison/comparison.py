"""Comparison of two campaigns, surfaces or media, with tests of significance."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from tribolab.comparison.calibration_terms import CalibrationTerms, calibration_terms, terms_text
from tribolab.comparison.changes import Change, changes_between
from tribolab.comparison.quantities import quantity_rows
from tribolab.comparison.run_values import (
    CONDITION,
    SPEED_COLUMN,
    MatchedRuns,
    match_runs,
)
from tribolab.comparison.sides import Compared, Side, sides_of
from tribolab.core.errors import AnalysisError
from tribolab.core.wording import many
from tribolab.metrology.differences import (
    BONFERRONI,
    PERMUTATION,
    ROTATION,
    Differences,
    differences_of_groups,
    interval,
    verdicts,
)
from tribolab.units.conversion import to_si

UNCHANGED, CHANGED = "unchanged", "changed by the analysis"
_LEVEL, _EQUIVALENCE_LEVEL = 0.95, 0.90
_EXACT = 1e-12  # relative; repeated analyses of the same raw data agree to rounding


@dataclass(frozen=True)
class Comparison:
    """Differences between two groups of runs, with their significance.

    Parameters
    ----------
    names
        Names of the first and the second group.
    points
        A row for each condition and speed: means, their difference (second minus first), its
        standard error and degrees of freedom, the simultaneous interval, ``p_value`` of the point
        alone, ``adjusted_p_value`` for all points, and the ``verdict``.
    quantities
        A row for each number of a condition or surface: mean friction over the common speeds,
        shear stress, roughness; difference with 95 % and 90 % intervals of each alone.
    changes
        What changed in settings, decisions, code and data.
    method
        Method that controls the error rate of all points, in words.
    calibration
        Errors included in addition to the scatter of the runs, in words.
    margin
        Largest irrelevant difference as stated; "" if none was.
    counts
        Number of points with each verdict.
    two_folders
        Whether both sides are folders, so that changes can be listed.
    """

    names: tuple[str, str]
    points: pd.DataFrame
    quantities: pd.DataFrame
    changes: tuple[Change, ...] = ()
    method: str = ""
    calibration: str = ""
    margin: str = ""
    counts: dict[str, int] = field(default_factory=dict)
    two_folders: bool = False

    def _repr_html_(self) -> str:
        """Return HTML of the verdicts and of the differences of each condition.

        Examples
        --------
        >>> rows = pd.DataFrame({"quantity": ["mean friction"], "difference": [0.0123]})
        >>> shown = Comparison(("old", "new"), rows, rows, counts={"equal": 7})._repr_html_()
        >>> "<b>new minus old</b>: 7 equal" in shown, "0.0123" in shown
        (True, True)
        """
        first, second = map(html.escape, self.names)
        counts = html.escape(", ".join(f"{n} {verdict}" for verdict, n in self.counts.items()))
        shown = self.quantities.to_html(index=False, float_format="{:.3g}".format)
        return f"<p><b>{second} minus {first}</b>: {counts}</p>{shown}"


def compare(
    first: Compared,
    second: Compared | None = None,
    *,
    by: str = "",
    levels: Sequence[str] = (),
    margin: str = "",
    pairs: int = 1,
) -> Comparison:
    """Return the differences between two campaigns, or two surfaces or media within one.

    Each run is one observation at a speed: the mean of its strokes.

    Parameters
    ----------
    first, second
        Results folders, results from `read_results`, or tables of friction with the columns
        ``run``, ``sliding_speed_m_s``, ``friction_coefficient`` and, if known, ``surface``,
        ``medium``, ``nominal_normal_force_N``. Without a second, two levels of the first are
        compared.
    by
        Column of these levels, e.g. ``"surface"``; with a second it does not define conditions,
        e.g. to compare two surfaces that were measured in two campaigns.
    levels
        The two levels, the reference first; by default the first two.
    margin
        Largest irrelevant difference of the coefficient, absolute (``"0.01"``) or relative to the
        first (``"5 %"``); without a margin no point is called equivalent.
    pairs
        Number of comparisons made together, which share one error rate.

    Returns
    -------
    Comparison
        The differences and their significance.

    Raises
    ------
    AnalysisError
        If the two have no condition and speed in common.
    UnitError
        If the margin is neither a number nor a percentage.

    Notes
    -----
    Runs from the same raw files are not independent observations. If all runs of a condition are
    from the same files, its verdict states whether the analysis changed the numbers, without a
    test. `differences_of_groups` documents the statistics. The errors include stated calibration
    uncertainties; those shared by both sides, e.g. the gain of one instrument, count only as far as
    their effects differ (`calibration_terms`).

    Examples
    --------
    >>> import numpy as np, pandas as pd
    >>> rng = np.random.default_rng(3)
    >>> table = pd.DataFrame({
    ...     "run": np.repeat([f"run {k}" for k in range(8)], 2),
    ...     "surface": np.repeat(["smooth", "rough"], 8),
    ...     "sliding_speed_m_s": np.tile([1e-4, 1e-3], 8),
    ...     "friction_coefficient": np.tile([0.5, 0.3], 8) + rng.normal(0, 0.01, 16),
    ... })
    >>> table.loc[table.surface == "rough", "friction_coefficient"] += [0.0, 0.2] * 4
    >>> compare(table, by="surface").points.verdict.tolist()
    ['undecided', 'different']
    """
    sides = sides_of(first, second, by, levels)
    kept = [name for name in CONDITION if name != by]
    conditions = match_runs(sides[0].segments, sides[1].segments, kept)
    if not conditions:
        raise AnalysisError(
            "there is nothing to compare: no surface, medium and load was measured in both at one "
            "speed"
        )
    same = [_all_same(condition, *sides) for condition in conditions]
    alpha = (1 - _LEVEL) / max(1, pairs)
    tested = [condition for condition, is_same in zip(conditions, same, strict=True) if not is_same]
    terms = [calibration_terms(c, sides[0].folder, sides[1].folder) for c in conditions]
    own = [part for part, is_same in zip(terms, same, strict=True) if not is_same]
    by_chance = _test_conditions(tested, own, margin, alpha) if tested else None
    points = [_points_of_same(c) for c, is_same in zip(conditions, same, strict=True) if is_same]
    if by_chance is not None:
        points.append(by_chance[1])
    rows = pd.concat(points, ignore_index=True)
    folders = [side.folder for side in sides]
    two_folders = second is not None and None not in folders
    return Comparison(
        names=(sides[0].name, sides[1].name),
        points=rows,
        quantities=quantity_rows(
            conditions, same, [part.terms for part in terms], sides[0].tables, sides[1].tables, by
        ),
        changes=()
        if second is None or folders[0] is None or folders[1] is None
        else tuple(changes_between(folders[0], folders[1])),
        method=_method(None if by_chance is None else by_chance[0], len(tested), pairs),
        calibration=terms_text(own) if tested else "",
        margin=margin,
        counts={word: int((rows["verdict"] == word).sum()) for word in dict.fromkeys(rows.verdict)},
        two_folders=two_folders,
    )


def _all_same(condition: MatchedRuns, first: Side, second: Side) -> bool:
    """Return whether both sides of a condition were computed from the same raw files."""
    if first.folder is None or second.folder is None or first.folder is second.folder:
        return False
    sums = [side.folder.checksums() if side.folder else {} for side in (first, second)]
    files = [
        sorted(sums[place].get(run, ()) for run in runs)
        for place, runs in enumerate((condition.first_runs, condition.second_runs))
    ]
    return bool(files[0]) and files[0] == files[1] and all(any(sums) for sums in files[0])


def _points_of_same(condition: MatchedRuns) -> pd.DataFrame:
    """Return the points of a condition with the same raw data on both sides, without a test."""
    first, second = (np.nanmean(values, axis=0) for values in (condition.first, condition.second))
    return _rows(
        condition,
        first,
        second,
        verdict=[
            UNCHANGED if abs(b - a) <= _EXACT * abs(a) else CHANGED
            for a, b in zip(first, second, strict=True)
        ],
    )


def _test_conditions(
    conditions: Sequence[MatchedRuns], terms: Sequence[CalibrationTerms], margin: str, alpha: float
) -> tuple[Differences, pd.DataFrame]:
    compared = differences_of_groups(
        [(c.first, c.second) for c in conditions],
        not_in_scatter=[part.terms for part in terms],
        alpha=alpha,
    )
    limits = margin_of(margin, compared.first)
    words = verdicts(compared, limits, alpha)
    rows, start = [], 0
    for condition in conditions:
        part = slice(start, start + condition.speeds.size)
        start = part.stop
        low, high = interval(
            compared.difference[part],
            compared.standard_error[part],
            compared.degrees_of_freedom[part],
            _EQUIVALENCE_LEVEL,
        )
        rows.append(
            _rows(
                condition,
                compared.first[part],
                compared.second[part],
                standard_error=compared.standard_error[part],
                degrees_of_freedom=compared.degrees_of_freedom[part],
                low=compared.low[part],
                high=compared.high[part],
                low_90=low,
                high_90=high,
                p_value=compared.p_value[part],
                adjusted_p_value=compared.adjusted_p_value[part],
                verdict=words[part],
            )
        )
    return compared, pd.concat(rows, ignore_index=True)


_NUMBERS = (
    "standard_error",
    "degrees_of_freedom",
    "low",
    "high",
    "low_90",
    "high_90",
    "p_value",
    "adjusted_p_value",
)


def _rows(
    condition: MatchedRuns,
    first: np.ndarray,
    second: np.ndarray,
    *,
    verdict: Sequence[str],
    **numbers: np.ndarray,
) -> pd.DataFrame:
    empty = np.full(condition.speeds.size, np.nan)
    return pd.DataFrame(
        {
            "condition": condition.condition,
            SPEED_COLUMN: condition.speeds,
            "first": first,
            "second": second,
            "difference": second - first,
            "relative_difference": (second - first) / np.where(first == 0, np.nan, first),
            **{name: numbers.get(name, empty) for name in _NUMBERS},
            "first_runs": np.isfinite(condition.first).sum(axis=0),
            "second_runs": np.isfinite(condition.second).sum(axis=0),
            "verdict": list(verdict),
        }
    )


def margin_of(margin: str, values: np.ndarray) -> np.ndarray | None:
    """Return the equivalence margin as an absolute value, from an absolute or relative one.

    Raises
    ------
    UnitError
        If the margin is neither a number nor a percentage.
    """
    if not margin:
        return None
    size = to_si(margin if any(c.isalpha() or c == "%" for c in margin) else float(margin), "1")
    return np.abs(values) * size if "%" in margin else np.full(values.shape, size)


_HOW = {
    PERMUTATION: (
        "whole runs are permuted between the groups; the threshold is the largest difference "
        "divided by its error that occurs by chance at the points of a condition"
    ),
    ROTATION: (
        "the residuals of the runs are rotated at random, which gives the threshold for all "
        "points of a condition, if runs are normally distributed"
    ),
    BONFERRONI: "Bonferroni's rule, for few runs with missing speeds",
}


def _method(compared: Differences | None, conditions: int, pairs: int) -> str:
    if compared is None:
        return "the raw data are the same, so every difference comes from the analysis"
    points = int(np.isfinite(compared.p_value).sum())
    how = "; ".join(_HOW[name] for name in dict.fromkeys(compared.methods))
    others = f" and {pairs} comparisons" if pairs > 1 else ""
    return (
        f"Welch's t of the runs' means at {many(points, 'point')} of "
        f"{many(conditions, 'condition')}; 5 % for all of them{others} together: {how}"
    )
