"""Ranges of the uncertain inputs of a computed Stribeck curve."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import positive, to_si

Range = tuple[str | float, str | float]


@dataclass(frozen=True)
class Unknowns:
    """Uncertain inputs for the band of a computed curve, in addition to theory errors.

    Parameters
    ----------
    viscosity, youngs_modulus, load, radius, work_of_adhesion
        Ranges, some 95 % coverage, of viscosity [Pa s], modulus [Pa], load [N/m; N for a ball],
        radius [m] and work of adhesion [J/m2]; None leaves an input out.
    shear_stress_error
        Standard error [Pa] of sigma_f; None leaves it out.
    measured_to
        Wavenumber [1/m] above which the spectrum is extrapolated, if its ``origin`` does not state
        this.
    outlet
        Whether a vented outlet may be flooded; an outlet stated as flooded is not varied.

    Examples
    --------
    >>> Unknowns(viscosity=("1.2 Pa s", "1.6 Pa s"), outlet=False).shear_stress_error is None
    True
    """

    viscosity: Range | None = None
    youngs_modulus: Range | None = None
    load: Range | None = None
    radius: Range | None = None
    work_of_adhesion: Range | None = None
    shear_stress_error: str | float | None = None
    measured_to: str | float | None = None
    outlet: bool = True

    def __post_init__(self) -> None:
        """Convert text to SI floats and raise an error if a value is impossible."""
        if self.measured_to is not None:
            known = positive(self.measured_to, "1/m", "measured_to")
            object.__setattr__(self, "measured_to", known)
        if self.shear_stress_error is not None:
            error = to_si(self.shear_stress_error, "Pa", name="shear_stress_error")
            if not 0 <= error < np.inf:
                raise AnalysisError(
                    f"finite, not negative is wanted; got {error:g} Pa",
                    function="shear_stress_error",
                )
            object.__setattr__(self, "shear_stress_error", error)


_NAMES = {field.name for field in fields(Unknowns)}


def merge_old_options(
    unknowns: Unknowns | None, options: Mapping[str, Any]
) -> tuple[Unknowns, dict[str, Any]]:
    """Return unknowns updated by arguments that are now unknowns, and the other arguments.

    Examples
    --------
    >>> merge_old_options(None, {"load_range": (300.0, 320.0), "cells": 100})[1]
    {'cells': 100}
    """
    found, left = {}, dict(options)
    for name in options:
        field = name.removesuffix("_range")
        if field in _NAMES and (name != field or field in ("shear_stress_error", "measured_to")):
            found[field] = left.pop(name)
    if "outlet" in left:  # None means that it is unknown whether the outlet is vented or flooded
        found["outlet"] = left["outlet"] is None
        if left["outlet"] is None:
            del left["outlet"]
    return replace(unknowns or Unknowns(), **found), left
