"""Plain checks on arrays: each finds its own defect, where it is, and leaves sound signals be."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.friction.oscillation.spectrum.lines import find_lines, mains_harmonic
from tribolab.friction.oscillation.spectrum.noise import noise_level
from tribolab.qc import signals
from tribolab.qc.flags import FAIL, GOOD, MISSING, NOT_EVALUATED, SUSPECT
from tribolab.qc.run import schema, timing
from tribolab.reading.netcdf.table_schema import validate

seeds = st.integers(0, 2**32 - 1)


def noise(seed, size=2000):
    return np.random.default_rng(seed).standard_normal(size)


def sawtooth(size, period, height, seed=0):
    phase = (np.arange(size) / period) % 1
    return height * phase + 0.01 * noise(seed, size)


def at(flags, severity=SUSPECT):
    return np.flatnonzero(flags == severity).tolist()


@given(seeds, st.integers(2, 1997), st.sampled_from([-1, 1]), st.floats(20, 1e4))
@settings(max_examples=50)
def test_a_spike_is_found_where_it_is_and_nothing_else(seed, place, sign, height):
    values = noise(seed)
    values[place] += sign * height
    assert place in at(signals.spikes(values))
    values[place] = 0.0
    assert at(signals.spikes(values)) == []


@pytest.mark.parametrize("period", [5, 8, 20, 21.7, 100, 1000])
def test_teeth_of_a_saw_and_steps_are_no_spikes(period):
    assert at(signals.spikes(sawtooth(5000, period, 1.0))) == []
    assert at(signals.spikes(-sawtooth(5000, period, 1.0))) == []
    step = 0.01 * noise(1) + 5.0 * (np.arange(2000) > 700)
    assert at(signals.spikes(step)) == []


def test_beside_missing_values_spikes_are_not_evaluated():
    values = noise(0)
    values[100] = np.nan
    flags = signals.spikes(values)
    assert at(flags, NOT_EVALUATED) == [0, 1, 98, 99, 100, 101, 102, 1998, 1999]


@given(seeds, st.floats(0.01, 0.3), st.floats(-1e3, 1e3))
@settings(max_examples=25)
def test_sound_quantised_noise_is_neither_stuck_nor_saturated(seed, step, level):
    values = np.round((level + noise(seed)) / step) * step
    assert at(signals.stuck(values)) == []
    assert at(signals.saturation(values)) == []


@given(seeds, st.integers(100, 1500), st.integers(60, 300))
@settings(max_examples=25)
def test_a_stuck_stretch_is_flagged_from_end_to_end(seed, start, length):
    values = np.round(noise(seed) / 0.1) * 0.1
    values[start : start + length] = 12.5
    assert at(signals.stuck(values)) == list(range(start, start + length))


def test_a_dead_channel_is_stuck():
    assert (signals.stuck(np.zeros(1000)) == SUSPECT).all()


def test_a_coarse_converter_is_not_stuck():
    values = np.round(3.4 + 0.1 * noise(2))  # repeats one code nearly always
    assert at(signals.stuck(values)) == []


@given(seeds, st.floats(0.2, 1.0))
@settings(max_examples=25)
def test_a_signal_cut_off_is_saturated_where_it_is_cut(seed, limit):
    values = np.minimum(np.round(noise(seed) / 0.05) * 0.05, np.round(limit / 0.05) * 0.05)
    assert at(signals.saturation(values)) == np.flatnonzero(values == values.max()).tolist()


def test_missing_is_missing():
    assert signals.missing(np.array([1.0, np.nan, 2.0])).tolist() == [GOOD, MISSING, GOOD]


@given(st.floats(1e-6, 1e3), seeds)
@settings(max_examples=25)
def test_the_step_of_a_converter_is_recovered(step, seed):
    values = np.round(10 * noise(seed)) * step
    assert signals.quantisation_step(values) == pytest.approx(step, rel=1e-6)
    assert signals.quantisation_step(noise(seed)) == 0


@given(seeds, st.floats(1e-6, 1e6), st.floats(-1, 1))
@settings(max_examples=25)
def test_noise_is_measured_through_a_drift(seed, size, slope):
    values = size * (noise(seed, 20_000) + slope * np.arange(20_000))
    assert noise_level(values) == pytest.approx(size, rel=0.06)


def test_time_that_stands_still_or_goes_back_fails():
    time = np.array([0.0, 1.0, 1.0, 2.0, 1.5, 3.0])
    assert at(timing.time_order(time), FAIL) == [2, 4]


@given(st.integers(10, 180), st.floats(6, 1e4))
@settings(max_examples=50)
def test_a_gap_is_found_behind_it(place, length):
    time = np.arange(200.0)
    time[place:] += length
    assert at(timing.time_gaps(time)) == [place]


def test_a_slower_rate_is_no_gap_however_short():
    rates = [0.001] * 500 + [0.1] * 4 + [0.001] * 500 + [0.1] * 40 + [0.01] * 300
    assert at(timing.time_gaps(np.cumsum(rates))) == []


def test_a_pause_between_steps_is_no_gap():
    time = np.concatenate([np.arange(50.0), 1000 + np.arange(50.0)])
    assert at(timing.time_gaps(time)) == [50]
    assert at(timing.time_gaps(time, pauses=np.array([50]))) == []


def test_jitter_is_told_from_a_change_of_the_rate():
    rng = np.random.default_rng(3)
    even = np.cumsum([0.01] * 500 + [0.1] * 500) * (1 + 1e-9)
    assert at(timing.time_jitter(even)) == []
    jitter = np.arange(1000) + rng.uniform(-0.45, 0.45, 1000)
    assert len(at(timing.time_jitter(jitter))) > 900
    assert at(timing.time_jitter(np.arange(1000) + rng.uniform(-0.05, 0.05, 1000))) == []


@given(st.integers(60, 440), st.floats(1.8, 100), st.booleans(), seeds)
@settings(max_examples=50)
def test_a_change_of_the_rate_is_found_to_within_a_few_samples(place, factor, slower, seed):
    interval = np.ones(500)
    interval[place:] *= factor if slower else 1 / factor
    interval *= 1 + 0.02 * np.clip(noise(seed, 500), -3, 3)
    time = np.cumsum(interval)
    assert abs(timing.rate_change(time) - place) <= 3
    assert np.abs(timing.rate_changes(time) - place).max() <= 3
    assert timing.rate_change(time[:place]) is None
    assert timing.rate_changes(time[:place]).size == 0


@given(st.floats(6, 400), st.floats(0.4, 5), seeds)
@settings(max_examples=25, deadline=None)
def test_a_line_is_found_with_its_frequency_and_amplitude(frequency, amplitude, seed):
    time = np.arange(4096) / 1000
    values = amplitude * np.sin(2 * np.pi * frequency * time) + noise(seed, 4096)
    line = find_lines(time, values)[0]
    assert line.frequency == pytest.approx(frequency, abs=0.25)
    assert line.amplitude == pytest.approx(amplitude, rel=0.35, abs=0.06)


def test_noise_has_no_lines():
    time = np.arange(4096) / 1000
    assert not any(find_lines(time, noise(seed, 4096)) for seed in range(200))


def test_mains_is_recognised_also_when_folded():
    assert mains_harmonic(50.05, 0.05, 1000) == "50 Hz"
    assert mains_harmonic(120.0, 0.05, 1000) == "120 Hz"
    assert mains_harmonic(10.0, 0.05, 60.0) == "50 Hz, folded"
    assert mains_harmonic(23.0, 0.05, 1000) == ""


def test_values_beyond_belief_and_beyond_physics_are_told_apart():
    kelvin = schema.ranges()["temperature"]
    assert schema.flag_range(np.array([293.0, 20.0, -3.0, np.nan]), kelvin).tolist() == [
        GOOD,
        SUSPECT,
        FAIL,
        NOT_EVALUATED,
    ]
    for span in schema.ranges().values():
        assert span.lowest <= span.low < span.high <= span.highest and span.reason


def test_the_check_and_the_schema_believe_the_same():
    for name, span in schema.ranges().items():
        for value, wrong in ((span.low, False), (span.high, False), (1.01 * span.high, True)):
            table = pd.DataFrame({"time": [0.0], name: [value]})
            assert bool(validate(table)) == wrong, (name, value)
            flag = schema.flag_range(np.array([value]), span)[0]
            assert (flag != GOOD) == wrong, (name, value)


def test_a_load_of_the_wrong_sign_is_seen_and_a_short_pull_is_not():
    load = np.concatenate([np.zeros(100), np.full(400, 31.0), [-5.0, -6.0]])
    assert schema.tensile_share(load) < 0.01
    assert schema.tensile_share(-load) > 0.99
    assert schema.tensile_share(np.zeros(10)) == 0


@pytest.mark.parametrize("rows", [100, 900])
def test_a_louder_step_holds_no_spikes_and_a_spike_in_it_is_found(rows):
    rng = np.random.default_rng(rows)
    noise = np.repeat([0.01, 0.01, 0.1, 0.01], rows)
    values = np.repeat([1.0, 2.0, 3.0, 4.0], rows) + noise * rng.standard_normal(4 * rows)
    assert not at(signals.spikes(values))
    values[[rows // 2, 2 * rows + rows // 2]] += [0.3, 3.0]
    assert at(signals.spikes(values)) == [rows // 2, 2 * rows + rows // 2]
