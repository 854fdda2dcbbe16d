"""The pipeline over the runs: all that can be done is done, what cannot be says why."""

import errno
import json
import multiprocessing
import os
import pickle
import re
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from campaigns import RUNS, copied, fingerprint, simulated

import tribolab
import tribolab as tl
from tribolab.app.needed import ANALYSIS
from tribolab.campaign.engine.executor import workers
from tribolab.campaign.engine.pool import WorkerDied
from tribolab.campaign.pipeline import process
from tribolab.campaign.runs import stage
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.settings.plan import planned_runs
from tribolab.core.errors import ConfigError, OutputError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.runs.traces import trace_size
from tribolab.report.page.reviewing import review_data
from tribolab.rig import read_truth


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("simulated"))


@pytest.fixture(scope="module")
def untouched(original):
    """What the campaign's files were before anything was done with them."""
    return fingerprint(original.parent)


@pytest.fixture(scope="module")
def done(original, untouched, tmp_path_factory):
    """The campaign, processed once in this process; not to be changed."""
    return process(load_campaign(original), tmp_path_factory.mktemp("results"))


@pytest.fixture
def campaign(original, tmp_path):
    return copied(original, tmp_path)


@pytest.fixture
def dry(campaign):
    """The campaign without its runs in glycerol."""
    glycerol = r'\n\[\[run\]\]\nfiles = "[^"]*_glycerol_.*?(?=\n\[|\Z)'
    text, count = re.subn(glycerol, "", campaign.read_text("utf-8"), flags=re.DOTALL)
    assert count == 1
    campaign.write_text(text, "utf-8")
    return campaign


def again(campaign, done, folder, **options):
    folder.mkdir(exist_ok=True)
    return process(load_campaign(campaign), folder, previous=done.folder, **options)


def edit(path, old, new):
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.slow
def test_every_run_and_every_condition_has_its_data_file(done):
    assert [run.name for run in done.runs] == list(RUNS)
    assert all(run.done and run.segments >= 6 and not run.reused for run in done.runs)
    assert [(c.medium, c.normal_force, c.run_names) for c in done.curves] == [
        ("glycerol", 31.0, RUNS[:2]),
        ("dry", 31.0, RUNS[2:]),
    ]
    files = {path.name for path in (done.folder / "data").iterdir()}
    assert files == {f"{name}.nc" for name in RUNS} | {
        "curve_Sb-R_glycerol_31N.nc",
        "curve_Sb-R_dry_31N.nc",
    }


@pytest.mark.slow
def test_a_data_file_holds_signals_segments_and_friction_with_their_origin(done, original):
    path = done.folder / done.runs[0].data_file
    for group in ("run", "segments", "friction"):
        data = read_netcdf(path, group=group)
        assert data.attrs["tribolab_version"] == tribolab.__version__
        assert (data.attrs["surface"], data.attrs["medium"]) == ("Sb-R", "glycerol")
        assert len(data.attrs["config_sha256"]) == 64
    friction = read_netcdf(path, group="friction")
    assert friction.friction_coefficient.sizes == {"segment": done.runs[0].segments}
    assert friction.attrs["trim"] == 0.10
    sources = {name: checksum for name, checksum, _ in done.sources}
    raw = fingerprint(original.parent)
    used = [name for name in raw if name.startswith("raw/friction")]
    assert sources == {name: raw[name][0] for name in used}


@pytest.mark.slow
def test_opened_without_a_group_a_data_file_says_what_it_is_and_what_it_holds(done, original):
    raw = fingerprint(original.parent)
    for run, curve in ((done.runs[0], done.curves[0]), (done.runs[2], done.curves[1])):
        with xr.open_dataset(done.folder / run.data_file) as root:
            origin = root.attrs
        assert origin["groups"].split("; ") == ["run", "segments", "friction", "stick_slip"]
        assert origin["Conventions"].startswith("CF-") and run.name in origin["history"]
        assert origin["tribolab_version"] == tribolab.__version__
        signals = read_netcdf(done.folder / run.data_file, group="run").attrs
        for key in ("source", "source_sha256", "config_sha256"):
            assert origin[key] == signals[key]
        assert tl.read(done.folder / run.data_file).attrs == signals

        with xr.open_dataset(done.folder / curve.data_file) as data:
            origin = data.attrs
        names, sums = origin["source"].split("; "), origin["source_sha256"].split("; ")
        files = {f"raw/friction/{name}": one for name, one in zip(names, sums, strict=True)}
        assert len(files) == 2 * len(curve.run_names)
        assert files == {name: raw[name][0] for name in files}
        assert origin["tribolab_version"] == tribolab.__version__
        assert len(origin["config_sha256"]) == 64 and origin["history"] and origin["Conventions"]


