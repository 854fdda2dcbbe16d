"""Control charts: published ones, run lengths, and instruments over simulated months."""

import datetime as dt
import json
import shutil
import time

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.comparison.history_page import history_verdict, write_history
from tribolab.comparison.instrument_history import history_of
from tribolab.comparison.watched import GAIN, REFERENCE, Observation, observations_of
from tribolab.metrology.control_charts import (
    CUSUM,
    EWMA,
    RULES,
    SHEWHART,
    WESTERN,
    Baseline,
    baseline_of,
    control_chart,
    cusums,
    mean_moving_range,
)
from tribolab.metrology.recalibration import recalibration_due
from tribolab.metrology.run_length import average_run_length, signal_probability

# NIST/SEMATECH handbook, 6.3.2.2 (flow rates), 6.3.2.3 (CUSUM) and 6.3.2.4 (EWMA)
FLOWS = [49.6, 47.6, 49.9, 51.3, 47.8, 51.2, 52.6, 52.4, 53.6, 52.1]
CUSUM_DATA = [
    324.925, 324.675, 324.725, 324.350, 325.350, 325.225, 324.125, 324.525, 325.225, 324.600,
    324.625, 325.150, 328.325, 327.250, 327.825, 328.500, 326.675, 327.775, 326.875, 328.350,
]  # fmt: skip
EWMA_DATA = [
    52.0, 47.0, 53.0, 49.3, 50.1, 47.0, 51.0, 50.1, 51.2, 50.5, 49.6, 47.6, 49.9, 51.3, 47.8,
    51.2, 52.6, 52.4, 53.6, 52.1,
]  # fmt: skip


def test_the_published_chart_of_individuals():
    values = np.array(FLOWS)
    # the handbook's 2.66 is 3/1.128
    sigma = mean_moving_range(values)
    chart = control_chart(values, Baseline(float(values.mean()), sigma), [SHEWHART])
    assert (chart.high, chart.low) == pytest.approx((55.80, 45.82), abs=0.03)
    assert not chart.any_signal.any()


def test_the_published_ewma_chart():
    # target 50 and sigma 2.0539 of earlier data, weight 0.3, limits of 3 deviations
    z, last = [], 50.0
    for value in EWMA_DATA:
        last = 0.3 * value + 0.7 * last
        z.append(last)
    assert z[:3] == pytest.approx([50.60, 49.52, 50.56], abs=0.006), "as it is printed"
    width = 3 * 2.0539 * np.sqrt(0.3 / 1.7)
    assert (50 + width, 50 - width) == pytest.approx((52.59, 47.41), abs=0.005)
    ours = control_chart(EWMA_DATA, Baseline(50.0, 2.0539), [EWMA])
    last = 50.0
    for value, smoothed in zip(EWMA_DATA, ours.smoothed, strict=True):
        last = 0.2 * value + 0.8 * last
        assert smoothed == pytest.approx(last)
    width = 2.86 * 2.0539 * np.sqrt(0.2 / 1.8)
    assert ours.smoothed_high[-1] == pytest.approx(50 + width, rel=1e-3)
    assert not ours.any_signal.any(), "nor does the published one"


def test_the_published_cusum_signals_at_the_fourteenth():
    # k = 0.3175 and h = 4.1959, in the units of the data, about 325
    up, down = cusums(np.array([CUSUM_DATA]) - 325, slack=0.3175)
    assert up[0][:13].max() < 4.1959 < up[0][13] and down.max() < 4.1959
    assert up[0][12:14] == pytest.approx([3.0075, 4.9400], abs=5e-4)
    ours = control_chart(CUSUM_DATA, Baseline(325.0, 0.635), [CUSUM])
    assert ours.signals[CUSUM].argmax() in (12, 13)


@pytest.mark.parametrize(
    "rules, known", [([SHEWHART], 370.4), ([EWMA], 371), ([CUSUM], 370), ([WESTERN], 91.75)]
)
def test_published_run_lengths_without_a_cause(rules, known):
    assert average_run_length(rules) == pytest.approx(known, rel=0.05)


