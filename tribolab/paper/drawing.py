"""Figures of the reproduction, each with its numbers as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tribolab import plot
from tribolab.core.wording import force_text, number, span, speed_text, speeds
from tribolab.paper.data import ROUGH, SURFACES, PaperData
from tribolab.studies.tables import MEDIA, modulus_table
from tribolab.surface.moments import rms_roughness, rms_slope

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FigureAndText = tuple["Figure", str]  # the figure, and its content in words and numbers
_BOUNDARY = 1e-9  # m/s, lowest speed at which the theory for Smooth is drawn


def _listed(parts: Iterable[str]) -> str:
    return "; ".join(parts) + "."


def paper_spectra(data: PaperData) -> FigureAndText:
    """Draw the stand-ins for the power spectra of the paper's surfaces."""
    psds = data.dry("psd")
    text = _listed(
        f"{name}: h_rms {1e6 * rms_roughness(psd):.4g} µm, slope {rms_slope(psd):.3g}"
        for name, psd in psds.items()
    )
    return plot.spectra(psds, surfaces=SURFACES), text


def scanned_spectra(data: PaperData) -> FigureAndText:
    """Draw the power spectra computed from the simulated profiles."""
    psds = {name: data.read("spectrum", name, "psd") for name in SURFACES}
    text = _listed(
        f"{name}: h_rms {1e6 * rms_roughness(psd):.3g} µm from {int(psd.scans)} profiles"
        for name, psd in psds.items()
    )
    return plot.spectra(psds, surfaces=SURFACES), text


def paper_contact_area(data: PaperData) -> FigureAndText:
    """Draw the contact area ratio A/A0 against pressure, without adhesion."""
    loads = data.dry("loads")
    text = _listed(
        f"{name}: A/A0 {float(contact.contact_area_ratio_no_adhesion[0, 0]):.3g} at "
        f"{1e-6 * float(contact.pressure[0]):.3g} MPa"
        for name, contact in loads.items()
    )
    figure = plot.contact_area(data.dry("contact"), loads[SURFACES[0]], surfaces=SURFACES)
    return figure, text


def paper_effective_work(data: PaperData) -> FigureAndText:
    """Draw the effective work of adhesion gamma_eff/gamma_0 against magnification."""
    works = data.dry("effective_work")
    text = _listed(
        f"{name}: "
        + ", ".join(
            f"{medium} {_ends(work.effective_work_of_adhesion.sel(medium=medium) / MEDIA[medium])}"
            for medium in work.medium.values.tolist()
        )
        for name, work in works.items()
    )
    figure = plot.effective_work(works, relative_to=MEDIA, surfaces=SURFACES)
    return figure, f"From magnification 1 to the highest: {text}"


def _ends(line: xr.DataArray) -> str:
    return f"{float(line[0]):.3g} to {float(line[-1]):.3g}"


def paper_adhesive_area(data: PaperData) -> FigureAndText:
    """Draw the contact area ratio A/A0 against pressure, with adhesion."""
    loads = data.dry("loads")
    text = _listed(
        f"{name}: "
        + ", ".join(
            f"{medium} {float(contact.contact_area_ratio.sel(medium=medium)[0]):.3g}"
            for medium in contact.medium.values.tolist()
        )
        + f" at {1e-6 * float(contact.pressure[0]):.3g} MPa"
        for name, contact in loads.items()
    )
    contacts, adhesions = data.dry("contact"), data.dry("adhesion")
    figure = plot.adhesive_area(contacts, adhesions, loads[SURFACES[0]], surfaces=SURFACES)
    return figure, text


def _friction_of(curves: Iterable[xr.Dataset]) -> str:
    return _listed(
        f"{c.attrs['surface']}, {c.attrs['medium']}, {force_text(c.attrs['normal_force_N'])}: µ "
        f"from {span(c.friction_coefficient.values.tolist())} at "
        f"{speeds(c.sliding_speed.values.tolist())}"
        for c in curves
    )


def dry_friction(data: PaperData) -> FigureAndText:
    """Draw the dry friction coefficient against speed."""
    measured = [data.measured(name, "dry") for name in SURFACES]
    return plot.stribeck(measured, surfaces=SURFACES, errors="std"), _friction_of(measured)


def paper_modulus(data: PaperData) -> FigureAndText:
    """Draw the stand-in for the paper's rubber modulus."""
    table = modulus_table()
    ends = (f"{float(table.storage_modulus[end]):.3g} Pa" for end in (0, -1))
    return plot.modulus(table), f"Storage modulus from {' to '.join(ends)}."


