"""Contact, adhesion and rubber friction of one surface, as far as the campaign file allows."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from tribolab.campaign.surfaces.rubber import rubber_groups, rubber_objection
from tribolab.contact.adhesive_contact import adhesion_by_works
from tribolab.contact.gap import gap_distribution
from tribolab.contact.geometry import Contact, PointContact, make_contact
from tribolab.contact.hertz import (
    hertz_half_width,
    hertz_max_pressure,
    hertz_mean_pressure,
    jkr_half_width,
)
from tribolab.contact.limits import line_limits
from tribolab.contact.line import rough_line_contact
from tribolab.contact.persson import contact_area_ratio, mean_separation
from tribolab.contact.point import across_the_middle, rough_point_contact
from tribolab.core.errors import ReadError, TribolabError
from tribolab.core.validity import together
from tribolab.core.wording import explain
from tribolab.records.parts import Finding, limit_findings
from tribolab.units.stamping import labelled, stamp

if TYPE_CHECKING:
    from tribolab.campaign.surfaces.plan import PlannedSurface
    from tribolab.contact.area import AreaTheory

Groups = dict[str, xr.Dataset]
_PER_DECADE = 10
_ENDINGS = ("", "_low", "_high")


def contact_of(surface: PlannedSurface) -> Contact | None:
    """Return the contact, if the campaign file defines it completely."""
    known = all(value is not None for value in surface.contact.values())
    return make_contact(**surface.contact) if known else None


def lowest_wavenumber(surface: PlannedSurface) -> float | None:
    """Return q0 = pi / (width of the Hertz contact at the lowest load) [1/m], if known."""
    contact = contact_of(surface)
    if contact is None or surface.lowest_force is None:
        return None
    return float(np.pi / (2 * hertz_half_width(contact.load(surface.lowest_force), contact)))


def contact_groups(surface: PlannedSurface, psd: xr.Dataset) -> tuple[Groups, list[Finding]]:
    """Compute contact, adhesion and rubber friction, as far as their inputs are known.

    Parameters
    ----------
    surface
        The surface in the campaign file.
    psd
        Extrapolated spectrum with its band.

    Returns
    -------
    tuple
        ``contact`` over pressure; over the loads ``loads`` (Hertz), ``line`` (dry, rough), ``gap``;
        ``adhesion`` over media and pressure, ``adhesion_loads``; ``rubber`` and ``modulus``; and
        findings on what is missing or failed.
    """
    groups: Groups = {}
    findings: list[Finding] = []
    known = surface.contact
    if known["youngs_modulus"] is None or known["poisson_ratio"] is None:
        text = (
            "contact, adhesion and rubber friction are not computed: [contact] wants "
            "youngs_modulus and poisson_ratio"
        )
        return groups, [Finding("note", text)]
    modulus = known["youngs_modulus"] / (1 - known["poisson_ratio"] ** 2)
    if contact := contact_of(surface):
        modulus = contact.effective_modulus
    grid = modulus * np.geomspace(5e-4, 0.5, 3 * _PER_DECADE + 1)
    forces = np.array(surface.forces)

    def attempt(
        what: str, names: tuple[str, ...], compute: Callable[[], tuple[xr.Dataset, ...]]
    ) -> None:
        try:
            groups.update(zip(names, compute(), strict=True))
        except Exception as error:  # recorded: the other parts are kept in the results
            severity = "suspect" if isinstance(error, TribolabError) else "error"
            if isinstance(error, ReadError):  # a file named in the campaign
                severity = "fail"
            findings.append(Finding(severity, f"{what}: {explain(error)[0]}"))

    attempt("contact", ("contact",), lambda: (_contact(grid, psd, modulus, surface.area),))
    if contact is None or not forces.size:
        missing = "radius and length in [contact]" if contact is None else "normal_force of a run"
        text = f"line contact, gap and rubber friction at the loads are not computed: no {missing}"
        findings.append(Finding("note", text))
        loads = None
    else:
        theory = surface.area
        loads = _loads(forces, contact, psd, theory)
        groups["loads"] = loads
        attempt("dry line contact", ("line",), lambda: (_lines(forces, contact, psd, theory),))
        attempt("gap", ("gap",), lambda: (_gaps(loads, psd, modulus),))
        if refused := rubber_objection(surface):
            findings.append(refused)
        else:
            names = ("rubber", "modulus")
            attempt("rubber friction", names, lambda: rubber_groups(surface, loads, psd, findings))
    if not surface.media:
        text = "adhesion is not computed: no [medium.*] has a positive work_of_adhesion"
        findings.append(Finding("note", text))
    else:
        names = ("adhesion", "adhesion_loads")
        attempt("adhesion", names, lambda: _adhesion(surface, grid, loads, contact, psd, modulus))
        if "adhesion_loads" in groups:
            findings += _undecided_pull_off(groups["adhesion_loads"])
    return groups, findings + limit_findings(groups)


def _bounds(psd: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the spectrum, and the spectra for the lower and upper bound of the contact area."""
    ends = {"": "", "_low": "_high", "_high": "_low"}  # more roughness, less contact
    return {
        ending: psd[["psd_2d"]].assign(psd_2d=psd[f"psd_2d{other}"])
        for ending, other in ends.items()
    }


