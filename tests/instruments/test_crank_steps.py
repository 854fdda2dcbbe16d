"""A crank's file in blocks: each block has the frequency or stroke that stands before it."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import save_draft

LOAD = 5.0  # N
BLOCKS = ((1.0, 4.0, 0.22), (10.0, 4.0, 0.15), (5.0, 1.5, 0.18))  # Hz, mm, coefficient


def _written(path: Path, blocks: tuple[tuple[float | None, float, float], ...]) -> Path:
    rng = np.random.default_rng(28)
    lines = ["Reciprocating rig", f"Normal load\t{LOAD:.2f} N", "Drive\tsine", ""]
    start = 0.0
    for number, (frequency, stroke, coefficient) in enumerate(blocks, 1):
        time = np.arange(4000) / 1000
        pace = np.cos(2 * np.pi * (frequency or 3.0) * time)
        force = 1e3 * LOAD * coefficient * np.tanh(50 * pace) + rng.normal(0, 12, time.size)
        stated = [] if frequency is None else [f"Frequency\t{frequency:.1f} Hz"]
        lines += [f"Block\t{number}", *stated, f"Stroke\t{stroke:.2f} mm", ""]
        lines += ["Test time\tFriction force", "s\tmN"]
        lines += [f"{start + t:.3f}\t{f:.1f}" for t, f in zip(time, force, strict=True)] + [""]
        start += 4.0
    path.write_text("\n".join(lines))
    return path


def _drafted(path: Path, file: Path) -> Path:
    return save_draft(tl.reading.draft_dialect(file), path / "rig.toml")


def test_each_block_slides_at_its_own_frequency_and_stroke(tmp_path: Path) -> None:
    file = _written(tmp_path / "blocks.txt", BLOCKS)
    run = tl.read(file, _drafted(tmp_path, file))
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    for step, (frequency, stroke, coefficient) in enumerate(BLOCKS, 1):
        own = friction.isel(segment=np.flatnonzero(friction["step"].values == step))
        assert own.sizes["segment"] >= 2 * 4 * frequency - 2
        peak = np.pi * frequency * stroke * 1e-3
        half = peak * (0.5 / np.arcsin(0.5))  # mean speed over the middle half of a sine's stroke
        assert np.abs(own["sliding_speed"].values) == pytest.approx(half, rel=0.03)
        mean, scatter = (f(own["friction_coefficient"].values) for f in (np.mean, np.std))
        assert abs(mean - coefficient) < 3 * scatter / np.sqrt(own.sizes["segment"]) + 1e-3


def test_a_block_that_does_not_state_its_frequency_is_refused(tmp_path: Path) -> None:
    dialect = _drafted(tmp_path, _written(tmp_path / "blocks.txt", BLOCKS))
    later = ((None, 4.0, 0.2), *BLOCKS)
    with pytest.raises(ReadError, match="'frequency' stands before some steps"):
        tl.read(_written(tmp_path / "later.txt", later), dialect)


def _crank(**attrs: float) -> xr.Dataset:
    time = np.arange(0, 6, 1e-3)
    velocity = 1e-2 * np.cos(2 * np.pi * time)
    return xr.Dataset({"sliding_velocity": ("time", velocity)}, {"time": time}, attrs)


def test_a_crank_s_strokes_have_middles_without_being_asked_for() -> None:
    itself = tl.find_segments(_crank(stroke_m=3.2e-3))
    assert itself.sizes["segment"] > 0
    xr.testing.assert_identical(
        itself, tl.find_segments(_crank(stroke_m=3.2e-3), stroke_middle=0.5)
    )
    assert itself.attrs["stroke_middle"] == 0.5
    assert tl.find_segments(_crank()).sizes["segment"] == 0


def _shuttling(place: np.ndarray, way: np.ndarray, rate: float, mu: float = 0.2) -> xr.Dataset:
    """Position along `place` [m], and a friction force that opposes the way of each sample."""
    rng = np.random.default_rng(7)
    time = np.arange(place.size) / rate
    noisy = [
        values + size * rng.standard_normal(place.size)
        for values, size in ((place, 2e-6), (mu * LOAD * way, 0.02), (LOAD + 0 * place, 0.01))
    ]
    names = ("position", "friction_force", "normal_force")
    columns = {name: ("time", values) for name, values in zip(names, noisy, strict=True)}
    return xr.Dataset(columns, {"time": time})


def _sine(frequency: float, cycles: int, rate: float = 1000.0) -> tuple[np.ndarray, np.ndarray]:
    angle = 2 * np.pi * frequency * np.arange(int(cycles / frequency * rate)) / rate
    return 5e-3 * np.sin(angle), np.sign(np.cos(angle))


def _rests_between(rate: float = 200.0) -> tuple[np.ndarray, np.ndarray]:
    """Strokes of 80 samples, a fifth of them at rest at the turn."""
    share = np.clip(np.arange(100) / 80, 0, 1)
    there = np.concatenate([share, 1 - share])
    way = np.repeat([1.0, -1.0], 100)
    return 10e-3 * np.tile(there, 12), np.tile(way, 12)


@pytest.mark.parametrize("made", [_sine(1.0, 5), _sine(5.0, 40), _rests_between()])
def test_a_position_that_goes_stroke_after_stroke_needs_no_settings(made) -> None:
    place, way = made
    run = _shuttling(place, way, 200.0 if place.max() > 6e-3 else 1000.0)
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    assert friction.sizes["segment"] >= 0.7 * np.count_nonzero(np.diff(way))
    off = friction["friction_coefficient"] - 0.2
    assert (np.abs(off) < 4 * friction["friction_coefficient_sem"]).all()


@pytest.mark.parametrize(
    "made",
    [
        (np.zeros(20_000), np.zeros(20_000)),  # at rest: noise goes to and fro, too
        (_sine(1.0, 10)[0], np.zeros(10_000)),  # friction that does not turn
        (1e-3 * np.cumsum(np.random.default_rng(3).standard_normal(20_000)), np.zeros(20_000)),
        (_sine(1.0, 2)[0], _sine(1.0, 2)[1]),  # four strokes
        (5e-5 * np.sin(2 * np.pi * 50 * np.arange(5000) / 1000), np.zeros(5000)),  # hum
    ],
    ids=["rest", "no friction", "walk", "few", "hum"],
)
def test_what_does_not_go_stroke_after_stroke_has_no_middles(made) -> None:
    segments = tl.find_segments(_shuttling(*made, 1000.0))
    assert "stroke_middle" not in segments.attrs
