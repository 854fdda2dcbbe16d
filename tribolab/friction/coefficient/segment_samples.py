"""Samples of the segments of a run: index ranges, mean times, angle of a rotating rig."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import one_by_one
from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.run_out import turned
from tribolab.friction.segments.stretches import name_of


def belong(run: xr.Dataset, segments: xr.Dataset) -> None:
    """Raise an error if `segments` is not a result of `find_segments` on this run."""
    if "segment" not in getattr(segments, "sizes", ()):
        raise AnalysisError(
            f"a {type(segments).__name__} without segments was given as segments",
            where=name_of(run),
            cure=Cure(notebook="give what tl.find_segments(run) returns"),
        )
    mine, theirs = (d.attrs.get("source_sha256") for d in (run, segments))
    outside = False
    if segments.sizes["segment"]:
        if not run.sizes.get("time"):
            raise AnalysisError(f"{name_of(run)}: the run has no samples")
        time = run["time"].values
        slack = 1e-6 * (time[-1] - time[0])
        outside = bool(
            (segments["start"].values < time[0] - slack).any()
            or (segments["stop"].values > time[-1] + slack).any()
        )
    if outside or (mine and theirs and mine != theirs):
        raise AnalysisError(
            "the segments lie outside this run or come from another file",
            where=name_of(run),
            cure=Cure(notebook="find them in the same run with find_segments(run)"),
        )


def trimmed_slices(run: xr.Dataset, segments: xr.Dataset) -> list[slice]:
    """Return the index ranges of the samples of each trimmed segment."""
    time = run["time"].values
    first = np.searchsorted(time, segments["trimmed_start"].values, side="left")
    last = np.searchsorted(time, segments["trimmed_stop"].values, side="right")
    return [slice(a, max(a, b)) for a, b in zip(first, last, strict=True)]


def mean_times(time: np.ndarray, parts: list[slice], segments: xr.Dataset) -> np.ndarray:
    """Return the mean time of each segment's samples [s], at which a drifting zero has its mean."""
    ends = (segments["trimmed_start"].values + segments["trimmed_stop"].values) / 2
    means = [
        time[s].mean() if s.stop > s.start else end
        for s, end in one_by_one(zip(parts, ends, strict=True))
    ]
    return np.array(means, dtype=float)


class Turning(NamedTuple):
    """Times [s] and rotation speed [rad/s] of a rig that rotates one way; None for other rigs."""

    time: np.ndarray | None = None
    speed: np.ndarray | None = None

    @classmethod
    def of(cls, run: xr.Dataset, segments: xr.Dataset) -> Turning:
        """Return the rotation of a run's rig."""
        # a disc that oscillates through an arc makes no whole turns to average over
        direction = segments["direction"].values
        if "rotation_speed" not in run or ((direction > 0).any() and (direction < 0).any()):
            return cls()
        return cls(run["time"].values, run["rotation_speed"].values)

    def angle(self, part: slice, at: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Return the rig's angle [rad] at a segment's samples or at given times; () if unknown."""
        if self.time is None or self.speed is None or part.stop - part.start < 2:
            return ()
        time = self.time[part]
        angle = turned(time, self.speed[part])
        whole = at is None or at.size == time.size
        return (angle if at is None or whole else np.interp(at, time, angle),)
