"""Mean, standard error, U95 and trend of a signal whose samples are correlated.

Notes
-----
A record is described by its means over up to 384 equal time intervals. Oscillations and slow trends
are fitted first, and the lowest cosines of the residuals determine the error of its mean
(:mod:`tribolab.friction.mean_error`). Three values are distinguished: the mean over the path (as
measured), the level (without the incomplete period of an oscillation), and the steady value after
running-in, which is not estimated here.

Coverage of the 95 % interval over 500 records of 1920 samples each is 93 to 100 %, the median
standard error 0.8 to 1.5 times the true scatter, for white noise, noise with a correlation time of
1/200 to 1/5 of the record, sines, sawtooths, drifts and running-in
(``tests/coverage/mean_coverage.py``). Waves that repeat with each turn of a rig whose rotation is
recorded cancel over whole turns (:mod:`tribolab.friction.run_out`;
``tests/coverage/run_out_coverage.py`` prints coverage).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from tribolab.core.coverage import NORMAL
from tribolab.friction.mean_error import limits
from tribolab.friction.mean_error.autoregression import spectra_of
from tribolab.friction.mean_error.course import line_through
from tribolab.friction.mean_error.freedom import StandardError, coverage_of, with_freedom
from tribolab.friction.mean_error.level import levels_of, without_lines
from tribolab.friction.run_out import (
    MAX_COARSE_TURNS,
    fitted_waves,
    hidden_by_part,
    in_step,
    stretches_for_many_turns,
    turns_of,
)
from tribolab.friction.time_weights import on_grid, sample_weights

MOST_STRETCHES = int(limits.BLOCKS.value)
_MIN_STRETCHES_OF_TURN = 40  # fewest intervals for which waves of a turning rig are fitted
# number of frequencies of the spectrum with which a wave of a turning rig is compared
_SPECTRUM_FREQUENCIES = 1024


class Estimate(NamedTuple):
    """Mean and trend of a record, with errors.

    ``t_0.975(dof) sem`` is ``u95``, of the mean over the path; values ending in ``_beyond`` are of
    the mean as an estimate beyond the path, where a trend along the path is slow drift that may
    continue.
    """

    mean: float
    std: float
    sem: float
    samples: int
    effective_samples: float
    autocorrelation_time: float
    trend: float
    trend_change: float
    trend_p_value: float
    turns: float = np.nan
    dof: float = np.nan
    u95: float = np.nan
    sem_beyond: float = np.nan
    dof_beyond: float = np.nan
    u95_beyond: float = np.nan
    level: float = np.nan
    determined: bool = False


_NOTHING = Estimate(
    mean=np.nan,
    std=np.nan,
    sem=np.nan,
    samples=0,
    effective_samples=np.nan,
    autocorrelation_time=np.nan,
    trend=np.nan,
    trend_change=np.nan,
    trend_p_value=np.nan,
)


def estimate_of(time: np.ndarray, values: np.ndarray) -> Estimate:
    """Return the mean of one record with its standard error, correlation time and trend.

    Parameters
    ----------
    time
        Increasing sample times [s]; the spacing may change.
    values
        The samples, in any unit. Values that are not finite are omitted.

    Returns
    -------
    Estimate
        ``std`` is the sample standard deviation (ddof 1). If the sampling rate changes, mean and
        std are weighted by time. ``effective_samples`` n_eff is std^2 over the variance of the mean
        beyond the path, at most the number of samples: few with a trend along the path;
        ``autocorrelation_time`` is duration / (2 n_eff), half a spacing for white noise.
        ``determined`` is true if U95 is at most half the range of the samples. ``trend_p_value``
        tests the least-squares slope against the correlated residuals.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> found = estimate_of(np.arange(1000.0), 0.3 + 0.01 * rng.standard_normal(1000))
    >>> abs(found.mean - 0.3) < found.u95, 0.0002 < found.sem < 0.0005
    (True, True)
    """
    return estimates_of([(time, values)])[0]


def estimates_of(records: Iterable[tuple[np.ndarray, ...]]) -> list[Estimate]:
    """Return the results of `estimate_of` for several records at once, in a fraction of the time.

    Parameters
    ----------
    records
        Sample times [s] and samples of each, processed in sequence; for a rotating rig also the
        angle [rad] of each sample: waves that repeat with each turn then do not count as drift, and
        ``turns`` is the number of recorded turns (:mod:`tribolab.friction.run_out`).
    """
    described = [_describe(*record) for record in records]
    out = [_NOTHING if isinstance(each, _Record) else each for each in described]
    alike: dict[int, list[int]] = {}
    for place, each in enumerate(described):
        if isinstance(each, _Record):
            alike.setdefault(each.blocks.size, []).append(place)
    for places in alike.values():
        own = [each for place in places if isinstance(each := described[place], _Record)]
        for place, estimate in zip(places, _estimate_errors(own), strict=True):
            out[place] = estimate
    return out


class _Record(NamedTuple):
    """A record as means over equal intervals, before its errors are known."""

    mean: float
    std: float
    reach: float  # largest minus smallest sample
    samples: int
    duration: float
    blocks: np.ndarray
    angle: np.ndarray  # of the rig's rotation over the same intervals [rad]; empty if unknown
    left: float = 0.0  # standard error that many turns leave in the mean


def _describe(
    time: np.ndarray, values: np.ndarray, angle: np.ndarray | None = None
) -> _Record | Estimate:
    """Return a record as means over intervals; its estimate at once if constant or too short."""
    good = np.isfinite(values)
    if not good.all():
        time, values = time[good], values[good]
        angle = None if angle is None else angle[good]
    n = values.size
    if n == 0:
        return _NOTHING
    if n < 3:
        return _NOTHING._replace(mean=float(np.mean(values)), samples=n)
    weight = sample_weights(time)
    if weight is None:
        mean, std = float(np.mean(values)), float(np.std(values, ddof=1))
    else:
        mean = float(weight @ values)
        variance = float(weight @ (values - mean) ** 2)
        std = float(np.sqrt(variance / max(1 - weight @ weight, 1 / n)))
    blocks = on_grid(time, values, min(n, MOST_STRETCHES))
    duration = float((time[-1] - time[0]) * n / (n - 1))
    if std == 0 or np.ptp(blocks) <= 1e-12 * abs(mean):
        sem = std / np.sqrt(n)
        steady = Estimate(mean, std, sem, n, n, duration / (2 * n), 0.0, 0.0, 1.0)
        return steady._replace(
            dof=np.inf,
            u95=NORMAL * sem,
            sem_beyond=sem,
            dof_beyond=np.inf,
            u95_beyond=NORMAL * sem,
            level=mean,
            determined=True,
        )
    known = angle is not None and bool(np.isfinite(angle[-1]))
    turned = on_grid(time, angle, blocks.size) if angle is not None and known else np.empty(0)
    record = _Record(mean, std, float(np.ptp(values)), n, duration, blocks, turned)
    fine = stretches_for_many_turns(turns_of(turned), blocks.size, n)
    if not fine or angle is None:
        return record
    return _without_many_turns(record, on_grid(time, values, fine), on_grid(time, angle, fine))


def _without_many_turns(record: _Record, fine: np.ndarray, angle: np.ndarray) -> _Record:
    """Return a record minus waves that repeat with each turn, fitted to finer intervals."""
    waves = fitted_waves(fine, in_step(fine, angle))
    repeated = np.sum([wave.signal for wave in waves], axis=0)
    return record._replace(
        blocks=(fine - repeated).reshape(record.blocks.size, -1).mean(axis=1),
        left=float(np.sqrt(sum(wave.left**2 for wave in waves))),
    )


def _estimate_errors(records: list[_Record]) -> list[Estimate]:
    """Return the estimates of records with equal numbers of intervals."""
    blocks, left = _without_turns(records)
    levels = levels_of(blocks)
    line = line_through(without_lines(blocks, levels.lines))
    # an incomplete period of an oscillation changes the mean over the path, but not the level
    moved = np.abs(levels.level - blocks.mean(axis=1))
    path, beyond = (
        with_freedom(np.sqrt(sem**2 + moved**2 + left**2), np.hypot(u95 + moved, NORMAL * left))
        for sem, u95 in ((levels.sem, levels.u95), (levels.sem_beyond, levels.u95_beyond))
    )
    out = []
    for k, record in enumerate(records):
        sem, u95 = float(path.sem[k]), float(path.sem[k] * coverage_of(path.dof[k]))
        past = float(beyond.sem[k])
        effective = float(np.clip((record.std / past) ** 2, 1.0, record.samples)) if past else 1.0
        change = float(line.change[k])
        out.append(
            Estimate(
                record.mean,
                record.std,
                sem,
                record.samples,
                effective,
                record.duration / (2 * effective),
                change / record.duration,
                change,
                float(line.chance[k]),
                turns_of(record.angle),
                float(path.dof[k]),
                u95,
                past,
                float(beyond.dof[k]),
                float(past * coverage_of(beyond.dof[k])),
                record.mean + float(levels.level[k] - blocks[k].mean()),
                u95 <= record.reach / 2,
            )
        )
    return out


def _without_turns(records: list[_Record]) -> tuple[np.ndarray, np.ndarray]:
    """Return the intervals without waves that repeat with each turn, and the remaining error."""
    blocks = np.stack([record.blocks for record in records])
    left = np.array([record.left for record in records])
    turns = np.array([turns_of(record.angle) for record in records])
    looked = np.flatnonzero((turns > 0) & (turns <= min(MAX_COARSE_TURNS, blocks.shape[1] / 6)))
    if not looked.size or blocks.shape[1] < _MIN_STRETCHES_OF_TURN:
        return blocks, left
    waves = [fitted_waves(blocks[k], records[k].angle) for k in looked]
    repeated = np.stack([np.sum([wave.signal for wave in own], axis=0) for own in waves])
    cycles = np.linspace(0, blocks.shape[1] / 2, _SPECTRUM_FREQUENCIES)
    power = spectra_of(blocks[looked] - repeated, cycles)
    for k, own, density in zip(looked, waves, power, strict=True):
        if turns[k] < 1:
            left[k] = own[0].signal.std() * hidden_by_part(turns[k])
            continue
        clear = [wave for wave in own if wave.exceeds_spectrum(density)]
        for wave in clear:
            blocks[k] -= wave.signal
        left[k] = np.sqrt(sum(wave.left**2 for wave in clear))
    return blocks, left


def undetermined_remark(estimate: Estimate) -> str:
    """Return a remark if a record is too short for an error of its mean; else "".

    Examples
    --------
    >>> found = Estimate(0.3, 0.01, 0.001, 1000, 100.0, 0.5, 0.0, 0.0, 1.0, u95=0.002)
    >>> undetermined_remark(found._replace(determined=True))
    ''
    >>> undetermined_remark(found._replace(u95=0.04))
    'the mean is not determined: the record is too short for its slow drift (U95 0.04)'
    """
    if estimate.determined or not estimate.u95 > 0:
        return ""
    return (
        "the mean is not determined: the record is too short for its slow drift "
        f"(U95 {estimate.u95:.2g})"
    )


def wander_remark(estimate: Estimate) -> str:
    """Return a remark on slow drift if it widens U95 and matters for the mean, else "".

    Examples
    --------
    >>> calm = Estimate(0.3, 0.01, 0.001, 1000, 100.0, 0.5, 0.0, 0.01, 1.0, u95=0.002)
    >>> wander_remark(calm), wander_remark(calm._replace(u95=0.0082))
    ('', 'U95 includes slow drift that this record is too short to resolve (4.2 times the value \
by scatter)')
    >>> wander_remark(calm._replace(u95=0.0082, mean=3.0))
    ''
    """
    scatter = NORMAL * estimate.sem
    if not scatter > 0 or not estimate.u95 > limits.MIN_DRIFT_WIDENING.value * scatter:
        return ""
    moved = abs(estimate.trend_change) > limits.MIN_DRIFT_CHANGE.value * estimate.sem
    if not (moved and estimate.u95 > limits.MIN_DRIFT_U95.value * abs(estimate.mean)):
        return ""
    return (
        "U95 includes slow drift that this record is too short to resolve "
        f"({estimate.u95 / scatter:.2g} times the value by scatter)"
    )


def error_of_series(records: np.ndarray) -> StandardError:
    """Return the standard error of each mean, with its degrees of freedom.

    Parameters
    ----------
    records
        One evenly spaced record in each row, of at least three values (record, value); of a longer
        record than usual, means over equal intervals are used.
    """
    count, most = records.shape[1], int(limits.BLOCKS.value)
    if count > most:
        edges = np.linspace(0, count, most + 1).astype(int)
        records = np.add.reduceat(records, edges[:-1], axis=1) / np.diff(edges)
    found = levels_of(records)
    moved = np.abs(found.level - records.mean(axis=1))
    return with_freedom(np.hypot(found.sem, moved), found.u95 + moved)
