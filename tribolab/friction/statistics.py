"""Mean, honest standard error and trend of a signal whose samples are not independent.

Notes
-----
The variance of the mean of a record of length T is the signal's spectrum S(f) seen through the
record's window, Var = int S(f) sinc^2(f T) df. The spectrum is that of an autoregressive model
(Burg) of the record's means over up to 96 equal stretches of time, its order p chosen by
N ln(residual variance) + 3 p. One formula thus serves white noise, noise with memory,
and stick-slip, whose periods cancel but for the last, unfinished one [1]_.

Three corrections were calibrated on simulated records: (i) a dip of the fitted spectrum at zero
frequency is not believed where no strong line explains it; (ii) below a strong line only part of
the line's fitted tail is counted, because whole periods cancel better than the model knows;
(iii) few effective samples widen the error. Coverage of the true mean by 1 and by 3 standard
errors, over 8000 records each (``tests/test_statistics.py`` tests it on smaller ensembles): white
noise 69 and 99.7 %; memory (AR(1)) of 1/100, 1/50, 1/20 of the record 75, 75, 73 % and 99.5, 99.4,
98.7 %; stick-slip of 5 to 10 periods with 5 to 10 % jitter 63 to 83 % and at least 99 %. The
error is too wide (75 to 92 % within 1) where a stroke holds a whole number of teeth.

What repeats with each turn of a rig whose rotation is recorded is known to cancel over whole turns
(:mod:`tribolab.friction.run_out`; ``tests/benchmarks/bench_run_out.py`` prints coverage).

A drift is part of the signal and is not removed: it lengthens the memory and widens the error.

References
----------
.. [1] Percival and Walden (1993), Spectral Analysis for Physical Applications, Cambridge.
   doi:10.1017/CBO9780511622762
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.friction.memory import errors_with_memory
from tribolab.friction.model_spectrum import GRID, ORDER, model_spectra, variance_of_sum
from tribolab.friction.run_out import (
    MOST_TURNS,
    fitted_waves,
    hidden_by_part,
    in_step,
    stretches_for_many_turns,
    turns_of,
)
from tribolab.friction.time_weights import on_grid, sample_weights

MOST_STRETCHES = 96  # stretches of a record; more resolve no slower memory
_WANDERS = 2.0  # times the error by the scatter, from which it is said that it is larger
_HUMP = 4.0  # an oscillation so much above the spectrum at zero is no slow wander
_BESIDE = 0.3  # widening where the noise beside a line is all that moves the mean
# how much the error is widened (and narrowed again where few samples were found because the memory
# was overestimated), and below how many effective samples
_WIDENING, _FEW = 0.62, 20.0
_NARROWING, _FEWER = 0.2, 11.0
STUDENT = 8.0  # effective samples below which the error is at least as wide as Student's t asks


class Estimate(NamedTuple):
    """What a record says of its mean and trend."""

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
    """Mean with its standard error, memory and trend of one record.

    Parameters
    ----------
    time
        Increasing sample times [s]; the spacing may change.
    values
        The samples, in any unit. Values that are not numbers are left out.

    Returns
    -------
    Estimate
        ``std`` is the sample standard deviation (ddof 1). If the sampling rate
        changes, mean and std are weighted by time.
        ``effective_samples`` n_eff is std^2 over the variance of the mean, at most the number of
        samples; ``autocorrelation_time`` is duration / (2 n_eff), half a spacing for white noise.
        ``sem`` is widened below 8 effective samples to what Student's t asks for, so that 1.96 of
        it make a 95 % interval with n_eff - 1 degrees of freedom (`student_widening`), and holds
        what a memory that is long beside the record may hide (`errors_with_memory`).
        ``trend_p_value`` tests the least-squares slope against the signal's own memory.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> found = estimate_of(np.arange(1000.0), 0.3 + 0.01 * rng.standard_normal(1000))
    >>> abs(found.mean - 0.3) < 3 * found.sem, 0.0002 < found.sem < 0.0005
    (True, True)
    """
    return estimates_of([(time, values)])[0]


def estimates_of(records: Iterable[tuple[np.ndarray, ...]]) -> list[Estimate]:
    """Give what `estimate_of` does for several records at once, in a fraction of the time.

    Parameters
    ----------
    records
        Sample times [s] and samples of each, looked at one after the other; of a rig that turns
        the angle [rad] of each sample, too: what repeats with each turn is then no slow wander,
        and ``turns`` says how many were seen (:mod:`tribolab.friction.run_out`).
    """
    told = [_described(*record) for record in records]
    out = [_NOTHING if isinstance(each, _Record) else each for each in told]
    alike: dict[int, list[int]] = {}
    for place, each in enumerate(told):
        if isinstance(each, _Record):
            alike.setdefault(each.blocks.size, []).append(place)
    for places in alike.values():
        own = [each for place in places if isinstance(each := told[place], _Record)]
        for place, estimate in zip(places, _with_errors(own), strict=True):
            out[place] = estimate
    return out


class _Record(NamedTuple):
    """What is known of a record before its memory is: its means over equal stretches, too."""

    mean: float
    std: float
    samples: int
    duration: float
    blocks: np.ndarray
    angle: np.ndarray  # of the rig's rotation over the same stretches [rad]; empty if unknown
    beside: float  # standard deviation beside the waves of many turns
    left: float = 0.0  # standard error that many turns leave in the mean


def _described(
    time: np.ndarray, values: np.ndarray, angle: np.ndarray | None = None
) -> _Record | Estimate:
    """Describe a record; the whole answer where it has no scatter or hardly a sample."""
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
        return Estimate(mean, std, std / np.sqrt(n), n, n, duration / (2 * n), 0.0, 0.0, 1.0)
    known = angle is not None and bool(np.isfinite(angle[-1]))
    turned = on_grid(time, angle, blocks.size) if angle is not None and known else np.empty(0)
    record = _Record(mean, std, n, duration, blocks, turned, std)
    fine = stretches_for_many_turns(turns_of(turned), blocks.size, n)
    if not fine or angle is None:
        return record
    return _without_many_turns(record, on_grid(time, values, fine), on_grid(time, angle, fine))


def _without_many_turns(record: _Record, fine: np.ndarray, angle: np.ndarray) -> _Record:
    """Take out of a record what repeats with each of many turns, seen in finer stretches."""
    waves = fitted_waves(fine, in_step(fine, angle))
    repeated = np.sum([wave.signal for wave in waves], axis=0)
    variance = max(record.std**2 - float(repeated.var()), 1e-6 * record.std**2)
    return record._replace(
        blocks=(fine - repeated).reshape(record.blocks.size, -1).mean(axis=1),
        beside=float(np.sqrt(variance)),
        left=float(np.sqrt(sum(wave.left**2 for wave in waves))),
    )


def _with_errors(records: list[_Record]) -> list[Estimate]:
    """Give the estimates of records with as many stretches each."""
    count, blocks = len(records), np.stack([record.blocks for record in records])
    lines = _lines_of(blocks)
    calmed, left = _without_turns(records)
    centred = calmed - calmed.mean(axis=1, keepdims=True)
    # of all at once: it is the calls that take the time
    power, floor = model_spectra(np.concatenate([centred, lines.rest]))
    plain, sem = _errors_of_mean(centred, power[:count], floor[:count])
    calm = np.array([not _oscillates(own, blocks.shape[1]) for own in power[:count]])
    slow = np.zeros(count)
    slow[calm] = errors_with_memory(calmed[calm])
    p_values = _p_values(lines, power[count:])
    out = []
    for k, (mean, std, n, duration, own, angle, beside, _) in enumerate(records):
        # what turns leave aside, as many samples as that part of the scatter asks for
        share = min(float(calmed[k].std() / own.std()), 1.0)
        effective = float(np.clip((beside * share / plain[k]) ** 2, 1.0, n))
        error = max(float(sem[k]), float(plain[k]) * student_widening(effective), float(slow[k]))
        if left[k] > 0:
            error = float(np.hypot(error, left[k]))
            effective = float(np.clip(std**2 / (plain[k] ** 2 + left[k] ** 2), 1.0, n))
        change = float(lines.slope[k]) * blocks.shape[1]
        out.append(
            Estimate(
                mean,
                std,
                error,
                n,
                effective,
                duration / (2 * effective),
                change / duration,
                change,
                float(p_values[k]),
                turns_of(angle),
            )
        )
    return out


def _without_turns(records: list[_Record]) -> tuple[np.ndarray, np.ndarray]:
    """Give the stretches without what repeats with each turn, and the error that it leaves."""
    blocks = np.stack([record.blocks for record in records])
    left = np.array([record.left for record in records])
    turns = np.array([turns_of(record.angle) for record in records])
    looked = np.flatnonzero((turns > 0) & (turns <= min(MOST_TURNS, blocks.shape[1] / 6)))
    if not looked.size or blocks.shape[1] < 2 * ORDER:
        return blocks, left
    waves = [fitted_waves(blocks[k], records[k].angle) for k in looked]
    repeated = np.stack([np.sum([wave.signal for wave in own], axis=0) for own in waves])
    rest = blocks[looked] - repeated
    power, _ = model_spectra(rest - rest.mean(axis=1, keepdims=True))
    for k, own, beside in zip(looked, waves, power, strict=True):
        if turns[k] < 1:
            left[k] = own[0].signal.std() * hidden_by_part(turns[k])
            continue
        clear = [wave for wave in own if wave.stands_out(beside)]
        for wave in clear:
            blocks[k] -= wave.signal
        left[k] = np.sqrt(sum(wave.left**2 for wave in clear))
    return blocks, left


def _oscillates(power: np.ndarray, samples: int) -> bool:
    """Whether most of a record goes to and fro: its periods cancel, and no wander is left."""
    cycles = np.arange(power.size) * samples / GRID
    return bool(power[cycles > 2.5].max(initial=0.0) > _HUMP * power[0])


def student_widening(effective: float) -> float:
    """Return what widens a standard error known from few effective samples, 1 from 8 on.

    Parameters
    ----------
    effective
        n_eff [1].

    Notes
    -----
    ``t_(0.975, n_eff - 1) / 1.96``, with one degree of freedom at least.

    Examples
    --------
    >>> [round(student_widening(n), 2) for n in (1.5, 3.0, 5.0, 8.0)]
    [6.48, 2.2, 1.42, 1.0]
    """
    if effective >= STUDENT:
        return 1.0
    return float(special.stdtrit(max(effective - 1, 1.0), 0.975) / special.ndtri(0.975))


def student_remark(effective: float) -> str:
    """Say that an error was widened, and why; "" from 8 effective samples on.

    Examples
    --------
    >>> student_remark(2.84)
    "2.8 effective samples: the standard error is widened by Student's t"
    """
    if not effective < STUDENT:
        return ""
    return f"{effective:.2g} effective samples: the standard error is widened by Student's t"


def wander_remark(estimate: Estimate) -> str:
    """Say that an error is larger than the scatter makes it, by what a slow wander may hide.

    Examples
    --------
    >>> calm = Estimate(0.3, 0.01, 0.001, 1000, 100.0, 0.5, 0.0, 0.0, 1.0)
    >>> wander_remark(calm), wander_remark(calm._replace(sem=0.0041))
    ('', 'the standard error is 4.1 times what the scatter makes: it holds a wander too slow to be \
seen in so short a record')
    """
    scatter = estimate.std / np.sqrt(max(estimate.effective_samples, 1.0))
    scatter *= student_widening(estimate.effective_samples)
    if not scatter > 0 or not estimate.sem > _WANDERS * scatter:
        return ""
    return (
        f"the standard error is {estimate.sem / scatter:.2g} times what the scatter makes: "
        "it holds a wander too slow to be seen in so short a record"
    )


def error_of_mean(records: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the standard error of each mean: plain, and widened for few samples.

    Parameters
    ----------
    records
        One evenly spaced record in each row.

    Returns
    -------
    tuple
        Plain and widened standard error (records). Quote the widened one.
    """
    centred = records - records.mean(axis=1, keepdims=True)
    return _errors_of_mean(centred, *model_spectra(centred))


