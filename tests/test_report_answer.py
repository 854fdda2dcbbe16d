"""The answer that the page begins with: what was found, and what is missing and why."""

from types import SimpleNamespace

import pytest

from tribolab.records.parts import CurveOutcome
from tribolab.report.document.document import verdict
from tribolab.report.live.curves import curve_label
from tribolab.report.live.points import of_curve, run_points
from tribolab.report.page.answer import cards
from tribolab.report.page.in_short import in_short

CHECK = {"check": "friction_sign", "status": "fail", "decision": "", "message": "it drives. Look"}
SEM = {"friction_coefficient_U95": 0.02, "runs": 2}


def run(name, load, status="done", quality="pass"):
    labels = {"surface": "Sb-R", "medium": "glycerol", "nominal_normal_force_N": load}
    said = {"checks": [], "reason": "x.csv: no unit", "error": ""}
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
    labels["load_from"] = "stated"
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


def test_a_sentence_says_of_each_error_what_it_holds():
    one = report([])
    for row, runs in zip(one["curves"][0]["points"], (2, 2, 1), strict=True):
        row["runs"] = runs
    (card,) = cards(one)
    assert card.at_loads[0].text == "31 N"
    assert card.at_loads[0].sentences[0].endswith(" (± U95, between runs and within the run).")
    for row in one["curves"][0]["points"]:
        row["runs"] = 1
    (card,) = cards(one)
    assert card.at_loads[0].sentences[0].endswith(", the fastest speed (± U95, within the run).")


def test_a_card_says_shape_stress_mode_and_what_the_model_misses():
    stress = {"shear_stress_Pa": 0.88e6, "shear_stress_low_Pa": 0.8e6}
    words = "the model describes the curve within the errors; largest at 1 mm/s"
    (card,) = cards(report([], **stress, shear_stress_high_Pa=0.95e6, judgement=words))
    (found,) = card.at_loads
    # half of 1.1 lies between the last two points: 100 um/s * 100^((1.07 - 0.55) / 0.87)
    assert found.sentences == (
        "Plateau of µ = 1.10 ± 0.02 up to 100 µm/s; half of it at about 1.6 mm/s; lowest "
        "0.20 ± 0.02 at 10 mm/s, the fastest speed (± U95, between runs).",
        "Steady sliding, no stick-slip at any speed.",
        "Shear stress 0.880 MPa (95 %: 0.800 to 0.950 MPa).",
        "The model describes the curve within the errors.",
    )
    assert card.missing == ()


def test_a_run_under_several_loads_misses_no_curve_where_it_has_one():
    several = run("a", None) | {"load_from": "varies"}
    assert cards(report([several]))[0].missing == ()
    alone = several | {"name": "b", "segments_found": []}
    (card,) = cards(report([alone]))
    assert card.missing and "no curve" in card.missing[0]


def test_a_point_of_a_run_holds_one_of_its_loads():
    rows = [
        {"sliding_speed_m_s": 1e-3, "normal_force_N": n, "friction_coefficient": mu} | SEM
        for n, mu in ((20.1, 0.35), (40.2, 0.33))
    ]
    points = run_points("r", rows, filed={20.0: 20.2, 40.0: 40.0})
    assert [(p.mu, p.load) for p in points] == [(0.35, 20.2), (0.33, 40.0)]
    assert [p.mu for p in of_curve(points, 40.0)] == [0.33]


def test_a_plateau_is_of_points_that_agree_within_their_errors():
    one = report([])
    for row in one["curves"][0]["points"]:
        row["friction_coefficient_U95"] = 0.004
    (card,) = cards(one)
    assert card.at_loads[0].sentences[0].startswith("Highest µ = 1.100 ± 0.004 at 1 µm/s; half")


@pytest.mark.parametrize(
    ("runs", "why"),
    [
        (
            [("b", "done", "fail"), ("c", "done", "error")],
            "both runs were rejected by their checks",
        ),
        ([("b", "done", "rejected")], "its only run was rejected by hand"),
        ([("b", "done", "fail"), ("c", "done", "rejected")], "both runs were rejected"),
        ([("b", "failed", "")] * 3, "all 3 runs could not be read"),
        ([("b", "failed", ""), ("c", "done", "fail")], "1 could not be read and 1 was rejected"),
    ],
)
def test_a_curve_that_is_missing_is_named_with_the_reason(runs, why):
    (card,) = cards(report([run(name, 91.0, *more) for name, *more in runs]))
    assert card.missing == (f"Sb-R, glycerol, 91 N: no curve, {why}.",)


def test_a_curve_says_which_runs_it_had_to_do_without_and_why():
    (card,) = cards(report([run("b", 31.0, quality="fail"), run("c", 31.0, status="failed")]))
    assert card.thin == (
        ("b", "31 N rests on 1 of 3 runs; rejected: friction sign: it drives"),
        ("c", "31 N rests on 1 of 3 runs; failed: x.csv: no unit"),
    )
    assert card.missing == ()


