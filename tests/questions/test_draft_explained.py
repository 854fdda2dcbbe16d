"""What the text above a table says of its columns, and of what lies between motor and sensor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect

TIME = 0.05 * np.arange(600)
FRICTION = 4.0 + 0.02 * np.sin(TIME)
LOAD = 25.0 + 0.05 * np.cos(TIME)
ACROSS = 0.3 + 0.1 * np.sin(3 * TIME)


def written(folder: Path, head: str, names: str, *columns: np.ndarray, name: str = "a.txt") -> Path:
    rows = "\n".join("\t".join(f"{x:.4f}" for x in row) for row in zip(*columns, strict=True))
    (folder / name).write_text(f"{head}\n{names}\n{rows}\n", "utf-8")
    return folder / name


@pytest.mark.parametrize(
    "head",
    [
        "Fx = vertical (normal) force; Fy = radial; Fz = tangential\nSliding speed: 20 mm/s",
        "Fx = Normalkraft; Fy = Querkraft; Fz = Reibkraft\nGleitgeschwindigkeit: 20 mm/s",
    ],
)
def test_axes_are_what_the_text_says_and_not_what_their_names_usually_mean(
    tmp_path: Path, head: str
) -> None:
    names = "Time [s]\tFx [N]\tFy [N]\tFz [N]"
    run = tl.read(written(tmp_path, head, names, TIME, LOAD, ACROSS, FRICTION))
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-4)
    np.testing.assert_allclose(run.normal_force, LOAD, atol=1e-4)
    assert "Fy" in run.attrs["columns_not_used"]


def test_axes_whose_explanation_is_not_known_are_asked_about(tmp_path: Path) -> None:
    head = "Fx = kwaad; Fz = blorp\nSliding speed: 20 mm/s"
    file = written(tmp_path, head, "Time [s]\tFx [N]\tFz [N]", TIME, FRICTION, LOAD)
    with pytest.raises(ReadError, match="the text names it: 'kwaad', in words that are not known"):
        tl.read(file)
    plain = written(
        tmp_path, "Sliding speed: 20 mm/s", "Time [s]\tFx [N]\tFz [N]", TIME, FRICTION, LOAD
    )
    np.testing.assert_allclose(tl.read(plain).friction_force, FRICTION, atol=1e-4)


def test_a_column_of_force_that_the_text_speaks_of_is_not_passed_over(tmp_path: Path) -> None:
    head = "Comp. T: friction of the bearings, to be taken off\nSliding speed: 20 mm/s"
    names = "Time [s]\tFriction force [N]\tNormal force [N]\tComp. T [N]"
    columns = TIME, FRICTION, LOAD, ACROSS
    with pytest.raises(ReadError, match=r"column 4 'Comp\. T' is not used, of which the text says"):
        tl.read(written(tmp_path, head, names, *columns))
    silent = written(tmp_path, "Sliding speed: 20 mm/s", names, *columns)
    np.testing.assert_allclose(tl.read(silent).friction_force, FRICTION, atol=1e-4)


@pytest.mark.parametrize(
    ("line", "asked"),
    [
        ("Getriebe 5:1", True),
        ("Gear ratio: 5:1", True),
        ("przekładnia 5:1", True),
        ("增益: 2", True),
        ("Verstärkung: 10", True),
        ("Gear ratio: 1:1", False),
        ("Gain: 1", False),
        ("Programme 5:1", False),
    ],
)
def test_a_gear_or_an_amplifier_that_the_signals_may_miss_is_asked_about(
    tmp_path: Path, line: str, asked: bool
) -> None:
    head = f"Radius: 20 mm\n{line}"
    names = "Time [s]\tRotation [rpm]\tFriction force [N]\tNormal force [N]"
    file = written(tmp_path, head, names, TIME, np.full(TIME.size, 60.0), FRICTION, LOAD)
    if asked:
        with pytest.raises(ReadError, match="signals are read as they stand, not times"):
            tl.read(file)
        return
    speed = tl.read(file).sliding_velocity
    np.testing.assert_allclose(np.abs(speed), 2 * np.pi * 0.02, rtol=1e-6)


@pytest.mark.parametrize(
    ("wanted", "found"), [("Last satt", "Last målt"), ("Soll-Last", "Ist-Last")]
)
def test_of_what_was_wanted_and_what_was_measured_the_latter_is_the_load(
    tmp_path: Path, wanted: str, found: str
) -> None:
    names = f"Time [s]\tFriction force [N]\t{wanted} [N]\t{found} [N]"
    wish = np.full(TIME.size, 24.0)
    file = written(tmp_path, "Sliding speed: 20 mm/s", names, TIME, FRICTION, wish, LOAD)
    np.testing.assert_allclose(tl.read(file).normal_force, LOAD, atol=1e-4)
    columns = draft_dialect(file).understood.columns
    assert columns[2].quantity in (None, "set_normal_force")
