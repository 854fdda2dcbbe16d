"""Web page and table of a measuring plan."""

from __future__ import annotations

import math
from pathlib import Path

from tribolab import plot
from tribolab.comparison.page import Part, Picture, Sheet, cells, write_parts
from tribolab.comparison.planning import LONGEST_STROKE, MeasuringPlan, plan_text
from tribolab.core.wording import duration, speed_text
from tribolab.report import tables


def write_plan(plan: MeasuringPlan, heading: str, folder: Path) -> Path:
    """Write ``plan.html`` and ``plan.csv``, and return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    tables.write_csv(plan.table, folder / "plan.csv")
    sure = f"{100 * plan.assurance:.0f} %"
    drawn = Picture(
        plot.runs_needed(plan.table, title=plan.goal),
        "Filled: runs that slide as long as the pilot's; open: runs of the cheapest sliding time. "
        f"Symbols: 50 % chance to reach the goal; ends of the bars: {sure}.",
        "Number of runs over sliding speed.",
    )
    heads = (
        "Condition", "Speed", "Mean", "Within a run", "Memory (s)", "Between runs", "Pilot runs",
        "Sliding time", "Runs, half sure", f"Runs, {sure} sure", "In all, sure", "Cheapest sliding",
        "Runs, half sure", f"Runs, {sure} sure", "In all, sure",
    )  # fmt: skip
    names = ("mean", "within_std", "autocorrelation_time_s", "between_runs_std")
    rows = [
        cells(
            (
                row["condition"], speed_text(float(row["sliding_speed_m_s"])),
                *(row[name] for name in names), row["pilot_runs"],
                *(
                    text
                    for name in ("", "cheapest_")
                    for text in (
                        duration(row[f"{name}sliding_time_s"]), _count(row[f"{name}runs"]),
                        _count(row[f"{name}assured_runs"]), duration(row[f"{name}assured_time_s"]),
                    )
                ),
            )
        )
        for row in plan.table.to_dict("records")
    ]  # fmt: skip
    part = Part(
        "plan",
        "How long, how often",
        texts=(
            f"For a {plan.goal}, at {duration(plan.setup_time)} of setting up each run.",
            "Half sure: in one of two campaigns of so many runs the error comes out as small as "
            f"asked for, in the other larger. {sure} sure: in {sure} of them. "
            "The fewer runs the pilot had, the further these two are apart: more runs of a pilot "
            "are the cheapest way to a sure plan. What runs have in common, such as a calibration, "
            "no repeat takes out.",
        ),
        figures=(drawn,),
        tables=(Sheet("Runs at each speed", "plan", heads, rows),),
        notes=(f"The cheapest sliding time is at most {LONGEST_STROKE} times the pilot's.",),
    )
    page = folder / "plan.html"
    counts = [name for name in plan.table if str(name).endswith("runs") and name != "pilot_runs"]
    fine = not plan.table[counts].isna().any().any()
    verdict = plan_text(plan)
    write_parts(page, kind="Plan", heading=heading, verdict=verdict, fine=bool(fine), parts=(part,))
    return page


def _count(runs: float) -> int | str:
    """Return the number of runs as text, or "out of reach" if it is infinite."""
    return int(runs) if math.isfinite(runs) else "out of reach"
