"""A campaign in which two of four runs went wrong, and what a person decides on it."""

import os
import time

import pandas as pd
from campaigns import RUNS, copied, simulated

from tribolab.app.run import run_campaign
from tribolab.campaign.settings.review import REVIEW_FILE
from tribolab.report.results_folder import read_results

FROZEN, SLIPPED, LATE, SOUND = RUNS  # what happened to the runs; the checks fail the first
SLIP = 2  # place of the stroke that slipped off

ENTRY = """[[decision]]
run = "{run}"
action = "{action}"
{times}reason = "{reason}"
author = "A. Person"
date = 2026-11-20

"""


def entry(run, action, reason="seen by eye", **times):
    """A decision as it stands in a review file; times in s, `start` and `stop` are from and to."""
    names = {"start": "from", "stop": "to", "new_start": "new_from", "new_stop": "new_to"}
    lines = "".join(f'{names[name]} = "{value:.4f} s"\n' for name, value in times.items())
    return ENTRY.format(run=run, action=action, reason=reason, times=lines)


def inside(rows, place):
    """The middle of a segment, as an interval."""
    start, stop = (float(rows[f"{end}_s"].iloc[place]) for end in ("start", "stop"))
    return {"start": start + 0.3 * (stop - start), "stop": stop - 0.3 * (stop - start)}


def rows_of(results, run):
    table = read_results(results)["friction"]
    return table[table.run == run]


def faulted(folder):
    """Return a campaign with results: one force signal froze, and one stroke slipped off."""
    file = simulated(folder, faults=("frozen",))
    log = file.parent / f"raw/friction/{SLIPPED}_force.csv"
    lines = log.read_text("utf-8").splitlines()
    head = next(n for n, line in enumerate(lines) if line.startswith("Time"))
    table = pd.read_csv(log, skiprows=head)
    slid = table["Time [s]"].between(*SLID)
    table.loc[slid, "Fx [N]"] *= 0.5
    body = table.to_csv(index=False, lineterminator="\n")
    log.write_text("\n".join(lines[:head]) + "\n" + body, "utf-8")
    for path in (file.parent / "raw").rglob("*.csv"):
        os.utime(path, (time.time() - 60,) * 2)
    run_campaign(file, jobs=1, figures="none")
    return file


SLID = (340.0, 367.2)  # s on the force log's clock: about the third stroke


def decided_on(original, folder):
    """Return a copy with decisions on three of four runs; and what the campaign came to."""
    file = copied(original, folder)
    results = file.parent / "results"
    late = rows_of(results, LATE)
    start, stop = (float(late[f"{end}_s"].iloc[1]) for end in ("start", "stop"))
    begin = start + 0.1 * (stop - start) + 20  # behind what is trimmed
    text = "# What was seen by eye.\n\n"
    text += entry(SLIPPED, "reject", "slipped off", **inside(rows_of(results, SLIPPED), SLIP))
    text += entry(FROZEN, "accept", "the logger's buffer, at rest")
    text += entry(LATE, "bounds", "began late", **inside(late, 1), new_start=begin)
    text += entry(LATE, "note", "humid day")
    (file.parent / REVIEW_FILE).write_text(text, "utf-8")
    return file, run_campaign(file, jobs=1, figures="none")
