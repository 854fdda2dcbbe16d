"""What the contact tests share: the reference surfaces, the published numbers, one elastic body."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from hypothesis import settings

from tribolab.contact.geometry import LineContact
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.studies import xu2026
from tribolab.surface.moments import rms_roughness, rms_slope
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


class RandomContact(NamedTuple):
    """A lubricated contact anywhere in the range that the solver is made for."""

    name: str
    modulus: float  # E [Pa]
    viscosity: float  # [Pa s]
    load: float  # [N/m]
    roughness: float  # h_rms [m]

    def curve(self, speeds: int | np.ndarray = 33, cells: int = 160) -> xr.Dataset:
        """Over eight decades of speed, or at speeds [m/s].

        The surface is one of the paper's, stretched all ways.
        """
        psd = reference_psd(self.name)
        factor = self.roughness / rms_roughness(psd)
        psd = psd.assign_coords(wavenumber=psd.wavenumber / factor) * factor**4
        return stribeck_curve(
            LineContact(0.07, 0.1, self.modulus, 0.5),
            psd,
            self.viscosity,
            self.load,
            1e6,
            np.geomspace(1e-9, 1e-1, speeds) if np.ndim(speeds) == 0 else speeds,
            cells=cells,
        )


def random_contacts(number: int, seed: int) -> Iterator[RandomContact]:
    """Draw contacts, evenly in the logarithms of all quantities."""
    rng = np.random.default_rng(seed)
    ranges = [(1e5, 1e9), (1e-3, 100), (310 / 30, 310 * 30), (1e-8, 50e-6)]
    for _ in range(number):
        values = [float(np.exp(rng.uniform(*np.log(ends)))) for ends in ranges]
        yield RandomContact(SURFACES[rng.integers(3)], *values)
