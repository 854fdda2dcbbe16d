"""Draw the figures of docs/theory.md on balls, outlets and layers, with numbers of other numerics.

Run from the project's root (half a minute)::

    PYTHONPATH=.:tests:tests/contact python tests/theory/theory_figures.py
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
from ball_cases import BALL, STRESS, TABLE, ball_psd
from contact_cases import CONTACT
from matplotlib.figure import Figure
from test_layers_and_liquids import LAYERS, OUTLETS, SPEEDS

from tribolab.contact.hertz import hertz_half_width
from tribolab.lubrication.parameters import Liquid, Solver
from tribolab.lubrication.stribeck import stribeck_curve

PICTURES = Path("docs/pictures")
STYLE = {"svg.fonttype": "none", "svg.hashsalt": "tribolab", "font.size": 9, "path.simplify": True}


def ball() -> None:
    """Draw a rough ball: table, rings and sectors, strips."""
    table = {v: wet + STRESS * area for v, (wet, area, _) in TABLE.items() if v > 0}
    speed = np.geomspace(1e-6, 1.0, 25)
    figure = Figure(figsize=(5, 3.2), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log")
    for method, style, words in (("full", "-", "rings and sectors"), ("strips", "--", "strips")):
        curve = stribeck_curve(BALL, ball_psd(), 1.0, 3.0, STRESS, speed, Solver(method=method))
        axes.plot(speed, curve.friction_coefficient, style, label=words)
    axes.plot(list(table), list(table.values()), "ko", ms=4, label="other numerics")
    axes.set(xlabel="ηv (N/m)", ylabel="µ", title="Rough ball, 3 N")
    _save(figure, "theory_ball.svg")


def outlet() -> None:
    """Draw a smooth cylinder with the outlet vented and flooded."""
    speed = np.geomspace(1e-4, 0.1, 25)
    figure = Figure(figsize=(5, 3.2), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log")
    liquids = (Liquid(1.4), Liquid(1.4, outlet="flooded"))
    points = (OUTLETS[None][0], OUTLETS[None][2])
    for liquid, known, style in zip(liquids, points, ("-", "--"), strict=True):
        curve = stribeck_curve(CONTACT, None, liquid, 310.0, 0.0, speed)
        axes.plot(speed, curve.friction_coefficient, style, label=liquid.outlet)
        axes.plot(SPEEDS, known, "ko", ms=4, label="" if style == "-" else "other numerics")
    axes.set(xlabel="v (m/s)", ylabel="µ", title="Smooth cylinder, 310 N/m, 1.4 Pa s")
    _save(figure, "theory_outlet.svg")


def layers() -> None:
    """Draw the half-width of a line contact on layers."""
    load = np.geomspace(200, 2500, 25)
    figure = Figure(figsize=(5, 3.2), layout="constrained")
    axes = figure.add_subplot()
    for thickness, (first, _, last, _) in LAYERS.items():
        layer = replace(CONTACT, thickness=thickness * 1e-3)
        axes.plot(load, 1e3 * hertz_half_width(load, layer), label=f"{thickness} mm")
        axes.plot([310, 2110], [first, last], "ko", ms=4)
    axes.plot(load, 1e3 * hertz_half_width(load, CONTACT), "k--", label="half-space (Hertz)")
    axes.set(xlabel="load (N/m)", ylabel="half-width a (mm)", title="Cylinder on a bonded layer")
    _save(figure, "theory_layers.svg")


def _save(figure: Figure, name: str) -> None:
    figure.axes[0].legend(frameon=False)
    with mpl.rc_context(STYLE):
        figure.savefig(PICTURES / name, metadata={"Date": None})
    print(f"{name}: {(PICTURES / name).stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    with mpl.rc_context(STYLE):
        layers()
        outlet()
        ball()
