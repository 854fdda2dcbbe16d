"""Web page and table of an instrument's history."""

from __future__ import annotations

import re
from pathlib import Path

from tribolab import plot
from tribolab.comparison.instrument_history import History, InstrumentHistory, expectations
from tribolab.comparison.page import Part, Picture, Sheet, cells, write_parts
from tribolab.core.wording import many
from tribolab.metrology.control_charts import FEWEST_OF_BASELINE
from tribolab.metrology.run_length import signal_probability
from tribolab.report import tables


def history_verdict(history: History) -> str:
    """Return the result of the history as one sentence."""
    charts = many(len(history.charts), "chart")
    judged = [chart for chart in history.charts if chart.chart is not None]
    if not judged:
        most = max((chart.values.size for chart in history.charts), default=0)
        missing = 2 * FEWEST_OF_BASELINE - most
        return (
            f"nothing judged yet: the longest of {charts} has {many(most, 'point')}, and a control "
            f"chart needs {2 * FEWEST_OF_BASELINE}. Add at least {missing} more campaigns of the "
            "same instrument"
            if missing > 0
            else f"nothing judged yet: the remarks say why no chart of {charts} can be judged"
        )
    if not history.signalling:
        others = len(history.charts) - len(judged)
        return f"{charts}: no signal" + (f", {others} not judged yet" if others else "")
    named = ", ".join(_name(chart, history) for chart in history.signalling[:4])
    more = len(history.signalling) - 4
    signal = "signal" if len(history.signalling) > 1 else "signals"
    return (
        f"{len(history.signalling)} of {charts} {signal}: {named}"
        f"{f' and {more} more' if more > 0 else ''}"
    )


def _name(chart: InstrumentHistory, history: History) -> str:
    """Return the name of the quantity, and of the instrument if there are several."""
    several = len({other.instrument for other in history.charts}) > 1
    return f"{chart.instrument}: {chart.quantity}" if several else chart.quantity


def write_history(history: History, folder: Path) -> Path:
    """Write ``history.html`` and ``history.csv``, and return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    tables.write_csv(history.table(), folder / "history.csv")
    page = folder / "history.html"
    instruments = dict.fromkeys(chart.instrument for chart in history.charts)
    write_parts(
        page,
        kind="History of instruments",
        heading=", ".join(name or "instrument not named" for name in instruments),
        verdict=history_verdict(history),
        fine=not history.signalling and any(chart.chart is not None for chart in history.charts),
        parts=[_summary(history), *(_chart(chart, history) for chart in _order_charts(history))],
    )
    return page


def _order_charts(history: History) -> list[InstrumentHistory]:
    """Return the charts in order: first those that signal, last those without a verdict."""
    return sorted(history.charts, key=lambda chart: (not chart.signals.size, chart.chart is None))


def _verdict(chart: InstrumentHistory) -> str:
    if chart.chart is None:
        return "not judged"
    if not chart.signals.size:
        return "as usual"
    first = chart.when[chart.signals[0]].date().isoformat()
    return f"not as usual since {first}"


def _summary(history: History) -> Part:
    rows = [
        cells(
            (
                _name(chart, history), chart.unit, len(chart.values), chart.baseline_points,
                float(chart.values[-1]), chart.chart.low if chart.chart else float("nan"),
                chart.chart.high if chart.chart else float("nan"), len(chart.signals),
                _verdict(chart),
            ),
            digits=4,
        )
        for chart in _order_charts(history)
    ]  # fmt: skip
    heads = ("Quantity", "Unit", "Points", "Baseline", "Last", "From", "To", "Signals", "Verdict")
    due = [
        f"{name}: calibration due {due.date.isoformat() if due.date else 'unknown'} ({due.reason})."
        for name, due in history.due.items()
    ]
    unread = [f"Left out: {text}" for text in history.unread[:20]]
    return Part(
        "summary",
        "All charts",
        texts=(
            "Each campaign is one point. The first ones are the baseline. A later point is a "
            "signal if it, or a series of points, deviates significantly "
            f"(rules: {', '.join(history.rules)}).{_chance_text(history)}",
            *due,
            *unread,
        ),
        tables=(Sheet("All charts", "history", heads, rows),),
    )


def _chance_text(history: History) -> str:
    """Return a text on how often some chart would signal although nothing changed."""
    judged = [chart for chart in history.charts if chart.chart is not None]
    if not judged:
        return ""
    none = 1.0
    for chart in judged:
        points, usual = chart.values.size - chart.baseline_points, chart.baseline_points
        none *= 1 - signal_probability(points, history.rules, baseline=usual)
    return (
        f" If nothing had changed, one or more of the {many(len(judged), 'chart')} that could be "
        f"judged would signal by chance in up to {100 * (1 - none):.0f} % of such pages."
    )


def _chart(chart: InstrumentHistory, history: History) -> Part:
    rows = chart.table()
    name = _name(chart, history)
    drawn = Picture(plot.control(rows, title=name), name, f"{name} over time.")
    text = expectations(chart, history.rules)
    texts = [text[0].upper() + text[1:] + "."]
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
