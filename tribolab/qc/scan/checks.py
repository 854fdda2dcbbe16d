"""All checks on the scans of one surface, with a table of findings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.core.errors import AnalysisError, ConfigError, Cure, nearest, shown
from tribolab.qc.findings import Findings
from tribolab.qc.flags import attach
from tribolab.qc.register import SWITCHED_OFF, Check, resolve_limits, results_of_checks
from tribolab.qc.scan.artefact_checks import ARTEFACT_CHECKS
from tribolab.qc.scan.height_checks import HEIGHT_CHECKS
from tribolab.qc.scan.instrument import INSTRUMENT_CHECKS
from tribolab.qc.scan.roughness_checks import REPEAT_CHECKS, ROUGHNESS_CHECKS
from tribolab.qc.scan.subject import ScanSubject

_ALL = *HEIGHT_CHECKS, *ROUGHNESS_CHECKS, *ARTEFACT_CHECKS, *INSTRUMENT_CHECKS, *REPEAT_CHECKS
SCAN_CHECKS: dict[str, Check[ScanSubject]] = {check.name: check for check in _ALL}


@of_runs
def check_scans(
    scans: xr.Dataset,
    *,
    limits: Mapping[str, Mapping[str, str | float]] | None = None,
    skip: Sequence[str] = (),
    results: xr.Dataset | Sequence[xr.Dataset] | None = None,
) -> Findings:
    """Return the findings of all checks on scans: errors, their place, effect and remedy.

    Parameters
    ----------
    scans
        ``height`` [m] (scan, x) from `scan_files.read_scans`, a single profile or a map
        (y, x). A list of such datasets gives a list.
    limits
        ``{check: {limit: value}}`` over the defaults; SI numbers or text with a unit.
    skip
        Names of checks to leave out; they appear as skipped.
    results
        The instrument's own results from `results.read_tester_results`.

    Returns
    -------
    Findings
        ``.table`` shows one row for each check and variable, ``.status`` the worst,
        ``.flagged`` the scans with ``height_qc`` and ``height_qc_tests``.

    Raises
    ------
    AnalysisError
        If the dataset holds no scan.
    ConfigError
        If a check or a limit is unknown; the message names the nearest.

    Examples
    --------
    >>> import numpy as np
    >>> rng = np.random.default_rng(0)
    >>> height = 1e-7 * rng.standard_normal(4096).cumsum()
    >>> height[1000:] += 2e-5
    >>> scans = xr.Dataset({"height": ("x", height)}, {"x": 1e-6 * np.arange(4096)})
    >>> check_scans(scans).table.query("check == 'steps'").message.item()
    'the height jumps 1 time, scan 1, x = 1 mm'
    """
    for name in skip:
        if name not in SCAN_CHECKS:
            raise ConfigError(
                f"[qc] skip: no check is called '{shown(name)}'{nearest(name, SCAN_CHECKS)}"
            )
    if "height" not in scans or "x" not in scans.height.dims or scans.sizes["x"] < 2:
        raise AnalysisError(
            "scans with 'height' (scan, x) are wanted",
            cure=Cure(notebook="read them with read_scans()"),
            function="check_scans",
        )
    resolved = resolve_limits(SCAN_CHECKS, limits or {})
    given = [results] if isinstance(results, xr.Dataset) else list(results or ())
    subject = ScanSubject(scans, given)
    answers = results_of_checks(SCAN_CHECKS, subject, resolved, dict.fromkeys(skip, SWITCHED_OFF))
    listed = tuple((SCAN_CHECKS[name], result) for name, rows in answers.items() for result in rows)
    flags = {
        check.name: subject.reshape_flags(result.flags)
        for check, result in listed
        if result.flags is not None
    }
    bits = {check.name: check.bit for check in SCAN_CHECKS.values()}
    flagged = attach(scans, "height", flags, bits)
    return Findings(str(scans.attrs.get("source", "scans")), listed, flagged, resolved)
