"""The sliding mode: regimes, evidence and verdict, on curves whose answer is known."""

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.friction.oscillation.slip_curve import frequency_scaling, one_curve, stick_slip_curve
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.segments.find import find_segments
from tribolab.regime.lubrication_regimes import end_of_boundary, measured_regimes, model_regimes
from tribolab.regime.model import LOCAL, NO_STICK_SLIP, SUSPECTED, UNEXPLAINED, UNKNOWN, Mode
from tribolab.regime.verdict import sliding_mode
from tribolab.rig import simulate_trace

SPEEDS = np.geomspace(1e-6, 1e-2, 13)


def curve(mu):
    return xr.Dataset({"friction_coefficient": ("sliding_speed", mu)}, {"sliding_speed": SPEEDS})


def slips(form, speeds=(1e-6, 2e-6, 4e-6), drops=(0.2, 0.2, 0.2), wavelength=22e-6, power=0.0):
    """One result of stick_slip for each speed; the wavelength goes with a power of the speed."""
    found = []
    for k, (v, drop) in enumerate(zip(speeds, drops, strict=True)):
        kind = form if drop else "none"
        run = simulate_trace(
            kind,
            speed=v,
            drop=drop,
            noise=0.005,
            wavelength=wavelength * (v / 1e-6) ** power,
            seed=k,
        )
        found.append(stick_slip(run, find_segments(run)))
    return found


@pytest.fixture(scope="module")
def saw():
    return stick_slip_curve(slips("sawtooth"))


@pytest.fixture(scope="module")
def quiet():
    return stick_slip_curve(slips("none", drops=(0, 0, 0)))


plateau = 2.6 * np.exp(-((SPEEDS / 2e-5) ** 1.5)) + 0.02 * (SPEEDS / 1e-2) ** 0.4


def modelled(end):
    """A model that leaves its boundary regime at a speed."""
    v = np.geomspace(1e-9, 1e-2, 60)
    share = 1 / (1 + v / end)
    data = {
        "friction_coefficient": ("sliding_speed", 2.6 * share + 0.02 * (v / 1e-2) ** 0.4),
        "solid_load_share": ("sliding_speed", share),
    }
    return xr.Dataset(data, {"sliding_speed": v})


def test_regimes_follow_plateau_fall_and_rise():
    found = measured_regimes(curve(plateau))
    assert end_of_boundary(SPEEDS, found) == pytest.approx(4.64e-6, rel=0.01)
    assert found[-1] == "hydrodynamic"
    assert found[5] == "mixed"
    # a curve that falls from the first speed on has no plateau
    assert np.isnan(end_of_boundary(SPEEDS, measured_regimes(curve(SPEEDS**-0.3))))
    assert end_of_boundary(*_model_end(1e-7)) < 2e-8


def _model_end(end):
    model = modelled(end)
    return model["sliding_speed"].values, model_regimes(model)


def test_stick_slip_with_macroscopic_adhesion_is_suspected_and_not_claimed(saw):
    known = Mode(work_of_adhesion=0.02, work_of_adhesion_range=(0.0, 0.04))
    found = sliding_mode(curve(plateau), modelled(1e-8), saw, known, name="Smooth")
    assert found.verdict == SUSPECTED
    assert "suspected" in found.text
    assert "may be zero" in found.paragraph
    sides = [(piece.topic, piece.side) for piece in found.evidence]
    assert ("traces", "for") in sides and ("adhesion", "for") in sides
    assert ("adhesion", "against") in sides
    sure = Mode(work_of_adhesion=0.02, work_of_adhesion_range=(0.01, 0.04))
    sides = [(p.topic, p.side) for p in sliding_mode(curve(plateau), None, saw, sure).evidence]
    assert ("adhesion", "against") not in sides
    assert any("plateau reaches" in p.text and p.side == "for" for p in found.evidence)
    assert found.decide


def test_stick_slip_without_macroscopic_adhesion_is_local(saw):
    found = sliding_mode(curve(plateau), None, saw, Mode(work_of_adhesion=0.0))
    assert found.verdict == LOCAL
    assert sliding_mode(curve(plateau), None, saw).verdict == UNEXPLAINED


def test_no_stick_slip_is_said_to_be_none_whatever_adhesion_would_allow(quiet):
    for work in (0.0, 0.02, None):
        found = sliding_mode(curve(plateau), None, quiet, Mode(work_of_adhesion=work))
        assert found.verdict == NO_STICK_SLIP
        assert found.text == "steady sliding, no stick-slip at any speed"
        assert "suspected" not in found.text
    assert sliding_mode(curve(plateau)).verdict == UNKNOWN


