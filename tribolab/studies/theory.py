"""Theoretical values for the reference system; slow calculations are cached."""

from __future__ import annotations

import functools
import re

import numpy as np

from tribolab.contact.adhesive_contact import adhesion, macroscopic_work_of_adhesion
from tribolab.contact.hertz import (
    hertz_half_width,
    hertz_max_pressure,
    hertz_mean_pressure,
    jkr_half_width,
)
from tribolab.contact.line import rough_line_contact
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.separation import separation_table
from tribolab.contact.work_of_adhesion import PDMS_PMMA_GLYCEROL, work_of_adhesion_spread
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.factors import flow_factors
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.modulus import PDMS_STAND_IN
from tribolab.studies import xu2026
from tribolab.studies.published import Published
from tribolab.surface.moments import rms_roughness, rms_slope

_LOAD = re.compile(r"([\d.]+) N/m")
_PRESSURE = re.compile(r"([\d.]+) MPa")
_WORK = re.compile(r"w = ([\d.]+) J/m2")
_OTHER_PRESSURE = 1e5  # Pa, pressure of Sec. 7


def _stated_number(pattern: re.Pattern[str], row: Published) -> float:
    """Return the number in the text of a row's condition that matches a pattern."""
    match = pattern.search(row.condition)
    if match is None:
        raise AnalysisError(
            f"published {row.quantity}: '{pattern.pattern}' is not in '{row.condition}'"
        )
    return float(match[1])


