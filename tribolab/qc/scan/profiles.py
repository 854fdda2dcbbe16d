"""Checks on profiles of heights: steps, clipping, outlying repeats.

Each is a plain function from arrays and limits to flags or numbers; none changes a height.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median, median_of_known
from tribolab.core.errors import AnalysisError
from tribolab.qc import signals
from tribolab.qc.flags import GOOD, NOT_EVALUATED, SUSPECT
from tribolab.qc.scan.artefacts import longest_run, noisy_stop, rounding_step
from tribolab.surface.roughness import roughness_parameters

_MOVED = 0.02  # if a larger share of neighbours differ, differences are not rare jumps
_BLOCK = 512  # points in a block; jumps are compared with the slopes in their block


def end_points(marked: np.ndarray) -> np.ndarray:
    """Return a mask of the marked points (row, x) that reach an end of their row without a gap.

    Examples
    --------
    >>> end_points(np.array([[True, False, True, False, True, True]])).astype(int).tolist()
    [[1, 0, 0, 0, 1, 1]]
    """
    return np.asarray(
        np.logical_and.accumulate(marked, axis=1)
        | np.logical_and.accumulate(marked[:, ::-1], axis=1)[:, ::-1]
    )


def steps(height: np.ndarray, factor: float = 12.0) -> np.ndarray:
    """Return flags on points at which the height jumps by far more than nearby.

    Parameters
    ----------
    height
        Heights of one profile [m] (x); NaN if missing.
    factor
        Smallest jump, in robust standard deviations of the differences between neighbours: those in
        the surrounding 512 points or, if larger, the lower quartile over the profile.

    Returns
    -------
    ndarray
        suspect at the point after a jump, good elsewhere; not evaluated without a neighbour.

    Notes
    -----
    Slopes of rough profiles have long tails. A jump must therefore also be three times larger than
    the second-largest elsewhere in its block, and larger than three rounding steps.

    Examples
    --------
    >>> height = np.sin(np.linspace(0.0, 60.0, 2000))
    >>> height[1200:] += 5.0
    >>> np.flatnonzero(steps(height) == SUSPECT)
    array([1200])
    """
    flags = np.full(height.size, NOT_EVALUATED, np.int8)
    if height.size < 64:
        return flags
    jumps = np.diff(height)
    known = np.isfinite(jumps)
    flags[1:][known] = GOOD
    if not known.any():
        return flags
    number = max(1, jumps.size // _BLOCK)
    blocks = np.array_split(np.where(known, jumps, np.nan), number)
    middles = np.array([median_of_known(b) if np.isfinite(b).any() else 0.0 for b in blocks])
    spread = np.array([_spread(b, m) for b, m in zip(blocks, middles, strict=True)])
    least = np.quantile(spread, 0.25)
    digit = rounding_step(height)
    for start, block, middle, scale in zip(
        np.cumsum([0, *(len(b) for b in blocks[:-1])]), blocks, middles, spread, strict=True
    ):
        size = np.nan_to_num(np.abs(block - middle))
        limit = max(factor * max(scale, least), 3.0 * digit)
        # compare with the neighbouring steps: a flank of several points is no jump
        signed = np.nan_to_num(block - middle)
        nearby = np.zeros(size.size)
        nearby[1:] = np.maximum(nearby[1:], np.maximum(signed[:-1] * np.sign(signed[1:]), 0.0))
        nearby[:-1] = np.maximum(nearby[:-1], np.maximum(signed[1:] * np.sign(signed[:-1]), 0.0))
        jumps_at = np.flatnonzero((size > limit) & (size > 3.0 * nearby))
        if jumps_at.size:
            usual = np.delete(
                size, np.unique(np.clip([jumps_at - 1, jumps_at, jumps_at + 1], 0, size.size - 1))
            )
            jumps_at = jumps_at[size[jumps_at] > 3.0 * usual.max(initial=0.0)]
        flags[start + 1 + jumps_at] = SUSPECT
    return flags


def _spread(values: np.ndarray, middle: float) -> float:
    """Return the robust standard deviation of differences; zeros are left out if most are zero."""
    away = np.abs(values[np.isfinite(values)] - middle)
    if not away.size:
        return 0.0
    usual = float(median(away))
    if usual == 0.0:
        moved = away[away > 0]
        usual = float(median(moved)) if moved.size >= _MOVED * away.size else 0.0
    return usual / 0.6745


def flag_clipping(height: np.ndarray, fewest: int = 5, noisy: float = 0.01) -> np.ndarray:
    """Return flags on flat peaks or valleys at an end of the measuring range.

    Parameters
    ----------
    height
        Heights of one profile [m] (x), as measured: with tilt and form.
    fewest
        Smallest number of points in a row on the outermost height.
    noisy
        Smallest share of the points clipped at a noisy stop; 1 to ignore noisy stops.

    Returns
    -------
    ndarray
        suspect at such points, good elsewhere.

    Notes
    -----
    A profile that is quantised coarsely reaches its outermost height in a row by chance; as many
    points on the next level distinguish it from a clipped one.
    """
    flags = signals.saturation(height, excess=3.0, fewest=fewest).copy()
    for end in (np.nanmax(height, initial=-np.inf), np.nanmin(height, initial=np.inf)):
        at_end = height == end
        if longest_run(at_end) < fewest:
            flags[at_end & (flags == SUSPECT)] = GOOD
    known = np.isfinite(height)
    if noisy < 1.0 and known.any() and not (flags == SUSPECT).any():
        flags[np.flatnonzero(known)[noisy_stop(height[known], noisy, fewest)]] = SUSPECT
    return flags


def pool_bands(
    logs: np.ndarray, weights: np.ndarray, fewest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Pool spectral bands until each has enough independent values; return means and value counts.

    Parameters
    ----------
    logs
        Logarithms of spectra (repeat, band).
    weights
        Independent values (band).
    fewest
        Required number of independent values in each pooled band.

    Returns
    -------
    tuple of numpy.ndarray
        Weighted mean logarithms (repeat, pooled band), and the pooled bands' values.

    Examples
    --------
    >>> pool_bands(np.array([[0.0, 1.0, 3.0, 5.0]]), np.array([1.0, 1.0, 2.0, 1.0]), 2.0)
    (array([[0.5, 3. ]]), array([2., 2.]))
    """
    starts, total = [], 0.0
    for band, weight in enumerate(weights):
        if total == 0.0:
            starts.append(band)
        total += weight
        if total >= fewest:
            total = 0.0
    if not starts:
        return logs, weights
    sums = np.add.reduceat(weights, starts)
    means = np.add.reduceat(logs * weights, starts, axis=1) / sums
    enough = sums >= fewest
    return means[:, enough], sums[enough]