def test_a_model_that_fits_explains_the_curve_and_one_that_misses_does_not(quiet):
    model = modelled(1e-5)
    place = np.log(model["sliding_speed"].values)
    mu = np.interp(np.log(SPEEDS), place, model["friction_coefficient"].values)
    known = Mode(work_of_adhesion=0.0)
    good = sliding_mode(curve(mu), model, quiet, known)
    assert good.numbers["model_misfit"] < 1e-12
    assert good.text.endswith("; mixed lubrication explains it to within 10 % of the peak friction")
    assert "alone does not explain it" in sliding_mode(curve(mu), modelled(1e-8), quiet, known).text


def test_friction_that_falls_with_speed_speaks_for_the_rig_and_one_that_does_not_against_it(saw):
    # the traces of `saw` oscillate from 1 to 4 um/s
    for slope, side, words in (
        (-0.2, "against", "stiffness of the rig would look the same"),
        (0.0, "for", ""),
    ):
        measured = curve(2.6 * (SPEEDS / 1e-6) ** slope)
        found = sliding_mode(measured, None, saw, Mode(work_of_adhesion=0.02))
        said = [p for p in found.evidence if "where the traces oscillate" in p.text]
        assert [p.side for p in said] == [side]
        assert words in said[0].text


def test_uniform_slip_needs_the_papers_friction_of_order_ten(saw):
    known = Mode(
        work_of_adhesion=0.02,
        area_ratio=0.876,
        pressure=0.042e6,
        rough_shear_stress=0.84e6 / 1.7,
        youngs_modulus=1.5e6,
    )
    found = sliding_mode(curve(plateau), None, saw, known)
    assert found.numbers["uniform_friction"] == pytest.approx(10.3, abs=0.1)
    assert any("would need µ = 10" in piece.text for piece in found.evidence)


def test_forced_wetting_sets_in_between_the_last_stick_slip_and_the_fall():
    slip = stick_slip_curve(
        slips("rounded", (1e-6, 2.15e-6, 4.64e-6, 1e-5), (0.5, 0.25, 0.1, 0.0), 40e-6)
    )
    found = sliding_mode(curve(plateau), None, slip, Mode(work_of_adhesion=0.02))
    low, high = (found.numbers[f"forced_wetting_{end}_m_s"] for end in ("low", "high"))
    assert 2e-6 < low <= 5e-6 < 9e-6 < high < 5e-5
    assert any("weaken" in piece.text for piece in found.evidence)
    dry = sliding_mode(curve(plateau), None, slip, Mode(work_of_adhesion=0.02, fluid=False))
    assert "wetting" not in dry.paragraph


def test_frequency_goes_with_speed_or_it_does_not(saw):
    assert saw.attrs["scaling_exponent"] == pytest.approx(1, abs=0.05)
    assert "wavelength is fixed" in saw.attrs["scaling"]
    # a wavelength that grows as the speed is a fixed frequency
    fixed = stick_slip_curve(slips("sawtooth", power=1.0))
    assert abs(fixed.attrs["scaling_exponent"]) < 0.05
    assert "fixed" in fixed.attrs["scaling"] and "wavelength" not in fixed.attrs["scaling"]
    ringing = sliding_mode(curve(plateau), None, fixed, Mode(work_of_adhesion=0.02))
    assert ringing.verdict == UNEXPLAINED
    assert any(one.side == "against" and "resonance" in one.text for one in ringing.evidence)
    assert "vibration" in ringing.decide[0]
    shrinking = stick_slip_curve(slips("rounded", power=-0.4))
    assert abs(shrinking.attrs["scaling_exponent"] - 1.4) < 3 * shrinking.attrs["scaling_error"]


def test_a_sine_of_one_frequency_in_runs_of_one_speed_each_is_the_rigs():
    fixed = stick_slip_curve(slips("rounded", power=1.0))
    assert fixed["waveform"].values.tolist() == ["smooth sliding"] * fixed.sizes["sliding_speed"]
    found = sliding_mode(curve(plateau), None, fixed, Mode(work_of_adhesion=0.02))
    assert found.verdict == NO_STICK_SLIP
    own = fixed.attrs["resonance_frequency_Hz"]
    assert any("resonance" in one.text and f"{own:.3g} Hz" in one.text for one in found.evidence)
    # a fixed wavelength is none
    assert "resonance_frequency_Hz" not in stick_slip_curve(slips("rounded")).attrs