def test_findings_that_are_alike_are_said_once_and_those_of_others_not_at_all():
    one = {"severity": "suspect", "where": "spikes friction_force", "message": "3 stand out. Look"}
    alike = [one | {"run": "a"}, one | {"run": "a"}]
    notes = [one | {"severity": "note", "run": "a"}, one | {"run": "elsewhere"}]
    (card,) = cards(report([], alike + notes))
    assert card.findings == (("suspect", "spikes (friction force): 3 stand out (and 1 alike)"),)


def falling(surface, medium, load, *points):
    rows = [{"sliding_speed_m_s": v, "friction_coefficient": mu} for v, mu in points]
    named = {"surface": surface, "medium": medium, "nominal_normal_force_N": load}
    return named | {"name": f"{surface}, {medium}", "points": rows}


def test_in_short_it_is_said_which_surface_lifts_off_last_and_where_the_model_fails():
    fine, rough = ((1e-6, 1.0), (1e-4, 0.01)), ((1e-6, 1.1), (1e-3, 0.9))
    curves = [falling("fine", "oil", 31.0, *fine), falling("rough", "oil", 31.0, *rough)]
    fit = {"judgement": "the model does not describe this curve: off by 80 % of its height"}
    models = [
        {"curve": "fine, oil", "fit": fit},
        {"curve": "rough, oil", "fit": {"judgement": "within its errors"}},
    ]
    assert in_short({"curves": curves, "models": models}) == [
        "In oil at 31 N, friction falls to half of its highest, as the liquid begins to lift the "
        "surfaces apart, at 10 µm/s on fine and not yet at "
        "1 mm/s on rough: rough needs the highest speed to lift off.",
        "The model fails on 1 of 2 curves: fine, oil, at 31 N.",
    ]
    # of two that never fall nobody knows which is the last
    third = falling("third", "oil", 31.0, (1e-6, 1.0), (1e-2, 0.8))
    (said,) = in_short({"curves": [*curves, third]})
    assert "highest speed" not in said
    # and a curve that was not measured far enough is not the first, either
    slow = falling("slow", "oil", 31.0, (1e-6, 1.0), (2e-6, 0.9))
    (said,) = in_short({"curves": [curves[0], slow]})
    assert "highest speed" not in said
    assert in_short({"curves": [third, slow], "models": []}) == []


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
    assert "2 of 2 runs done; 1 without a friction value; 4 segments" in part.text


def test_runs_of_neither_surface_nor_medium_are_told_one_by_one():
    """Each is a curve of its own, whatever its load; nothing is said to be missing of another."""
    one = report([])
    first = one["curves"][0]
    names = [f"run_{place}" for place in range(8)]
    nameless = {"surface": "", "medium": "", "load_from": "stated"}
    one["curves"] = [
        first | nameless | {"name": name, "runs": [name], "nominal_normal_force_N": 10.0 + place}
        for place, name in enumerate(names)
    ]
    one["runs"] = [run(name, 10.0) | {"surface": "", "medium": ""} for name in [*names, "other"]]
    (card,) = cards(one)
    assert (card.name, card.missing, card.thin) == ("8 runs", (), ())
    assert [at.title for at in card.at_loads[:2]] == ["run_0, 10 N", "run_1, 11 N"]
    assert (len(card.at_loads), card.more) == (6, "2 more curves: see all points")


def test_the_roughness_of_surfaces_stands_above_the_cards():
    one = report([])
    row = {"Rq_m": 0.68e-6, "Rq_sem_m": None, "Rq_gap_error_m": None, "lambda_c_m": 4e-4}
    one["surfaces"] = [{"name": "Sb-R", "roughness": row}, {"name": "no scan", "roughness": None}]
    assert in_short(one)[-1] == "Rq (cut-off 0.4 mm): Sb-R 0.68 µm"


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


def test_a_large_trend_that_is_not_decided_stands_above_the_cards():
    one = report([])
    row = {"friction_coefficient": 0.8, "trend_p_value": 0.36, "effective_samples": 2.8}
    short = [row | {"trend_change": change} for change in (-0.16, 0.0, 0.1)]
    one["runs"] = [run("a", 10.0) | {"segments": short, "quantity": "friction_coefficient"}]
    (said,) = [text for text in in_short(one) if text.startswith("Trend undecided")]
    assert said.startswith("Trend undecided in 2 of 3 segments, at most −20 % along one (run a)")
    one["runs"][0]["segments"] = [row | {"trend_change": 0.01}]
    assert not any(text.startswith("Trend undecided") for text in in_short(one))
