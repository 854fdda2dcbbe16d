"""A rough ball, and its curve by numerics on meshes of their own."""

import numpy as np
import xarray as xr

from tribolab.contact.geometry import PointContact
from tribolab.lubrication.parameters import Solver

BALL = PointContact("9.5 mm", "1 MPa", 0.5)
STRESS = 1e5  # Pa
COARSE = Solver(cells=60)  # for what holds on any mesh
# viscosity times speed [N/m]: friction of the fluid, area per force [1/Pa], film in the middle [m]
TABLE = {
    0.0: (0.0, 1.1818e-6, 0.134e-6),
    1e-7: (2.2e-5, 1.1299e-6, 0.172e-6),
    1e-6: (1.95e-4, 9.812e-7, 0.247e-6),
    1e-5: (0.00149, 7.065e-7, 0.395e-6),
    3.16e-5: (0.00377, 5.347e-7, 0.517e-6),
    1e-4: (0.00865, 3.562e-7, 0.699e-6),
    3.16e-4: (0.01663, 1.842e-7, 1.005e-6),
    1e-3: (0.02097, 5.05e-8, 1.633e-6),
    3.16e-3: (0.01517, 3.8e-9, 2.944e-6),
    1e-2: (0.01672, 0.0, 5.539e-6),
    0.1: (0.0490, 0.0, 20.93e-6),
    1.0: (0.1736, 0.0, 82.15e-6),
}


def ball_psd() -> xr.Dataset:
    """Flat up to 4e5 1/m, then H = 0.9 up to 1e8 1/m: h_rms 0.8 um, slope 1."""
    q = np.unique(np.concatenate([np.geomspace(2e3, 4e5, 40), np.geomspace(4e5, 1e8, 80)]))
    c = 6.0314e-25 * np.where(q <= 4e5, 1.0, (q / 4e5) ** -3.8)
    return xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
