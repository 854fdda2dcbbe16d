"""Smooth line contacts against closed forms and the published numbers."""

import numpy as np
import pytest
from contact_cases import CONTACT, properties, target
from hypothesis import given
from hypothesis import strategies as st

from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import (
    hertz_half_width,
    hertz_max_pressure,
    hertz_mean_pressure,
    hertz_pressure,
    jkr_half_width,
    jkr_smallest_load,
)
from tribolab.core.errors import AnalysisError, UnitError


@pytest.mark.parametrize("load", [310, 910, 1510, 2110])
def test_nominal_pressures_of_the_paper(shared, load):
    published = target(shared, "nominal_pressure", "all", f"{load} N/m")
    assert hertz_mean_pressure(f"{load} N/m", CONTACT) / 1e6 == pytest.approx(published, rel=0.01)


def test_hertz_limit_of_the_papers_appendix(shared):
    pressure = target(shared, "hertz_max_pressure", "smooth limit")
    width = target(shared, "hertz_contact_width", "smooth limit")
    assert hertz_max_pressure(310.0, CONTACT) / 1e6 == pytest.approx(pressure, abs=5e-5)
    assert 2e3 * hertz_half_width(310.0, CONTACT) == pytest.approx(width, abs=5e-3)


def test_half_widths_printed_in_section_5_are_ten_times_too_large(shared):
    dry = target(shared, "half_width_no_adhesion", "Smooth")
    sticky = target(shared, "half_width_with_adhesion", "Smooth")
    assert 1e3 * hertz_half_width(310.0, CONTACT) == pytest.approx(dry / 10, rel=0.01)
    assert 1e3 * jkr_half_width(310.0, CONTACT, "64 mJ/m^2") == pytest.approx(sticky / 10, abs=0.05)


def test_hertz_pressure_carries_the_load_and_peaks_at_the_maximum():
    a = hertz_half_width(310.0, CONTACT)
    theta, weight = np.polynomial.legendre.leggauss(60)
    x = a * np.sin(np.pi / 2 * theta)  # takes the square root at the edge away
    step = a * np.cos(np.pi / 2 * theta) * np.pi / 2 * weight
    assert (hertz_pressure(x, 310.0, CONTACT) * step).sum() == pytest.approx(310.0, rel=1e-12)
    assert hertz_pressure(0.0, 310.0, CONTACT) == pytest.approx(hertz_max_pressure(310.0, CONTACT))
    assert hertz_pressure([-1.01 * a, 1.01 * a], 310.0, CONTACT).tolist() == [0.0, 0.0]


@properties
@given(force=st.floats(-1, 5e4), work=st.floats(1e-6, 10))
def test_jkr_solves_its_equation_on_the_branch_connected_to_hertz(force, work):
    smallest = jkr_smallest_load(CONTACT, work)
    load = smallest * -force if force < 0 else force
    a = jkr_half_width(load, CONTACT, work)
    modulus, radius = CONTACT.effective_modulus, CONTACT.radius
    terms = np.pi * modulus * a**2 / (4 * radius), np.sqrt(2 * modulus * np.pi * a * work)
    assert terms[0] - terms[1] == pytest.approx(load, abs=1e-9 * sum(terms))
    stiff = np.pi * modulus * a / (2 * radius) - np.sqrt(np.pi * modulus * work / (2 * a))
    assert stiff >= -1e-6 * np.pi * modulus * a / (2 * radius)
    if load >= 0:
        assert a > hertz_half_width(load, CONTACT)


def test_jkr_goes_over_into_hertz_and_is_hertz_without_adhesion():
    loads = np.array([1.0, 310.0, 2110.0])
    hertz = hertz_half_width(loads, CONTACT)
    np.testing.assert_allclose(jkr_half_width(loads, CONTACT, 1e-16), hertz, rtol=1e-6)
    np.testing.assert_array_equal(jkr_half_width(loads, CONTACT, 0.0), hertz)


def test_jkr_at_rest_without_load_has_its_closed_form():
    a = jkr_half_width(0.0, CONTACT, 0.064)
    closed = (32 * CONTACT.radius**2 * 0.064 / (np.pi * CONTACT.effective_modulus)) ** (1 / 3)
    assert a == pytest.approx(closed, rel=1e-13)


def test_a_pull_beyond_the_smallest_load_is_refused_with_that_load():
    smallest = jkr_smallest_load(CONTACT, 0.064)
    assert jkr_half_width(smallest, CONTACT, 0.064) > 0
    with pytest.raises(AnalysisError, match=f"detaches below {smallest:.6g} N/m"):
        jkr_half_width([310.0, 1.001 * smallest], CONTACT, 0.064)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hertz_half_width(-1.0, CONTACT), "cannot be pulled"),
        (lambda: hertz_half_width(np.nan, CONTACT), "finite"),
        (lambda: jkr_half_width(1.0, CONTACT, -0.1), "work_of_adhesion"),
        (lambda: LineContact(0.0, 0.1, 1e6, 0.5), "radius"),
        (lambda: LineContact(0.07, 0.1, -1e6, 0.5), "youngs_modulus"),
        (lambda: LineContact(0.07, 0.1, 1e6, 0.51), "poisson_ratio"),
        (lambda: LineContact(0.07, 0.1, 1e6, -1.0), "poisson_ratio"),
        (lambda: LineContact(np.inf, 0.1, 1e6, 0.3), "radius"),
    ],
)
def test_what_is_no_contact_is_refused(call, words):
    with pytest.raises(AnalysisError, match=words):
        call()


def test_incompressible_rubber_is_allowed_and_text_needs_units():
    contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    assert contact == CONTACT
    assert contact.effective_modulus == 2.0e6
    assert contact.load("31 N") == 310.0
    with pytest.raises(UnitError, match="radius"):
        LineContact("7", "10 cm", "1.5 MPa", 0.5)


def test_no_load_is_no_contact():
    assert hertz_half_width(0.0, CONTACT) == 0
    assert hertz_mean_pressure(0.0, CONTACT) == 0