@pytest.mark.slow
def test_a_measured_curve_takes_its_runs_together(done):
    curve = read_netcdf(done.folder / done.curves[0].data_file)
    at_set_speeds = curve.sel(sliding_speed=[4.64e-6, 1e-4, 2.15e-3], method="nearest")
    np.testing.assert_allclose(at_set_speeds.sliding_speed, [4.64e-6, 1e-4, 2.15e-3], rtol=0.05)
    assert at_set_speeds.runs.values.tolist() == [2, 2, 2]


@pytest.mark.slow
def test_raw_files_are_only_read(original, untouched, done):
    assert fingerprint(original.parent) == untouched


@pytest.mark.slow
def test_a_file_that_is_bad_missing_or_vanishes_on_the_way_costs_its_own_run_only(
    campaign, tmp_path
):
    raw = campaign.parent / "raw/friction"
    bad, gone = (raw / f"{name}_force.csv" for name in (RUNS[0], RUNS[2]))
    bad.write_text("Lunch is at noon.\n")
    (raw / f"{RUNS[3]}_motion.csv").unlink()

    def progress(stage, done, total):
        gone.unlink(missing_ok=True)

    outcome = process(load_campaign(campaign), tmp_path, progress=progress)
    unreadable, vanished, alone = outcome.failed
    assert [run.name for run in outcome.failed] == [RUNS[0], RUNS[2], f"{RUNS[3]}_force"]
    assert bad.name in unreadable.reason and unreadable.error == "ReadError"
    assert gone.name in vanished.reason
    assert "sliding speed" in alone.reason
    assert outcome.curves[0].run_names == RUNS[1:2]
    assert [path.name for path in (tmp_path / "data").glob("sb*")] == [f"{RUNS[1]}.nc"]
    missing = next(source for source in outcome.sources if gone.name in source[0])
    assert missing[1:] == ("", 0)


@pytest.mark.slow
def test_a_mistake_of_ours_costs_the_run_and_says_where(campaign, tmp_path, monkeypatch):
    def broken(*given):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr(stage, "analyse_run", broken)
    outcome = process(load_campaign(campaign), tmp_path)
    assert outcome.curves == ()
    assert outcome.runs[0].error == "ZeroDivisionError"
    said = "crashed with ZeroDivisionError at campaign/runs/stage.py:"
    assert outcome.runs[0].reason.startswith(said)


@pytest.mark.slow
def test_what_did_not_change_is_not_done_again(campaign, done, tmp_path):
    for path in campaign.parent.rglob("*.csv"):
        os.utime(path)  # touched, not changed
    outcome = again(campaign, done, tmp_path / "new")
    assert all(run.reused for run in outcome.runs)
    for run in outcome.runs:
        new, old = (folder / run.data_file for folder in (outcome.folder, done.folder))
        assert new.read_bytes() == old.read_bytes()
    assert [(r.name, r.segments, r.normal_force) for r in outcome.runs] == [
        (r.name, r.segments, r.normal_force) for r in done.runs
    ]
    assert outcome.curves == done.curves
    assert outcome.sources == done.sources


