"""The results folder: tables, report.json and figures say what the data files say."""

import base64
import json
import zlib
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from report_pages import details_of, figures_of
from reporting import made_outcome, made_run, with_run, without_curves

import tribolab
from tribolab.qc.flags import attach
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.packed import clock_of, pack_points
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome
from tribolab.records.runs.run_facts import stick_slip_of
from tribolab.records.runs.run_record import RunRecord, Waveform
from tribolab.records.runs.traces import decimated_trace, finer_trace, flagged_spans, script_json
from tribolab.records.wording import error_text, plain_value
from tribolab.report.campaign_tables import TABLES
from tribolab.report.results import shown_curves, write_report

SCHEMA = json.loads(
    (Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json").read_text()
)
RUNS = [
    ("sb-r_1", "Sb-R", "glycerol", 31.0, 0.8),
    ("sb-r_2", "Sb-R", "glycerol", 31.0, 0.82),
    ("sb-s_1", "Sb-S", "glycerol", 31.0, 1.1),
    ("sb-s_dry", "Sb-S", "dry", 31.0, 1.4),
    ("nameless", "", "", None, 0.5),
]
REASON = "bad.csv: column 'Fx' has no unit; say it in the dialect"


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    made = made_outcome(folder, RUNS, failed=[("broken", REASON)], samples=60)
    write_report(made)
    return made


@pytest.fixture(scope="module")
def report(outcome):
    def refuse(text):
        raise AssertionError(f"{text} is no JSON")

    return json.loads((outcome.folder / "report.json").read_text(), parse_constant=refuse)


def valid(report):
    jsonschema.Draft202012Validator(SCHEMA).validate(report)


def table(outcome, name):
    return pd.read_csv(outcome.folder / "tables" / f"{name}.csv", keep_default_na=False)


def test_report_json_fits_its_schema(report):
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    valid(report)


def test_schema_refuses_what_it_does_not_know(report):
    for wrong in (
        report | {"schema_version": "0.9"},
        report | {"more": 1},
        report | {"runs": [report["runs"][0] | {"status": "fine"}]},
        {key: value for key, value in report.items() if key != "findings"},
    ):
        with pytest.raises(jsonschema.ValidationError):
            valid(wrong)


def test_every_table_is_described_and_stands_in_the_docs(outcome):
    written = {file.stem for file in (outcome.folder / "tables").glob("*.csv")}
    assert {"friction", "checks", "sources"} <= written <= set(TABLES)
    told = (Path(tribolab.__file__).parents[1] / "docs/results.md").read_text("utf-8")
    assert [name for name in TABLES if f"{name}.csv" not in told] == []


def test_friction_table_is_the_data_files_to_the_last_digit(outcome):
    friction = pd.read_csv(outcome.folder / "tables/friction.csv")
    for run in outcome.runs[:-1]:
        rows = friction[friction.run == run.name]
        data = read_netcdf(outcome.folder / run.data_file, group="friction")
        for column, name in {
            "friction_coefficient": "friction_coefficient",
            "friction_coefficient_std": "friction_coefficient_std",
            "friction_coefficient_sem": "friction_coefficient_sem",
            "sliding_speed_m_s": "sliding_speed",
            "start_s": "start",
            "stop_s": "stop",
            "normal_force_N": "normal_force",
            "trend_change": "trend_change",
            "direction": "direction",
        }.items():
            np.testing.assert_array_equal(rows[column].to_numpy(), data[name].values)
        assert rows.segment.tolist() == list(range(1, data.sizes["segment"] + 1))


def test_friction_table_says_what_each_row_is_of(outcome):
    friction = table(outcome, "friction")
    assert list(friction.columns[:7]) == [
        "run",
        "surface",
        "medium",
        "nominal_normal_force_N",
        "segment",
        "sliding_speed_m_s",
        "direction",
    ]
    row = friction[friction.run == "sb-s_dry"].iloc[0]
    assert (row.surface, row.medium, float(row.nominal_normal_force_N)) == ("Sb-S", "dry", 31.0)
    assert friction[friction.run == "nameless"].iloc[0].nominal_normal_force_N == ""


def test_stribeck_table_has_every_point_of_every_curve(outcome):
    points = pd.read_csv(outcome.folder / "tables/stribeck.csv")
    for curve in outcome.curves:
        rows = points[points.curve == curve.name]
        data = read_netcdf(outcome.folder / curve.data_file)
        np.testing.assert_array_equal(rows.sliding_speed_m_s, data.sliding_speed.values)
        np.testing.assert_array_equal(rows.friction_coefficient, data.friction_coefficient.values)


def test_sources_stand_with_their_checksums(outcome, report):
    sources = table(outcome, "sources")
    known = sources[["file", "sha256", "bytes"]].itertuples(index=False, name=None)
    assert list(known) == list(outcome.sources)
    assert sources.left_out.str.startswith("at rest: ").any()
    assert report["sources"][0] == {"file": "raw/made.csv", "sha256": "ab" * 32, "bytes": 9}


def test_failed_run_leads_the_findings_with_its_reason(outcome, report):
    first = table(outcome, "checks").iloc[0]
    assert (first.status, first.run, first.message) == ("fail", "broken", REASON)
    assert report["findings"][0]["message"] == REASON
    assert report["verdict"]["status"] == "incomplete"
    assert "5 of 6 runs usable; 1 failed; 30 segments" in report["verdict"]["text"]


def test_what_was_left_out_is_said_with_reason_and_time(outcome, report):
    findings = table(outcome, "checks")
    mine = findings[findings.run == "sb-r_1"]
    assert not (mine.check == "left out").any()
    assert "not used: Temp [C]; Aux" in mine[mine.check == "columns"].message.tolist()
    said = [(one["run"], one["message"]) for one in report["findings"]]
    assert ("sb-r_1", "at rest: 7 intervals, 14 s") in said


def test_highlights_are_means_over_the_strokes_at_a_speed(outcome, report):
    run = outcome.runs[0]
    data = read_netcdf(outcome.folder / run.data_file, group="friction")
    marks = report["runs"][0]["highlights"]
    assert [mark["where"] for mark in marks] == ["slowest", "middle", "fastest"]
    for mark, part in zip(marks, (slice(0, 2), slice(2, 4), slice(4, 6)), strict=True):
        both = data.friction_coefficient.values[part]
        sem = data.friction_coefficient_sem.values[part]
        assert mark["value"] == pytest.approx(both.mean(), rel=1e-12)
        # both strokes of a half loop have one and the same friction: the second adds nothing
        assert mark["sem"] == pytest.approx(sem.mean(), rel=1e-12)
        assert mark["segments"] == 2


def test_every_figure_named_is_there_and_described_with_numbers(outcome, report):
    figures = report["figures"]
    names = {Path(figure["file"]).stem for figure in figures}
    assert {"stribeck_sb-r_glycerol", "stribeck_load_1", "curves_runs"} <= names
    on_disk = {f"figures/{path.name}" for path in (outcome.folder / "figures").iterdir()}
    every = figures + report["sliding_figures"]
    assert {figure[kind] for figure in every for kind in ("file", "data")} == on_disk
    for figure in figures:
        assert any(character.isdigit() for character in figure["alt"])


@pytest.mark.slow
def test_report_is_the_same_in_processes_threads_and_here(tmp_path):
    made = made_outcome(tmp_path / "same", RUNS[:1], speeds=[1e-3], samples=50)

    def written(executor=None):
        calls = []
        options = {"progress": lambda *call: calls.append(call), "figures": "curves"}
        write_report(made, executor=executor, **options)
        assert calls[-1] == ("page", 1, 1) and calls[-2][0] == "figures"
        lines = (made.folder / "report.json").read_text().splitlines()
        figures = {p.name: p.read_bytes() for p in (made.folder / "figures").iterdir()}
        return [line for line in lines if "made_at" not in line], figures

    here = written()
    assert here[1]
    with ThreadPoolExecutor(3) as threads:
        assert written(threads) == here
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:
        assert written(processes) == here


def test_nan_becomes_null_and_infinity_too():
    value = {"a": [np.float64("nan"), 1.5, np.int8(2)], "b": np.array([np.inf, 0.0]), "c": None}
    assert plain_value(value) == {"a": [None, 1.5, 2], "b": [None, 0.0], "c": None}


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.81234, 0.0042, "0.812 ± 0.004"),
        (0.81234, 0.0123, "0.812 ± 0.012"),
        (123.4, 31.0, "123 ± 31"),
        (0.5, None, "0.5"),
        (0.5, float("nan"), "0.5"),
        (None, 0.1, "–"),
    ],
)
def test_error_sets_the_digits(value, error, text):
    assert error_text(value, error) == text


