"""Distribution of the gap: what it integrates to, its limits, and what has no gap."""

import numpy as np
import pytest
import xarray as xr
from contact_cases import E_STAR, SURFACES, properties, reference_psd, self_affine
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from tribolab.contact.gap import gap_distribution
from tribolab.contact.persson import contact_area_ratio, mean_separation
from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import rms_roughness, rms_slope


def gap_averages(distribution, function, at_contact=0.0, above_cutoff=False):
    """Average of a function of the gap, over open and closed area."""
    weight, gap = distribution["gap_weight"], distribution["gap"]
    if above_cutoff:
        weight = weight.where(gap >= distribution.attrs["cutoff_m"], 0.0)
    open_part = (weight * function(gap)).sum("gap")
    return open_part + distribution["contact_area_ratio"] * at_contact


VARIANTS = ("flow", "plain")
# up to A/A0 of about 0.8
PRESSURES = {
    "Smooth": np.geomspace(0.1, 1.9e5, 15),
    "Sb-S": np.geomspace(0.1, 7e5, 15),
    "Sb-R": np.geomspace(0.1, 1.2e6, 15),
}


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", SURFACES)
def test_open_and_closed_area_make_one_and_the_mean_gap_is_the_separation(name, variant):
    psd, p = reference_psd(name), PRESSURES[name]
    gaps = gap_distribution(p, psd, E_STAR, variant)
    assert (gaps.gap_density >= 0).all()
    total = gap_averages(gaps, lambda u: xr.ones_like(u), at_contact=1.0)
    np.testing.assert_allclose(total, 1.0, atol=2e-5)
    np.testing.assert_allclose(
        gap_averages(gaps, lambda u: u), mean_separation(p, psd, E_STAR), rtol=2e-5
    )
    np.testing.assert_allclose(gaps.contact_area_ratio, contact_area_ratio(p, psd, E_STAR))


def test_the_density_alone_integrates_to_the_open_area():
    gaps = gap_distribution(np.array([1e2, 4e4]), reference_psd("Sb-R"), E_STAR)
    u = gaps.gap.values
    log = np.log(u[1:])
    for row in range(2):
        curve = CubicSpline(log, gaps.gap_density.values[row, 1:] * u[1:])
        first_cell = float(gaps.gap_weight[row, 0])  # gaps smaller than any atom
        area = curve.integrate(log[0], log[-1]) + first_cell
        assert first_cell < 3e-3
        assert area == pytest.approx(1 - float(gaps.contact_area_ratio[row]), abs=5e-4)


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", SURFACES)
def test_far_from_contact_the_gap_spreads_as_the_undeformed_roughness(name, variant):
    psd = reference_psd(name)
    gaps = gap_distribution(1e-2, psd, E_STAR, variant)
    mean, height = float(gaps.separation), rms_roughness(psd)
    spread = float(gap_averages(gaps, lambda u: (u - mean) ** 2))
    assert mean > 6 * height
    assert spread == pytest.approx(height**2, rel=0.06)
    # Tripp: <1/u> u = 1 + (h/u)^2 at large separation
    inverse = float(gap_averages(gaps, lambda u: 1 / u, above_cutoff=True)) * mean
    assert inverse == pytest.approx(1 + (height / mean) ** 2, abs=0.2 * (height / mean) ** 2)


@pytest.mark.parametrize("variant", VARIANTS)
def test_averages_do_not_hang_on_the_grid_of_magnifications(variant, monkeypatch):
    psd, p = reference_psd("Sb-S"), np.geomspace(1e2, 8e4, 6)
    coarse = gap_distribution(p, psd, E_STAR, variant)
    monkeypatch.setattr("tribolab.contact.gap._PER_DECADE", 60)
    fine = gap_distribution(p, psd, E_STAR, variant)
    for function, cut, tolerance in ((lambda u: u**3, False, 0.01), (lambda u: 1 / u, True, 2e-3)):
        np.testing.assert_allclose(
            gap_averages(coarse, function, above_cutoff=cut),
            gap_averages(fine, function, above_cutoff=cut),
            rtol=tolerance,
        )


