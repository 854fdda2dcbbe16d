"""Simulation of stylus profiles on the cylinders of the reference study."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.studies import xu2026
from tribolab.surface.synthesis import synthesise_profiles
from tribolab.units.stamping import stamp

_OVERSAMPLING = 2  # simulated points per pitch of the recorded profile
_NOISE = 5e-9  # m, rms noise
_STEP = 1e-9  # m, height resolution
_TILT = 0.02  # largest slope at which a specimen is mounted


def scans(
    surface: str = "Sb-S",
    profiles: int | None = None,
    *,
    seed: int | np.random.Generator = 0,
    length: float | None = None,
) -> xr.Dataset:
    """Return simulated profiles along the circumference of a cylinder, as a stylus traces them.

    Parameters
    ----------
    surface
        ``"Smooth"``, ``"Sb-S"`` or ``"Sb-R"``.
    profiles
        Number of scans at different positions; by default three, as in the paper.
    seed
        Seed or generator.
    length
        Scan length [m]; default the paper's 25 mm.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (profile, x) as measured. Attributes: the truth (``radius_m``, the spectrum's
        roughness and slope).

    Notes
    -----
    Roughness is generated at half the pitch, on twice the length so that scans are not periodic.
    The cylinder is a circle, not a parabola: over 25 mm they differ by 9 um, and a parabola fitted
    to it has a curvature 0.7 % too large. The stylus is a sphere that touches from above (dilation
    along the profile, ignoring heights next to the track). Noise and resolution are added last.

    Examples
    --------
    >>> scan = scans("Sb-R", 1, length=2e-3)
    >>> scan.height.shape
    (1, 4001)
    """
    known, tool = xu2026.surface(surface), xu2026.profilometer
    profiles = profiles or tool.scans
    length = length or tool.scan_length
    rng = np.random.default_rng(seed)
    fine = tool.pitch / _OVERSAMPLING
    points = round(length / fine) + 1
    rough = synthesise_profiles(
        known.spectrum,
        points=1 << int(np.ceil(np.log2(2 * points))),
        pitch=fine,
        profiles=profiles,
        rng=rng,
    )
    x = fine * np.arange(points)
    off_centre = rng.uniform(-0.02, 0.02, (profiles, 1)) * length
    angle = rng.uniform(-_TILT, _TILT, (profiles, 1))
    radius = xu2026.system.radius
    form = np.sqrt(radius**2 - (x - length / 2 - off_centre) ** 2) - radius + angle * x
    felt = touch(rough.height.values[:, :points] + form, fine, tool.tip_radius)
    height = felt[:, ::_OVERSAMPLING] + _NOISE * rng.standard_normal(
        (profiles, (points - 1) // _OVERSAMPLING + 1)
    )
    height -= height[:, :1]  # the instrument sets the first height to zero
    data = xr.Dataset(
        {"height": (("profile", "x"), np.round(height / _STEP) * _STEP)},
        {"x": tool.pitch * np.arange(height.shape[1])},
    )
    return stamp(
        data,
        surface=known.name,
        origin=xu2026.STAND_IN,
        radius_m=radius,
        tip_radius_m=tool.tip_radius,
        rms_roughness_m=known.rms_roughness,
        rms_slope=known.rms_slope,
        variance_in_band_m2=rough.attrs["variance_in_band_m2"],
    )


def touch(height: np.ndarray, pitch: float, tip_radius: float) -> np.ndarray:
    """Return the height [m] of a spherical tip that slides along profiles (..., x)."""
    # imported late: scipy loads slowly
    from scipy.ndimage import grey_dilation

    half = int(tip_radius / pitch)
    reach = pitch * np.arange(-half, half + 1)
    ball = np.sqrt(np.maximum(tip_radius**2 - reach**2, 0)) - tip_radius
    structure = ball.reshape((1,) * (height.ndim - 1) + (-1,))
    return grey_dilation(height, structure=structure, mode="nearest")
