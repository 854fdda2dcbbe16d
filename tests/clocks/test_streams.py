"""The command line in any terminal and pipe, and stopped in any way."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SAY = [sys.executable, "-c"]
LONG = "from tribolab.app.streams import prepared\nimport sys\n"
LONG += "with prepared():\n    [print('line', n) for n in range(100_000)]\nsys.exit(7)"


def test_a_reader_that_leaves_changes_nothing_but_what_is_shown():
    with subprocess.Popen([*SAY, LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"line 0\n"
        process.stdout.close()
        errors = process.stderr.read()
    assert (process.returncode, errors) == (7, b"")


@pytest.mark.parametrize(
    ("settings", "wanted"),
    [
        ({"LC_ALL": "POSIX", "PYTHONUTF8": "0"}, b"0.8 +- 0.1 um \\udcff\n"),
        ({"PYTHONUTF8": "1"}, "0.8 ± 0.1 µm \\udcff\n".encode()),
    ],
)
def test_every_text_can_be_shown_in_every_terminal(settings, wanted):
    code = "from tribolab.app.streams import prepared\n"
    code += "with prepared(): print('0.8 \\xb1 0.1 \\xb5m \\udcff')"
    env = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG"))} | settings
    done = subprocess.run([*SAY, code], capture_output=True, env=env, check=True)
    assert done.stdout == wanted


SHORT = [sys.executable, "-m", "tribolab", "--version"]


def test_an_output_on_a_full_disk_is_one_sentence_and_an_exit_code():
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(SHORT, stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 3
    assert done.stderr == (
        b"tribolab: standard output cannot be written (No space left on device)\n"
    )


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_a_stream_that_is_closed_changes_nothing_but_what_is_shown(closed):
    command = ["bash", "-c", f'"$@" {closed}', "bash", *SHORT]
    done = subprocess.run(command, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert bool(done.stdout) == (closed == "2>&-")


STOPPED = """
import sys, time
from tribolab.campaign.store.staging import staged
from tribolab.app.streams import Terminated, prepared
try:
    with prepared(), staged(sys.argv[1]) as folder:
        print("working", flush=True)
        time.sleep(60)
except Terminated as stop:
    sys.exit(stop.code)
"""


@pytest.fixture
def heard():
    """What is started hears SIGHUP, though the tests themselves may run under nohup."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_being_stopped_tidies_up(tmp_path, number):
    began = time.monotonic()
    command = [*SAY, STOPPED, str(tmp_path / "results")]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"working\n"
        process.send_signal(number)
        process.wait(30)
    assert process.returncode == 128 + number
    assert list(tmp_path.iterdir()) == [] and time.monotonic() - began < 30


SWALLOWED = """
import signal, sys, time
from tribolab.app.streams import Terminated, prepared

class Left:
    def __del__(self):  # what is raised here, Python swallows
        signal.raise_signal(int(sys.argv[1]))

try:
    with prepared():
        left = Left()
        del left
        time.sleep(20)
except KeyboardInterrupt as stop:
    sys.exit(isinstance(stop, Terminated) and stop.code)
"""


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_comes_where_exceptions_are_swallowed_still_stops(number):
    command = [*SAY, SWALLOWED, str(int(number))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=15)
    assert (done.returncode, done.stderr) == (128 + number, "")
