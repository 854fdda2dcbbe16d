"""A review file does in a campaign what `tl.decide` does in a notebook, and all of it is told."""

import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import xarray as xr
from campaigns import RUNS, copied
from report_pages import details_of
from reviews import FROZEN, LATE, SLIP, SLIPPED, SOUND, entry, rows_of
from typer.testing import CliRunner

import tribolab
from tribolab.app.run import run_campaign
from tribolab.campaign.runs.analysis import analyse_run
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.settings.plan import planned_runs
from tribolab.campaign.settings.review import (
    REVIEW_FILE,
    REVIEW_SCHEMA_FILE,
    load_review,
    review_schema,
)
from tribolab.cli import app
from tribolab.core.errors import ConfigError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.decisions.decided_segments import decide
from tribolab.friction.decisions.decision import Decision
from tribolab.friction.segments.find import find_segments
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.qc.flags import FAIL, GOOD
from tribolab.qc.manual import BIT
from tribolab.qc.run.checks import check_run
from tribolab.reading.runs.read_run import read_run
from tribolab.reading.schema_folder import schema_folder
from tribolab.records.runs.decision_rows import decision_rows
from tribolab.report.results_folder import read_results

SCHEMA = Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json"
GLYCEROL, DRY = "curve_Sb-R_glycerol_31N", "curve_Sb-R_dry_31N"


@pytest.mark.slow
def test_only_what_was_decided_on_is_done_again(reviewed, tmp_path):
    file, outcome = reviewed
    assert [run.reused for run in outcome.runs] == [False, False, False, True]
    assert run_campaign(file, jobs=1, figures="none").runs[0].reused
    file = copied(file, tmp_path)
    path = file.parent / REVIEW_FILE
    path.write_text(path.read_text("utf-8").replace("slipped off", "lost its load"), "utf-8")
    again = run_campaign(file, jobs=1, figures="none")
    assert [run.reused for run in again.runs] == [True, False, True, True]
    path.unlink()
    bare = run_campaign(file, jobs=1, figures="none")
    assert [run.reused for run in bare.runs] == [False, False, False, True]
    assert "decisions" not in list(read_results(bare.folder))


@pytest.mark.slow
def test_a_notebook_gives_the_numbers_of_the_campaign(reviewed):
    file, outcome = reviewed
    decisions, frictions = load_review(file.parent), {}
    for name in RUNS:
        logs = [file.parent / f"raw/friction/{name}_{log}.csv" for log in ("force", "motion")]
        run = read_run(logs, "linear_slider")
        segments = decide(find_segments(run), decisions.get(name, ()), run)
        friction = frictions[name] = friction_coefficient(run, segments)
        rows = rows_of(outcome.folder, name)
        for column in ("friction_coefficient", "friction_coefficient_sem", "start_s"):
            values = friction[column.removesuffix("_s")].values
            np.testing.assert_array_equal(rows[column].values, values)
    table = read_results(outcome.folder)["stribeck"]
    for curve, names in ((GLYCEROL, (FROZEN, SLIPPED)), (DRY, (LATE, SOUND))):
        mine = measured_stribeck_curve([frictions[name] for name in names])
        rows = table[table.curve == curve]
        np.testing.assert_array_equal(rows.friction_coefficient, mine.friction_coefficient)
        np.testing.assert_array_equal(rows.segments, mine.segments)


@pytest.mark.slow
def test_friction_with_decisions_and_without_are_both_kept(original, reviewed):
    _, outcome = reviewed
    now, before = (read_results(f) for f in (outcome.folder, original.parent / "results"))
    for new, old in zip(*(curves_of(each.folder) for each in (now, before)), strict=True):
        assert (new["points_as_found"] or new["points"]) == old["points"]
    run = now.data(SLIPPED, "friction_as_found").friction_coefficient.values
    earlier = rows_of(original.parent / "results", SLIPPED).friction_coefficient.values
    np.testing.assert_array_equal(run, earlier)
    # the stroke of half the friction spoilt the zero of its partner; rejected, it does not
    rows = rows_of(outcome.folder, SLIPPED)
    sound = float(rows.friction_coefficient.iloc[0])
    assert abs(rows.friction_coefficient.iloc[SLIP + 1] / sound - 1) < 0.05
    assert abs(run[SLIP + 1] / sound - 1) > 0.2
    moved = now["checks"].query("check == @GLYCEROL").message.item()
    assert moved.startswith("decisions change µ by at most ") and "points_as_found" in moved


