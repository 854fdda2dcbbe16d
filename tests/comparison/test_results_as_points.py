"""Tables of results, as rheometers write them: each row a point of the curve, from file to page."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

import tribolab as tl
from tribolab.app.run import run_campaign
from tribolab.qc.run.checks import check_run

SPEED = np.geomspace(0.1, 1000, 25)  # mm/s
CAMPAIGN = '[campaign]\nname = "oil"\n\n[[surface]]\nname = "PDMS"\n\n[medium.oil]\n\n'
CAMPAIGN += '[[run]]\nfiles = "*.csv"\nsurface = "PDMS"\nmedium = "oil"\n'


def table(seed):
    rng = np.random.default_rng(seed)
    mu = 0.1 / (1 + SPEED / 50) + 0.01
    read = mu * (1 + 0.02 * rng.standard_normal(mu.size))
    rows = (f"{k};{v:.4g};{m:.5f};5.0" for k, (v, m) in enumerate(zip(SPEED, read, strict=True)))
    head = "Sample: oil\n\nPoint;Sliding speed [mm/s];Friction factor [-];Normal force [N]\n"
    return head + "\n".join(rows) + "\n", mu


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("points")
    (place / "raw").mkdir()
    for seed in range(3):
        (place / "raw" / f"{'abc'[seed]}.csv").write_text(table(seed)[0])
    (place / "campaign.toml").write_text(CAMPAIGN)
    run_campaign(place, figures="none")
    return place


def test_repeats_make_the_error_of_the_curve(folder):
    curve = pd.read_csv(folder / "results" / "tables" / "stribeck.csv")
    np.testing.assert_allclose(1e3 * curve.sliding_speed_m_s, SPEED, rtol=1e-3)
    off = curve.friction_coefficient - table(0)[1]
    assert (off.abs() < curve.friction_coefficient_U95).mean() > 0.8
    assert (curve.friction_coefficient_u > 0).all() and (curve.segments == 3).all()


def test_nothing_fails_for_want_of_samples_and_the_notes_say_what_the_rows_are(folder):
    told = pd.read_csv(folder / "results" / "tables" / "checks.csv")
    assert not (told.status == "error").any()
    assert told.message.str.contains("each row is a result").sum() == 3


def test_of_a_single_run_no_error_is_known_and_none_is_invented(folder, tmp_path):
    (tmp_path / "raw").mkdir()
    shutil.copy(folder / "raw" / "a.csv", tmp_path / "raw")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    run_campaign(tmp_path, figures="none")
    curve = pd.read_csv(tmp_path / "results" / "tables" / "stribeck.csv")
    assert len(curve) == SPEED.size
    for end in ("sem", "u", "U95"):
        assert curve[f"friction_coefficient_{end}"].isna().all()
    said = json.loads((tmp_path / "results" / "report.json").read_text("utf-8"))["curves"]
    assert said and not any("no normal force" in each["uncertainty_says"] for each in said)
    budget = pd.read_csv(tmp_path / "results" / "tables" / "uncertainty_budget.csv")
    assert budget.share.isna().all()


def test_sweeps_up_and_down_are_points_and_what_looks_at_samples_is_skipped(tmp_path):
    both = np.concatenate([SPEED, SPEED[::-1]])
    rows = "\n".join(f"{10 * k};{v:.5g};{0.2 + k / 1000};5" for k, v in enumerate(both))
    head = "Time [s];Sliding speed [mm/s];COF;Load [N]\n"
    (tmp_path / "sweep.csv").write_text(head + rows + "\n")
    run = tl.read(tmp_path / "sweep.csv")
    assert tl.find_segments(run).sizes["segment"] == 50
    found = check_run(run).table
    skipped = found[found.message.str.contains("its rows are results")].check
    assert {"stuck", "spikes", "sampling", "hum"} <= set(skipped)


def test_rows_of_either_kind_are_samples_where_a_speed_is_held(tmp_path):
    swept = np.geomspace(0.1, 100, 40)
    held = np.repeat([1.0, 3.0, 9.0], 40)
    for name, speed in {"swept": swept, "held": held}.items():
        rows = "\n".join(f"{k};{v:.5g};{0.3 + 0.001 * (k % 3)};5" for k, v in enumerate(speed))
        head = "Time [s];Sliding speed [mm/s];COF;Load [N]\n"
        (tmp_path / f"{name}.csv").write_text(head + rows + "\n")
    run = tl.read(tmp_path / "held.csv")
    either = {name: tl.read(tmp_path / f"{name}.csv") for name in ("swept", "held")}
    either = {name: run.assign_attrs(rows_are="either") for name, run in either.items()}
    assert tl.find_segments(either["swept"]).sizes["segment"] == 40
    found = tl.find_segments(either["held"])
    assert found.equals(tl.find_segments(run)) and found.attrs["rows_are"] == "either"