@pytest.mark.slow
def test_files_and_folders_whose_names_are_not_utf8_are_analysed(dry, tmp_path):
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/in\xff"))
    dry.parent.rename(folder)
    for path in list((folder / "raw/friction").glob("*dry_31N_02*")):
        path.rename(Path(os.fsdecode(os.fsencode(path).replace(b"N_02", b"N_\xe4"))))
    config = load_campaign(folder / dry.name)
    outcome = process(config, folder / "new")
    assert [run.status for run in outcome.runs] == ["done"] * 2
    assert all(curve.done for curve in outcome.curves)
    files = [name for run in outcome.runs for name in run.files]
    assert "raw/friction/sb-r_dry_31N_\\xe4_force.csv" in files
    assert reused(process(config, folder / "next", previous=outcome.folder)) == [
        run.name for run in outcome.runs
    ]
    shown = [files, outcome.sources, review_data(config, [])]
    json.dumps(shown, ensure_ascii=False).encode()  # it is text throughout


def reused(outcome):
    return [run.name for run in outcome.runs if run.reused]


@pytest.mark.slow
def test_a_changed_raw_file_is_done_again_alone(campaign, done, tmp_path):
    motion = campaign.parent / "raw/friction/sb-r_dry_31N_01_motion.csv"
    with motion.open("a") as file:
        file.write("\n")
    assert reused(again(campaign, done, tmp_path / "new")) == [RUNS[0], RUNS[1], RUNS[3]]


@pytest.mark.slow
def test_a_changed_setting_is_done_again(dry, done, tmp_path):
    edit(dry, "trim = 0.10", "trim = 0.12")
    outcome = again(dry, done, tmp_path / "new")
    assert reused(outcome) == []
    friction = read_netcdf(outcome.folder / outcome.runs[0].data_file, group="friction")
    assert friction.attrs["trim"] == 0.12


@pytest.mark.slow
def test_a_clock_shift_in_the_campaign_file_is_taken_and_makes_its_runs_anew(
    campaign, done, tmp_path
):
    truth = read_truth(campaign.parent).facts["runs"]
    shift = truth[RUNS[2]]["clock_shift_at_middle_s"]
    edit(campaign, 'medium = "dry"\n', f'medium = "dry"\nclock_shift = "{1e3 * shift:.4f} ms"\n')
    outcome = again(campaign, done, tmp_path / "new")
    assert reused(outcome) == list(RUNS[:2])
    given, estimated = (
        read_netcdf(one.folder / one.runs[2].data_file, group="run").attrs
        for one in (outcome, done)
    )
    assert (given["clock_shift_source"], estimated["clock_shift_source"]) == ("given", "estimated")
    assert given["clock_shift_s"] == pytest.approx(shift, abs=1e-6)
    assert given["clock_shift_s"] != estimated["clock_shift_s"]
    [found] = [row for row in given["findings"] if row["check"] == "clock_shift"]
    assert found["status"] == "pass" and "given" in found["message"]


def test_a_clock_shift_without_a_second_log_is_told(dry, tmp_path):
    (dry.parent / f"raw/friction/{RUNS[3]}_motion.csv").unlink()
    edit(dry, 'medium = "dry"\n', 'medium = "dry"\nclock_shift = "0.42 s"\n')
    *_, run = planned_runs(load_campaign(dry))
    reason = stage.process_run(stage.RunTask(run, tmp_path, *trace_size(1))).record.outcome.reason
    assert f"no second log ({RUNS[3]}_motion.csv)" in reason
    assert "leave clock_shift out" in reason


