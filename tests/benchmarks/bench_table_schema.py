"""Checking a run against its Table Schema, against plain pandas masks for the same limits.

Run: ``python tests/benchmarks/bench_table_schema.py``; prints seconds and the ratio.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from side_by_side import least_times, row

from tribolab.reading.netcdf.table_schema import load_schema, validate

ROWS = 1_000_000
COLUMNS = ("time", "friction_force", "normal_force", "sliding_velocity", "position")


def with_masks(table: pd.DataFrame) -> int:
    """Count what is out of limits with two masks a column, as one would by hand."""
    count = 0
    for field in load_schema("run")["fields"]:
        if field["name"] in table:
            limits, values = field["constraints"], table[field["name"]]
            count += int((values < limits["minimum"]).sum() + (values > limits["maximum"]).sum())
    return count + int(table["time"].isna().sum() + table["time"].duplicated().sum())


def main() -> None:
    """Print the times for good data, and for data of which every third row is bad."""
    rng = np.random.default_rng(0)
    table = pd.DataFrame({name: rng.normal(size=ROWS) for name in COLUMNS})
    table["time"] = np.arange(ROWS) * 1e-3
    for name in ("good", "a third bad"):
        if name != "good":
            table.loc[::3, "normal_force"] = -1e9
        assert validate(table).total == with_masks(table)
        times = least_times(5, ours=lambda: validate(table), masks=lambda: with_masks(table))
        row(f"table schema, {name}", times["ours"], "pandas masks", times["masks"], 1)


if __name__ == "__main__":
    main()
