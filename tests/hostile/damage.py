"""Damage to each kind of stored file, and whether the next run notices, reports and mends it.

    PYTHONPATH=$PWD:tests python -m hostile.damage CAMPAIGN NAME COUNT

damages the file NAME of the results of a campaign COUNT times, each time in another way.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import numpy as np

KINDS = (
    *("catalogue.sqlite", "data/sb-r_dry_31N_01.nc", "report.html", "report.json"),
    *("tables/friction.csv", ".tribolab-results"),
)


def spoil(path: Path, random: np.random.Generator) -> None:
    """Flip bits, clear a block, cut, lengthen or mix up; the time of change stays if it can."""
    state, content = path.stat(), bytearray(path.read_bytes())
    before, how = bytes(content), random.integers(5)
    at = random.integers(len(content))
    if how == 0:
        for place in random.integers(0, len(content), random.choice([1, 50])):
            content[place] ^= 1 << random.integers(8)
    elif how == 1:
        content[at : at + 512] = bytes(len(content[at : at + 512]))
    elif how == 2:
        del content[at:]
    elif how == 3:
        content += random.bytes(64)
    else:
        content[at : at + 64] = random.bytes(len(content[at : at + 64]))
    if bytes(content) == before:
        content[at] ^= 1
    path.unlink()  # not through a hard link
    path.write_bytes(content)
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))


def wrong(campaign: Path, name: str, tables: dict[str, bytes]) -> str:
    """Say what is wrong with the answer to a damaged file; nothing if all is as it should be."""
    from typer.testing import CliRunner

    from tribolab.app.verifying import problems
    from tribolab.cli import app
    from tribolab.core.errors import TribolabError

    def answer(*words: str) -> tuple[int, str]:
        done = CliRunner().invoke(app, list(words))
        return done.exit_code, " ".join(done.output.split())

    results = campaign.parent / "results"
    try:
        found = problems(results)
    except TribolabError as error:
        found = [str(error)]
    if not found or not found[0].startswith(name):
        return f"verify says {found[:1]}"
    run = ("run", str(campaign), "-q", "-j", "1")
    code, said = answer(*run)
    if "verify --repair" in said:  # the marker is lost beyond use
        answer("verify", str(results), "--repair")
        code, said = answer(*run)
    elif said.count("changed since tribolab wrote them") != 1 or name not in said:
        return f"run does not name it once: {said[:200]}"
    if code not in (0, 1):
        return f"exit code {code}: {said[:200]}"
    if problems(results):
        return f"still wrong: {problems(results)[0]}"
    new = {p.name: p.read_bytes() for p in (results / "tables").glob("*.csv")}
    lost = [key for key, content in tables.items() if new.get(key) != content]
    return f"other numbers in {lost}" if lost else ""


def main(campaign: Path, name: str, count: int) -> int:
    """Damage a file again and again; returns 1 if one of the answers is wrong."""
    results, faults = campaign.parent / "results", 0
    whole = campaign.parent.parent / "whole"
    shutil.copytree(results, whole)
    tables = {p.name: p.read_bytes() for p in (whole / "tables").glob("*.csv")}
    for number in range(count):
        shutil.rmtree(results)
        shutil.copytree(whole, results)
        spoil(results / name, np.random.default_rng((KINDS.index(name), number)))
        if fault := wrong(campaign, name, tables):
            faults += 1
            print(f"{name}, damage {number}: {fault}", flush=True)
    print(f"{count} times {name} damaged, {faults} failures")
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])))
