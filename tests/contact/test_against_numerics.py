"""Balls, outlets, layers and thinning liquids against tables made by numerics of their own."""

from dataclasses import replace

import numpy as np
import pytest
from ball_cases import BALL, COARSE, STRESS, ball_psd
from contact_cases import CONTACT, reference_psd

from tribolab.contact.geometry import PointContact
from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure, jkr_half_width
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.parameters import Interface, Liquid, Solver
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.lubrication.thinning import carreau_yasuda

SCALED = PointContact(1.0, 0.75, 0.5)  # E* = 1, E' = 2
SPEEDS = [1e-4, 1e-3, 1e-2, 0.1]
WET = Liquid(1.4, outlet="flooded")


def conserved(curve):
    return max(abs(curve[name]).max() for name in ("load_balance", "flux_variation")) < 1e-8


def test_jkr_of_a_ball_at_any_load():
    load, work = np.array([0.0, 0.01, 3.0]), 0.05
    pull = 3 * np.pi * work * BALL.radius
    size = load + pull + np.sqrt(2 * pull * load + pull**2)
    expected = (0.75 * BALL.radius / BALL.effective_modulus * size) ** (1 / 3)
    found = [jkr_half_width(float(force), BALL, work) for force in load]
    assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow
def test_soft_balls_have_the_films_and_drag_of_the_formulas_for_them():
    """Ratios to Hamrock and Dowson, and to de Vicente et al., differ with speed as stated."""
    load, speed = 1.2e-2, np.array([2e-8, 2e-7, 2e-6, 2e-5])
    curve = stribeck_curve(SCALED, None, 1.0, 2 * load, 0.0, 4 * speed)
    centre, least = curve.central_separation.values, curve.minimum_separation.values
    middle = 7.32 * (1 - 0.72 * np.exp(-0.28)) * speed**0.64 * load**-0.22
    lowest = 7.43 * (1 - 0.85 * np.exp(-0.31)) * speed**0.65 * load**-0.21
    assert centre / middle == pytest.approx([1.42, 1.27, 1.13, 1.01], rel=0.01)
    assert least / lowest == pytest.approx([0.89, 1.00, 1.07, 1.04], rel=0.01)
    assert centre / (3.3 * speed**0.6 * load**-0.14) == pytest.approx(1, abs=0.06)
    rolling = stribeck_curve(SCALED, None, 1.0, 2 * load, Interface(0.0, slide_roll=1.0), 2 * speed)
    sheared = 3.8 * speed**0.71 * load**-0.76 + 0.96 * speed**0.36 * load**-0.11
    assert rolling.friction_coefficient.values / sheared == pytest.approx(0.9, abs=0.04)
    resisted = abs(rolling.friction_coefficient_pressure.values) / (
        1.46 * speed**0.65 * load**-0.70
    )
    assert resisted[2] == pytest.approx(0.99, abs=0.01)
    assert conserved(curve) and conserved(rolling)


@pytest.mark.slow
def test_strips_are_too_low_at_a_light_load_beyond_their_limit():
    speeds = [1e-4, 3e-3, 1e-2, 1.0]
    full, strips = (
        stribeck_curve(
            BALL, ball_psd(), 1.0, 0.3, STRESS, speeds, Solver(cells=110, method=method)
        ).friction_coefficient.values
        for method in ("full", "strips")
    )
    ratio = strips / full
    assert np.all((ratio[:2] > 0.925) & (ratio[:2] < 1.005))
    assert ratio[2:] == pytest.approx([0.83, 0.5], abs=0.015)


@pytest.mark.parametrize(
    ("name", "liquid", "films"),
    [
        (None, Liquid(1.4), [1.444, 5.889, 24.97, 117.8]),
        (None, WET, [1.372, 5.568, 23.13, 98.4]),
        ("Sb-S", Liquid(1.4), [3.090, 6.808, 25.28, 117.9]),
        ("Sb-S", WET, [3.020, 6.497, 23.46, 98.5]),
    ],
)
def test_films_with_vented_and_flooded_outlets(name, liquid, films):
    psd = None if name is None else reference_psd(name)
    curve = stribeck_curve(CONTACT, psd, liquid, 310.0, 0.0, SPEEDS)
    assert curve.minimum_separation.values * 1e6 == pytest.approx(films, rel=2e-3)
    assert conserved(curve)


