"""A stated averaging or gear makes a question; one repeated time stamp makes none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.unknown.proposal.questions import GuessedError

CASES = {
    "averaging_10.csv": "every sample is taken for a row, although the file states 'Averaging: 10",
    "reduction_10.csv": "speeds are read as they stand, not divided by 'Reduction: 10'",
}


@pytest.mark.parametrize("name", CASES)
def test_a_speed_that_a_stated_factor_may_change_is_asked_about(
    shared_data: Path, name: str
) -> None:
    with pytest.raises(GuessedError) as caught:
        tl.read(shared_data / "cases" / name)
    assert CASES[name] in str(caught.value)


@pytest.mark.parametrize("line", ["Averaging: 1", "Average friction: 10", "Reduction: 1"])
def test_a_factor_of_one_or_another_quantity_is_no_question(tmp_path: Path, line: str) -> None:
    rng = np.random.default_rng(0)
    rows = np.stack([np.full(400, 1e-3), 3 + 0.01 * rng.random(400), np.full(400, 10.0)], 1)
    rows[:, 2] += 0.01 * rng.random(400)
    path = tmp_path / "run.csv"
    names = "Velocity [m/s],Friction force [N],Normal force [N]"
    np.savetxt(
        path, rows, "%.6g", ",", header=f"Sampling rate: 200 Hz\n{line}\n{names}", comments=""
    )
    assert tl.read(path)["time"].values[-1] == pytest.approx(399 / 200)


def test_one_repeated_time_stamp_is_read_and_noted(shared_data: Path) -> None:
    run = tl.read(shared_data / "cases" / "one_stamp_repeated_SOUND.csv")
    assert np.diff(run["time"].values) == pytest.approx(0.05)
    assert tl.check(run).status == "pass"
    assert run.attrs["rows_time_interpolated"] == 1
