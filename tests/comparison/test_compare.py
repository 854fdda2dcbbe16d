"""Campaigns beside each other: what differs is called so, what does not is not, what changed is."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest
from campaigns import copied
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.app.run import run_campaign
from tribolab.comparison.calibration_terms import calibration_terms
from tribolab.comparison.comparison import CHANGED, UNCHANGED
from tribolab.comparison.folder import Folder
from tribolab.comparison.run_values import MatchedRuns
from tribolab.metrology.differences import (
    DIFFERENT,
    EQUIVALENT,
    OPEN,
    differences_of_groups,
    verdicts,
)
from tribolab.metrology.resampling import rotation_test


def runs(rng, count, points, offset=0.0):
    """Coefficients of runs at several speeds, bound by what a run has in common."""
    return rng.normal(0.5, 0.01, (count, 1)) + rng.normal(0, 0.01, (count, points)) + offset


def test_welchs_t_is_that_of_scipy():
    from scipy import stats

    rng = np.random.default_rng(0)
    first, second = runs(rng, 5, 7), runs(rng, 8, 7, 0.01)
    compared = differences_of_groups([(first, second)])
    theirs = stats.ttest_ind(second, first, equal_var=False)
    assert compared.p_value == pytest.approx(theirs.pvalue, rel=1e-10)
    low, high = compared.interval(0.95)
    bounds = theirs.confidence_interval(0.95)
    assert low == pytest.approx(bounds.low) and high == pytest.approx(bounds.high)


@pytest.mark.parametrize("count, gaps", [(5, False), (3, False), (3, True)])
def test_a_verdict_its_interval_and_its_p_value_agree(count, gaps):
    rng = np.random.default_rng(7)
    told = []
    for _ in range(40):
        groups = [(runs(rng, count, 4), runs(rng, count, 4, 0.02)) for _ in range(2)]
        if gaps:
            groups[0][0][0, 0] = np.nan
        compared = differences_of_groups(groups)
        outside = (compared.low > 0) | (compared.high < 0)
        assert [word == DIFFERENT for word in verdicts(compared, None)] == outside.tolist()
        assert outside.tolist() == (compared.adjusted_p_value <= 0.05).tolist()
        told.append(outside.mean())
    assert 0 < np.mean(told) < 1


@pytest.mark.parametrize(
    "conditions, count, method",
    [(1, 5, "permutation"), (1, 4, "rotation"), (6, 5, "permutation"), (1, 3, "rotation")],
)
def test_permutations_are_used_where_they_can_tell(conditions, count, method):
    rng = np.random.default_rng(1)
    groups = [(runs(rng, count, 3), runs(rng, count, 3, 0.5)) for _ in range(conditions)]
    compared = differences_of_groups(groups)
    assert set(compared.methods) == {method}
    assert (compared.adjusted_p_value <= 0.05).all(), "no clear difference is lost in their number"


def test_permutations_of_one_condition_are_counted_exactly():
    rng = np.random.default_rng(2)
    compared = differences_of_groups([(runs(rng, 5, 5), runs(rng, 5, 5, 1.0))])
    assert compared.adjusted_p_value == pytest.approx(np.full(5, 2 / 252))


def test_of_one_point_rotations_are_students_t():
    from scipy import stats

    rng = np.random.default_rng(12)
    first, second = runs(rng, 3, 1), runs(rng, 3, 1, 0.02)
    own, _ = rotation_test(
        first, second, np.zeros((0, 1)), np.array([0.05]), np.array([4.0]), 0.05, 0
    )
    # Welch's p of equal scatter and equal numbers is a function of t: how often it is below 5 %
    # is known from Student's t of all four degrees of freedom, over the mixing of the two scatters
    score, share = np.abs(stats.t.rvs(4, size=200_000, random_state=1)), rng.beta(1, 1, 200_000)
    freedom = 2 / (share**2 + (1 - share) ** 2)
    wanted = np.mean(2 * stats.t.sf(score, freedom) <= 0.05)
    assert own[0] == pytest.approx(wanted, abs=4 * np.sqrt(wanted / 2000))


def test_what_the_groups_share_cancels_and_what_they_do_not_counts_for_all_points_at_once():
    rng = np.random.default_rng(13)
    wrong, families, gain = np.zeros(2), 60, 0.02
    for _ in range(families):
        first, second = runs(rng, 4, 6), runs(rng, 4, 6)
        second *= 1 + gain * rng.normal()
        told = [None, [np.full((1, 6), 0.5 * gain)]]
        for place, terms in enumerate(told):
            compared = differences_of_groups([(first, second)], not_in_scatter=terms)
            wrong[place] += (compared.adjusted_p_value <= 0.05).any()
    assert wrong[0] / families > 0.1, "a gain that nobody states is taken for a difference"
    assert wrong[1] / families < 0.05 + 3 * np.sqrt(0.05 * 0.95 / families)


@pytest.mark.slow
def test_one_family_in_twenty_errs_and_together_the_intervals_hold_all():
    rng = np.random.default_rng(3)
    wrong, held, families = 0, 0, 400
    for _ in range(families):
        first, second = runs(rng, 6, 9), runs(rng, 6, 9)
        compared = differences_of_groups([(first, second)])
        wrong += (compared.adjusted_p_value <= 0.05).any()
        held += ((compared.low <= 0) & (compared.high >= 0)).all()
    spread = 3 * np.sqrt(0.05 * 0.95 / families)
    assert 0.02 < wrong / families < 0.05 + spread
    assert 0.95 - spread < held / families < 1


def test_what_the_scatter_does_not_show_widens_the_error():
    rng = np.random.default_rng(4)
    groups = [(runs(rng, 5, 2), runs(rng, 5, 2, 0.03))]
    alone = differences_of_groups(groups)
    whole = differences_of_groups(groups, not_in_scatter=[np.array([[0.0, 0.2]])])
    assert whole.standard_error == pytest.approx(np.hypot(alone.standard_error, [0.0, 0.2]))
    assert whole.adjusted_p_value[1] > 0.5 > alone.adjusted_p_value[1]


def folder_with_budget(path, serial, gain, tilt=0.0, instrument="slide"):
    """A results folder whose curve has a gain of 1 % and, where stated, a tilt of each mount."""
    (path / "tables").mkdir(parents=True)
    rows = [
        {
            "curve": "c",
            "sliding_speed_m_s": speed,
            "part": part,
            "varies": varies,
            "contribution": c,
        }
        for speed, mu in ((1e-4, 0.5), (1e-3, 0.3))
        for part, varies, c in (
            ("friction gain", "calibration", gain * mu),
            ("tilt", "mount", tilt),
            ("resolution", "stroke", 0.001 * bool(gain)),
            ("between runs", "", 0.1),
        )
    ]
    pd.DataFrame(rows).to_csv(path / "tables/uncertainty_budget.csv", index=False)
    runs = [{"name": "a", "status": "done", "instrument": instrument, "files": ["a.csv"]}]
    text = '[campaign]\nname = "x"\n\n'
    text += f'[calibration]\nserial = "{serial}"\n\n[[run]]\nfiles = "*.csv"\n'
    campaign = {"name": "x", "text": text, "sha256": 64 * "0"}
    return Folder(
        path, {"campaign": campaign, "runs": runs, "curves": [{"name": "c", "runs": ["a"]}]}
    )


def test_a_calibration_that_both_share_is_not_in_their_difference_twice(tmp_path):
    speeds = np.array([1.01e-4, 0.99e-3])
    condition = MatchedRuns("x", speeds, np.zeros((1, 2)), np.zeros((1, 2)), ("a",), ("a",))
    first = folder_with_budget(tmp_path / "1", "42", 0.01)
    assert first.campaign is not None and first.campaign.calibration.serial == "42"

    def terms(second):
        made = calibration_terms(condition, first, second)
        return made, np.sqrt((made.terms**2).sum(axis=0))

    own = np.sqrt(2) * 0.001  # of the resolution, of which each point has its own
    made, error = terms(folder_with_budget(tmp_path / "2", "42", 0.01))
    assert error == pytest.approx([own, own]) and made.shared == ("friction gain",)
    made, error = terms(folder_with_budget(tmp_path / "3", "43", 0.01))
    assert error == pytest.approx(np.hypot(own, np.sqrt(2) * 0.01 * np.array([0.5, 0.3])))
    assert made.own == ("friction gain", "resolution") and made.shared == ()
    gains = [row for row in made.terms if row.all()]
    assert np.array(gains) == pytest.approx(0.01 * np.array([[0.5, 0.3], [0.5, 0.3]]))
    made, error = terms(folder_with_budget(tmp_path / "4", "42", 0.01, 0.02))
    assert error == pytest.approx(np.hypot(own, 0.02)), "a tilt of another mount is not shared"
    # of a gain that one of two states while both have the same, the difference knows nothing
    made, error = terms(folder_with_budget(tmp_path / "5", "42", 0.0))
    assert error == pytest.approx([0.001, 0.001]) and "friction gain" not in made.own
    assert calibration_terms(condition, None, first).terms.shape == (0, 2)


def test_three_verdicts():
    rng = np.random.default_rng(5)
    noise = runs(rng, 6, 3, -0.5)
    first, second = noise + [0.5, 0.5, 0.5], runs(rng, 6, 3, -0.5) + [0.5, 0.7, 0.5]
    second[:, 2] += rng.normal(0, 0.2, 6)
    compared = differences_of_groups([(first, second)])
    margin = np.full(3, 0.04)
    assert verdicts(compared, margin) == [EQUIVALENT, DIFFERENT, OPEN]
    assert EQUIVALENT not in verdicts(compared, None)


def test_a_run_that_lacks_a_speed_counts_at_the_others():
    table = pd.DataFrame(
        {
            "run": np.repeat([f"r{k}" for k in range(10)], 2),
            "surface": np.repeat(["a", "b"], 10),
            "sliding_speed_m_s": np.tile([1e-4, 1e-3], 10),
            "friction_coefficient": np.tile([0.4, 0.3], 10)
            + np.random.default_rng(6).normal(0, 0.01, 20),
        }
    )
    points = tl.compare(table.drop(index=1), by="surface").points
    assert points.first_runs.tolist() == [5, 4] and points.second_runs.tolist() == [5, 5]
    with pytest.raises(tl.TribolabError, match="no surface is called 'c'; there is a, b"):
        tl.compare(table, by="surface", levels=("a", "c"))
    with pytest.raises(tl.TribolabError, match="nothing to compare"):
        tl.compare(table, table.assign(surface="other"))


@pytest.fixture(scope="module")
def trimmed(original, tmp_path_factory):
    """Results of the same raw files with another trim."""
    campaign = copied(original, tmp_path_factory.mktemp("trimmed"))
    text = campaign.read_text("utf-8")
    assert "trim = 0.10" in text
    campaign.write_text(text.replace("trim = 0.10", "trim = 0.2"), "utf-8")
    run_campaign(campaign, jobs=1, figures="none")
    return campaign.parent / "results"


def test_two_copies_of_one_results_folder_do_not_differ(original, tmp_path):
    copy = shutil.copytree(original.parent / "results", tmp_path / "copy")
    compared = tl.compare(original.parent / "results", copy)
    assert compared.changes == ()
    assert set(compared.points.verdict) == {UNCHANGED} and (compared.points.difference == 0).all()
    assert (compared.quantities.difference == 0).all()


@pytest.mark.slow
def test_a_changed_trim_is_named_and_not_taken_for_another_measurement(original, trimmed, tmp_path):
    compared = tl.compare(original.parent / "results", trimmed)
    assert [(c.kind, c.what, c.first, c.second) for c in compared.changes] == [
        ("settings", "segments.trim", "0.1", "0.2")
    ]
    assert set(compared.points.verdict) == {CHANGED}
    assert compared.points.p_value.isna().all(), "the same raw data are no second sample"
    words = ["compare", str(original.parent / "results"), str(trimmed), "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 0 and "settings: segments.trim: 0.1 → 0.2" in done.stdout
    page = (tmp_path / "out/compare.html").read_text("utf-8")
    assert "segments.trim" in page and "http-equiv" in page and "<img src=" in page
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "compare.html",
        "compare_points.csv",
        "compare_quantities.csv",
    }


def test_what_changed_in_code_data_and_decisions_is_told(original, reviewed, tmp_path):
    from tribolab.comparison.changes import changes_between
    from tribolab.comparison.folder import open_folder

    first = open_folder(original.parent)
    copy = shutil.copytree(original.parent / "results", tmp_path / "copy") / "report.json"
    report = json.loads(copy.read_text("utf-8"))
    report["versions"]["numpy"] = "0.1"
    report["sources"][0]["sha256"] = 64 * "0"
    copy.write_text(json.dumps(report), "utf-8")
    told = changes_between(first, open_folder(copy.parent))
    assert [change.kind for change in told] == ["code", "data", "data"]
    assert told[1].what == report["sources"][0]["file"]
    decided = changes_between(first, open_folder(reviewed[0].parent))
    assert "decisions" in {change.kind for change in decided}


def test_a_folder_without_results_is_told(tmp_path):
    done = CliRunner().invoke(cli.app, ["compare", str(tmp_path), str(tmp_path)])
    assert done.exit_code == 3 and "name the folder that 'tribolab run' wrote" in done.stderr
    done = CliRunner().invoke(cli.app, ["compare", str(tmp_path)])
    assert done.exit_code == 2 and "name a second one, or use --by" in done.stderr
