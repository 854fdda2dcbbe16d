"""Figures: one function per figure, a result in, a matplotlib Figure out."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribolab.plot.budget import uncertainty_budget
    from tribolab.plot.compared import differences, forest
    from tribolab.plot.contact import (
        adhesive_area,
        contact_area,
        contact_separation,
        effective_work,
        gaps,
        line_pressure,
    )
    from tribolab.plot.curves import half_loop, stribeck
    from tribolab.plot.film import film_profiles, lubrication_factors
    from tribolab.plot.joint import joint_fit
    from tribolab.plot.knobs import knobs
    from tribolab.plot.mixed import (
        friction_factor_effect,
        mixed_curve,
        shear_stress,
        shear_stress_over_speed,
    )
    from tribolab.plot.over_time import control
    from tribolab.plot.panels import strokes
    from tribolab.plot.planned import runs_needed
    from tribolab.plot.reduce import envelope
    from tribolab.plot.repeats import precision
    from tribolab.plot.runs import trace
    from tribolab.plot.sensitivity import model_sensitivity
    from tribolab.plot.slip_spectra import slip_spectra
    from tribolab.plot.spectrogram import slip_spectrogram
    from tribolab.plot.spread import friction_spread
    from tribolab.plot.starts import cycles, static_friction
    from tribolab.plot.stick_slip import Trace, slip_events, slip_traces, waveform_map
    from tribolab.plot.style import figure_data, paper_style, save, svg
    from tribolab.plot.surfaces import modulus, spectra, viscoelastic

# Loaded when first used: whoever wants a label waits for no matplotlib.
_HOMES = {
    "Trace": "tribolab.plot.stick_slip",
    "adhesive_area": "tribolab.plot.contact",
    "contact_area": "tribolab.plot.contact",
    "contact_separation": "tribolab.plot.contact",
    "effective_work": "tribolab.plot.contact",
    "control": "tribolab.plot.over_time",
    "cycles": "tribolab.plot.starts",
    "differences": "tribolab.plot.compared",
    "envelope": "tribolab.plot.reduce",
    "figure_data": "tribolab.plot.style",
    "film_profiles": "tribolab.plot.film",
    "forest": "tribolab.plot.compared",
    "friction_factor_effect": "tribolab.plot.mixed",
    "friction_spread": "tribolab.plot.spread",
    "gaps": "tribolab.plot.contact",
    "half_loop": "tribolab.plot.curves",
    "joint_fit": "tribolab.plot.joint",
    "knobs": "tribolab.plot.knobs",
    "line_pressure": "tribolab.plot.contact",
    "lubrication_factors": "tribolab.plot.film",
    "mixed_curve": "tribolab.plot.mixed",
    "model_sensitivity": "tribolab.plot.sensitivity",
    "modulus": "tribolab.plot.surfaces",
    "paper_style": "tribolab.plot.style",
    "precision": "tribolab.plot.repeats",
    "runs_needed": "tribolab.plot.planned",
    "save": "tribolab.plot.style",
    "shear_stress": "tribolab.plot.mixed",
    "shear_stress_over_speed": "tribolab.plot.mixed",
    "slip_events": "tribolab.plot.stick_slip",
    "slip_spectra": "tribolab.plot.slip_spectra",
    "slip_spectrogram": "tribolab.plot.spectrogram",
    "slip_traces": "tribolab.plot.stick_slip",
    "spectra": "tribolab.plot.surfaces",
    "static_friction": "tribolab.plot.starts",
    "stribeck": "tribolab.plot.curves",
    "strokes": "tribolab.plot.panels",
    "svg": "tribolab.plot.style",
    "trace": "tribolab.plot.runs",
    "uncertainty_budget": "tribolab.plot.budget",
    "viscoelastic": "tribolab.plot.surfaces",
    "waveform_map": "tribolab.plot.stick_slip",
}

__all__ = [
    "Trace",
    "adhesive_area",
    "contact_area",
    "contact_separation",
    "effective_work",
    "control",
    "cycles",
    "differences",
    "envelope",
    "figure_data",
    "film_profiles",
    "forest",
    "friction_factor_effect",
    "friction_spread",
    "gaps",
    "half_loop",
    "joint_fit",
    "knobs",
    "line_pressure",
    "lubrication_factors",
    "mixed_curve",
    "model_sensitivity",
    "modulus",
    "paper_style",
    "precision",
    "runs_needed",
    "save",
    "slip_events",
    "slip_spectra",
    "slip_spectrogram",
    "slip_traces",
    "shear_stress",
    "shear_stress_over_speed",
    "spectra",
    "strokes",
    "static_friction",
    "stribeck",
    "svg",
    "trace",
    "uncertainty_budget",
    "viscoelastic",
    "waveform_map",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tribolab.plot' has no attribute '{name}'")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
