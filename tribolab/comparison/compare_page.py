"""Web page and tables of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tribolab import plot
from tribolab.comparison.comparison import CHANGED, Comparison
from tribolab.comparison.page import Part, Picture, Sheet, cells, write_parts
from tribolab.core.wording import many, percent, speed_text
from tribolab.metrology.differences import DIFFERENT, EQUIVALENT, OPEN
from tribolab.report import tables

_VERDICTS = (DIFFERENT, CHANGED, EQUIVALENT, OPEN)
_HEADS = (
    "Condition",
    "Speed",
    "First",
    "Second",
    "Difference",
    "95 % of all: from",
    "to",
    "Runs",
    "p of all",
    "Verdict",
)


def comparison_verdict(compared: Comparison) -> str:
    """Return the result of a comparison as one sentence."""
    points = len(compared.points)
    words = {word: word for word in _VERDICTS}
    words[EQUIVALENT] += f" within {compared.margin}"
    words[OPEN] += _open_to(compared)
    counts = [
        f"{compared.counts[word]} {text}"
        for word, text in words.items()
        if compared.counts.get(word)
    ]
    summary = "; ".join(counts) or "nothing differs, and the raw data are the same"
    return f"{' and '.join(compared.names)}: {many(points, 'point')}, {summary}"


def _open_to(compared: Comparison) -> str:
    """Return a text on the largest difference still possible if none was proved."""
    rows = compared.points[compared.points["verdict"] == OPEN]
    reach = rows[["low", "high"]].abs().max(axis=1) / rows["first"].abs()
    if not np.isfinite(reach).any():
        return ""
    return f" (they may differ by up to {percent(float(reach.max()))})"


def write_comparisons(compared: Sequence[Comparison], folder: Path) -> Path:
    """Write ``compare.html``, and two tables for each pair: points, and whole conditions.

    Returns
    -------
    pathlib.Path
        The page.
    """
    folder.mkdir(parents=True, exist_ok=True)
    parts: list[Part] = []
    for number, pair in enumerate(compared, start=1):
        end = f"_{number}" if len(compared) > 1 else ""
        tables.write_csv(pair.points, folder / f"compare_points{end}.csv")
        tables.write_csv(pair.quantities, folder / f"compare_quantities{end}.csv")
        parts += _parts(pair, end)
    fine = not any(pair.counts.get(word) for pair in compared for word in (DIFFERENT, CHANGED))
    page = folder / "compare.html"
    first = compared[0].names[0]
    write_parts(
        page,
        kind="Comparison",
        heading=f"{', '.join(pair.names[1] for pair in compared)} beside {first}",
        verdict="; ".join(comparison_verdict(pair) for pair in compared),
        fine=fine,
        parts=parts,
    )
    return page


def _parts(compared: Comparison, end: str) -> list[Part]:
    first, second = compared.names
    meaning = f": {second} less {first}" if end else ""
    drawn = Picture(
        plot.differences(compared.points, title=f"{second} less {first}"),
        "Difference of the friction coefficient over speed, relative to the first. Bars: "
        "simultaneous 95 % intervals for all differences. Filled points differ significantly.",
        f"Relative difference of friction between {first} and {second} over speed.",
    )
    wood = Picture(
        plot.forest(compared.quantities, names=compared.names),
        "Results of whole conditions and surfaces. Each bar is a separate interval: thin 95 %, "
        "thick 90 %.",
        f"Relative differences between {first} and {second}, a row for each number.",
    )
    plainly = (
        "Different: the difference at this speed is significant. If nothing differs, one "
        "comparison in twenty still contains such a point."
        if compared.calibration
        else "These differences have no random error, because the raw data are the same."
    )
    margin = (
        f"Equivalent means: the 90 % interval of the point alone is within {compared.margin}."
        if compared.margin
        else "No margin is stated, so nothing can be called equivalent: undecided means that no "
        "difference was proved, not that the two are equal."
    )
    return [
        *([_changes(compared, end, meaning)] if compared.two_folders else []),
        Part(
            f"points{end}",
            f"Friction over speed{meaning}",
            texts=(plainly, margin),
            figures=(drawn,),
            tables=(_points(compared, end),),
            notes=(
                f"{compared.method}.",
                *([f"The unit is the run; {compared.calibration}."] * bool(compared.calibration)),
            ),
        ),
        Part(
            f"numbers{end}",
            f"Numbers of conditions and surfaces{meaning}",
            figures=(wood,),
            tables=(_quantities(compared, end),),
        ),
    ]


def _changes(compared: Comparison, end: str, meaning: str) -> Part:
    rows = [
        cells((change.kind, change.what, change.first, change.second))
        for change in compared.changes
    ]
    sheet = Sheet("What changed", f"changes{end}", ("Kind", "What", *compared.names), rows)
    nothing = ("Settings, decisions, code and raw data are the same.",)
    return Part(
        f"changes{end}",
        f"What changed{meaning}",
        texts=() if rows else nothing,
        tables=(sheet,) if rows else (),
    )


def _points(compared: Comparison, end: str) -> Sheet:
    rows = []
    for row in compared.points.to_dict("records"):
        speed = speed_text(float(row["sliding_speed_m_s"]))
        runs = f"{row['first_runs']} and {row['second_runs']}"
        numbers = (row[name] for name in ("first", "second", "difference", "low", "high"))
        chance = row["adjusted_p_value"]
        rows.append(cells((row["condition"], speed, *numbers, runs, chance, row["verdict"])))
    return Sheet("Differences at each speed", f"compare_points{end}", _HEADS, rows)


def _quantities(compared: Comparison, end: str) -> Sheet:
    heads = ("Number", "Of", *compared.names, "Difference", "95 %: from", "to", "Error holds")
    names = ("of", "first", "second", "difference", "low", "high", "basis")
    rows = [
        cells((str(row["quantity"]).replace("_", " "), *(row[name] for name in names)))
        for row in compared.quantities.to_dict("records")
    ]
    return Sheet("Numbers of conditions and surfaces", f"compare_quantities{end}", heads, rows)
