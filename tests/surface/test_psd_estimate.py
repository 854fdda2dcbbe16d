"""Spectra of profiles and maps: Parseval, honest bands, and the truth behind rig-like scans."""

import numpy as np
import pytest
import xarray as xr
from scipy.special import erf

from tribolab.rig.scans.profiles import scans as rig_scans
from tribolab.studies import xu2026
from tribolab.surface import self_affine
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.form import remove_form
from tribolab.surface.moments import band, rms_roughness, rms_slope, spectral_moment
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.spectra.reliability import TIP_SHARE
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

PITCH, POINTS = 0.5e-6, 50_001


def cut_from_longer(spectrum, seed, points=POINTS, scans=3):
    """Scans that are not periodic: pieces of a profile several times as long."""
    period = 1 << int(np.ceil(np.log2(points)))
    rough = synthesise_profiles(spectrum, points=scans * period, pitch=PITCH, rng=seed)
    height = rough.height.values.reshape(scans, period)[:, :points]
    return xr.Dataset({"height": (("scan", "x"), height)}, {"x": PITCH * np.arange(points)})


def area_ratio(psd, pressure=0.0417e6, modulus=2e6):
    """Eqs. (6) and (7) of the paper."""
    g = (modulus / pressure) ** 2 * np.pi / 4 * spectral_moment(psd, 3)
    return erf(0.5 / np.sqrt(g))


def covered(spectrum, truth, name):
    inside = (spectrum[f"{name}_low"] <= truth) & (truth <= spectrum[f"{name}_high"])
    return inside.values


def with_form(scans, seed):
    x = scans.x.values - scans.x.values.mean()
    rng = np.random.default_rng(seed)
    offset = rng.uniform(-1e-3, 1e-3, (scans.sizes["scan"], 1))
    return scans.assign(height=scans.height + np.sqrt(0.07**2 - (x - offset) ** 2))


@pytest.mark.slow
@pytest.mark.parametrize("form", ["none", "circle"])
def test_bands_of_95_percent_cover_the_truth_in_95_percent_of_bins(form):
    spectrum = xu2026.surface("Sb-R").spectrum
    one, two = [], []
    for seed in range(25):
        scans = cut_from_longer(spectrum, seed, points=20_001)
        if form == "circle":
            scans = with_form(scans, seed)
        profile = psd_1d(scans, form=form)
        trusted = profile.trusted.values == 1
        truth = self_affine.psd_1d(spectrum, profile.wavenumber.values)
        one.append(covered(profile, truth, "psd_1d")[trusted])
        surface = psd_2d(profile)
        truth = self_affine.psd_2d(spectrum, surface.wavenumber.values)
        two.append(covered(surface, truth, "psd_2d"))
    assert 0.90 <= np.mean(np.concatenate(one)) <= 0.99
    assert 0.90 <= np.mean(np.concatenate(two)) <= 0.99


def test_parseval_holds_on_every_result():
    scans = cut_from_longer(xu2026.surface("Sb-S").spectrum, 1)
    profile = psd_1d(scans, form="none", flanks=1.0)
    window = np.sin(np.pi * (np.arange(POINTS) + 0.5) / POINTS) ** 2
    whole = float((scans.height**2 * window**2).mean() / np.mean(window**2))
    assert profile.attrs["mean_square_height_m2"] == pytest.approx(whole, rel=1e-12)
    assert profile.attrs["parseval_error"] < 1e-10
    # the bins hold all lines but the constant one
    assert float(profile.mean_square_height.sum()) == pytest.approx(whole, rel=1e-3)
    surface = psd_2d(profile)
    assert surface.attrs["parseval_error_binned"] < 1e-3
    # all three together: what the 2D spectrum holds is what the scans hold
    wide = extrapolate(surface, q_low=1.0)
    held = 2 * np.pi * spectral_moment(wide, 1)
    trusted = profile.mean_square_height.where(profile.trusted == 1).sum()
    first = profile.isel(wavenumber=profile.trusted.values == 1).isel(wavenumber=0)
    longer = 2 * float(first.psd_1d * first.wavenumber_low)
    assert held == pytest.approx(float(trusted) + longer, rel=0.02)


