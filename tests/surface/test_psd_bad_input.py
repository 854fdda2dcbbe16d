"""Scans that cannot give a spectrum, or only part of one: a defined answer or a clear error."""

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.studies import xu2026
from tribolab.surface import self_affine
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.form import remove_form
from tribolab.surface.roughness import roughness_parameters
from tribolab.surface.spectra.abel import Annuli
from tribolab.surface.spectra.annuli import merge_annuli
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.synthesis import synthesise_profiles

PITCH = 0.5e-6


def profiles(height, pitch=PITCH):
    height = np.atleast_2d(height)
    x = pitch * np.arange(height.shape[1])
    return xr.Dataset({"height": (("scan", "x"), height)}, {"x": x})


def rough(points, scans=3, seed=1, name="Sb-S"):
    spectrum = xu2026.surface(name).spectrum
    period = 1 << int(np.ceil(np.log2(max(points, 32_768))))
    drawn = synthesise_profiles(spectrum, points=period * scans, pitch=PITCH, rng=seed)
    return profiles(drawn.height.values.reshape(scans, period)[:, :points])


def test_a_single_scan_has_a_spectrum_with_a_wider_band():
    three = rough(20_001)
    one = psd_2d(three.isel(scan=[0]), form="none")
    all_ = psd_2d(three, form="none")
    assert one.attrs["scans"] == 1
    bands = [np.log(s.psd_2d_high / s.psd_2d_low).values[-3:].mean() for s in (one, all_)]
    assert bands[0] == pytest.approx(np.sqrt(3) * bands[1], rel=0.25)
    bare = psd_2d(three.isel(scan=0), form="none")  # without a dimension for scans
    np.testing.assert_allclose(bare.psd_2d, one.psd_2d)


def test_a_scan_shorter_than_the_rolloff_says_what_it_does_not_know():
    surface = psd_2d(rough(2001, scans=2, name="Sb-R"), form="tilt")
    wide = extrapolate(surface, q_low=423.0)
    # 1 mm; the surface rolls off at 0.22 mm, four waves in the scan
    assert wide.wavenumber[0] == 423.0
    short = psd_2d(rough(301, scans=2, name="Sb-R"), form="tilt")
    assert extrapolate(short, q_low=423.0).attrs["rolloff"].startswith("not reached")


def test_noise_alone_is_not_trusted():
    white = profiles(1e-9 * np.random.default_rng(2).standard_normal((3, 4096)))
    profile = psd_1d(white, form="none")
    assert profile.trusted.sum() == 0
    assert profile.attrs["trusted_high_limited_by"] == "noise floor"
    with pytest.raises(AnalysisError, match="noise floor.*longer or finer scans"):
        psd_2d(profile)


def test_a_grating_has_no_isotropic_spectrum():
    x = PITCH * np.arange(20_001)
    grating = 1e-6 * np.sin(2 * np.pi * x / 100e-6) + 1e-9 * np.cumsum(
        np.random.default_rng(1).standard_normal((3, x.size)), axis=1
    )
    surface = psd_2d(profiles(grating), form="none")
    assert (surface.psd_2d > 0).all()  # the annuli below the grating's are joined with it


def test_profiles_of_no_isotropic_surface_are_named():
    edges = np.array([1e3, 2e3, 4e3])
    found = Annuli(edges, np.array([-2.0, -1.0]), np.eye(2), 1.0, 1.0)
    with pytest.raises(AnalysisError, match="isotropic"):
        merge_annuli(found, found, np.array([0.1, 0.1]))


ONE_D = xr.Dataset({"psd_2d": ("wavenumber", [1.0, 2.0])}, {"wavenumber": [1.0, 2.0]})


@pytest.mark.parametrize(
    ("scans", "words"),
    [
        (profiles(np.zeros((3, 1000))), "all heights are equal"),
        (profiles(np.full((3, 1000), np.nan)), "too few for the form|fill_dropouts"),
        (
            profiles(np.where(np.arange(1000) % 5 > 1, np.nan, 1e-6 * np.sin(np.arange(1000)))),
            "60% of the heights are missing",
        ),
        (profiles(np.arange(10.0)), "too few for a spectrum"),
        (profiles(np.arange(1000.0)).assign_coords(x=np.arange(1000.0) ** 2), "even steps"),
        (profiles(np.arange(1000.0)).assign_coords(x=-np.arange(1000.0)), "even steps"),
        ([rough(1000), rough(2000)], "equal pitch and length"),
        (ONE_D, "read_scans"),
        (
            xr.Dataset({"height": (("a", "b", "x"), np.ones((2, 2, 99)))}, {"x": np.arange(99.0)}),
            "dim",
        ),
    ],
)
def test_what_has_no_spectrum_says_why(scans, words):
    with pytest.raises(AnalysisError, match=words):
        psd_1d(scans)
    with pytest.raises(AnalysisError, match=words):
        psd_2d(scans)


