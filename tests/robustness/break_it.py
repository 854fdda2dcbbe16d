"""Try to break tribolab as its users do without meaning to; print each case, exit 1 on a failure.

    PYTHONPATH=$PWD nice python tests/robustness/break_it.py            (all cases, some minutes)
    PYTHONPATH=$PWD python tests/robustness/break_it.py --only units    (names that contain it)
    PYTHONPATH=$PWD python tests/robustness/break_it.py --quick         (small files only)

Each case is a command line, or a few lines as in a notebook, in a process of its own. Its answer
is what the case wants of it (see `Case`), within 5 s of computing and 1 GB of memory, and never
a traceback, a warning of numpy or a control character. The time on the clock is measured too,
but not judged: a busy machine makes it long.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from hostile import CASES

SECONDS, MEMORY, PATIENCE = 5.0, 1 << 30, 900.0
_NEVER = {
    "a traceback": r"Traceback \(most recent",
    "a crash": r"crashed with|--debug shows where",
    "a warning": r"RuntimeWarning|UserWarning|DeprecationWarning",
    "a control character": r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\x9b]",
}


@dataclass(frozen=True)
class Answer:
    """What a command said, and what it took."""

    code: int
    out: str
    err: str
    seconds: float
    clock: float
    memory: int


def answer(command: Sequence[str | bytes], folder: Path, settings: dict[str, str]) -> Answer:
    """Run one command and measure it, its own children included."""
    began = time.monotonic()
    with (folder / ".out").open("w+b") as out, (folder / ".err").open("w+b") as err:
        process = subprocess.Popen(
            command, stdout=out, stderr=err, cwd=folder, env={**os.environ, **settings}
        )
        while True:
            pid, status, used = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() - began > PATIENCE:
                process.kill()
            time.sleep(0.02)
        process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
    (folder / ".out").unlink()
    (folder / ".err").unlink()
    return Answer(
        process.returncode,
        *texts,
        used.ru_utime + used.ru_stime,
        time.monotonic() - began,
        used.ru_maxrss << 10,
    )


def wrong(case, found: Answer, folder: Path) -> list[str]:
    """Say what is wrong with an answer; nothing if it is as it should be."""
    said = found.out + found.err
    faults = [what for what, pattern in _NEVER.items() if re.search(pattern, said)]
    if found.code not in case.codes:
        faults.append(f"exit code {found.code}, not {' or '.join(map(str, case.codes))}")
    if case.says and not re.search(case.says, said):
        faults.append(f"does not say '{case.says}'")
    if case.never and re.search(case.never, said):
        faults.append(f"says '{case.never}'")
    if found.seconds > case.seconds:
        faults.append(f"{found.seconds:.1f} s of computing")
    if found.memory > MEMORY:
        faults.append(f"{found.memory / 1e6:.0f} MB")
    lines = [line for line in found.err.splitlines() if line]
    if any(len(line) > 1500 for line in lines):
        faults.append("a line of more than 1500 characters")
    if case.after and (fault := case.after(folder)):
        faults.append(fault)
    return faults


def main() -> int:
    """Run the cases of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="cases whose names contain this")
    parser.add_argument("--quick", action="store_true", help="leave out what wants large files")
    given = parser.parse_args()
    chosen = [c for c in CASES if given.only in c.name and not (given.quick and c.large)]
    failed = 0
    for case in chosen:
        with tempfile.TemporaryDirectory(prefix="break_it_") as name:
            folder = Path(name)
            command = case.prepare(folder)
            found = answer(command, folder, case.settings)
            faults = wrong(case, found, folder)
        failed += bool(faults)
        verdict = "; ".join(faults) or "ok"
        print(
            f"{case.name:<44}{found.seconds:6.1f} s {found.clock:6.1f} s "
            f"{found.memory / 1e6:6.0f} MB  {verdict}",
            flush=True,
        )
        if faults:
            print("    " + (found.err.strip() or found.out.strip())[-600:].replace("\n", "\n    "))
    print(f"{len(chosen)} cases, {failed} failures")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
