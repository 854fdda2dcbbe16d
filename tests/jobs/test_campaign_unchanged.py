"""Nothing is done where nothing changed, changes are noticed, and failures that may end retried."""

import os
import shutil
import time
from dataclasses import replace
from pathlib import Path

import pytest
from campaigns import RUNS, copied, fingerprint

from tribolab.app.run import run_campaign
from tribolab.campaign.runs import stage as runs_module
from tribolab.campaign.settings.load import load_and_plan
from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.store.outcome import Outcome
from tribolab.campaign.store.unchanged import note, unchanged
from tribolab.records.parts import CurveOutcome, RunOutcome
from tribolab.report import code

OPTIONS = {"figures": "none", "pdf": False, "tables": "csv", "code": code.code_of_page()}


@pytest.fixture
def campaign(two_runs, tmp_path):
    return copied(two_runs, tmp_path)


def run(campaign, **options):
    return run_campaign(campaign, jobs=1, **({"figures": "none"} | options))


def refuse(*given, **more):
    raise AssertionError("work was done")


@pytest.mark.slow
def test_what_did_not_change_is_told_without_work_and_leaves_the_folder_untouched(
    campaign, monkeypatch, tmp_path
):
    first = run(campaign)
    before, folder = fingerprint(first.folder), first.folder.stat()
    with monkeypatch.context() as guarded:
        for name in ("process", "write_report"):
            place = "campaign.pipeline" if name == "process" else "report.results"
            guarded.setattr(f"tribolab.{place}.{name}", refuse)
        guarded.setattr("tribolab.campaign.store.new_catalogue.sha256_of_file", refuse)
        guarded.setattr("tribolab.reading.netcdf.netcdf.read_netcdf", refuse)
        again = run(campaign)
    assert fingerprint(first.folder) == before and first.folder.stat() == folder
    assert again.runs == tuple(replace(run, reused=True) for run in first.runs)
    assert (again.curves, again.sources) == (first.curves, first.sources)
    assert [s.name for s in again.surfaces] == [s.name for s in first.surfaces]

    # copied and touched files are the same: read, and nothing is done
    elsewhere = copied(campaign, tmp_path / "elsewhere")
    for path in filter(Path.is_file, elsewhere.parent.rglob("*")):
        path.touch()
    with monkeypatch.context() as guarded:
        guarded.setattr("tribolab.campaign.pipeline.process", refuse)
        assert [one.reused for one in run(elsewhere).runs] == [True, True]
        assert run(campaign, verify=True).runs == again.runs

    # everything that may change is noticed
    assert unchanged(*load_and_plan(campaign), first.folder, OPTIONS)
    assert not unchanged(*load_and_plan(campaign), first.folder, OPTIONS | {"pdf": True})
    (first.folder / "tables/friction.csv").write_text("mine")
    assert not unchanged(*load_and_plan(campaign), first.folder, OPTIONS)
    run(campaign)
    [mine] = fingerprint(first.folder).keys() - before.keys()
    assert mine.startswith("tables/friction.changed-") and before.keys() < {
        *fingerprint(first.folder)
    }
    raw = campaign.parent / f"raw/friction/{RUNS[0]}_force.csv"
    state = raw.stat()
    raw.write_bytes(raw.read_bytes().replace(b"1", b"2", 1))
    os.utime(raw, ns=(state.st_atime_ns, state.st_mtime_ns + 1))  # as long, a nanosecond later
    assert not unchanged(*load_and_plan(campaign), first.folder, OPTIONS)
    assert [one.reused for one in run(campaign).runs] == [False, True]


@pytest.mark.slow
def test_another_code_of_the_report_makes_the_page_anew_and_nothing_else(
    campaign, monkeypatch, tmp_path
):
    first = run(campaign)
    before = fingerprint(first.folder)
    package = tmp_path / "tribolab"
    for room in ("report", "figures", "records"):
        shutil.copytree(code._PACKAGE / room, package / room)
    monkeypatch.setattr(code, "_PACKAGE", package)
    made = code.code_of_page.__wrapped__(), code.code_of_figures.__wrapped__()
    assert made == (code.code_of_page(), code.code_of_figures()), "wherever it is installed"
    style = package / "report/assets/report.css"
    style.write_text(style.read_text("utf-8") + "\n", "utf-8")
    assert code.code_of_figures.__wrapped__() == made[1], "a style draws no figure anew"
    monkeypatch.setattr("tribolab.app.run.code_of_page", code.code_of_page.__wrapped__)
    again = run(campaign)
    assert all(one.reused for one in again.runs)
    after = fingerprint(first.folder)
    assert after["report.html"] != before["report.html"]
    assert {name for name in after if name.startswith("data/") and after[name] != before[name]} == (
        set()
    )


@pytest.mark.slow
def test_a_failure_that_may_not_last_is_tried_again_and_one_of_the_files_is_not(
    campaign, monkeypatch
):
    shutil.rmtree(campaign.parent / "results")  # else they would be kept
    bad = campaign.parent / f"raw/friction/{RUNS[0]}_force.csv"
    bad.write_text("Lunch is at noon.\n")
    os.utime(bad, (time.time() - 60,) * 2)
    assert [one.error for one in run(campaign).failed] == ["ReadError"]
    with monkeypatch.context() as guarded:
        guarded.setattr("tribolab.campaign.pipeline.process", refuse)
        assert [one.error for one in run(campaign).failed] == ["ReadError"]

    analyse = runs_module.analyse_run

    def out_of_memory(*given):
        raise MemoryError("for now")

    monkeypatch.setattr(runs_module, "analyse_run", out_of_memory)
    campaign.write_text(campaign.read_text("utf-8").replace("trim = 0.10", "trim = 0.12"), "utf-8")
    assert "MemoryError" in {one.error for one in run(campaign).failed} | {
        one.kept and "MemoryError" for one in run(campaign).runs
    }
    monkeypatch.setattr(runs_module, "analyse_run", analyse)
    done = run(campaign)
    assert [(one.name, one.kept) for one in done.runs if one.done] == [(RUNS[2], "")]


def test_what_is_kept_crashed_or_not_readable_is_never_taken_for_final(two_runs, tmp_path):
    campaign, planned = load_and_plan(two_runs)
    store = Store(tmp_path)
    run = {"name": "a", "files": ("a.csv",), "surface": "", "medium": "", "normal_force": None}
    done = RunOutcome(**run, status="done", data_file="data/a.nc")
    curve = CurveOutcome("c", "", "", None, "data/c.nc", ("a",))
    whole = Outcome(campaign, tmp_path, store, (done,), (curve,), (("a.csv", "ab" * 32, 3),))
    for doubtful in (
        replace(whole, runs=(replace(done, kept="kept from before"),)),
        replace(whole, runs=(replace(done, status="failed", error="WorkerDied"),)),
        replace(whole, curves=(replace(curve, status="failed", crash="Traceback"),)),
        replace(whole, sources=(("a.csv", "", 0),)),
    ):
        note(doubtful, planned, OPTIONS)
        assert store.fact("made from") == ""
    note(whole, planned, OPTIONS)
    assert store.fact("made from")
    store.close()
