"""How many rows a run's files have, how many were left out, and why: attributes of the run.

``rows_in_file``; where rows were left out also ``rows_left_out`` and ``rows_left_out_why``, and
``rows_left_out_meant``, the share that the dialect allows; ``rows_time_interpolated``. Of a
companion log the same with ``companion_`` before it; ``rows_not_covered`` are those of the first
log, before and after, of which the companion knows nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import xarray as xr

from tribolab.io.clock import Mended
from tribolab.io.dialect_model import Dialect
from tribolab.io.pieces import Content

_ROWS = ("rows_in_file", "rows_left_out", "rows_left_out_why", "rows_left_out_meant")


def row_attributes(
    kept: int, contents: list[Content], mended: Mended, dialect: Dialect
) -> dict[str, Any]:
    """Count the rows of a run's files.

    Parameters
    ----------
    kept
        Rows of the run.
    contents
        What the files hold.
    mended
        What became of the rows when time was put in order.
    dialect
        The instrument's dialect.

    Returns
    -------
    dict
        Attributes of the run.
    """
    reasons: Counter[str] = Counter(mended.left_out)
    for content in contents:
        reasons.update(content.left_out)
    attrs = _counted(kept, reasons)
    if dialect.rows.left_out:
        attrs["rows_left_out_meant"] = dialect.rows.left_out
    if mended.interpolated:
        attrs["rows_time_interpolated"] = mended.interpolated
    return attrs


def _counted(kept: int, reasons: Mapping[str, int]) -> dict[str, Any]:
    lost = sum(reasons.values())
    attrs: dict[str, Any] = {"rows_in_file": kept + lost}
    if lost:
        attrs["rows_left_out"] = lost
        attrs["rows_left_out_why"] = "; ".join(f"{n} {why}" for why, n in reasons.items() if n)
    return attrs


def with_companion_rows(merged: xr.Dataset, run: xr.Dataset, motion: xr.Dataset) -> xr.Dataset:
    """Add to a merged run's attributes what its two logs lost, and what only one of them covers.

    Parameters
    ----------
    merged
        The run of both logs (time).
    run, motion
        The logs (time).
    """
    companion = {f"companion_{key}": motion.attrs[key] for key in _ROWS if key in motion.attrs}
    if alone := run.sizes["time"] - merged.sizes["time"]:
        companion["rows_not_covered"] = alone
    return merged.assign_attrs(companion)
