"""How often the interval of a shear stress holds the truth, of simulated balls on discs.

Each seed draws a machine: shear stress 0.15 to 0.6 MPa, a viscosity that lies off what is stated by
10 %, a level of each run (3 %) and noise of each row (2 %). The rig writes three runs in the format
of a mini traction machine; they are read, made a curve at the slide-roll ratio of the Stribeck
step, and fitted with the model of the stated viscosity. Intervals should hold the truth in 93 to
97 %; of 60 seeds that is 56 to 58, and chance alone leaves 53 to 60 in 95 % of such tests.

Run from the project's root::

    python tests/coverage/ball_coverage.py [seeds] [first seed]
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

import tribolab as tl
from tribolab.contact.geometry import PointContact
from tribolab.fit.fit_settings import FitSettings
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.friction.coefficient.repeatability import pooled_repeatability, run_levels
from tribolab.friction.traction import stribeck_part
from tribolab.rig import MiniTraction
from tribolab.rig.mini_traction import mini_traction_text
from tribolab.studies import xu2026

STATED = MiniTraction(traction_ratios=())
VISCOSITY_ERROR, RUNS = 0.10, 3


def computed(speed: np.ndarray) -> xr.Dataset:
    """Return the model of the stated viscosity over sliding speeds [m/s], without shear stress."""
    rolling = speed / STATED.slide_roll
    with_stress = replace(STATED, shear_stress=1.0)
    fluid, whole = (
        machine.friction(rolling, STATED.slide_roll, STATED.viscosity)
        for machine in (replace(STATED, shear_stress=0.0), with_stress)
    )
    return xr.Dataset(
        {
            "friction_coefficient": ("sliding_speed", fluid),
            "friction_without_factors": ("sliding_speed", fluid),
            "friction_per_shear_stress": ("sliding_speed", whole - fluid),
        },
        {"sliding_speed": speed},
        {"viscosity_Pa_s": STATED.viscosity, "shear_stress_Pa": 0.0},
    )


def one_machine(seed: int) -> tuple[float, float, float]:
    """Return the fitted shear stress, half its interval, and the true one [Pa]."""
    random = np.random.default_rng([seed, 44])
    machine = replace(
        STATED,
        shear_stress=float(np.exp(random.uniform(np.log(0.15e6), np.log(0.6e6)))),
        viscosity=STATED.viscosity * float(np.exp(VISCOSITY_ERROR * random.standard_normal())),
    )
    frictions = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(RUNS):
            file = Path(folder) / f"run_{number}.txt"
            file.write_text(mini_traction_text(machine, 100 * seed + number), "utf-8")
            run = tl.read(file)
            frictions.append(tl.friction_coefficient(run, tl.find_segments(run)))
    parts, _ = stribeck_part(frictions)
    measured = tl.measured_stribeck_curve(parts)
    spread, freedom = pooled_repeatability([run_levels(parts)])
    fit = fit_shear_stress(
        measured,
        PointContact(machine.radius, machine.youngs_modulus, 0.5),
        xu2026.psd(machine.surface),
        STATED.viscosity,
        machine.normal_force,
        settings=FitSettings(
            common_error=spread / np.sqrt(RUNS),
            common_freedom=freedom,
            curve=computed(measured["sliding_speed"].values),
            abscissa_error=VISCOSITY_ERROR,
        ),
    )
    return fit.shear_stress, fit.half_interval, machine.shear_stress


def main(seeds: int = 60, first: int = 0) -> None:
    """Print each fit, and the share of the intervals that hold the truth."""
    held = []
    for seed in range(first, first + seeds):
        stress, half, true = one_machine(seed)
        held.append(abs(stress - true) <= half)
        print(
            f"seed {seed}: {stress / true - 1:+.1%} off, half interval {half / true:.1%}"
            f"{'' if held[-1] else '  MISSED'}",
            flush=True,
        )
    print(f"{sum(held)} of {len(held)} intervals hold the truth ({np.mean(held):.1%})")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