@pytest.mark.parametrize(
    ("load", "lowest", "more"),
    [
        (310.0, [-9, -13, -19, -26], [1.108, 1.221, 1.394, 1.624]),
        (2110.0, [-11, -17, -27, -39], [1.03, 1.06, 1.14, 1.27]),
    ],
)
def test_tension_behind_a_smooth_cylinder(load, lowest, more):
    vented, flooded = (
        stribeck_curve(CONTACT, None, liquid, load, 0.0, SPEEDS) for liquid in (Liquid(1.4), WET)
    )
    ratio = flooded.friction_coefficient.values / vented.friction_coefficient.values
    assert ratio == pytest.approx(more, abs=0.005)
    profiles = [film_profile(CONTACT, None, WET, load, speed) for speed in SPEEDS]
    kilopascal = [float(profile.fluid_pressure.min()) / 1e3 for profile in profiles]
    assert kilopascal == pytest.approx(lowest, rel=0.06)


@pytest.mark.parametrize(
    ("thickness", "expected"),
    [
        (2, (3.4672, 187.1, 4.0463, 270.6)),
        (5, (4.7255, 128.3, 5.6362, 181.7)),
        (10, (5.5744, 105.1, 6.8190, 143.9)),
        (20, (6.0891, 95.28, 7.6586, 125.9)),
        (np.inf, (6.3681, 90.97, 8.2031, 117.2)),
    ],
)
def test_layers_at_the_middle_loads(thickness, expected):
    layer, loads = replace(CONTACT, thickness=thickness * 1e-3), np.array([910.0, 1510.0])
    found = np.stack([hertz_half_width(loads, layer) * 1e3, hertz_max_pressure(loads, layer) / 1e3])
    assert found.T.ravel() == pytest.approx(expected, rel=1e-3)


@pytest.mark.slow
def test_load_and_flux_are_conserved_with_every_option():
    ball = replace(BALL, thickness=2e-3, counter_modulus=3e6)
    thinning = Liquid(1.0, thinning=carreau_yasuda("10 s", 0.4, rest=0.002))
    curves = [
        stribeck_curve(ball, None, 1.0, 3.0, 0.0, [1e-3], COARSE),
        stribeck_curve(BALL, None, thinning, 3.0, 0.0, [1e-2], COARSE),
        stribeck_curve(CONTACT, reference_psd("Sb-S"), thinning, 310.0, 0.0, SPEEDS),
        stribeck_curve(replace(CONTACT, thickness=5e-3), None, WET, 310.0, 0.0, SPEEDS),
        stribeck_curve(CONTACT, None, 1.4, 310.0, Interface(0.0, slide_roll=0.5), SPEEDS),
    ]
    assert [conserved(curve) for curve in curves] == [True] * len(curves)


@pytest.mark.slow
@pytest.mark.parametrize("contact", [CONTACT, SCALED])
def test_smooth_contacts_of_all_loads_have_one_curve(contact):
    """mu R/a is a function of eta v R^3/(E* a^4)."""
    loads = (310.0, 1000.0) if contact is CONTACT else (2e-3, 6e-3)
    reduced = []
    for load in loads:
        a = float(hertz_half_width(load, contact))
        speed = 1e-4 * contact.effective_modulus * a**4 / contact.radius**3
        liquid = Liquid(1.0, extent=(8 if contact.is_round else 40) * a)  # scales, too
        curve = stribeck_curve(contact, None, liquid, load, 0.0, [speed], COARSE)
        reduced.append(float(curve.friction_coefficient[0]) * contact.radius / a)
    assert reduced[0] == pytest.approx(reduced[1], rel=2e-3)
