"""The uncertainty of a measured curve: what its runs scatter, and what they all share."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.friction.decisions.rejected import kept
from tribolab.io.uncertainty import Known
from tribolab.metrology.budget_parts import BETWEEN, NOISE, Scatter, combined
from tribolab.metrology.sensitivity import AMBIGUOUS, contributions, readings_of

MOUNT = "mount"  # attribute of a friction result: which mount it was measured in


def with_curve_uncertainty(
    curve: xr.Dataset, frictions: Sequence[xr.Dataset], known: Mapping[str, Known]
) -> xr.Dataset:
    """Return a measured curve with the uncertainty of each point and its parts.

    Parameters
    ----------
    curve
        From `tribolab.measured_stribeck_curve` of these runs (sliding_speed).
    frictions
        Results of `tribolab.friction_coefficient`. The attribute ``mount``, where all of them
        have one, tells how often the sample was mounted.
    known
        Standard uncertainties by name.

    Notes
    -----
    What all runs share is averaged with its sign and added. What varies with the run is in the
    spread between runs as soon as there are two of them, what varies with the mount as soon as two
    mounts are named, what varies with the stroke as soon as a point has two observations: it is
    not added again.
    """
    points = np.log(curve["sliding_speed"].values)
    size = points.size
    names: dict[str, None] = {}
    sums: dict[str, np.ndarray] = {}
    runs, observations = np.zeros(size), np.zeros(size)
    for part in map(kept, frictions):
        place, own, count = _at_points(part, points)
        met = count > 0
        runs += met
        observations += count
        for name, row in contributions(readings_of(part), known).items():
            names[name] = None
            mean = np.zeros(size)
            np.add.at(mean, place, row[own])
            total = np.bincount(place, minlength=size)
            sums.setdefault(name, np.zeros(size))[met] += mean[met] / total[met]
    mounts = _mounts(frictions)
    parts = {}
    for name in names:
        share = sums[name] / np.maximum(runs, 1)
        parts[name] = np.where(_in_scatter(name, known, runs, mounts, observations), 0.0, share)
    u, dof = (curve[f"friction_coefficient_{end}"].values for end in ("u", "dof"))
    several = runs > 1
    scatter = [Scatter(np.where(several, 0.0, u), dof, NOISE)] if not several.all() else []
    if several.any():
        scatter.append(Scatter(np.where(several, u, 0.0), dof, BETWEEN))
    return combined(curve, "sliding_speed", scatter, parts, known)


def _at_points(
    friction: xr.Dataset, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the point of each segment that counts, these segments, and observations per point."""
    speed = friction["sliding_speed"].values
    mu = friction["friction_coefficient"].values
    own = np.flatnonzero(np.isfinite(mu) & (speed > 0))
    edges = (points[1:] + points[:-1]) / 2
    place = np.searchsorted(edges, np.log(speed[own]))
    alone = -1 - own
    both = readings_of(friction).both_ways[own]
    key = np.where(both, friction["pair"].values[own], alone) if "pair" in friction else alone
    _, first = np.unique(key, return_index=True)
    return place, own, np.bincount(place[first], minlength=points.size)


def _mounts(frictions: Sequence[xr.Dataset]) -> int:
    labels = [str(friction.attrs.get(MOUNT, "")) for friction in frictions]
    return len(set(labels)) if all(labels) else 1


def _in_scatter(
    name: str, known: Mapping[str, Known], runs: np.ndarray, mounts: int, observations: np.ndarray
) -> np.ndarray:
    """Return at which points a part is in the scatter already (point)."""
    varies = "stroke" if name == AMBIGUOUS else known[name].varies
    several = {
        "stroke": observations > 1,
        "run": runs > 1,
        "mount": (runs > 1) & (mounts > 1),
        "calibration": np.zeros(runs.size, dtype=bool),
    }
    return several[varies]


def shared_parts(curve: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """Give the parts of a curve's uncertainty that its points share, by name (sliding_speed).

    Parameters
    ----------
    curve
        With ``uncertainty_part``, from `with_curve_uncertainty`.
    """
    if "uncertainty_part" not in curve:
        return
    for name in curve["part"].values.astype(str).tolist():
        if name not in (NOISE, BETWEEN, AMBIGUOUS, "resolution", "zero_drift"):
            yield name, curve["uncertainty_part"].sel(part=name).values
