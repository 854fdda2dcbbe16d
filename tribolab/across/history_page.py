"""The page and the table of an instrument's history."""

from __future__ import annotations

import re
from pathlib import Path

from tribolab import plot
from tribolab.across.history import History, Watched, expectations
from tribolab.across.page import Part, Picture, Sheet, cells, write_parts
from tribolab.report import tables
from tribolab.words import many


def history_verdict(told: History) -> str:
    """Return what came of it in one sentence."""
    charts = many(len(told.charts), "chart")
    if not told.signalling:
        return f"{charts}: no signal"
    named = ", ".join(_name(chart) for chart in told.signalling[:4])
    more = len(told.signalling) - 4
    return f"{charts}: {named}{f' and {more} more' if more > 0 else ''} signal"


def _name(chart: Watched) -> str:
    return f"{chart.instrument}: {chart.quantity}" if chart.instrument else chart.quantity


def write_history(told: History, folder: Path) -> Path:
    """Write ``history.html`` and ``history.csv``, and return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    tables.write_csv(told.table(), folder / "history.csv")
    page = folder / "history.html"
    instruments = dict.fromkeys(chart.instrument for chart in told.charts)
    write_parts(
        page,
        kind="History of instruments",
        heading=", ".join(name or "instrument not named" for name in instruments),
        verdict=history_verdict(told),
        fine=not told.signalling,
        parts=[_summary(told), *(_chart(chart, told) for chart in told.charts)],
    )
    return page


def _summary(told: History) -> Part:
    rows = [
        cells(
            (
                _name(chart), chart.unit, len(chart.values), chart.baseline_points,
                float(chart.values[-1]), chart.chart.low if chart.chart else float("nan"),
                chart.chart.high if chart.chart else float("nan"), len(chart.signals),
                chart.when[chart.signals[0]].date().isoformat() if chart.signals.size else "–",
            ),
            digits=4,
        )
        for chart in told.charts
    ]  # fmt: skip
    heads = ("Quantity", "Unit", "Points", "Baseline", "Last", "From", "To", "Signals", "First")
    due = [
        f"{name}: calibration due {due.date.isoformat() if due.date else 'unknown'} ({due.reason})."
        for name, due in told.due.items()
    ]
    unread = [f"Left out: {text}" for text in told.unread[:20]]
    return Part(
        "summary",
        "All charts",
        texts=(f"Rules: {', '.join(told.rules)}. Each campaign is one point.", *due, *unread),
        tables=(Sheet("All charts", "history", heads, rows),),
    )


def _chart(chart: Watched, told: History) -> Part:
    rows = chart.table()
    name = _name(chart)
    drawn = Picture(plot.control(rows, title=name), name, f"{name} over time.")
    said = expectations(chart, told.rules)
    texts = [said[0].upper() + said[1:] + "."]
    if chart.remark and chart.chart is not None:
        texts.append(chart.remark[0].upper() + chart.remark[1:] + ".")
    marked = rows[rows["signal"] != ""]
    signals = [
        cells((row["when"], row["value"], row["signal"], row["folder"]), digits=4)
        for row in marked.to_dict("records")
    ]
    heads = ("When", "Value", "Rule", "Results")
    return Part(
        re.sub(r"\W+", "-", name),
        name,
        texts=texts,
        figures=(drawn,),
        tables=(Sheet(f"Signals of {name}", "signals", heads, signals),) if signals else (),
    )
