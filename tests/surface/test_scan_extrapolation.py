"""What a campaign says of a spectrum that it leads on, or does not."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from tribolab.campaign.surfaces import scans as of_scans
from tribolab.core.errors import AnalysisError
from tribolab.reading.scan_files import read_scans
from tribolab.surface.form import fill_dropouts
from tribolab.surface.self_affine import SelfAffine
from tribolab.surface.synthesis import synthesise_profiles


def judged(monkeypatch, scan, **options):
    monkeypatch.setattr(of_scans, "contact_of", lambda surface: None)
    q_low = options.pop("contact", None)
    surface = SimpleNamespace(roughness=options)
    return of_scans.spectra_of_scans(surface, fill_dropouts(scan), q_low)


def test_noise_beside_waves_is_not_led_on_and_what_the_height_lacks_is_said(
    monkeypatch, shared_data
):
    scan = read_scans(shared_data / "cases" / "profile_noise_floor.csv")
    groups, findings = judged(monkeypatch, scan)
    rough = groups["roughness"]
    assert float(rough.rms_roughness) < 1e-6 and float(rough.rms_slope) < 0.1
    (refused,) = (f.message for f in findings if f.severity == "suspect")
    assert "Hurst exponent of -0.6" in refused and "measured waves alone" in refused
    (lacks,) = (f.message for f in findings if "longer waves" in f.message)
    assert "0.399 um" in lacks and "Pq = 0.738 um" in lacks


def test_a_slope_that_the_extrapolation_multiplies_is_said_and_can_be_left_out(monkeypatch):
    rough = SelfAffine(hurst=0.3, rolloff=2e4, plateau=1e-21, low=1e3, high=1e9)
    scan = synthesise_profiles(rough, points=8192, pitch=1e-6, profiles=2, rng=1)
    scan = scan.rename(profile="scan")
    groups, findings = judged(monkeypatch, scan, form="tilt")
    (told,) = (f for f in findings if "extrapolated, not measured" in f.message)
    q_high = told.message.split('q_high = "')[1].split('"')[0]
    assert told.severity == "suspect" and float(groups["roughness"].rms_slope) > 1
    groups, findings = judged(monkeypatch, scan, form="tilt", q_high=q_high)
    assert not any("extrapolated, not measured" in f.message for f in findings)
    measured = groups["roughness"].attrs["measured_rms_slope"]
    assert float(groups["roughness"].rms_slope) == pytest.approx(measured, rel=1e-3)


def test_a_contact_narrower_than_all_measured_waves_is_a_reason(monkeypatch):
    rng = np.random.default_rng(4)
    scan = xr.Dataset({"height": ("x", 1e-7 * rng.standard_normal(2000).cumsum())})
    scan = scan.assign_coords(x=1e-4 * np.arange(2000))
    with pytest.raises(AnalysisError, match="none of them was measured"):
        judged(monkeypatch, scan, contact=1e6)
