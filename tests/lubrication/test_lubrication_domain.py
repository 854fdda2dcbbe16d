"""mu(v) is that of the speed alone: mesh and domain by its film, the rest in closed form."""

import numpy as np
import pytest
from contact_cases import CONTACT, RandomContact, reference_psd
from scipy.integrate import quad

from tribolab.contact.geometry import LineContact
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.domain import _tail, film_estimate
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.parabolas import lowest
from tribolab.lubrication.stribeck import stribeck_curve


def friction(name, speeds, load=310.0, **more):
    psd = reference_psd(name) if name else None
    return stribeck_curve(CONTACT, psd, 1.4, load, 0.84e6, speeds, **more).friction_coefficient


@pytest.mark.slow
@pytest.mark.parametrize(("name", "load"), [("Smooth", 2110.0), ("Sb-S", 310.0)])
def test_friction_at_a_speed_is_that_of_the_speed_alone(name, load):
    """Whatever the list ends with: it was 0.01877 to 0.01964 for Sb-S at 310 N/m and 1 cm/s."""
    asked = [1e-3, 1e-2]
    mu = [
        friction(name, [*asked, *others], load).sel(sliding_speed=asked).values
        for others in ([], [1e-7], [0.1], [0.3, 10.0])
    ]
    np.testing.assert_allclose(mu, np.broadcast_to(mu[0], (4, 2)), rtol=1e-7)


def test_so_is_the_film():
    curve = stribeck_curve(CONTACT, reference_psd("Sb-S"), 1.4, 310.0, 0.0, [1e-4, 1e-3, 1.0])
    film = film_profile(CONTACT, reference_psd("Sb-S"), 1.4, 310.0, 1e-3)
    least = lowest(film.x.values, film.separation.values)
    assert least == pytest.approx(float(curve.minimum_separation[1]), rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "load"), [("Smooth", 2110.0), ("Sb-S", 310.0), ("Sb-R", 310.0)])
def test_friction_and_film_are_converged_up_to_a_metre_a_second(name, load):
    """Against 300 reaches of the film on more cells; at 0.1 m/s it was 8 % low."""
    speeds = [1e-5, 1e-3, 1e-2, 1e-1, 1.0]
    psd = reference_psd(name)
    ours, brute = (
        stribeck_curve(CONTACT, psd, 1.4, load, 0.84e6, speeds, **more)
        for more in ({}, {"domain": 5.0, "cells": 500})
    )
    for part, within in (("friction_coefficient", 2e-3), ("minimum_separation", 3e-3)):
        np.testing.assert_allclose(ours[part], brute[part], rtol=within)


@pytest.mark.slow
def test_friction_is_converged_where_the_film_ruptures_within_the_roughness():
    """Liquid covers all of the flat there, as before: else the place of one face told 0.3 %."""
    contact = RandomContact("Smooth", 31e6, 7.65, 669.0, 25e-6)
    speeds = np.array([3.16e-3, 1e-2])
    ours, fine = (contact.curve(speeds, cells).friction_coefficient for cells in (160, 300))
    np.testing.assert_allclose(ours, fine, rtol=3e-4)


def test_a_short_domain_and_a_long_one_are_the_same():
    """What is not solved is known: 12, 60 and 120 reaches of the film."""
    speeds = [1e-4, 1e-2, 1e-1, 1.0]
    short, default, long = (
        friction("Smooth", speeds, domain=domain).values for domain in (0.2, 1.0, 2.0)
    )
    np.testing.assert_allclose(short, default, rtol=3e-3)
    np.testing.assert_allclose(long, default, rtol=5e-4)


def test_the_rigid_limit_is_the_closed_form():
    """Cylinder and plane, p = 0 far before and the film ruptured behind.

    Load 2.44748 eta v R/h0, h*/h0 = 1.22575, drag over eta v sqrt(R/h0): 2.84872 by shear,
    0.64105 by the streamers in the cavity, 2.30054 by the gradient of the pressure.
    """
    stiff = LineContact(0.07, 0.1, "100 GPa", 0.5)
    curve = stribeck_curve(stiff, None, 1.4, 310.0, 0.0, [3e-3, 1e-1])
    film = curve.minimum_separation.values
    rate = 1.4 * curve.sliding_speed.values
    np.testing.assert_allclose(310.0 * film / (rate * 0.07), 2.44748, rtol=1e-3)
    np.testing.assert_allclose(
        curve.friction_coefficient, 2.36582 * np.sqrt(film / 0.07), rtol=1e-3
    )
    unit = rate * np.sqrt(0.07 / film) / 310.0
    for part, value in (("couette", 2.84872 + 0.64105), ("pressure", 2.30054)):
        np.testing.assert_allclose(curve[f"friction_coefficient_{part}"] / unit, value, rtol=1e-3)
    found = film_profile(stiff, None, 1.4, 310.0, 1e-1)
    filled = 2 * float(found.flux) / 0.1 / float(found.separation.min())
    assert filled == pytest.approx(1.22575, rel=1e-3)


@pytest.mark.parametrize("name", [None, "Sb-S"])
def test_friction_does_not_jump_where_the_mesh_changes(name):
    """Films under and above the gap of the contact take different meshes."""
    low, high = 1e-3, 10.0
    gap = 310.0 * 4 * CONTACT.radius / (np.pi * CONTACT.effective_modulus) / (2 * CONTACT.radius)
    for _ in range(60):
        middle = np.sqrt(low * high)
        above = film_estimate(CONTACT, 1.4, 310.0, middle) > gap
        low, high = (low, middle) if above else (middle, high)
    around = low * np.geomspace(0.8, 1.25, 12)
    mu = np.log(friction(name, around).values)
    smooth = np.polyval(np.polyfit(np.log(around), mu, 2), np.log(around))
    assert np.max(np.abs(mu - smooth)) < 5e-4


@pytest.mark.parametrize("constant", [-30.0, 0.0, 0.3, 400.0])
@pytest.mark.parametrize("power", [1, 2])
def test_the_tails_are_the_integrals(constant, power):
    start = 12.0
    exact = quad(lambda x: (constant + x**2) ** -power, start, np.inf, epsabs=0, epsrel=1e-10)[0]
    assert _tail(power, start, constant) == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize(("length", "lower"), [("20 mm", (0.06, 0.15)), ("70 mm", (0.02, 0.05))])
def test_liquid_that_begins_near_the_contact_drags_less(length, lower):
    """At 1e-2 and 1e-1 m/s, to the percent."""
    full = friction("Smooth", [1e-2, 1e-1])
    cut = friction("Smooth", [1e-2, 1e-1], inlet_length=length)
    np.testing.assert_allclose(1 - cut / full, lower, atol=0.01)


def test_liquid_that_begins_far_away_is_everywhere():
    """Towards the limit as 8 eta v R/(W X)."""
    full = friction("Sb-S", [1e-1])
    far = friction("Sb-S", [1e-1], inlet_length=3.0)
    missing = 8 * 1.4 * 0.1 * 0.07 / (310.0 * 3.0)
    assert float(full[0] - far[0]) == pytest.approx(missing, rel=0.15)


def test_liquid_must_begin_before_the_contact():
    with pytest.raises(AnalysisError, match="inlet_length: the liquid must begin more than 1.5"):
        friction("Sb-S", [1e-3], inlet_length="4 mm")
