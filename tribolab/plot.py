"""Figures for notebooks and papers: each function draws a result and returns a Figure.

`tribolab.plot.stribeck.spec(curve)` describes the figure without drawing it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.figures.envelopes import envelope as envelope
    from tribolab.figures.look.controls import knobs as knobs
    from tribolab.figures.look.drawing import draw as draw
    from tribolab.figures.look.style import (
        figure_data as figure_data,
        paper_style as paper_style,
        save as save,
        svg as svg,
    )
    from tribolab.figures.subjects.adhesion import (
        adhesive_area as adhesive_area,
        effective_work as effective_work,
    )
    from tribolab.figures.subjects.comparison import (
        control as control,
        differences as differences,
        forest as forest,
    )
    from tribolab.figures.subjects.contact import (
        contact_area as contact_area,
        contact_separation as contact_separation,
        gaps as gaps,
        line_pressure as line_pressure,
    )
    from tribolab.figures.subjects.curves import stribeck as stribeck
    from tribolab.figures.subjects.film import (
        film_profiles as film_profiles,
        lubrication_factors as lubrication_factors,
    )
    from tribolab.figures.subjects.fits import (
        joint_fit as joint_fit,
        model_sensitivity as model_sensitivity,
    )
    from tribolab.figures.subjects.master import master_curve as master_curve
    from tribolab.figures.subjects.mixed import (
        friction_factor_effect as friction_factor_effect,
        mixed_curve as mixed_curve,
        shear_stress as shear_stress,
        shear_stress_over_speed as shear_stress_over_speed,
    )
    from tribolab.figures.subjects.planning import (
        precision as precision,
        runs_needed as runs_needed,
        uncertainty_budget as uncertainty_budget,
    )
    from tribolab.figures.subjects.signals_over_time import run as run
    from tribolab.figures.subjects.slip import (
        Trace as Trace,
        slip_events as slip_events,
        slip_traces as slip_traces,
        waveform_map as waveform_map,
    )
    from tribolab.figures.subjects.slip_spectrum import (
        slip_spectra as slip_spectra,
        slip_spectrogram as slip_spectrogram,
    )
    from tribolab.figures.subjects.spread import (
        friction_spread as friction_spread,
        half_loop as half_loop,
    )
    from tribolab.figures.subjects.starts import (
        cycles as cycles,
        static_friction as static_friction,
    )
    from tribolab.figures.subjects.stroke_loops import strokes as strokes
    from tribolab.figures.subjects.surfaces import (
        modulus as modulus,
        profiles as profiles,
        spectra as spectra,
        viscoelastic as viscoelastic,
    )
    from tribolab.figures.subjects.traces import trace as trace

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
