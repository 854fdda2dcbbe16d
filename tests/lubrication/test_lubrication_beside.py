"""Curves that start from the films of a like contact: the same curves, in fewer steps."""

from dataclasses import replace

import numpy as np
import pytest
from contact_cases import CONTACT, reference_psd

from tribolab.contact.geometry import LineContact
from tribolab.lubrication.factors import flow_factors
from tribolab.lubrication.parameters import parameters_of
from tribolab.lubrication.solved_curve import solve_curve

SPEEDS = np.geomspace(1e-9, 1e-1, 17)
NUMBERS = (
    "friction_coefficient",
    "friction_per_shear_stress",
    "minimum_separation",
    "solid_load_share",
)


def solved(near=None, *, name="Sb-S", speed=SPEEDS, contact=CONTACT, load=910.0, **changed):
    given = {"viscosity": 1.4, "shear_stress": 1e6, "cells": 100} | changed
    psd = None if name is None else reference_psd(name)
    parameters = parameters_of(given.pop("viscosity"), given.pop("shear_stress"), **given)
    return solve_curve(contact, psd, load, speed, parameters, near)


def assert_same(curve, other):
    for name in NUMBERS:
        np.testing.assert_allclose(curve[name], other[name], rtol=1e-6, err_msg=name)


@pytest.fixture(scope="module")
def start():
    return solved()


@pytest.mark.parametrize(
    "changed",
    [
        {"viscosity": 1.9},
        {"rough_body": "moving"},
        {"contact": replace(CONTACT, youngs_modulus=1.02 * CONTACT.youngs_modulus)},
        {"load": 930.0},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_like_contact_gives_the_same_curve_in_fewer_steps(start, changed):
    alone, beside = solved(**changed).curve, solved(start, **changed).curve
    assert_same(beside, alone)
    assert beside.iterations.sum() < 0.9 * alone.iterations.sum()
    assert float(np.abs(beside.residual).max()) < 1e-8


def test_where_only_the_shear_of_thin_gaps_changes_the_films_are_there(start):
    factors = flow_factors(reference_psd("Sb-S"), cutoff=3e-9)
    alone, beside = solved(factors=factors).curve, solved(start, factors=factors).curve
    assert_same(beside, alone)
    assert beside.iterations.sum() < alone.iterations.sum() / 3


@pytest.mark.parametrize(
    "changed",
    [
        {"viscosity": 1e-3},
        {"name": "Smooth"},
        {"name": None, "speed": SPEEDS[8:]},
        {"load": 2110.0},
        {"contact": LineContact("2 cm", "10 cm", "4 MPa", 0.5)},
        {"inlet_length": 0.02},
        {"cells": 130},
        {"speed": np.append(SPEEDS, 0.5)},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_contact_that_is_not_alike_does_no_harm(start, changed):
    assert_same(solved(start, **changed).curve, solved(**changed).curve)


def test_a_curve_from_rest_on_and_backwards_may_start_there_too(start):
    speed = np.append([0.0], -SPEEDS)
    assert_same(solved(start, speed=speed).curve, solved(speed=speed).curve)