def curves_of(results):
    return json.loads((results / "report.json").read_text("utf-8"))["curves"]


@pytest.mark.slow
@pytest.mark.parametrize("action", ["note", "accept"])
@pytest.mark.parametrize("name", [FROZEN, SLIPPED])
def test_notes_and_acceptance_move_no_number_and_cost_no_second_analysis(
    original, monkeypatch, name, action
):
    [planned] = [run for run in planned_runs(load_campaign(original)) if run.name == name]
    bare = analyse_run(planned)
    calls = []

    def counted(*given, **options):
        calls.append(given)
        return friction_coefficient(*given, **options)

    place = "tribolab.friction.coefficient.coefficient.friction_coefficient"
    monkeypatch.setattr(place, counted)
    decision = Decision(action, "humid day", "A. Person", "2026-11-20")
    decided = analyse_run(replace(planned, decisions=(decision,)))
    assert len(calls) == 1
    for result in (decided.friction_as_found, bare.friction):
        del result.attrs["history"]  # it says when
    xr.testing.assert_identical(decided.friction_as_found, bare.friction)
    assert decided.quality_as_found == bare.quality
    settled = action == "accept" and bare.quality in ("suspect", "fail")
    assert decided.quality == ("accepted" if settled else bare.quality)


@pytest.mark.slow
def test_every_decision_stands_in_a_table_with_what_came_of_it(reviewed):
    table = read_results(reviewed[1].folder)["decisions"]
    rows = table.set_index(["run", "action"])
    assert set(rows.author) == {"A. Person"} and set(rows.date) == {"2026-11-20"}
    slipped = rows.loc[(SLIPPED, "reject")]
    assert (str(slipped.segments), slipped.effect) == (str(SLIP + 1), "1 segment rejected")
    assert np.isnan(slipped.friction_coefficient) and slipped.friction_coefficient_as_found > 0
    assert "stuck" in rows.loc[(FROZEN, "accept")].effect
    assert " instead of " in rows.loc[(LATE, "bounds")].effect
    assert np.isnan(rows.loc[(LATE, "note")].start_s)


@pytest.mark.slow
def test_the_report_shows_and_counts_what_a_person_decided(reviewed):
    folder = reviewed[1].folder
    report = json.loads((folder / "report.json").read_text("utf-8"))
    jsonschema.validate(report, json.loads(SCHEMA.read_text("utf-8")))
    verdict = report["verdict"]
    counts = ("rejected", "rejected_by_hand", "accepted_by_hand", "segments_rejected")
    assert [verdict[name] for name in counts] == [0, 0, 1, 1]
    assert "1 accepted by hand; 24 segments (1 rejected by hand)" in verdict["text"]
    frozen = next(run for run in report["runs"] if run["name"] == FROZEN)
    assert (frozen["quality"], frozen["quality_as_found"]) == ("accepted", "fail")
    said = [f["message"] for f in report["findings"] if f["run"] == FROZEN]
    assert any(text.startswith("accepted by A. Person in spite of: fail: ") for text in said)
    assert not [f for f in report["findings"] if f["severity"] == "fail"]
    page = "".join(details_of(folder))
    assert page.count('<tr class="rejected">') == 1
    assert "rejected by A. Person: slipped off" in page


@pytest.mark.slow
def test_flags_say_which_samples_a_person_decided_on(reviewed):
    results = read_results(reviewed[1].folder)
    run, rows = results.data(SLIPPED, "run"), rows_of(reviewed[1].folder, SLIPPED)
    inside = run.time.values >= rows.start_s.iloc[SLIP]
    inside &= run.time.values <= rows.stop_s.iloc[SLIP]
    tests = run.friction_force_qc_tests
    words = tests.attrs["flag_meanings"].split()
    assert tests.attrs["flag_masks"][words.index("manual")] == 1 << BIT
    assert ((tests.values & (1 << BIT) != 0) == inside).all()
    assert (run.friction_force_qc.values[inside] == FAIL).all()
    frozen = results.data(FROZEN, "run")
    stuck = frozen.friction_force_qc_tests.values & (1 << words.index("stuck")) != 0
    assert stuck.any() and (frozen.friction_force_qc.values[stuck] == GOOD).all()


