"""The load of a run that states none is the measured one, the same for repeats."""

import numpy as np
import pytest
from dialects import dialect_of

from tribolab.campaign.pipeline import process
from tribolab.campaign.runs.loads import RunLoad, load_of
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.wording import force_text, load_text
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.reading.unknown_run import read_run

DIALECT = dialect_of("plain", time="t", friction_force="F", normal_force="N", sliding_velocity="v")
CAMPAIGN = """
[campaign]
name = "Loads"
[[surface]]
name = "steel"
[medium.oil]
[[run]]
files = "m*.csv"
surface = "steel"
medium = "oil"
instrument = "plain.toml"
"""
STATED = """
[[run]]
files = "s*.csv"
surface = "steel"
medium = "oil"
instrument = "plain.toml"
normal_force = "15 N"
"""


def by_load(load):
    return 0.2 * (load / 20) ** -0.1


def rows_of(loads, seed, mu=lambda load: 0.2):
    rng = np.random.default_rng(seed)
    steps = np.repeat(loads, 400)
    force, load = np.stack([mu(steps) * steps, steps]) + 0.01 * rng.standard_normal((2, steps.size))
    speed = np.repeat(np.arange(1, len(loads) + 1), 400)
    signals = zip(np.arange(steps.size) / 20, force, load, speed, strict=True)
    return "t [s],F [N],N [N],v [mm/s]\n" + "".join(
        f"{t:.3f},{f:.4f},{n:.4f},{v}\n" for t, f, n, v in signals
    )


def analysed(folder, campaign=CAMPAIGN, previous=None, mu=lambda load: 0.2, **files):
    raw = folder / "raw"
    raw.mkdir(exist_ok=True, parents=True)
    for seed, (name, loads) in enumerate(files.items()):
        (raw / f"{name}.csv").write_text(rows_of(loads, seed, mu))
    (folder / "plain.toml").write_text(DIALECT)
    (folder / "campaign.toml").write_text(campaign)
    results = folder / f"results{len(list(folder.glob('results*')))}"
    results.mkdir()
    return process(load_campaign(folder), results, previous=previous)


def loads(outcome):
    return {run.name: (run.normal_force, run.load_from) for run in outcome.runs}


def test_repeats_have_one_measured_load_and_another_load_is_another_curve(tmp_path):
    outcome = analysed(tmp_path, m1=[14.9, 14.95], m2=[15.2, 15.2], m3=[30.1, 29.9])
    (light, low), (again, _), (heavy, high) = loads(outcome).values()
    assert light == again == pytest.approx(15.1, abs=0.05) and low == high == "measured"
    assert heavy == pytest.approx(30, abs=0.1)
    assert [(c.normal_force, c.load_from, len(c.run_names)) for c in outcome.curves] == [
        (light, "measured", 2),
        (heavy, "measured", 1),
    ]
    # as results that are taken over, and with a repeat more
    outcome.store.save()
    (tmp_path / "raw" / "m4.csv").write_text(rows_of([15.6, 15.6], 9))
    more = analysed(tmp_path, previous=outcome.folder)
    assert [run.reused for run in more.runs] == [True, True, True, False]
    assert len({run.normal_force for run in more.runs}) == 2
    kept = {run.name: run.normal_force for run in more.store.outcomes("run", type(more.runs[0]))}
    assert kept == {run.name: run.normal_force for run in more.runs}


def test_a_measured_load_joins_that_which_a_repeat_states(tmp_path):
    outcome = analysed(tmp_path, CAMPAIGN + STATED, m1=[14.9, 14.95], s1=[15.2, 15.2])
    assert loads(outcome) == {"m1": (15.0, "measured"), "s1": (15.0, "stated")}
    [curve] = outcome.curves
    assert (curve.normal_force, curve.load_from) == (15.0, "stated")


def test_a_run_under_several_loads_is_part_of_a_curve_of_each(tmp_path):
    """Friction falls with load: one curve of both would hold neither."""
    two = [10.0, 10.05, 20.0, 20.1]
    outcome = analysed(tmp_path, mu=by_load, m1=two, m2=[20.3, 20.3, 20.3, 20.3])
    [(of_both, said), (heavy, _)] = loads(outcome).values()
    assert (of_both, said) == (None, "varies")
    light, other = outcome.curves
    assert light.normal_force == pytest.approx(10.0, abs=0.05) and light.run_names == ("m1",)
    assert other.normal_force == heavy and other.run_names == ("m1", "m2")
    assert light.load_from == other.load_from == "measured"
    for curve in (light, other):
        measured = read_netcdf(outcome.folder / curve.data_file)["friction_coefficient"]
        truth = by_load(curve.normal_force)
        assert measured.values == pytest.approx(np.full(measured.size, truth), abs=0.002)
        assert measured.size == (2 if curve is light else 4)
    # taken over, and with a repeat more, which moves the label of one level
    outcome.store.save()
    (tmp_path / "raw" / "m3.csv").write_text(rows_of([20.9] * 4, 9, by_load))
    more = analysed(tmp_path, previous=outcome.folder)
    assert [run.reused for run in more.runs] == [True, True, False]
    assert [len(curve.run_names) for curve in more.curves] == [1, 3]


def test_a_load_that_rises_all_the_time_has_no_levels_and_says_so(tmp_path):
    outcome = analysed(tmp_path, m1=[10.0, 10.8, 11.6, 12.4])
    assert loads(outcome) == {"m1": (None, "varies")}
    [curve] = outcome.curves
    assert (curve.normal_force, curve.load_from) == (None, "varies")
    assert load_text(*loads(outcome)["m1"]) == "several loads" != force_text(None)


@pytest.mark.parametrize(
    ("loads", "known"),
    [
        ([10.0] * 4, RunLoad(10.0, "stated", None)),
        ([10.0, 10.0, 20.0, 20.0], RunLoad(None, "stated", None, (10.0, 20.0))),
    ],
)
def test_a_load_of_set_points_is_not_called_measured(tmp_path, loads, known):
    head, *rows = rows_of(loads, 3).splitlines()
    cells = [row.split(",") for row in rows]
    rows = [f"{t},{f},{round(float(n), -1)},{v}" for t, f, n, v in cells]
    text = "\n".join([head.replace("N [N]", "Set normal force [N]"), *rows])
    (tmp_path / "a.csv").write_text(text.replace("F [N]", "Friction force [N]") + "\n")
    run = read_run(tmp_path / "a.csv")
    assert load_of(None, run, friction_coefficient(run, find_segments(run))) == known
    assert load_text(None, "stated") == "several loads"
