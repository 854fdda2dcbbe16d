"""Strokes whose frequency or length a column holds, and which change in steps."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.info.file_info import file_lines
from tribolab.qc.run.checks import check_run
from tribolab.reading.runs.speed import level_of_each
from tribolab.reading.runs.stroke_speed import velocity_of_strokes

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


def _strokes(frequencies, lasts=6.0, rate=500, seed=2):
    """Return times, numbers of steps and friction of a crank that goes from turn to turn."""
    rng = np.random.default_rng(seed)
    own = np.arange(int(lasts * rate)) / rate
    force = np.concatenate([3 * np.tanh(30 * np.sin(2 * np.pi * f * own)) for f in frequencies])
    time = np.arange(force.size) / rate
    step = np.repeat(np.arange(1, len(frequencies) + 1), own.size)
    return time, step, force + 0.05 * rng.standard_normal(force.size)


@pytest.mark.parametrize("stated", [1.0, 3.0, 5.0])
def test_a_frequency_that_friction_does_not_have_is_no_speed(tmp_path, stated):
    time, _, force = _strokes((2.0,), lasts=20.0)
    rows = "\n".join(f"{t:.3f},{f:.4f}" for t, f in zip(time, force, strict=True))
    head = f"Stroke: 6 mm\nFrequency: {stated} Hz\nDrive: crank\nLoad: 25 N\n"
    (tmp_path / "a.csv").write_text(f"{head}Time [s],Friction force [N]\n{rows}\n")
    run = tl.read(tmp_path / "a.csv")
    assert "sliding_velocity" not in run
    said = check_run(run, tl.find_segments(run)).table.query("status == 'fail'")
    assert f"it does not reverse at the stated {stated:g} Hz" in " ".join(said.message)


def test_a_part_of_another_frequency_does_not_pass_for_rest(tmp_path):
    time, _, force = _strokes((1.0, 2.0, 4.0), lasts=10.0)
    rows = "\n".join(f"{t:.3f},{f:.4f}" for t, f in zip(time, force, strict=True))
    head = "Stroke: 6 mm\nFrequency: 1 Hz\nDrive: crank\nLoad: 25 N\n"
    (tmp_path / "a.csv").write_text(f"{head}Time [s],Friction force [N]\n{rows}\n")
    run = tl.read(tmp_path / "a.csv")
    assert run.attrs["strokes_unlike_s"] == pytest.approx(19, abs=1.5)
    said = check_run(run, tl.find_segments(run)).table.query("check == 'segment_speed'")
    assert said.status.item() == "fail" and "during only part of the run" in said.message.item()
    # the same with rests in it is fine
    resting = np.where((time > 10) & (time < 20), 0.0, force)
    still = np.where(time >= 20, 0.0, resting)
    assert not velocity_of_strokes(time, still, 6e-3, 1.0, "crank").unlike


def test_strokes_in_a_files_name_give_no_speed(tmp_path):
    time, _, force = _strokes((2.0,), lasts=20.0)
    rows = "\n".join(f"{t:.3f},{f:.4f},25" for t, f in zip(time, force, strict=True))
    text = f"Time [s],Friction force [N],Load [N]\n{rows}\n"
    (tmp_path / "pin_stroke6mm_2Hz_sine.csv").write_text(text)
    assert "sliding_velocity" not in tl.read(tmp_path / "pin_stroke6mm_2Hz_sine.csv")
    (tmp_path / "pin_100Hz.csv").write_text(text)  # how often samples were taken, perhaps
    with pytest.raises(tl.TribolabError, match="nothing tells the sliding speed"):
        tl.find_segments(tl.read(tmp_path / "pin_100Hz.csv"))
    said = " ".join(file_lines(tmp_path / "pin_100Hz.csv"))
    assert "how long the strokes are and how often they come" in said
