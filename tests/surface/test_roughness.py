"""Roughness parameters and the Gaussian filter, against closed forms and a real instrument."""

import numpy as np
import pytest
import xarray as xr
from real_runs import mitutoyo as workbook

from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import AnalysisError, UnitError
from tribolab.studies import xu2026
from tribolab.surface.filters import gaussian_filter, transmission
from tribolab.surface.roughness import roughness_parameters
from tribolab.surface.spectrum_roughness import spectral_roughness

PITCH = 0.5e-6
X = PITCH * np.arange(40_000)


def profile(height):
    return xr.Dataset({"height": ("x", height)}, {"x": X[: height.size]})


def wave(length, amplitude=1e-6):
    return profile(amplitude * np.sin(2 * np.pi * X / length))


@pytest.fixture(scope="module")
def mitutoyo(shared_data):
    return workbook(shared_data, "mitutoyo_2_mock").squeeze()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "printed", "digit"),
    [
        ("Ra", 3.308e-6, 0.5e-9),
        ("Rq", 3.959e-6, 0.5e-9),
        ("Rz", 18.485e-6, 0.5e-9),
        ("Rsk", -0.144, 0.5e-3),
        ("Rku", 2.463, 0.5e-3),
        ("Rdq", 0.157, 0.5e-3),
    ],
)
def test_the_instrument_s_own_results_come_out_to_their_last_digit(mitutoyo, name, printed, digit):
    found = roughness_parameters(mitutoyo)
    assert found.attrs["filtered_by"] == "instrument"
    assert abs(float(found[name]) - printed) <= 1.0001 * digit


def test_over_the_whole_length_from_its_mean(mitutoyo):
    found = roughness_parameters(mitutoyo, lambda_c=None)
    assert float(found.Ra) == pytest.approx(3.306e-6, abs=0.5e-9)
    assert float(found.Rq) == pytest.approx(3.969e-6, abs=0.5e-9)


@pytest.mark.parametrize("lambda_c", [None, "0.8 mm"])
def test_a_pure_sine_has_its_closed_forms(lambda_c):
    found = roughness_parameters(wave(100e-6), lambda_c=lambda_c)
    loss = 1 if lambda_c is None else 1 - float(transmission(100e-6, 0.8e-3))
    assert float(found.Rq) == pytest.approx(loss * 1e-6 / np.sqrt(2), rel=1e-4)
    assert float(found.Ra) == pytest.approx(loss * 2e-6 / np.pi, rel=1e-4)
    assert float(found.Rz) == pytest.approx(loss * 2e-6, rel=1e-4)
    assert float(found.Rsk) == pytest.approx(0, abs=1e-4)
    assert float(found.Rku) == pytest.approx(1.5, rel=1e-4)
    assert float(found.Rdq) == pytest.approx(loss * 2 * np.pi * 1e-2 / np.sqrt(2), rel=1e-4)


@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0, 2.0, 4.0])
def test_the_filter_transmits_what_the_standard_says(ratio):
    cutoff = 250e-6
    filtered = gaussian_filter(wave(ratio * cutoff), cutoff).height.values
    middle = filtered[5000:-5000]
    # ISO 16610-21: exp(-pi (alpha cutoff / length)^2), alpha = sqrt(ln 2 / pi)
    expected = 1e-6 * np.exp(-np.log(2) / ratio**2)
    fitted = 2 * np.mean(middle**2)
    phase = np.sin(2 * np.pi * X[5000:-5000] / (ratio * cutoff))
    assert 2 * np.mean(middle * phase) == pytest.approx(expected, rel=2e-3, abs=1e-12)
    assert np.sqrt(fitted) == pytest.approx(expected, rel=2e-3, abs=1e-12)


def test_long_and_short_waves_are_parted():
    both = wave(8e-3, 5e-6).height + wave(50e-6).height + wave(3e-6, 0.2e-6).height
    found = roughness_parameters(profile(both.values), lambda_c="0.8 mm", lambda_s="10 um")
    assert float(found.Rq) == pytest.approx(0.7071e-6, rel=0.04)
    assert found.attrs["lambda_c_m"] == 0.8e-3
    assert found.attrs["evaluation_length_m"] == pytest.approx(20e-3 - 0.8e-3)


def test_a_level_profile_passes_the_filter_up_to_its_ends():
    filtered = gaussian_filter(profile(np.full(X.size, 3e-6)), "0.8 mm")
    np.testing.assert_allclose(filtered.height, 3e-6, rtol=1e-9)


