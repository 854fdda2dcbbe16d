"""The first screen: numbers, doubts and runs, the worst first."""

from types import SimpleNamespace

import pytest

from tribolab.records.parts import CurveOutcome, RunOutcome
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.running_in_record import RunningIn
from tribolab.report.document.document import state_of, verdict
from tribolab.report.page.doubts import doubts
from tribolab.report.page.key_numbers import friction_numbers, settled_numbers
from tribolab.report.page.run_list import listed_runs
from tribolab.report.page_figures.curves import curve_label
from tribolab.report.page_figures.points import RunPoint, of_curve, run_points
from tribolab.report.page_figures.starts import static_figures

CHECK = {"check": "friction_sign", "status": "fail", "decision": "", "message": "it drives"}
SEM = {"friction_coefficient_U95": 0.02, "runs": 2}


def run(name, load, status="done", quality="pass"):
    labels = {"surface": "Sb-R", "medium": "glycerol", "nominal_normal_force_N": load}
    said = {"checks": [], "reason": "x.csv: no unit", "error": "", "highlights": []}
    said["running_in"] = []
    said |= {"quantity": "friction_coefficient", "decisions": []}
    if quality == "fail":
        said["checks"] = [CHECK]
    return labels | said | {"name": name, "status": status, "quality": quality}


def report(runs, findings=(), **fit):
    """A report with a curve at 31 N, a plateau of 1.1 that falls to 0.2."""
    points = [
        {"sliding_speed_m_s": v, "friction_coefficient": mu} | SEM
        for v, mu in ((0.999e-6, 1.1), (1e-4, 1.07), (1e-2, 0.2))
    ]
    labels = {"surface": "Sb-R", "medium": "glycerol", "nominal_normal_force_N": 31.0}
    labels |= {"load_from": "stated", "uncertainty_says": ""}
    curve = labels | {"name": "c", "runs": ["a"], "points": points}
    model = {"curve": "c", "status": "done", "reason": "", "fit": fit or None}
    mode = {"curve": "c", "text": "steady sliding, no stick-slip at any speed"}
    return {
        "curves": [curve],
        "models": [model] if fit else [],
        "sliding_mode": [mode],
        "runs": [run("a", 31.0), *runs],
        "findings": list(findings),
    }


def test_a_point_of_a_run_holds_one_of_its_loads():
    rows = [
        {"sliding_speed_m_s": 1e-3, "normal_force_N": n, "friction_coefficient": mu} | SEM
        for n, mu in ((20.1, 0.35), (40.2, 0.33))
    ]
    points = run_points("r", rows, filed={20.0: 20.2, 40.0: 40.0})
    assert [(p.mu, p.load) for p in points] == [(0.35, 20.2), (0.33, 40.0)]
    assert [p.mu for p in of_curve(points, 40.0)] == [0.33]


def test_the_headline_does_not_mix_instruments():
    def measured(instrument, low, high):
        said = {"instrument": instrument, "value_min": low, "value_max": high}
        counts = {"segments_found": 3, "segments_rejected": 0, "quantity": "friction_coefficient"}
        counts["reused"] = False
        return run(instrument, 31.0) | said | counts

    runs = [measured("disc", 0.08, 0.15), measured("disc", 0.1, 0.2), measured("sled", 0.4, 0.5)]
    assert verdict(runs).text.endswith("µ from 0.08 to 0.2 (disc) and 0.4 to 0.5 (sled)")
    assert verdict(runs[:2]).text.endswith("µ from 0.08 to 0.2")
    many = [measured(f"rig {k}", 0.1, 0.1 + 0.1 * k) for k in range(1, 6)]
    assert verdict(many).text.endswith("µ from 0.1 to 0.6, of 5 instruments together")


def test_curves_that_no_choice_of_load_parts_are_named_in_the_legend():
    known = [
        SimpleNamespace(outcome=CurveOutcome(name, "a", "oil", load, "", (name,), load_from=told))
        for name, load, told in (("m", None, "varies"), ("s", 15.0, "stated"), ("t", 30.0, ""))
    ]
    several, stated, other = (curve.outcome for curve in known)
    assert curve_label(several, known) == "measured, several loads"
    assert curve_label(stated, known) == "measured, 15 N"
    assert curve_label(stated, known[1:]) == curve_label(other, known[1:]) == "measured"


def test_a_campaign_with_a_run_in_which_nothing_could_be_measured_is_not_complete():
    run = {"status": "done", "quality": "pass", "quantity": "friction_coefficient"}
    run |= {"segments_found": 4, "segments_rejected": 0, "reused": False, "objections": []}
    run |= {"value_min": 0.1, "value_max": 0.2, "instrument": "a", "instrument_title": "a"}
    empty = run | {"value_min": None, "value_max": None, "segments_found": 0}
    whole, part = verdict([run, run]), verdict([run, empty])
    assert (whole.status, whole.without_value) == ("complete", 0)
    assert (part.status, part.without_value) == ("incomplete", 1)
    assert "2 of 2 runs usable; 1 without a friction value; 4 segments" in part.text


