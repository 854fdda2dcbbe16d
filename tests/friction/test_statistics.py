"""The standard error of the mean covers the truth; trends are neither missed nor made up."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.signal import lfilter

from tribolab.friction.mean_error.course import line_through
from tribolab.friction.mean_error.estimates import MOST_STRETCHES, error_of_series, estimate_of
from tribolab.friction.mean_error.freedom import with_freedom
from tribolab.friction.mean_error.level import levels_of
from tribolab.friction.time_weights import on_grid, sample_weights

RECORDS, N = 240, 1920


def white(rng, n=N):
    return rng.standard_normal((RECORDS, n))


def memory(rng, time):
    """AR(1), stationary from its first sample."""
    a = np.exp(-1 / time)
    noise = rng.standard_normal((RECORDS, N))
    noise[:, 0] /= np.sqrt(1 - a * a)
    return lfilter([1], [1, -a], noise, axis=1)


def oscillation(rng, form, jitter, noise, fewest=5.0, most=10.0):
    """Periods that are drawn anew each, from a random phase on; 5 to 10 of them in a record."""
    periods = rng.uniform(fewest, most, RECORDS)
    result = np.empty((RECORDS, N))
    for i, count in enumerate(periods):
        length = N / count * (1 + jitter * rng.standard_normal(2 * int(count) + 6))
        edge = np.concatenate([[0.0], np.cumsum(length)]) - N / count * (1 + rng.random())
        phase = np.interp(np.arange(N), edge, np.arange(edge.size)) % 1
        result[i] = np.sin(2 * np.pi * phase) if form == "sine" else 2 * phase - 1
    return result + noise * rng.standard_normal((RECORDS, N))


def coverage(records):
    """Share of records whose U95 holds the truth, 0, and the standard error over the scatter."""
    blocks = records
    if records.shape[1] > MOST_STRETCHES:
        blocks = records.reshape(len(records), MOST_STRETCHES, -1).mean(axis=2)
    error = error_of_series(blocks)
    mean = blocks.mean(axis=1)
    inside = np.abs(mean) <= error.sem * stats.t.ppf(0.975, np.minimum(error.dof, 1e9))
    return inside.mean(), np.median(error.sem) / np.sqrt(np.mean(mean**2))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "seed"),
    [
        ("white", 11),
        ("white, 40 samples", 12),
        ("memory of 1/200", 13),
        ("memory of 1/50", 14),
        ("memory of 1/20", 15),
    ],
)
def test_u95_covers_noise(kind, seed):
    rng = np.random.default_rng(seed)
    records = {
        "white": lambda: white(rng),
        "white, 40 samples": lambda: white(rng, 40),
        "memory of 1/200": lambda: memory(rng, N / 200),
        "memory of 1/50": lambda: memory(rng, N / 50),
        "memory of 1/20": lambda: memory(rng, N / 20),
    }[kind]()
    inside, width = coverage(records)
    assert inside >= 0.90 and 0.6 < width < 1.6


@pytest.mark.slow
@pytest.mark.parametrize("form", ["sine", "saw"])
def test_u95_covers_stick_slip_of_few_periods(form):
    inside, width = coverage(oscillation(np.random.default_rng(21), form, 0.05, 0.1))
    assert inside >= 0.90 and width < (1.6 if form == "sine" else 3.0)


@pytest.mark.slow
@pytest.mark.parametrize("course", ["drift", "running-in"])
def test_a_course_along_the_path_is_no_error_of_the_mean_over_it(course):
    t = (np.arange(N) + 0.5) / N
    shape = 14 * t if course == "drift" else 9 * np.exp(-t / 0.25)
    rng = np.random.default_rng(31)
    records = shape - shape.mean() + memory(rng, N / 200)
    inside, width = coverage(records)
    assert inside >= 0.90 and width < 1.6
    found = levels_of(records.reshape(RECORDS, MOST_STRETCHES, -1).mean(axis=2))
    # the same number for the surface beyond the path: the course may go on
    assert np.median(found.u95_beyond / found.u95) > 5


def test_error_and_freedom_make_u95():
    wide = np.array([1.0, 1.96, 2.5, 4.0, 12.7, 30.0])
    found = with_freedom(np.ones(6), wide)
    assert found.sem * stats.t.ppf(0.975, np.minimum(found.dof, 1e9)) == pytest.approx(
        wide, rel=1e-4
    )
    assert np.isinf(found.dof[0]) and found.dof[-1] == 1


def test_stick_slip_is_known_better_than_independent_samples_would_tell():
    rng = np.random.default_rng(5)
    record = oscillation(rng, "saw", 0.05, 0.02, 30.0, 30.0)[0]
    found = estimate_of(np.arange(N) / 1e3, record)
    assert found.sem < 0.7 * found.std / np.sqrt(N)


def test_memory_lengthens_the_autocorrelation_time_as_theory_says():
    # integrated time of AR(1): (1 + a) / (1 - a) / 2 samples
    rng = np.random.default_rng(6)
    a = np.exp(-1 / 5)
    found = [estimate_of(np.arange(N) * 0.1, r).autocorrelation_time for r in memory(rng, 5)[:200]]
    assert np.median(found) == pytest.approx(0.05 * (1 + a) / (1 - a), rel=0.15)


def test_white_noise_counts_every_sample():
    found = [estimate_of(np.arange(N) * 0.1, r) for r in white(np.random.default_rng(7))[:200]]
    assert np.median([f.effective_samples for f in found]) > 0.9 * N
    assert np.median([f.autocorrelation_time for f in found]) == pytest.approx(0.05, rel=0.1)


@pytest.mark.parametrize("time", [0.3, N / 100, N / 20])
def test_wander_is_rarely_called_a_trend(time):
    records = memory(np.random.default_rng(51), time)
    blocks = records.reshape(RECORDS, MOST_STRETCHES, -1).mean(axis=2)
    assert np.mean(line_through(blocks).chance < 0.05) <= 0.10


def test_real_trend_is_found_with_its_size():
    rng = np.random.default_rng(8)
    time = np.arange(2000) * 0.01
    found = estimate_of(time, 0.3 + 1e-3 * time + 0.005 * rng.standard_normal(2000))
    assert found.trend == pytest.approx(1e-3, rel=0.1)
    assert found.trend_change == pytest.approx(0.02, rel=0.1)
    assert found.trend_p_value < 1e-6


def test_uneven_sampling_is_weighted_by_time():
    # half the time at 0.2, half at 0.4, but a hundred times more samples in the second half
    time = np.concatenate([np.arange(50) * 1.0, 50 + np.arange(5000) * 0.01])
    values = np.where(time < 50, 0.2, 0.4)
    assert sample_weights(time) is not None
    assert estimate_of(time, values).mean == pytest.approx(0.3, abs=0.003)


def test_even_sampling_gives_the_plain_mean_and_standard_deviation():
    values = np.random.default_rng(1).standard_normal(500)
    time = np.arange(500) + 0.05 * np.sin(np.arange(500))
    found = estimate_of(time, values)
    assert found.mean == np.mean(values)
    assert found.std == np.std(values, ddof=1)


def test_constant_signal_has_no_error_and_no_trend():
    found = estimate_of(np.arange(100.0), np.full(100, 0.3))
    assert (found.mean, found.std, found.sem, found.trend) == (0.3, 0.0, 0.0, 0.0)
    assert found.trend_p_value == 1.0


@pytest.mark.parametrize("n", [0, 1, 2])
def test_too_few_samples_give_no_error_instead_of_a_number(n):
    found = estimate_of(np.arange(float(n)), np.full(n, 0.3))
    assert found.samples == n
    assert np.isnan(found.sem)
    assert np.isnan(found.trend_p_value)


def test_missing_numbers_are_left_out():
    values = np.random.default_rng(2).standard_normal(600)
    values[::3] = np.nan
    found = estimate_of(np.arange(600.0), values)
    assert found.samples == 400
    assert found.mean == pytest.approx(np.nanmean(values))


def test_empty_stretches_of_the_grid_are_interpolated():
    time = np.concatenate([np.arange(100.0), 200 + np.arange(100.0)])
    assert on_grid(time, 2 * time, 30) == pytest.approx(2 * (np.arange(30) + 0.5) * 10, abs=20)


@settings(deadline=None, max_examples=40)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(5, 400),
    st.floats(1e-6, 1e6),
    st.floats(-100, 100),
    st.floats(-1e5, 1e5),
)
def test_estimates_follow_scale_shift_and_time_origin(seed, n, scale, shift, origin):
    values = np.random.default_rng(seed).standard_normal(n)
    time = np.arange(n) * 0.5
    plain = estimate_of(time, values)
    other = estimate_of(time + origin, scale * (values + shift))
    assert other.mean == pytest.approx(scale * (plain.mean + shift), rel=1e-6, abs=1e-6 * scale)
    for name in ("std", "sem", "trend_change"):
        assert getattr(other, name) == pytest.approx(
            scale * getattr(plain, name), rel=1e-4, abs=1e-6 * scale
        )
    assert other.trend_p_value == pytest.approx(plain.trend_p_value, abs=1e-4)


def test_a_record_too_short_for_its_wander_is_not_determined():
    found = [estimate_of(np.arange(N) * 0.1, r) for r in memory(np.random.default_rng(17), N / 3)]
    assert np.mean([one.determined for one in found[:80]]) < 0.3
    calm = [estimate_of(np.arange(N) * 0.1, r) for r in white(np.random.default_rng(18))[:80]]
    assert all(one.determined for one in calm)
