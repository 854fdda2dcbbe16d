"""Good results and moments in which they could be lost; clusters that go away."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from hostile.base import LONG, TRIBOLAB, UNREADABLE, USAGE, Command, campaign, case, run, whole

# ---- 1 to 5: loss


def _spoil(folder: Path, log: str, how: Callable[[Path], None]) -> Command:
    file = campaign(folder, results=True)
    how(next((folder / "c/raw").rglob(log)))
    return run(file)


def _folder_instead(path: Path) -> None:
    path.unlink()
    path.mkdir()


def _kept(folder: Path) -> str:
    old = (whole().parent / "results/tables/friction.csv").read_text("utf-8")
    new = (folder / "c/results/tables/friction.csv").read_text("utf-8")
    return "" if new == old else "the friction of before is lost"


for _name, _how in {
    "empty": lambda path: path.write_bytes(b""),
    "gone": Path.unlink,
    "a folder": _folder_instead,
    "noise": lambda path: path.write_bytes(bytes(range(256)) * 40),
}.items():
    for _log in ("*dry*_force.csv", "*glycerol*_motion.csv"):
        case(
            f"loss 1: {_log} is {_name}",
            *(_log, _how),
            codes=(UNREADABLE,),
            says="kept from 20",
            after=_kept,
            **LONG,
        )(_spoil)


@case("loss 1: a scan is empty", says="kept from 20", **LONG)
def _(folder: Path) -> Command:
    return _spoil(folder, "profiles/*.csv", lambda path: path.write_bytes(b""))


def _mine(folder: Path) -> str:
    notes = folder / "c/results/notes/mine.md"
    return "" if notes.exists() and notes.read_text() == "squeal" else "a file of theirs is lost"


@case("loss 2: files of others survive", codes=(0, 1), says="mine.md", after=_mine, **LONG)
def _(folder: Path) -> Command:
    file = campaign(folder, True, lambda text: text.replace("trim = 0.10", "trim = 0.11"))
    (folder / "c/results/notes").mkdir()
    (folder / "c/results/notes/mine.md").write_text("squeal")
    return run(file)


def _thesis(folder: Path) -> str:
    return "" if (folder / "thesis/thesis.tex").is_file() else "the thesis is lost"


@case("loss 2: a copied marker makes nothing ours", codes=(USAGE,), after=_thesis, large=True)
def _(folder: Path) -> Command:
    from tribolab.campaign.store.ledger import MARKER

    file = campaign(folder, results=True)
    (folder / "thesis").mkdir()
    (folder / "thesis/thesis.tex").write_text("three years")
    shutil.copy(folder / "c/results" / MARKER, folder / "thesis")
    return run(file, "-o", str(folder / "thesis"))


@case(
    ("loss 3: an input in the results"),
    codes=(USAGE,),
    says="the results folder would contain",
    large=True,
)
def _(folder: Path) -> Command:
    file = campaign(
        folder,
        True,
        lambda text: text.replace("[contact]", '[contact]\nmodulus_file = "../results/dma.csv"'),
    )
    (folder / "c/results/dma.csv").write_text("f,E_stor,E_loss\nHz,MPa,MPa\n1,1,1\n2,2,2\n")
    return run(file)


@case("loss 5: brackets in the output's name", codes=(0, 1), **LONG)
def _(folder: Path) -> Command:
    return run(campaign(folder), "-o", str(folder / "out [1]*"))


# ---- 9: a cluster


def _nothing_left(folder: Path) -> str:
    left = {path.name for path in (folder / "c").iterdir()} - {"campaign.toml", "raw", "truth"}
    return f"left behind: {left}" if left else ""


def _all_done(folder: Path) -> str:
    tables = whole().parent / "results/tables"
    new = folder / "c/results/tables"
    wrong = [p.name for p in tables.glob("*.csv") if (new / p.name).read_bytes() != p.read_bytes()]
    return f"not as without a cluster: {wrong}" if wrong else ""


@case(
    "cluster 9: no scheduler",
    codes=(USAGE,),
    says="no Dask scheduler answers",
    after=_nothing_left,
    seconds=30.0,
    large=True,
)
def _(folder: Path) -> Command:
    file = str(campaign(folder))
    return [*TRIBOLAB, "run", file, "-q", "--scheduler", "tcp://127.0.0.1:1"]


# A scheduler and two workers as they are started by hand. As soon as the run has given them work, a
# signal is sent to some of them. What the run says has to come within a minute.
_LOST = """
import json, os, signal, subprocess, sys, time
from pathlib import Path
from distributed import Client

campaign, victims, number, memory, *more = sys.argv[1:]
file = Path("scheduler.json")
quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}

def start(kind, *options):
    command = [sys.executable, "-m", "distributed.cli.dask_" + kind, "--scheduler-file", str(file)]
    return subprocess.Popen([*command, "--no-dashboard", *options], **quiet)

started = [start("scheduler", "--host", "127.0.0.1", "--port", "0", "--dashboard-address", ":0")]
try:
    nanny = "--nanny" if memory.endswith("nanny") else "--no-nanny"
    options = [nanny, "--nthreads", "1", "--memory-limit", memory.removesuffix(" nanny")]
    started += [start("worker", *options) for _ in range(2)]
    while not file.is_file():
        time.sleep(0.1)
    address = json.loads(file.read_text())["address"]
    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(1 if nanny == "--nanny" else 2)
        command = [sys.executable, "-m", "tribolab", "run", campaign, *more, "-q"]
        run = subprocess.Popen(
            [*command, "--scheduler", address], stderr=subprocess.PIPE, text=True
        )
        while not client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)):
            time.sleep(0.02)
        client.close()
    began = time.monotonic()
    for place in map(int, victims):
        started[place].send_signal(int(number))
    for line in run.stderr:
        if "Dask" in line and time.monotonic() - began > 60:
            print("said too late", flush=True)
        print(line, end="", file=sys.stderr, flush=True)
    sys.exit(run.wait(90))