def test_published_run_lengths_after_a_step_of_one_sigma():
    # Montgomery: Shewhart 44; Lucas and Saccucci: EWMA some 9; Hawkins: CUSUM 9.93 (h = 4.77)
    assert average_run_length([SHEWHART], shift=1.0) == pytest.approx(43.9, rel=0.05)
    assert average_run_length([CUSUM], shift=1.0) == pytest.approx(9.93, rel=0.05)
    assert average_run_length([EWMA], shift=1.0) == pytest.approx(9.3, rel=0.08)


@pytest.mark.parametrize("points, factor", [(10, 4.29), (20, 3.53), (30, 3.33)])
def test_limits_of_few_points_are_as_wide_as_they_have_to_be(points, factor):
    usual = Baseline(0.0, 1.0, points, points - 1)
    chart = control_chart([0.0], usual, [SHEWHART])
    assert chart.high == pytest.approx(factor, abs=0.005)
    # of a new point, and of estimated limits: 0.27 % all the same
    rng = np.random.default_rng(points)
    before, new = rng.normal(size=(200_000, points)), rng.normal(size=200_000)
    score = (new - before.mean(axis=1)) / before.std(axis=1, ddof=1)
    assert (np.abs(score) > chart.high).mean() == pytest.approx(0.0027, abs=4e-4)


def test_correlated_points_are_told():
    rng = np.random.default_rng(1)
    noise, walk = rng.normal(size=60), [0.0]
    for step in noise[1:]:
        walk.append(0.75 * walk[-1] + step)
    assert not baseline_of(noise).correlated
    usual = baseline_of(walk)
    assert usual.correlated and usual.sigma == pytest.approx(np.std(walk, ddof=1))
    assert mean_moving_range(np.array(walk)) < 0.8 * usual.sigma


def test_a_calibration_is_due_by_date_or_by_drift():
    day = dt.date(2026, 1, 1)
    assert recalibration_due(day, 365).date == dt.date(2027, 1, 1)
    days = np.arange(0, 100, 10.0)
    exact = recalibration_due(day, 365, days, 1e-4 * days, 0.02)
    assert exact.date == day + dt.timedelta(days=200) and exact.reason == "drift"
    noisy = 1e-4 * days + 1e-3 * (-1.0) ** np.arange(10)
    assert recalibration_due(day, 365, days, noisy, 0.02).date < exact.date
    assert recalibration_due(day, 90, days, 1e-5 * days, 0.02).reason == "interval"


def months(rng, campaigns, gain_drift=0.0, zero_jump=0.0, at=30):
    """Weekly numbers of one rig: a gain of scatter 0.5 %, a zero of scatter 0.02 N."""
    points = []
    for week in range(campaigns):
        when = dt.datetime(2026, 1, 5) + dt.timedelta(days=7 * week)
        gain = 1 + rng.normal(0, 0.005) + gain_drift * max(0, week - at) * 7 / 30.4
        zero = rng.normal(0, 0.02) + zero_jump * (week >= at)
        for quantity, unit, value in ((GAIN, "1", gain), ("zero", "N", zero)):
            points.append(Observation("slide", quantity, unit, when, f"{week}", value))
    return points


def test_a_drifting_gain_and_a_jumping_zero_are_found():
    told = history_of(months(np.random.default_rng(2), 60, 0.005, 0.1, 25))
    gain, zero = told.charts
    assert 25 <= gain.signals[0] < 40 and 25 <= zero.signals[0] < 30
    assert set(told.table().signal.unique()) - {""} <= {
        "3 sigma", "EWMA", "3 sigma, EWMA",
    }  # fmt: skip


def test_false_alarms_are_as_many_as_the_page_states():
    rng = np.random.default_rng(3)
    charts = [chart for _ in range(150) for chart in history_of(months(rng, 50)).charts]
    wanted = signal_probability(30, baseline=20)
    spread = 3 * np.sqrt(wanted * (1 - wanted) / len(charts))
    assert np.mean([chart.signals.size > 0 for chart in charts]) == pytest.approx(
        wanted, abs=spread
    )


def test_a_speed_that_scatters_between_campaigns_is_one_quantity():
    rng = np.random.default_rng(8)
    days = [dt.datetime(2026, 1, 5) + dt.timedelta(days=7 * week) for week in range(30)]
    points = [
        Observation("rig", REFERENCE, "1", day, "a", rng.normal(0.5, 0.01), speed)
        for day in days
        # 2.15 mm/s stands between two roundings to two digits
        for speed in (1e-4, 2.15e-3 * rng.normal(1, 0.002))
    ]
    charts = history_of(points).charts
    assert [chart.values.size for chart in charts] == [30, 30]
    assert [chart.quantity for chart in charts] == [
        f"{REFERENCE} at 100 µm/s",
        f"{REFERENCE} at 2.15 mm/s",
    ]


