"""A zero that is read at one place of a file, or in a blank run, is taken off, and in doubt."""

from __future__ import annotations

import numpy as np
import pytest
from dialects import dialect_of

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError, UnitError

DIALECT = dialect_of("cell", time="t", sliding_velocity="v", friction_force="F", normal_force="L")
MU, LOAD, ZERO = 0.3, 10.0, 1.7


def write(folder, name, force, speed, more=""):
    rng = np.random.default_rng(len(name))
    time = 0.01 * np.arange(force.size)
    noisy = force + 0.01 * rng.standard_normal(force.size)
    table = np.column_stack([time, speed, noisy, np.full(force.size, LOAD)])
    head = "t [s],v [mm/s],F [N],L [N]"
    np.savetxt(folder / name, table, delimiter=",", header=head, comments="")
    (folder / "cell.toml").write_text(DIALECT + more)
    return folder / name, folder / "cell.toml"


def one_way(folder, more=""):
    """One stroke one way from second 4 on, loaded from the start: nothing else tells the zero."""
    speed = np.r_[np.zeros(400), np.ones(2000)]
    force = ZERO + np.where(speed > 0, MU * LOAD, 0.0)
    return write(folder, "run.csv", force, speed, more)


@pytest.mark.parametrize("zero", ["first 300 samples", "first 3 s", "0.5 s to 3.5 s", "file b.csv"])
def test_the_zero_is_taken_off_where_it_is_read(tmp_path, zero):
    path, dialect = one_way(tmp_path)
    write(tmp_path, "b.csv", np.full(500, ZERO), np.zeros(500))
    run = tl.read(path, dialect, zero=zero)
    assert run.attrs["friction_force_zero_N"] == pytest.approx(ZERO, abs=2e-3)
    assert 3e-4 < run.attrs["friction_force_zero_sem_N"] < 1e-3
    segments = tl.find_segments(run)
    friction = tl.friction_coefficient(run, segments)
    (error,) = (friction["friction_coefficient"] - MU) / friction["friction_coefficient_sem"]
    assert abs(float(error)) < 3
    assert friction["zero_from"].values[0] == f"read from {zero}"
    (row,) = [r for r in tl.check(run, segments).rows if r["check"] == "zero_reference"]
    assert row["status"] == "suspect" and "drifted from there" in row["message"]


def test_a_stated_drift_settles_the_doubt_and_is_in_the_error(tmp_path):
    more = DIALECT.index('name = "F"') + len('name = "F"\n')
    text = 'zero = "first 3 s"\nzero_uncertainty = "0.1 N"\n'
    path, dialect = one_way(tmp_path)
    dialect.write_text(DIALECT[:more] + text + DIALECT[more:])
    run = tl.read(path, dialect)
    segments = tl.find_segments(run)
    friction = tl.friction_coefficient(run, segments)
    assert friction["friction_coefficient_sem"].values == pytest.approx([0.1 / LOAD], rel=0.05)
    rows = tl.check(run, segments).rows
    assert not [r for r in rows if r["check"] == "zero_reference" and r["status"] == "suspect"]


@pytest.mark.parametrize(
    ("zero", "kind", "said"),
    [
        ("somewhere", UnitError, "does not say where the zero is read"),
        ("first 3 N", UnitError, "cannot be turned"),
        ("first 4 samples", ReadError, "holds 4 numbers, and 10 are needed"),
        ("50 s to 60 s", ReadError, "holds 0 numbers"),
        ("file missing.csv", ReadError, "missing.csv"),
    ],
)
def test_a_zero_that_cannot_be_read_is_an_error(tmp_path, zero, kind, said):
    with pytest.raises(kind, match=said):
        tl.read(*one_way(tmp_path), zero=zero)


def test_a_dialect_says_where_a_zero_can_be_read(tmp_path):
    path, dialect = one_way(tmp_path)
    dialect.write_text(DIALECT.replace('name = "F"', 'name = "F"\nzero = "at dawn"'))
    with pytest.raises(ConfigError, match="at dawn"):
        tl.read(path, dialect)