def test_a_point_of_a_run_has_the_wider_error_and_what_all_strokes_share():
    one = {"sliding_speed_m_s": 1e-3, "friction_coefficient": 0.2, "effective_samples": 9.0}
    one |= {"friction_coefficient_sem": 0.001, "friction_coefficient_U95": 0.002}
    beyond = {f"friction_coefficient_beyond_{end}": v for end, v in (("sem", 0.01), ("U95", 0.02))}
    (point,) = run_points("r", [one | beyond])
    assert point.within == 0.02
    shared = one | {"friction_coefficient_shared_sem": 0.0009}
    (alone,) = run_points("r", [one] * 16)
    (common,) = run_points("r", [shared] * 16)
    assert alone.within < 0.0006
    assert 1.9 * 0.0009 < common.within < 2.2 * 0.0009


def test_the_numbers_of_a_curve_are_its_extremes_and_where_half_is_left():
    stress = {"shear_stress_Pa": 0.88e6, "shear_stress_low_Pa": 0.8e6}
    words = "the model describes the curve within the errors; largest at 1 mm/s"
    fitted = report([], **stress, shear_stress_high_Pa=0.95e6, judgement=words)
    table = friction_numbers(fitted)
    # half of 1.1 lies between the last two points: 100 um/s * 100^((1.07 - 0.55) / 0.87)
    assert table.rows[0].cells == (
        "Sb-R, glycerol",
        "31 N",
        "1.10 ± 0.02 at 1 µm/s",
        "1.6 mm/s",
        "0.20 ± 0.02 at 10 mm/s",
        "0.88 (0.800 to 0.950)",
    )
    fitted["models"][0]["fit"]["judgement"] = "the model does not describe this curve: by 80 %"
    assert friction_numbers(fitted).rows[0].cells[-1] == "model fails"
    del fitted["curves"][0]["points"][1:]
    table = friction_numbers(fitted | {"models": []})
    assert (table.heads[2], table.rows[0].cells[2]) == ("µ ± U95", "1.10 ± 0.02 at 1 µm/s")


@pytest.mark.parametrize(
    ("runs", "why"),
    [
        ([("b", "done", "fail"), ("c", "done", "error")], "both runs were rejected"),
        ([("b", "done", "rejected")], "its only run was rejected by hand"),
        ([("b", "done", "fail"), ("c", "done", "rejected")], "both runs were rejected"),
        ([("b", "failed", "")] * 3, "all 3 runs could not be read"),
        ([("b", "failed", ""), ("c", "done", "fail")], "1 could not be read and 1 rejected"),
    ],
)
def test_a_curve_that_is_missing_is_named_with_the_reason(runs, why):
    found = doubts(report([run(name, 91.0, *more) for name, *more in runs]))
    (missing,) = [doubt for doubt in found if doubt.text.startswith("no curve")]
    assert (missing.runs, missing.text) == ("Sb-R, glycerol, 91 N", f"no curve, {why}")


def test_a_run_under_several_loads_misses_no_curve_where_it_has_one():
    several = run("a", None) | {"load_from": "varies"}
    assert doubts(report([several])) == []


def test_doubts_name_runs_left_out_then_odd_repeats_then_findings_each_with_its_cure():
    odd = run("o", 31.0) | {"checks": [CHECK | {"check": "repeats", "message": "19 % above"}]}
    stuck = CHECK | {"check": "stuck", "status": "suspect", "message": "12 samples repeat"}
    doubtful = [run(name, 31.0, quality="suspect") | {"checks": [stuck]} for name in "st"]
    row = {"severity": "suspect", "where": "stuck friction_force"}
    findings = [row | {"run": name, "message": "12 samples repeat. Check it."} for name in "st"]
    left = row | {"severity": "fail", "run": "b", "message": "of a run that is left out"}
    one = report([run("b", 31.0, quality="fail"), odd, *doubtful], [left, *findings])
    one["curves"][0]["uncertainty_says"] = "calibration not stated: statistical only"
    said = [(doubt.level, doubt.runs, doubt.text) for doubt in doubts(one)]
    assert said[:3] == [
        ("fail", "b", "left out, friction sign: it drives"),
        ("suspect", "o", "19 % above"),
        ("suspect", "s and t", "12 samples repeat"),
    ]
    assert said[3][0] == "note" and said[3][2].startswith("± is statistical only")
    assert doubts(one)[2].cure == "Check it."
    many = report([run(f"b{n}", 31.0, quality="fail") for n in range(3)])
    (left,) = doubts(many)
    assert (left.runs, left.text) == (
        "3 runs",
        "left out: b0 (friction sign), b1 (friction sign), b2 (friction sign)",
    )


