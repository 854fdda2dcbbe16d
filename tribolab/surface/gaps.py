"""Scans with missing heights: interpolation across gaps, and the effect of gaps on results.

The effect of a gap is estimated from the scan itself: the same gaps are placed elsewhere on it and
bridged, and the result is computed again.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError

_TRIALS = 16  # number of random positions at which the gaps are placed
_MAX_MISSING = 0.5  # largest share of missing heights with which a scan is evaluated
_FEW_MISSING = 8  # up to this many missing heights at an end are filled with the nearest height
_STUDENT = 1.087  # 97.5 % quantile of Student's t (15 degrees of freedom) / normal quantile
_NORMAL = 1.96
# share of the correction added to the error, because gaps do not occur at random
_SHIFT_SHARE = 0.3
_MAX_FACTOR = float(np.log(2.0))  # change of ln(power) above which gaps dominate a result


class GapEffect(NamedTuple):
    """Effect of gaps on a result: its mean shift, and the standard error left after correction.

    The result minus the shift is the result of the complete scan, within 1.96 errors in 95 % of
    cases. A large share of the shift from bridges hides the surface.
    """

    shift: np.ndarray
    error: np.ndarray
    bridges: np.ndarray


def gaps_in(scans: xr.Dataset) -> np.ndarray | None:
    """Return a mask of missing heights (dims of ``height``), including those that were filled.

    Returns None if no height is missing.
    """
    missing = ~np.isfinite(scans.height)
    if "dropout" in scans:
        missing = missing | (scans.dropout > 0)
    values = missing.transpose(*scans.height.dims).values
    return values if values.any() else None


def cut_ends(scans: xr.Dataset) -> xr.Dataset:
    """Return profiles cut to the range between the first and last height common to all of them.

    Maps are unchanged, and so are profiles that lack only a few heights or would lose more than
    half.
    """
    missing = gaps_in(scans)
    if missing is None or "y" in scans.height.dims:
        return scans
    axis = list(scans.height.dims).index("x")
    present = ~np.moveaxis(missing, axis, -1).reshape(-1, scans.sizes["x"])
    if not present.any(axis=1).all():
        return scans
    first = int(present.argmax(axis=1).max())
    last = present.shape[1] - int(present[:, ::-1].argmax(axis=1).max())
    lost = max(first, present.shape[1] - last)
    if lost <= _FEW_MISSING or last - first < max(2, present.shape[1] // 2):
        return scans
    return scans.isel(x=slice(first, last))


def bridge_gaps(height: np.ndarray, missing: np.ndarray, *, is_map: bool) -> np.ndarray:
    """Return heights interpolated across gaps: linearly in profiles, from four sides in maps.

    Parameters
    ----------
    height
        Heights [m]; values inside gaps are ignored.
    missing
        Mask of missing heights, in the shape of the heights.
    is_map
        Whether the last two dimensions are a map.

    Returns
    -------
    numpy.ndarray
        The heights; in the gaps of a map the mean of the nearest heights to the left and right,
        above and below, each weighted by one over its distance.

    Examples
    --------
    >>> row = np.array([0.0, np.nan, np.nan, 3.0, np.nan])
    >>> bridge_gaps(row, np.isnan(row), is_map=False).tolist()
    [0.0, 1.0, 2.0, 3.0, 3.0]
    """
    if not missing.any():
        return height
    total, weights = np.zeros(height.shape), np.zeros(height.shape)
    for axis in (-1, -2) if is_map else (-1,):
        for backwards in (False, True):
            value, distance = _nearest(height, missing, axis, backwards=backwards)
            weight = np.where(np.isfinite(distance), 1.0 / distance, 0.0)
            total += weight * value
            weights += weight
    if not (weights[missing] > 0).all():
        if not is_map:
            raise AnalysisError(
                "a profile has no height that is a number; leave that scan out",
                function="fill_dropouts",
            )
        alone = missing & (weights == 0)  # no height was measured in the same row or column
        total[alone], weights[alone] = float(np.mean(height[~missing])), 1.0
    return np.where(missing, np.divide(total, weights, where=missing, out=total), height)


def _nearest(
    height: np.ndarray, missing: np.ndarray, axis: int, *, backwards: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest measured height in one direction, and its distance in points."""
    if backwards:
        height, missing = np.flip(height, axis), np.flip(missing, axis)
    number = height.shape[axis]
    place = np.expand_dims(np.arange(number), tuple(range(1, -axis)))
    last = np.maximum.accumulate(np.where(missing, -1, place), axis=axis)
    value = np.take_along_axis(height, np.maximum(last, 0), axis=axis)
    distance = np.where(last >= 0, np.maximum(place - last, 1), np.inf)
    value = np.where(last >= 0, value, 0.0)
    if backwards:
        value, distance = np.flip(value, axis), np.flip(distance, axis)
    return value, distance