X = PITCH * np.arange(20_001)
SMOOTH = {
    "equal": np.full(X.size, 1e-6),
    "tilted": 1e-6 + 0.01 * X,
    "equal, far off": np.full(X.size, -3.7e-3),
}


@pytest.mark.parametrize("form", ["auto", "none", "tilt"])
@pytest.mark.parametrize("kind", SMOOTH)
def test_rounding_is_not_taken_for_roughness(kind, form):
    scan = profiles(SMOOTH[kind])
    for spectrum in (psd_1d, psd_2d):
        with pytest.raises(AnalysisError, match="all heights are equal.*leave that scan out"):
            spectrum(scan, form=form)
    with pytest.raises(AnalysisError, match="roughness_parameters: .*without rounding"):
        roughness_parameters(remove_form(scan, "circle"))
    for cut in ("auto", None):
        with pytest.raises(AnalysisError, match="roughness_parameters: .*without rounding"):
            roughness_parameters(scan, lambda_c=cut)


def test_the_one_level_scan_among_rough_ones_is_named():
    scans = rough(4096)
    scans.height[1] = 1e-6
    with pytest.raises(AnalysisError, match="psd_1d: scan 2: all heights are equal"):
        psd_1d(scans, form="none")
    named = scans.assign(file=("scan", ["a.csv", "b.csv", "c.csv"]))
    with pytest.raises(AnalysisError, match=r"psd_1d: b\.csv: all heights"):
        psd_1d(named)


def test_the_last_digits_of_a_gauge_are_roughness():
    # 24 bits over the range: 1e-7 of the largest height, and no more than that
    digits = np.random.default_rng(1).integers(0, 2, X.size) * 1e-10
    gauge = profiles(1e-3 + digits)
    assert psd_1d(gauge, form="none").attrs["mean_square_height_m2"] > 0
    found = roughness_parameters(gauge, lambda_c=None)
    assert found.Rq.item() == pytest.approx(5e-11, rel=1e-3)


def test_a_perfect_plane_has_no_spectrum():
    plane = 1e-6 + np.add.outer(0.3 * X[:200], 0.1 * X[:200])
    for form in ("auto", "none", "tilt"):
        scan = xr.Dataset({"height": (("y", "x"), plane)}, {"y": X[:200], "x": X[:200]})
        with pytest.raises(AnalysisError, match="psd_2d: all heights are equal.*plane"):
            psd_2d(scan, form=form)
    with pytest.raises(AnalysisError, match=r"psd_2d\(\) takes its spectrum"):
        psd_1d(scan)


@pytest.mark.parametrize(
    ("height", "words"),
    [
        (np.full((64, 64), 1e-6), "all heights are equal"),
        (np.zeros((64, 64)), "all heights are equal"),
        (np.full((64, 64), np.nan), "too\\s+few"),
        (np.where(np.eye(64) > 0, np.nan, np.arange(64.0)), "all heights are equal"),
        (np.eye(8), "too small"),
    ],
)
def test_maps_without_a_spectrum_say_why(height, words):
    axis = 1e-6 * np.arange(height.shape[0])
    scan = xr.Dataset({"height": (("y", "x"), height)}, {"y": axis, "x": axis})
    with pytest.raises(AnalysisError, match=words):
        psd_2d(scan)


def test_one_dimension_of_units_does_not_leak_into_another():
    surface = psd_2d(rough(8001), form="none")
    assert surface.psd_2d.attrs["units"] == "m4"
    assert surface.wavenumber.attrs["units"] == "1/m"
    q = surface.wavenumber.values
    truth = self_affine.psd_2d(xu2026.surface("Sb-S").spectrum, q)
    assert np.median(surface.psd_2d.values / truth) == pytest.approx(1, abs=0.15)
