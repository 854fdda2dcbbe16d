"""A rotation that a header states is known as one in a column: what repeats is run-out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl

TURNS = 1.0  # a second
HEADERS = {
    "rotation and radius": "Rotation speed: 60 rpm\nTrack radius: 15 mm\n",
    "speed per minute": "Speed: 60 rpm\nRadius: 15 mm\n",
    "units with the names": "Rotational speed [rpm]: 60\nRadius [mm]: 15\n",
}
# columns: clock, time, torque or force, lateral force, counts, measured turns a second, interval
NEWPORT = """
name = "newport"
title = "torque of a disc"
[recognise]
columns = 7
[text]
delimiter = ";"
[header]
skip = 1
[speed]
source = "none"
[[column]]
quantity = "time"
position = 2
unit = "s"
[[column]]
quantity = "friction_force"
position = 3
unit = "N"
[[value]]
name = "turns_stated"
pattern = '^(?:[\\d.]+\\s+){7}([\\d.]+)'
unit = "rev/s"
to = "rad/s"
[[derived]]
quantity = "sliding_velocity"
formula = "turns_stated * '15 mm'"
"""


def disc(path: Path, header: str, *, velocity: bool = False) -> Path:
    """Write two minutes on a disc that runs out by 5 %, 20 rows a second."""
    rng = np.random.default_rng(0)
    time = np.arange(0, 120, 0.05)
    angle = 2 * np.pi * TURNS * time
    mu = 0.3 * (1 + 0.05 * np.sin(angle + 0.3) + 0.02 * np.sin(2 * angle))
    force, load = (x + 0.02 * rng.standard_normal(time.size) for x in (10 * mu, 10.0))
    columns = [time, force, load]
    names = "Time [s],Friction force [N],Normal force [N]"
    if velocity:
        columns.append(np.full(time.size, 2e3 * np.pi * TURNS * 0.015))
        names += ",Velocity [mm/s]"
    np.savetxt(path, np.stack(columns, 1), "%.6g", ",", header=header + names, comments="")
    return path


@pytest.mark.parametrize("velocity", [False, True])
@pytest.mark.parametrize("header", HEADERS.values(), ids=HEADERS)
def test_a_stated_rotation_makes_a_repeated_wave_run_out(
    tmp_path: Path, header: str, velocity: bool
) -> None:
    run = tl.read(disc(tmp_path / "disc.csv", header, velocity=velocity))
    np.testing.assert_allclose(run["rotation_speed"].values, 2 * np.pi * TURNS)
    segments = tl.find_segments(run)
    assert segments["sliding_speed"].values == pytest.approx(2 * np.pi * TURNS * 0.015, rel=1e-3)
    slip = tl.stick_slip(run, segments)
    assert slip["waveform"].item() == "smooth sliding"
    assert "run-out: repeats once" in slip["instrument"].item()


def test_run_out_of_a_real_disc_is_no_stick_slip(shared_data: Path, tmp_path: Path) -> None:
    dialect = tmp_path / "newport.toml"
    dialect.write_text(NEWPORT, encoding="utf-8")
    run = tl.read(shared_data / "newport_disc_torque_MIT" / "1rps10N.txt", instrument=dialect)
    segments = tl.find_segments(run)
    slip = tl.stick_slip(run, segments)
    assert slip["waveform"].item() == "smooth sliding"
    assert slip["instrument"].item() == "run-out: repeats once a turn"
    unknown = tl.stick_slip(run.drop_vars("rotation_speed").drop_attrs(), segments)
    assert unknown["waveform"].item() == "sinus-like oscillation"
