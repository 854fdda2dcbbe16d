"""Uncertainty of a computed Stribeck curve; unknown inputs are varied one at a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.arrays.threads import one_thread
from tribolab.contact.geometry import Contact
from tribolab.contact.persson import rough_band
from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import reasons_of, together
from tribolab.fit import limits
from tribolab.fit.left_out import describe_effects, effects_not_modelled
from tribolab.fit.unknowns import Range, Unknowns, merge_old_options
from tribolab.fit.variation import Base, Changed, Skipped, Variation
from tribolab.fit.variations import fixed_parameters, variations
from tribolab.lubrication.parameters import (
    Interface,
    Liquid,
    Parameters,
    Solver,
    parameters_of,
    renamed,
    warn_of_old,
)
from tribolab.lubrication.solved_curve import SolvedCurve, solve_curve
from tribolab.units.conversion import positive, to_si
from tribolab.units.stamping import labelled, stamp

_DEFAULT_SPEEDS = tuple(np.geomspace(1e-9, 1e-1, 17).tolist())  # m/s
_PARTS = ("friction_coefficient_couette", "friction_coefficient_pressure")


@renamed(viscosity="liquid", shear_stress="interface")
def model_uncertainty(
    contact: Contact,
    psd: xr.Dataset | None,
    liquid: Liquid | str | float,
    load: str | float,
    interface: Interface | str | float,
    speed: str | ArrayLike | None = None,
    solver: Solver | None = None,
    unknowns: Unknowns | None = None,
    *,
    refit: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Return an uncertainty band of a computed Stribeck curve, and the effect of each unknown.

    Parameters
    ----------
    contact, psd, liquid, load, interface, solver
        As for `stribeck_curve`, with one load. ``psd_2d_low``, ``psd_2d_high`` and ``origin`` of
        the spectrum are used if available.
    speed
        Sliding speeds [m/s] (sliding_speed), above zero; by default 17 from 1 nm/s to 0.1 m/s. With
        a slide-roll ratio they are the speeds named by `Interface.abscissa`.
    unknowns
        `Unknowns`; None treats the given inputs as exact, but a vented outlet as possibly flooded.
    refit
        Whether sigma_f of each varied curve is refitted to the given curve, as for a model whose
        sigma_f was fitted to a measured curve.
    **options
        Single fields of `Liquid`, `Interface`, `Solver` and `Unknowns`: arguments of the last
        release.

    Returns
    -------
    xarray.Dataset
        ``friction_coefficient`` with ``_low`` and ``_high`` over ``sliding_speed``. Over
        ``variation`` (name of the unknown): ``variation_low``, ``variation_high`` (ends of the
        range as text; empty for a one-sided range), ``variation_reason``; ``largest_change`` [1],
        the largest change of mu relative to the maximum of the curve, at ``largest_change_speed``
        [m/s]; ``largest_relative_change`` [1] of mu at one speed, at
        ``largest_relative_change_speed``; ``shear_stress_change_low``, ``shear_stress_change_high``
        [1], relative change of sigma_f with which each end fits the given curve. The curves
        themselves are ``friction_coefficient_varied`` (variation, range_end, sliding_speed), NaN
        for a missing end. The attribute ``not_varied`` lists unknowns that were not varied, with
        reasons, ``not_in_model`` neglected effects with their size; ``validity`` and
        ``validity_reasons`` also name variations beyond the theory's limits.

    Raises
    ------
    UnitError, AnalysisError
        As for `stribeck_curve`, also if a varied model cannot be solved.

    Notes
    -----
    Each range has roughly 95 % coverage; that of percolation is wider than in numerical studies of
    isotropic surfaces [2]_. Deviations of ln mu are combined in quadrature, those that raise mu at
    a speed for the upper edge and those that lower it for the lower one: the unknowns are
    independent of each other, so their sum would overstate the band; many are one-sided or bend the
    curve differently at both ends, so that a symmetric band would hide the sign; and mu spans
    decades and stays positive, so that ratios are combined. If both ends of a variation raise mu,
    the larger change is used. The reference for the changes is computed on the same coarser mesh,
    100 cells, as the variations.

    The refitted sigma_f is that of least squares with equal weights, as in `fit_shear_stress`.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    .. [2] A. Wang, M. H. Müser, "Percolation and Reynolds flow in elastic contacts of isotropic and
       anisotropic, randomly rough surfaces", Tribol. Lett. 69, 1 (2021).
       doi:10.1007/s11249-020-01378-7

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> given = {"viscosity": 1.4, "load": 310.0, "shear_stress": 0.0}
    >>> spread = model_uncertainty(contact, None, speed=[1e-3, 1e-1], **given)
    >>> spread.largest_change.to_series().round(2).to_dict()  # of smooth surfaces
    {'inlet length': 0.05, 'outlet': 0.62}
    """
    warn_of_old("model_uncertainty", options)
    known, single = merge_old_options(unknowns, options)
    if psd is not None:  # wavenumbers without roughness cannot be varied
        rough = rough_band(psd)[0]
        psd = psd.sel(wavenumber=slice(rough[0], rough[-1]))
    force = positive(load, contact.load_unit, "load")
    parameters = parameters_of(liquid, interface, solver, **single | {"method": "auto"})
    base = _base(contact, psd, force, parameters, known)
    speeds = np.atleast_1d(labelled(_DEFAULT_SPEEDS if speed is None else speed, "sliding_speed"))
    if np.any(speeds <= 0):
        raise AnalysisError("speed: a band is made at speeds above zero; leave the others out")
    cells = parameters.solver.cells
    given = _Given(contact, psd, force, speeds, parameters)
    coarse = given.changed({"cells": min(cells, int(limits.MAX_CELLS_OF_CHANGE.value))})
    with one_thread():
        whole = start = given.solved()
        if cells > limits.MAX_CELLS_OF_CHANGE.value and not contact.is_round:
            start = coarse.solved()
        curve, reference = whole.curve, start.curve
        all_unknowns = variations(base)
        varied = [unknown for unknown in all_unknowns if isinstance(unknown, Variation)]
        mu, fitted, attributes = _all_ends(coarse, varied, start, refit)
    left = [unknown for unknown in all_unknowns if isinstance(unknown, Skipped)]
    height = reference["friction_coefficient"].values
    error = known.shear_stress_error
    if error is None:
        left.append(Skipped("shear stress", "no shear_stress_error was given"))
    elif not refit:
        fitted_stress, ends = _vary_stress(float(error), reference)
        varied.append(fitted_stress)
        mu = np.concatenate([mu, ends[None]])
        fitted = np.concatenate([fitted, np.zeros((1, 2))])
    log_ratio = np.log(mu / height)
    top = curve["friction_coefficient"].values
    over = str(curve["friction_coefficient"].dims[0])
    raised, lowered = (_quadrature(sign * log_ratio) for sign in (1, -1))
    data = xr.Dataset(
        {
            "friction_coefficient": (over, top),
            "friction_coefficient_low": (over, top * np.exp(-lowered)),
            "friction_coefficient_high": (over, top * np.exp(raised)),
            "friction_coefficient_varied": (
                ("variation", "range_end", over),
                top * np.exp(log_ratio),
            ),
            **_table(varied, mu, height, speeds),
            "shear_stress_change_low": ("variation", fitted[:, 0]),
            "shear_stress_change_high": ("variation", fitted[:, 1]),
        },
        {
            over: speeds,
            "variation": np.array([variation.name for variation in varied], dtype=str),
            "range_end": ["low", "high"],
        },
    )
    return stamp(
        data.assign_attrs(curve.attrs),
        **{"load_N" if contact.is_round else "load_N_m": force},
        not_varied="; ".join(f"{name}: {reason}" for name, reason in left + fixed_parameters(base)),
        not_in_model=describe_effects(effects_not_modelled(contact, force, base.viscosity, psd)),
        shear_stress_refitted="yes" if refit else "no",
        combined="deviations of ln mu in quadrature, upwards and downwards apart",
        **together([curve.attrs, *attributes]),
    )