def _areas(
    pressure: xr.DataArray, psd: xr.Dataset, modulus: float, theory: AreaTheory
) -> dict[str, xr.DataArray]:
    return {
        f"contact_area_ratio{ending}": contact_area_ratio(pressure, spectrum, modulus, theory)
        for ending, spectrum in _bounds(psd).items()
    }


def _contact(grid: np.ndarray, psd: xr.Dataset, modulus: float, theory: AreaTheory) -> xr.Dataset:
    pressure = labelled(grid, "pressure")
    data = _areas(pressure, psd, modulus, theory)
    data["separation"] = mean_separation(pressure, psd, modulus)
    valid = data["contact_area_ratio"].attrs
    return stamp(xr.Dataset(data), effective_modulus_Pa=modulus, area=theory, **together([valid]))


def _loads(forces: np.ndarray, contact: Contact, psd: xr.Dataset, theory: AreaTheory) -> xr.Dataset:
    """Return the Hertz contact at each load, and the rough contact at its mean pressure."""
    load = np.array([contact.load(float(force)) for force in forces])
    coords = {"load": load}

    def over_load(values: np.ndarray | float) -> xr.DataArray:
        return xr.DataArray(values, coords, ["load"])

    pressure = over_load(hertz_mean_pressure(load, contact))
    modulus = contact.effective_modulus
    data = {
        "normal_force": over_load(forces),
        "pressure": pressure,
        "max_pressure": over_load(hertz_max_pressure(load, contact)),
        "contact_width": over_load(2 * hertz_half_width(load, contact)),
        **_areas(pressure, psd, modulus, theory),
        "separation": mean_separation(pressure, psd, modulus),
    }
    valid = line_limits("line contact", contact, load, psd)
    return stamp(xr.Dataset(data), effective_modulus_Pa=modulus, **valid)


def _lines(forces: np.ndarray, contact: Contact, psd: xr.Dataset, theory: AreaTheory) -> xr.Dataset:
    """Return the dry rough line contact at each load, each with its own x."""
    parts = []
    for force in forces:
        load = contact.load(float(force))
        if isinstance(contact, PointContact):
            line = across_the_middle(rough_point_contact(load, contact, psd, area=theory))
        else:
            line = rough_line_contact(load, contact, psd, area=theory)
        parts.append(line.reset_index("x").reset_coords("x").rename_dims(x="point"))
    lines = xr.concat(parts, "load", combine_attrs="drop_conflicts")
    valid = together([line.attrs for line in parts])
    return stamp(lines.assign(normal_force=("load", forces)), **valid)


def _gaps(loads: xr.Dataset, psd: xr.Dataset, modulus: float) -> xr.Dataset:
    gaps = gap_distribution(loads.pressure, psd, modulus)
    return gaps.assign(normal_force=loads.normal_force)


