"""Containers are read in a child process: what it does to itself costs one error."""

import gzip
import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

import isolated_cases as cases
import numpy as np
import pytest
from scipy.io import netcdf_file
from typer.testing import CliRunner

import tribolab
from tribolab.cli import app
from tribolab.core.errors import OutputError, ReadError, TribolabError
from tribolab.reading.netcdf.table_schema import load_schema
from tribolab.reading.raw import limits, server
from tribolab.reading.raw.opening import CrashedError, MissingLibraryError
from tribolab.reading.raw.scratch import scratch_place
from tribolab.reading.raw.source import check_regular

POSIX = pytest.mark.skipif(not hasattr(os, "fork"), reason="children are copies on POSIX only")


@pytest.fixture(autouse=True)
def cases_found(monkeypatch):
    """The server has our search path: it imports the cases, too."""
    monkeypatch.syspath_prepend(str(Path(cases.__file__).parent))


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "a.bin"
    path.write_text("content")
    return path


def test_numbers_and_texts_come_back_from_another_process(file):
    small, large = cases.read_bytes(file), cases.read_bytes(file, times=100_000)
    assert small["text"] == large["text"] == "content"
    assert small["pid"] != os.getpid() and small["pid"] != large["pid"]
    assert np.array_equal(large["values"], np.arange(400_000.0))
    large["values"][0] = 7.0  # ours to change


@POSIX
@pytest.mark.parametrize(
    ("what", "words"),
    [
        (cases.crash, "crashed \\(signal 11\\)"),
        (cases.fill_memory, "more memory than a sound file"),
        (cases.never_end, "did not finish"),
    ],
)
def test_a_library_that_ends_badly_costs_one_error_and_the_next_file_is_read(
    what, words, file, monkeypatch
):
    quick = limits.Limit(0.1, "s", "for this test")
    monkeypatch.setattr(limits, "CPU_FOR_ANY_FILE", quick)
    with pytest.raises(CrashedError, match=f"{file}: the file is damaged or hostile: .*{words}"):
        what(file)
    assert cases.read_bytes(file)["text"] == "content"


@POSIX
def test_a_result_larger_than_its_limit_is_refused(file, monkeypatch):
    monkeypatch.setattr(limits, "UNPACKED_FOR_ANY_FILE", limits.Limit(1e6, "byte", "small"))
    with pytest.raises(CrashedError):
        cases.write_too_much(file)


def test_an_error_of_ours_keeps_its_parts(file):
    with pytest.raises(ReadError) as caught:
        cases.complain(file)
    assert str(caught.value) == f"{file}: no table; describe it"


def test_what_no_reader_expects_of_a_library_is_damage_of_the_file(file):
    with pytest.raises(ReadError, match=f"{file}: this file cannot be read: IndexError"):
        cases.meet_the_unexpected(file)


def test_a_missing_library_is_named(file):
    words = r"needs the package a_library_that_is_not_there; install it: pip install 'tribolab"
    with pytest.raises(MissingLibraryError, match=words):
        cases.need(file)


def test_a_result_cannot_run_code_here(file):
    Path("/tmp/tribolab-was-here").unlink(missing_ok=True)
    with pytest.raises(pickle.UnpicklingError, match="no result of reading"):
        cases.answer_with_a_command(file)
    assert not Path("/tmp/tribolab-was-here").exists()


@POSIX
def test_what_is_no_file_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(tmp_path / "pipe")
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(tmp_path / "socket"))
        for name in ("pipe", "link", "socket"):
            with pytest.raises(ReadError, match="not a regular file"):
                check_regular(tmp_path / name)
    for path, words in ((tmp_path, "folder"), (tmp_path / "none", "no such file")):
        with pytest.raises(ReadError, match=words):
            check_regular(path)
    with pytest.raises(ReadError, match="not a regular file"):
        check_regular(Path("/dev/zero"))


FORCE = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n" + "".join(
    f"{n / 10},0.5,31.0\n" for n in range(30)
)


@POSIX
@pytest.mark.parametrize("name", ["pipe.csv", "link.csv", "zero.csv"])
@pytest.mark.parametrize(
    "command", ["info", "check", "dialect", "run", "info a_force.csv --instrument", "campaign",
                "scans", "modulus", "schema", "companion"],
)  # fmt: skip
def test_no_command_opens_what_is_no_regular_file(command, name, tmp_path, monkeypatch):
    """One that does waits for ever, or for all memory."""
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.csv")
    Path("link.csv").symlink_to("pipe.csv")
    Path("zero.csv").symlink_to("/dev/zero")
    Path("a_force.csv").write_text(FORCE)
    if command == "schema":
        Path(name).rename("own.json")
        name = "own.json"
    if command in ("scans", "modulus", "schema"):
        reader = {"scans": tribolab.read_scans, "modulus": tribolab.rubber.read_modulus}
        with pytest.raises(TribolabError, match=f"{name}.*not a regular file"):
            reader.get(command, load_schema)(Path(name))
        return
    if command == "companion":
        Path("a_motion.csv").symlink_to(name)
        command, name = "check", "a_force.csv"
    if command == "campaign":
        Path("campaign.toml").symlink_to(name)
        command, name = "run", "campaign.toml"
    if command.endswith("--instrument"):
        Path(name).rename("own.toml")
        name = "own.toml"
    answer = CliRunner().invoke(app, [*command.split(), name])
    assert answer.exit_code in (2, 3)
    assert "not a regular file" in " ".join(answer.output.split())


@POSIX
def test_threads_and_a_killed_server_lose_nothing(file):
    answers = []
    threads = [
        threading.Thread(target=lambda: answers.append(cases.read_bytes(file)["text"]))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    process = server.ONLY._process
    if process is not None:
        os.kill(process.pid, signal.SIGKILL)
    for thread in threads:
        thread.join()
    assert answers == ["content"] * 4


@POSIX
def test_what_a_killed_process_left_is_removed_at_the_next_start(tmp_path, monkeypatch):
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    left, ours = (tmp_path / f"tribolab-{pid}-x" for pid in (ended.pid, os.getpid()))
    for folder in (left, ours):
        folder.mkdir()
        (folder / "part").write_text("content")
    (tmp_path / "tribolab-notes-x").write_text("not ours")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    scratch_place()
    assert not left.exists() and ours.exists() and (tmp_path / "tribolab-notes-x").exists()


@pytest.mark.parametrize("packed", [True, False])
def test_a_lack_of_scratch_files_is_not_reported_as_damage(packed, file, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path / "none"))
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(FORCE.encode()))
    with pytest.raises(OutputError, match="scratch files cannot be written.*set TMPDIR"):
        tribolab.read(path) if packed else cases.read_bytes(file)


def test_what_is_refused_is_looked_at_once(tmp_path, monkeypatch):
    path, jobs = tmp_path / "a.nc", []
    with netcdf_file(path, "w") as data:
        data.createDimension("time", 2)
        for number in range(5001):
            data.createVariable(f"v{number}", "f8", ("time",))
    run = server.ONLY.run
    monkeypatch.setattr(server.ONLY, "run", lambda job: jobs.append(job) or run(job))
    for reader in (tribolab.read, tribolab.read, tribolab.read_scans):
        with pytest.raises(ReadError, match=r"a\.nc: more than 5000 variables"):
            reader(path)
    assert len(jobs) == 1


def test_importing_the_package_starts_no_process():
    code = "from tribolab.reading.raw import opening, server; print(server.ONLY._process)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(Path(tribolab.__file__).parents[1])},
    )  # fmt: skip
    assert done.stdout.strip() == "None"
