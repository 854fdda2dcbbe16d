"""Figures: one function per figure, a result in, a matplotlib Figure out."""

from __future__ import annotations

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
from tribolab.plot.mixed import (
    friction_factor_effect,
    mixed_curve,
    shear_stress,
    shear_stress_over_speed,
)
from tribolab.plot.panels import strokes
from tribolab.plot.reduce import envelope
from tribolab.plot.runs import trace
from tribolab.plot.sensitivity import model_sensitivity
from tribolab.plot.spectrogram import slip_spectrogram
from tribolab.plot.stick_slip import Trace, slip_events, slip_spectra, slip_traces, waveform_map
from tribolab.plot.style import figure_data, paper_style, save, svg
from tribolab.plot.surfaces import modulus, spectra, viscoelastic

__all__ = [
    "Trace",
    "adhesive_area",
    "contact_area",
    "contact_separation",
    "effective_work",
    "envelope",
    "figure_data",
    "film_profiles",
    "friction_factor_effect",
    "gaps",
    "half_loop",
    "line_pressure",
    "lubrication_factors",
    "mixed_curve",
    "model_sensitivity",
    "modulus",
    "paper_style",
    "save",
    "slip_events",
    "slip_spectra",
    "slip_spectrogram",
    "slip_traces",
    "shear_stress",
    "shear_stress_over_speed",
    "spectra",
    "strokes",
    "stribeck",
    "svg",
    "trace",
    "viscoelastic",
    "waveform_map",
]
