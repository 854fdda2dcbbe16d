"""The command line as a person and a scheduled job meet it: what it says, its exit codes."""

import contextlib
import json
import os
import pty
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from typing import NamedTuple

import pandas as pd
import pytest
from campaigns import copied, fingerprint, simulated
from reporting import made_outcome
from typer.testing import CliRunner

import tribolab
from tribolab import cli
from tribolab.app.commands.campaign import show_outcome
from tribolab.app.progress import progress_bars
from tribolab.campaign.settings.analysed import Qc
from tribolab.records.parts import ModelOutcome

ENVIRONMENT = os.environ | {"COLUMNS": "100", "NO_COLOR": "1"}


def tribolab_command(*words, **options):
    command = [sys.executable, "-m", "tribolab", *map(str, words)]
    options = {"capture_output": True, "text": True, "env": ENVIRONMENT, "check": False} | options
    return subprocess.run(command, **options)


class Said(NamedTuple):
    """What a command said, and its exit code."""

    returncode: int
    stdout: str
    stderr: str


def told(*words):
    """Run a command in this process, where it is not the process that is looked at."""
    done = CliRunner().invoke(cli.app, [str(word) for word in words], env=ENVIRONMENT)
    return Said(done.exit_code, done.stdout, done.stderr)


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("simulated"), repeats=1)


@pytest.fixture(scope="module")
def analysed(original):
    """The campaign with results, and what `tribolab run` said."""
    return original, told("run", original, "--jobs", 1)


@pytest.fixture
def campaign(analysed, tmp_path):
    return copied(analysed[0], tmp_path)


def test_help_teaches_and_version_tells():
    done = told("--help")
    assert done.returncode == 0
    for word in ("demo", "run", "simulate", "info", "Exit codes"):
        assert word in done.stdout
    assert "tribolab run campaign.toml --output" in told("run", "--help").stdout
    assert tribolab_command("--version").stdout == f"tribolab {tribolab.__version__}\n"


def test_help_needs_none_of_the_heavy_libraries():
    code = (
        "import sys\nfrom tribolab import cli\n"
        "try:\n    cli.app(['--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'pandas', 'scipy', 'xarray', 'pint', 'pydantic', 'matplotlib', 'dask'}\n"
        "sys.stderr.write(str(sorted(heavy & set(sys.modules))))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "[]"


@pytest.mark.slow
def test_a_run_says_in_few_lines_what_came_out(analysed):
    campaign, done = analysed
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("OK      2 of 2 runs usable\n")
    assert re.search(r"2 of 2 runs read, \d+ segments\n", done.stdout)
    row = r"Sb-R +glycerol +31 N +1 +\d+ +\S+ to \S+ m/s +\S+ to \S+ +at most \S+ "
    assert re.search(rf"{row}\(within the run\)\n", done.stdout)
    assert "\ncalibration not stated: every uncertainty is statistical only" in done.stdout
    assert "([uncertainty] in the campaign file)\n" in done.stdout
    assert done.stdout.endswith("results/report.html\n")
    assert len(done.stdout.splitlines()) < 9
    results = campaign.parent / "results"
    assert {path.name for path in results.iterdir()} >= {
        *("report.html", "report.json", "tables", "figures", "data")
    }
    json.loads((results / "report.json").read_text(encoding="utf-8"))


def test_old_options_of_figures_name_the_command_that_draws_them(tmp_path):
    done = told("run", tmp_path / "none.toml", "--figures", "all", "--pdf")
    for option in ("--figures", "--pdf"):
        said = f"tribolab: {option} will be removed in the next release: 'tribolab figures'"
        assert said in done.stderr


@pytest.mark.slow
def test_a_second_run_leaves_everything_as_it_is(campaign):
    before = fingerprint(campaign.parent)
    done = told("run", campaign.parent, "--jobs", 1)
    assert done.returncode == 0
    assert "2 unchanged since the last analysis" in done.stdout
    assert fingerprint(campaign.parent) == before


@pytest.mark.slow
def test_another_title_makes_another_report_of_the_same_data(campaign):
    text = campaign.read_text(encoding="utf-8")
    campaign.write_text(text.replace('name = "PMMA', 'name = "Plexiglas', 1), encoding="utf-8")
    done = told("run", campaign, "--jobs", 1)
    assert "2 unchanged since the last analysis" in done.stdout
    assert "Plexiglas" in (campaign.parent / "results/report.html").read_text(encoding="utf-8")
    assert sorted(path.name for path in campaign.parent.iterdir()) == [
        *("campaign.toml", "raw", "results", "truth")
    ]


@pytest.mark.slow
def test_a_bad_file_gives_exit_code_3_and_results_of_the_others(campaign, tmp_path):
    (campaign.parent / "raw/friction/sb-r_dry_31N_01_force.csv").write_text("Time [s]\n")
    done = told("run", campaign, "-o", tmp_path / "new", "-j", 1)
    assert done.returncode == 3
    assert "1 of 2 runs" in done.stdout
    assert done.stderr.startswith("tribolab: sb-r_dry_31N_01 failed: ")
    assert "sb-r_dry_31N_01_force.csv" in done.stderr
    assert (tmp_path / "new" / "report.html").is_file()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["run", "none.toml"], 2, "none.toml: there is no such file"),
        (["rum"], 2, "No such command"),
        (["run", "{campaign}", "--jobs", "0"], 2, "--jobs"),
        (["run", "{campaign}", "--output", "{folder}"], 2, "--output"),
        (["run", "{campaign}", "--output", "{folder}/raw/x"], 2, "same folder as the raw files"),
        (["simulate", "{folder}"], 2, "nothing is overwritten"),
        (["info", "none.csv"], 3, "none.csv"),
        (["info", "{campaign}"], 3, "no table of numbers"),
        (["info", "{campaign}", "-i", "linear_slidr"], 2, "'linear_slider'"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else None,
)
def test_what_goes_wrong_gives_its_exit_code_and_the_cure(analysed, words, code, said):
    campaign = analysed[0]
    words = [word.format(campaign=campaign, folder=campaign.parent) for word in words]
    before = fingerprint(campaign.parent)
    done = told(*words)
    assert done.returncode == code
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
    assert fingerprint(campaign.parent) == before