@pytest.mark.slow
def test_another_version_and_a_damaged_file_are_done_again(dry, done, tmp_path, monkeypatch):
    first = again(dry, done, tmp_path / "first")
    damaged = first.folder / first.runs[1].data_file
    content = damaged.read_bytes()
    damaged.unlink()  # not the file of `done`, which it is a link to
    damaged.write_bytes(content[: len(content) // 2])
    assert reused(again(dry, first, tmp_path / "second")) == [RUNS[2]]
    monkeypatch.setattr("tribolab.version.__version__", "9.9.9")
    assert reused(again(dry, first, tmp_path / "third")) == []


@pytest.mark.slow
def test_a_campaign_whose_files_are_gone_says_so(campaign, tmp_path):
    loaded = load_campaign(campaign)
    for path in campaign.parent.glob("raw/friction/*_dry_*"):
        path.unlink()
    with pytest.raises(ConfigError, match=r"line \d+: run 2, files: nothing matches"):
        process(loaded, tmp_path)


def same_results(outcome, other):
    assert outcome.curves == other.curves
    assert outcome.sources == other.sources
    same_friction(outcome.runs, outcome, other)


def same_friction(runs, *outcomes):
    for run in runs:
        one, two = (read_netcdf(o.folder / run.data_file, group="friction") for o in outcomes)
        xr.testing.assert_equal(one, two)


@pytest.mark.slow
def test_processes_give_what_this_process_gives_even_if_one_is_killed(original, done, tmp_path):
    killed = []

    def progress(stage, count, total):
        if stage == "runs" and count == 1:
            victim = multiprocessing.active_children()[0]
            victim.kill()
            killed.append(victim.pid)

    with workers(2, modules=ANALYSIS) as pool:  # as the commands do
        outcome = process(load_campaign(original), tmp_path, executor=pool, progress=progress)
    assert len(killed) == 1
    same_results(outcome, done)


class Losing(ThreadPoolExecutor):
    """Loses some runs, as a pool does whose workers die again and again."""

    def __init__(self, lost):
        super().__init__(2)
        self.lost = lost

    def submit(self, function, task):
        if getattr(getattr(task, "run", None), "name", "") in self.lost:
            future = Future()
            future.set_exception(WorkerDied("its worker process ended"))
            return future
        return super().submit(function, task)


@pytest.mark.slow
def test_threads_give_what_this_process_gives_but_for_a_run_that_kills_its_worker(
    original, done, tmp_path
):
    with Losing(RUNS[2:3]) as executor:
        outcome = process(load_campaign(original), tmp_path, executor=executor)
    assert [(run.name, run.error) for run in outcome.failed] == [(RUNS[2], "WorkerDied")]
    assert "ended" in outcome.failed[0].reason
    assert outcome.curves[0] == done.curves[0]
    same_friction([run for run in outcome.runs if run.done], outcome, done)


def test_results_in_which_nothing_could_be_done_replace_nothing(original, tmp_path):
    with Losing(RUNS) as executor, pytest.raises(WorkerDied, match="no run could be analysed"):
        process(load_campaign(original), tmp_path, executor=executor)


@pytest.mark.slow
def test_a_script_without_its_guard_is_told_so_and_harms_nothing(campaign, tmp_path):
    for file in (campaign.parent / "raw/friction").iterdir():
        if "_dry_" in file.name or "_02_" in file.name:  # each run costs several processes
            file.unlink()
    dry = r'\n\[\[run\]\]\nfiles = "[^"]*_dry_.*?(?=\n\[|\Z)'
    campaign.write_text(re.sub(dry, "", campaign.read_text("utf-8"), flags=re.DOTALL), "utf-8")
    (tmp_path / "here").mkdir()
    tmp_path = tmp_path / "here"
    script = tmp_path / "script.py"
    script.write_text(
        "import tribolab as tl\n"
        f"tl.run_campaign({str(campaign)!r}, output={str(tmp_path / 'new')!r}, jobs=2)\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 1
    assert "__name__" in done.stderr.splitlines()[-1]
    assert [path.name for path in tmp_path.iterdir()] == ["script.py"]


def test_a_worker_hands_back_a_record_not_signals(original, tmp_path):
    (tmp_path / "data").mkdir()
    run = planned_runs(load_campaign(original))[0]
    answer = stage.process_run(stage.RunTask(run, tmp_path, *trace_size(10_000)))
    assert (tmp_path / answer.record.outcome.data_file).stat().st_size > 50_000
    assert len(pickle.dumps(answer)) < 50_000


def test_a_full_disk_ends_the_campaign_with_one_clear_error(original, tmp_path, monkeypatch):
    def full(data, path, **options):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr("tribolab.reading.netcdf.netcdf.write_groups", full)
    with pytest.raises(OutputError, match="disk is full"):
        process(load_campaign(original), tmp_path)
