"""Good results and moments in which they could be lost; clusters that go away."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from hostile.base import LONG, UNREADABLE, USAGE, Command, campaign, case, run, whole

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
    from tribolab.campaign.ledger import MARKER

    file = campaign(folder, results=True)
    (folder / "thesis").mkdir()
    (folder / "thesis/thesis.tex").write_text("three years")
    shutil.copy(folder / "c/results" / MARKER, folder / "thesis")
    return run(file, "-o", str(folder / "thesis"))


@case("loss 3: an input in the results", codes=(USAGE,), says="results must lie apart", large=True)
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


@case(
    "cluster 9: no scheduler",
    codes=(USAGE,),
    says="no Dask scheduler answers",
    after=_nothing_left,
    seconds=30.0,
    large=True,
)
def _(folder: Path) -> Command:
    return run(campaign(folder), "--scheduler", "tcp://127.0.0.1:1")


_LOST = """
import os, sys
from tribolab.cli import main
from tribolab.app import run
from dask.distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                      host="127.0.0.1", processes=True) as cluster:
        pids = [worker.pid for worker in cluster.workers.values()]
        whole = run.run_campaign
        def dying(*args, progress=None, **options):
            def kill(*_):
                import signal
                for nanny in cluster.workers.values():
                    nanny.auto_restart = False
                for pid in pids:
                    try:
                        os.kill(pid, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
            return whole(*args, progress=kill, **options)
        run.run_campaign = dying
        import tribolab.campaign.executor as executor
        sys.argv = ["tribolab", "run", sys.argv[1], "-q", "--scheduler", cluster.scheduler_address]
        main()
"""


@case(
    "cluster 9: both workers gone",
    codes=(UNREADABLE,),
    says="Dask cluster is lost",
    after=_nothing_left,
    seconds=90.0,
    large=True,
)
def _(folder: Path) -> Command:
    (folder / "lost.py").write_text(_LOST)
    return [sys.executable, str(folder / "lost.py"), str(campaign(folder))]


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
process = subprocess.Popen([sys.executable, "-m", "tribolab", "run", sys.argv[1], "-q", "-j", "2"])
time.sleep(float(sys.argv[3]))
process.send_signal(int(sys.argv[2]))
sys.exit(process.wait(60))
"""

for _signal, _seconds in ((15, 3.0), (1, 3.0), (2, 3.0), (15, 8.0)):

    @case(
        f"loss 5: signal {_signal} after {_seconds:g} s",
        *(_signal, _seconds),
        codes=(128 + _signal,),
        says="results of before are as they were",
        after=_old,
        **LONG,
    )
    def _(folder: Path, number: int, seconds: float) -> Command:
        file = campaign(folder, True, lambda text: text.replace("trim = 0.10", "trim = 0.12"))
        (folder / "stopped.py").write_text(_STOPPED)
        return [sys.executable, str(folder / "stopped.py"), str(file), str(number), str(seconds)]


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


@case(
    "cluster 9: the scheduler gone",
    codes=(UNREADABLE,),
    says="Dask cluster is lost",
    after=_nothing_left,
    seconds=90.0,
    large=True,
)
def _(folder: Path) -> Command:
    one = "pids = [worker.pid for worker in cluster.workers.values()]"
    (folder / "lost.py").write_text(
        _LOST.replace(one, "pids = []").replace(
            "for nanny in cluster.workers.values():",
            "cluster.sync(cluster.scheduler.close)\n                for nanny in ():",
        )
    )
    return [sys.executable, str(folder / "lost.py"), str(campaign(folder))]