@pytest.mark.slow
def test_a_mistake_in_the_campaign_file_is_one_line(campaign):
    text = campaign.read_text(encoding="utf-8")
    campaign.write_text(text.replace("viscosity", "viscosty"), encoding="utf-8")
    done = told("run", campaign)
    assert done.returncode == 2
    line = 1 + text.splitlines().index('viscosity = "1.4 Pa s"')
    assert done.stderr == (
        f"tribolab: {campaign}, line {line}: medium.glycerol.viscosty: unknown key; "
        "did you mean 'viscosity' or 'viscosity_range'?\n"
    )


@pytest.mark.slow
def test_a_mistake_of_ours_is_one_line_and_a_traceback_on_demand(monkeypatch, capsys, campaign):
    def broken(*words, **options):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr("tribolab.app.run.run_campaign", broken)
    with pytest.raises(SystemExit) as caught:
        cli.app(["run", str(campaign)])
    assert caught.value.code == 3
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "crashed with ZeroDivisionError at app/commands/campaign.py:" in said
    assert "--debug" in said
    with pytest.raises(ZeroDivisionError):
        cli.app(["run", str(campaign), "--debug"])


@pytest.mark.slow
def test_a_campaign_without_motion_finds_nothing_and_says_so(campaign, tmp_path):
    text = campaign.read_text(encoding="utf-8")
    text += '\n[qc.limits.segments]\nmin_duration = "1000 h"\n'
    campaign.write_text(text, encoding="utf-8")
    done = told("run", campaign, "-o", tmp_path / "new", "-j", 1)
    assert done.returncode == 3
    assert "no run contains a segment of constant speed" in done.stderr


@pytest.mark.slow
def test_info_shows_how_files_are_understood_and_goes_on_after_a_bad_one(analysed):
    campaign = analysed[0]
    good = campaign.parent / "raw/friction/sb-r_dry_31N_01_force.csv"
    done = told("info", campaign, good)
    assert done.returncode == 3
    assert "campaign.toml" in done.stderr
    assert re.search(r"linear_slider \(.*force log\)", done.stdout)
    assert re.search(r"normal_force +\S+ to \S+ N +from 'Fz \[N\]'", done.stdout)


