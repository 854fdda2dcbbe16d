"""What the contact tests share: the reference surfaces, the published numbers, one elastic body."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from hypothesis import settings

# Same cases on every run, and no clock: the machine that runs the tests may be busy.
properties = settings(deadline=None, derandomize=True, max_examples=60)

E_STAR = 2.0e6  # Pa: 1.5 MPa with Poisson's ratio 0.5
SURFACES = ("Smooth", "Sb-S", "Sb-R")

# H, roll-off [1/m], plateau [m4]: the stand-ins for the paper's measured spectra.
_SPECTRA = {
    "Smooth": (1.090, 4.666116e4, 1.435334e-22),
    "Sb-S": (1.155, 9.053363e4, 1.629575e-22),
    "Sb-R": (1.190, 2.804894e4, 5.461285e-20),
}


def reference_psd(name: str, points: int | None = None) -> xr.Dataset:
    """Plateau and power law; three nodes hold it exactly, `points` puts it on a log grid."""
    hurst, rolloff, plateau = _SPECTRA[name]
    q = np.array([423.0, rolloff, np.pi / 1e-9])
    if points:
        q = np.union1d(q, np.geomspace(q[0], q[-1], points))
    c = plateau * np.maximum(q / rolloff, 1.0) ** (-2 * (1 + hurst))
    return xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})


def target(shared: Path, quantity: str, surface: str, condition: str = "") -> float:
    """The published number, as printed."""
    rows = pd.read_csv(shared / "targets.csv")
    rows = rows[(rows["quantity"] == quantity) & (rows["surface"] == surface)]
    rows = rows[rows["condition"].str.contains(condition, regex=False)]
    assert len(rows) == 1, f"{quantity}, {surface}, {condition}: {len(rows)} rows"
    return float(rows["published"].iloc[0])