finally:
    for process in started:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
"""


_HERE = "--local-if-lost"
for _what, _victims, _number, _memory, _says in (
    ("both workers killed", "12", 9, "0", "Dask cluster is lost: all of its workers are gone"),
    ("the scheduler killed", "0", 9, "0", "Dask cluster is lost"),
    ("both workers stopped", "12", 19, "0", "Dask cluster is lost: no worker has answered for"),
    ("the scheduler stopped", "0", 19, "0", "Dask cluster is lost: its scheduler does not answer"),
    ("one worker stopped", "1", 19, "0", "Dask worker tcp:.* has not answered for"),
    ("one worker killed", "1", 9, "0", ""),
    ("no memory left", "", 0, "150MB", "Dask cluster is lost: its workers have no memory left"),
    ("workers die of memory", "", 0, "150MB nanny", "its Dask workers died"),
):
    for _more in ((), (_HERE,)):
        _whole = _what.startswith("one") or bool(_more)

        @case(
            f"cluster 9: {_what}{', finished here' if _more else ''}",
            *(_victims, _number, _memory, _more),
            codes=(0, 1) if _whole else (UNREADABLE,),
            says=_says,
            never="distributed|said too late",
            after=_all_done if _whole else _nothing_left,
            seconds=90.0,
            large=True,
        )
        def _(folder: Path, victims: str, number: int, memory: str, more: tuple) -> Command:
            (folder / "lost.py").write_text(_LOST)
            command = [sys.executable, str(folder / "lost.py"), str(campaign(folder))]
            return [*command, victims, str(number), memory, *more]


for _address in (
    *("nonsense", "tcp://", "tcp://127.0.0.1:99999", "tcp://127.0.0.1:x", "gopher://127.0.0.1:1"),
    *("tcp://no.such.host.invalid:8786", "http://127.0.0.1:1", "tcp://240.0.0.1:8786", "", " "),
    *("tls://127.0.0.1:1", "ws://127.0.0.1:1", "ucx://127.0.0.1:1", "tcp://[::1:1", "inproc://1"),
    *("tcp://127.0.0.1:1\x1b[31m", "/etc/passwd", "-", "tcp://127.0.0.1:-1"),
):

    @case(
        f"cluster 9: the address {_address!r}",
        _address,
        codes=(USAGE,),
        says="Dask|scheduler",
        after=_nothing_left,
        seconds=30.0,
        large=True,
    )
    def _(folder: Path, address: str) -> Command:
        return [*TRIBOLAB, "run", str(campaign(folder)), "-q", "--scheduler", address]


# ---- moments


def _old(folder: Path) -> str:
    """The results of before are whole, and nothing lies beside them."""
    left = {path.name for path in (folder / "c").iterdir()}
    if odd := left - {"campaign.toml", "raw", "truth", "results"}:
        return f"left behind: {odd}"
    same = (folder / "c/results/report.json").read_bytes()
    return "" if same == (whole().parent / "results/report.json").read_bytes() else "changed"


_STOPPED = """
import os, signal, subprocess, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # else left ignored by what started us
signal.signal(signal.SIGHUP, signal.SIG_DFL)
process = subprocess.Popen([sys.executable, "-m", "tribolab", "run", sys.argv[1], "-q", "-j", "2"])
until, folder = time.monotonic() + 60.0, os.path.dirname(sys.argv[1])
while time.monotonic() < until:  # until so many files of the new results are written
    rooms = [name for name in os.listdir(folder) if name.startswith(".")]
    made = [files for room in rooms for _, _, files in os.walk(os.path.join(folder, room))]
    if sum(map(len, made)) >= int(sys.argv[3]):
        break
    time.sleep(0.01)
process.send_signal(int(sys.argv[2]))
sys.exit(process.wait(60))
"""

for _signal, _files in ((15, 1), (1, 1), (2, 1), (15, 3), (15, 6)):

    @case(
        f"loss 5: signal {_signal} after {_files} files",
        *(_signal, _files),
        codes=(128 + _signal,),
        says="earlier results are unchanged",
        after=_old,
        **LONG,
    )
    def _(folder: Path, number: int, files: int) -> Command:
        file = campaign(folder, True, lambda text: text.replace("trim = 0.10", "trim = 0.12"))
        (folder / "stopped.py").write_text(_STOPPED)
        return [sys.executable, str(folder / "stopped.py"), str(file), str(number), str(files)]


def _in_the_volume(folder: Path) -> str:
    import subprocess

    there = (folder / "c/volume/report.html").is_file()
    subprocess.run(["umount", str(folder / "c/volume")], check=False, capture_output=True)
    return "" if there else "no report in the volume"


@case("loss 4: a mount point", codes=(0, 1), after=_in_the_volume, **LONG)
def _(folder: Path) -> Command:
    import subprocess

    file = campaign(folder)
    (folder / "c/volume").mkdir()
    mount = ["mount", "-t", "tmpfs", "tmpfs", str(folder / "c/volume")]
    subprocess.run(mount, check=False, capture_output=True)  # else it is a folder like others
    return run(file, "-o", str(folder / "c/volume"))
