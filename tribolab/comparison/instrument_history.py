"""History of an instrument: control charts from the results folders of many campaigns."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from tribolab.campaign.settings.measured import CalibrationTable
from tribolab.comparison.watched import (
    GAIN,
    REFERENCE,
    Observation,
    group_by_speed,
    observations_of,
)
from tribolab.core.errors import AnalysisError, ReadError, TribolabError
from tribolab.core.html_list import html_list
from tribolab.core.wording import many
from tribolab.metrology.control_charts import (
    DEFAULT_RULES,
    FEWEST_OF_BASELINE,
    Baseline,
    Chart,
    baseline_of,
    control_chart,
)
from tribolab.metrology.recalibration import Due, recalibration_due
from tribolab.metrology.run_length import (
    average_run_length,
    median_run_length,
    signal_probability,
)

_BASELINE = 20  # length of the baseline, if at least as many points follow
_DAY = 86400.0


@dataclass(frozen=True)
class InstrumentHistory:
    """History of one quantity of one instrument, as a control chart.

    Parameters
    ----------
    instrument, quantity, unit
        Identification.
    when, folders, values
        The points, in order of time.
    baseline_points
        Number of first points that form the baseline; 0 if there are too few.
    baseline
        Baseline; None if it cannot be computed.
    chart
        Control chart of the points after the baseline; None without one.
    remark
        Reason for its absence, or a problem of the baseline.
    """

    instrument: str
    quantity: str
    unit: str
    when: tuple[dt.datetime, ...]
    folders: tuple[str, ...]
    values: np.ndarray
    baseline_points: int = 0
    baseline: Baseline | None = None
    chart: Chart | None = None
    remark: str = ""

    @property
    def signals(self) -> np.ndarray:
        """Indices of the points that signal."""
        if self.chart is None:
            return np.zeros(0, dtype=int)
        return self.baseline_points + np.flatnonzero(self.chart.any_signal)

    def table(self) -> pd.DataFrame:
        """Return the table of the points, with control limits and the rules that signal."""
        count, start = self.values.size, self.baseline_points
        rules = np.full(count, "", dtype=object)
        columns = {name: np.full(count, np.nan) for name in _COLUMNS}
        if self.chart is not None:
            columns["low"][start:], columns["high"][start:] = self.chart.low, self.chart.high
            for name in _COLUMNS[2:]:
                columns[name][start:] = getattr(self.chart, name)
            for place in self.signals:
                by = self.chart.signals.items()
                rules[place] = ", ".join(rule for rule, marks in by if marks[place - start])
        return pd.DataFrame(
            {
                "instrument": self.instrument,
                "quantity": self.quantity,
                "unit": self.unit,
                "when": [moment.isoformat(timespec="seconds") for moment in self.when],
                "folder": self.folders,
                "value": self.values,
                "baseline": np.arange(count) < start,
                **columns,
                "signal": rules,
            }
        )


_COLUMNS = ("low", "high", "smoothed", "smoothed_low", "smoothed_high")


@dataclass(frozen=True)
class History:
    """Control charts of several quantities and instruments.

    Parameters
    ----------
    charts
        Chart of each instrument and quantity.
    rules
        Rules by which points signal.
    due
        Date of the next calibration of each instrument, if it can be computed.
    unread
        Folders that could not be read, with the reason.
    """

    charts: tuple[InstrumentHistory, ...]
    rules: tuple[str, ...]
    due: dict[str, Due] = field(default_factory=dict)
    unread: tuple[str, ...] = ()

    @property
    def signalling(self) -> tuple[InstrumentHistory, ...]:
        """Charts in which at least one point signals."""
        return tuple(chart for chart in self.charts if chart.signals.size)

    def _repr_html_(self) -> str:
        """Return HTML of the charts that signal, and of the folders that could not be read."""
        entries = [
            (f"{c.instrument}, {c.quantity}", f"{many(c.signals.size, 'point')} signal")
            for c in self.signalling
        ]
        entries += [("not read", reason) for reason in self.unread]
        return html_list(many(len(self.charts), "chart"), entries)

    def table(self) -> pd.DataFrame:
        """Return one table of the points of all charts."""
        rows = [chart.table() for chart in self.charts]
        return pd.concat(rows, ignore_index=True) if rows else pd.DataFrame()


def history(
    folders: Sequence[str | Path],
    *,
    rules: Sequence[str] = DEFAULT_RULES,
    baseline: int | None = None,
) -> History:
    """Return the control charts of instruments, from the results folders of many campaigns.

    Parameters
    ----------
    folders
        Results folders, or folders of campaigns with ``results``, in any order.
    rules
        ``"3 sigma"``, ``"EWMA"``, ``"CUSUM"``, ``"Western Electric"``.
    baseline
        Number of first campaigns that form the baseline; by default 20, or half of them if there
        are fewer than 40.

    Returns
    -------
    History
        The control charts of all instruments.

    Raises
    ------
    ReadError
        If no folder could be read.

    Notes
    -----
    The quantities are the zeros of the forces, noise, hum, the tilt (increase of the common offset
    of both directions with load), set-point errors, and the shift between two clocks. If
    `[reference]` of the campaign file names runs on a reference sample, its friction at each speed
    and the gain by a dead weight are added. Each campaign gives one point, the mean of its
    segments.

    Examples
    --------
    >>> from tribolab.comparison.instrument_history import history_of
    >>> import datetime as dt
    >>> days = [dt.datetime(2026, 1, 1) + dt.timedelta(days=7 * k) for k in range(12)]
    >>> zeros = [0.1, 0.12, 0.09, 0.1, 0.11, 0.1, 0.1, 0.11, 0.09, 0.1, 0.11, 0.4]
    >>> points = [
    ...     Observation("slide", "zero", "N", day, "a", zero)
    ...     for day, zero in zip(days, zeros, strict=True)
    ... ]
    >>> history_of(points).charts[0].signals.tolist()
    [11]
    """
    points: list[Observation] = []
    unread: list[str] = []
    calibrations: dict[str, CalibrationTable] = {}
    for path in folders:
        try:
            made, folder = observations_of(path)
        except TribolabError as error:
            unread.append(error.message_for("terminal"))
            continue
        points += made
        stated = None if folder.campaign is None else folder.campaign.calibration
        if stated is not None and stated.date is not None:
            for name in {point.instrument for point in made}:
                before = calibrations.get(name)
                if before is None or before.date is None or stated.date >= before.date:
                    calibrations[name] = stated
    if unread and not points:
        raise ReadError("; ".join(unread[:3]))
    history = history_of(points, rules=rules, baseline=baseline)
    due = {name: _due(stated, history.charts, name) for name, stated in calibrations.items()}
    return History(history.charts, history.rules, due, tuple(unread))


def history_of(
    points: Sequence[Observation],
    *,
    rules: Sequence[str] = DEFAULT_RULES,
    baseline: int | None = None,
) -> History:
    """Return the control charts of given observations; arguments as for `history`."""
    groups: dict[tuple[str, str, str], list[Observation]] = {}
    for point in sorted(group_by_speed(points), key=lambda point: (point.when, point.folder)):
        groups.setdefault((point.instrument, point.quantity, point.unit), []).append(point)
    charts = [
        _instrument_history(*key, own, rules, baseline) for key, own in sorted(groups.items())
    ]
    return History(tuple(charts), tuple(rules))


def _instrument_history(
    instrument: str,
    quantity: str,
    unit: str,
    points: Sequence[Observation],
    rules: Sequence[str],
    baseline: int | None,
) -> InstrumentHistory:
    values = np.array([point.value for point in points])
    when = tuple(point.when for point in points)
    bare = InstrumentHistory(
        instrument, quantity, unit, when, tuple(p.folder for p in points), values
    )
    count = min(_BASELINE, values.size // 2) if baseline is None else baseline
    if count < FEWEST_OF_BASELINE or values.size <= count:
        few = f"{many(values.size, 'point')}: too few to judge, {2 * FEWEST_OF_BASELINE} are wanted"
        return InstrumentHistory(*_fields(bare), remark=few)
    try:
        usual = baseline_of(values[:count])
    except AnalysisError as error:
        return InstrumentHistory(*_fields(bare), remark=str(error))
    remark = ""
    if usual.correlated and usual.correlation > 0:
        remark = (
            f"neighbouring points of the baseline correlate by {usual.correlation:.2f}: false "
            "alarms come more often than stated"
        )
    chart = control_chart(values[count:], usual, rules)
    return InstrumentHistory(
        *_fields(bare), baseline_points=count, baseline=usual, chart=chart, remark=remark
    )


def _fields(
    bare: InstrumentHistory,
) -> tuple[str, str, str, tuple[dt.datetime, ...], tuple[str, ...], np.ndarray]:
    return bare.instrument, bare.quantity, bare.unit, bare.when, bare.folders, bare.values


def _due(stated: CalibrationTable, charts: Sequence[InstrumentHistory], instrument: str) -> Due:
    """Return the date of the next calibration, from its interval or from the observed drift."""
    assert stated.date is not None
    interval = None if stated.interval is None else stated.interval / _DAY
    watched = [c for c in charts if c.instrument == instrument and c.quantity == GAIN]
    watched += [
        c for c in charts if c.instrument == instrument and c.quantity.startswith(REFERENCE)
    ]
    if stated.limit is None or not watched:
        return recalibration_due(stated.date, interval)
    chart = watched[0]
    begin = dt.datetime.combine(stated.date, dt.time())
    days = np.array([(moment - begin).total_seconds() / _DAY for moment in chart.when])
    since = days >= 0
    if not since.any():
        return recalibration_due(stated.date, interval)
    relative = chart.values[since] / chart.values[since][: min(3, int(since.sum()))].mean() - 1
    return recalibration_due(stated.date, interval, days[since], relative, stated.limit)


def expectations(chart: InstrumentHistory, rules: Sequence[str]) -> str:
    """Return a text on the rate of false alarms, and on the delay of true ones."""
    if chart.chart is None:
        return chart.remark
    points, usual = chart.values.size - chart.baseline_points, chart.baseline_points
    false = signal_probability(points, rules, baseline=usual)
    known = average_run_length(rules)
    often = f"; one in {points / -math.log1p(-false):.0f} points" if 0 < false < 1 else ""
    steps = []
    for shift in (1.0, 2.0):
        steps.append(median_run_length(rules, shift=shift, baseline=usual))
    soon = " and ".join(
        f"of {shift} standard deviations after {length:.0f} points"
        if math.isfinite(length)
        else f"of {shift} standard deviation hardly ever"
        for shift, length in zip((1, 2), steps, strict=True)
    )
    return (
        f"{', '.join(rules)}: chance of a false alarm in these {many(points, 'point')} "
        f"{100 * false:.0f} %{often}, as the {usual} points of the baseline are what limits are "
        f"made of (ARL0 of known limits: {known:.0f} points); half of all steps are found, {soon}"
    )
