"""Friction laws of the virtual rig: mixed lubrication where it is valid, else empirical laws."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError, nearest
from tribolab.rig.mixed_law import MixedLaw, mixed_law
from tribolab.studies import xu2026

_MEDIA = ("glycerol", "dry")

# Effective shear stress [Pa] of the dry contact area with adhesion: the order of magnitude of
# Sec. 6, with the paper's ratio of 1.5 between Sb-R and Sb-S; the paper only plots the values.
_DRY_SHEAR_STRESS = {"Smooth": 0.130e6, "Sb-S": 0.605e6, "Sb-R": 0.907e6}


@dataclass(frozen=True)
class DryLaw:
    """Dry friction that increases slowly: ``mu = level (1 + slope log10(v / 0.1 mm/s))``.

    Examples
    --------
    >>> DryLaw(level=0.5)(1e-3).round(4).item()
    0.5075
    """

    level: float
    slope: float = 0.015

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return the friction coefficient at sliding speeds [m/s]."""
        return self.level * (1 + self.slope * np.log10(np.asarray(speed, dtype=float) / 1e-4))


@dataclass(frozen=True)
class StribeckLaw:
    """Empirical Stribeck curve of the smooth surface: plateau, transition, viscous drag.

    Parameters
    ----------
    boundary
        Friction coefficient of the plateau at low speed.
    transition_speed, exponent
        Speed [m/s] and exponent of the solid part ``boundary exp(-(v/transition_speed)^exponent)``.
    drag
        The viscous part is ``drag * (v / 1 cm/s)^0.4``.

    Examples
    --------
    >>> law = StribeckLaw(boundary=1.4, transition_speed=3e-5, exponent=1.5, drag=0.02)
    >>> law([1e-6, 1e-4, 1e-2]).round(3).tolist()
    [1.392, 0.006, 0.02]
    """

    boundary: float
    transition_speed: float
    exponent: float
    drag: float

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return the friction coefficient at sliding speeds [m/s]."""
        v = np.asarray(speed, dtype=float)
        solid = self.boundary * np.exp(-((v / self.transition_speed) ** self.exponent))
        return solid + self.drag * (v / 1e-2) ** 0.4


@dataclass(frozen=True)
class StickSlip:
    """Stick-slip of one surface in one medium: waveform, wavelength and drop against speed.

    Parameters
    ----------
    form
        ``"sawtooth"`` (slow linear rise, abrupt drop), ``"rounded"`` (near a sine) or ``"none"``.
    wavelength, wavelength_exponent
        Sliding distance per period [m]: ``wavelength * (v / 1 um/s) ** -wavelength_exponent``.
    drop, drop_exponent
        Fall from peak to valley, relative to the friction coefficient:
        ``drop * (v / 1 um/s) ** -drop_exponent``.
    fade_start, fade_stop
        The drop decreases linearly in log v between these speeds [m/s]; above, there is none.

    Examples
    --------
    >>> StickSlip("sawtooth", wavelength=22e-6, drop=0.18).at(1e-6)
    ('sawtooth', 2.2e-05, 0.18)
    """

    form: str = "none"
    wavelength: float = math.nan
    wavelength_exponent: float = 0.0
    drop: float = 0.0
    drop_exponent: float = 0.0
    fade_start: float = math.inf
    fade_stop: float = math.inf

    def at(self, speed: float) -> tuple[str, float, float]:
        """Return waveform, wavelength [m] and relative drop at a speed [m/s]."""
        left = 1.0
        if speed > self.fade_start:
            span = math.log(self.fade_stop / self.fade_start)
            left = math.log(self.fade_stop / speed) / span if span > 0 else 0.0
        if self.form == "none" or speed >= self.fade_stop * (1 - 1e-9) or left <= 0:
            return "none", math.nan, 0.0
        v = speed / 1e-6
        drop = left * self.drop * v**-self.drop_exponent
        return self.form, self.wavelength * v**-self.wavelength_exponent, drop


def _film_thickness(speed: float, normal_force: float) -> float:
    """Return the thickness [m] of a soft-EHL film in the glycerol of the paper.

    ``h/R = 3.05 (eta U/E'R)^0.6 (W/E'R)^-0.2`` with U = v/2 and E' = 2E*.
    """
    s = xu2026.system
    stiffness = 2 * s.effective_modulus * s.radius
    entrainment = s.viscosity * speed / 2 / stiffness
    return 3.05 * s.radius * entrainment**0.6 * (normal_force / s.length / stiffness) ** -0.2


def friction_law(surface: str, medium: str, normal_force: float) -> DryLaw | StribeckLaw | MixedLaw:
    """Return the law of friction against speed for a surface of Xu et al. under a load.

    Parameters
    ----------
    surface, medium
        ``"Smooth"``, ``"Sb-S"``, ``"Sb-R"``; ``"glycerol"`` or ``"dry"``.
    normal_force
        Normal force [N].

    Returns
    -------
    DryLaw, StribeckLaw or MixedLaw
        A function of speed [m/s]. `simulate_run` accepts any such function.

    Notes
    -----
    In glycerol the rough surfaces follow the mixed-lubrication model with the paper's fitted shear
    stress, see `mixed_law`. Smooth slides by instabilities: its plateau follows from the paper's
    adhesive area and area-corrected stress (Sec. 7). It is constant up to about 10 um/s, where
    forced wetting starts, as the paper observes without predicting it. Above, soft EHL adds drag.

    Examples
    --------
    >>> law = friction_law("Sb-S", "glycerol", 31.0)
    >>> round(float(law(1e-9)), 2)
    1.39
    """
    if medium not in _MEDIA:
        raise AnalysisError(f"the rig has no medium '{medium}'{nearest(medium, _MEDIA)}")
    s, known = xu2026.system, xu2026.surface(surface)
    pressure = s.nominal_pressure(normal_force)
    # adhesion makes the smooth contact almost complete at any load; other areas grow with load
    reference = pressure if known.name == "Smooth" else s.nominal_pressure(s.loads[0])
    if medium == "dry":
        level = _DRY_SHEAR_STRESS[known.name] * known.area_ratio_dry / reference
        return DryLaw(level)
    if known.name != "Smooth":
        return mixed_law(known.name, float(normal_force))
    ((_, stress),) = known.shear_stress
    drag = s.viscosity * 1e-2 * 2 * s.half_width(normal_force)
    drag /= _film_thickness(1e-2, normal_force) * normal_force / s.length
    boundary = stress * known.area_ratio / reference  # 0.224 x 0.5 equals 0.876 x 0.127
    return StribeckLaw(boundary, transition_speed=3e-5, exponent=1.5, drag=drag)


def stick_slip(surface: str, medium: str) -> StickSlip:
    """Return the stick-slip of a surface as Xu et al. describe it (Sec. 6 to 8): Smooth only.

    Dry stick-slip is a sawtooth, equal at 1 and 3 um/s. In glycerol it is rounder and longer, much
    weaker and shorter at 3 than at 1 um/s, and absent at 10 um/s. The paper prints no numbers:
    wavelengths and drops are assumptions, and so is the fading of the dry sawtooth above 0.1 mm/s.

    Parameters
    ----------
    surface, medium
        As for `friction_law`.

    Examples
    --------
    >>> stick_slip("Smooth", "dry").form, stick_slip("Sb-R", "dry").form
    ('sawtooth', 'none')
    """
    if xu2026.surface(surface).name != "Smooth":
        return StickSlip()
    if medium == "dry":
        return StickSlip("sawtooth", wavelength=22e-6, drop=0.18, fade_start=1e-4, fade_stop=1e-3)
    return StickSlip(
        "rounded",
        wavelength=40e-6,
        wavelength_exponent=0.4,
        drop=0.20,
        drop_exponent=1.1,
        fade_stop=1e-5,
    )
