"""Calibration errors of the difference between two sides of a comparison, shared or not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from tribolab.comparison.folder import Folder
from tribolab.comparison.labels import labels_of_runs
from tribolab.comparison.run_values import SPEED_COLUMN, TOLERANCE, MatchedRuns
from tribolab.metrology.budget_curve import EACH_POINT
from tribolab.metrology.budget_parts import BETWEEN, NOISE, part_words

RunNames = tuple[str, ...]

_NOT_STATED = (
    "no calibration is stated: the intervals include only the scatter of the runs, so a "
    "difference between instruments may be a calibration error"
)


@dataclass(frozen=True)
class _Part:
    """Calibration input of one side; if both sides have the same one, they share its error."""

    name: str
    whose: str


@dataclass(frozen=True)
class CalibrationTerms:
    """Calibration errors of the differences between two sides in one condition.

    Parameters
    ----------
    terms
        Signed standard uncertainties, each fully correlated between points (term, point).
    shared
        Inputs that both sides share and that largely cancel in the difference.
    own
        Inputs that the sides do not share.
    """

    terms: np.ndarray
    shared: tuple[str, ...] = ()
    own: tuple[str, ...] = ()


def calibration_terms(
    condition: MatchedRuns, first: Folder | None, second: Folder | None
) -> CalibrationTerms:
    """Return the calibration errors of differences, except those in the scatter of the runs.

    Parameters
    ----------
    condition
        The runs and the speeds.
    first, second
        Their results folders, or None.

    Notes
    -----
    The variance is sum_j (c_A - c_B)^2 u_j^2 over the shared inputs j: those that vary with the
    calibration if instrument and calibration are the same, and those that vary with the mount if
    both sides are one sample in one mount of one campaign. Inputs that are not shared add
    separately. Inputs that vary more often are in the scatter of the runs. A shared input that only
    one side states is left out.
    """
    size = condition.speeds.size
    if first is None or second is None:
        return CalibrationTerms(np.zeros((0, size)))
    together = first is second
    sides = [
        _side_inputs(folder, runs, condition.speeds, together)
        for folder, runs in ((first, condition.first_runs), (second, condition.second_runs))
    ]
    calibrations = [_calibrations(first, condition.first_runs)]
    calibrations.append(_calibrations(second, condition.second_runs))
    one_sided = not all(sides) and calibrations[0] == calibrations[1]
    terms: list[np.ndarray] = []
    shared: dict[str, None] = {}
    own: dict[str, None] = {}
    for part in dict.fromkeys([*sides[0], *sides[1]]):
        there = [side.get(part) for side in sides]
        both = all(row is not None for row in there) and bool(part.whose)
        if one_sided and part.whose and not both:
            continue
        rows = [np.zeros(size) if row is None else row for row in there]
        terms += [rows[1] - rows[0]] if both else [row for row in rows if row.any()]
        (shared if both else own)[part.name] = None
    made = np.concatenate([_rows(row, size) for row in terms]) if terms else np.zeros((0, size))
    return CalibrationTerms(made[made.any(axis=1)], tuple(shared), tuple(own))


def _rows(row: np.ndarray, size: int) -> np.ndarray:
    """Return a term that is fully correlated between points, or one term for each point."""
    return row.reshape(-1, size)


def _calibrations(folder: Folder, runs: RunNames) -> frozenset[str]:
    """Return the instruments and calibrations with which some runs were measured."""
    stated = None if folder.campaign is None else folder.campaign.calibration
    which = "" if stated is None else f"{stated.date} {stated.serial} {stated.certificate}"
    names = {str(run.get("instrument", "")) for run in folder.done if run["name"] in runs}
    return frozenset(f"{name}\n{which}" for name in names)


def _side_inputs(
    folder: Folder, runs: RunNames, speeds: np.ndarray, together: bool
) -> dict[_Part, np.ndarray]:
    """Return the inputs of one side, each with its effect on the friction at every point."""
    table = folder.table("uncertainty_budget")
    if table is None or "varies" not in table:
        return {}
    mine = set(runs)
    weight = {c["name"]: len(mine & set(c["runs"])) for c in folder.report["curves"]}
    table = table[table["curve"].map(weight).fillna(0) > 0]
    table = table[~table["part"].isin([NOISE, BETWEEN]) & (table["contribution"].abs() > 0)]
    whose = _origin(folder, runs, together)
    made: dict[_Part, np.ndarray] = {}
    counted = sum(weight.values())
    for (curve, text, varies), rows in table.groupby(["curve", "part", "varies"], dropna=False):
        name, _, instrument = str(text).partition(", ")
        row = _values_at(rows, speeds) * weight[curve] / counted
        if name in _EACH_POINT:
            part, row = _Part(name, ""), np.diag(row)
        else:
            part = _Part(name, whose.get(f"{varies} {instrument}".strip(), ""))
        made[part] = made.get(part, np.zeros_like(row)) + row
    return made


_EACH_POINT = tuple(map(part_words, EACH_POINT))


def _origin(folder: Folder, runs: RunNames, together: bool) -> Mapping[str, str]:
    """Return which calibration or mount an input belongs to."""
    made = {}
    known = _calibrations(folder, runs)
    for whose in known:
        made[f"calibration {whose.partition(chr(10))[0]}".strip()] = whose
    if len(known) == 1:
        made["calibration"] = next(iter(known))
    if together and (labels := labels_of_runs(folder, folder.campaign)).get("mount") is not None:
        mounts = labels["mount"].reindex(list(runs)).dropna().unique()
        if len(mounts) == 1:
            made["mount"] = f"mount {mounts[0]}"
    return made


def _values_at(rows: pd.DataFrame, speeds: np.ndarray) -> np.ndarray:
    """Return contributions at the compared speeds; 0 at speeds that the curve lacks."""
    known = rows[SPEED_COLUMN].to_numpy(dtype=float)
    apart = np.abs(np.log(known[:, None] / speeds))
    nearest = apart.argmin(axis=0)
    near = apart[nearest, np.arange(speeds.size)] <= np.log1p(TOLERANCE)
    return np.where(near, rows["contribution"].to_numpy(dtype=float)[nearest], 0.0)


def terms_text(made: Sequence[CalibrationTerms]) -> str:
    """Return a text on the errors that are included in addition to the scatter of the runs."""
    shared = tuple(dict.fromkeys(name for terms in made for name in terms.shared))
    own = tuple(dict.fromkeys(name for terms in made for name in terms.own if name not in shared))
    if not shared and not own:
        return _NOT_STATED
    texts = []
    if own:
        texts.append(f"each of the two has its own {_join_names(own)}, and both errors count")
    if shared:
        texts.append(
            f"of {_join_names(shared)}, which they share, only what acts on them differently counts"
        )
    return "in addition to the scatter of the runs: " + "; ".join(texts)


def _join_names(names: tuple[str, ...]) -> str:
    return ", ".join(names[:-1]) + (" and " if len(names) > 1 else "") + names[-1]