@pytest.mark.slow
def test_a_run_that_is_rejected_is_in_no_curve_and_no_failure(original, tmp_path):
    file = copied(original, tmp_path)
    text = entry(FROZEN, "reject", "its signal froze") + entry(LATE, "reject")
    (file.parent / REVIEW_FILE).write_text(text + entry(SOUND, "reject"), "utf-8")
    told = CliRunner().invoke(app, ["run", str(file), "--jobs", "1", "-q"])
    assert told.exit_code == 0, told.output
    assert "decided by hand: 3 runs rejected: see " in told.output
    results = read_results(file.parent / "results")
    assert set(results["stribeck"].curve) == {GLYCEROL}
    report = json.loads((file.parent / "results/report.json").read_text("utf-8"))
    assert "3 rejected by hand" in report["verdict"]["text"]
    page = (file.parent / "results/report.html").read_text("utf-8")
    assert "rejected by A. Person: its signal froze" in page


@pytest.mark.slow
def test_a_decision_that_finds_nothing_is_told_and_stops_no_other(reviewed, tmp_path):
    file = copied(reviewed[0], tmp_path)
    path = file.parent / REVIEW_FILE
    text = path.read_text("utf-8") + entry(f"{SOUND}x", "reject")
    line = text[: text.index(f"{SOUND}x")].count("\n") + 1
    path.write_text(text + entry(SOUND, "reject", start=1.0, stop=2.0), "utf-8")
    told = CliRunner().invoke(app, ["run", str(file), "--jobs", "1", "-q"])
    assert told.exit_code == 3
    assert f"review.toml, line {line}: decision 5, run: no run is called '{SOUND}x'" in told.stderr
    assert f"did you mean '{SOUND}'" in told.stderr
    assert f"{SOUND} failed: " in told.stderr
    assert "reject, 1 to 2 s (A. Person, 2026-11-20) finds no segment" in told.stderr
    assert "correct its from and to in review.toml" in told.stderr
    report = json.loads((file.parent / "results/report.json").read_text("utf-8"))
    assert [run["status"] for run in report["runs"]] == ["done", "done", "done", "failed"]
    assert [run["reused"] for run in report["runs"]] == [True, True, True, False]
    assert report["verdict"]["status"] == "incomplete"
    lost = read_results(file.parent / "results")["decisions"].set_index("run").loc[SOUND]
    assert lost.effect == "not applied: the run failed"
    again = CliRunner().invoke(app, ["run", str(file), "--jobs", "1", "-q"])
    assert again.exit_code == 3 and again.stderr == told.stderr


@pytest.mark.slow
def test_a_rejection_holds_for_an_earlier_result_whose_file_cannot_be_read(reviewed, tmp_path):
    file = copied(reviewed[0], tmp_path)
    path = file.parent / REVIEW_FILE
    path.write_text(path.read_text("utf-8") + entry(SOUND, "reject", "wrong sample"), "utf-8")
    (file.parent / f"raw/friction/{SOUND}_force.csv").write_bytes(b"")
    outcome = run_campaign(file, jobs=1, figures="none")
    assert (outcome.runs[3].quality, outcome.runs[3].in_curves) == ("rejected", False)
    assert "what was decided since" in outcome.runs[3].kept
    dry = next(curve for curve in outcome.curves if curve.name == DRY)
    assert dry.run_names == (LATE,)
    report = json.loads((outcome.folder / "report.json").read_text("utf-8"))
    run = report["runs"][3]
    assert (run["quality"], run["quality_as_found"]) == ("rejected", "pass")
    assert run["decisions"][0]["reason"] == "wrong sample" and run["segments"]
    assert "1 rejected by hand" in report["verdict"]["text"]