def test_empty_campaign_still_has_a_report(tmp_path):
    made = made_outcome(tmp_path / "none", [], failed=[("a", "no such file"), ("b", "")])
    write_report(made, figures="none")
    report = json.loads((made.folder / "report.json").read_text())
    valid(report)
    assert report["verdict"]["status"] == "nothing"
    assert list(table(made, "friction").columns)[0] == "run"
    assert table(made, "checks").message.tolist()[:2] == ["no such file", "ReadError"]


def _one(tmp_path, change):
    made = made_outcome(tmp_path / "one", [("only", "Sb-R", "glycerol", 31.0, 0.8)])
    return with_run(made, 0, change(*made_run()))


def test_run_without_segments_is_suspect_and_has_a_trace(tmp_path):
    def nothing(run, segments, friction):
        empty = slice(0, 0)
        return run, segments.isel(segment=empty), friction.isel(segment=empty)

    made = _one(tmp_path, nothing)
    write_report(made, figures="none")
    report = json.loads((made.folder / "report.json").read_text())
    valid(report)
    assert report["findings"][0]["severity"] == "suspect"
    assert 'id="trace-run0"' in details_of(made.folder)[0]
    assert report["runs"][0]["sliding_speed_min_m_s"] is None


def test_the_table_of_runs_says_which_stick_slip_at_how_many_speeds(tmp_path, report):
    def sawing(run, segments, friction):
        inside = run["time"] < segments["stop"].values[1]
        saw = 0.3 * 31.0 * ((run["position"] / 50e-6) % 1.0)
        run["friction_force"] += (saw * np.sign(run["sliding_velocity"])).where(inside, 0.0)
        return run, segments, friction

    made = without_curves(_one(tmp_path, sawing))
    write_report(made, figures="none")
    sawn = json.loads((made.folder / "report.json").read_text())
    valid(sawn)
    assert sawn["runs"][0]["stick_slip"] == {
        "class": "sawtooth stick-slip",
        "detail": "at 1 of 3 speeds",
    }
    page = (made.folder / "report.html").read_text()
    assert "sawtooth stick-slip<br><small>at 1 of 3 speeds</small>" in page
    quiet = {"class": "smooth sliding", "detail": ""}
    # the run that failed has none
    assert [run["stick_slip"] for run in report["runs"]] == [quiet] * len(RUNS) + [None]