def gap_effect(
    height: np.ndarray,
    missing: np.ndarray,
    measure: Callable[[np.ndarray], np.ndarray],
    *,
    is_map: bool,
    joint: bool = False,
    own: np.ndarray | None = None,
) -> GapEffect:
    """Return the effect of gaps on a result, found by placing the same gaps elsewhere on the scan.

    Parameters
    ----------
    height
        Bridged heights [m] (scan, x) or (scan, y, x).
    missing
        Mask of missing heights, in the shape of the heights.
    measure
        Computes the result from heights; results with a relative error give their logarithm.
    is_map
        Whether the scans are maps.
    joint
        Whether all scans share one result; the gaps of one are then placed on others too.
    own
        Whether each result is a logarithm, if every profile or map row has its own results,
        (result, scan) or (result, scan, y).

    Returns
    -------
    GapEffect
        Effect on each result, in the shape that `measure` returns.

    Raises
    ------
    AnalysisError
        If more than half of a scan is missing.

    Notes
    -----
    The gaps are shifted cyclically and mirrored, in sixteen reproducible ways. If all scans have
    one result, the gaps of one scan are also placed on others, because one profile may be smoother
    than the next. The mean shift is corrected for gaps that fall on existing bridges. Three tenths
    of the shift are added to the error: gaps of real scans are on flanks and in pits rather than at
    random. If each row of a map has a result, the effect of its gaps is that on the rows where they
    were placed. A result of a single profile changes in proportion to the remaining heights (as
    with smooth bridges) or to the newly lost ones, and scatters like means over windows: as 1/n of
    the remaining heights minus 1/n of the earlier ones. For scans with points, streaks, blobs and
    holes removed, 1.96 errors include the value of the complete scan in 93 to 99 % of cases
    (`tests/coverage/gap_coverage.py`).
    """
    share = float(missing.reshape(len(missing), -1).mean(axis=1).max())
    if share > _MAX_MISSING:
        raise AnalysisError(
            f"{share:.0%} of the heights are missing; what is left says too little of the surface: "
            "leave that scan out"
        )
    rng = np.random.default_rng(20)
    whole = measure(height)
    changes, left = [], []
    for _ in range(_TRIALS):
        laid = missing[rng.permutation(len(missing))] if joint else missing
        gaps, row = _move_gaps(laid, rng, (-2, -1) if is_map else (-1,))
        change = measure(bridge_gaps(height, gaps, is_map=is_map)) - whole
        if own is not None and is_map:  # each change belongs to the row from which its gaps come
            back = np.broadcast_to(np.argsort(row, axis=-1), change.shape)
            change = np.take_along_axis(change, back, axis=-1)
        changes.append(change)
        left.append(1.0 - (missing | gaps).reshape(len(missing), -1).mean(axis=1))
    every = np.stack(changes)
    grow, widen = (
        _window_factors(missing, np.stack(left), own)
        if own is not None and not is_map
        else (np.array(1.0 / (1.0 - share)), np.array(1.0))
    )
    shift = every.mean(axis=0) * grow
    # gaps at the highest peak cause longer tails than those of a normal distribution
    farthest = np.abs(every - every.mean(axis=0)).max(axis=0) / _NORMAL
    scatter = np.maximum(_STUDENT * every.std(axis=0, ddof=1), farthest)
    error = np.hypot(np.sqrt(1.0 + 1.0 / _TRIALS) * widen * scatter, _SHIFT_SHARE * shift)
    return GapEffect(shift, error, shift)


