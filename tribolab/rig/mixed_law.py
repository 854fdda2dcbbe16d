"""Friction law of the rough surfaces in glycerol, from the mixed-lubrication model."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from tribolab.core.errors import AnalysisError, Cure
from tribolab.studies import xu2026

# includes all set speeds, so that the true friction at them is not interpolated
_SPEEDS = tuple(sorted({1e-9, 1e-8, 1e-7, *xu2026.SPEEDS, 3e-2, 1e-1}))


@dataclass(frozen=True)
class MixedLaw:
    """Friction coefficient against speed from the mixed-lubrication model.

    Parameters
    ----------
    surface
        Name of the surface, whose spectrum (a stand-in for the measured one) the model uses.
    normal_force
        Normal force [N].
    shear_stress
        Shear stress sigma_f in the real contact area [Pa].
    speeds, friction
        Computed curve: speeds [m/s] and µ, interpolated in ln v (PCHIP).

    Examples
    --------
    >>> law = MixedLaw("Sb-S", 31.0, 0.84e6, speeds=(1e-6, 1e-4, 1e-2), friction=(1.4, 0.7, 0.02))
    >>> law([1e-7, 1e-4]).tolist()
    [1.4, 0.7]
    """

    surface: str
    normal_force: float
    shear_stress: float
    speeds: tuple[float, ...]
    friction: tuple[float, ...]

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return the friction coefficient at speeds [m/s]; below the lowest speed it is constant.

        Raises
        ------
        AnalysisError
            If a speed is above the highest of the computed curve.
        """
        v = np.asarray(speed, dtype=float)
        low, high = self.speeds[0], self.speeds[-1]
        if np.any(v > high * (1 + 1e-9)):
            raise AnalysisError(
                f"the rig's friction law of {self.surface} ends at {high:g} m/s; got {v.max():g} "
                "m/s",
                cure=Cure(notebook="take slower strokes, or give simulate_run a law of your own"),
            )
        curve = PchipInterpolator(np.log(self.speeds), self.friction)
        return curve(np.log(np.clip(v, low, high)))


@functools.cache
def mixed_law(surface: str, normal_force: float) -> MixedLaw:
    """Return the friction law of a rough surface in glycerol, with the paper's shear stress.

    The shear stress is interpolated between the loads of the paper, and constant beyond them.

    Parameters
    ----------
    surface
        ``"Sb-S"`` or ``"Sb-R"``.
    normal_force
        Normal force [N].

    Notes
    -----
    `tribolab.stribeck_curve` with the system and the stand-in spectrum of `studies.xu2026`: exact
    at the paper's 13 speeds, with a few on either side. Computed once in a process.

    Examples
    --------
    >>> law = mixed_law("Sb-S", 31.0)
    >>> law.shear_stress, round(float(law(1e-6)), 2)
    (840000.0, 1.38)
    """
    # imported late for a quick start
    from tribolab.lubrication.stribeck import stribeck_curve

    known = xu2026.surface(surface)
    forces, stresses = zip(*known.shear_stress, strict=True)
    stress = float(np.interp(normal_force, forces, stresses))
    contact, eta = xu2026.contact, xu2026.system.viscosity
    load = contact.load(normal_force)
    curve = stribeck_curve(contact, xu2026.psd(known.name), eta, load, stress, _SPEEDS)
    friction = tuple(curve["friction_coefficient"].values.tolist())
    return MixedLaw(known.name, float(normal_force), stress, _SPEEDS, friction)