WRONG = {
    "action": ('"reject"', '"rejct"', 3, "did you mean 'reject'"),
    "key": ("from =", "form =", 4, "did you mean 'from'"),
    "one end": ('to = "2.0000 s"\n', "", 1, "wants both its ends"),
    "no unit": ('"2.0000 s"', "2", 5, "2 has no unit; write e.g. '31 s'"),
    "no author": ('author = "A. Person"\n', "", 1, "author: is missing"),
    "no date": ("2026-11-20", '"friday"', 8, "date"),
}


@pytest.mark.slow
@pytest.mark.parametrize(("right", "wrong", "line", "said"), WRONG.values(), ids=WRONG)
def test_a_mistake_in_the_review_file_is_met_before_any_work(
    original, tmp_path, right, wrong, line, said
):
    text = entry(SOUND, "reject", start=1.0, stop=2.0)
    assert right in text
    file = tmp_path / "campaign.toml"
    file.write_text(original.read_text("utf-8"), "utf-8")
    (tmp_path / "raw").symlink_to(original.parent / "raw")
    (tmp_path / REVIEW_FILE).write_text(text.replace(right, wrong, 1), "utf-8")
    with pytest.raises(ConfigError, match=f"{REVIEW_FILE}, line {line}: .*{said}"):
        load_campaign(file)


def test_the_published_schema_is_the_models_and_knows_every_key():
    published = json.loads((schema_folder() / REVIEW_SCHEMA_FILE).read_text(encoding="utf-8"))
    assert published == review_schema()
    whole = {"run": "x", "action": "bounds", "from": "1 s", "to": "2 s", "new_to": "1.5 s"}
    whole |= {"reason": "late", "author": "A", "date": "2026-11-20"}
    jsonschema.validate({"decision": [whole]}, published)
    for wrong in ({"action": "drop"}, {"from": 1.0}, {"number": 3}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({"decision": [whole | wrong]}, published)


@pytest.fixture(scope="module")
def spiked(original):
    """A run with a spike in the middle of its second and of its fourth segment, and these."""
    logs = [original.parent / f"raw/friction/{SOUND}_{log}.csv" for log in ("force", "motion")]
    run = read_run(logs, "linear_slider")
    segments = find_segments(run)
    middles = [float(segments.start[k] + segments.stop[k]) / 2 for k in (1, 3)]
    force = run.friction_force.values.copy()
    force[np.searchsorted(run.time.values, middles)] += 20.0
    windows = [{"start": middle - 2, "stop": middle + 2} for middle in middles]
    return run.assign(friction_force=run.friction_force.copy(data=force)), segments, windows


@pytest.mark.slow
@pytest.mark.parametrize(
    ("actions", "status", "effects", "said"),
    [
        ("n", "suspect", [""], ""),
        ("a", "suspect", ["no objection lies in it alone"], ""),
        ("aa", "accepted", ["in spite of spikes"] * 2, "accepted by A, B in spite of"),
        ("ra", "accepted", ["1 segment rejected", "in spite of spikes"], "accepted by B"),
        ("rr", "pass", ["1 segment rejected"] * 2, "within a part that A, B rejected"),
    ],
)
def test_an_objection_no_longer_counts_where_persons_decided_on_all_of_it(
    spiked, actions, status, effects, said
):
    run, segments, windows = spiked
    words = {"n": "note", "a": "accept", "r": "reject"}
    made = [
        Decision(words[action], "a door", author, "2026-11-20", **window)
        for action, author, window in zip(actions, "AB", windows, strict=False)
    ]
    decided = decide(segments, made)
    found = check_run(run, decided)
    assert (check_run(run, segments).status, found.status) == ("suspect", status)
    [row] = [row for row in found.rows if row["check"] == "spikes" and row["count"]]
    assert row["status"] == "suspect" and row.get("decision", "").startswith(said)
    assert ("note  spikes" in repr(found)) == bool(said)
    friction = friction_coefficient(run, decided)
    rows = decision_rows(friction, friction_coefficient(run, segments), found.rows)
    assert [row.effect for row in rows] == effects
