"""Strokes whose frequency or length a column holds, and which change in steps."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.io.speed import level_of_each

RATE = 250.0


def _crank(frequencies: list[float], lasts: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return set frequency, friction (0.2 of 10 N) and load of blocks with rests between them."""
    blocks = [np.full(int(RATE * 2), 0.0)]
    for frequency in frequencies:
        blocks += [np.full(int(RATE * lasts), frequency), np.full(int(RATE * 2), 0.0)]
    setting = np.concatenate(blocks)
    phase = 2 * np.pi * np.cumsum(setting) / RATE
    noise = np.random.default_rng(1).normal(0, 0.01, setting.size)
    force = np.where(setting > 0, 2.0 * np.sign(np.cos(phase)), 0.0) + 0.1 + noise
    return setting, force, np.full(setting.size, 10.0)


@pytest.mark.parametrize("name", ["f_Soll/Hz", "Frequenz [Hz]", "Set frequency (1/min)"])
def test_a_column_of_the_frequency_gives_the_speed_of_each_block(tmp_path: Path, name: str) -> None:
    setting, force, load = _crank([0.5, 1.0, 2.0], 12.0)
    setting = 60 * setting if "min" in name else setting
    rows = [
        f"{k / RATE:.3f};{f:g};{x:.4f};{n:.2f}"
        for k, (f, x, n) in enumerate(zip(setting, force, load, strict=True))
    ]
    text = ["# Antrieb: Kurbelschleife", "# Hub: 12 mm", f"Zeit [s];{name};Reibkraft [N];F_N [N]"]
    file = tmp_path / "stufen.csv"
    file.write_text("\n".join([*text, *rows]) + "\n", encoding="utf-8")
    run = tl.read(file)
    segments = tl.find_segments(run)
    speeds = segments.sliding_speed.values
    # the mean over the middle half of a sine's way is 3 L f
    for frequency in (0.5, 1.0, 2.0):
        assert np.isclose(speeds, 3 * 0.012 * frequency, rtol=0.02).sum() > 6 * frequency
    mu = tl.friction_coefficient(run, segments)
    assert float(np.median(mu.friction_coefficient)) == pytest.approx(0.2, rel=0.02)
    assert not (segments.trimmed_stop - segments.trimmed_start > 0.8).any()  # no rest in a stroke


def test_reduced_rows_have_the_mean_speed_of_their_strokes(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    rows = []
    for k in range(240):
        stroke, often, mu = [(1.0, 20.0, 0.15), (1.0, 40.0, 0.14), (2.0, 20.0, 0.13)][k // 80]
        measured = stroke * (1 + rng.normal(0, 0.003))
        rows.append(f"{k}\t50.0\t{measured:.3f}\t{often:.1f}\t{50 * mu + rng.normal(0, 0.02):.3f}")
    text = ["Drive: crank", "", "time\tFN\tstroke\tfreq\tFf", "s\tN\tmm\tHz\tN"]
    file = tmp_path / "reduced.dat"
    file.write_text("\n".join([*text, *rows]) + "\n", encoding="utf-8")
    run = tl.read(file)
    segments = tl.find_segments(run)
    assert segments.sliding_speed.values == pytest.approx([0.04, 0.08, 0.08], rel=0.01)
    mu = tl.friction_coefficient(run, segments)
    assert mu.friction_coefficient.values == pytest.approx([0.15, 0.14, 0.13], rel=0.01)


def test_a_frequency_that_is_ramped_has_no_levels() -> None:
    assert level_of_each(np.linspace(1.0, 20.0, 1000)) is None
    assert level_of_each(np.zeros(5)) is None
    assert level_of_each(np.array([0.0, np.nan, 5.0, 5.1])).tolist() == [0.0, 0.0, 5.05, 5.05]