def test_a_sine_has_its_power_at_its_wavenumber():
    x = PITCH * np.arange(POINTS)
    q = 2 * np.pi * 100 / (PITCH * POINTS)
    wave = xr.Dataset({"height": (("scan", "x"), 1e-6 * np.sin(q * x)[None])}, {"x": x})
    profile = psd_1d(wave, form="none")
    here = (profile.wavenumber_low < q) & (q < profile.wavenumber_high)
    assert float(profile.mean_square_height.sum()) == pytest.approx(0.5e-12, rel=1e-6)
    assert float(profile.mean_square_height.where(here).sum()) > 0.999 * 0.5e-12


@pytest.mark.parametrize("hurst", [0.5, 0.8, 1.1])
def test_analytic_profiles_give_the_surface_s_contact_area(hurst):
    spectrum = self_affine.SelfAffine(hurst, 5e4, 1e-22, 423.0, np.pi / 1e-9)
    edges = np.geomspace(500, 1e8, 65)
    fine = np.geomspace(edges[:-1], edges[1:], 41)
    values = self_affine.psd_1d(spectrum, fine)
    power = 2 * np.trapezoid(values * fine, np.log(fine), axis=0)
    q = np.sqrt(edges[:-1] * edges[1:])
    profile = xr.Dataset(
        {
            "psd_1d": ("wavenumber", self_affine.psd_1d(spectrum, q)),
            "mean_square_height": ("wavenumber", power),
            "independent_values": ("wavenumber", np.full(q.size, 1e6)),
            "trusted": ("wavenumber", np.ones(q.size, np.int8)),
        },
        {
            "wavenumber": q,
            "wavenumber_low": ("wavenumber", edges[:-1]),
            "wavenumber_high": ("wavenumber", edges[1:]),
        },
    )
    found = psd_2d(profile)
    low, high = float(found.wavenumber[0]), 5e7
    truth = self_affine.tabulate(spectrum)
    assert area_ratio(band(found, low, high)) == pytest.approx(
        area_ratio(band(truth, low, high)), rel=0.01
    )


@pytest.mark.parametrize("name", ["Smooth", "Sb-S", "Sb-R"])
def test_rig_like_scans_alone_give_the_surface(name):
    """Three scans of 25 mm, cylinder, tip and noise: the truth to 1 nm, inside the bands."""
    truth = xu2026.psd(name)
    measured = remove_form(rig_scans(name, 3, seed=11).assign_attrs(tip_radius_m=2e-6))
    assert measured.attrs["form_radius_m"] == pytest.approx(0.07, rel=0.01)
    wide = extrapolate(psd_2d(measured), q_low=423.0)
    low, high = (wide.assign(psd_2d=wide[f"psd_2d_{end}"]) for end in ("low", "high"))
    for moment, tolerance in ((rms_roughness, 0.05), (rms_slope, 0.10)):
        assert moment(wide) == pytest.approx(moment(truth), rel=tolerance)
        assert moment(low) < moment(truth) < moment(high)
    assert area_ratio(wide) == pytest.approx(area_ratio(truth), rel=0.10)
    assert area_ratio(high) < area_ratio(truth) < area_ratio(low)
    hurst = xu2026.surface(name).spectrum.hurst
    assert wide.attrs["hurst_exponent"] == pytest.approx(hurst, abs=0.08)


def test_the_tip_limits_the_band_whatever_the_unit_of_the_file():
    scans = cut_from_longer(xu2026.surface("Sb-R").spectrum, 5, points=20_001)
    free = psd_1d(scans, form="none")
    blunt = psd_1d(scans, form="none", tip_radius="2 um")
    assert blunt.attrs["trusted_high_limited_by"] == "stylus tip"
    assert blunt.attrs["trusted_high_1_m"] < free.attrs["trusted_high_1_m"]
    for text in (2e-6, "0.002 mm", "2000 nm"):
        same = psd_1d(scans, form="none", tip_radius=text)
        assert same.attrs["trusted_high_1_m"] == blunt.attrs["trusted_high_1_m"]
    q = blunt.attrs["trusted_high_1_m"]
    spectrum, k = xu2026.surface("Sb-R").spectrum, np.geomspace(100, q, 4000)
    curvature = np.trapezoid(2 * k**5 * self_affine.psd_1d(spectrum, k), np.log(k))
    assert 2e-6 * np.sqrt(curvature) == pytest.approx(TIP_SHARE, rel=0.25)


