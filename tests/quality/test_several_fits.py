"""Several surfaces, media and loads at once give what each gives by itself."""

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.core.errors import AnalysisError
from tribolab.studies import xu2026

SPEEDS = np.geomspace(1e-6, 1e-2, 6)
SURFACES = ["Sb-S", "Sb-R"]
LOADS = [310.0, 910.0]  # N/m
TRUE = 0.84e6  # Pa
GRID = {"cells": 60}


@pytest.fixture(scope="module")
def spectra():
    return xu2026.psd(SURFACES, points=301)


@pytest.fixture(scope="module")
def measured(spectra):
    """Curves of two surfaces at two loads, one of which was not measured; 1 % errors."""
    curves = []
    for load in LOADS:
        curve = tl.stribeck_curve(xu2026.contact, spectra, 1.4, load, TRUE, SPEEDS, **GRID)
        curves.append(curve[["friction_coefficient"]])
    both = xr.concat(curves, xr.DataArray([31.0, 91.0], dims="normal_force"))
    rng = np.random.default_rng(1)
    mu = both.friction_coefficient * (
        1 + 0.01 * rng.standard_normal(both.friction_coefficient.shape)
    )
    mu[{"normal_force": 1, "surface": 1}] = np.nan
    return xr.Dataset({"friction_coefficient": mu, "friction_coefficient_sem": 0.01 * abs(mu)})


@pytest.fixture(scope="module")
def fits(measured, spectra):
    load = xr.DataArray(LOADS, {"normal_force": [31.0, 91.0]})
    return tl.fit.fit_shear_stresses(measured, xu2026.contact, spectra, "1.4 Pa s", load, **GRID)


@pytest.mark.slow
def test_each_condition_has_the_fit_that_it_has_alone(fits, measured, spectra):
    for surface, force, load in (("Sb-S", 31.0, 310.0), ("Sb-S", 91.0, 910.0), ("Sb-R", 31.0, 310)):
        alone = tl.fit_shear_stress(
            measured.sel(surface=surface, normal_force=force),
            xu2026.contact,
            spectra.sel(surface=surface).dropna("wavenumber"),
            "1.4 Pa s",
            load,
            **GRID,
        )
        one = fits.sel(surface=surface, normal_force=force)
        assert one.to_dataframe().equals(alone.to_dataframe())
        assert abs(one.shear_stress - TRUE) < 4 * one.total_error
        computed = fits.curve.friction_coefficient.sel(surface=surface, normal_force=force)
        np.testing.assert_array_equal(computed, alone.curve.friction_coefficient)


@pytest.mark.slow
def test_what_was_not_measured_is_not_fitted_and_says_so(fits):
    stress = fits.to_dataset().shear_stress
    assert set(stress.dims) == {"surface", "normal_force"} and stress.attrs["units"] == "Pa"
    assert int(stress.isnull().sum()) == 1
    assert len(fits.to_dataframe()) == len(list(fits)) == 3
    with pytest.raises(AnalysisError, match=r"nothing was measured at .*Sb-R"):
        fits.sel(surface="Sb-R", normal_force=91.0)
    assert fits.curve.friction_coefficient.sel(surface="Sb-R", normal_force=91.0).isnull().all()
    assert len(list(fits.sel(surface="Sb-R"))) == 1
    assert fits._repr_html_().split("<details>")[0].count("<tr>") == 1 + 3


@pytest.mark.slow
def test_a_condition_that_cannot_be_fitted_is_named(measured, spectra):
    few = measured.isel(sliding_speed=slice(0, 1))
    with pytest.raises(AnalysisError, match=r"(?s)Sb-S.*at least 2"):
        tl.fit.fit_shear_stresses(few, xu2026.contact, spectra, 1.4, 310.0, **GRID)
    with pytest.raises(AnalysisError, match="surface 'Sb-R'"):
        other = spectra.sel(surface=["Sb-S"])
        tl.fit.fit_shear_stresses(measured, xu2026.contact, other, 1.4, 310.0, **GRID)
    with pytest.raises(AnalysisError, match="fit it with fit_shear_stress$"):
        one = measured.isel(surface=0, normal_force=0, drop=True)
        psd = spectra.isel(surface=0, drop=True)
        tl.fit.fit_shear_stresses(one, xu2026.contact, psd, 1.4, 310.0)


def test_a_stress_for_each_curve_is_added_to_each(spectra):
    bare = tl.stribeck_curve(xu2026.contact, spectra, 1.4, 310.0, 0.0, SPEEDS, **GRID)
    stress = xr.DataArray([1e6, 2e6], {"surface": SURFACES})
    curves = tl.lubrication.with_shear_stress(bare, stress)
    for surface, value in zip(SURFACES, stress.values, strict=True):
        alone = tl.lubrication.with_shear_stress(bare.sel(surface=surface), float(value))
        xr.testing.assert_equal(
            curves.friction_coefficient.sel(surface=surface), alone.friction_coefficient
        )
    assert curves.shear_stress.attrs["units"] == "Pa"


def test_labels_make_dims_of_measured_curves():
    def run(mu):
        values = {"friction_coefficient": mu, "friction_coefficient_std": 0.01}
        values |= {"friction_coefficient_sem": 0.01, "sliding_speed": 1e-3}
        return xr.Dataset({name: ("segment", [value]) for name, value in values.items()})

    runs = [run(mu) for mu in (0.9, 0.5, 0.7)]
    curves = tl.measured_stribeck_curve(
        runs, surface=["Sb-R", "Sb-S", "Sb-R"], normal_force=[91.0, 31.0, 91.0]
    )
    both = tl.measured_stribeck_curve([runs[0], runs[2]])
    assert curves.friction_coefficient.dims == ("surface", "normal_force", "sliding_speed")
    assert curves.normal_force.values.tolist() == [31.0, 91.0]
    rough = curves.sel(surface="Sb-R")
    assert (
        rough.friction_coefficient.sel(normal_force=91).item() == both.friction_coefficient.item()
    )
    assert rough.friction_coefficient.sel(normal_force=31).isnull().all()
    assert curves.runs.sel(surface="Sb-R", normal_force=91).item() == 2
    for wrong in (["Sb-R"], "abc"):
        with pytest.raises(AnalysisError, match="one label for each of 3 runs"):
            tl.measured_stribeck_curve(runs, surface=wrong)


def test_relative_factors_are_those_of_each_surface(spectra):
    over = np.array([0.3, 1.0, 3.0])
    both = tl.lubrication.relative_flow_factors(spectra, over)
    for surface in SURFACES:
        table = tl.lubrication.flow_factors(spectra.sel(surface=surface).dropna("wavenumber"))
        alone = table.dataset(over * table.rms_roughness)
        for name in alone.data_vars:
            np.testing.assert_array_equal(both[name].sel(surface=surface), alone[name])
        np.testing.assert_array_equal(both.separation.sel(surface=surface), alone.separation)
    drawn = tl.plot.figure_data(tl.plot.lubrication_factors(both))
    assert set(drawn.series) == set(SURFACES)
