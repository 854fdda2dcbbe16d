"""Checks on data of either kind, runs or scans."""

from __future__ import annotations

from typing import Any

import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.qc.findings import Findings
from tribolab.qc.run.checks import check_run
from tribolab.qc.scan.checks import check_scans
from tribolab.qc.scan.sets import check_scan_set


def check(
    data: xr.Dataset | list[xr.Dataset], segments: xr.Dataset | None = None, **options: Any
) -> Findings | list[Findings]:
    """Return the findings of all checks on a run or on scans.

    Parameters
    ----------
    data
        A run (dim ``time``), scans of one surface (``height``), or a list of either. Scans in a
        list are also checked against each other.
    segments
        The segments of a run; found if not given.
    **options
        ``limits`` and ``skip``; for runs ``friction``, ``slip``, ``normal_force`` and
        ``contact_width`` as for `check_run`, for scans ``results`` as for `check_scans`.

    Returns
    -------
    Findings or list of Findings
        One for each dataset.

    Raises
    ------
    AnalysisError
        If the data are neither runs nor scans.
    ConfigError
        If a check or a limit is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> noise = 0.01 * np.random.default_rng(0).standard_normal(400)
    >>> run = xr.Dataset({"friction_force": ("time", 1 + noise)}, {"time": np.arange(400) / 100})
    >>> run = run.assign(sliding_velocity=("time", np.full(400, 1e-3)))
    >>> check(run).status, check(run.assign_attrs(friction_force_zero_uncertainty_N=0.01)).status
    ('suspect', 'pass')
    >>> check(xr.Dataset({"height": ("x", 1e-6 * noise)}, {"x": 1e-6 * np.arange(400)})).status
    'pass'
    """
    if _is_scan(data):
        return check_scans(data, **options)
    if isinstance(data, list) and data and all(_is_scan(each) for each in data):
        return check_scan_set(data, **options)
    return _check_runs(data, segments, **options)


_check_runs = of_runs(check_run, "check")


def _is_scan(data: object) -> bool:
    return isinstance(data, xr.Dataset) and "height" in data