def test_the_part_of_the_track_that_counts_is_told(tmp_path):
    def part(run, segments, friction):
        segments.attrs |= {"position_low_m": 0.005, "position_high_m": 0.032}
        return run, segments, friction

    made = without_curves(_one(tmp_path, part))
    write_report(made, figures="none")
    report = json.loads((made.folder / "report.json").read_text())
    valid(report)
    assert report["runs"][0]["position_range_m"] == [0.005, 0.032]
    assert any("outside positions 5 to 32 mm" in one["message"] for one in report["findings"])
    assert "5 to 32 mm; the rest of each stroke" in details_of(made.folder)[0]


def test_every_check_of_every_run_stands_in_a_table(tmp_path, outcome):
    rows = [
        {"check": "spikes", "variable": "friction_force", "status": "pass", "value": 0.0,
         "unit": "1", "message": "none", "cure": ""},
        {"check": "load", "variable": "", "status": "skipped", "value": None, "unit": "",
         "message": "no set-point", "cure": ""},
    ]  # fmt: skip
    runs = [("one", "", "dry", 31.0, 0.8), ("two", "", "dry", 31.0, 0.8)]
    made = made_outcome(tmp_path, runs, speeds=[1e-2], samples=50)
    for index, findings in ((0, rows), (1, rows[:1])):
        run, segments, friction = made_run([1e-2], samples=50)
        run.attrs["findings"] = findings
        made = with_run(made, index, (run, segments, friction))
    write_report(made, figures="none")
    checks = table(made, "checks")
    checks = checks[checks.check.isin([row["check"] for row in rows])]
    assert checks["run"].tolist() == ["one", "one", "two"]
    assert checks["status"].tolist() == ["pass", "skipped", "pass"]
    names = ["run", "check", "variable", "status", "value", "unit", "message"]
    for one in (checks, table(outcome, "checks")):  # also where no check said anything
        assert list(one.columns) == names