def odd_one_out(
    logs: np.ndarray, weights: np.ndarray, factor: float, certainty: float
) -> tuple[int, float]:
    """Return the repeat whose spectrum differs from those of all others, if there is one.

    Parameters
    ----------
    logs
        Natural logarithms of the repeats' spectra (repeat, band).
    weights
        Number of independent values of each band (band).
    factor
        Smallest difference of a band, as a factor.
    certainty
        Smallest difference of a band, in standard deviations.

    Returns
    -------
    tuple of int and float
        Number of the outlying repeat (-1: none) and its largest deviation from the others' median,
        as a factor (above 1).

    Notes
    -----
    The logarithm of a mean of n independent spectral values scatters by sqrt(1/n). The others'
    median has about 1.5 / (repeats - 1) of that variance. If two repeats differ, the outlier is
    unknown: the one with more power is named.
    """
    repeats = len(logs)
    if repeats < 2:
        return -1, 1.0
    odd = []
    for repeat in range(repeats):
        others = np.delete(logs, repeat, axis=0)
        middle = np.median(others, axis=0)
        deviation = logs[repeat] - middle
        scatter = np.sqrt((1.0 + 1.5 / (repeats - 1)) / np.maximum(weights, 1.0))
        # if the others differ from each other as much, none is an outlier
        apart = np.abs(others - middle).max(axis=0)
        real = np.abs(deviation) > np.maximum(certainty * scatter, 2.0 * apart)
        odd.append(np.abs(deviation)[real].max(initial=0.0))
    worst = int(np.argmax(odd))
    if repeats == 2 and odd[worst] > 0:
        worst = int(np.argmax(logs.sum(axis=1)))
    largest = float(np.exp(min(max(odd), 700.0)))
    return (worst, largest) if largest > factor else (-1, largest)


def cost_of_gaps(profile: xr.Dataset | None) -> str:
    """Return the uncertainty of Rq due to missing heights as text; "" without roughness.

    Parameters
    ----------
    profile
        ``height`` [m] (x) with filled heights marked; None if it has too few heights.
    """
    if profile is None:
        return ""
    try:
        rough = roughness_parameters(profile, lambda_c=None)
    except AnalysisError:
        return ""
    if "Rq_gap_error" not in rough:
        return ""
    share = float(rough.Rq_gap_error / rough.Rq)
    return f"the roughness Rq with a standard error of {share:.2g} of its value"