def test_a_history_that_judges_nothing_is_no_success(tmp_path):
    told = history_of(months(np.random.default_rng(4), 1))
    text = history_verdict(told)
    assert "no signal" not in text and "Add at least 9 more campaigns" in text
    page = write_history(told, tmp_path / "one").read_text("utf-8")
    assert 'class="banner incomplete"' in page
    enough = history_of(months(np.random.default_rng(4), 10))
    assert any(chart.chart is not None for chart in enough.charts)


def test_too_few_points_are_told_and_rules_are_known():
    told = history_of(months(np.random.default_rng(4), 8))
    assert all("too few" in chart.remark and not chart.signals.size for chart in told.charts)
    with pytest.raises(tl.TribolabError, match="no rule is called 'sigma'"):
        history_of(months(np.random.default_rng(4), 20), rules=["sigma"])
    assert history_of(months(np.random.default_rng(4), 40), rules=RULES).rules == RULES


@pytest.fixture(scope="module")
def archive(original, tmp_path_factory):
    """Results of 24 weeks: copies, whose zero jumps and whose gain is that of a dead weight."""
    folder = tmp_path_factory.mktemp("archive")
    results = original.parent / "results"
    report = json.loads((results / "report.json").read_text("utf-8"))
    report["campaign"]["text"] += (
        '\n[reference]\nfiles = "friction/*.csv"\ndead_weight = "31 N"\n'
        '[calibration]\ndate = 2026-01-01\ninterval = "1 year"\nserial = "7"\n'
    )
    zero = "friction_force_offset_N"
    own = [[row[zero] for row in run["segments"]] for run in report["runs"]]
    rng = np.random.default_rng(5)
    for week in range(24):
        mine = folder / f"week_{week:02}"
        (mine / "tables").mkdir(parents=True)
        off = rng.normal(0, 0.02) + 0.5 * (week >= 20)
        for run, values in zip(report["runs"], own, strict=True):
            for row, value in zip(run["segments"], values, strict=True):
                row[zero] = None if value is None else value + off
        shutil.copy(results / "tables" / "stick_slip.csv", mine / "tables")
        for run in report["runs"]:
            began = dt.datetime(2026, 1, 5) + dt.timedelta(days=7 * week)
            run["recorded_at"] = began.isoformat()
        (mine / "report.json").write_text(json.dumps(report), "utf-8")
    return folder


@pytest.mark.slow
def test_the_command_watches_an_archive_and_ends_with_one_on_a_signal(archive, tmp_path):
    words = ["lab", "history", str(archive), "--baseline", "18", "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 1, done.output
    assert "signals: zero of the friction force\n" in done.stdout
    assert "calibration due 2027-01-01 (interval)" in done.stdout
    told = tl.comparison.history(sorted(archive.iterdir()), baseline=18)
    names = {chart.quantity for chart in told.charts}
    assert {GAIN, "clock shift", "set-point error of the load", "noise of friction"} <= names
    assert any(name.startswith("friction of the reference at ") for name in names)
    [zero] = told.signalling
    assert zero.signals[0] == 20
    assert (tmp_path / "out/history.html").stat().st_size > 10_000
    quiet = ["lab", "history", *map(str, sorted(archive.iterdir())[:20]), "-o", str(tmp_path / "b")]
    assert CliRunner().invoke(cli.app, [*quiet, "--baseline", "18"]).exit_code == 0


def test_a_folder_that_is_no_results_is_left_out_and_told(archive, tmp_path):
    told = tl.comparison.history([archive / "week_00", tmp_path])
    assert len(told.unread) == 1 and "no folder of results" in told.unread[0]
    done = CliRunner().invoke(
        cli.app, ["lab", "history", str(tmp_path), "-o", str(tmp_path / "out")]
    )
    assert done.exit_code == 3


def test_a_results_folder_is_read_in_milliseconds(archive):
    begun = time.process_time()
    for folder in sorted(archive.iterdir()):
        observations_of(folder)
    assert (time.process_time() - begun) / 24 < 0.05