def test_gaussian_heights_have_the_moments_of_a_gaussian():
    height = np.random.default_rng(1).normal(0, 1e-6, X.size)
    found = roughness_parameters(profile(height), lambda_c=None)
    assert float(found.Rku) == pytest.approx(3.0, abs=0.1)
    assert float(found.Rsk) == pytest.approx(0.0, abs=0.05)
    assert float(found.Ra / found.Rq) == pytest.approx(np.sqrt(2 / np.pi), rel=0.01)


@pytest.mark.parametrize("name", ["Smooth", "Sb-S", "Sb-R"])
def test_spectral_moments_are_the_paper_s(name):
    found = spectral_roughness(xu2026.psd(name)).isel(wavenumber=-1)
    surface = xu2026.surface(name)
    assert float(found.rms_roughness) == pytest.approx(surface.rms_roughness, rel=2e-3)
    assert float(found.rms_slope) == pytest.approx(surface.rms_slope, rel=2e-3)
    assert float(found.rms_curvature) > 0


def test_cumulative_roughness_grows_and_bounds_bracket():
    psd = xu2026.psd("Sb-S")
    psd = psd.assign(psd_2d_low=0.5 * psd.psd_2d, psd_2d_high=2 * psd.psd_2d)
    found = spectral_roughness(psd)
    assert (np.diff(found.rms_slope) >= 0).all()
    np.testing.assert_allclose(found.rms_slope_high, 2 * found.rms_slope_low, rtol=1e-12)
    assert found.rms_curvature_low.attrs["units"] == "1/m"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: roughness_parameters(profile(np.zeros(40_000)), lambda_c=None), "equal"),
        (lambda: roughness_parameters(profile(np.full(40_000, np.nan))), "fill_dropouts"),
        (lambda: roughness_parameters(wave(1e-4), lambda_c="15 mm"), "shorter than two"),
        (lambda: roughness_parameters(wave(1e-4), lambda_c=np.nan), "lambda_c: a positive"),
        (lambda: gaussian_filter(wave(1e-4), 1e-7), "two points"),
        (lambda: roughness_parameters(profile(np.arange(6.0)), lambda_c=None), "seven points"),
    ],
)
def test_what_has_no_roughness_says_why(call, words):
    with pytest.raises(AnalysisError, match=words):
        call()


def test_a_cutoff_without_a_unit_is_refused():
    with pytest.raises(UnitError, match="lambda_c"):
        roughness_parameters(wave(1e-4), lambda_c="0.8")


def test_info_tells_the_roughness_with_the_cut_off_and_with_none(tmp_path):
    x = 1e-6 * np.arange(8000)
    short, long = (a * np.sin(2 * np.pi * x / s) for a, s in ((1e-6, 0.05e-3), (2e-6, 2e-3)))
    file = tmp_path / "profile.csv"
    rows = [f"{1e3 * at:.4f},{1e6 * z:.6f}" for at, z in zip(x, short + long, strict=True)]
    file.write_text("x [mm],z [um]\n" + "\n".join(rows))
    said = {line.split()[0]: line for line in file_lines(file)[1:]}
    left = 1 - transmission(2e-3, 0.8e-3)  # of the long wave, whose amplitude is twice
    assert float(said["Rq"].split()[1]) == pytest.approx(np.sqrt((1 + 4 * left**2) / 2), rel=0.01)
    assert "longer than 0.8 mm" in said["Rq"]
    assert float(said["Pq"].split()[1]) == pytest.approx(np.sqrt((1 + 4) / 2), rel=0.03)


def test_the_scatter_of_sampling_lengths_is_the_error_of_one_profile():
    """Of many profiles of one surface the parameters scatter by what each says of itself."""
    rng = np.random.default_rng(5)
    q = np.fft.rfftfreq(X.size, PITCH)
    amplitude = np.maximum(q, 5e3) ** -1.3 * (q > 0)
    phases = np.exp(2j * np.pi * rng.random((120, q.size))) * rng.rayleigh(size=(120, q.size))
    height = np.fft.irfft(amplitude * phases, X.size)
    scans = xr.Dataset({"height": (("scan", "x"), height)}, {"x": X})
    found = roughness_parameters(scans)
    assert found.attrs["sampling_lengths"] == 24
    for name in ("Ra", "Rq", "Rz"):
        own = np.sqrt(float((found[f"{name}_sem"] ** 2).mean()))
        assert own == pytest.approx(float(found[name].std(ddof=1)), rel=0.2), name
    assert "Rdq_sem" not in found
    assert "Rq_sem" not in roughness_parameters(scans, lambda_c=None)
    assert "Rq_sem" not in roughness_parameters(scans, lambda_c="8 mm")  # two lengths are too few
