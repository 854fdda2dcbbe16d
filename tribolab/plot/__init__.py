"""Figures: one function per figure, a result in, a matplotlib Figure out.

Each function also describes its figure without drawing it: `tribolab.plot.stribeck.spec(curve)`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribolab.figures.comparison import (
        control,
        differences,
        forest,
        precision,
        runs_needed,
        uncertainty_budget,
    )
    from tribolab.figures.contact import (
        adhesive_area,
        contact_area,
        contact_separation,
        effective_work,
        gaps,
        line_pressure,
    )
    from tribolab.figures.curves import friction_spread, half_loop, stribeck
    from tribolab.figures.envelope import envelope
    from tribolab.figures.film import film_profiles, lubrication_factors
    from tribolab.figures.fits import joint_fit, model_sensitivity
    from tribolab.figures.look.draw import draw
    from tribolab.figures.look.knobs import knobs
    from tribolab.figures.look.style import figure_data, paper_style, save, svg
    from tribolab.figures.master import master_curve
    from tribolab.figures.mixed import (
        friction_factor_effect,
        mixed_curve,
        shear_stress,
        shear_stress_over_speed,
    )
    from tribolab.figures.slip import Trace, slip_events, slip_traces, waveform_map
    from tribolab.figures.slip_spectra import slip_spectra, slip_spectrogram
    from tribolab.figures.starts import cycles, static_friction
    from tribolab.figures.surfaces import modulus, profiles, spectra, viscoelastic
    from tribolab.figures.trace import strokes, trace

# Loaded when first used: whoever wants a label waits for no matplotlib.
_HOMES = {
    "control": "tribolab.figures.comparison",
    "differences": "tribolab.figures.comparison",
    "forest": "tribolab.figures.comparison",
    "precision": "tribolab.figures.comparison",
    "runs_needed": "tribolab.figures.comparison",
    "uncertainty_budget": "tribolab.figures.comparison",
    "adhesive_area": "tribolab.figures.contact",
    "contact_area": "tribolab.figures.contact",
    "contact_separation": "tribolab.figures.contact",
    "effective_work": "tribolab.figures.contact",
    "gaps": "tribolab.figures.contact",
    "line_pressure": "tribolab.figures.contact",
    "friction_spread": "tribolab.figures.curves",
    "half_loop": "tribolab.figures.curves",
    "stribeck": "tribolab.figures.curves",
    "envelope": "tribolab.figures.envelope",
    "film_profiles": "tribolab.figures.film",
    "lubrication_factors": "tribolab.figures.film",
    "joint_fit": "tribolab.figures.fits",
    "model_sensitivity": "tribolab.figures.fits",
    "draw": "tribolab.figures.look.draw",
    "knobs": "tribolab.figures.look.knobs",
    "figure_data": "tribolab.figures.look.style",
    "paper_style": "tribolab.figures.look.style",
    "save": "tribolab.figures.look.style",
    "svg": "tribolab.figures.look.style",
    "master_curve": "tribolab.figures.master",
    "friction_factor_effect": "tribolab.figures.mixed",
    "mixed_curve": "tribolab.figures.mixed",
    "shear_stress": "tribolab.figures.mixed",
    "shear_stress_over_speed": "tribolab.figures.mixed",
    "Trace": "tribolab.figures.slip",
    "slip_events": "tribolab.figures.slip",
    "slip_traces": "tribolab.figures.slip",
    "waveform_map": "tribolab.figures.slip",
    "slip_spectra": "tribolab.figures.slip_spectra",
    "slip_spectrogram": "tribolab.figures.slip_spectra",
    "cycles": "tribolab.figures.starts",
    "static_friction": "tribolab.figures.starts",
    "modulus": "tribolab.figures.surfaces",
    "profiles": "tribolab.figures.surfaces",
    "spectra": "tribolab.figures.surfaces",
    "viscoelastic": "tribolab.figures.surfaces",
    "strokes": "tribolab.figures.trace",
    "trace": "tribolab.figures.trace",
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
    "mixed_curve",
    "model_sensitivity",
    "master_curve",
    "modulus",
    "paper_style",
    "precision",
    "profiles",
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
