"""Planning: formulas against their closed forms, plans followed by simulation."""

import math

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.comparison.planning import plan_text
from tribolab.comparison.planning_page import write_plan
from tribolab.metrology.planning import (
    Pilot,
    cheapest_sliding_time,
    run_variance,
    runs_for_half_interval,
    runs_for_standard_error,
)


def test_a_run_that_slides_for_long_or_not_at_all():
    pilot = Pilot(within=0.1, memory=0.5, between=0.02)
    assert run_variance(pilot, 1e6) == pytest.approx(0.02**2 + 2 * 0.5 * 0.1**2 / 1e6, rel=1e-5)
    assert run_variance(pilot, 1e-6) == pytest.approx(0.02**2 + 0.1**2, rel=1e-5)


def test_the_variance_of_a_mean_is_that_of_simulated_signals():
    rng = np.random.default_rng(1)
    tau, step, samples = 0.4, 0.02, 100  # T = 2 s: no more than five memories
    phi = math.exp(-step / tau)
    x = np.empty((20_000, samples))
    x[:, 0] = rng.normal(size=len(x))
    for k in range(1, samples):
        x[:, k] = phi * x[:, k - 1] + math.sqrt(1 - phi**2) * rng.normal(size=len(x))
    assert x.mean(axis=1).var() == pytest.approx(run_variance(Pilot(1.0, tau, 0.0), 2.0), rel=0.04)


def test_half_an_interval_is_students():
    # n from the tables of Student's t: 0.975 quantile of 6 degrees of freedom is 2.447
    assert runs_for_half_interval(1.0, 2.447 / math.sqrt(7) + 1e-4) == 7
    assert runs_for_half_interval(1.0, 2.447 / math.sqrt(7) - 1e-3) == 8
    assert runs_for_standard_error(1.0, 1e-6) is None


def test_assurance_takes_the_pilots_own_error_in():
    from scipy import stats

    rng = np.random.default_rng(9)
    runs = runs_for_standard_error(1.0, 0.2, 0.8, 6)
    pilots = rng.chisquare(5, 40_000) / 5  # variances that pilots of six tell of a true one
    worst = stats.f.ppf(0.8, runs - 1, 5)
    later = rng.chisquare(runs - 1, 40_000) / (runs - 1)
    assert np.mean(later <= pilots * worst) == pytest.approx(0.8, abs=0.01)
    assert runs > runs_for_standard_error(1.0, 0.2, 0.8) > runs_for_standard_error(1.0, 0.2)


def test_a_pilot_of_three_runs_may_have_found_half():
    # its 80 % upper bound of the spread is 2.1 times what it found: so are the runs, squared
    sure = runs_for_standard_error(1.0, 0.1, 0.8, 3)
    assert math.sqrt(sure / 100) == pytest.approx(2.1, abs=0.03)
    as_likely_as_not = runs_for_standard_error(1.0, 0.1, None, 3)
    assert as_likely_as_not / 100 == pytest.approx(1.44, abs=0.03)  # 2 over the median of chi^2_2


def test_the_cheapest_time_is_that_of_the_closed_form():
    pilot = Pilot(within=0.2, memory=0.3, between=0.01)
    closed = math.sqrt(1200 * 2 * 0.3 * 0.2**2 / 0.01**2)
    assert cheapest_sliding_time(pilot, 1200.0, 1e5) == pytest.approx(closed, rel=0.01)
    assert cheapest_sliding_time(pilot, 1200.0, 60.0) == pytest.approx(60.0, rel=1e-3)


def pilot_table(rng, runs, between, within=0.02, memory=0.5, time=100.0):
    """A pilot as the analysis would tell of it: what is known along a run, means that scatter."""
    means = 0.5 + rng.normal(0, math.sqrt(run_variance(Pilot(within, memory, between), time)), runs)
    return pd.DataFrame(
        {
            "run": [f"r{k}" for k in range(runs)],
            "sliding_speed_m_s": 1e-3,
            "friction_coefficient": means,
            "friction_coefficient_std": within,
            "autocorrelation_time_s": memory,
            "trimmed_start_s": 0.0,
            "trimmed_stop_s": time,
        }
    )


@pytest.mark.slow
def test_a_plan_that_is_followed_reaches_its_precision():
    rng = np.random.default_rng(2)
    reached = {"runs": [], "assured_runs": []}
    for _ in range(200):
        plan = tl.comparison.measuring_plan(pilot_table(rng, 4, 0.01), standard_error=0.002)
        for name, errors in reached.items():
            runs = int(plan.table[name][0])
            later = pilot_table(rng, runs, 0.01).friction_coefficient
            errors.append(later.std(ddof=1) / math.sqrt(runs))
    assert np.median(reached["runs"]) == pytest.approx(0.002, rel=0.1)
    sure = np.mean(np.array(reached["assured_runs"]) <= 0.002)
    assert sure == pytest.approx(0.8, abs=3 * math.sqrt(0.16 / 200))


def test_a_goal_out_of_reach_is_no_success_and_a_goal_in_reach_is_named(tmp_path):
    table = pilot_table(np.random.default_rng(3), 4, 0.01)
    plan = tl.comparison.measuring_plan(table, standard_error=1e-5)
    text = plan_text(plan)
    assert text.startswith("standard error of 1e-05: not achievable at 1 of 1 point")
    within = float(text.split("10 runs reach ")[1].split(". ")[0])
    assert tl.comparison.measuring_plan(table, standard_error=1.1 * within).table.runs.max() <= 20
    assert 'class="banner incomplete"' in write_plan(plan, "p", tmp_path).read_text("utf-8")
    reached = tl.comparison.measuring_plan(table, standard_error=0.01)
    assert reached._repr_html_().count("<tr") == 1 + len(reached.table)
    assert 'class="banner complete"' in write_plan(reached, "p", tmp_path).read_text("utf-8")


def test_a_plan_asks_for_one_precision_and_for_two_runs(tmp_path):
    table = pilot_table(np.random.default_rng(3), 4, 0.01)
    with pytest.raises(tl.TribolabError, match="state one precision"):
        tl.comparison.measuring_plan(table, standard_error=0.1, half_interval=0.1)
    with pytest.raises(tl.TribolabError, match="no condition and speed has two runs"):
        tl.comparison.measuring_plan(table.head(1), standard_error=0.1)
    with pytest.raises(tl.TribolabError, match="an assurance of 1.5"):
        tl.comparison.measuring_plan(table, standard_error=0.1, assurance=1.5)


def test_the_command_plans_after_a_campaign(original, tmp_path):
    words = ["lab", "plan", str(original.parent / "results"), "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(cli.app, [*words, "--half-interval", "0.02"])
    assert done.exit_code == 0, done.output
    assert "reach it with a chance of 50 %" in done.stdout
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"plan.html", "plan.csv"}
    old = CliRunner().invoke(cli.app, [*words[1:], "--standard-error", "0.01"])
    assert old.exit_code == 0 and "write 'tribolab lab plan'" in old.stderr
    assert "--standard-error will be removed in the next release" in old.stderr
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 2 and "--half-interval" in done.stderr
