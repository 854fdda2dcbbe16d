"""Make the results folders of this version that later versions must be able to read.

    python tests/kept_results.py tests/kept_results

Writes ``VERSION.tar.xz`` with three results folders: two repeats of one condition, two runs of
which one has a decision, and one run with a scanned surface and models. The pages and the binary
copies of the tables are left out, as they are large, and so are the raw files, which `raw_campaign`
simulates again.
"""

from __future__ import annotations

import re
import sys
import tarfile
import tempfile
from dataclasses import replace
from pathlib import Path

from tribolab.app.run import run_campaign
from tribolab.campaign.settings.review import REVIEW_FILE
from tribolab.rig import Protocol, Rig, simulate_campaign
from tribolab.version import __version__

KINDS = ("repeats", "decisions", "surfaces_and_models")
REVIEWED = "sb-r_glycerol_31N_01"
PAGE = "report.html"
_POINTS = 1200  # of the profile, which is the largest part of the results
_DECISION = f"""[[decision]]
run = "{REVIEWED}"
action = "note"
reason = "humid day"
author = "A. Person"
date = 2026-11-20
"""


def raw_campaign(folder: Path, kind: str) -> Path:
    """Simulate the raw files of a kept results folder; returns campaign.toml."""
    rate = 1.0 if kind == "surfaces_and_models" else 0.4  # Hz, at rest; gaps leave no model
    repeats = 2 if kind == "repeats" else 1
    rig = Rig()
    protocol = replace(Protocol(speeds=(4.64e-4, 2.15e-3)), unloaded_rest=3.0, loading=2.0)
    rig = replace(rig, protocol=protocol, loggers=replace(rig.loggers, force_rate=rate))
    file = simulate_campaign(folder, rig=rig, small=True, surfaces=("Sb-R",), n_repeats=repeats)
    head, *runs = re.split(r"(?m)^(?=\[\[run\]\])", file.read_text("utf-8"))
    if kind != "decisions":
        runs = [run for run in runs if '"glycerol"' in run]
    text = head + "".join(runs)
    if kind == "surfaces_and_models":
        text += '\n[model]\nuncertainty = "none"\n'
        [scan] = file.parent.glob("raw/profiles/*.csv")
        lines = scan.read_text("utf-8").replace("length: 25 mm", "length: 0.6 mm").splitlines()
        scan.write_text("\n".join(lines[:_POINTS]) + "\n", "utf-8")
    else:
        text = re.sub(r"(?m)^scans = .*\n", "", text) + "\n[model]\ncompute = false\n"
    file.write_text(text, "utf-8")
    if kind == "decisions":
        file.with_name(REVIEW_FILE).write_text(_DECISION, "utf-8")
    return file


def main(target: Path) -> None:
    """Write the archive of this version."""
    target.mkdir(exist_ok=True)
    with (
        tempfile.TemporaryDirectory() as temporary,
        tarfile.open(target / f"{__version__}.tar.xz", "w:xz", preset=9) as archive,
    ):
        for kind in KINDS:
            file = raw_campaign(Path(temporary) / kind, kind)
            run_campaign(file, jobs=1, figures="none")
            results = file.parent / "results"
            (results / PAGE).unlink()
            archive.add(results, kind)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
