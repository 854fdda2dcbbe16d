"""Quality of instrument data: flags, checks on runs and scans, findings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.qc.finding_table import objections
    from tribolab.qc.run.checks import RUN_CHECKS
    from tribolab.qc.scan.checks import check_scans
    from tribolab.qc.scan.sets import check_scan_set

__all__ = [
    "RUN_CHECKS",
    "check_scan_set",
    "check_scans",
    "objections",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "RUN_CHECKS": "run.checks",
        "check_scan_set": "scan.sets",
        "check_scans": "scan.checks",
        "objections": "finding_table",
    },
)
