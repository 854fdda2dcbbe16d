"""Attributes that count the rows of a run: in its files, left out, or with interpolated time.

``rows_in_file`` is always set, ``rows_left_out`` and ``rows_left_out_why`` if rows were left out,
``rows_time_interpolated`` if times were interpolated. A companion log has the first three with the
prefix ``companion_``; ``rows_not_covered`` counts the rows of the main log outside its range.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from tribolab.core.untyped import Json
from tribolab.reading.clocks.clock import Mended
from tribolab.reading.si_tables.model import Content
from tribolab.reading.signals import Signals

ROW_ATTRIBUTES = ("rows_in_file", "rows_left_out", "rows_left_out_why")


def row_attributes(kept: int, contents: list[Content], mended: Mended) -> Json:
    """Return the attributes that count the rows of a run's files, and the rows left out.

    Parameters
    ----------
    kept
        Rows of the run.
    contents
        Contents of the files.
    mended
        Result of the repair of time.

    Returns
    -------
    dict
        Attributes of the run.
    """
    reasons: Counter[str] = Counter(mended.left_out)
    for content in contents:
        reasons.update(content.left_out)
    attrs = _counted(kept, reasons)
    if mended.interpolated:
        attrs["rows_time_interpolated"] = mended.interpolated
    return attrs


def _counted(kept: int, reasons: Mapping[str, int]) -> Json:
    lost = sum(reasons.values())
    attrs: Json = {"rows_in_file": kept + lost}
    if lost:
        attrs["rows_left_out"] = lost
        attrs["rows_left_out_why"] = "; ".join(f"{n} {why}" for why, n in reasons.items() if n)
    return attrs


def rows_in_words(attrs: Mapping[str, Any]) -> str:
    """Return the number of rows left out and the reason in words; "" without any.

    Examples
    --------
    >>> rows_in_words(
    ...     {"rows_in_file": 50, "rows_left_out": 1, "rows_left_out_why": "1 cut short at the end"}
    ... )
    '1 of 50 rows (2.00%): 1 cut short at the end'
    """
    lost, rows = int(attrs.get("rows_left_out", 0)), int(attrs.get("rows_in_file", 0))
    if not lost or not rows:
        return ""
    return f"{lost} of {rows} rows ({lost / rows:.2%}): {attrs.get('rows_left_out_why', '')}"


def with_companion_rows(merged: Signals, run: Signals, motion: Signals) -> Signals:
    """Add the row counts of the companion log, and the rows that it does not cover, to a run.

    Parameters
    ----------
    merged
        The run of both logs.
    run, motion
        The logs.
    """
    companion: Json = {
        f"companion_{key}": motion.attrs[key] for key in ROW_ATTRIBUTES if key in motion.attrs
    }
    if alone := run.time.size - merged.time.size:
        companion["rows_not_covered"] = alone
    return merged._replace(attrs=merged.attrs | companion)
