"""Scans with missing heights: what is told of them holds what the whole scan shows."""

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.surface.form import fill_dropouts
from tribolab.surface.gaps import bridge_gaps, cut_ends, gaps_in
from tribolab.surface.roughness import roughness_parameters
from tribolab.surface.self_affine import SelfAffine
from tribolab.surface.spectra.binning import log_bins
from tribolab.surface.spectra.parts import Transform, long_gaps, parts_spectrum
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.spectra.tails import long_holes, tails
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

ROUGH = SelfAffine(hurst=0.8, rolloff=2e5, plateau=1e-25, low=1e4, high=1e8)
MAP = synthesise_map(ROUGH, points=128, pitch=1e-6, rng=7)
LINES = synthesise_profiles(ROUGH, points=4096, pitch=1e-6, profiles=3, rng=7)
LINES = LINES.rename(profile="scan")


def knocked(scans, kind, seed):
    rng = np.random.default_rng(seed)
    shape = scans.height.shape
    holes = rng.random(shape) < 0.1
    if kind == "blobs":
        y, x = np.ogrid[: shape[0], : shape[1]]
        centres = rng.uniform(0, [shape[0], shape[1]], (8, 2))
        holes = np.any([np.hypot(y - a, x - b) < 8 for a, b in centres], axis=0)
    return scans.assign(height=scans.height.where(~holes))


def test_a_plane_is_bridged_exactly_by_straight_lines():
    y, x = np.mgrid[:9, :11].astype(float)
    plane = 2 * x - 3 * y
    missing = np.zeros(plane.shape, bool)
    missing[3:6, 4:7] = True
    np.testing.assert_allclose(bridge_gaps(plane, missing, is_map=False), plane, atol=1e-12)
    inside = bridge_gaps(plane, missing, is_map=True)
    assert inside[~missing].tolist() == plane[~missing].tolist()
    np.testing.assert_allclose(inside[4, 5], plane[4, 5], atol=1e-12)  # by symmetry
    ring = plane[2:7, 3:8][~missing[2:7, 3:8]]
    assert (inside[missing] >= ring.min()).all() and (inside[missing] <= ring.max()).all()


@pytest.mark.parametrize("kind", ["points", "blobs"])
def test_the_spectrum_of_a_map_with_gaps_holds_that_of_the_whole(kind):
    whole, ratios, plain, errors = psd_2d(MAP), [], [], []
    for seed in range(3):
        gappy = knocked(MAP, kind, seed)
        part = psd_2d(gappy)
        same = whole.sel(wavenumber=part.wavenumber)
        ratios.append(np.log(part.psd_2d / same.psd_2d).values / part.gap_error.values)
        errors.append(float(part.gap_error[-1]))
        naive = psd_2d(fill_dropouts(gappy).drop_vars("dropout")).sel(wavenumber=part.wavenumber)
        plain.append(np.log(naive.psd_2d / same.psd_2d).values)
        assert (part.psd_2d_high / part.psd_2d_low > same.psd_2d_high / same.psd_2d_low).all()
    inside = np.mean(np.abs(np.concatenate(ratios)) < 1.96)
    assert inside > 0.85, inside
    if kind == "points":  # bridging alone takes short waves away; that is made up for
        corrected = np.mean([row[-1] * error for row, error in zip(ratios, errors, strict=True)])
        assert np.mean([row[-1] for row in plain]) < -0.05
        assert abs(corrected) < 0.025


def test_dropouts_that_were_filled_before_count_as_gaps():
    gappy = knocked(MAP, "points", 1)
    raw, filled = psd_2d(gappy, form="mean"), psd_2d(fill_dropouts(gappy), form="mean")
    assert "gap_error" in filled
    np.testing.assert_allclose(filled.psd_2d, raw.psd_2d, rtol=0.02)


