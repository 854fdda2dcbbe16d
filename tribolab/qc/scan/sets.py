"""Checks on several scans of one surface, and on roughness values without a profile."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from tribolab.qc.findings import Findings
from tribolab.qc.register import Result
from tribolab.qc.scan.checks import SCAN_CHECKS, check_scans
from tribolab.qc.scan.instrument import uncomputed_values

_REPEATS = "repeats"
CheckLimits = Mapping[str, Mapping[str, str | float]]


def check_scan_set(
    scans: Sequence[xr.Dataset],
    *,
    limits: CheckLimits | None = None,
    skip: Sequence[str] = (),
    results: Sequence[Sequence[xr.Dataset]] | None = None,
) -> list[Findings]:
    """Return the findings of the checks on each scan, and on the scans against each other.

    Parameters
    ----------
    scans
        One dataset for each file, as `read_scans` with ``stack=False`` returns them.
    limits, skip
        As for `check_scans`.
    results
        The instrument's own results for each scan.

    Returns
    -------
    list of Findings
        One for each scan. The check "repeats" objects to the outlying scan only; if two scans
        differ and there is no third, it objects to both.

    Raises
    ------
    AnalysisError
        If a dataset holds no scan.
    ConfigError
        If a check or a limit is unknown; the message names the nearest.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> rows = 1e-8 * rng.standard_normal((3, 4096)).cumsum(axis=1) * [[1], [1], [9]]
    >>> x = 1e-6 * np.arange(4096)
    >>> scans = [xr.Dataset({"height": ("x", row)}, {"x": x}) for row in rows]
    >>> [found.status for found in check_scan_set(scans)]
    ['pass', 'pass', 'fail']
    """
    given = results or [()] * len(scans)
    findings = [
        check_scans(scan, limits=limits, skip=skip, results=list(own))
        for scan, own in zip(scans, given, strict=True)
    ]
    if len(scans) < 2 or _REPEATS in skip:
        return findings
    shapes = [_shape(scan) for scan in scans]
    usual = Counter(shapes).most_common(1)[0][0]
    alike = [number for number, shape in enumerate(shapes) if shape == usual]
    verdicts = {
        number: Result("skipped", "height", "it differs from the others in pitch or length")
        for number in range(len(scans))
    }
    if len(alike) > 1:
        verdicts.update(_repeats([scans[number] for number in alike], alike, limits, skip))
    return [_add_repeats(finding, verdicts[number]) for number, finding in enumerate(findings)]


def check_results(results: xr.Dataset) -> Findings:
    """Return the findings of the checks on roughness values that have no profile.

    Parameters
    ----------
    results
        From `tribolab.reading.scans.results.read_tester_results`.

    Returns
    -------
    Findings
        Result of the check "results": values that the instrument could not compute.
    """
    text = "the instrument could compute all of its values; there is no profile to compare with"
    result = uncomputed_values(results) or Result("pass", "results", text)
    name = str(results.attrs.get("source", "results"))
    return Findings(name, ((SCAN_CHECKS["results"], result),))


def _shape(scan: xr.Dataset) -> tuple[Any, ...]:
    x = scan.x.values
    return (*sorted(scan.sizes.items()), f"{(x[-1] - x[0]) / (x.size - 1):.4g}")


def _repeats(
    scans: list[xr.Dataset], numbers: list[int], limits: CheckLimits | None, skip: Sequence[str]
) -> dict[int, Result]:
    """Return the result of comparing each scan with the others, as a dictionary by scan number."""
    rows = [np.asarray(scan.height.transpose(..., "x").values, dtype=float) for scan in scans]
    names = [str(scan.attrs.get("source", f"scan {n + 1}")) for n, scan in enumerate(scans)]
    first = scans[0]
    if any(row.ndim > 2 or (row.ndim == 2 and len(row) > 1) for row in rows):
        text = "maps are not compared with each other"
        return dict.fromkeys(numbers, Result("skipped", "height", text))
    kept = {k: v for k, v in first.attrs.items() if k in ("tip_radius_m", "form_removed")}
    together = xr.Dataset(
        {"height": (("scan", "x"), np.stack([row.reshape(-1) for row in rows]))},
        {"x": first.x.values, "file": ("scan", names)},
        kept,
    )
    others = tuple(name for name in SCAN_CHECKS if name != _REPEATS)
    checked = check_scans(together, limits=limits, skip=(*skip, *others))
    [repeats] = [result for check, result in checked.results if check.name == _REPEATS]
    if repeats.status not in ("suspect", "fail") or len(scans) == 2:
        return dict.fromkeys(numbers, repeats)
    odd = names.index(repeats.where)
    fine = f"agrees with the other scans but {names[odd]}"
    right = Result("pass", "height", fine, repeats.value)
    return {number: repeats if n == odd else right for n, number in enumerate(numbers)}


def _add_repeats(findings: Findings, repeats: Result) -> Findings:
    """Return the findings of a scan with the result of the check "repeats" replaced."""
    rows = tuple(
        (check, repeats if check.name == _REPEATS else result) for check, result in findings.results
    )
    return Findings(findings.name, rows, findings.flagged, findings.limits)
