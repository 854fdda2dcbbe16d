"""Adhesion under the liquid in the solid's share of a lubricated contact."""

import numpy as np
import pytest
from contact_cases import CONTACT, E_STAR, reference_psd

from tribolab.contact.adhesive_contact import adhesion
from tribolab.contact.line import rough_line_contact
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.stribeck import stribeck_curve

WET = "51 mJ/m^2"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Smooth", "Sb-R"])
def test_boundary_friction_is_the_adhesive_area_of_the_dry_contact(name):
    """int A_adh(p) dx over the nominal contact, by another solver on another mesh."""
    psd = reference_psd(name)
    dry = rough_line_contact(310.0, CONTACT, psd, points=201)
    pressure = dry.pressure.values
    inside = pressure > 1e-3 * pressure.max()
    area = adhesion(pressure[inside], psd, E_STAR, WET).contact_area_ratio.values
    exact = area.sum() * float(dry.x[1] - dry.x[0]) / 310.0
    curve = stribeck_curve(CONTACT, psd, 1.4, 310.0, 0.1e6, [0.0], cells=200, work_of_adhesion=WET)
    assert float(curve.friction_per_shear_stress[0]) == pytest.approx(exact, rel=1e-2)


def test_what_binds_is_the_solids_share_and_no_film_changes():
    psd, speeds = reference_psd("Smooth"), [1e-6, 1e-4, 1e-2]
    without, bound, wetted = (
        stribeck_curve(CONTACT, psd, 1.4, 310.0, 0.1e6, speeds, cells=100, work_of_adhesion=work)
        for work in (None, WET, "-5 mJ/m^2")
    )
    np.testing.assert_array_equal(without.minimum_separation, bound.minimum_separation)
    np.testing.assert_array_equal(without.friction_coefficient, wetted.friction_coefficient)
    grown = bound.friction_per_shear_stress / without.friction_per_shear_stress
    assert np.all(grown > 3)
    # where the film parts the bodies nothing binds, although area stays at no pressure when dry
    assert float(bound.friction_coefficient_solid[2]) < 1e-9
    assert np.all(np.diff(bound.friction_per_shear_stress) < 0)


def test_no_area_is_more_than_the_whole():
    film = film_profile(
        CONTACT, reference_psd("Smooth"), 1.4, 310.0, 0.0, cells=100, work_of_adhesion=WET
    )
    area = film.contact_area_ratio.values
    assert 0.9 < area.max() <= 1
    assert np.all(area[np.abs(film.x.values) > 8e-3] < 1e-3)
