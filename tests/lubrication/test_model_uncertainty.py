"""The band on a model curve: each end is a model of its own, and the whole is what is said."""

from dataclasses import replace

import numpy as np
import pytest
from contact_cases import CONTACT, reference_psd

from tribolab.core.errors import AnalysisError
from tribolab.fit.model_error import model_uncertainty
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.moments import band, rms_roughness

SPEEDS = np.array([1e-9, 1e-5, 1e-4, 1e-3, 1e-1])
GIVEN = {"viscosity": 1.4, "load": 310.0, "shear_stress": 0.84e6, "speed": SPEEDS}
RANGES = {
    "viscosity_range": ("0.98 Pa s", 1.82),  # 30 % off
    "youngs_modulus_range": ("1.35 MPa", "1.65 MPa"),
    "load_range": (280.0, "340 N/m"),
    "radius_range": (0.066, "7.4 cm"),
}
BOTH = ("viscosity", "Young's modulus", "load", "radius")  # have two ends
WIDTH = 1.21  # of the made band


def measured_psd():
    """Sb-S as if measured from 1e3 to 1e6 1/m with an even band, and extrapolated."""
    seen = band(reference_psd("Sb-S", points=60), 1e3, 1e6)
    seen["psd_2d_low"], seen["psd_2d_high"] = seen.psd_2d / WIDTH, seen.psd_2d * WIDTH
    return extrapolate(seen, q_low=423.0)


@pytest.fixture(scope="module")
def spread():
    return model_uncertainty(
        CONTACT, measured_psd(), shear_stress_error="0.01 MPa", **RANGES, **GIVEN
    )


@pytest.mark.slow
def test_the_band_holds_the_curve_and_every_variation(spread):
    low, high = spread.friction_coefficient_low, spread.friction_coefficient_high
    assert (low <= spread.friction_coefficient).all()
    assert (spread.friction_coefficient <= high).all()
    assert (low > 0).all()
    each = spread.friction_coefficient_varied
    assert (each.max(["variation", "range_end"]) <= high * (1 + 1e-12)).all()
    assert (each.min(["variation", "range_end"]) >= low * (1 - 1e-12)).all()
    # independent unknowns do not all err at once
    together = np.log(each / spread.friction_coefficient).max("range_end").clip(0).sum("variation")
    assert (np.log(high / spread.friction_coefficient) < together).all()


def test_everything_on_the_list_is_varied(spread):
    assert spread.variation.values.tolist() == [
        "spectrum band",
        "spectrum at long waves",
        "Hurst exponent",
        "spectrum at short waves",
        "percolation threshold",
        "cut-off of <1/u>",
        "elastic-energy factor",
        "theory of the contact area",
        "rough body",
        "friction factors",
        "flow and shear factors",
        "contact pressure p(u)",
        "viscosity",
        "Young's modulus",
        "load",
        "radius",
        "inlet length",
        "outlet",
        "shear stress",
    ]
    assert spread.friction_coefficient_high.attrs["units"] == "1"
    assert spread.largest_change_speed.attrs["units"] == "m/s"
    ends = spread.variation_low.str.len() + spread.variation_high.str.len()
    assert (ends > 0).all()