def test_roughness_of_profiles_with_gaps_holds_that_of_the_whole():
    whole, inside = roughness_parameters(LINES), []
    for seed in range(6):
        part = roughness_parameters(knocked(LINES, "points", seed))
        for name in ("Ra", "Rq", "Rz", "Rdq"):
            away = np.abs(part[name] - whole[name]) / part[f"{name}_gap_error"]
            inside.append((away < 1.96).values)
    assert np.mean(inside) > 0.85
    assert (part.Rdq_gap_error < 0.1 * whole.Rdq).all()


def test_spectra_of_profiles_with_gaps_hold_that_of_the_whole():
    whole, inside = psd_1d(LINES), []
    for seed in range(4):
        part = psd_1d(knocked(LINES, "points", seed))
        away = np.log(part.psd_1d / whole.psd_1d) / part.gap_error
        inside.append((np.abs(away) < 1.96).values[part.trusted.values == 1])
    assert np.mean(np.concatenate(inside)) > 0.88
    assert psd_2d(part).psd_2d.notnull().all()


@pytest.mark.parametrize("share", [0.125, 0.25, 0.5])
def test_a_single_profile_with_one_long_hole_shows_the_surface_with_a_wider_band(share):
    single, inside = LINES.isel(scan=[0]), []
    whole = psd_1d(single)
    for at in (300, 1200, 1900):
        present = (np.arange(4096) < at) | (np.arange(4096) >= at + share * 4096)
        part = psd_1d(single.assign(height=single.height.where(xr.DataArray(present, dims="x"))))
        known = part.trusted.values == 1
        assert known.sum() > whole.trusted.sum() - 4  # as far as without the hole
        away = np.log(part.psd_1d / whole.psd_1d) / part.gap_error
        inside.append((np.abs(away) < 1.96).values[known])
        wider = (part.psd_1d_high / part.psd_1d_low) / (whole.psd_1d_high / whole.psd_1d_low)
        assert (wider.values[known] > 1.0).all()
    assert np.mean(np.concatenate(inside)) > 0.85
    surface, same = psd_2d(part), psd_2d(whole)
    assert surface.psd_2d.notnull().all()
    assert surface.wavenumber.values[-1] == pytest.approx(same.wavenumber.values[-1], rel=0.3)


def test_the_parts_beside_a_hole_see_nothing_of_its_bridge():
    height = LINES.height.values[:1]
    missing = np.zeros(height.shape, dtype=bool)
    missing[:, 1500:2400] = True
    missing[:, 100:103] = True  # short: bridged, and parts nothing
    how = Transform(log_bins(2048, 3, 12), 4096, order=1, flanks=0.5)
    long = long_gaps(missing)
    assert not long[:, :1500].any() and long[:, 1500:2400].all()
    low, high = (parts_spectrum(np.where(long, z, height), missing, how) for z in (0.0, 1.0))
    np.testing.assert_allclose(low.power, high.power, rtol=1e-12)
    assert low.first == np.searchsorted(how.bins.starts, 3 * 4096 / 1500)
    assert parts_spectrum(height, missing & ~long, how) is None


def test_missing_ends_are_cut_off_and_are_no_gaps():
    height = LINES.height.values.copy()
    height[0, :200] = height[1, -100:] = np.nan
    cut = cut_ends(LINES.assign(height=(("scan", "x"), height)))
    assert cut.sizes["x"] == 4096 - 300 and gaps_in(cut) is None
    spectrum = psd_1d(LINES.assign(height=(("scan", "x"), height)))
    same = psd_1d(LINES.isel(x=slice(200, -100)))
    np.testing.assert_allclose(spectrum.psd_1d, same.psd_1d)
    assert "gap_error" not in spectrum


def test_where_gaps_hide_short_waves_the_spectrum_ends():
    rng = np.random.default_rng(2)
    noise = rng.normal(0.0, 1e-6, (128, 128))
    noise[rng.random(noise.shape) < 0.45] = np.nan
    spectrum = psd_2d(MAP.assign(height=(("y", "x"), noise)))
    assert float(spectrum.wavenumber[-1]) < spectrum.attrs["gaps_hide_above_1_m"] < np.pi / 1e-6


