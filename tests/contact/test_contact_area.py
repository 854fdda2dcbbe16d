"""The corrected contact areas: their limits, their equation, and where they enter."""

import numpy as np
import pytest
from contact_cases import CONTACT, E_STAR, reference_psd
from scipy.integrate import solve_ivp
from scipy.special import erf

from tribolab.contact.area import area_of
from tribolab.contact.line import rough_line_contact
from tribolab.contact.persson import apparent_contact_area_ratio, contact_area_ratio
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.stribeck import stribeck_curve

SHARES = {
    "corrected": lambda area: 0.51 + 0.49 * area**2,
    "numerics": lambda area: 1 - 0.5 * (1 - area) ** 0.45,
}
# boundary elements over Persson's theory at p/(E* xi), five Hurst exponents
NUMERICS = {0.03: 1.38, 0.1: (1.27 + 1.32) / 2, 0.3: 1.15, 0.6: 1.05, 1.0: 1.01}


@pytest.mark.parametrize("theory", SHARES)
def test_the_variance_of_the_stress_grows_by_the_share_of_the_energy(theory):
    """dV/dV_c = S(erf(p/sqrt(2 V))) by Runge-Kutta, in ln V over ln V_c, at p = 1."""

    def growth(log_c, log_v):
        return SHARES[theory](erf(np.exp(-log_v / 2) / np.sqrt(2))) * np.exp(log_c - log_v)

    at = np.linspace(np.log(1e-2), np.log(1e6), 40)
    exact = solve_ivp(growth, at[[0, -1]], at[:1], t_eval=at, rtol=1e-10, atol=1e-12)
    area = erf(np.exp(-exact.y[0] / 2) / np.sqrt(2))
    reduced = 1 / np.sqrt(2 * np.exp(at))
    np.testing.assert_allclose(area_of(reduced, theory), area, rtol=2e-6)


@pytest.mark.parametrize(("theory", "slope"), [("corrected", 2.23), ("numerics", 2.26)])
def test_area_is_proportional_to_light_pressure_and_complete_under_a_heavy_one(theory, slope):
    reduced = np.array([1e-7, 1e-4])
    over = area_of(reduced * np.sqrt(2), theory) / reduced  # y = sqrt(2) p/(E* xi)
    assert over[0] == pytest.approx(slope, abs=0.01)
    assert over[1] == pytest.approx(over[0], rel=1e-2)
    heavy = np.array([0.0, 3.0, 6.5, 1e3])
    np.testing.assert_allclose(area_of(heavy, theory), erf(heavy), atol=2e-5)
    grid = area_of(np.geomspace(1e-9, 10, 3000), theory)
    assert np.all(np.diff(grid) >= 0)


@pytest.mark.parametrize("theory", SHARES)
def test_the_area_is_that_of_boundary_elements(theory):
    for reduced, ratio in NUMERICS.items():
        y = np.array(np.sqrt(2) * reduced)
        assert area_of(y, theory) / erf(y) == pytest.approx(ratio, rel=0.05)


def test_the_area_seen_at_each_magnification_is_the_same_function():
    psd = reference_psd("Sb-S", 60)
    seen = apparent_contact_area_ratio(1e5, psd, E_STAR, "corrected")
    whole = contact_area_ratio(1e5, psd, E_STAR, "corrected")
    assert float(seen[-1]) == pytest.approx(whole, rel=1e-12)
    part = psd.isel(wavenumber=slice(0, 31))
    assert float(seen[30]) == pytest.approx(contact_area_ratio(1e5, part, E_STAR, "corrected"))
    assert float(seen[0]) == 1


def test_films_stay_and_the_solid_friction_grows_with_the_area():
    psd = reference_psd("Sb-R")
    plain, other = (
        stribeck_curve(CONTACT, psd, 1.4, 310.0, 1e6, [1e-7, 1e-3], cells=100, area=theory)
        for theory in ("persson", "corrected")
    )
    np.testing.assert_array_equal(plain.minimum_separation, other.minimum_separation)
    grown = other.friction_per_shear_stress / plain.friction_per_shear_stress
    assert np.all((grown > 1.25) & (grown < 1.401))
    np.testing.assert_array_equal(
        plain.friction_per_shear_stress_other, other.friction_per_shear_stress
    )
    film = film_profile(CONTACT, psd, 1.4, 310.0, 1e-7, cells=100, area="corrected")
    width = np.gradient(film.x.values)
    per_stress = float((film.contact_area_ratio.values * width).sum()) / 310
    assert per_stress == pytest.approx(float(other.friction_per_shear_stress[0]), rel=1e-2)


def test_the_dry_line_contact_takes_the_theory_too():
    psd = reference_psd("Sb-S")
    plain, other = (
        rough_line_contact(310.0, CONTACT, psd, points=101, area=theory)
        for theory in ("persson", "corrected")
    )
    np.testing.assert_array_equal(plain.pressure, other.pressure)
    middle = other.contact_area_ratio[50] / plain.contact_area_ratio[50]
    assert 1.3 < float(middle) < 1.4


def test_an_unknown_theory_is_refused():
    with pytest.raises(AnalysisError, match="corrected"):
        contact_area_ratio(1e5, reference_psd("Sb-S"), E_STAR, "corected")
