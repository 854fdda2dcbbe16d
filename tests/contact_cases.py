"""What the contact tests share: the reference surfaces, the published numbers, one elastic body."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from hypothesis import settings

from tribolab.contact.geometry import LineContact
from tribolab.studies import xu2026
from tribolab.surface.moments import rms_slope
from tribolab.surface.self_affine import psd_2d

# Same cases on every run, and no clock: the machine that runs the tests may be busy.
properties = settings(deadline=None, derandomize=True, max_examples=60)

E_STAR = 2.0e6  # Pa: 1.5 MPa with Poisson's ratio 0.5
CONTACT = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
SURFACES = ("Smooth", "Sb-S", "Sb-R")


def reference_psd(name: str, points: int | None = None) -> xr.Dataset:
    """Plateau and power law; three nodes hold it exactly, `points` puts it on a log grid."""
    spectrum = xu2026.surface(name).spectrum
    q = np.array([spectrum.low, spectrum.rolloff, spectrum.high])
    if points:
        q = np.union1d(q, np.geomspace(q[0], q[-1], points))
    return xr.Dataset({"psd_2d": ("wavenumber", psd_2d(spectrum, q))}, {"wavenumber": q})


def self_affine(hurst: float, slope: float) -> xr.Dataset:
    """A spectrum with the roll-off at 1e4 1/m and the rms slope asked for."""
    q = np.array([1e3, 1e4, 1e9])
    c = np.array([1.0, 1.0, 1e5 ** (-2 * (1 + hurst))])
    psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})
    return psd * (slope / rms_slope(psd)) ** 2


def target(shared: Path, quantity: str, surface: str, condition: str = "") -> float:
    """The published number, as printed."""
    rows = pd.read_csv(shared / "targets.csv")
    rows = rows[(rows["quantity"] == quantity) & (rows["surface"] == surface)]
    rows = rows[rows["condition"].str.contains(condition, regex=False)]
    assert len(rows) == 1, f"{quantity}, {surface}, {condition}: {len(rows)} rows"
    return float(rows["published"].iloc[0])
