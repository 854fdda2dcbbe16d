"""Writing of simulated scans with faults."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.rig.faults import FAULTS, Fault
from tribolab.rig.files import scan_file
from tribolab.rig.scans.faults import SCAN_FAULTS, ScanFault, exported

# names for `simulate_campaign(faults=...)`, with the prefix scan_ if a fault of runs has that name
SCAN_FAULTS_BY_NAME: dict[str, ScanFault] = {
    f"scan_{name}" if name in FAULTS else name: fault for name, fault in SCAN_FAULTS.items()
}


def fault_of_campaign(name: str) -> Fault | ScanFault:
    """Return the fault with a given name, which is a fault of runs or of scans.

    Raises
    ------
    ConfigError
        If there is no such fault; the message suggests similar names.

    Examples
    --------
    >>> fault_of_campaign("dropouts").check, fault_of_campaign("scan_dropouts").check
    ('missing', 'dropouts')
    """
    every: dict[str, Fault | ScanFault] = {**FAULTS, **SCAN_FAULTS_BY_NAME}
    if name not in every:
        raise ConfigError(f"the rig has no fault '{shown(name)}'{nearest(name, every, most=None)}")
    return every[name]


def write_faulty_scans(
    scans: xr.Dataset, faults: Sequence[str], folder: Path, rng: int | np.random.Generator = 0
) -> dict[str, dict[str, list[dict[str, str]]]]:
    """Write simulated scans with faults into files, and return the faults in each file.

    Parameters
    ----------
    scans
        From `tribolab.rig.scans`; not changed.
    faults
        Names accepted by `fault_of_campaign`, in the order of application.
    folder
        Target folder, which must exist.
    rng
        Seed or generator.

    Returns
    -------
    dict
        For each faulty file, the faults with their effect, the check that must find them, and
        its lowest expected status.
    """
    rng = np.random.default_rng(rng)
    struck = exported(scans)
    # Ra and Rq of the instrument are exported only if a fault concerns them
    results = any(SCAN_FAULTS_BY_NAME[name].check == "results" for name in faults)
    files = _files(struck, results)
    facts: dict[str, dict[str, list[dict[str, str]]]] = {}
    for name in faults:
        fault = SCAN_FAULTS_BY_NAME[name]
        struck = fault.strike(struck, rng)
        before, files = files, _files(struck, results)
        entry = {"name": name, "what": fault.what, "severity": fault.severity, "check": fault.check}
        for file, content in files.items():
            if content != before[file]:
                facts.setdefault(file, {"faults": []})["faults"].append(entry)
    for file, content in files.items():
        (folder / file).write_bytes(content)
    return facts


def _files(scans: xr.Dataset, results: bool) -> dict[str, bytes]:
    """Return the content of the file of each scan, by file name."""
    attrs, x, heights = scans.attrs, scans.x.values, scans.height.values
    if "recorded_x" in scans.coords:  # the traverse moved at uneven speed
        places = scans.recorded_x.values
        x, heights = places, [np.interp(places, x, row) for row in heights]
    stated = {name: attrs[f"instrument_{name}_m"].split("; ") for name in ("Ra", "Rq")}
    return {
        str(file): scan_file(
            x,
            height,
            tip_radius=attrs["tip_radius_m"],
            pitch=attrs["stated_pitch_m"],
            length=attrs["stated_length_m"],
            results={name: float(values[row]) for name, values in stated.items() if results},
        )
        for row, (file, height) in enumerate(zip(scans.file.values, heights, strict=True))
    }