def test_a_run_without_speeds_counts_segments_and_one_too_short_is_not_evaluated():
    saw = "sawtooth stick-slip"
    slip = made_slip(["smooth sliding", saw, saw, "not evaluated"], [np.nan] * 4)
    assert stick_slip_of(slip) == Waveform(saw, "in 2 of 3 segments")
    still = made_slip(["smooth sliding"] * 3, [np.nan] * 3)
    assert stick_slip_of(still).detail == "if it slides: speed not known"
    slip = made_slip([saw] * 3, [1e-6, 2e-6, 4e-6])
    assert stick_slip_of(slip) == Waveform(saw, "at 3 of 3 speeds")
    slip = made_slip(["not decided"] * 2 + ["smooth sliding"], [1e-6, 2e-6, 4e-6])
    assert stick_slip_of(slip) == Waveform("not decided", "at 2 of 3 speeds")
    slip = made_slip(["not evaluated"], [1e-6])
    assert stick_slip_of(slip) == Waveform("not evaluated", "")


def made_slip(kinds, speeds):
    names = ("drop", "dominant_wavelength", "dominant_frequency", "fall_share", "harmonic_content")
    data = {name: ("segment", np.ones(len(kinds))) for name in names}
    data["waveform"] = "segment", np.array(kinds, dtype=object)
    data["instrument"] = "segment", np.array([""] * len(kinds), dtype=object)
    return xr.Dataset(data | {"sliding_speed": ("segment", np.array(speeds))})


def test_run_without_load_is_told_by_its_half_loops(tmp_path):
    def no_load(run, segments, friction):
        gone = [name for name in friction.data_vars if "coefficient" in name]
        return run.drop_vars("normal_force"), segments, friction.drop_vars([*gone, "normal_force"])

    made = without_curves(_one(tmp_path, no_load))
    write_report(made, figures="none")
    report = json.loads((made.folder / "report.json").read_text())
    valid(report)
    run = report["runs"][0]
    assert run["quantity"] == "half_loop"
    assert run["value_min"] == pytest.approx(0.8 * 31, rel=0.02)
    assert "half loop from 24" in report["verdict"]["text"]
    [shown] = json.loads(made.store.trace("run", "only").coarse)["signals"][:1]
    assert (shown["name"], shown["unit"]) == ("friction_force", "N")


def test_unknown_speeds_are_null_and_averaged_over_all(tmp_path):
    def speedless(run, segments, friction):
        nan = ("segment", np.full(friction.sizes["segment"], np.nan))
        run = run.drop_vars(["sliding_velocity", "position"])
        return run, segments.assign(sliding_speed=nan), friction.assign(sliding_speed=nan)

    made = _one(tmp_path, speedless)
    [mark] = made.store.get("run", "only", RunRecord).record.facts.highlights
    assert (mark.where, mark.sliding_speed_m_s, mark.segments) == ("all", None, 6)


def test_drifting_and_backward_friction_is_said(tmp_path):
    def odd(run, segments, friction):
        friction = friction.copy()
        friction["trend_p_value"] = "segment", [1e-4, 1e-4, 0.3, 0.3, 0.3, 0.3]
        friction["trend_change"] = 0.1 * friction["friction_coefficient"]
        friction["friction_coefficient"][3] *= -1
        friction.attrs["offset"] = "none: strokes in one direction only"
        return run, segments, friction

    write_report(made := _one(tmp_path, odd), figures="none")
    messages = " | ".join(table(made, "checks").message)
    assert "2 segments of 6 with a significant trend, at most 10 % of the" in messages
    assert "1 segment of 6 with friction along the motion" in messages
    assert "none: strokes in one direction only" in messages
    (segments,) = details_of(made.folder)
    assert segments.count("%, significant</td>") == 2


