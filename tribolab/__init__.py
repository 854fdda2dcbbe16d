"""tribolab: a workbench for friction experiments on soft, rough contacts.

Raw files in; friction coefficients with honest error bars and a report out. Every step
is a plain function on xarray datasets, in SI units::

    import tribolab as tl

    run = tl.read("raw/sb-r_glycerol_31N_01_force.csv")
    segments = tl.find_segments(run, trim=0.10)
    mu = tl.friction_coefficient(run, segments)
"""

from __future__ import annotations

import importlib
import sys
from typing import TYPE_CHECKING, Any

from tribolab.core.moved import accept_old_paths
from tribolab.version import __version__

# Public name -> the module it lives in; "" for a module itself. Loaded when first used, so that
# `import tribolab` costs nothing.
_PUBLIC = {
    "read": "tribolab.reading.run_files",
    "variables": "tribolab.units.variable_table",
    "draft_dialect": "tribolab.reading.unknown.proposal.draft",
    "read_netcdf": "tribolab.reading.netcdf.netcdf",
    "write_netcdf": "tribolab.reading.netcdf.netcdf",
    "find_segments": "tribolab.friction.segments.find",
    "Decision": "tribolab.friction.decisions.decision",
    "decide": "tribolab.friction.decisions.decided_segments",
    "friction_coefficient": "tribolab.friction.coefficient.coefficient",
    "half_loops": "tribolab.friction.coefficient.friction_loop",
    "uncertainty_budget": "tribolab.metrology.budget",
    "friction_per_cycle": "tribolab.friction.coefficient.cycles",
    "moving_mass": "tribolab.friction.inertia",
    "without_inertia": "tribolab.friction.inertia",
    "static_friction": "tribolab.friction.coefficient.static",
    "running_in": "tribolab.friction.running_in.history",
    "stick_slip": "tribolab.friction.oscillation.slip_segments",
    "error_from_blocks": "tribolab.friction.blocks",
    "stick_slip_curve": "tribolab.friction.oscillation.slip_curve",
    "measured_stribeck_curve": "tribolab.friction.stribeck",
    "traction_curves": "tribolab.friction.traction",
    "check": "tribolab.qc.run.checks",
    "RUN_CHECKS": "tribolab.qc.run.checks",
    "objections": "tribolab.qc.finding_table",
    "check_scans": "tribolab.qc.scan.checks",
    "check_scan_set": "tribolab.qc.scan.sets",
    "read_scans": "tribolab.reading.scan_files",
    "read_results": "tribolab.report.results_folder",
    "remove_form": "tribolab.surface.form",
    "fill_dropouts": "tribolab.surface.form",
    "psd_1d": "tribolab.surface.spectra.psd",
    "psd_2d": "tribolab.surface.spectra.psd",
    "self_affine_psd": "tribolab.surface.self_affine",
    "synthesise_map": "tribolab.surface.synthesis",
    "extrapolate": "tribolab.surface.extrapolation",
    "roughness_parameters": "tribolab.surface.roughness",
    "spectral_roughness": "tribolab.surface.roughness",
    "LineContact": "tribolab.contact.geometry",
    "PointContact": "tribolab.contact.geometry",
    "rough_point_contact": "tribolab.contact.point",
    "rolling_friction": "tribolab.contact.rolling",
    "collapse_test": "tribolab.fit.master_curve",
    "Liquid": "tribolab.lubrication.parameters",
    "Interface": "tribolab.lubrication.parameters",
    "Solver": "tribolab.lubrication.parameters",
    "contact_area_ratio": "tribolab.contact.persson",
    "mean_separation": "tribolab.contact.persson",
    "separation_table": "tribolab.contact.separation",
    "gap_distribution": "tribolab.contact.gap",
    "rough_line_contact": "tribolab.contact.line",
    "adhesion": "tribolab.contact.adhesive_contact",
    "macroscopic_work_of_adhesion": "tribolab.contact.adhesive_contact",
    "adhesion_uncertainty": "tribolab.contact.adhesion_error",
    "SurfaceEnergies": "tribolab.contact.work_of_adhesion",
    "work_of_adhesion_spread": "tribolab.contact.work_of_adhesion",
    "stribeck_curve": "tribolab.lubrication.stribeck",
    "with_shear_stress": "tribolab.lubrication.stribeck",
    "liquid_viscosity": "tribolab.lubrication.viscosity",
    "film_profile": "tribolab.lubrication.film",
    "relative_flow_factors": "tribolab.lubrication.relative_factors",
    "flow_factors": "tribolab.lubrication.factors",
    "FitSettings": "tribolab.fit.fit_settings",
    "Unknowns": "tribolab.fit.unknowns",
    "fit_shear_stress": "tribolab.fit.shear_stress",
    "fit_shear_stresses": "tribolab.fit.several",
    "fit_shear_stress_jointly": "tribolab.fit.joint.fit",
    "JointPriors": "tribolab.fit.joint.priors",
    "DryFriction": "tribolab.fit.joint.inputs",
    "compare_shear_stress_models": "tribolab.fit.joint.comparison",
    "sliding_mode": "tribolab.regime.verdict",
    "sliding_modes": "tribolab.regime.several",
    "Mode": "tribolab.regime.model",
    "dead_weight_gain": "tribolab.metrology.dead_weight",
    "model_inputs": "tribolab.fit.input_error",
    "model_uncertainty": "tribolab.fit.model_error",
    "viscoelastic_friction": "tribolab.rubber.friction",
    "two_body_friction": "tribolab.rubber.two_bodies",
    "RubberBody": "tribolab.rubber.two_bodies",
    "read_modulus": "tribolab.rubber.modulus",
    "PronySeries": "tribolab.rubber.prony",
    "WilliamsLandelFerry": "tribolab.rubber.temperature",
    "flash_temperature": "tribolab.rubber.temperature",
    "modulus_at": "tribolab.rubber.temperature",
    "load_campaign": "tribolab.campaign.settings.load",
    "load_review": "tribolab.campaign.settings.review",
    "run_campaign": "tribolab.app.run",
    "compare": "tribolab.comparison.comparison",
    "repeatability": "tribolab.comparison.repeat_study",
    "history": "tribolab.comparison.instrument_history",
    "measuring_plan": "tribolab.comparison.planning",
    "pack": "tribolab.archive.packing",
    "TribolabError": "tribolab.core.errors",
    "plot": "",
    "rig": "",
    "studies": "",
}