class Theory:
    """Theory of the reference system: Hertz, JKR, Persson, adhesion, rubber, lubrication.

    Methods take a row of the published numbers: its surface and condition select the value.
    """

    media = ("dry", "glycerol")

    def __init__(self) -> None:
        self._contact = xu2026.contact
        self._modulus = self._contact.effective_modulus
        loads = [force / self._contact.length for force in xu2026.system.loads]
        self._pressures = np.append(hertz_mean_pressure(loads, self._contact), _OTHER_PRESSURE)
        self._adhesive = functools.cache(self._adhesion)
        self._lines = functools.cache(self._line)
        self._slow = functools.cache(self._boundary)

    def load(self, row: Published) -> float:
        """Return the load [N/m] of a condition, even if the paper states a pressure instead."""
        if match := _LOAD.search(row.condition):
            return float(match[1])
        if match := _PRESSURE.search(row.condition):
            for other in xu2026.published:
                if other.quantity == "nominal_pressure" and float(other.text) == float(match[1]):
                    return self.load(other)
        raise AnalysisError(f"published {row.quantity}: no load in '{row.condition}'")

    def has_load(self, row: Published) -> bool:
        """Return whether the condition states a load, or a pressure that belongs to one."""
        try:
            return self.load(row) > 0
        except AnalysisError:
            return False

    def pressure(self, row: Published) -> float:
        """Return the mean Hertz pressure [Pa] of the load, or the pressure that is stated."""
        if not self.has_load(row):
            return 1e6 * _stated_number(_PRESSURE, row)
        return float(hertz_mean_pressure(self.load(row), self._contact))

    def medium(self, row: Published) -> str:
        """Return the medium of a condition with adhesion; "" for a condition without."""
        if "no adhesion" in row.condition:
            return ""
        return next((medium for medium in self.media if medium in row.condition), "")

    def hertz_half_width(self, row: Published) -> float:
        """Return the half-width [m] of the Hertz contact, Eq. (16)."""
        return float(hertz_half_width(self.load(row), self._contact))

    def hertz_max_pressure(self, row: Published) -> float:
        """Return the maximum Hertz pressure [Pa]."""
        return float(hertz_max_pressure(self.load(row), self._contact))

    def jkr_half_width(self, row: Published) -> float:
        """Return the JKR half-width [m], Eq. (15), with the condition's work of adhesion."""
        work = _stated_number(_WORK, row)
        return float(jkr_half_width(self.load(row), self._contact, work))

    def roughness(self, surface: str) -> float:
        """Return the root-mean-square roughness [m] of the stand-in spectrum."""
        return rms_roughness(xu2026.psd(surface))

    def slope(self, surface: str) -> float:
        """Return the root-mean-square slope [1] of the stand-in spectrum."""
        return rms_slope(xu2026.psd(surface))

    def area(self, row: Published) -> float:
        """Return the real contact area ratio A/A0 without adhesion."""
        return contact_area_ratio(self.pressure(row), xu2026.psd(row.surface), self._modulus)

    def work(self, medium: str) -> float:
        """Return the work of adhesion [J/m2], Eqs. (13) and (14)."""
        return PDMS_PMMA_GLYCEROL.dry if medium == "dry" else PDMS_PMMA_GLYCEROL.wet

    def work_bounds(self, medium: str) -> tuple[float, float]:
        """Return the smallest and largest work of adhesion [J/m2] for the surface energies."""
        spread = work_of_adhesion_spread(PDMS_PMMA_GLYCEROL, samples=2)
        mine = spread.sel(medium="dry" if medium == "dry" else "wet")
        return float(mine.work_of_adhesion_low), float(mine.work_of_adhesion_high)

    def adhesive_area(self, row: Published, medium: str) -> float:
        """Return the real contact area ratio A/A0 with adhesion."""
        areas, _ = self._adhesive(row.surface, medium)
        return float(areas[np.argmin(np.abs(self._pressures - self.pressure(row)))])

    def enhancement(self, surface: str, medium: str) -> list[float]:
        """Return the ratio of the contact area with adhesion to that without, at each load."""
        return self._adhesive(surface, medium)[1][:-1].tolist()

    def macroscopic_work(self, surface: str, medium: str) -> float:
        """Return the effective work of adhesion gamma_eff(1) [J/m2] at vanishing load."""
        work = self._published_work(medium)
        macroscopic = macroscopic_work_of_adhesion(xu2026.psd(surface), self._modulus, work)
        return float(macroscopic.macroscopic_work_of_adhesion)

    def viscoelastic_friction(self) -> dict[str, float]:
        """Return the maximum viscoelastic friction of each surface; complete contact for Smooth."""
        speeds = np.array(xu2026.SPEEDS)
        largest = {}
        for name in xu2026.surfaces:
            full = name == "Smooth"  # adhesion makes its contact almost complete (Sec. 6)
            friction = viscoelastic_friction(
                speeds, self._pressures[0], xu2026.psd(name), PDMS_STAND_IN, complete_contact=full
            )
            label = f"{name} (complete contact)" if full else name
            largest[label] = float(friction.friction_coefficient.max())
        return largest

    def line(self, row: Published) -> tuple[float, float]:
        """Return the maximum pressure [Pa] and width [m] of the dry rough line contact."""
        return self._lines(row.surface, self.load(row))

    def separation_decay(self, surface: str) -> float:
        """Return the constant alpha = h_rms/u0 of p ~ exp(-alpha u/h_rms)."""
        table = separation_table(xu2026.psd(surface), self._modulus)
        return table.rms_roughness / table.decay_length

    def flow_stops(self, level: float) -> list[float]:
        """Return, by surface, the mean separation in h_rms below which phi_p is below a level."""
        stops = []
        for name in xu2026.surfaces:
            factors = flow_factors(xu2026.psd(name))
            closed, height = factors.percolation_separation, factors.rms_roughness
            u = closed + height * np.geomspace(1e-4, 1.0, 2000)
            above = u[factors.at(u).phi_p > level]
            stops.append(float(above[0] if level > 0 else closed) / height)
        return stops

    def boundary_onset(self, row: Published, share: float) -> float:
        """Return the speed [m/s] at which friction is a given share of dry friction."""
        speed, friction = self._slow(row.surface, self.load(row))
        return float(np.exp(np.interp(-share, -friction, np.log(speed))))

    def _published_work(self, medium: str) -> float:
        """Return the work of adhesion [J/m2] as rounded and used in the paper."""
        return next(
            row.si
            for row in xu2026.published
            if row.quantity == "work_of_adhesion" and row.condition == medium
        )

    def _adhesion(self, surface: str, medium: str) -> tuple[np.ndarray, np.ndarray]:
        work = self._published_work(medium)
        contact = adhesion(self._pressures, xu2026.psd(surface), self._modulus, work)
        return contact.contact_area_ratio.values, contact.area_enhancement.values

    def _line(self, surface: str, load: float) -> tuple[float, float]:
        line = rough_line_contact(load, self._contact, xu2026.psd(surface))
        return float(line.max_pressure), float(line.contact_width)

    def _boundary(self, surface: str, load: float) -> tuple[np.ndarray, np.ndarray]:
        """Return low speeds [m/s], and the ratio of friction at these speeds to dry friction."""
        speed = np.append(0.0, np.geomspace(1e-11, 1e-6, 21))
        stress = dict(xu2026.surface(surface).shear_stress)[load * self._contact.length]
        eta = xu2026.system.viscosity
        curve = stribeck_curve(self._contact, xu2026.psd(surface), eta, load, stress, speed)
        friction = curve.friction_coefficient.values
        return speed[1:], friction[1:] / friction[0]