def _errors_of_mean(
    centred: np.ndarray, power: np.ndarray, floor: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """As `error_of_mean`, of records without their means and their model spectra."""
    n = centred.shape[1]
    plain = np.sqrt(variance_of_sum(power, np.full(n, 1 / n)))
    effective = np.mean(centred**2, axis=1) / np.maximum(plain**2, 1e-300)
    student = special.stdtrit(n - 1, 0.995) / special.ndtri(0.995)
    # the many coefficients that describe a line leave the noise beside it less well known
    share = floor / n / np.maximum(plain**2, 1e-300)
    beside = 1 + _BESIDE * share**2
    return plain, plain * student * beside * _widening(effective, n)


def _widening(effective: np.ndarray, n: int) -> np.ndarray:
    """Return the factor by which a spectrum known from few effective samples widens an error."""
    share = effective / min(n / MOST_STRETCHES, 1)
    wide = 1 + _WIDENING / (1 + (share / _FEW) ** 2)
    return wide * (1 - _NARROWING / (1 + (share / _FEWER) ** 2))


def trend(record: np.ndarray) -> tuple[float, float]:
    """Least-squares slope per sample of an even record and its two-sided p value.

    The error of the slope comes from the spectrum of what the line leaves, so that a slow
    wander is not taken for a trend.
    """
    lines = _lines_of(record[None, :])
    power, _ = model_spectra(lines.rest)
    return float(lines.slope[0]), float(_p_values(lines, power)[0])


class _Lines(NamedTuple):
    """Slopes per sample, the samples' weights in them, what they leave of records; if nothing."""

    slope: np.ndarray
    weights: np.ndarray
    rest: np.ndarray
    exact: np.ndarray


def _lines_of(records: np.ndarray) -> _Lines:
    n = records.shape[1]
    place = np.arange(n) - (n - 1) / 2
    weights = place / (place @ place)
    slope = records @ weights
    rest = records - records.mean(axis=1, keepdims=True) - slope[:, None] * place
    exact = np.abs(rest).max(axis=1) <= 1e-14 * np.abs(records).max(axis=1)
    return _Lines(slope, weights, rest, exact)


def _p_values(lines: _Lines, power: np.ndarray) -> np.ndarray:
    """Two-sided p values of slopes, from the model spectra (record, frequency) of what is left."""
    n = lines.weights.size
    error = np.sqrt(np.maximum(variance_of_sum(power, lines.weights), 1e-300))
    plain = variance_of_sum(power, np.full(n, 1 / n))
    effective = np.minimum(np.mean(lines.rest**2, axis=1) / np.maximum(plain, 1e-300), n)
    error *= _widening(effective, n)
    freedom = np.maximum(effective - 2, 2.0)
    p_values = 2 * special.stdtr(freedom, -np.abs(lines.slope) / error)
    return np.where(lines.exact, np.where(lines.slope != 0, 0.0, 1.0), p_values)
