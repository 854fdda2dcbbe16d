"""Specimens of a sled test one after another or side by side: each has its own coefficients."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl

SLIDING, STATIC = (0.30, 0.36, 0.27), (0.40, 0.47, 0.35)
NEWTON = 0.2 * 9.80665


def _pull(sliding: float, static: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return way [mm] and force [N]: slack, the peak at 3 mm, then sliding."""
    way = np.arange(0, 70, 0.05)
    ratio = np.interp(way, [0, 1, 3, 4.5, 70], [0, 0, static, sliding, sliding])
    return way, NEWTON * ratio + np.random.default_rng(seed).normal(0, 0.002, way.size)


def _pulls() -> list[tuple[np.ndarray, np.ndarray]]:
    return [_pull(k, s, n) for n, (k, s) in enumerate(zip(SLIDING, STATIC, strict=True))]


def _is_right(run: object) -> None:
    segments = tl.find_segments(run)
    mu = tl.friction_coefficient(run, segments)
    assert mu.friction_coefficient.values == pytest.approx(SLIDING, rel=0.01)
    assert segments.sliding_speed.values == pytest.approx(2.5e-3, rel=1e-3)
    starts = tl.static_friction(run, segments, mu)
    assert starts.static_friction_coefficient.values == pytest.approx(STATIC, rel=0.03)
    assert starts.peak.values.all()
    assert np.isnan(starts.waiting_time.values).all()


@pytest.mark.parametrize("number", ["Specimen No", "Éprouvette", "Probekörper Nr."])
def test_specimens_below_each_other_are_segments_of_their_own(tmp_path: Path, number: str) -> None:
    rows, passed = [], 0.0
    for which, (way, force) in enumerate(_pulls(), start=1):
        for x, f in zip(way, force, strict=True):
            rows.append(f"{which};{passed + x / 2.5:.3f};{x:.3f};{f:.4f}")
        passed += way[-1] / 2.5 + 0.02
    head = ["Sled mass: 200 g", f"{number};Time (s);Position (mm);Friction force (N)"]
    file = tmp_path / "stacked.csv"
    file.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")
    _is_right(tl.read(file))


def test_a_counter_that_wraps_within_a_pull_begins_no_specimen(tmp_path: Path) -> None:
    way, force = _pull(0.3, 0.4, 5)
    rows = [f"{x / 2.5:.3f};{x % 25:.3f};{f:.4f}" for x, f in zip(way, force, strict=True)]
    head = ["Sled mass: 200 g", "Time (s);Position (mm);Friction force (N)"]
    file = tmp_path / "wraps.csv"
    file.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")
    assert tl.find_segments(tl.read(file)).sizes["segment"] == 1