def paper_viscoelastic(data: PaperData) -> FigureAndText:
    """Draw the viscoelastic friction coefficient against speed."""
    rubbers = data.dry("rubber")
    rubbers["Smooth (complete contact)"] = data.read("dry", "Smooth", "rubber_complete")
    text = _listed(
        f"{name}: µ at most {number(float(rubber.friction_coefficient.max()), 2)}"
        for name, rubber in rubbers.items()
    )
    return plot.viscoelastic(rubbers, surfaces=SURFACES), text


def dry_shear_stress(data: PaperData) -> FigureAndText:
    """Draw the dry shear stress sigma_f(v) = mu sigma_0 A_0/A from simulated friction."""
    stresses = {}
    for name in SURFACES:
        loads = data.read("dry", name, "loads").isel(load=0)
        factor = float(loads.pressure / loads.contact_area_ratio.sel(medium="dry"))
        mu = data.measured(name, "dry")
        stresses[name] = xr.Dataset(
            {
                "shear_stress": factor * mu.friction_coefficient,
                "shear_stress_std": factor * mu.friction_coefficient_std,
            }
        )
    means = {name: float(stress.shear_stress.mean()) for name, stress in stresses.items()}
    text = [f"{name}: {mean / 1e6:.3g} MPa on average" for name, mean in means.items()]
    text.append(f"Sb-R over Sb-S: {means['Sb-R'] / means['Sb-S']:.3g}")
    largest = max(
        float((known.shear_stress_std / known.shear_stress).max()) for known in stresses.values()
    )
    text.append(f"standard deviation at most {100 * largest:.2g} % of it")
    return plot.shear_stress_over_speed(stresses, surfaces=SURFACES), _listed(text)


def _traces(data: PaperData, wanted: list[tuple[str, str, float]]) -> FigureAndText:
    traces = [data.trace(*stroke) for stroke in wanted]
    text = []
    for trace in traces:
        if trace.friction is None:
            continue
        stroke = trace.friction.isel(segment=trace.segment)
        mean, spread = (float(stroke[f"friction_coefficient{end}"]) for end in ("", "_std"))
        text.append(f"{trace.label}: µ = {number(mean)} (standard deviation {number(spread, 2)})")
    ends = [
        float((row.trimmed_stop - row.trimmed_start) * row.sliding_speed)
        for row in (trace.segments.isel(segment=trace.segment) for trace in traces)
    ]
    return plot.slip_traces(traces, SURFACES, longest=min(ends)), _listed(text)


def dry_traces(data: PaperData) -> FigureAndText:
    """Draw dry friction traces of Smooth and Sb-R."""
    return _traces(data, [(n, "dry", v) for n in ("Sb-R", "Smooth") for v in (1e-6, 3e-6)])


def wet_traces(data: PaperData) -> FigureAndText:
    """Draw friction traces in glycerol."""
    wanted = [("Sb-R", "glycerol", 1e-6), *(("Smooth", "glycerol", v) for v in (1e-6, 3e-6))]
    return _traces(data, wanted)


def rough_dry_and_wet(data: PaperData) -> FigureAndText:
    """Draw friction traces of Sb-R, dry and in glycerol."""
    return _traces(data, [("Sb-R", "glycerol", 1e-6), ("Sb-R", "dry", 1e-6)])


def smooth_dry_and_wet(data: PaperData) -> FigureAndText:
    """Draw friction traces of Smooth, dry and in glycerol, and of Sb-R in glycerol."""
    wanted = [("Sb-R", "glycerol"), ("Smooth", "glycerol"), ("Smooth", "dry")]
    return _traces(data, [(*stroke, 1e-6) for stroke in wanted])


def both_rough(data: PaperData) -> FigureAndText:
    """Draw the Stribeck curves of both rough surfaces at the lowest load, with dry friction."""
    force = data.forces[0]
    measured = [data.measured(name, medium) for name in ROUGH for medium in ("glycerol", "dry")]
    models = [data.model(name, force) for name in ROUGH]
    return plot.stribeck(measured, models, surfaces=SURFACES, errors="std"), _friction_of(measured)


def all_loads(data: PaperData, name: str) -> FigureAndText:
    """Draw the Stribeck curves of a surface at all loads."""
    measured = [data.measured(name, "glycerol", force) for force in data.forces]
    models = [data.model(name, force) for force in data.forces]
    off = [
        float(np.abs(m.friction_coefficient / _model_at(model, m) - 1).max())
        for m, model in zip(measured, models, strict=True)
    ]
    worst = f" Points and lines part by at most {100 * max(off):.2g} %."
    return plot.stribeck(measured, models, surfaces=SURFACES, errors="std"), _friction_of(
        measured
    ) + worst


