"""Viscosity against shear rate, from files of rheometers."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.lexicon.lexicon import known_words, normalise_label
from tribolab.reading.modulus_tables import Column, TableKind, find_table, numbers_of, scale_of
from tribolab.reading.raw.source import read_unchanged

_UNITS = {"shear_rate": "1/s", "viscosity": "Pa s"}
_SAME_RATE = 0.02  # relative difference of shear rates at the same set-point


class FlowCurve(NamedTuple):
    """Viscosity [Pa s] against shear rate [1/s], in order of increasing rate."""

    shear_rate: np.ndarray
    viscosity: np.ndarray


def read_flow_curve(path: str | Path) -> FlowCurve:
    r"""Read viscosity against shear rate from any export of a rheometer.

    Parameters
    ----------
    path
        Delimited or aligned text in any common encoding, or a workbook, with columns of shear rate
        and viscosity. Units are in brackets or in a row of their own.

    Returns
    -------
    FlowCurve
        Rows at one shear rate are averaged, on a logarithmic scale.

    Raises
    ------
    ReadError
        If there is no such table, a unit is missing, or all rows are at one shear rate.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "xanthan.csv"
    ...     _ = file.write_text("Shear rate [1/s],Viscosity [mPa s]\n0.1,900\n10,80\n1000,5\n")
    ...     read_flow_curve(file).viscosity.round(6).tolist()
    [0.9, 0.08, 0.005]
    """
    path = Path(path)
    table = read_unchanged([path], lambda: find_table(path, None, kind=_FLOW_CURVE))
    rows = [numbers_of(row, table.columns, table.decimal) for row in table.rows]
    values = np.array([row for row in rows if row is not None], dtype=float)
    data = dict(zip(table.columns, values.reshape(-1, len(table.columns)).T, strict=True))
    rate, viscosity = (
        data[name] * scale_of(table.columns[name], unit, path.name) for name, unit in _UNITS.items()
    )
    good = np.isfinite(rate) & np.isfinite(viscosity) & (rate > 0) & (viscosity > 0)
    order = np.argsort(rate[good], kind="stable")
    log_rate, log_eta = np.log(rate[good][order]), np.log(viscosity[good][order])
    edges = np.flatnonzero(np.diff(log_rate) > _SAME_RATE) + 1
    means = [
        (float(np.exp(a.mean())), float(np.exp(b.mean())))
        for a, b in zip(np.split(log_rate, edges), np.split(log_eta, edges), strict=True)
        if a.size
    ]
    if len(means) < 2:
        raise ReadError(
            f"{path.name}: the viscosity is at one shear rate only; two or more are wanted"
        )
    rates, viscosities = np.array(means).T
    return FlowCurve(rates, viscosities)


def _concept(label: str) -> str:
    """Return the quantity of a flow curve that a column name means; "" if it means none."""
    whole = normalise_label(label)
    words = [word for word in known_words("run") if word.quantity in _UNITS]
    return next((w.quantity for w in words if whole in (*w.stems, *w.symbols)), "")


def _needed(columns: dict[str, Column]) -> dict[str, Column]:
    return {name: columns[name] for name in _UNITS} if set(_UNITS) <= set(columns) else {}


_FLOW_CURVE = TableKind(_concept, _needed, "shear rate and viscosity are wanted")