def logarithm(power: np.ndarray) -> np.ndarray:
    """Return the natural logarithm of values; zeros are replaced by the smallest positive float."""
    return np.log(np.maximum(power, np.finfo(float).tiny))


def effective_values(independent: np.ndarray, effect: GapEffect) -> np.ndarray:
    """Return the number of independent values, reduced by the additional error due to gaps.

    >>> effect = GapEffect(shift=np.zeros(1), error=np.array([0.1]), bridges=np.zeros(1))
    >>> round(float(effective_values(np.array([100.0]), effect)[0]), 9)
    50.0
    """
    return np.asarray(1.0 / (1.0 / independent + effect.error**2))


def gap_cutoff(wavenumber: np.ndarray, effect: GapEffect) -> float:
    """Return the wavenumber [1/m] above which bridged gaps double or halve the power; inf if none.

    >>> effect = GapEffect(np.zeros(4), np.ones(4), bridges=np.array([0.9, 0.1, 0.8, 0.9]))
    >>> gap_cutoff(np.array([1.0, 2.0, 3.0, 4.0]), effect)
    3.0
    """
    lost = np.logical_and.accumulate(np.abs(effect.bridges[::-1]) > _MAX_FACTOR)[::-1]
    return float(wavenumber[np.argmax(lost)]) if lost.any() else float("inf")


def _window_factors(
    missing: np.ndarray, left: np.ndarray, logarithms: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return factors, for moved gaps on real ones, of change (result, scan) and scatter (scan)."""
    there = 1.0 - missing.mean(axis=1)
    lost = np.log(np.maximum(left, 1.0 / missing.shape[1]) / there).mean(axis=0)
    fresh = (there - left).mean(axis=0) / np.where(there < 1.0, 1.0 - there, 1.0)
    hit = fresh > 0
    of_logarithm = np.divide(np.log(there), lost, where=hit, out=np.ones(len(there)))
    of_value = np.divide(1.0, fresh, where=hit, out=np.ones(len(there)))
    grow = np.where(logarithms[:, None], of_logarithm, of_value)
    ratio = np.divide(left.mean(axis=0), fresh, where=hit, out=np.ones(len(there)))
    return grow, np.sqrt(np.maximum(ratio, 1.0))


def _move_gaps(
    missing: np.ndarray, rng: np.random.Generator, axes: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Return each scan's gaps at random other positions, and the rows they come from (scan, y)."""
    moved = np.empty_like(missing)
    came = np.empty(missing.shape[:2], dtype=int)
    for scan, gaps in enumerate(missing):
        row = np.arange(missing.shape[1])
        for axis in axes:
            by = _shift(gaps, rng, axis)
            mirrored = bool(rng.random() < 0.5)
            gaps = np.roll(gaps, by, axis)
            gaps = np.flip(gaps, axis) if mirrored else gaps
            if axis == -gaps.ndim:
                row = np.roll(row, by)
                row = row[::-1] if mirrored else row
        moved[scan], came[scan] = gaps, row
    return moved, came


def _shift(gaps: np.ndarray, rng: np.random.Generator, axis: int) -> int:
    """Return a random cyclic shift of gaps that does not split a gap at the ends of a profile."""
    if gaps.ndim > 1:
        return int(rng.integers(gaps.shape[axis]))
    starts = np.flatnonzero(~(gaps & np.roll(gaps, 1)))
    return -int(rng.choice(starts))
