"""Figures: one function per figure, a result in, a matplotlib Figure out."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribolab.figures.curves import friction_spread, half_loop, stribeck
    from tribolab.figures.envelope import envelope
    from tribolab.figures.look.knobs import knobs
    from tribolab.figures.look.style import figure_data, paper_style, save, svg
    from tribolab.plot.metrology.budget import uncertainty_budget
    from tribolab.plot.metrology.compared import differences, forest
    from tribolab.plot.metrology.over_time import control
    from tribolab.plot.metrology.planned import runs_needed
    from tribolab.plot.metrology.repeats import precision
    from tribolab.plot.model.film import film_profiles, lubrication_factors
    from tribolab.plot.model.joint import joint_fit
    from tribolab.plot.model.mixed import (
        friction_factor_effect,
        mixed_curve,
        shear_stress,
        shear_stress_over_speed,
    )
    from tribolab.plot.model.sensitivity import model_sensitivity
    from tribolab.plot.runs.starts import cycles, static_friction
    from tribolab.plot.runs.strokes import strokes
    from tribolab.plot.runs.trace import trace
    from tribolab.plot.slip.spectra import slip_spectra
    from tribolab.plot.slip.spectrogram import slip_spectrogram
    from tribolab.plot.slip.stick_slip import Trace, slip_events, slip_traces, waveform_map
    from tribolab.plot.surface.contact import (
        adhesive_area,
        contact_area,
        contact_separation,
        effective_work,
        gaps,
        line_pressure,
    )
    from tribolab.plot.surface.spectra import modulus, spectra, viscoelastic

# Loaded when first used: whoever wants a label waits for no matplotlib.
_HOMES = {
    "Trace": "tribolab.plot.slip.stick_slip",
    "adhesive_area": "tribolab.plot.surface.contact",
    "contact_area": "tribolab.plot.surface.contact",
    "contact_separation": "tribolab.plot.surface.contact",
    "effective_work": "tribolab.plot.surface.contact",
    "control": "tribolab.plot.metrology.over_time",
    "cycles": "tribolab.plot.runs.starts",
    "differences": "tribolab.plot.metrology.compared",
    "envelope": "tribolab.figures.envelope",
    "figure_data": "tribolab.figures.look.style",
    "film_profiles": "tribolab.plot.model.film",
    "forest": "tribolab.plot.metrology.compared",
    "friction_factor_effect": "tribolab.plot.model.mixed",
    "friction_spread": "tribolab.figures.curves",
    "gaps": "tribolab.plot.surface.contact",
    "half_loop": "tribolab.figures.curves",
    "joint_fit": "tribolab.plot.model.joint",
    "knobs": "tribolab.figures.look.knobs",
    "line_pressure": "tribolab.plot.surface.contact",
    "lubrication_factors": "tribolab.plot.model.film",
    "mixed_curve": "tribolab.plot.model.mixed",
    "model_sensitivity": "tribolab.plot.model.sensitivity",
    "modulus": "tribolab.plot.surface.spectra",
    "paper_style": "tribolab.figures.look.style",
    "precision": "tribolab.plot.metrology.repeats",
    "runs_needed": "tribolab.plot.metrology.planned",
    "save": "tribolab.figures.look.style",
    "shear_stress": "tribolab.plot.model.mixed",
    "shear_stress_over_speed": "tribolab.plot.model.mixed",
    "slip_events": "tribolab.plot.slip.stick_slip",
    "slip_spectra": "tribolab.plot.slip.spectra",
    "slip_spectrogram": "tribolab.plot.slip.spectrogram",
    "slip_traces": "tribolab.plot.slip.stick_slip",
    "spectra": "tribolab.plot.surface.spectra",
    "static_friction": "tribolab.plot.runs.starts",
    "stribeck": "tribolab.figures.curves",
    "strokes": "tribolab.plot.runs.strokes",
    "svg": "tribolab.figures.look.style",
    "trace": "tribolab.plot.runs.trace",
    "uncertainty_budget": "tribolab.plot.metrology.budget",
    "viscoelastic": "tribolab.plot.surface.spectra",
    "waveform_map": "tribolab.plot.slip.stick_slip",
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
