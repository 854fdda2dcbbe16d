"""Theoretical results for the reference system at its pressures, speeds and loads."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.studies import xu2026
from tribolab.units.stamping import labelled, stamp

SurfaceGroups = dict[str, xr.Dataset]
# Work of adhesion [J/m2] by medium, as rounded and used in the paper.
MEDIA = {row.condition: row.si for row in xu2026.published if row.quantity == "work_of_adhesion"}
_PROFILE_SPEEDS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # m/s, speeds of the profiles in App. B
_PRESSURES = np.geomspace(1e-3, 1.0, 46) * 1e6  # Pa
# m/s, rounded so that speeds which differ only by rounding appear once
_SPEEDS = np.unique([*(float(f"{v:.3g}") for v in np.geomspace(1e-9, 1e-1, 33)), *xu2026.SPEEDS])
_SEPARATIONS = np.geomspace(0.1, 6.0, 120)  # in units of h_rms
_MAX_PRESSED = 0.3  # largest pressure that is shown, as a share of E*


def dry_contact(name: str) -> SurfaceGroups:
    """Return contact, adhesion and rubber friction of a surface without a liquid.

    Parameters
    ----------
    name
        Name of the surface.

    Returns
    -------
    dict
        ``psd``; ``contact`` and ``adhesion`` (medium) over pressure; ``effective_work`` (medium,
        wavenumber) as the pressure vanishes; ``loads``, the Hertz contact at the paper's loads,
        with the areas there; ``rubber`` at the lowest load, for Smooth also ``rubber_complete``.

    Examples
    --------
    >>> sorted(dry_contact("Sb-R"))
    ['adhesion', 'contact', 'effective_work', 'loads', 'psd', 'rubber', 'separation']
    """
    # imported late for a quick start
    from tribolab.contact.persson import contact_area_ratio
    from tribolab.contact.separation import separation_table
    from tribolab.rubber.friction import viscoelastic_friction
    from tribolab.rubber.modulus import PDMS_STAND_IN

    psd, modulus = xu2026.psd(name), xu2026.contact.effective_modulus
    pressure = labelled(_PRESSURES, "pressure")
    area = contact_area_ratio(pressure, psd, modulus)
    adhesive, work, loads = _adhesion(psd, modulus)
    table = separation_table(psd, modulus)
    height = table.rms_roughness
    apart = labelled(_SEPARATIONS * height, "separation")
    pressed = table.pressure(apart)
    lowest = float(loads.pressure[0])
    speed = np.geomspace(1e-7, xu2026.system.highest_speed, 31)
    groups = {
        "psd": psd,
        "contact": stamp(xr.Dataset({"contact_area_ratio": area})),
        "adhesion": adhesive,
        "effective_work": work,
        "loads": loads,
        "separation": stamp(
            xr.Dataset({"contact_pressure": pressed}).where(
                pressed < _MAX_PRESSED * modulus, drop=True
            ),
            rms_roughness_m=height,
            decay_length_m=table.decay_length,
        ),
        "rubber": viscoelastic_friction(speed, lowest, psd, PDMS_STAND_IN),
    }
    if name == "Smooth":  # adhesion makes its contact almost complete (Sec. 6)
        groups["rubber_complete"] = viscoelastic_friction(
            speed, lowest, psd, PDMS_STAND_IN, complete_contact=True
        )
    return groups


def _adhesion(psd: xr.Dataset, modulus: float) -> tuple[xr.Dataset, xr.Dataset, xr.Dataset]:
    """Return adhesion on a grid of pressures, at zero pressure and at the loads."""
    # imported late for a quick start
    from tribolab.contact.adhesive_contact import adhesion
    from tribolab.contact.hertz import hertz_mean_pressure

    forces = np.array(xu2026.system.loads)
    at_loads = hertz_mean_pressure(forces / xu2026.contact.length, xu2026.contact)
    pressures = np.concatenate([[0.0], at_loads, _PRESSURES])
    over, rest, loaded = [], [], []
    names = ["contact_area_ratio", "contact_area_ratio_no_adhesion", "area_enhancement"]
    for gamma in MEDIA.values():
        contact = adhesion(pressures, psd, modulus, gamma)
        over.append(contact[names].isel(pressure=slice(1 + forces.size, None)))
        rest.append(contact[["effective_work_of_adhesion"]].isel(pressure=0, drop=True))
        loaded.append(contact[names].isel(pressure=slice(1, 1 + forces.size)))
    media = xr.DataArray(list(MEDIA), dims="medium", name="medium")
    parts = [
        xr.concat(both, media, combine_attrs="drop_conflicts") for both in (over, rest, loaded)
    ]
    # the dim is renamed from pressure to load, so that results are by load
    loads = parts[2].rename(pressure="load").assign_coords(load=forces / xu2026.contact.length)
    loads = loads.assign(pressure=("load", at_loads), normal_force=("load", forces))
    return stamp(parts[0]), stamp(parts[1]), stamp(loads)


def modulus_table() -> xr.Dataset:
    """Return storage and loss modulus of the stand-in for the paper's rubber, by frequency."""
    # imported late for a quick start
    from tribolab.rubber.modulus import PDMS_STAND_IN

    omega = np.geomspace(1e-2, 1e13, 226)
    value = PDMS_STAND_IN(omega)
    parts = {"storage_modulus": value.real, "loss_modulus": value.imag}
    over = {key: ("angular_frequency", part) for key, part in parts.items()}
    return stamp(xr.Dataset(over, {"angular_frequency": omega}))


def lubricated(name: str, forces: tuple[float, ...] = xu2026.system.loads) -> SurfaceGroups:
    """Return the mixed lubrication of a surface in glycerol.

    Parameters
    ----------
    name
        Name of the surface.
    forces
        Normal forces [N], from low to high.

    Returns
    -------
    dict
        ``curve_<force>N`` over the sliding speed, with the shear stress that the paper fitted
        at that force (for Smooth, that of the lowest force); ``profiles`` at the lowest force;
        ``factors``.
    """
    # imported late for a quick start
    from tribolab.lubrication.factors import flow_factors
    from tribolab.lubrication.stribeck import stribeck_curve

    psd, eta = xu2026.psd(name), xu2026.system.viscosity
    stresses = dict(xu2026.surface(name).shear_stress)
    groups = {}
    for force in forces:
        stress = stresses.get(force, stresses[min(stresses)])
        load = xu2026.contact.load(force)
        curve = stribeck_curve(xu2026.contact, psd, eta, load, stress, _SPEEDS)
        groups[f"curve_{force:g}N"] = curve.assign_attrs(
            surface=name, medium="glycerol", normal_force_N=force
        )
    if name != "Smooth":  # the paper shows no profiles of Smooth
        groups["profiles"] = _profiles(psd, xu2026.contact.load(min(forces)))
    factors = flow_factors(psd)
    groups["factors"] = factors.dataset(_SEPARATIONS * factors.rms_roughness)
    return groups


def _profiles(psd: xr.Dataset, load: float) -> xr.Dataset:
    # imported late for a quick start
    from tribolab.lubrication.film import film_profile

    profiles = [
        film_profile(xu2026.contact, psd, xu2026.system.viscosity, load, v)
        .reset_index("x")
        .reset_coords("x")
        .rename_dims(x="point")
        for v in _PROFILE_SPEEDS
    ]
    return stamp(xr.concat(profiles, "sliding_speed", combine_attrs="drop_conflicts"))
