"""A long record is worked on in pieces: where it is cut does not show."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.arrays.chunks import pieces
from tribolab.friction.oscillation.spectrum import noise
from tribolab.qc import signals
from tribolab.qc.flags import (
    FAIL,
    GOOD,
    MISSING,
    NOT_EVALUATED,
    SUSPECT,
    attach,
    combine,
    is_uniform,
    uniform,
)
from tribolab.qc.run import timing
from tribolab.qc.run.checks import check_run

SEVERITIES = (GOOD, NOT_EVALUATED, SUSPECT, FAIL, MISSING)


@settings(deadline=None)
@given(st.integers(0, 50), st.integers(0, 50), st.integers(1, 60))
def test_pieces_cover_every_sample_once(start, length, piece):
    cut = list(pieces(start, start + length, piece))
    covered = [sample for first, last in cut for sample in range(first, last)]
    assert covered == list(range(start, start + length))
    assert all(last - first <= piece for first, last in cut)


def hostile_signal(seed, size):
    """A quantised signal with spikes, a stuck stretch, gaps in its values, and a cut-off top."""
    rng = np.random.default_rng(seed)
    values = np.round(rng.normal(31, 0.3, size) / 0.05) * 0.05
    values[rng.integers(0, size, size // 40)] += rng.choice([-9.0, 9.0])
    values[size // 3 : size // 3 + size // 8] = values[size // 3]
    if seed % 2:
        values[rng.integers(0, size, size // 50)] = np.nan
    return np.minimum(values, 31.4)


def hostile_time(seed, size):
    """Times that jitter in a stretch, pause, and change their rate."""
    rng = np.random.default_rng(seed)
    interval = np.ones(size)
    interval[size // 4 : size // 2] += rng.normal(0, 0.4, size // 2 - size // 4)
    interval[rng.integers(0, size, 5)] = 40.0
    interval[3 * size // 4 :] = 3.0
    return np.cumsum(np.abs(interval))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("size", [16, 67, 600, 1100, 3001])
def test_where_a_record_is_cut_does_not_show(monkeypatch, seed, size):
    values, time = hostile_signal(seed, size), hostile_time(seed, size)

    def found():
        flags = [
            signals.missing(values),
            signals.spikes(values),
            signals.stuck(values),
            signals.saturation(values),
            timing.time_gaps(time),
            timing.time_jitter(time),
            timing.rate_changes(time),
        ]
        return [*(one.tolist() for one in flags), noise.noise_level(values)]

    whole = found()
    for piece in (1, 64, 1000):
        monkeypatch.setattr("tribolab.arrays.chunks.PIECE", piece)
        assert found() == whole


@settings(deadline=None, max_examples=50)
@given(st.lists(st.sampled_from(SEVERITIES), min_size=1, max_size=5), st.data())
def test_flags_that_are_all_alike_count_as_the_same_written_out(alike, data):
    other = data.draw(st.lists(st.sampled_from(SEVERITIES), min_size=4, max_size=4))
    short = [uniform(4, one) for one in alike]
    assert all(map(is_uniform, short))
    long = [np.full(4, one, np.int8) for one in alike]
    for extra in ([], [np.array(other, np.int8)]):
        found = combine([*short, *extra])
        assert found.dtype == np.int8
        assert found.tolist() == combine([*long, *extra]).tolist()
    run = xr.Dataset({"normal_force": ("time", [1.0, 2.0, np.nan, 4.0])})
    names = {f"check {number}": number for number in range(len(alike) + 1)}
    flags = [
        dict(zip(names, [*some, np.array(other, np.int8)], strict=True)) for some in (short, long)
    ]
    first, second = (attach(run, "normal_force", one, names) for one in flags)
    assert first.identical(second)


def test_a_sound_record_carries_its_flags_in_little_memory():
    size = 20_000
    rng = np.random.default_rng(0)
    time = np.arange(size) / 1000.0
    run = xr.Dataset(
        {
            "friction_force": ("time", 5 + rng.normal(0, 0.1, size)),
            "normal_force": ("time", 10 + rng.normal(0, 0.1, size)),
            "sliding_velocity": ("time", np.full(size, 1e-3)),
        },
        {"time": time},
    )
    found = check_run(run)
    held = {id(r.flags): r.flags for _, r in found.results if r.flags is not None}
    written_out = [flags for flags in held.values() if not is_uniform(flags)]
    assert len(held) > 15 and len(written_out) <= 8
    tests = found.flagged["normal_force_qc_tests"]
    assert tests.dtype == np.int32 and not tests.any()
