"""A length beside a speed of rotation: the way that was slid, or something else, like wear."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.model import DraftColumn

_FEWEST = 20  # rows that tell
_ALIKE = 0.98  # of the way that turns explain


def beside_turns(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[DraftColumn]:
    """Tell by the turns whether a length is the way that was slid; what is none is not used.

    A way goes on as fast as something turns; one that counts up all turns whatever their direction
    is no position.

    Parameters
    ----------
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    turning = [c for c in columns if c.used and c.quantity == "rotation_speed"]
    ways = [c for c in columns if c.used and c.quantity == "position"]
    if len(turning) != 1 or len(ways) != 1:
        return list(columns)
    rate, way = (numbers[:, c.place - 1] for c in (turning[0], ways[0]))
    there = np.isfinite(rate) & np.isfinite(way)
    if there.sum() < _FEWEST or not np.ptp(rate[there]) + np.abs(rate[there]).max() > 0:
        return list(columns)
    rate, way = rate[there], way[there]
    note = "a length that does not grow as it turns: not the way that was slid"
    if _explained(way, np.cumsum(rate)) > _ALIKE:
        told = ways[0]._replace(guessed=(), options=())
    else:
        if _explained(np.abs(way), np.cumsum(np.abs(rate))) > _ALIKE:
            note = "all the way that was slid, whatever its direction; the turns tell the speed"
        told = ways[0]._replace(
            quantity=None, used=False, guessed=(), options=(), fill_in="", note=note
        )
    return [told if column is ways[0] else column for column in columns]


def _explained(way: np.ndarray, turns: np.ndarray) -> float:
    """Return which part of a length's changes goes as turns do, apart from new starts of either."""
    if not np.ptp(turns) > 0 or not np.ptp(way) > 0:
        return 0.0
    steps, by_turns = np.diff(way), np.diff(turns)
    usual = np.abs(steps) < 100 * np.median(np.abs(steps[steps != 0]))  # it may start anew
    way, turns = np.cumsum(np.where(usual, steps, 0)), np.cumsum(np.where(usual, by_turns, 0))
    if not np.ptp(turns) > 0 or not np.ptp(way) > 0:
        return 0.0
    return float(np.corrcoef(way, turns)[0, 1] ** 2)