def _with_terminal(*words):
    """Run with stderr on a terminal; return exit code, stdout and what the terminal showed."""
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "tribolab", *map(str, words)]
    environment = ENVIRONMENT | {"TERM": "xterm"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=theirs, env=environment, text=True
    ) as process:
        os.close(theirs)
        shown = b""
        with contextlib.suppress(OSError):  # the other end is closed
            while piece := os.read(ours, 65536):
                shown += piece
        said = process.stdout.read()
    os.close(ours)
    return process.returncode, said, shown.decode()


@pytest.mark.slow
def test_bars_are_shown_on_a_terminal(tmp_path):
    words = ["simulate", tmp_path / "a", "--small", "--repeats", 1, "-j", 1]
    code, said, shown = _with_terminal(*words)
    assert code == 0
    assert f"tribolab run {tmp_path / 'a'}" in said
    assert "simulate" in shown
    assert "6/6" in shown


@pytest.mark.parametrize(("terminal", "quiet"), [(True, True), (False, False)])
def test_no_bars_in_a_pipe_or_if_told(monkeypatch, terminal, quiet):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal, raising=False)
    with progress_bars(quiet) as progress:
        assert progress is None


def _begin(campaign, *words):
    """Start a run and wait until it writes; a new trim so that nothing is taken over."""
    text = campaign.read_text(encoding="utf-8")
    campaign.write_text(text.replace("trim = 0.10", "trim = 0.2"), encoding="utf-8")
    command = [sys.executable, "-m", "tribolab", "run", str(campaign), *words]
    process = subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
        start_new_session=True,
        # where the tests themselves run in the background, the interrupt would be ignored
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    deadline = time.monotonic() + 60
    while not list(campaign.parent.glob(".results.tribolab-*/new/data/*.nc")):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.01)
    return process


@pytest.mark.slow
def test_a_run_that_is_killed_leaves_the_old_results_and_the_next_completes(campaign):
    results = campaign.parent / "results"
    before = fingerprint(results)
    with _begin(campaign, "--jobs", "1") as process:
        process.kill()
    assert process.returncode == -signal.SIGKILL
    assert fingerprint(results) == before
    assert list(campaign.parent.glob(".results.tribolab-*"))
    done = told("run", campaign, "--jobs", 1)
    assert done.returncode == 0
    assert "unchanged" not in done.stdout
    assert list(campaign.parent.glob(".results.tribolab-*")) == []
    table = pd.read_csv(results / "tables" / "friction.csv")
    assert set(table["run"]) == {"sb-r_glycerol_31N_01", "sb-r_dry_31N_01"}
    assert fingerprint(results) != before


@pytest.mark.slow
def test_ctrl_c_leaves_the_old_results_and_nothing_else(campaign):
    results = campaign.parent / "results"
    before = fingerprint(results)
    with _begin(campaign, "--jobs", "2") as process:
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: the workers get it too
        said = process.stderr.read()
    assert process.returncode == 130
    assert said == "tribolab: interrupted; earlier results are unchanged\n"
    assert fingerprint(results) == before
    assert list(campaign.parent.glob(".results.tribolab-*")) == []


@pytest.mark.parametrize(
    ("status", "fail_on", "code"),
    [("failed", "fail", 1), ("failed", "suspect", 1), ("failed", "never", 0)]
    + [("skipped", "suspect", 0), ("done", "suspect", 0)],
)
def test_a_model_that_failed_is_named_and_gives_exit_code_1(
    tmp_path, capsys, status, fail_on, code
):
    made = made_outcome(tmp_path, [("one", "Sb-R", "glycerol", 31.0, 0.8)])
    labels = {"curve": "curve0", "surface": "Sb-R", "medium": "glycerol", "normal_force": 31.0}
    model = ModelOutcome(name="model_curve0", status=status, reason="no film was found", **labels)
    campaign = made.campaign.model_copy(update={"qc": Qc(fail_on=fail_on)})
    assert show_outcome(replace(made, models=(model,), campaign=campaign), debug=False) == code
    said = "tribolab: no model of Sb-R in glycerol at 31 N: no film was found"
    assert (said in capsys.readouterr().err) == (status == "failed")
