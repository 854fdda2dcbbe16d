"""Two results folders, value by value: which numbers of their tables differ, and by how much.

Run with ``python tests/robustness/compare_results.py BEFORE AFTER [relative tolerance]``; exit code
1 if anything differs. Tables that only one of them has are named.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd


def differences(before: pd.DataFrame, after: pd.DataFrame, tolerance: float) -> list[str]:
    """Say what differs between two tables."""
    said = []
    for name in before.columns.symmetric_difference(after.columns):
        said.append(f"column {name} is only in {'before' if name in before else 'after'}")
    if len(before) != len(after):
        return [*said, f"{len(before)} rows before, {len(after)} after"]
    for name in before.columns.intersection(after.columns, sort=False):
        one, other = before[name], after[name]
        if one.dtype.kind in "fiu" and other.dtype.kind in "fiu":
            a, b = one.to_numpy(float), other.to_numpy(float)
            same = np.isclose(a, b, rtol=tolerance, atol=0, equal_nan=True)
        else:
            same = ((one == other) | (one.isna() & other.isna())).to_numpy()
        if not same.all():
            first = int(np.argmin(same))
            said.append(
                f"{name}: {int((~same).sum())} of {len(same)} differ, first in row {first + 1}: "
                f"{one.iloc[first]!r} -> {other.iloc[first]!r}"
            )
    return said


def main(before: Path, after: Path, tolerance: float) -> int:
    """Compare all tables; return the exit code."""
    tables = [{p.name: p for p in (f / "tables").glob("*.csv")} for f in (before, after)]
    values = count = 0
    for name in sorted(tables[0].keys() | tables[1].keys()):
        if name not in tables[0] or name not in tables[1]:
            print(f"{name}: only {'before' if name in tables[0] else 'after'}")
            count += 1
            continue
        one, other = (pd.read_csv(mine[name]) for mine in tables)
        found = differences(one, other, tolerance)
        values += one.size
        count += len(found)
        for line in found:
            print(f"{name}: {line}")
    print(f"{values} values in {len(tables[0])} tables; {count} differences")
    return int(count > 0)


if __name__ == "__main__":
    limit = float(sys.argv[3]) if len(sys.argv) > 3 else 0.0
    raise SystemExit(main(Path(sys.argv[1]), Path(sys.argv[2]), limit))