def _adhesion(
    surface: PlannedSurface,
    grid: np.ndarray,
    loads: xr.Dataset | None,
    contact: Contact | None,
    psd: xr.Dataset,
    modulus: float,
) -> tuple[xr.Dataset, xr.Dataset]:
    """Solve adhesion in each medium: at zero pressure, at the loads, and on the pressure grid."""
    at_loads = np.array([]) if loads is None else loads.pressure.values
    pressures = np.concatenate([[0.0], at_loads, grid])
    # a band is smooth, so a third of the grid is enough
    bounding = np.concatenate([[0.0], at_loads, grid[::3]])
    spectra = _bounds(psd)
    works = {"": [medium.work_of_adhesion for medium in surface.media]}
    works |= {"_low": [max(medium.low, 0.0) for medium in surface.media]}
    works |= {"_high": [max(medium.high, 0.0) for medium in surface.media]}
    middle = adhesion_by_works(pressures, psd, modulus, works[""], surface.area)
    # a ratio may be extreme where the areas are not: combine each work with both spectra
    both = [*works["_low"], *works["_high"]]
    ends = {
        ending: adhesion_by_works(bounding, spectra[ending], modulus, both, surface.area)
        for ending in _ENDINGS[1:]
    }
    curves, points, valid = [], [], []
    for place, medium in enumerate(surface.media):
        solved = middle[place]
        valid.append(solved.attrs)
        curve = solved.isel(pressure=slice(1 + at_loads.size, None))
        curve = curve[["contact_area_ratio", "area_enhancement"]]
        rest, under_load = (
            solved.isel(pressure=0),
            solved.isel(pressure=slice(1, 1 + at_loads.size)),
        )
        point = under_load[
            [
                "contact_area_ratio",
                "contact_area_ratio_no_adhesion",
                "area_enhancement",
                "apparent_contact_area_ratio",
            ]
        ].rename(pressure="load")
        point["effective_work_of_adhesion"] = (
            "wavenumber",
            rest.effective_work_of_adhesion.values,
        )
        macroscopic = float(rest.effective_work_of_adhesion[0])
        point["work_of_adhesion"] = medium.work_of_adhesion
        point["macroscopic_work_of_adhesion"] = macroscopic
        point["pull_off"] = np.int8(macroscopic > 0)
        growth = [point["area_enhancement"].values]
        for ending, work in (("_low", medium.low), ("_high", medium.high)):
            other = "_low" if ending == "_high" else "_high"
            of_work = place + (ending == "_high") * len(surface.media)
            bound = ends[ending][of_work]
            for on_spectrum in (bound, ends[other][of_work]):
                growth.append(on_spectrum.area_enhancement.values[1 : 1 + at_loads.size])
            areas = bound.contact_area_ratio.values
            through = PchipInterpolator(np.log(grid[::3]), np.log(areas[1 + at_loads.size :]))
            outer = np.minimum if ending == "_low" else np.maximum
            edge = outer(np.exp(through(np.log(grid))), curve.contact_area_ratio.values)
            curve[f"contact_area_ratio{ending}"] = ("pressure", edge)
            point[f"work_of_adhesion{ending}"] = work
            point[f"contact_area_ratio{ending}"] = ("load", areas[1 : 1 + at_loads.size])
            at_rest = float(bound.effective_work_of_adhesion[0, 0])
            point[f"macroscopic_work_of_adhesion{ending}"] = at_rest
        for ending, outermost in (("_low", np.min), ("_high", np.max)):
            point[f"area_enhancement{ending}"] = ("load", outermost(growth, axis=0))
        curves.append(curve)
        if loads is not None and contact is not None:
            point = point.assign_coords(load=loads["load"]).drop_vars("pressure", errors="ignore")
            half = jkr_half_width(loads["load"].values, contact, macroscopic)
            point["contact_width"] = ("load", 2 * half)
            point["normal_force"] = loads.normal_force
            point["pressure"] = loads.pressure
        points.append(point)
    names = xr.DataArray([medium.name for medium in surface.media], dims="medium", name="medium")
    joined = [xr.concat(parts, names, combine_attrs="drop_conflicts") for parts in (curves, points)]
    limits = together(valid)
    return stamp(joined[0], **limits), stamp(joined[1], **limits)


def _undecided_pull_off(points: xr.Dataset) -> list[Finding]:
    """Return a finding for each medium in which the bounds disagree on a pull-off force."""
    low, high = (
        points[f"macroscopic_work_of_adhesion{ending}"].values > 0 for ending in _ENDINGS[1:]
    )
    return [
        Finding(
            "note",
            f"{medium}: whether there is a pull-off force is not decided within the bounds of "
            "spectrum and work of adhesion",
        )
        for medium, undecided in zip(points.medium.values, low != high, strict=True)
        if undecided
    ]
