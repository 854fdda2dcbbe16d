"""Figures: one function per figure, a result in, a matplotlib Figure out."""

from __future__ import annotations

from tribolab.plot.curves import half_loop, stribeck
from tribolab.plot.panels import strokes
from tribolab.plot.reduce import envelope
from tribolab.plot.runs import trace
from tribolab.plot.style import figure_data, paper_style, save, svg

__all__ = [
    "envelope",
    "figure_data",
    "half_loop",
    "save",
    "stribeck",
    "strokes",
    "paper_style",
    "svg",
    "trace",
]
