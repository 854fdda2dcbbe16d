"""Effect of uncertain load, radius and modulus on a computed friction curve."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.geometry import Contact
from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.fit import limits
from tribolab.lubrication.parameters import Liquid, parameters_of
from tribolab.lubrication.solved_curve import SolvedCurve, solve_curve
from tribolab.units.conversion import positive
from tribolab.units.stamping import labelled, stamp

_INPUTS = ("load", "radius", "youngs_modulus")
_LN_STEP = 0.02  # step of ln(input) up and down, for derivatives
_PARTS = ("friction_coefficient_couette", "friction_coefficient_pressure")
_SOLID = "friction_per_shear_stress"
_MOVED = ("fluid_part", "solid_part", "solid_part_other")


def model_inputs(
    contact: Contact,
    psd: xr.Dataset | None,
    viscosity: Liquid | str | float,
    load: str | float,
    speed: str | ArrayLike,
    errors: Mapping[str, float],
    **model: Any,
) -> xr.Dataset:
    """Return the change of a computed curve due to one standard uncertainty of each model input.

    Parameters
    ----------
    contact, psd, viscosity, load
        As for `stribeck_curve`, with one load.
    speed
        Sliding speeds [m/s] (sliding_speed), above zero; some three per decade are enough, because
        the changes are smooth.
    errors
        Relative standard uncertainties [1] of ``"load"``, ``"radius"``, ``"youngs_modulus"``.
    **model
        Further arguments of `stribeck_curve`, such as ``area``.

    Returns
    -------
    xarray.Dataset
        Signed changes over ``model_input`` and ``sliding_speed``: ``fluid_part`` [1] of the fluid
        friction; ``solid_part`` [1/Pa] of the friction per shear stress, and ``solid_part_other``
        the same by the other theory of the contact area.

    Raises
    ------
    AnalysisError
        If an input is not known, or its uncertainty is negative or too large to be linear.

    Notes ----- Changes are central differences, from two curves for inputs that differ by 4 %. They
    do not affect the measured friction, which is a ratio of recorded forces. If all forces increase
    by the same factor, nothing changes: ``d mu/d ln(viscosity v) + d mu/d ln(load) + d mu/d
    ln(modulus) + sigma_f d mu/d sigma_f = 0``.

    Examples
    --------
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> moved = model_inputs(contact, None, 1.4, 310.0, [1e-2], {"load": 0.01}, cells=100)
    >>> moved.fluid_part.sel(model_input="load").values.round(5)  # of smooth surfaces
    array([-0.00011])
    """
    for name, error in errors.items():
        if name not in _INPUTS:
            raise AnalysisError(f"errors: '{shown(name)}' is not known{nearest(name, _INPUTS)}")
        if not 0 <= error < 0.5:
            raise AnalysisError(
                f"errors: {name}: a relative standard uncertainty from 0 to 0.5 is wanted; "
                f"got {error:g}"
            )
    force = positive(load, contact.load_unit, "load")
    speeds = np.atleast_1d(labelled(speed, "sliding_speed"))
    parameters = parameters_of(viscosity, 0.0, **model)
    cells = min(parameters.solver.cells, limits.MAX_CELLS_OF_CHANGE.value)
    solver = replace(parameters.solver, cells=cells)
    if contact.is_round:  # for differences, the strip approximation of a ball is accurate enough
        solver = replace(parameters.solver, method="auto")
    parameters = parameters._replace(solver=solver)
    rows = []
    near: SolvedCurve | None = None  # each curve starts from the previous one, which is similar
    for name, error in errors.items():
        ends = []
        for factor in (np.exp(_LN_STEP), np.exp(-_LN_STEP)):
            body, at = contact, force
            if name == "load":
                at = factor * force
            else:
                body = replace(contact, **{name: factor * getattr(contact, name)})
            near = solve_curve(body, psd, at, speeds, parameters, near)
            ends.append(near.curve)
        rows.append([error * (above - below) / (2 * _LN_STEP) for above, below in _columns(*ends)])
    moved = np.reshape(rows, (len(errors), 3, speeds.size))
    dims = ("model_input", "sliding_speed")
    return stamp(
        xr.Dataset(
            {name: (dims, moved[:, i]) for i, name in enumerate(_MOVED)},
            {"model_input": np.array(list(errors), dtype=str), "sliding_speed": speeds},
        )
    )


def _columns(above: xr.Dataset, below: xr.Dataset) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return pairs (input raised, input lowered): fluid friction, solid friction by each theory."""
    names = (_SOLID, f"{_SOLID}_other")
    fluid = [end[_PARTS[0]].values + end[_PARTS[1]].values for end in (above, below)]
    return [(fluid[0], fluid[1]), *((above[n].values, below[n].values) for n in names)]


def moved_friction(inputs: xr.Dataset, shear_stress: float, speed: np.ndarray) -> np.ndarray:
    """Return the change of friction due to each input at given speeds (model_input, sliding_speed).

    Parameters
    ----------
    inputs
        From `model_inputs`.
    shear_stress
        sigma_f [Pa].
    speed
        Speeds [m/s]; the changes are interpolated linearly in ln(speed).
    """
    log_speed = np.log(inputs["sliding_speed"].values)
    rows = inputs["fluid_part"].values + shear_stress * inputs["solid_part"].values
    moved = [np.interp(np.log(speed), log_speed, row) for row in rows]
    return np.array(moved).reshape(len(moved), speed.size)
