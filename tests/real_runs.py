"""The real measured runs and profiles that several tests use."""

from functools import cache
from pathlib import Path

import xarray as xr

from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans


def actuator(folder: Path, name: str) -> xr.Dataset:
    return read(folder / "actuator_friction_CC0" / f"{name}.csv")


def rock(folder: Path) -> xr.Dataset:
    return read(folder / "rock_velstep_MIT" / "velstep4_BRAVA_expb819_basalt.txt")


def paper(folder: Path, stiffness: int, speed: int) -> xr.Dataset:
    return read(folder / "stickslip_paper_CeCILL-B" / f"k{stiffness}Nm_v{speed}.mat")


def reciprocating(folder: Path) -> xr.Dataset:
    return read(folder / "cetr_umt2_MIT" / "HT-2n-6-4 2_001.csv")


@cache
def mitutoyo(folder: Path, name: str) -> xr.Dataset:
    """A workbook takes a second to read; not to be changed."""
    return read_scans(folder / "surfacetopography_MIT" / f"{name}.xlsx")