def _model_at(model: xr.Dataset, points: xr.Dataset) -> np.ndarray:
    v = np.log(points.sliding_speed.values)
    return np.interp(v, np.log(model.sliding_speed.values), model.friction_coefficient.values)


def paper_shear_stress(data: PaperData) -> FigureAndText:
    """Draw the shear stress sigma_f against load, as fitted and corrected for adhesion."""
    text = _listed(
        f"{fit['surface']}, {force_text(fit['normal_force_N'])}: "
        f"{fit['shear_stress_Pa'] / 1e6:.3g} MPa, "
        f"in the adhesive area {fit['corrected_shear_stress_Pa'] / 1e6:.3g} MPa"
        for fit in data.fits.to_dict("records")
    )
    return plot.shear_stress(data.fits, surfaces=SURFACES), text


def smooth_and_theory(data: PaperData) -> FigureAndText:
    """Draw the Stribeck curves of Smooth at all loads, and the theory at the lowest load."""
    measured = [data.measured("Smooth", "glycerol", force) for force in data.forces]
    force = data.forces[0]
    model = data.read("wet", "Smooth", f"curve_{force:g}N")
    v = model["sliding_speed"]
    model = model.isel(sliding_speed=np.flatnonzero((v >= _BOUNDARY) & (v < 3e-2)))
    highest = float(model.friction_coefficient.max())
    text = f" The theory reaches µ = {highest:.3g} at {speed_text(float(v.min()))}."
    return plot.stribeck(measured, model, surfaces=SURFACES, errors="std"), _friction_of(
        measured
    ) + text


def separation(data: PaperData) -> FigureAndText:
    """Draw the contact pressure against the mean separation."""
    tables = data.dry("separation")
    text = _listed(
        f"{name}: falls by a factor e in "
        f"{d.attrs['decay_length_m'] / d.attrs['rms_roughness_m']:.3g} h_rms = "
        f"{1e6 * d.attrs['decay_length_m']:.3g} µm"
        for name, d in tables.items()
    )
    return plot.contact_separation(tables, surfaces=SURFACES), text


def factors(data: PaperData) -> FigureAndText:
    """Draw the flow and friction factors against the mean separation."""
    factors = {name: data.read("wet", name, "factors") for name in SURFACES}
    closed = [
        d.attrs["percolation_separation_m"] / d.attrs["rms_roughness_m"] for d in factors.values()
    ]
    text = f"Flow stops at a mean separation of {span(closed)} h_rms."
    return plot.lubrication_factors(factors, surfaces=SURFACES), text


def paper_friction_factor_effect(data: PaperData) -> FigureAndText:
    """Draw friction against speed at the highest load, with and without friction factors."""
    force = data.forces[-1]
    pairs = {name: data.model(name, force) for name in ROUGH}
    text = _listed(
        f"{name}, {force_text(force)}: they raise µ by at most {_largest_rise(curve)}"
        for name, curve in pairs.items()
    )
    return plot.friction_factor_effect(pairs, scale="linear", surfaces=SURFACES), text


def _largest_rise(curve: xr.Dataset) -> str:
    rise = curve.friction_coefficient - curve.friction_without_factors
    at = int(rise.values.argmax())
    part = float(rise[at] / curve.friction_without_factors[at])
    v = speed_text(float(f"{float(curve.sliding_speed[at]):.3g}"))
    return f"{float(rise[at]):.2g}, {100 * part:.2g} % at {v}"


def profiles(data: PaperData, name: str) -> FigureAndText:
    """Draw film and pressure profiles across the contact of a surface."""
    across = data.read("wet", name, "profiles")
    text = _listed(
        f"{speed_text(float(v))}: smallest separation "
        f"{1e6 * float(across.separation.sel(sliding_speed=v).min()):.3g} µm, "
        f"pressures of contact and fluid at most "
        + " and ".join(
            f"{1e-6 * float(across[key].sel(sliding_speed=v).max()):.3g}"
            for key in ("contact_pressure", "fluid_pressure")
        )
        + " MPa"
        for v in across.sliding_speed.values
    )
    return plot.film_profiles(across), text


def bars(data: PaperData, name: str) -> FigureAndText:
    """Draw the friction of a surface in glycerol at all loads, with error bars."""
    measured = [data.measured(name, "glycerol", force) for force in data.forces]
    smallest, largest = (
        end(float(end(c.friction_coefficient_std.values)) for c in measured) for end in (min, max)
    )
    text = f" Standard deviation from {smallest:.2g} to {largest:.2g}."
    return plot.friction_spread(measured, surfaces=SURFACES), _friction_of(measured) + text
