"""Figures: one function per figure, a result in, a matplotlib Figure out.

Each function also describes its figure without drawing it: `tribolab.plot.stribeck.spec(curve)`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribolab.figures.envelopes import envelope
    from tribolab.figures.look.controls import knobs
    from tribolab.figures.look.drawing import draw
    from tribolab.figures.look.style import figure_data, paper_style, save, svg
    from tribolab.figures.subjects.adhesion import adhesive_area, effective_work
    from tribolab.figures.subjects.comparison import control, differences, forest
    from tribolab.figures.subjects.contact import (
        contact_area,
        contact_separation,
        gaps,
        line_pressure,
    )
    from tribolab.figures.subjects.curves import stribeck
    from tribolab.figures.subjects.film import film_profiles, lubrication_factors
    from tribolab.figures.subjects.fits import joint_fit, model_sensitivity
    from tribolab.figures.subjects.master import master_curve
    from tribolab.figures.subjects.mixed import (
        friction_factor_effect,
        mixed_curve,
        shear_stress,
        shear_stress_over_speed,
    )
    from tribolab.figures.subjects.planning import precision, runs_needed, uncertainty_budget
    from tribolab.figures.subjects.signals_over_time import run
    from tribolab.figures.subjects.slip import Trace, slip_events, slip_traces, waveform_map
    from tribolab.figures.subjects.slip_spectrum import slip_spectra, slip_spectrogram
    from tribolab.figures.subjects.spread import friction_spread, half_loop
    from tribolab.figures.subjects.starts import cycles, static_friction
    from tribolab.figures.subjects.stroke_loops import strokes
    from tribolab.figures.subjects.surfaces import modulus, profiles, spectra, viscoelastic
    from tribolab.figures.subjects.traces import trace

# Loaded when first used: whoever wants a label waits for no matplotlib.
_HOMES = {
    "envelope": "tribolab.figures.envelopes",
    "draw": "tribolab.figures.look.drawing",
    "knobs": "tribolab.figures.look.controls",
    "figure_data": "tribolab.figures.look.style",
    "paper_style": "tribolab.figures.look.style",
    "save": "tribolab.figures.look.style",
    "svg": "tribolab.figures.look.style",
    "adhesive_area": "tribolab.figures.subjects.adhesion",
    "effective_work": "tribolab.figures.subjects.adhesion",
    "control": "tribolab.figures.subjects.comparison",
    "differences": "tribolab.figures.subjects.comparison",
    "forest": "tribolab.figures.subjects.comparison",
    "contact_area": "tribolab.figures.subjects.contact",
    "contact_separation": "tribolab.figures.subjects.contact",
    "gaps": "tribolab.figures.subjects.contact",
    "line_pressure": "tribolab.figures.subjects.contact",
    "stribeck": "tribolab.figures.subjects.curves",
    "film_profiles": "tribolab.figures.subjects.film",
    "lubrication_factors": "tribolab.figures.subjects.film",
    "joint_fit": "tribolab.figures.subjects.fits",
    "model_sensitivity": "tribolab.figures.subjects.fits",
    "master_curve": "tribolab.figures.subjects.master",
    "friction_factor_effect": "tribolab.figures.subjects.mixed",
    "mixed_curve": "tribolab.figures.subjects.mixed",
    "shear_stress": "tribolab.figures.subjects.mixed",
    "shear_stress_over_speed": "tribolab.figures.subjects.mixed",
    "precision": "tribolab.figures.subjects.planning",
    "runs_needed": "tribolab.figures.subjects.planning",
    "uncertainty_budget": "tribolab.figures.subjects.planning",
    "run": "tribolab.figures.subjects.signals_over_time",
    "Trace": "tribolab.figures.subjects.slip",
    "slip_events": "tribolab.figures.subjects.slip",
    "slip_traces": "tribolab.figures.subjects.slip",
    "waveform_map": "tribolab.figures.subjects.slip",
    "slip_spectra": "tribolab.figures.subjects.slip_spectrum",
    "slip_spectrogram": "tribolab.figures.subjects.slip_spectrum",
    "friction_spread": "tribolab.figures.subjects.spread",
    "half_loop": "tribolab.figures.subjects.spread",
    "cycles": "tribolab.figures.subjects.starts",
    "static_friction": "tribolab.figures.subjects.starts",
    "strokes": "tribolab.figures.subjects.stroke_loops",
    "modulus": "tribolab.figures.subjects.surfaces",
    "profiles": "tribolab.figures.subjects.surfaces",
    "spectra": "tribolab.figures.subjects.surfaces",
    "viscoelastic": "tribolab.figures.subjects.surfaces",
    "trace": "tribolab.figures.subjects.traces",
}

__all__ = [
    "Trace",
    "adhesive_area",
    "contact_area",
    "contact_separation",
    "control",
    "cycles",
    "differences",
    "draw",
    "effective_work",
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
    "master_curve",
    "mixed_curve",
    "model_sensitivity",
    "modulus",
    "paper_style",
    "precision",
    "profiles",
    "run",
    "runs_needed",
    "save",
    "shear_stress",
    "shear_stress_over_speed",
    "slip_events",
    "slip_spectra",
    "slip_spectrogram",
    "slip_traces",
    "spectra",
    "static_friction",
    "stribeck",
    "strokes",
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
