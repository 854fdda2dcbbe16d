"""Quality control of measured data: flags, checks on runs and scans, findings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.qc.finding_table import objections as objections
    from tribolab.qc.run.checks import RUN_CHECKS as RUN_CHECKS
    from tribolab.qc.scan.checks import check_scans as check_scans
    from tribolab.qc.scan.sets import check_scan_set as check_scan_set

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