@pytest.mark.slow
@pytest.mark.parametrize("note", ["Simulated <by> a rig.", None])
def test_the_campaign_s_note_stands_at_the_top_of_the_page(tmp_path, note):
    made = made_outcome(tmp_path, [("one", "Sb-R", "dry", 31.0, 0.8)], samples=60)
    about = made.campaign.campaign.model_copy(update={"note": note})
    campaign = made.campaign.model_copy(update={"campaign": about})
    campaign.set_file(made.campaign.file)
    write_report(replace(made, campaign=campaign), figures="none")
    valid(json.loads((made.folder / "report.json").read_text()))
    top = (made.folder / "report.html").read_text(encoding="utf-8").split("</header>")[0]
    assert ("Simulated &lt;by&gt; a rig.</li>" in top) == bool(note)
    assert ("campaign" in table(made, "checks")["check"].tolist()) == bool(note)


@pytest.mark.slow
def test_evidence_leads_to_traces_and_what_is_the_same_is_said_once(tmp_path):
    runs = [("a", "Sand S", "dry", 31.0, 0.8), ("b", "sand/s", "dry", 31.0, 0.6)]
    write_report(made := made_outcome(tmp_path, runs, speeds=[1e-5, 1e-3]))
    page = (made.folder / "report.html").read_text(encoding="utf-8")
    section = page.split('<h3 id="mode-1">')[1].split("</section>")[0]
    assert section.startswith("Sand S, dry, at 31 N; sand/s, dry, at 31 N</h3>")
    assert 'href="#sliding-traces"' in section and "mode-2" not in page
    figure = figures_of(made.folder)["sliding-traces"]
    traces, way = figure["series"], figure["panels"][0]["x"]
    longest = max(one["x"][-1] for one in traces)  # in a unit that needs no powers of ten
    assert way["unit"] in ("µm", "mm", "m") and 1 <= longest < 1e4
    assert {one["surface"] for one in traces} == {"Sand S", "sand/s"}


@pytest.mark.slow
def test_a_broken_data_file_costs_only_its_own_place(tmp_path):
    made = made_outcome(
        tmp_path / "two",
        [("good", "Sb-R", "glycerol", 31.0, 0.8), ("torn", "Sb-R", "glycerol", 31.0, 0.8)],
        samples=60,
    )
    (made.folder / made.curves[0].data_file).write_bytes(b"CDF torn")
    write_report(made)
    report = json.loads((made.folder / "report.json").read_text())
    valid(report)
    torn = [one for one in report["findings"] if one["severity"] == "error"]
    assert [one["where"].split()[0] for one in torn] == ["stick-slip"]
    # what is recorded is shown all the same
    assert [len(run["segments"]) for run in report["runs"]] == [6, 6]
    assert len(report["curves"]) == 1


def test_a_curve_that_failed_is_a_finding(tmp_path):
    made = made_outcome(tmp_path / "c", [("one", "Sb-R", "glycerol", 31.0, 0.8)])
    failed = replace(made.curves[0], status="failed", data_file="", reason="no speed is known")
    made.store.put("curve", failed.name, 0, "", CurveRecord(failed))
    write_report(replace(made, curves=(failed,)), figures="none")
    findings = table(made, "checks")
    assert findings.message.iloc[0] == "no measured curve: no speed is known"
    assert findings.status.iloc[0] == "suspect"


def unpacked(signal, clock):
    """The times and values of a signal, as the page reads them."""
    raw = base64.b64decode(signal["data"])
    raw = zlib.decompress(raw) if signal["deflated"] else raw
    planes = np.frombuffer(raw, np.uint8).reshape(-1, signal["points"]).astype(float)
    width = signal["step_bytes"]
    steps, levels = (
        256.0 ** np.arange(len(part)) @ part for part in (planes[:width], planes[width:])
    )
    value = signal["low"] + levels / 65534 * (signal["high"] - signal["low"])
    value = np.where(levels > 65534, np.nan, value)
    if signal.get("linear_below"):
        value = signal["linear_below"] * np.sinh(value)
    return np.interp(np.cumsum(steps), *clock), value


def test_a_gap_in_the_motion_does_not_hide_it():
    run, segments, friction = made_run(samples=3000)
    whole = [one["name"] for one in decimated_trace(run, segments, friction, 2000)["signals"]]
    run["sliding_velocity"][700] = np.nan
    gaps = [one["name"] for one in decimated_trace(run, segments, friction, 2000)["signals"]]
    assert gaps == whole and "sliding_velocity" in whole


