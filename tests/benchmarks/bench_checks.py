"""How long all checks on a run of a million rows take, against reading its file with pandas.

    python tests/benchmarks/bench_checks.py

Processor time, so that a busy machine does not spoil it; best of three, after one to warm up.
"""

from __future__ import annotations

import io

import numpy as np
import pandas as pd
import xarray as xr
from side_by_side import least_times, row

from tribolab.qc.run.checks import check_run
from tribolab.units.stamping import stamp

ROWS = 1_000_000


def made() -> xr.Dataset:
    """Build twenty strokes at 1 mm/s, sampled at 1 kHz, with noise and the steps of a converter."""
    rng = np.random.default_rng(0)
    moment = np.arange(ROWS) / 1000
    wave = np.sin(2 * np.pi * moment / 100)
    velocity = np.where(np.abs(wave) < 0.1, 0.0, 1e-3 * np.sign(wave))
    force = 2e4 * velocity + 0.04 * rng.standard_normal(ROWS)
    signals = {
        "friction_force": np.round(force / 0.015) * 0.015,
        "normal_force": np.round((31 + 0.05 * rng.standard_normal(ROWS)) / 0.015) * 0.015,
        "sliding_velocity": velocity * (1 + 0.02 * rng.standard_normal(ROWS)),
        "position": np.cumsum(velocity) / 1000,
    }
    data = {name: ("time", values) for name, values in signals.items()}
    return stamp(xr.Dataset(data, {"time": moment}), source="made")


def main() -> None:
    """Print both times and their ratio."""
    run = made()
    text = run.to_dataframe().round(6).to_csv()
    times = least_times(
        3,
        checks=lambda: check_run(run, normal_force=31.0),
        reading=lambda: pd.read_csv(io.StringIO(text)),
    )
    row(f"all checks of {ROWS:.0e} rows", times["checks"], "pandas", times["reading"], None)


if __name__ == "__main__":
    main()
