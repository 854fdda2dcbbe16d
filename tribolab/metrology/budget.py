"""Uncertainty budget of measured friction coefficients."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from pydantic import ValidationError

from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import AnalysisError, Cure, nearest, shown
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.metrology.budget_curve import curve_uncertainty
from tribolab.metrology.budget_parts import NOISE, ScatterPart, combine_parts
from tribolab.metrology.budget_result import UncertaintyBudget
from tribolab.metrology.sensitivity import contributions, readings_of
from tribolab.reading.dialect.uncertainty import NAMES, Known, StatedUncertainty, Uncertainty

# variables that describe the scatter of the curve itself
_OWN = ("friction_coefficient_u", "friction_coefficient_dof")
StatedUncertainties = Mapping[str, StatedUncertainty | Mapping[str, Any]]


def uncertainty_budget(
    friction: xr.Dataset | Sequence[xr.Dataset],
    uncertainty: StatedUncertainties | None = None,
    *,
    speed_tolerance: float = 0.1,
) -> UncertaintyBudget:
    """Return the uncertainty budget of friction coefficients: standard uncertainty, parts and U95.

    Parameters
    ----------
    friction
        From `friction_coefficient`: the budget of each segment. A list of such results, of repeated
        runs of one system: the budget of each point of their curve. Runs of one instrument share
        its calibration; different instruments are independent.
    uncertainty
        Calibration uncertainties by the names of `uncertainty.NAMES`, each
        with the keys of a table [uncertainty.NAME] of the campaign file: ``{"tilt": {"value":
        "0.5 deg", "as": "half-width"}}``. It overrides the instrument's file.
    speed_tolerance
        As for `measured_stribeck_curve`.

    Returns
    -------
    UncertaintyBudget

    Raises
    ------
    AnalysisError
        If a name is not known, a key is wrong, or there is no friction coefficient.

    Notes
    -----
    ``u^2 = sum (c_i u_i)^2`` with the sensitivities of `contributions`, degrees of freedom by
    Welch and Satterthwaite, ``U95 = t_0.975(nu) u`` (JCGM 100:2008). The noise within the run is
    the standard error of the mean with its degrees of freedom. If one rectangular part
    dominates, U95 is too wide, which `caveats` states.

    Examples
    --------
    A cell that is tilted by up to a degree, sliding one way:

    >>> one_way = xr.Dataset({
    ...     "friction_coefficient": ("segment", [0.0075]),
    ...     "friction_coefficient_sem": ("segment", [0.0002]),
    ...     "normal_force": ("segment", [50.0]),
    ...     "direction": ("segment", [1]),
    ... })
    >>> tilt = {"tilt": {"value": "1 deg", "as": "standard"}}
    >>> uncertainty_budget(one_way, tilt).data.friction_coefficient_u.values.round(4)
    array([0.0175])
    >>> uncertainty_budget(one_way).caveats
    'calibration not stated: statistical only'
    """
    if isinstance(friction, xr.Dataset):
        known = known_uncertainties(friction, uncertainty)
        return UncertaintyBudget(segment_uncertainty(friction, known), known)
    curve = measured_stribeck_curve(friction, speed_tolerance)
    alone = [zero_apart(run, known_uncertainties(run, uncertainty)) for run in friction]
    if any(part.friction is not run for part, run in zip(alone, friction, strict=True)):
        own = measured_stribeck_curve([part.friction for part in alone], speed_tolerance)
        curve = curve.assign({name: own[name] for name in _OWN})
    stated = [part.known for part in alone]
    return UncertaintyBudget(*curve_uncertainty(curve, friction, stated))


def known_uncertainties(
    friction: xr.Dataset, stated: StatedUncertainties | None = None
) -> dict[str, Known]:
    """Return the standard uncertainties by name, from the instrument's file and from the user.

    Parameters
    ----------
    friction
        Result with the attribute ``uncertainty``: inputs from the run's instrument and campaign.
    stated
        As for `uncertainty_budget`.

    Raises
    ------
    AnalysisError
        If a name is not known, or its statement is invalid.
    """
    own = RunAttributes.from_attrs(friction.attrs).uncertainty
    known = {name: Known(**entry) for name, entry in own.items() if name in NAMES}
    for name in stated or {}:
        if name not in NAMES:
            raise AnalysisError(
                f"uncertainty: '{shown(name)}' is not known{nearest(name, NAMES)}",
                function="uncertainty_budget",
            )
    try:
        return known | {
            name: Known(**entry)
            for name, entry in Uncertainty.model_validate(dict(stated or {})).plain().items()
        }
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise AnalysisError(
            f"uncertainty: {where}: {first['msg'].removeprefix('Value error, ')}",
            cure=Cure(notebook='e.g. uncertainty={"tilt": {"value": "0.5 deg", "as": "standard"}}'),
        ) from error


def segment_uncertainty(friction: xr.Dataset, known: Mapping[str, Known]) -> xr.Dataset:
    """Return a friction result with the uncertainty of each segment and its contributions.

    Parameters
    ----------
    friction
        From `friction_coefficient` (segment).
    known
        Standard uncertainties by name, from `known_uncertainties`.

    Returns
    -------
    xarray.Dataset
        See `tribolab.metrology.budget_parts.combine_parts`.

    Raises
    ------
    AnalysisError
        If there is no friction coefficient.
    """
    if "friction_coefficient" not in friction:
        raise AnalysisError(
            "no 'friction_coefficient': a run without normal force has forces only",
            function="uncertainty_budget",
        )
    alone = zero_apart(friction, known)
    parts = contributions(readings_of(friction), alone.known)
    noise = alone.friction["friction_coefficient_sem"].values.astype(float)
    dof = alone.friction.get("friction_coefficient_dof")
    free = np.full(noise.size, np.inf) if dof is None else dof.values.astype(float)
    scatter = [ScatterPart(noise, free, NOISE)]
    return combine_parts(friction, "segment", scatter, parts, known)


class ZeroApart(NamedTuple):
    """Friction result whose standard errors exclude the stated zero; the zero is an input."""

    friction: xr.Dataset
    known: Mapping[str, Known]


def zero_apart(friction: xr.Dataset, known: Mapping[str, Known]) -> ZeroApart:
    """Return a result whose standard errors exclude the stated zero, now a separate contribution.

    Parameters
    ----------
    friction
        From `friction_coefficient` (segment).
    known
        Standard uncertainties by name; without ``friction_zero`` nothing is removed.
    """
    entry, stated = known.get("friction_zero"), friction.attrs.get("zero_stated")
    if entry is None or stated is None or "normal_force" not in friction:
        return ZeroApart(friction, known)
    inputs = dict(known) | {"friction_zero": entry._replace(standard=float(stated))}
    part = np.nan_to_num(contributions(readings_of(friction), inputs)["friction_zero"])
    error = friction["friction_coefficient_sem"]
    noise = np.sqrt(np.maximum(error.values.astype(float) ** 2 - part**2, 0.0))
    alone = friction.assign(friction_coefficient_sem=error.copy(data=noise))
    return ZeroApart(alone, inputs)
