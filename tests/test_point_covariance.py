"""Errors that points share: the covariance of a curve in fits and in the verdict on a model."""

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.fit.point_covariance import PointErrors
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.lubrication.stribeck import stribeck_curve, with_shear_stress
from tribolab.mode.misfit import is_sufficient, misfit_numbers
from tribolab.studies import xu2026

SPEED = np.geomspace(1e-6, 1e-2, 9)
GIVEN = (xu2026.contact, xu2026.psd("Sb-S"), 1.4, xu2026.contact.load(31.0))


@pytest.fixture(scope="module")
def bare():
    dense = np.union1d(np.geomspace(1e-7, 1e-1, 25), SPEED)
    return stribeck_curve(*GIVEN, 0.0, dense, cells=100)


@pytest.fixture(scope="module")
def truth(bare):
    curve = with_shear_stress(bare, 0.84e6)
    slope = np.gradient(curve.friction_coefficient.values, np.log(curve.sliding_speed.values))
    return curve.sel(sliding_speed=SPEED), np.interp(SPEED, curve.sliding_speed.values, slope)


def measured(mu, own, shared):
    """A measured curve with parts of its uncertainty that all points share."""
    data = {
        "friction_coefficient": ("sliding_speed", mu),
        "friction_coefficient_sem": ("sliding_speed", own),
        "uncertainty_part": (("part", "sliding_speed"), np.vstack([own, shared])),
    }
    names = ["between runs", *(f"gain {i}" for i in range(len(shared)))]
    return xr.Dataset(data, {"sliding_speed": SPEED, "part": np.array(names)})


def test_chi_square_of_nine_points_is_nine_with_the_full_covariance_and_22_6_without():
    rng = np.random.default_rng(1)
    own, tilt = np.full(9, 0.01), np.full(9, 0.008)
    gain = np.linspace(0.2, 1.4, 9)
    gain *= np.sqrt((22.6 - 9) * 0.01**2 - np.sum(tilt**2)) / np.linalg.norm(gain)
    errors = PointErrors(own, np.array([tilt, gain]))
    drawn = own * rng.standard_normal((20_000, 9))
    drawn += rng.standard_normal((20_000, 2)) @ errors.shared
    assert np.mean(np.sum(errors.whitened(drawn.T) ** 2, axis=0)) == pytest.approx(9.0, abs=0.1)
    assert np.mean(np.sum((drawn / own) ** 2, axis=1)) == pytest.approx(22.6, abs=0.5)


def test_a_fit_with_shared_errors_has_its_chi_square_and_an_error_that_holds(bare, truth):
    rng = np.random.default_rng(5)
    curve, slope = truth
    mu = curve.friction_coefficient.values
    own, parts = 0.02 * mu + 1e-3, np.array([0.05 * mu])
    pulls, chi, diagonal = [], [], []
    for _ in range(60):
        drawn = mu + own * rng.standard_normal(9) + 0.12 * slope * rng.standard_normal()
        drawn = drawn + parts[0] * rng.standard_normal()
        data = measured(drawn, own, parts)
        fit = fit_shear_stress(data, *GIVEN, curve=bare, abscissa_error=0.12)
        alone = fit_shear_stress(data.drop_vars("uncertainty_part"), *GIVEN, curve=bare)
        pulls.append((fit.shear_stress - 0.84e6) / fit.shear_stress_error)
        chi.append(fit.chi_square)
        diagonal.append(alone.chi_square)
    assert np.mean(chi) == pytest.approx(8, abs=1.5)
    assert np.mean(diagonal) > 1.3 * np.mean(chi)
    assert np.std(pulls) == pytest.approx(1, abs=0.25)


def test_without_shared_parts_nothing_changes(bare, truth):
    mu = truth[0].friction_coefficient.values * np.linspace(0.97, 1.02, 9)
    data = measured(mu, 0.02 * mu, np.zeros((1, 9)))
    plain = data.drop_vars(["uncertainty_part", "part"])
    first, second = (fit_shear_stress(d, *GIVEN, curve=bare) for d in (data, plain))
    assert first.shear_stress == second.shear_stress
    assert first.total_error == second.total_error


def test_a_model_is_sufficient_where_shared_errors_make_what_it_misses(truth):
    model = truth[0][["friction_coefficient"]]
    mu = model.friction_coefficient.values
    tilted = mu + 0.03 * mu.max()
    off = mu - tilted
    own = np.full(9, 0.002 * mu.max())
    alone = misfit_numbers(measured(tilted, own, np.zeros((1, 9))), model, off)
    together = misfit_numbers(measured(tilted, own, np.full((1, 9), 0.03 * mu.max())), model, off)
    assert alone["model_misfit_p_value"] < 1e-6 and together["model_misfit_p_value"] > 0.3
    wide = misfit_numbers(measured(tilted, own, np.full((1, 9), 0.3 * mu.max())), model, off)
    assert is_sufficient(together) is True and is_sufficient(wide) is None


def test_glycerol_at_half_a_degree_reaches_the_points_by_the_speed(bare, truth):
    known = tl.liquid_viscosity("glycerol", "23 °C", "1 %")
    relative = known.uncertainty(0.5 / np.sqrt(3), 0.01 / np.sqrt(3))
    model = with_shear_stress(bare, 0.84e6).assign_attrs(abscissa_error=relative)
    mu, slope = truth[0].friction_coefficient.values, truth[1]
    thinner = mu - 0.12 * slope
    data = measured(thinner, 0.002 * mu + 1e-4, np.zeros((1, 9)))
    told = misfit_numbers(data, model, mu - thinner)
    untold = misfit_numbers(data, model.assign_attrs(abscissa_error=0.0), mu - thinner)
    assert untold["model_misfit_p_value"] < 1e-4 < told["model_misfit_p_value"]
