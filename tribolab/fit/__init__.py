"""Shear stress and its error, from fits of computed to measured Stribeck curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.fit.fit_settings import FitSettings as FitSettings
    from tribolab.fit.input_error import model_inputs as model_inputs
    from tribolab.fit.joint.fit import fit_shear_stress_jointly as fit_shear_stress_jointly
    from tribolab.fit.joint.inputs import DryFriction as DryFriction
    from tribolab.fit.joint.priors import JointPriors as JointPriors
    from tribolab.fit.master_curve import collapse_test as collapse_test
    from tribolab.fit.model_error import model_uncertainty as model_uncertainty
    from tribolab.fit.several import fit_shear_stresses as fit_shear_stresses
    from tribolab.fit.unknowns import Unknowns as Unknowns

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