def test_more_gaps_than_heights_are_refused():
    rng = np.random.default_rng(1)
    few = MAP.assign(height=MAP.height.where(rng.random((128, 128)) < 0.4))
    with pytest.raises(AnalysisError, match="of the heights are missing"):
        psd_2d(few)
    with pytest.raises(AnalysisError, match="of the heights are missing"):
        roughness_parameters(few, lambda_c=None)


def test_results_with_gaps_are_the_same_each_time():
    gappy = knocked(MAP, "blobs", 4)
    xr.testing.assert_identical(
        psd_2d(gappy).drop_attrs(), psd_2d(gappy.copy(deep=True)).drop_attrs()
    )


def test_the_error_of_a_row_counts_its_own_gaps_and_not_those_of_other_rows():
    area = synthesise_map(ROUGH, points=128, pitch=1e-6, rng=3)
    whole = roughness_parameters(area, lambda_c=None)
    missing = np.zeros((128, 128), dtype=bool)
    missing[:64, :64] = True
    gappy = area.assign(height=area.height.where(~missing))
    rough = roughness_parameters(gappy, lambda_c=None)
    untouched = rough.isel(y=slice(64, None))
    np.testing.assert_array_equal(untouched.Rq_gap_error, 0.0)
    np.testing.assert_allclose(untouched.Rq, whole.Rq[64:])
    held = abs(rough.Rq - whole.Rq)[:64] <= 1.96 * rough.Rq_gap_error[:64]
    assert float(held.mean()) > 0.85


def test_ra_of_a_profile_that_lacks_half_in_one_piece_lies_within_its_error():
    for seed in range(4):
        line = synthesise_profiles(ROUGH, points=4096, pitch=1e-6, profiles=1, rng=seed)
        line = line.isel(profile=0)
        whole = roughness_parameters(line)
        rough = roughness_parameters(
            line.assign(height=line.height.where(abs(line.x - 2e-3) > 1e-3))
        )
        assert abs(float(rough.Ra - whole.Ra)) < 1.96 * float(rough.Ra_gap_error)


def test_skewness_and_kurtosis_beside_a_long_hole_are_those_of_what_was_measured():
    # a bridge over half of a profile made each height beside it an outlier: Rku was 13 of 3
    whole = roughness_parameters(LINES)
    for start in (300, 1200, 1900):
        holes = LINES.assign(height=LINES.height.where(abs(LINES.x * 1e6 - start - 1000) > 1000))
        rough = roughness_parameters(holes)
        for name, far in (("Rsk", 1.0), ("Rku", 1.5)):
            error = rough[f"{name}_gap_error"]
            assert (abs(rough[name] - whole[name]) < 2.5 * error).all(), (name, start)
            assert (error > 0).all() and (error < far).all(), (name, start)


def test_moments_of_whole_lengths_know_nothing_of_a_length_that_is_missing():
    rows = np.random.default_rng(3).normal(0, 1e-6, (2, 4, 500))
    missing = np.zeros(rows.shape, bool)
    missing[:, 2] = True
    assert long_holes(missing).all()
    assert not long_holes(np.zeros(rows.shape, bool)).any()
    tail = tails(np.where(missing, 1e3, rows), missing)
    left = np.delete(rows, 2, axis=1)
    square = np.mean(left**2, axis=-1)
    np.testing.assert_allclose(
        tail["Rku"].value, (np.mean(left**4, axis=-1) / square**2).mean(axis=-1), rtol=1e-12
    )
    # white noise: skewness of 500 points scatters by sqrt(6/500), a length of four is missing
    least = np.sqrt(6 / 500 * (1 / 3 - 1 / 4))
    assert ((tail["Rsk"].error > 0.99 * least) & (tail["Rsk"].error < 3 * least)).all()
    nothing = tails(rows, np.ones(rows.shape, bool))
    assert np.isnan(nothing["Rsk"].value).all()
