"""Stored results that were damaged, or forged by somebody who knows how they are written."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hostile.base import LONG, TRIBOLAB, Command, campaign, case, run
from hostile.damage import KINDS

MARKER = ".tribolab-results"
_COUNT = 200

for _kind in KINDS:

    @case(
        f"stored 2: {_COUNT} times damaged, {_kind}",
        _kind,
        codes=(0,),
        says=f"{_COUNT} times .* 0 failures",
        seconds=3600.0,
        large=True,
        settings={"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    def _(folder: Path, kind: str) -> Command:
        file = campaign(folder, results=True)
        start = (
            f"from hostile.damage import main, Path; main(Path({str(file)!r}), {kind!r}, {_COUNT})"
        )
        return [sys.executable, "-c", start]


def _listed(change: Callable[[dict[str, Any]], object], signed: bool) -> Callable[[Path], None]:
    """Change what a marker lists; with a checksum that fits, or with the one of before."""

    def forge(results: Path) -> None:
        from tribolab.campaign.store.ledger import _checksum

        listed = json.loads((results / MARKER).read_text("utf-8"))
        change(listed)
        if signed:
            listed["blake2b"] = _checksum(listed)
        (results / MARKER).write_text(json.dumps(listed), "utf-8")

    return forge


def _replaced(content: bytes) -> Callable[[Path], None]:
    return lambda results: (results / MARKER).write_bytes(content) and None


def _pipe(results: Path) -> None:
    (results / MARKER).unlink()
    os.mkfifo(results / MARKER)


def _device(results: Path) -> None:
    (results / MARKER).unlink()
    (results / MARKER).symlink_to("/dev/zero")


def _folder(results: Path) -> None:
    (results / MARKER).unlink()
    (results / MARKER).mkdir()


_RUN = "data/sb-r_dry_31N_01.nc"
FORGED: dict[str, Callable[[Path], None]] = {
    "a size": _listed(lambda m: m["files"].update({_RUN: [1, 2, "0" * 32, 3, ""]}), False),
    "a size, signed": _listed(lambda m: m["files"].update({_RUN: [1, 2, "0" * 32, 3, ""]}), True),
    "a file of others, signed": _listed(
        lambda m: m["files"].update({"../raw/x": m["files"][_RUN]}), True
    ),
    "the password file, signed": _listed(
        lambda m: m["files"].update({"/etc/passwd": m["files"][_RUN]}), True
    ),
    "a NUL, signed": _listed(lambda m: m["files"].update({"a\0b": m["files"][_RUN]}), True),
    "no list, signed": _listed(lambda m: m.update(files=[]), True),
    "numbers, signed": _listed(lambda m: m["files"].update({_RUN: 7}), True),
    "texts, signed": _listed(lambda m: m["files"].update({_RUN: ["a"] * 5}), True),
    "100 000 files, signed": _listed(
        lambda m: m["files"].update({f"data/{n}.nc": [1, 2, "0" * 32] for n in range(100_000)}),
        True,
    ),
    "nothing": _replaced(b""),
    "lists 100 000 deep": _replaced(b"[" * 100_000),
    "40 MB of a digit": _replaced(b"7" * 40_000_000),
    "noise": _replaced(bytes(range(256)) * 40),
    "a pipe": _pipe,
    "a device": _device,
    "a folder": _folder,
}


def _mended(folder: Path) -> str:
    results = folder / "c/results"
    if not (results / MARKER).is_file():
        return ""  # refused, with its repair
    from tribolab.app.verifying import problems
    from tribolab.core.errors import TribolabError

    try:
        left = problems(results)
    except TribolabError as error:
        left = [str(error)]
    return f"still wrong: {left[0]}" if left and "--repair" not in left[0] else ""


for _name, _forge in FORGED.items():
    for _command in ("run", "verify"):

        @case(
            f"stored 2: {_command}, a marker with {_name}",
            *(_command, _forge),
            codes=(0, 1, 2) if _command == "run" else (0, 1, 2, 3),
            says="since tribolab wrote|--repair|missing|marker|unchanged|not as it was written"
            "|holds something else|report:",
            after=_mended if _command == "run" else None,
            **LONG,
        )
        def _(folder: Path, command: str, forge: Callable[[Path], None]) -> Command:
            file = campaign(folder, results=True)
            forge(folder / "c/results")
            return run(file) if command == "run" else [*TRIBOLAB, command, "c/results"]


@case("stored 2: a forged table with a marker that fits", codes=(3,), says="friction.csv", **LONG)
def _(folder: Path) -> Command:
    from tribolab.campaign.store.ledger import Ledger

    campaign(folder, results=True)
    results = folder / "c/results"
    table = results / "tables/friction.csv"
    text = table.read_text("utf-8")
    table.unlink()
    table.write_text(text.replace(",1.1", ",1.2", 1), "utf-8")
    Ledger(results).write(results)
    return [*TRIBOLAB, "verify", str(results), "--recompute"]


@case("stored 2: scratch files on a disk that is full", codes=(2, 3), says="set TMPDIR")
def _(folder: Path) -> Command:
    import gzip

    from hostile.base import FORCE, ROWS

    with gzip.open(folder / "a.csv.gz", "wt") as file:
        file.write(FORCE + ROWS * 20)
    (folder / "full").mkdir()
    mount = f"mount -t tmpfs -o size=16k tmpfs {folder}/full"
    look = f"TMPDIR={folder}/full {shutil.which('env')} {' '.join(TRIBOLAB)} info a.csv.gz"
    return ["unshare", "-m", "sh", "-c", f"{mount} && {look}"]