@properties
@given(
    hurst=st.floats(0.4, 1.2),
    slope=st.floats(0.05, 1),
    area=st.floats(1e-4, 0.3),
    variant=st.sampled_from(VARIANTS),
)
def test_any_surface_has_a_distribution(hurst, slope, area, variant):
    psd = self_affine(hurst, slope)
    p = area * slope * E_STAR * np.sqrt(np.pi / 8)
    gaps = gap_distribution(p, psd, E_STAR, variant)
    total = gap_averages(gaps, lambda u: xr.ones_like(u), at_contact=1.0)
    assert float(total) == pytest.approx(1.0, abs=1e-3)
    mean, square, cube = (float(gap_averages(gaps, lambda u, n=n: u**n)) for n in (1, 2, 3))
    assert mean == pytest.approx(float(gaps.separation), rel=1e-3)
    assert square >= mean**2
    assert cube >= mean**3


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", SURFACES)
def test_where_little_touches_the_distribution_has_the_right_mean_by_itself(name, variant):
    psd = reference_psd(name)
    p = 1e-2 * E_STAR * rms_slope(psd) * np.sqrt(np.pi / 8)  # A/A0 = 0.01
    found = gap_distribution([1e-3 * p, 0.1 * p, p], psd, E_STAR, variant)
    np.testing.assert_allclose(found.contact_area_ratio[-1], 0.01, rtol=1e-3)
    np.testing.assert_allclose(found.gap_scale, 1.0, atol=0.02)


def test_the_cutoff_leaves_out_what_lies_under_it():
    psd = reference_psd("Smooth")
    narrow, wide = (gap_distribution(4e4, psd, E_STAR, cutoff=c) for c in ("1 nm", "10 nm"))
    share = [
        float(gap_averages(g, lambda u: xr.ones_like(u), above_cutoff=True)) for g in (narrow, wide)
    ]
    everything = float(gap_averages(narrow, lambda u: xr.ones_like(u)))
    assert everything > share[0] > share[1]
    above = narrow.gap_weight.where(narrow.gap > 1e-8, 0).sum()
    assert float(above) == pytest.approx(share[1], rel=1e-4)


def test_dims_of_the_pressure_are_kept():
    psd = reference_psd("Sb-R")
    p = xr.DataArray([[1e3, 1e4], [2e4, 4e4]], dims=("load", "x"), coords={"x": [0.0, 1e-3]})
    gaps = gap_distribution(p, psd, E_STAR)
    assert gaps.gap_density.dims == ("load", "x", "gap")
    assert gaps.gap_density.attrs["units"] == "1/m"
    assert gap_averages(gaps, lambda u: u**2).dims == ("load", "x")
    alone = gap_distribution("40 kPa", psd, E_STAR)
    assert alone.gap_density.dims == ("gap",)
    for n in (1, 3):
        averages = [gap_averages(g, lambda u, n=n: u**n) for g in (gaps, alone)]
        assert float(averages[0][1, 1]) == pytest.approx(float(averages[1]), rel=1e-5)


@pytest.mark.parametrize(
    ("pressure", "words"),
    [
        (0.0, "above zero"),
        (-1.0, "negative"),
        (np.array([1.0, np.inf]), "finite"),
        (np.array([1e3, np.nan]), "finite"),
        (np.array([1e3, 1e7]), "at 1e\\+07 Pa the contact is complete"),
        (np.ones((2, 2)), "DataArray that names them"),
    ],
)
def test_pressures_without_a_gap_are_refused(pressure, words):
    with pytest.raises(AnalysisError, match=words):
        gap_distribution(pressure, reference_psd("Smooth"), E_STAR)


def test_unknown_variants_and_flat_surfaces_are_refused():
    psd = reference_psd("Smooth")
    with pytest.raises(AnalysisError, match="did you mean 'plain'"):
        gap_distribution(1e3, psd, E_STAR, "plan")
    with pytest.raises(AnalysisError, match="zero everywhere"):
        gap_distribution(1e3, psd * 0, E_STAR)