def test_runs_are_listed_worst_first_with_their_deviation_from_usable_repeats():
    repeats = [CHECK | {"check": "repeats", "status": "suspect"}]
    runs = [run("a", 31.0), run("b", 31.0), run("bad", 31.0, quality="fail")]
    runs += [run("odd", 31.0) | {"checks": repeats}, run("alone", 91.0)]
    mu = {"a": 0.5, "b": 0.52, "bad": 0.9, "odd": 0.6, "alone": 0.4}
    points = {
        name: [RunPoint(name, v, value, 0.01, 9.0, 2) for v in (1e-3, 1.001e-3 * 10)]
        for name, value in mu.items()
    }
    listed = listed_runs(runs, points, {})
    assert listed.speeds == ("1 mm/s", "10 mm/s")
    assert [row.run["name"] for row in listed.rows] == ["bad", "odd", "a", "b", "alone"]
    # of 0.5, 0.52 and 0.6 the median; a run that its checks rejected is no repeat
    assert [row.values[0] for row in listed.rows] == [
        ("0.9", "+73 %"),
        ("0.6", "+15 %"),
        ("0.5", "−3.8 %"),
        ("0.52", "0.0 %"),
        ("0.4", ""),
    ]
    assert [row.state for row in listed.rows[:2]] == ["rejected", "odd"]


def started(name, load, static, rests=(3.0, 10.0, 31.0)):
    """A run with a start after each rest, at a kinetic friction of 0.4."""
    outcome = RunOutcome(
        name=name,
        status="done",
        data_file="",
        files=(),
        surface="glass",
        medium="dry",
        normal_force=load,
        load_from="stated",
    )
    starts = tuple(
        {"waiting_time_s": rest, "static_friction_coefficient": mu, "friction_coefficient": 0.4}
        | {"static_friction_coefficient_sem": 0.001, "sliding_speed_m_s": 1e-3}
        for rest, mu in zip(rests, static, strict=True)
    )
    return RunRecord(outcome, (), starts=starts)


def test_starts_after_equal_rests_are_averaged():
    pair = [started("a", 5.0, (0.5, 0.52, 0.54)), started("b", 5.0, (0.52, 0.52, 0.54))]
    (figure,) = static_figures([*pair, started("c", 9.0, (0.6, 0.62, 0.64))])
    rows = [row.cells[1:] for row in figure.numbers.rows]
    # 12.7 standard errors of the mean of two, else the U95 of one start
    assert rows[:3] == [
        ("5 N", "3", "0.51 ± 0.13", "0.4", "1 mm/s", "2"),
        ("5 N", "10", "0.520 ± 0.002", "0.4", "1 mm/s", "2"),
        ("5 N", "31", "0.540 ± 0.002", "0.4", "1 mm/s", "2"),
    ]
    assert [row[0] for row in rows[3:]] == ["9 N"] * 3


def test_the_list_names_the_reason_that_sets_a_run_apart():
    zero = {"check": "zero_reference", "status": "suspect", "decision": "", "message": "no rest"}
    odd = zero | {"check": "repeats", "message": "21 % above"}
    runs = [run(name, 31.0, quality="suspect") | {"checks": [zero]} for name in "ab"]
    runs.append(run("c", 31.0, quality="suspect") | {"checks": [zero, odd]})
    rows = {row.run["name"]: row.why for row in listed_runs(runs, {}, {}).rows}
    assert rows == {
        "a": "all runs: no rest",
        "b": "all runs: no rest",
        "c": "repeats: 21 % above (and 1 more)",
    }


def test_repeats_that_leave_their_mean_uncertain_make_a_campaign_suspect():
    document = report([])
    assert not [doubt for doubt in doubts(document) if "disagree" in doubt.text]
    assert state_of({"status": "complete", "suspect": 0, "uncertain": 1}) == "SUSPECT"
    for point in document["curves"][0]["points"]:
        point["friction_coefficient_U95"] = 0.3 * point["friction_coefficient"]
    (doubt,) = (doubt for doubt in doubts(document) if "disagree" in doubt.text)
    assert doubt.text.endswith("exceeds 25 % of the mean: Sb-R, glycerol, 31 N")


def test_steady_friction_has_the_mean_without_a_repeat_that_contradicts_the_others():
    settled = {"start_m": 1.0, "end_m": 5.0, "sliding_speed_m_s": 0.1, "verdict": ""}
    settled |= {name: None for name in RunningIn.__dataclass_fields__ if name not in settled}
    runs = []
    for name, mu in (("a", 0.50), ("b", 0.50), ("c", 0.62)):
        level = {"steady_friction_coefficient": mu, "steady_friction_coefficient_U95": 0.004}
        runs.append(run(name, 5.0) | {"running_in": [settled | level]})
    means = [row.cells[:2] for row in settled_numbers({"runs": runs}).rows[:1]]
    assert means == [("mean of 3 repeats", "0.54 ± 0.17")]
    runs[2]["checks"] = [CHECK | {"check": "repeats", "status": "suspect"}]
    means = [row.cells[:2] for row in settled_numbers({"runs": runs}).rows[:2]]
    # the U95 of equal repeats is that of their own means
    assert means[1] == ("mean of 2 repeats, without c", "0.500 ± 0.003")
