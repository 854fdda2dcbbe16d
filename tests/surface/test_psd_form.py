"""Form removal: what is taken away is what was put there, and roughness stays."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.core.errors import AnalysisError
from tribolab.surface.form import fill_dropouts, remove_form

X = np.linspace(0, 25e-3, 1001)


def profile(height, x=X):
    dims = ("scan", "x") if height.ndim == 2 else ("x",)
    return xr.Dataset({"height": (dims, height)}, {"x": x})


def circle(radius, centre):
    return np.sign(radius) * np.sqrt(radius**2 - (X - centre) ** 2)


@settings(max_examples=30, deadline=None)
@given(st.floats(0.035, 10.0), st.sampled_from([1, -1]), st.floats(8e-3, 17e-3))
def test_a_circle_leaves_nothing_and_its_radius_is_found(radius, side, centre):
    flat = remove_form(profile(circle(side * radius, centre)))
    assert flat.attrs["form_radius_m"] == pytest.approx(radius, rel=1e-8)
    assert float(abs(flat.height).max()) < 1e-11
    assert np.sign(flat.form_curvature) == -side
    tilt = -side * (12.5e-3 - centre) / np.sqrt(radius**2 - (12.5e-3 - centre) ** 2)
    assert float(flat.form_tilt) == pytest.approx(tilt, rel=1e-6, abs=1e-9)


def test_a_parabola_leaves_micrometres_of_the_paper_s_cylinder():
    left = remove_form(profile(circle(0.07, 12.5e-3)), "polynomial", degree=2)
    # x^4 / (8 R^3) less its share in the parabola, the 4th Legendre polynomial: 8/35
    assert float(np.ptp(left.height.values)) == pytest.approx(
        (8 / 35) * 12.5e-3**4 / (8 * 0.07**3) * (1 + 3 / 7), rel=0.05
    )


def test_roughness_passes_and_each_scan_has_its_own_circle():
    rng = np.random.default_rng(1)
    rough = rng.normal(0, 1e-6, (3, X.size))
    form = np.stack([circle(r, 12e-3) for r in (0.05, 0.07, 0.5)])
    flat = remove_form(profile(form + rough))
    np.testing.assert_allclose(1 / abs(flat.form_curvature), [0.05, 0.07, 0.5], rtol=2e-3)
    np.testing.assert_allclose(flat.height.std("x"), rough.std(1), rtol=2e-3)


def test_a_level_profile_has_no_radius():
    flat = remove_form(profile(np.zeros(X.size)))
    assert flat.attrs["form_radius_m"] == np.inf


def test_tilt_and_polynomials_report_what_they_took():
    flat = remove_form(profile(3e-3 * X + 1.0), "tilt")
    assert float(flat.form_tilt) == pytest.approx(3e-3, rel=1e-9)
    assert float(abs(flat.height).max()) < 1e-12
    bent = remove_form(profile(0.5 * 4.0 * (X - 12.5e-3) ** 2), "polynomial", degree=4)
    assert float(bent.form_curvature) == pytest.approx(4.0, rel=1e-9)
    assert bent.attrs["form_order"] == 4


def test_dropouts_do_not_pull_the_form_and_are_counted():
    height = circle(0.07, 12.5e-3)[None].repeat(2, 0)
    height[0, 100:300] = np.nan
    flat = remove_form(profile(height))
    assert float(abs(flat.height).max()) < 1e-11
    filled = fill_dropouts(flat)
    assert filled.attrs["dropouts"] == 200
    assert filled.attrs["dropout_share"] == pytest.approx(200 / height.size)
    assert int(filled.dropout.sum()) == 200
    assert float(abs(filled.height).max()) < 1e-11


def test_a_tilted_map_is_levelled(shared_data):
    from tribolab.reading.scan_files import read_scans

    tilted = read_scans(shared_data / "nanovea_map_MIT" / "test1.txt", instrument="nanovea_map")
    flat = remove_form(tilted, "tilt")
    # a plane explains most of the 22.5 um, and a second one nothing
    assert float(flat.height.std()) < 0.5 * float(tilted.height.std())
    again = remove_form(flat, "tilt")
    np.testing.assert_allclose(again.height, flat.height, atol=1e-15)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: remove_form(profile(np.zeros(1001)), "cirle"), "'circle'"),
        (lambda: remove_form(profile(np.zeros(3), X[:3])), "too few"),
        (lambda: remove_form(profile(np.zeros(1001)), "polynomial", degree=40), "degree"),
        (lambda: remove_form(profile(np.full(1001, np.nan))), "too\\s+few"),
        (lambda: fill_dropouts(profile(np.full(1001, np.nan))), "leave that scan out"),
        (
            lambda: remove_form(profile(circle(0.07, 12.5e-3), X * 1e-3)),
            "units of the heights",
        ),
    ],
)
def test_what_has_no_form_says_so(call, words):
    with pytest.raises(AnalysisError, match=words):
        call()
