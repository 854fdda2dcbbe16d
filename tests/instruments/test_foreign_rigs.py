"""Rigs known by little: a crank by stroke and frequency, a load by its set-point."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ConfigError

DIALECT = """
name = "crank"
title = "a crank"
[recognise]
header = ["Friction", "Set load"]
[text]
delimiter = ","
[header]
pattern = "^Time"
units = "brackets"
[speed]
source = "stroke"
stroke = "4 mm"
frequency = "2.5 Hz"
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "friction_force"
name = "Friction"
[[column]]
quantity = "normal_force"
name = "Set load"
"""


@pytest.fixture(scope="module")
def crank(tmp_path_factory):
    """Make a run of a crank: 20 strokes, a load that is set to 20 N."""
    rng = np.random.default_rng(3)
    folder = tmp_path_factory.mktemp("crank")
    time = np.arange(4000) / 500
    force = 6 * np.tanh(np.cos(5 * np.pi * time) / 0.05) + 0.06 * rng.standard_normal(time.size)
    table = np.column_stack([time, force, np.full(time.size, 20.0)])
    head = "Time [s],Friction [N],Set load [N]"
    np.savetxt(folder / "a.csv", table, "%.4f", ",", header=head, comments="")
    (folder / "crank.toml").write_text(DIALECT)
    return folder


def stuck_load(run):
    table = tl.check(run).table
    return table.query("check == 'stuck' and variable == 'normal_force'").iloc[0]


def test_the_checks_look_at_the_strokes_of_a_crank(crank):
    run = tl.read(crank / "a.csv", instrument=crank / "crank.toml")
    rows = tl.check(run).table.query("check == 'segments'")
    assert set(rows.status) == {"pass"}
    assert "at rest" not in set(tl.find_segments(run).omitted_reason.values)


def test_a_set_load_is_doubted_and_a_dead_one_is_stuck(crank):
    run = tl.read(crank / "a.csv", instrument=crank / "crank.toml")
    told = stuck_load(run)
    assert told.status == "suspect"
    assert "a set-point or a dead sensor" in told.message and "set_normal_force" in told.message
    load = run["normal_force"].values.copy()
    load[:1000] += 0.1 * np.sin(np.arange(1000.0))  # alive before it stood still
    assert stuck_load(run.assign(normal_force=("time", load))).status == "fail"
    assert stuck_load(run.assign(normal_force=("time", 0 * load))).status == "fail"
    both_still = run.assign(
        normal_force=("time", 0 * load + 20), friction_force=("time", 0 * load + 6)
    )
    assert stuck_load(both_still).status == "fail"


@pytest.mark.parametrize(
    ("right", "wrong"),
    [('"4 mm"', '"4 N"'), ('name = "Friction"', 'name = "Friction"\nzero_uncertainty = "1 mm"')],
)
def test_a_wrong_unit_names_the_dialect_and_the_key(crank, right, wrong):
    file = crank / "wrong.toml"
    file.write_text(DIALECT.replace(right, wrong))
    with pytest.raises(ConfigError, match=r"wrong\.toml: .*(stroke|zero_uncertainty): unit '"):
        tl.read(crank / "a.csv", instrument=file)
