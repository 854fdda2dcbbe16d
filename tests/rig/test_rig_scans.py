"""Scans of the virtual cylinders: form, roughness and stylus are what they claim to be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tribolab import rig
from tribolab.rig.scans.profiles import touch
from tribolab.studies import xu2026

SCANS = 8


def circle(x, z):
    """Radius and residual of the circle through a profile (algebraic least squares)."""
    a = np.stack([x, z, np.ones_like(x)], axis=1)
    p, q, r = np.linalg.lstsq(a, -(x**2 + z**2), rcond=None)[0]
    radius = np.sqrt((p**2 + q**2) / 4 - r)
    return radius, z - (-q / 2 + np.sqrt(radius**2 - (x + p / 2) ** 2))


@pytest.fixture(scope="module", params=list(xu2026.surfaces))
def scanned(request):
    return rig.scans(request.param, SCANS, seed=5)


def test_scan_is_the_instruments(scanned):
    assert scanned.height.shape == (SCANS, 50_001)
    assert scanned.height.attrs["units"] == "m"
    np.testing.assert_allclose(np.diff(scanned.x), 0.5e-6, rtol=1e-6)
    assert float(scanned.x[-1]) == pytest.approx(25e-3)
    counts = scanned.height.values / 1e-9
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)


def test_form_is_the_cylinder_and_the_rest_has_the_roughness_of_the_spectrum(scanned):
    x = scanned.x.values
    radii, variances = [], []
    for z in scanned.height.values:
        radius, rest = circle(x, z)
        radii.append(radius)
        variances.append(rest.var())
    radius_sem = np.std(radii, ddof=1) / np.sqrt(SCANS)
    assert abs(np.mean(radii) - 0.07) < 4 * radius_sem + 1e-6
    assert radius_sem < 0.01 * 0.07
    # the fit takes the longest waves away, so the variance may be low by a few per cent
    sem = np.std(variances, ddof=1) / np.sqrt(SCANS)
    expected = scanned.attrs["variance_in_band_m2"]
    assert -0.05 * expected - 4 * sem < np.mean(variances) - expected < 4 * sem
    assert sem < 0.12 * expected
    assert np.sqrt(expected) == pytest.approx(scanned.attrs["rms_roughness_m"], rel=0.01)


def test_parabola_fit_gives_the_curvature_of_the_circle():
    scan = rig.scans("Smooth", SCANS, seed=6)
    x = scan.x.values - 12.5e-3
    curvature = [-2 * np.polyfit(x, z, 2)[0] for z in scan.height.values]
    # a circle's fourth order adds 3/14 (L/R)^2 to the parabola over -L..L
    expected = (1 + 3 / 14 * (12.5e-3 / 0.07) ** 2) / 0.07
    assert np.mean(curvature) == pytest.approx(expected, rel=1e-3)


def test_scans_are_seeded_and_differ_from_each_other():
    one, again = (rig.scans("Sb-R", 2, seed=3, length=10e-3) for _ in range(2))
    assert one.equals(again)
    rough = [circle(one.x.values, z)[1] for z in one.height.values]
    assert abs(np.corrcoef(rough)[0, 1]) < 0.5


def test_stylus_turns_a_spike_into_its_own_shape():
    height = np.zeros(101)
    height[50] = 1e-6
    felt = touch(height, 0.25e-6, 2e-6)
    reach = 0.25e-6 * np.arange(-50, 51)
    ball = 1e-6 - 2e-6 + np.sqrt(np.maximum(4e-12 - reach**2, 0))
    np.testing.assert_allclose(felt, np.maximum(ball, 0), atol=1e-18)


def test_stylus_does_not_reach_the_bottom_of_a_narrow_groove():
    x = 0.25e-6 * np.arange(-200, 201)
    groove = np.where(np.abs(x) < 0.9e-6, -5e-6, 0.0)  # edges at +-1 um
    depth = touch(groove, 0.25e-6, 2e-6).min()
    assert depth == pytest.approx(-(2e-6 - np.sqrt(4e-12 - 1e-12)), rel=1e-6)


@given(st.lists(st.floats(-1e-5, 1e-5), min_size=20, max_size=60))
def test_stylus_never_goes_below_the_surface_and_ignores_its_height(values):
    height = np.array(values)
    felt = touch(height, 0.5e-6, 2e-6)
    assert (felt >= height).all()
    assert felt.max() == height.max()
    np.testing.assert_allclose(touch(height + 1e-3, 0.5e-6, 2e-6) - 1e-3, felt, atol=1e-15)
