"""Hysteresis friction of the rubber on one surface, with the modulus of the campaign file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.wording import number
from tribolab.records.parts import Finding
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.modulus import PDMS_STAND_IN, TabulatedModulus, read_modulus
from tribolab.rubber.prony import PronySeries
from tribolab.rubber.temperature import Shiftable, WilliamsLandelFerry, modulus_at
from tribolab.units.stamping import stamp

if TYPE_CHECKING:
    from tribolab.campaign.surfaces.plan import PlannedSurface
    from tribolab.core.untyped import Arguments

_STIFFEST_RUBBER = 20e6  # Pa; stiffer bodies are not rubber, so the stand-in modulus does not apply
_SAME_RUBBER = 2.0  # largest ratio of low-frequency modulus to youngs_modulus for one rubber
_PER_DECADE = 10
_BEYOND = 1e2  # factor by which the shown frequencies exceed the relaxation rates
_ICE = 273.15  # K at 0 °C


class _Rubber(NamedTuple):
    """Modulus, its source in words, and the angular frequencies [rad/s] for display."""

    modulus: Shiftable
    origin: str
    omega: np.ndarray


def rubber_objection(surface: PlannedSurface) -> Finding | None:
    """Return the reason why the friction of the rubber is not computed; None if it is."""
    stiffness = surface.contact["youngs_modulus"]
    known = surface.modulus_file is not None or surface.rubber.get("prony_moduli")
    if known or stiffness <= _STIFFEST_RUBBER:
        return None
    text = (
        f"rubber friction is not computed: {stiffness / 1e6:.3g} MPa is no rubber; name its "
        "modulus_file in [contact] if it is viscoelastic"
    )
    return Finding("note", text)


def rubber_groups(
    surface: PlannedSurface, loads: xr.Dataset, psd: xr.Dataset, findings: list[Finding]
) -> tuple[xr.Dataset, xr.Dataset]:
    """Return the friction of the rubber at the loads and speeds, and its modulus by frequency.

    Parameters
    ----------
    surface
        The surface in the campaign file.
    loads
        Hertz contact at each load.
    psd
        Extrapolated spectrum.
    findings
        Extended by findings on the modulus.

    Raises
    ------
    TribolabError
        If the modulus cannot be read or shifted, or does not cover the relevant frequencies.
    """
    rubber = _modulus(surface, findings)
    if surface.rubber.get("temperature") is not None:
        rubber = _shift_modulus(rubber, surface.rubber)
    speed = np.geomspace(1e-7, 1e-1, 6 * _PER_DECADE + 1)
    friction = viscoelastic_friction(
        speed,
        loads.pressure,
        psd,
        rubber.modulus,
        surface.contact["poisson_ratio"],
        work_of_adhesion=surface.rubber_work,
        area=surface.area,
    )
    origin = rubber.origin
    if surface.rubber_work is not None:
        work = number(1e3 * surface.rubber_work)
        origin += f"; contact with adhesion, {work} mJ/m²"
    value = rubber.modulus(rubber.omega)
    over_frequency = xr.Dataset(
        {
            "storage_modulus": ("angular_frequency", value.real),
            "loss_modulus": ("angular_frequency", value.imag),
        },
        {"angular_frequency": rubber.omega},
    )
    friction = friction.assign(normal_force=loads.normal_force)
    return friction.assign_attrs(modulus=origin), stamp(over_frequency, modulus=origin)


def _modulus(surface: PlannedSurface, findings: list[Finding]) -> _Rubber:
    """Return the modulus from a file, a Prony series, or else a stand-in for a rubber."""
    stiffness = surface.contact["youngs_modulus"]
    if surface.modulus_file is not None:
        path, label = surface.modulus_file
        sweep, unit = surface.modulus_read
        table = read_modulus(path, sweep, unit=unit)
        findings.extend(Finding("note", f"{label}: {remark}") for remark in table.remarks)
        omega = table.angular_frequency
        findings.extend(_modulus_mismatch(stiffness, float(table(omega[0]).real), omega[0], label))
        return _Rubber(table, label, omega)
    if moduli := surface.rubber.get("prony_moduli"):
        times = surface.rubber["prony_times"]
        ends = 1 / (_BEYOND * max(times)), _BEYOND / min(times)
        count = int(np.ceil(_PER_DECADE * np.log10(ends[1] / ends[0]))) + 1
        relaxations = "1 relaxation" if len(moduli) == 1 else f"{len(moduli)} relaxations"
        return _Rubber(
            PronySeries(stiffness, np.array(moduli), np.array(times)),
            f"Prony series of {relaxations}, {stiffness / 1e6:g} MPa at rest",
            np.geomspace(*ends, count),
        )
    text = (
        "rubber friction is computed with the modulus of a typical PDMS, so it is only an order "
        "of magnitude"
    )
    findings.append(Finding("note", text))
    network = replace(PDMS_STAND_IN, relaxed=stiffness)
    return _Rubber(
        network,
        f"Typical PDMS network, for orders of magnitude only: {stiffness / 1e6:g} MPa at "
        f"rest, {network.unrelaxed / 1e9:g} GPa as a glass, fractional Zener with tau = "
        f"{network.relaxation_time:g} s and exponent {network.exponent:g}",
        np.geomspace(1e-2, 1e13, 15 * _PER_DECADE + 1),
    )


def _shift_modulus(rubber: _Rubber, stated: Arguments) -> _Rubber:
    """Shift a modulus from its temperature to that of the rubber."""
    law = WilliamsLandelFerry(stated["c1"], stated["c2"], stated["reference_temperature"])
    kelvin = stated["temperature"]
    modulus = modulus_at(rubber.modulus, kelvin, law)
    omega = rubber.omega / law.shift_factor(kelvin)
    if isinstance(modulus, TabulatedModulus):
        omega = modulus.angular_frequency
    before, after = (number(value - _ICE, 3) for value in (law.reference_temperature, kelvin))
    return _Rubber(modulus, f"{rubber.origin}, shifted from {before} to {after} °C", omega)


def _modulus_mismatch(stiffness: float, slow: float, frequency: float, label: str) -> list[Finding]:
    """Return a finding if a measured modulus does not match youngs_modulus of the contact."""
    if 1 / _SAME_RUBBER <= slow / stiffness <= _SAME_RUBBER:
        return []
    text = (
        f"rubber friction is computed with a modulus of {slow / 1e6:.3g} MPa at {frequency:.3g} "
        f"rad/s ({label}), the contact with youngs_modulus = {stiffness / 1e6:.3g} MPa: are both "
        "of the same rubber, and in the same units?"
    )
    return [Finding("note", text)]