def test_noise_ends_the_band_where_it_meets_the_roughness():
    spectrum, noise = xu2026.surface("Smooth").spectrum, 20e-9
    scans = cut_from_longer(spectrum, 3, points=20_001)
    rng = np.random.default_rng(3)
    noisy = scans.assign(height=scans.height + noise * rng.standard_normal(scans.height.shape))
    found = psd_1d(noisy, form="none")
    assert found.attrs["trusted_high_limited_by"] == "noise floor"
    floor = noise**2 * PITCH / (2 * np.pi)
    at_end = self_affine.psd_1d(spectrum, found.attrs["trusted_high_1_m"])
    assert 10 < at_end / floor < 40


def test_filters_of_the_instrument_limit_the_band():
    scans = cut_from_longer(xu2026.surface("Sb-R").spectrum, 5, points=20_001)
    found = psd_1d(scans.assign_attrs(lambda_c_m=0.8e-3, lambda_s_m=8e-6), form="none")
    assert found.attrs["trusted_low_limited_by"] == "lambda_c"
    assert found.attrs["trusted_high_limited_by"] == "lambda_s"
    # ISO 16610-21: 95 % of the power passes at 5.19 lambda_s, and at 0.434 lambda_c
    assert found.attrs["trusted_high_1_m"] <= 2 * np.pi / (5.19 * 8e-6)
    assert found.attrs["trusted_low_1_m"] >= 2 * np.pi / (0.434 * 0.8e-3) * 0.99


def test_more_scans_narrow_the_band_as_their_number_says():
    spectrum = xu2026.surface("Sb-S").spectrum
    many = cut_from_longer(spectrum, 9, points=8001, scans=12)
    few = psd_1d(many.isel(scan=slice(0, 3)), form="none")
    all_ = psd_1d(many, form="none")
    np.testing.assert_allclose(all_.independent_values, 4 * few.independent_values, rtol=0.2)


def test_scans_in_chunks_equal_scans_at_once():
    spectrum = xu2026.surface("Sb-S").spectrum
    scans = cut_from_longer(spectrum, 4, points=8001, scans=40)
    together = psd_1d(scans, form="none")
    single = [psd_1d(scans.isel(scan=[i]), form="none").mean_square_height for i in range(40)]
    np.testing.assert_allclose(together.mean_square_height, np.mean(single, 0), rtol=1e-12)


@pytest.fixture(scope="module")
def maps():
    """Four maps that are not periodic, each cut from a larger one."""
    spectrum = self_affine.SelfAffine(0.8, 6e4, 1e-22, 1e3, 1e9)
    n, pitch, rng = 512, 1e-6, np.random.default_rng(7)
    larger = [synthesise_map(spectrum, points=2 * n, pitch=pitch, rng=rng) for _ in range(4)]
    return spectrum, xr.concat([one.isel(y=slice(n), x=slice(n)) for one in larger], "scan")


def test_a_map_has_the_spectrum_it_was_made_from(maps):
    spectrum, stack = maps
    inside = []
    for scan in range(4):
        found = psd_2d(stack.isel(scan=scan))
        assert found.attrs["parseval_error"] < 1e-10
        use = found.wavenumber.values < 1e6
        truth = self_affine.psd_2d(spectrum, found.wavenumber.values)
        inside.append(covered(found, truth, "psd_2d")[use])
    assert np.mean(np.concatenate(inside)) >= 0.85


def test_maps_of_one_surface_are_averaged_and_narrow_the_band(maps):
    spectrum, stack = maps
    together, single = psd_2d(stack), [psd_2d(stack.isel(scan=scan)) for scan in range(4)]
    mean = np.mean([one.psd_2d for one in single], axis=0)
    np.testing.assert_allclose(together.psd_2d, mean, rtol=1e-12)
    np.testing.assert_allclose(together.independent_values, 4 * single[0].independent_values)
    assert together.attrs["scans"] == 4 and together.attrs["parseval_error"] < 1e-10
    widths = [np.log(one.psd_2d_high / one.psd_2d_low).values for one in (together, single[0])]
    assert (widths[0] < 0.6 * widths[1]).all()
    truth = self_affine.psd_2d(spectrum, together.wavenumber.values)
    use = together.wavenumber.values < 1e6
    assert covered(together, truth, "psd_2d")[use].mean() >= 0.85
