"""Uncertainty of a measured curve: scatter of its runs, and errors common to them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.attributes import RunAttributes
from tribolab.friction.decisions.rejected import kept
from tribolab.metrology.budget_parts import BETWEEN, NOISE, ScatterPart, combine_parts, part_name
from tribolab.metrology.sensitivity import AMBIGUOUS, contributions, readings_of
from tribolab.reading.dialect.uncertainty import Known

_MOUNT = "mount"  # attribute of a friction result that names the mount of its sample
# contributions that are independent between the points of a curve
EACH_POINT = (NOISE, BETWEEN, AMBIGUOUS, "resolution", "zero_drift")


class CurveUncertainty(NamedTuple):
    """Measured curve with its uncertainty, and the inputs that were stated.

    Parameters
    ----------
    curve
        See `tribolab.metrology.budget_parts.combine_parts`.
    known
        Inputs by the names of the parts; for several instruments, those of each.
    """

    curve: xr.Dataset
    known: dict[str, Known]


class _Part(NamedTuple):
    """Uncertain input of one calibration; runs with the same calibration share its error."""

    name: str
    instrument: str
    known: Known | None


def curve_uncertainty(
    curve: xr.Dataset, frictions: Sequence[xr.Dataset], known: Sequence[Mapping[str, Known]]
) -> CurveUncertainty:
    """Return the measured curve with the uncertainty of each point and its contributions.

    Parameters
    ----------
    curve
        From `tribolab.measured_stribeck_curve` of these runs (sliding_speed).
    frictions
        Results of `tribolab.friction_coefficient`. The attribute ``mount``, if all of them have
        one, distinguishes mounts of the sample; the attribute ``instrument``, instruments.
    known
        Standard uncertainties by name, of each run.

    Notes
    -----
    Errors shared by all runs of an instrument are averaged with their sign and added; errors of
    different instruments are independent. An error that the scatter already includes is not added
    again: one that varies with the run if a point has two runs, with the mount if there are two
    named mounts, with the stroke if a point has two observations; and calibrations if every run of
    a point is from another instrument.
    """
    points = np.log(curve["sliding_speed"].values)
    size = points.size
    sums: dict[_Part, np.ndarray] = {}
    runs, observations = np.zeros(size), np.zeros(size)
    instruments: dict[str, np.ndarray] = {}
    unstated: dict[str, bool] = {}
    for part, stated in zip(map(kept, frictions), known, strict=True):
        index, own, count = _point_of_segments(part, points)
        met, instrument = count > 0, RunAttributes.from_attrs(part.attrs).instrument
        runs += met
        observations += count
        instruments[instrument] = instruments.get(instrument, np.zeros(size, dtype=bool)) | met
        inputs = contributions(readings_of(part), stated)
        unstated[instrument] = unstated.get(instrument, True) and not set(inputs) & set(stated)
        total = np.bincount(index, minlength=size)
        for name, row in inputs.items():
            mean = np.bincount(index, weights=row[own], minlength=size)
            key = _Part(name, instrument, stated.get(name))
            sums.setdefault(key, np.zeros(size))[met] += mean[met] / total[met]
    mounts, apart = _mounts(frictions), np.sum(list(instruments.values()), axis=0)
    several = {
        "stroke": observations > 1,
        "run": runs > 1,
        "mount": (runs > 1) & (mounts > 1),
        "calibration": (runs > 1) & (apart == runs),
    }
    parts, named = {}, {}
    for label, key in _part_labels(sums).items():
        varies = "stroke" if key.known is None else key.known.varies
        parts[label] = np.where(several[varies], 0.0, sums[key] / np.maximum(runs, 1))
        if key.known is not None:
            named[label] = key.known
    left = [name for name, nothing in unstated.items() if nothing and not all(unstated.values())]
    result = combine_parts(curve, "sliding_speed", _scatter(curve, runs), parts, named, left)
    return CurveUncertainty(result, named)


def _scatter(curve: xr.Dataset, runs: np.ndarray) -> list[ScatterPart]:
    """Return the scatter of each point: noise for single runs, else scatter between runs."""
    u, dof = (curve[f"friction_coefficient_{end}"].values for end in ("u", "dof"))
    several = runs > 1
    scatter = [ScatterPart(np.where(several, 0.0, u), dof, NOISE)] if not several.all() else []
    if several.any():
        scatter.append(ScatterPart(np.where(several, u, 0.0), dof, BETWEEN))
    return scatter


def _part_labels(parts: Mapping[_Part, np.ndarray]) -> dict[str, _Part]:
    """Return the label of each contribution, which names the calibration if there are several."""
    labels: dict[str, _Part] = {}
    for key in parts:
        alike = [other for other in parts if other.name == key.name]
        own = [other for other in alike if other.instrument == key.instrument]
        label = key.name
        if len(alike) > 1:
            label = f"{key.name}, {key.instrument or 'instrument not named'}"
            label += f" {own.index(key) + 1}" if len(own) > 1 else ""
        labels[label] = key
    return labels


def _point_of_segments(
    friction: xr.Dataset, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the point index of each used segment, these segments, and observations per point."""
    speed = friction["sliding_speed"].values
    mu = friction["friction_coefficient"].values
    own = np.flatnonzero(np.isfinite(mu) & (speed > 0))
    edges = (points[1:] + points[:-1]) / 2
    index = np.searchsorted(edges, np.log(speed[own]))
    alone = -1 - own
    both = readings_of(friction).both_ways[own]
    key = np.where(both, friction["pair"].values[own], alone) if "pair" in friction else alone
    _, first = np.unique(key, return_index=True)
    return index, own, np.bincount(index[first], minlength=points.size)


def _mounts(frictions: Sequence[xr.Dataset]) -> int:
    labels = [str(friction.attrs.get(_MOUNT, "")) for friction in frictions]
    return len(set(labels)) if all(labels) else 1


def shared_parts(curve: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the contributions common to all points of a curve (sliding_speed), with their names.

    Parameters
    ----------
    curve
        With ``uncertainty_part``, from `curve_uncertainty`.
    """
    if "uncertainty_part" not in curve:
        return
    for name in curve["part"].values.astype(str).tolist():
        if part_name(name) not in EACH_POINT:
            yield name, curve["uncertainty_part"].sel(part=name).values