def test_the_models_band_says_at_how_many_speeds_it_may_be_right(quiet):
    measured = curve(plateau)
    mu = measured["friction_coefficient"]
    band = xr.Dataset({"friction_coefficient_low": 0.9 * mu, "friction_coefficient_high": 1.1 * mu})
    inside = sliding_mode(measured, measured, quiet, band=band)
    assert inside.numbers["speeds_in_band"] == inside.numbers["speeds_with_band"] == mu.size
    assert any(f"{mu.size} of {mu.size} speeds" in one.text for one in inside.evidence)
    beyond = sliding_mode(measured, measured, quiet, band=band + 0.3 * mu)
    assert beyond.numbers["speeds_in_band"] == 0


def test_an_oscillation_without_whole_cycles_is_told_without_drops(saw):
    cut = saw.assign(drop=saw["drop"] * np.nan)
    found = sliding_mode(curve(plateau), None, cut, Mode(work_of_adhesion=0.02))
    assert not any("nan" in one.text for one in found.evidence)


def test_scaling_needs_three_speeds(quiet, saw):
    assert "not known" in quiet.attrs["scaling"]
    assert frequency_scaling(saw.isel(sliding_speed=[0, 1])).speeds == 2


def test_stick_slip_over_speed_counts_segments_and_averages(saw):
    twice = stick_slip_curve([*slips("sawtooth"), *slips("sawtooth")])
    assert twice["segments"].values.tolist() == [2, 2, 2]
    assert twice["drop"].values == pytest.approx(saw["drop"].values)
    with pytest.raises(AnalysisError, match="at least one run"):
        stick_slip_curve([])


def test_curves_of_several_systems_are_those_of_each_side_by_side(saw, quiet):
    ringing = stick_slip_curve(slips("rounded", power=1.0, speeds=(1e-6, 2e-6, 8e-6)))
    runs = slips("sawtooth") + slips("none", drops=(0, 0, 0))
    runs += slips("rounded", power=1.0, speeds=(1e-6, 2e-6, 8e-6))
    media = ["dry"] * 3 + ["oil"] * 3 + ["on a spring"] * 3
    curves = stick_slip_curve(runs, medium=media)
    assert curves["waveform"].dims == ("medium", "sliding_speed")
    assert curves.sizes["sliding_speed"] == 4  # that of one system is empty for the others
    known = Mode(work_of_adhesion=0.02)
    for medium, alone in (("dry", saw), ("oil", quiet), ("on a spring", ringing)):
        part = one_curve(curves.sel(medium=medium))
        for name in ("waveform", "segments"):
            assert part[name].values.tolist() == alone[name].values.tolist()
        for name in ("scaling_exponent", "scaling_error"):
            np.testing.assert_equal(curves[name].sel(medium=medium).item(), alone.attrs[name])
            assert curves[name].attrs["long_name"]
        for name in ("scaling", "resonance_frequency_Hz"):
            assert part.attrs.get(name) == alone.attrs.get(name)
        whole, own = (
            sliding_mode(curve(plateau), None, slip, known)
            for slip in (curves.sel(medium=medium), alone)
        )
        assert whole.paragraph == own.paragraph
    with pytest.raises(AnalysisError, match="medium: one label for each of 9 runs"):
        stick_slip_curve(runs, medium=["dry"])


def test_a_map_of_curves_over_a_dim_is_that_of_each(saw, quiet):
    from tribolab import plot

    runs = slips("sawtooth") + slips("none", drops=(0, 0, 0))
    curves = stick_slip_curve(runs, run=["saw"] * 3 + ["quiet"] * 3)
    maps = plot.waveform_map(curves), plot.waveform_map({"quiet": quiet, "saw": saw})
    names = [[text.get_text() for text in one.axes[0].get_yticklabels()] for one in maps]
    assert names == [["quiet", "saw"]] * 2
    assert plot.figure_data(maps[0]).equals(plot.figure_data(maps[1]))


def test_a_spectrogram_shows_the_oscillation_above_its_background():
    from tribolab.figures.subjects.slip_spectrum import power_levels

    run = simulate_trace("sawtooth", noise=0.01, samples=4000, seed=3)
    slip = stick_slip(run, find_segments(run))
    _, frequency, level = power_levels(slip)
    near = np.abs(np.log(frequency / slip["dominant_frequency"].item())) < 0.1
    assert level[near].max() > 2  # decades above the background
    assert np.median(level) < 1
    assert power_levels(slip.assign(psd=slip["psd"] * np.nan)) is None