def test_a_spectrum_times_a_number_moves_the_plateau_by_its_root(spread):
    """In boundary lubrication mu = sigma_f A/F, and A goes as one over the rms slope."""
    one = spread.sel(variation="spectrum band")
    plateau = one.friction_coefficient_varied.isel(sliding_speed=0) / one.friction_coefficient[0]
    np.testing.assert_allclose(plateau, [WIDTH**0.5, WIDTH**-0.5], rtol=4e-3)
    # a sigma_f fitted to the same measured curve moves the other way, less as transitions move too
    assert WIDTH**-0.5 - 1 < one.shear_stress_change_low < -0.05
    assert 0.05 < one.shear_stress_change_high < WIDTH**0.5 - 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "end", "change"),
    [
        ("rough body", "high", {"rough_body": "moving"}),
        ("friction factors", "low", {"friction_factors": False}),
        ("viscosity", "low", {"viscosity": 0.98}),
        ("viscosity", "high", {"viscosity": 1.82}),
        ("load", "high", {"load": 340.0}),
        ("radius", "low", {"contact": replace(CONTACT, radius=0.066)}),
        ("Young's modulus", "low", {"contact": replace(CONTACT, youngs_modulus=1.35e6)}),
        ("Young's modulus", "high", {"contact": replace(CONTACT, youngs_modulus=1.65e6)}),
        ("inlet length", "low", {"inlet_length": CONTACT.radius}),
    ],
)
def test_an_end_is_the_curve_of_that_model(spread, name, end, change):
    direct = stribeck_curve(**{"contact": CONTACT, "psd": measured_psd(), **GIVEN, **change})
    found = spread.friction_coefficient_varied.sel(variation=name, range_end=end)
    np.testing.assert_allclose(found, direct.friction_coefficient, rtol=3e-3)
    other = {"low": "high", "high": "low"}[end]
    missing = spread.friction_coefficient_varied.sel(variation=name, range_end=other)
    assert bool(missing.isnull().all()) == (name not in BOTH)


def test_each_unknown_moves_the_curve_where_it_must(spread):
    where = spread.largest_change_speed.to_series()
    assert where["spectrum band"] == 1e-9
    assert where["shear stress"] == 1e-9
    assert where["inlet length"] == 1e-1  # drag in the wide gap
    assert where["viscosity"] in (1e-4, 1e-3)  # where the fluid takes over
    assert 1e-5 <= where["percolation threshold"] <= 1e-3  # where the fluid takes over
    assert 1e-5 <= where["flow and shear factors"] <= 1e-3
    # at 310 N/m Sb-S is never compressed to 0.28 h_rms
    assert float(spread.largest_change.sel(variation="contact pressure p(u)")) < 1e-8
    # 1.96 standard errors of 1.2 % each
    change = float(spread.largest_change.sel(variation="shear stress"))
    assert change == pytest.approx(1.96 * 0.01 / 0.84, rel=1e-3)


@pytest.mark.slow
def test_a_fitted_shear_stress_takes_up_what_scales_the_area():
    psd = measured_psd()[["psd_2d"]]
    given = GIVEN | {"speed": [1e-9, 1e-8]}
    fixed, fitted = (
        model_uncertainty(CONTACT, psd, **given, measured_to=1e6, refit=refit)
        for refit in (False, True)
    )
    widths = [
        float(np.log(one.friction_coefficient_high / one.friction_coefficient_low)[0])
        for one in (fixed, fitted)
    ]
    assert widths[0] > 0.2
    assert widths[1] < 1e-3
    # on the plateau sigma_f and area change places
    ratio = fixed.friction_coefficient_varied.isel(sliding_speed=0) / fixed.friction_coefficient[0]
    for end in ("low", "high"):
        change = fixed[f"shear_stress_change_{end}"].values
        np.testing.assert_allclose(1 + change, 1 / ratio.sel(range_end=end), rtol=1e-3)
    assert "psd_2d_low" in fixed.attrs["not_varied"]
    assert "shear_stress_error" in fixed.attrs["not_varied"]


def test_a_viscosity_30_percent_off_halves_or_doubles_friction_at_a_millimetre_a_second(spread):
    """The transition shifts along the speed, where friction falls as steeply as that."""
    one = spread.sel(variation="viscosity").friction_coefficient_varied.sel(sliding_speed=1e-3)
    low, high = (one / spread.friction_coefficient.sel(sliding_speed=1e-3)).values
    assert low > 1.5
    assert high < 0.8
    # the band holds it
    top = float(spread.friction_coefficient_high.sel(sliding_speed=1e-3))
    assert top >= float(one.sel(range_end="low")) * (1 - 1e-12)


