"""Sizes of effects that a model leaves out, against numerics of their own and closed forms."""

import re

import numpy as np
import pytest
from contact_cases import CONTACT, reference_psd

from tribolab.contact.geometry import PointContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.fit.left_out import effects_not_modelled
from tribolab.surface.moments import rms_roughness

LOAD = 310.0


def sizes(*given):
    return {effect.name: effect.size for effect in effects_not_modelled(*given)}


def numbers(text):
    return [float(found) for found in re.findall(r"\d+\.?\d*(?:e[+-]?\d+)?", text)]


@pytest.fixture(scope="module")
def line():
    """Indentation of a half-space along a contact of uniform width: matrix, positions, a."""
    a, cells = float(hertz_half_width(LOAD, CONTACT)), 300
    cell = CONTACT.length / cells
    s = (np.arange(cells) + 0.5) * cell - CONTACT.length / 2
    turn = (np.arange(200) + 0.5) / 200 * np.pi
    x, weight = np.abs(a * np.cos(turn)), np.sin(turn) ** 2
    far = np.arange(cells)[:, None] * cell
    kernel = np.arcsinh((far + cell / 2) / x) - np.arcsinh((far - cell / 2) / x)
    row = kernel @ weight / weight.sum()
    return row[np.abs(np.subtract.outer(np.arange(cells), np.arange(cells)))], s, a


def test_a_straight_cylinder_loads_its_ends_as_an_elastic_line(line):
    matrix, s, a = line
    load = np.linalg.solve(matrix, np.ones(s.size))
    near = np.interp(CONTACT.length / 2 - a, s, load) / load[s.size // 2] - 1
    percent, distance, *_ = numbers(sizes(CONTACT, LOAD, 1.4, None)["edge load"])
    assert percent / 100 == pytest.approx(near, abs=0.1)
    assert distance == pytest.approx(1e3 * a, rel=0.02)


def test_a_tilt_changes_the_load_of_the_ends_by_a_tenth(line):
    matrix, s, a = line
    half, modulus = CONTACT.length / 2, CONTACT.effective_modulus
    tilt = numbers(sizes(CONTACT, LOAD, 1.4, None)["misalignment"])[0] / 1e3
    # load per length changed by a tenth at the ends; a^2 grows with the load: 1 less
    change = 0.1 * LOAD * s / half
    raised = (matrix @ change - change) / (np.pi * modulus)
    slope = np.polynomial.Polynomial.fit(s, raised, 1).convert().coef[1]
    assert slope == pytest.approx(tilt, rel=0.03)
    drop = numbers(sizes(CONTACT, LOAD, 1.4, None)["crown"])[0] / 1e6
    assert drop == pytest.approx(tilt * half, rel=0.05)


def test_the_film_thins_as_between_flat_strips_and_disks():
    psd, ball = reference_psd("Sb-S"), PointContact("9.5 mm", "1 MPa", 0.5)
    for contact, load in ((CONTACT, LOAD), (ball, 3.0)):
        a, h = float(hertz_half_width(load, contact)), rms_roughness(psd)
        found = sizes(contact, load, 1.4, psd)
        # dh/dt = -W h^3/(8 eta a^3) of a strip, -2 F h^3/(3 pi eta a^4) of a disk
        rate = 2 * load / (3 * np.pi * a**4) if contact.is_round else load / (8 * a**3)
        films = np.geomspace(1e3 * h, h, 20_001)
        middle = np.sqrt(films[1:] * films[:-1])
        time = np.sum(-np.diff(films) / (rate / 1.4 * middle**3))
        assert numbers(found["squeeze-out time"])[0] == pytest.approx(time, rel=0.06)
        assert found["lay"] == found["contact angle hysteresis"] == ""
        assert ("misalignment" in found) is not contact.is_round
