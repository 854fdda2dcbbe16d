"""Comparison of measured curves with computed ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.fit.fit_settings import FitSettings
    from tribolab.fit.input_error import model_inputs
    from tribolab.fit.joint.comparison import compare_shear_stress_models
    from tribolab.fit.joint.fit import fit_shear_stress_jointly
    from tribolab.fit.joint.inputs import DryFriction
    from tribolab.fit.joint.priors import JointPriors
    from tribolab.fit.master_curve import collapse_test
    from tribolab.fit.model_error import model_uncertainty
    from tribolab.fit.several import fit_shear_stresses
    from tribolab.fit.unknowns import Unknowns

__all__ = [
    "DryFriction",
    "FitSettings",
    "JointPriors",
    "Unknowns",
    "collapse_test",
    "compare_shear_stress_models",
    "fit_shear_stress_jointly",
    "fit_shear_stresses",
    "model_inputs",
    "model_uncertainty",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "DryFriction": "joint.inputs",
        "FitSettings": "fit_settings",
        "JointPriors": "joint.priors",
        "Unknowns": "unknowns",
        "collapse_test": "master_curve",
        "compare_shear_stress_models": "joint.comparison",
        "fit_shear_stress_jointly": "joint.fit",
        "fit_shear_stresses": "several",
        "model_inputs": "input_error",
        "model_uncertainty": "model_error",
    },
)
