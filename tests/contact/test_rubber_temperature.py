"""Adhesion at each wavenumber, other temperatures, sums of relaxations, and heat."""

import numpy as np
import pytest
from contact_cases import E_STAR, reference_psd

from tribolab.contact.adhesive_contact import adhesion
from tribolab.core.errors import AnalysisError
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.modulus import PDMS_STAND_IN, FractionalZener, TabulatedModulus
from tribolab.rubber.prony import PronySeries
from tribolab.rubber.temperature import WilliamsLandelFerry, flash_temperature, modulus_at

LAW = WilliamsLandelFerry(8.86, "101.6 K", "20 degC")
OMEGA = np.geomspace(1e-3, 1e9, 60)


@pytest.mark.parametrize(("name", "most"), [("Sb-S", 1.89), ("Sb-R", 1.23)])
def test_adhesive_contact_loses_more_but_less_than_the_area_grows(name, most):
    """The paper scales by the whole area's growth and calls that an upper bound."""
    psd, speeds = reference_psd(name), [1e-4, 1e-2]
    free = viscoelastic_friction(speeds, "41.7 kPa", psd, PDMS_STAND_IN)
    bound = viscoelastic_friction(
        speeds, "41.7 kPa", psd, PDMS_STAND_IN, work_of_adhesion="64 mJ/m^2"
    )
    grown = (bound.friction_coefficient / free.friction_coefficient).values
    assert np.all((grown > 1.02) & (grown < most))


def test_at_rest_the_area_is_that_of_adhesive_contact():
    psd = reference_psd("Sb-S")
    rest = viscoelastic_friction(
        0.0, [2e4, 4.17e4], psd, PDMS_STAND_IN, work_of_adhesion="64 mJ/m^2"
    )
    exact = adhesion([2e4, 4.17e4], psd, E_STAR, "64 mJ/m^2").contact_area_ratio
    np.testing.assert_allclose(rest.contact_area_ratio.values.ravel(), exact, rtol=1e-3)
    wetted = viscoelastic_friction(1e-3, 2e4, psd, PDMS_STAND_IN, work_of_adhesion=-1e-3)
    plain = viscoelastic_friction(1e-3, 2e4, psd, PDMS_STAND_IN)
    assert float(wetted.friction_coefficient) == float(plain.friction_coefficient)


@pytest.mark.parametrize("kelvin", [280.0, 293.15, 330.0])
def test_a_rubber_at_another_temperature_is_one_at_another_frequency(kelvin):
    times, moduli = np.geomspace(1e-8, 1, 9), np.geomspace(1e7, 1e5, 9)
    zener, prony = PDMS_STAND_IN, PronySeries(1.5e6, moduli, times)
    value = zener(OMEGA)
    table = TabulatedModulus(OMEGA, value.real, value.imag)
    apart = kelvin - 293.15
    factor = 10 ** (-8.86 * apart / (101.6 + apart))
    for solid in (zener, prony, table):
        shifted = modulus_at(solid, kelvin, LAW)
        inside = OMEGA[20:40]
        np.testing.assert_allclose(shifted(inside), solid(inside * factor), rtol=1e-9)


def test_shifts_follow_one_another():
    """From the reference to T by way of T': C1 and C2 change, C1 C2 and T_r - C2 do not."""
    middle = 310.0
    c2 = LAW.c2 + middle - LAW.reference_temperature
    onward = WilliamsLandelFerry(LAW.c1 * LAW.c2 / c2, c2, middle)
    direct = LAW.shift_factor(340.0)
    assert LAW.shift_factor(middle) * onward.shift_factor(340.0) == pytest.approx(direct)


def test_a_temperature_beyond_the_law_is_refused():
    with pytest.raises(AnalysisError, match="nothing relaxes"):
        LAW.shift_factor("180 K")
    with pytest.raises(AnalysisError, match="no longer by C1"):
        LAW.shift_factor("420 K")


def test_a_master_curve_that_was_shifted_out_of_reach_is_refused():
    """A table about a hundredth of a hertz tells nothing of nanometres at room temperature."""
    value = PDMS_STAND_IN(OMEGA[:10])
    cold = modulus_at(TabulatedModulus(OMEGA[:10], value.real, value.imag), 340.0, LAW)
    with pytest.raises(AnalysisError, match="outside the modulus table"):
        viscoelastic_friction([1e-2, 1e-1], 4e4, reference_psd("Sb-S"), cold)


def test_one_relaxation_is_the_standard_solid_and_loss_is_causal():
    series = PronySeries(1e6, [9e6], [1e-4])
    np.testing.assert_allclose(series(OMEGA), FractionalZener(1e6, 1e7, 1e-4, 1.0)(OMEGA))
    np.testing.assert_allclose(series(-OMEGA), np.conj(series(OMEGA)))
    # Kramers and Kronig: E(inf) - E(0) = (2/pi) int E'' d ln omega
    many = PronySeries(1e6, [1e6, 2e6, 5e6], [1e-5, 1e-3, 1e-1])
    log = np.linspace(np.log(1e-6), np.log(1e10), 4001)
    total = 2 / np.pi * np.trapezoid(many(np.exp(log)).imag, log)
    assert total == pytest.approx(8e6, rel=1e-4)


@pytest.mark.parametrize("wrong", [([1e6], [1e-3, 1]), ([-1.0], [1e-3]), ([1e6], [0.0])])
def test_a_series_that_is_no_solid_is_refused(wrong):
    with pytest.raises(AnalysisError, match="wanted"):
        PronySeries(1e6, *wrong)


def test_a_spot_heats_between_one_at_rest_and_a_fast_one():
    conducts, diffuses, size, stress = 0.16, 1.1e-7, 1e-4, 1e6
    slow, fast = flash_temperature(stress, np.array([1e-7, 1e3]), size, conducts, diffuses)
    assert slow == pytest.approx(stress * 1e-7 * size / conducts, rel=1e-3)
    band = 2 * stress * 1e3 / conducts * np.sqrt(2 * diffuses * size / (np.pi * 1e3))
    assert fast == pytest.approx(band, rel=1e-3)


def test_heat_is_warned_of():
    psd = reference_psd("Sb-R")
    cool, hot = (viscoelastic_friction(v, "0.1 MPa", psd, PDMS_STAND_IN) for v in (1e-4, 1.0))
    assert "temperature rise" not in cool.validity_reasons
    assert "temperature rise" in hot.validity_reasons
