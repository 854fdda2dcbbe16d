"""Good results do not go with a raw file that cannot be read for an hour."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import jsonschema
import pandas as pd
import pytest
from campaigns import RUNS, copied, simulated, surfaces_alone
from typer.testing import CliRunner

import tribolab
from tribolab.app.run import run_campaign
from tribolab.campaign.models.kept import kept_model
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.store.new_catalogue import Store
from tribolab.cli import app
from tribolab.core.errors import ConfigError
from tribolab.records.part_records import ModelRecord, ModelRows
from tribolab.records.parts import ModelOutcome

SCHEMA = Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json"


RUNS = (RUNS[0], RUNS[2])  # of a campaign without repeats
QUIET = ("-q", "-j", "1")
ROWS = ModelRows(None, ({"sliding_speed_m_s": 1e-3, "friction_coefficient": 0.5},))


@pytest.fixture
def campaign(two_runs, tmp_path):
    return copied(two_runs, tmp_path)


def table(campaign, name="friction"):
    return pd.read_csv(campaign.parent / "results" / "tables" / f"{name}.csv")


def first_log(campaign, log="force"):
    return campaign.parent / f"raw/friction/{RUNS[0]}_{log}.csv"


def emptied(path):
    path.write_bytes(b"")


def spoilt(path):
    path.write_text("Lunch is at noon.\n")


def made_a_folder(path):
    path.unlink()
    path.mkdir()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spoil", "log"), [(emptied, "force"), (spoilt, "motion"), (Path.unlink, "motion")]
)
def test_the_earlier_result_of_a_run_is_kept_and_says_so(campaign, spoil, log):
    before = table(campaign)
    spoil(first_log(campaign, log))
    answer = CliRunner().invoke(app, ["run", str(campaign), *QUIET])
    assert answer.exit_code == 3
    assert re.search(rf"{RUNS[0]}.*kept from 20\d\d-.*cannot be read now", answer.output)
    after = table(campaign)
    pd.testing.assert_frame_equal(after, before)
    report = json.loads((campaign.parent / "results/report.json").read_text("utf-8"))
    jsonschema.validate(report, json.loads(SCHEMA.read_text("utf-8")))
    assert [run["name"] for run in report["runs"]] == list(RUNS)
    assert [bool(run["kept"]) for run in report["runs"]] == [True, False]
    assert report["verdict"]["kept"] == 1 and report["verdict"]["status"] == "incomplete"
    assert "kept from" in (campaign.parent / "results/report.html").read_text("utf-8")


@pytest.mark.slow
def test_what_is_kept_stays_from_the_same_moment_until_the_file_is_there_again(campaign):
    raw = first_log(campaign).read_bytes()
    emptied(first_log(campaign))
    first, again = (run_campaign(campaign, jobs=1, figures="none").runs[0] for _ in range(2))
    assert again.kept.split(": ")[0] == first.kept.split(": ")[0]
    first_log(campaign).write_bytes(raw)
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert not outcome.kept
    report = json.loads((campaign.parent / "results/report.json").read_text("utf-8"))
    assert report["verdict"]["status"] == "complete"


@pytest.mark.slow
def test_a_run_is_dropped_when_the_campaign_names_it_no_more(campaign):
    text = campaign.read_text("utf-8")
    emptied(first_log(campaign))
    start, stop = text.index("[[run]]"), text.index("[[run]]", text.index("[[run]]") + 1)
    campaign.write_text(text[:start] + text[stop:], "utf-8")
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert RUNS[0] not in [run.name for run in outcome.runs] and not outcome.kept


@pytest.mark.slow
def test_a_raw_file_that_was_renamed_is_not_counted_twice(campaign):
    for log in ("force", "motion"):
        path = first_log(campaign, log)
        path.rename(path.with_name(path.name.replace("_01_", "_07_")))
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert not outcome.kept and len(outcome.runs) == len(RUNS)
    assert {run.name for run in outcome.runs} == {RUNS[0].replace("_01", "_07"), *RUNS[1:]}


@pytest.fixture
def scanned(tmp_path):
    """A campaign of scans alone; adhesion would take as long as all the rest."""
    campaign = surfaces_alone(simulated(tmp_path, repeats=1, scans=True))
    text, count = re.subn(r"(?m)^work_of_adhesion.*\n", "", campaign.read_text("utf-8"))
    assert count
    campaign.write_text(text, "utf-8")
    return campaign


@pytest.mark.slow
def test_the_spectrum_of_all_scans_is_kept_when_one_cannot_be_read(scanned, tmp_path):
    campaign = scanned
    [scan] = (campaign.parent / "raw/profiles").iterdir()
    second = scan.with_name("sb-r_second.csv")
    second.write_bytes(scan.read_bytes() + b"\n")  # of other content, like every scan
    read = load_campaign(campaign)
    before = process(read, tmp_path / "0")
    content = (tmp_path / "0" / before.surfaces[0].data_file).read_bytes()
    for number, spoil in enumerate((emptied, Path.unlink)):
        spoil(second)
        new = tmp_path / str(number + 1)
        outcome = process(read, new, previous=tmp_path / str(number))
        [surface] = outcome.surfaces
        assert surface.kept.startswith("kept from 20") and "sb-r_second.csv" in surface.kept
        assert surface.unreadable  # so the exit code is 3
        assert (new / surface.data_file).read_bytes() == content


@pytest.mark.slow
def test_rubber_friction_is_kept_when_its_modulus_cannot_be_read(scanned, tmp_path):
    campaign = scanned
    modulus = campaign.parent / "raw/dma.csv"
    modulus.write_text("f,E_stor,E_loss\nHz,MPa,MPa\n0.001,1.5,0.1\n1e3,1.8,0.3\n1e9,90,30\n")
    text = campaign.read_text("utf-8")
    campaign.write_text(text.replace("[contact]", '[contact]\nmodulus_file = "dma.csv"'), "utf-8")
    read = load_campaign(campaign)
    [before] = process(read, tmp_path / "0").surfaces
    assert "modulus" in before.parts and not before.unreadable
    modulus.write_bytes(b"")
    [alone] = process(read, tmp_path / "alone").surfaces
    assert "modulus" not in alone.parts and alone.unreadable
    [surface] = process(read, tmp_path / "1", previous=tmp_path / "0").surfaces
    assert surface.kept.startswith("kept from 20") and "dma.csv cannot be read" in surface.kept
    assert surface.parts == before.parts and surface.unreadable


def test_a_model_that_cannot_be_computed_now_is_kept(tmp_path):
    for name in ("old", "new"):
        (tmp_path / name / "data").mkdir(parents=True)
    (tmp_path / "old/data/model_a.nc").write_bytes(b"")
    of = {"curve": "a", "surface": "s", "medium": "m", "normal_force": 31.0}
    done = ModelOutcome(name="model_a", **of, status="done", data_file="data/model_a.nc")
    earlier = Store(tmp_path / "old")
    earlier.put("model", "model_a", 0, "made so", ModelRecord(done, ROWS))
    earlier.close()
    store = Store(tmp_path / "new", tmp_path / "old")
    died = replace(done, status="failed", error="WorkerDied", reason="out of memory", data_file="")
    kept = kept_model(store, ModelRecord(died))
    assert kept.outcome.done and "out of memory" in kept.outcome.kept
    assert kept.rows == ROWS
    assert (tmp_path / "new/data/model_a.nc").exists()
    wrong = ModelRecord(replace(died, error="AnalysisError"))  # an answer about the data stands
    assert kept_model(store, wrong) == wrong
    (tmp_path / "old/data/model_a.nc").write_bytes(b"other")  # not what the record is of
    assert kept_model(store, ModelRecord(died)) == ModelRecord(died)
    store.close()


@pytest.mark.slow
def test_an_answer_about_data_that_were_read_replaces_the_earlier_one(campaign):
    text = campaign.read_text("utf-8")
    campaign.write_text(f"{text}\n[qc.limits.segments]\nmin_duration = '9 h'\n", "utf-8")
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert not any(run.kept for run in outcome.runs) and outcome.segments == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        (r"\[\[surface\]\]", '[[surface]]\nscans = "../results/mine"', "a scan"),
        (r"files = .*", 'files = "../results/mine"', "a raw file"),
        (r"\[contact\]", '[contact]\nmodulus_file = "../results/mine"', "the modulus file"),
        (r"instrument = .*", 'instrument = "results/mine.toml"', "a dialect"),
    ],
    ids=lambda text: text.split()[-1],
)
def test_inputs_inside_the_results_are_refused_before_work_starts(campaign, old, new, what):
    results = campaign.parent / "results"
    dialect = Path(tribolab.__file__).parents[1] / "raw_data_schema/instruments/linear_slider.toml"
    shutil.copy(dialect, results / "mine.toml")
    shutil.copy(first_log(campaign), results / "mine")
    campaign.write_text(re.sub(old, new, campaign.read_text("utf-8"), count=1), "utf-8")
    with pytest.raises(ConfigError, match=rf"{what} \(mine.*--output"):
        run_campaign(campaign, jobs=1, figures="none")


@pytest.mark.slow
def test_notes_in_the_results_survive_and_are_named(campaign):
    note = campaign.parent / "results" / "notes.md"
    note.write_text("squeal at 1 mm/s")
    text = campaign.read_text("utf-8")
    campaign.write_text(text.replace("trim = 0.10", "trim = 0.2"), "utf-8")
    answer = CliRunner().invoke(app, ["run", str(campaign), *QUIET])
    assert answer.exit_code == 0 and "kept: notes.md" in answer.output
    assert note.read_text() == "squeal at 1 mm/s"
