"""Spectra of almost no degrees of freedom come to a band or a reason, and to no warning."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from tribolab.campaign.surfaces import scans as of_scans
from tribolab.core.errors import AnalysisError
from tribolab.surface.form import fill_dropouts
from tribolab.surface.self_affine import SelfAffine, psd_1d
from tribolab.surface.spectra.annuli import confidence_band
from tribolab.surface.spectra.areal import psd_2d_of_map
from tribolab.surface.spectra.smooth_law import fitted_law

POINTS = 200
LINE = np.arange(POINTS)
SHAPES = {
    "walk": lambda rng: np.cumsum(rng.standard_normal((1, POINTS)), 1),
    "white": lambda rng: rng.standard_normal((1, POINTS)),
    "wave": lambda rng: np.sin(LINE * rng.uniform(0.05, 2.0))[None],
    "step": lambda rng: (LINE > 70.0)[None] * 1.0,
    "point": lambda rng: (LINE == 90)[None] * 1.0,
    "saw": lambda rng: (LINE % 17.0)[None],
    "fall": lambda rng: np.exp(-LINE / 5.0)[None],
    "smooth": lambda rng: np.cumsum(np.cumsum(rng.standard_normal((1, POINTS)), 1), 1),
    "gaps": lambda rng: np.where((LINE > 60) & (LINE < 130), np.nan, rng.standard_normal(POINTS))[
        None
    ],
}


@pytest.mark.parametrize("kind", SHAPES)
@pytest.mark.parametrize("q_low", [None, 1e3, 1e6])
def test_a_spectrum_has_a_finite_band_or_a_reason(monkeypatch, kind, q_low):
    monkeypatch.setattr(of_scans, "contact_of", lambda surface: None)
    rng = np.random.default_rng(3)
    scan = xr.Dataset(
        {"height": (("scan", "x"), 1e-6 * SHAPES[kind](rng))}, {"x": 3e-6 * np.arange(POINTS)}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            surface = SimpleNamespace(roughness={"form": "tilt"})
            groups, _ = of_scans.spectra_of_scans(surface, fill_dropouts(scan), q_low)
        except AnalysisError as error:
            assert len(error.what) > 20
            return
    assert float(groups["roughness"].Pq.mean()) > 0
    for name in ("psd_2d", "psd_2d_low", "psd_2d_high"):
        assert "psd" not in groups or np.isfinite(groups["psd"][name].values).all()


def test_a_band_widens_steadily_where_hardly_a_value_is_independent():
    independent = np.concatenate([[0.0, 1e-9], np.geomspace(1e-3, 100, 60)])
    with np.errstate(all="raise"):
        low, high = confidence_band(np.ones(independent.size), independent)
    assert np.isfinite(high).all() and (low > 0).all()
    assert (np.diff(high) <= 0).all() and (np.diff(low) >= 0).all()
    at_one = confidence_band(np.ones(2), np.array([1 - 1e-9, 1.0]))
    np.testing.assert_allclose(at_one[1][0], at_one[1][1], rtol=1e-6)


def test_what_a_spectrum_leaves_open_is_known_within_the_bounds_of_the_fit():
    """Below a roll-off that lies beyond the last bin no Hurst exponent can be seen."""
    q = np.geomspace(1e3, 3e3, 4)
    flat = psd_1d(SelfAffine(0.8, 1e6, 1e-21, 1.0, 1e12), q)
    law = fitted_law(q, flat, np.full(4, 0.7))
    errors = np.sqrt(np.diag(law.covariance))
    assert np.isfinite(errors).all() and errors[1] < 4.0 / np.sqrt(12) * 1.001


def test_points_of_a_map_that_share_no_wavenumbers_are_a_reason():
    rng = np.random.default_rng(0)
    grid = {"y": 2e-2 * np.arange(60), "x": 2e-5 * np.arange(60)}
    scan = xr.Dataset({"height": (("y", "x"), 1e-6 * rng.standard_normal((60, 60)))}, grid)
    with pytest.raises(AnalysisError, match="20 um apart along x and 2e.04 um along y"):
        psd_2d_of_map(scan)
