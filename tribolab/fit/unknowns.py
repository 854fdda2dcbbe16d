"""What is not known of a model, as a frozen object."""

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
    """What a band on a computed curve takes as uncertain beside the theory itself.

    Parameters
    ----------
    viscosity, youngs_modulus, load, radius, work_of_adhesion
        Ends of what the liquid's viscosity [Pa s], the contact's modulus [Pa], the load [N/m, of
        a ball N], the radius [m] and the work of adhesion [J/m2] may be, some 95 %; None leaves
        each out.
    shear_stress_error
        Standard error [Pa] of sigma_f; None leaves it out.
    measured_to
        Wavenumber [1/m] above which the spectrum is a guess, where ``origin`` does not say.
    outlet
        Whether a vented outlet may be flooded; a liquid that is stated to be flooded is.

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
        """Turn text into SI floats and refuse what is not possible."""
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
    """Return the unknowns with what was an argument in the last release, and all other options.

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
    if "outlet" in left:  # None was vented or flooded, not known which
        found["outlet"] = left["outlet"] is None
        if left["outlet"] is None:
            del left["outlet"]
    return replace(unknowns or Unknowns(), **found), left