@pytest.mark.parametrize("fine", [False, True])
def test_traces_for_the_page_are_the_signals_with_every_extreme(fine):
    run, segments, friction = made_run(samples=3000)
    run["friction_force"][7000] = 900.0
    packed = decimated_trace(run, segments, friction, 2000)
    clock = packed["clock"]
    assert len(clock[0]) < 40, "a knot where the rate of sampling changes"
    if fine:
        packed = json.loads(finer_trace(run, segments, friction, 2000, 25_000))
    assert not packed["complete"] and packed["signals"][0]["points"] < (13_000 if fine else 2200)
    step = np.diff(run.time.values)
    within = np.minimum(np.r_[step, step[-1]], np.r_[step[0], step]) / 4 + 1e-5
    for signal, name in zip(packed["signals"], ("ratio", "sliding_velocity"), strict=True):
        time, value = unpacked(signal, clock)
        assert signal["points"] > (2500 if fine else 900)
        true = (run.friction_force / run.normal_force if name == "ratio" else run[name]).values
        at = np.round(np.interp(time, run.time.values, np.arange(run.sizes["time"]))).astype(int)
        assert np.all(np.abs(time - run.time.values[at]) <= within[at])
        resolution = np.ptp(true) / 65534 if name == "ratio" else 1e-3 * np.abs(true[at]) + 1e-9
        assert np.all(np.abs(value - true[at]) <= resolution)
        assert value.max() == pytest.approx(true.max(), rel=1e-4)
    assert script_json({"a": "</script>"}) == '{"a":"\\u003c/script>"}'


@pytest.mark.parametrize(("jitter", "counted"), [(0.0, True), (0.1, True), (0.9, False)])
@pytest.mark.parametrize("deflate", [False, True])
def test_points_with_gaps_pack_into_what_they_were(jitter, counted, deflate):
    rng = np.random.default_rng(4)
    time = 1e-3 * (np.arange(40_000) + jitter * rng.uniform(0, 1, 40_000))
    time[30_000:] += 50.0
    time -= time[0]
    value = np.where(np.arange(time.size) % 7 == 3, np.nan, rng.normal(size=time.size))
    clock = clock_of(time)
    assert (clock.ticks is None) == counted
    few = np.sort(rng.choice(np.arange(1, time.size - 1), 900, replace=False))
    for pick in (few, np.array([0, time.size - 1]), np.arange(time.size)):
        packed = pack_points(clock.places(pick), value[pick], deflate=deflate)
        found = unpacked(packed, (clock.knots, clock.at_s))
        assert np.abs(found[0] - time[pick]).max() < 0.26e-3
        np.testing.assert_allclose(found[1], value[pick], atol=1e-4)


def test_finer_trace_holds_to_its_size_and_is_left_out_where_it_adds_nothing():
    run, segments, friction = made_run(samples=3000)
    sizes = [len(finer_trace(run, segments, friction, 500, size)) for size in (9e5, 3e4, 1.5e4)]
    assert sizes[0] > 3e4 >= sizes[1] > 1.5e4 >= sizes[2] > 0
    assert json.loads(finer_trace(run, segments, friction, 500, 9e5))["complete"]
    assert finer_trace(run, segments, friction, 500, 2000) == ""
    assert finer_trace(run, segments, friction, run.sizes["time"], 9e5) == ""


def test_flagged_spans_say_where_why_and_how_gravely():
    run, _, _ = made_run(speeds=[1e-2])
    flags = np.ones(run.sizes["time"], np.int8)
    flags[100:103], flags[400] = 3, 4
    run = attach(run, "friction_force", {"spikes": flags}, {"spikes": 14})
    spans = flagged_spans(run)
    kinds = [(span.severity, span.checks) for span in spans]
    assert kinds == [("suspect", ("spikes",)), ("fail", ("spikes",))]
    assert spans[0].start_s == pytest.approx(float(run.time[100]))
    assert spans[0].stop_s == pytest.approx(float(run.time[102]))


def test_a_curve_without_stick_slip_over_speed_is_shown_and_says_so():
    outcome = CurveOutcome("c", "a", "oil", None, "data/c.nc", ("first", "second"))
    curve = CurveRecord(outcome, ({"friction_coefficient": 0.3},), no_slip="two kinds of names")
    shown, said = shown_curves([curve, replace(curve, no_slip="")], {})
    assert len(shown) == 2
    assert said == [("error", "first; second", "c", "no stick-slip over speed: two kinds of names")]