class _Given(NamedTuple):
    """Arguments of `solve_curve` in SI."""

    contact: Contact
    psd: xr.Dataset | None
    load: float
    speed: np.ndarray
    parameters: Parameters

    def changed(self, change: Mapping[str, Any]) -> _Given:
        """Return the model with the changes of one end of a range."""
        own = {name: value for name, value in change.items() if name in self._fields}
        left = {name: value for name, value in change.items() if name not in own}
        return self._replace(**own, parameters=parameters_of(*self.parameters, **left))

    def solved(self, near: SolvedCurve | None = None) -> SolvedCurve:
        """Return the solved model; a similar solution speeds this up."""
        return solve_curve(self.contact, self.psd, self.load, self.speed, self.parameters, near)


def _base(
    contact: Contact, psd: xr.Dataset | None, load: float, parameters: Parameters, known: Unknowns
) -> Base:
    """Return the unvaried model, with the ranges of its inputs in SI."""
    liquid, interface, solver = parameters
    work = interface.work_of_adhesion
    return Base(
        psd=psd,
        rough_body=interface.rough_body or "stationary",
        friction_factors=solver.friction_factors,
        gamma=solver.gamma,
        measured_to=None if known.measured_to is None else float(known.measured_to),
        contact=contact,
        load=load,
        viscosity=liquid.viscosity,
        viscosity_range=_range(known.viscosity, liquid.viscosity, "Pa s", "viscosity"),
        youngs_modulus_range=_range(
            known.youngs_modulus, contact.youngs_modulus, "Pa", "youngs_modulus"
        ),
        inlet_length=np.inf if liquid.extent is None else liquid.extent,
        area=solver.area,
        work_of_adhesion=work,
        work_of_adhesion_range=None
        if work is None
        else _range(known.work_of_adhesion, work, "J/m2", "work_of_adhesion", least=-np.inf),
        load_range=_range(known.load, load, contact.load_unit, "load"),
        radius_range=_range(known.radius, contact.radius, "m", "radius"),
        outlet="unknown" if known.outlet and liquid.outlet == "vented" else liquid.outlet,
    )