__all__ = [
    "__version__",
    "read",
    "variables",
    "draft_dialect",
    "read_netcdf",
    "write_netcdf",
    "find_segments",
    "Decision",
    "decide",
    "friction_coefficient",
    "friction_per_cycle",
    "moving_mass",
    "without_inertia",
    "static_friction",
    "running_in",
    "half_loops",
    "uncertainty_budget",
    "stick_slip",
    "error_from_blocks",
    "stick_slip_curve",
    "measured_stribeck_curve",
    "traction_curves",
    "check",
    "RUN_CHECKS",
    "objections",
    "check_scans",
    "check_scan_set",
    "read_scans",
    "read_results",
    "relative_flow_factors",
    "remove_form",
    "fill_dropouts",
    "psd_1d",
    "psd_2d",
    "self_affine_psd",
    "synthesise_map",
    "extrapolate",
    "roughness_parameters",
    "spectral_roughness",
    "LineContact",
    "PointContact",
    "rough_point_contact",
    "rolling_friction",
    "collapse_test",
    "Liquid",
    "Interface",
    "Solver",
    "contact_area_ratio",
    "mean_separation",
    "separation_table",
    "gap_distribution",
    "rough_line_contact",
    "adhesion",
    "macroscopic_work_of_adhesion",
    "adhesion_uncertainty",
    "SurfaceEnergies",
    "work_of_adhesion_spread",
    "stribeck_curve",
    "with_shear_stress",
    "liquid_viscosity",
    "film_profile",
    "flow_factors",
    "FitSettings",
    "Unknowns",
    "fit_shear_stress",
    "fit_shear_stresses",
    "fit_shear_stress_jointly",
    "JointPriors",
    "DryFriction",
    "compare_shear_stress_models",
    "sliding_mode",
    "sliding_modes",
    "Mode",
    "dead_weight_gain",
    "model_inputs",
    "model_uncertainty",
    "viscoelastic_friction",
    "two_body_friction",
    "RubberBody",
    "read_modulus",
    "PronySeries",
    "WilliamsLandelFerry",
    "flash_temperature",
    "modulus_at",
    "load_campaign",
    "load_review",
    "run_campaign",
    "compare",
    "repeatability",
    "history",
    "measuring_plan",
    "pack",
    "TribolabError",
    "plot",
    "rig",
    "studies",
]