def test_all_that_is_held_fixed_is_named(spread):
    fixed = ("geometry and load", "liquid", "cavitation", "elasticity")
    rough = ("shear stress in the contact", "contact area", "roughness")
    named = [one.split(": ")[0] for one in spread.attrs["not_varied"].split("; ")]
    assert named == [*fixed, *rough]  # nothing else: all ranges were given
    # table of a layer: 3.5061 mm of 3.7168 mm, 56.42 kPa of 53.10 kPa; 3.1564 mm, 63.56 kPa
    text = spread.attrs["not_in_model"]
    assert "10 mm would change the contact's width by −6 % and its highest pressure by +6 %" in text
    assert (
        "5 mm would change the contact's width by −15 % and its highest pressure by +20 %" in text
    )
    assert "load: length and Poisson's ratio are taken as stated" in spread.attrs["not_varied"]
    bare = model_uncertainty(CONTACT, None, **GIVEN | {"speed": [1e-2]})
    text = bare.attrs["not_varied"]
    assert "radius, length, Poisson's ratio and normal force are taken as stated" in text
    for name in (*fixed, "viscosity: no viscosity_range was given", "Young's modulus: no youngs_"):
        assert name in text
    assert "contact area" not in text


def test_smooth_surfaces_have_the_inlet_alone():
    given = {**GIVEN, "speed": [1e-2, 1e-1]}
    both = model_uncertainty(CONTACT, None, **given)
    assert both.variation.values.tolist() == ["inlet length", "outlet"]
    assert float(both.largest_relative_change.sel(variation="outlet")) == pytest.approx(
        0.11448 / 0.07045 - 1, rel=5e-3
    )
    spread = model_uncertainty(CONTACT, None, **given, outlet="vented")
    assert spread.variation.values.tolist() == ["inlet length"]
    cut, full = (
        stribeck_curve(CONTACT, None, **given, **more, cells=100).friction_coefficient
        for more in ({"inlet_length": 0.07}, {})
    )
    np.testing.assert_allclose(
        spread.friction_coefficient_low / spread.friction_coefficient, cut / full, rtol=1e-9
    )
    np.testing.assert_array_equal(spread.friction_coefficient_high, spread.friction_coefficient)
    stated = model_uncertainty(CONTACT, None, **given, inlet_length="20 mm", outlet="vented")
    assert stated.variation.size == 0
    assert "inlet length: it is stated" in stated.attrs["not_varied"]


def test_the_result_survives_a_file(spread, tmp_path):
    write_netcdf(spread, tmp_path / "band.nc")
    back = read_netcdf(tmp_path / "band.nc")
    np.testing.assert_array_equal(back.friction_coefficient_low, spread.friction_coefficient_low)
    assert back.variation_high.values.tolist() == spread.variation_high.values.tolist()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed": [0.0, 1e-4]}, "above zero"),
        ({"measured_to": 1e12}, "outside the spectrum"),
        ({"load": 0.0}, "load"),
        ({"shear_stress_error": "-1 Pa"}, "shear_stress_error"),
        ({"shear_stress": -1.0}, "shear_stress"),
        ({"viscosity_range": (1.5, 1.6)}, "viscosity_range: 1.5 to 1.6 Pa s must go from below"),
        ({"youngs_modulus_range": ("1 MPa", "0 MPa")}, "youngs_modulus_range"),
        ({"load_range": (320.0, 340.0)}, "load_range: 320 to 340 N/m must go from below"),
        ({"radius_range": (0.0, 0.1)}, "radius_range"),
    ],
)
def test_what_has_no_band_is_refused(change, words):
    given = {**GIVEN, "speed": [1e-4], **change}
    with pytest.raises(AnalysisError, match=words):
        model_uncertainty(CONTACT, reference_psd("Sb-S"), **given)


@pytest.mark.slow
def test_a_band_is_found_for_a_roughness_near_the_cut_off_of_gaps():
    psd = reference_psd("Sb-S")
    fine = psd * (12e-9 / rms_roughness(psd)) ** 2
    found = model_uncertainty(CONTACT, fine, **(GIVEN | {"speed": [1e-9, 1e-3]}))
    assert "cut-off" in " ".join(found.variation.values.tolist())
    assert np.all(found.friction_coefficient_low < found.friction_coefficient_high)
