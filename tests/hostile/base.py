"""What users do without meaning to: files, names and moments that tribolab has to survive.

A case prepares a folder and returns the command; what the answer has to be stands beside it.
``tests/robustness/break_it.py`` runs all of them with limits on time and memory,
``tests/reading/test_hostile.py`` the quick ones.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from campaigns import simulated

TRIBOLAB = [sys.executable, "-m", "tribolab"]
FINE, FOUND, USAGE, UNREADABLE = 0, 1, 2, 3
Command = list[str | bytes]


@dataclass(frozen=True)
class Case:
    """One way to break it.

    Attributes
    ----------
    name, prepare
        What it is called; it fills a folder and returns the command.
    codes
        Exit codes that are right.
    says, never
        Patterns that have to be in the answer, and must not be.
    seconds
        Of computing, its children's included.
    large
        Whether it writes a file of hundreds of megabytes, or takes long.
    settings
        Environment variables.
    after
        Says what is wrong in the folder afterwards; nothing if it is as it should be.
    """

    name: str
    prepare: Callable[[Path], Command]
    codes: tuple[int, ...] = (UNREADABLE,)
    says: str = ""
    never: str = ""
    seconds: float = 5.0
    large: bool = False
    settings: Mapping[str, str] = field(default_factory=dict)
    after: Callable[[Path], str] | None = None


CASES: list[Case] = []


def case(name: str, *args, **options) -> Callable:
    """Register a function of (folder, *args) as a case."""

    def register(function: Callable) -> Callable:
        CASES.append(Case(name, lambda folder: function(folder, *args), **options))
        return function

    return register


def notebook(code: str) -> Command:
    """Lines as in a notebook: an error of ours is told with its exit code, any other crashes."""
    head = "import sys, tribolab as tl\ntry:\n"
    body = "".join(f"    {line}\n" for line in code.splitlines())
    tail = "except tl.TribolabError as error:\n    print(error, file=sys.stderr); sys.exit(3)\n"
    return [sys.executable, "-W", "error::RuntimeWarning", "-c", head + body + tail]


ROWS = "".join(f"{0.1 * n:.1f},{0.5 + n % 3},31.{n % 7}\n" for n in range(300))
FORCE = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n" + ROWS


@cache
def whole() -> Path:
    """Return a small campaign with its results; simulated once for all cases."""
    folder = Path(tempfile.mkdtemp(prefix="break_it_campaign_"))
    import atexit

    atexit.register(shutil.rmtree, folder, True)
    from tribolab.app.run import run_campaign

    file = simulated(folder, repeats=1, scans=True)
    run_campaign(file, jobs=1)
    return file


def campaign(folder: Path, results: bool = False, change=lambda text: text) -> Path:
    """Copy the campaign, with results if wanted; returns its file."""
    left_out = shutil.ignore_patterns() if results else shutil.ignore_patterns("results")
    shutil.copytree(whole().parent, folder / "c", ignore=left_out)
    file = folder / "c" / "campaign.toml"
    file.write_text(change(file.read_text("utf-8")), "utf-8")
    return file


def run(file: Path, *more: str) -> Command:
    """Return the command that analyses a campaign."""
    return [*TRIBOLAB, "run", str(file), "-q", "-j", "1", *more]


LONG = {"seconds": 90.0, "large": True}


def wrong_campaign(folder: Path, replace: Mapping[str, str], more: str = "") -> Command:
    """Return a command on a campaign file that is wrong before any raw file is read."""
    text = (
        '[campaign]\nname = "x"\n[contact]\nyoungs_modulus = "1.5 MPa"\n[medium.glycerol]\n'
        'viscosity = "1 Pa s"\n[segments]\ntrim = 0.10\n[[run]]\nfiles = "*.csv"\n'
    )
    for old, new in replace.items():
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "raw").mkdir()
    (folder / "raw/a.csv").write_text(FORCE)
    (folder / "campaign.toml").write_text(text + more)
    return [*TRIBOLAB, "run", str(folder / "campaign.toml"), "-q", "-j", "1"]