if TYPE_CHECKING:
    from tribolab import plot, rig, studies
    from tribolab.app.run import run_campaign
    from tribolab.archive.packing import pack
    from tribolab.campaign.settings.load import load_campaign
    from tribolab.campaign.settings.review import load_review
    from tribolab.comparison.comparison import compare
    from tribolab.comparison.instrument_history import history
    from tribolab.comparison.planning import measuring_plan
    from tribolab.comparison.repeat_study import repeatability
    from tribolab.contact.adhesion_error import adhesion_uncertainty
    from tribolab.contact.adhesive_contact import adhesion, macroscopic_work_of_adhesion
    from tribolab.contact.gap import gap_distribution
    from tribolab.contact.geometry import LineContact, PointContact
    from tribolab.contact.line import rough_line_contact
    from tribolab.contact.persson import contact_area_ratio, mean_separation
    from tribolab.contact.point import rough_point_contact
    from tribolab.contact.rolling import rolling_friction
    from tribolab.contact.separation import separation_table
    from tribolab.contact.work_of_adhesion import SurfaceEnergies, work_of_adhesion_spread
    from tribolab.core.errors import TribolabError
    from tribolab.fit.fit_settings import FitSettings
    from tribolab.fit.input_error import model_inputs
    from tribolab.fit.joint.comparison import compare_shear_stress_models
    from tribolab.fit.joint.fit import fit_shear_stress_jointly
    from tribolab.fit.joint.inputs import DryFriction
    from tribolab.fit.joint.priors import JointPriors
    from tribolab.fit.master_curve import collapse_test
    from tribolab.fit.model_error import model_uncertainty
    from tribolab.fit.several import fit_shear_stresses
    from tribolab.fit.shear_stress import fit_shear_stress
    from tribolab.fit.unknowns import Unknowns
    from tribolab.friction.blocks import error_from_blocks
    from tribolab.friction.coefficient.coefficient import friction_coefficient
    from tribolab.friction.coefficient.cycles import friction_per_cycle
    from tribolab.friction.coefficient.friction_loop import half_loops
    from tribolab.friction.coefficient.static import static_friction
    from tribolab.friction.decisions.decided_segments import decide
    from tribolab.friction.decisions.decision import Decision
    from tribolab.friction.inertia import moving_mass, without_inertia
    from tribolab.friction.oscillation.slip_curve import stick_slip_curve
    from tribolab.friction.oscillation.slip_segments import stick_slip
    from tribolab.friction.running_in.history import running_in
    from tribolab.friction.segments.find import find_segments
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.friction.traction import traction_curves
    from tribolab.lubrication.factors import flow_factors
    from tribolab.lubrication.film import film_profile
    from tribolab.lubrication.parameters import Interface, Liquid, Solver
    from tribolab.lubrication.relative_factors import relative_flow_factors
    from tribolab.lubrication.stribeck import stribeck_curve, with_shear_stress
    from tribolab.lubrication.viscosity import liquid_viscosity
    from tribolab.metrology.budget import uncertainty_budget
    from tribolab.metrology.dead_weight import dead_weight_gain
    from tribolab.qc.finding_table import objections
    from tribolab.qc.run.checks import RUN_CHECKS, check
    from tribolab.qc.scan.checks import check_scans
    from tribolab.qc.scan.sets import check_scan_set
    from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
    from tribolab.reading.run_files import read
    from tribolab.reading.scan_files import read_scans
    from tribolab.reading.unknown.proposal.draft import draft_dialect
    from tribolab.regime.model import Mode
    from tribolab.regime.several import sliding_modes
    from tribolab.regime.verdict import sliding_mode
    from tribolab.report.results_folder import read_results
    from tribolab.rubber.friction import viscoelastic_friction
    from tribolab.rubber.modulus import read_modulus
    from tribolab.rubber.prony import PronySeries
    from tribolab.rubber.temperature import WilliamsLandelFerry, flash_temperature, modulus_at
    from tribolab.rubber.two_bodies import RubberBody, two_body_friction
    from tribolab.surface.extrapolation import extrapolate
    from tribolab.surface.form import fill_dropouts, remove_form
    from tribolab.surface.roughness import roughness_parameters, spectral_roughness
    from tribolab.surface.self_affine import self_affine_psd
    from tribolab.surface.spectra.psd import psd_1d, psd_2d
    from tribolab.surface.synthesis import synthesise_map
    from tribolab.units.variable_table import variables


if "IPython" in sys.modules:
    from tribolab.units.display import show_units

    show_units()


accept_old_paths()


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module 'tribolab' has no attribute '{name}'")
    home = _PUBLIC[name]
    value = (
        getattr(importlib.import_module(home), name)
        if home
        else importlib.import_module(f"tribolab.{name}")
    )
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
