"""What uncertain surface energies do to the contact area."""

import numpy as np
import pytest
import xarray as xr
from contact_cases import E_STAR, SURFACES, reference_psd

from tribolab.contact.adhesion_balance import rough_interface
from tribolab.contact.adhesion_error import adhesion_uncertainty
from tribolab.contact.adhesive_contact import adhesion, macroscopic_work_of_adhesion
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.work_of_adhesion import (
    PDMS_PMMA_GLYCEROL,
    SurfaceEnergies,
    sample_work_of_adhesion,
)
from tribolab.core.errors import AnalysisError

PRESSURE = np.array([0.0417e6, 0.1e6])


@pytest.mark.slow
@pytest.mark.parametrize("surface", ["Smooth", "Sb-S"])  # with and without a pull-off force
def test_values_and_bounds_are_those_at_the_works_of_adhesion_stated(surface):
    psd = reference_psd(surface)
    spread = adhesion_uncertainty(PRESSURE, psd, E_STAR)
    assert spread.contact_area_ratio.dims == ("medium", "pressure")
    for ending, medium in (("", "wet"), ("_low", "wet"), ("_high", "dry")):
        part = spread.sel(medium=medium)
        work = float(part[f"work_of_adhesion{ending}"])
        expected = adhesion(PRESSURE, psd, E_STAR, work).contact_area_ratio
        np.testing.assert_allclose(part[f"contact_area_ratio{ending}"], expected, rtol=1e-9)
        expected = macroscopic_work_of_adhesion(psd, E_STAR, work).macroscopic_work_of_adhesion
        got = float(part[f"macroscopic_work_of_adhesion{ending}"])
        assert got == pytest.approx(float(expected), rel=1e-9, abs=1e-15)


def test_literature_bounds_leave_the_pull_off_in_glycerol_open_for_the_smooth_surface_only():
    for surface in SURFACES:
        spread = adhesion_uncertainty(1e5, reference_psd(surface), E_STAR)
        low = spread.macroscopic_work_of_adhesion_low > 0
        high = spread.macroscopic_work_of_adhesion_high > 0
        expected = ([True, False], [True, True]) if surface == "Smooth" else ([False] * 2,) * 2
        np.testing.assert_array_equal([low, high], expected)


def test_the_deviation_is_that_of_draws_solved_one_by_one():
    psd = reference_psd("Smooth")
    spread = adhesion_uncertainty(0.0417e6, psd, E_STAR, samples=40, seed=5)
    drawn = sample_work_of_adhesion(PDMS_PMMA_GLYCEROL, 40, seed=5)[1]
    surface = rough_interface(psd, E_STAR, 0.4, 1.0, 200)
    areas = surface.solve(np.full(40, 0.0417e6), drawn, 100).area[:, -1]
    expected = np.std(areas, ddof=1)
    assert float(spread.contact_area_ratio_std.sel(medium="wet")) == pytest.approx(
        expected, rel=5e-3
    )


def test_bounds_hold_value_and_deviation():
    spread = adhesion_uncertainty(PRESSURE, reference_psd("Sb-S"), E_STAR)
    low, high = spread.contact_area_ratio_low, spread.contact_area_ratio_high
    assert ((low <= spread.contact_area_ratio) & (spread.contact_area_ratio <= high)).all()
    assert (spread.contact_area_ratio_std < (high - low) / 2).all()
    again = adhesion_uncertainty(PRESSURE, reference_psd("Sb-S"), E_STAR)
    xr.testing.assert_identical(spread, again)


def test_certain_energies_give_one_area():
    sure = SurfaceEnergies("22 mJ/m^2", "46 mJ/m^2", "64 mJ/m^2", "90 deg", "90 deg")
    spread = adhesion_uncertainty(1e5, reference_psd("Sb-S"), E_STAR, sure)
    for name in ("contact_area_ratio_low", "contact_area_ratio_high"):
        np.testing.assert_allclose(spread[name], spread.contact_area_ratio, rtol=1e-12)
    np.testing.assert_allclose(spread.contact_area_ratio_std, 0, atol=1e-12)


def test_a_liquid_that_wets_leaves_the_area_without_adhesion():
    wets = SurfaceEnergies(
        "22 mJ/m^2", "46 mJ/m^2", "64 mJ/m^2", ("20 deg", "10 deg", "30 deg"), "20 deg"
    )
    psd = reference_psd("Sb-S")
    spread = adhesion_uncertainty(1e5, psd, E_STAR, wets).sel(medium="wet")
    assert float(spread.work_of_adhesion_high) < 0
    expected = contact_area_ratio(1e5, psd, E_STAR)
    assert float(spread.contact_area_ratio) == pytest.approx(expected, rel=1e-9)
    assert float(spread.contact_area_ratio_high) == pytest.approx(expected, rel=1e-9)
    assert float(spread.contact_area_ratio_std) == pytest.approx(0, abs=1e-12)


def test_bad_input_is_named():
    with pytest.raises(AnalysisError, match="pressure"):
        adhesion_uncertainty(-1.0, reference_psd("Sb-S"), E_STAR)