def _all_ends(
    coarse: _Given, varied: list[Variation], start: SolvedCurve, refit: bool
) -> tuple[np.ndarray, np.ndarray, list[dict[str, str]]]:
    """Return friction, change of sigma_f and validity warnings at both ends of each variation."""
    reference = start.curve
    stress = coarse.parameters.interface.shear_stress
    aim = reference["friction_coefficient"].values
    mu, attributes = np.full((len(varied), 2, aim.size), np.nan), []
    beyond = {reason.split(" is ")[0] for reason in reasons_of(reference.attrs)}
    fitted = np.full((len(varied), 2), np.nan)
    for i, variation in enumerate(varied):
        for j, end in enumerate(variation.ends):
            if end is None:
                continue
            try:
                changed = _reuse_films(reference, end)
                if changed is None:
                    changed = coarse.changed(end).solved(start).curve
            except AnalysisError as error:
                where = f"varied {variation.name} ({variation.texts[j]})"
                raise AnalysisError(error, where=where) from error
            attributes += [
                {"validity_reasons": f"varied {variation.name} ({variation.texts[j]}): {reason}"}
                for reason in reasons_of(changed.attrs)
                if reason.split(" is ")[0] not in beyond
            ]
            fluid = sum(changed[part].values for part in _PARTS)
            area = changed["friction_per_shear_stress"].values
            solid = float(area @ area)
            best = float(area @ (aim - fluid)) / solid if solid > 0 else np.nan
            fitted[i, j] = best / stress - 1 if stress > 0 else np.nan
            mu[i, j] = fluid + (best if refit and solid > 0 else stress) * area
    return mu, fitted, attributes


def _reuse_films(reference: xr.Dataset, end: Changed) -> xr.Dataset | None:
    """Return the curve of a variation that leaves the film unchanged; None for other variations."""
    if end.keys() == {"area"}:
        return reference.assign(
            friction_per_shear_stress=reference["friction_per_shear_stress_other"]
        )
    if end == {"friction_factors": False}:
        bare = reference["friction_without_factors"] - reference["friction_coefficient_solid"]
        couette, pressure = _PARTS
        return reference.assign({couette: bare, pressure: 0.0 * bare})
    return None


def _range(
    given: Range | None, value: float, unit: str, name: str, least: float = 0.0
) -> tuple[float, float] | None:
    """Return a range in SI after checking that it contains the value and stays above `least`."""
    if given is None:
        return None
    read = positive if least == 0 else to_si
    low, high = (read(end, unit, name=f"{name}_range") for end in given)
    if not low <= value <= high:
        raise AnalysisError(
            f"{name}_range: {low:g} to {high:g} {unit} must go from below to above {value:g} {unit}"
        )
    return low, high


def _vary_stress(error: float, reference: xr.Dataset) -> tuple[Variation, np.ndarray]:
    """Return the fit error of the shear stress as a variation, with mu at both ends."""
    stress, mu = reference.attrs["shear_stress_Pa"], reference["friction_coefficient"].values
    ends = np.array([max(stress - NORMAL * error, 0.0), stress + NORMAL * error])
    texts = (f"{ends[0] / 1e6:.3g} MPa", f"{ends[1] / 1e6:.3g} MPa")
    reason = "1.96 standard errors of the fit"
    area = reference["friction_per_shear_stress"].values
    changed = mu + (ends - stress)[:, None] * area
    return Variation("shear stress", reason, texts, ({}, {})), changed


def _quadrature(deviation: np.ndarray) -> np.ndarray:
    """Return the root sum of squares over variations, each with the larger of its two changes."""
    if deviation.shape[0] == 0:
        return np.zeros(deviation.shape[-1])
    larger = np.nanmax(deviation, axis=1).clip(0)
    return np.sqrt(np.sum(larger**2, axis=0))


def _table(
    varied: list[Variation], mu: np.ndarray, height: np.ndarray, speed: np.ndarray
) -> dict[str, tuple[str, Any]]:
    """Return a table of ends, reasons and largest changes of each variation."""
    words = {
        "variation_low": [variation.texts[0] for variation in varied],
        "variation_high": [variation.texts[1] for variation in varied],
        "variation_reason": [variation.reason for variation in varied],
    }
    table: dict[str, tuple[str, Any]] = {
        name: ("variation", np.array(texts, dtype=str))  # dtype str also without variations
        for name, texts in words.items()
    }
    for name, over in (("largest_change", height.max()), ("largest_relative_change", height)):
        change = np.nanmax(np.abs(mu - height) / over, axis=1)
        table[name] = ("variation", change.max(axis=1))
        table[f"{name}_speed"] = ("variation", speed[change.argmax(axis=1)])
    return table
