"""Checking a run against its Table Schema, against plain pandas masks for the same limits.

Run: ``python tests/benchmarks/bench_table_schema.py``; prints seconds and the ratio.
"""

from __future__ import annotations

import time

import numpy as np
import pandas as pd

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


def best(function, table: pd.DataFrame) -> float:
    """Shortest of five."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        function(table)
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    """Print the times for good data, and for data of which every third row is bad."""
    rng = np.random.default_rng(0)
    table = pd.DataFrame({name: rng.normal(size=ROWS) for name in COLUMNS})
    table["time"] = np.arange(ROWS) * 1e-3
    for name in ("good", "a third bad"):
        if name != "good":
            table.loc[::3, "normal_force"] = -1e9
        assert validate(table).total == with_masks(table)
        ours, masks = best(validate, table), best(with_masks, table)
        print(f"{name}: {ours:.4f} s, masks {masks:.4f} s, masks/ours {masks / ours:.1f}")


if __name__ == "__main__":
    main()
