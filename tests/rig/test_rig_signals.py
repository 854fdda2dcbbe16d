"""The virtual rig's signals hold what its truth says, and behave as the paper describes."""

import numpy as np
import pytest
from scipy.stats import skew

from tribolab import rig
from tribolab.core.errors import AnalysisError, UnitError
from tribolab.studies import xu2026

QUIET = rig.Scatter(repeat=0.0, fluctuation=0.0, load_control=0.0)
FEW = rig.Protocol(speeds=(1e-5, 4.64e-4, 1e-2))


def inside(run, row, trim=0.10):
    """Samples of the force log within one trimmed segment."""
    time = run.noise_free.time.values
    cut = trim * (row.stop_s - row.start_s)
    return (time >= row.start_s + cut) & (time <= row.stop_s - cut)


@pytest.fixture(scope="module")
def dry():
    return rig.simulate_run("Smooth", "dry", 31.0, seed=11)


@pytest.fixture(scope="module")
def glycerol():
    return rig.simulate_run("Smooth", "glycerol", 31.0, seed=12)


@pytest.fixture(scope="module")
def rough():
    return rig.simulate_run("Sb-R", "glycerol", "31 N", seed=13)


def test_without_scatter_the_noise_free_signal_is_the_law():
    run = rig.simulate_run("Sb-S", rig=rig.Rig(FEW, QUIET), seed=1)
    law = rig.friction_law("Sb-S", "glycerol", 31.0)
    assert len(run.segments) == 6
    for row in run.segments.itertuples():
        signal = run.noise_free.friction_coefficient.values[inside(run, row)]
        np.testing.assert_allclose(signal, row.direction * law(row.sliding_speed_m_s), rtol=1e-12)


def test_run_in_is_felt_at_the_start_and_dead_after_8_percent():
    run = rig.simulate_run("Sb-R", "dry", rig=rig.Rig(FEW, QUIET), seed=1)
    signal, position = run.noise_free.friction_coefficient, run.noise_free.position
    row = run.segments.iloc[0]
    done = (position / position.max()).values
    first = (run.noise_free.time < row.stop_s).values & (done > 0)
    settled = signal.values[first & (done > 0.08)]
    np.testing.assert_allclose(settled, row.friction_coefficient, rtol=1e-12)
    assert signal.values[first & (done < 0.08)].max() > 1.05 * row.friction_coefficient


@pytest.mark.parametrize("name", ["dry", "glycerol", "rough"])
def test_truth_is_the_mean_of_the_noise_free_signal(name, request):
    run = request.getfixturevalue(name)
    assert len(run.segments) == 26
    for row in run.segments.itertuples():
        signal = row.direction * run.noise_free.friction_coefficient.values[inside(run, row)]
        assert signal.mean() == pytest.approx(row.friction_coefficient_trimmed_mean, rel=1.5e-3)
        # what a last half period of stick-slip and the fluctuation may leave over
        leftover = 0.3 * row.stick_slip_drop / 8 + 0.003 * row.friction_coefficient
        assert abs(row.friction_coefficient_trimmed_mean - row.friction_coefficient) < leftover


def test_whole_segments_keep_the_level_of_the_law(dry):
    for row in dry.segments.itertuples():
        time = dry.noise_free.time.values
        whole = (time >= row.start_s + 0.07 * (row.stop_s - row.start_s)) & (time <= row.stop_s)
        mean = row.direction * dry.noise_free.friction_coefficient.values[whole].mean()
        assert mean == pytest.approx(row.friction_coefficient, rel=0.01)


def test_friction_follows_the_load(rough):
    free = rough.noise_free
    np.testing.assert_allclose(
        free.friction_force, free.friction_coefficient * free.normal_force, rtol=1e-12
    )
    loaded = free.normal_force.values > 0.9 * 31
    assert free.normal_force.values[loaded].std() / 31 == pytest.approx(0.005, rel=0.5)


def test_noise_is_small_and_has_no_mean(rough):
    error = rough.force_log.friction_force - rough.noise_free.friction_force
    error -= rough.facts["friction_force_offset_N"]
    assert 0.04 < float(error.std()) < 0.4
    assert abs(float(error.mean())) < 0.4
    start = rough.force_log.time < 9
    for force in ("friction_force", "normal_force"):
        unloaded = float(rough.force_log[force].where(start).mean())
        assert unloaded == pytest.approx(rough.facts[f"{force}_offset_N"], abs=0.05)


def test_forces_are_whole_counts_of_the_converter(rough):
    counts = rough.force_log.friction_force.values / (1000 / 2**16)
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-9)


def test_motion_returns_and_its_speed_is_the_derivative(rough):
    free = rough.noise_free
    assert abs(float(free.position[-1])) < 1e-12
    for row in rough.segments.itertuples():
        cut = inside(rough, row, 0.01)
        slope = np.polyfit(free.time.values[cut], free.position.values[cut], 1)[0]
        assert slope == pytest.approx(row.direction * row.sliding_speed_m_s, rel=1e-6)
        np.testing.assert_allclose(
            free.sliding_velocity.values[cut], row.direction * row.sliding_speed_m_s, rtol=1e-12
        )


def test_speeds_are_the_papers_thirteen_both_ways(rough):
    assert tuple(rough.segments.sliding_speed_m_s[::2]) == xu2026.SPEEDS
    assert tuple(rough.segments.sliding_speed_m_s[1::2]) == xu2026.SPEEDS
    assert list(rough.segments.direction[:4]) == [1, -1, 1, -1]


@pytest.mark.parametrize(("speed", "force_rate"), [(1e-6, 10.0), (1e-4, 100.0), (1e-2, 1000.0)])
def test_loggers_keep_the_rate_of_the_step(rough, speed, force_rate):
    row = rough.segments.query("sliding_speed_m_s == @speed").iloc[0]
    shift = rough.facts["clock_shift_s"]
    for log, rate, late in (
        (rough.force_log, force_rate, 0.0),
        (rough.motion_log, 0.4 * force_rate, shift),
    ):
        time = log.time.values + late
        steps = np.diff(time[(time > row.start_s) & (time < row.stop_s)])
        assert np.median(steps) == pytest.approx(1 / rate, rel=0.02)
        assert 0.01 < steps.std() * rate < 0.05  # jitter of two samples


@pytest.mark.parametrize("seed", range(6))
def test_time_never_repeats_or_goes_back(seed):
    run = rig.simulate_run("Sb-R", "dry", rig=rig.Rig(FEW), seed=seed)
    assert run.force_log.time.values[0] == 0.0
    for log in (run.force_log, run.motion_log):
        assert np.diff(log.time.values).min() > 0


@pytest.mark.parametrize("seed", range(6))
def test_clock_shift_and_rate_bring_the_logs_together(seed):
    run = rig.simulate_run("Sb-R", "dry", rig=rig.Rig(FEW), seed=seed)
    shift, rate = run.facts["clock_shift_s"], run.facts["clock_rate"]
    assert abs(shift) <= 2 and abs(rate) <= 10e-6
    time = run.motion_log.time.values * (1 + rate) + shift
    # position is smooth where the force log is dense: inside the fastest stroke
    row = run.segments.iloc[-2]
    cut = (time > row.start_s) & (time < row.stop_s)
    true = np.interp(time[cut], run.noise_free.time.values, run.noise_free.position.values)
    # the stamps' 10 us at 1 cm/s are 0.1 um, the encoder's step another 0.1 um
    assert np.abs(run.motion_log.position.values[cut] - true).max() < 3e-7


@pytest.mark.parametrize("name", ["dry", "glycerol", "rough"])
def test_half_loops_of_the_readings_give_the_truth(name, request):
    # the shortest analysis there is: zeros from the unloaded rest, then half the loop of each pair
    run = request.getfixturevalue(name)
    start = run.force_log.time.values < 9
    fx, fz = (run.force_log[n].values for n in ("friction_force", "normal_force"))
    fx, fz = fx - fx[start].mean(), fz - fz[start].mean()
    within = [inside(run, row) for row in run.segments.itertuples()]
    means = np.array([np.mean(fx[cut] / fz[cut]) for cut in within])
    half_loops = (means[::2] - means[1::2]) / 2
    truth = run.segments.friction_coefficient_trimmed_mean.values.reshape(-1, 2).mean(axis=1)
    # three standard deviations of the normal force's drift, one of the friction force's, on 31 N
    cell = rig.ForceCell()
    np.testing.assert_allclose(
        half_loops, truth, rtol=3 * cell.drift / 5 / 31, atol=cell.drift / 31
    )


def test_sticking_slips_abruptly_when_dry_and_round_in_glycerol(dry, glycerol):
    skewness = {}
    for name, run in (("dry", dry), ("glycerol", glycerol)):
        row = run.segments.iloc[0]
        cut = inside(run, row)
        mu = run.force_log.friction_force.values[cut] / run.force_log.normal_force.values[cut]
        smooth = np.convolve(mu, np.ones(4) / 4, mode="valid")
        skewness[name] = skew(np.diff(smooth[::4]))
    assert skewness["dry"] < -3
    assert abs(skewness["glycerol"]) < 0.6


@pytest.mark.parametrize(("name", "drop"), [("dry", 0.18), ("glycerol", 0.20)])
def test_at_least_eight_periods_are_left_at_the_lowest_speed(name, drop, request):
    run = request.getfixturevalue(name)
    row = run.segments.iloc[0]
    signal = run.noise_free.friction_coefficient.values[inside(run, row)]
    swing = signal - row.friction_coefficient
    ups = np.count_nonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    assert ups >= 8
    slid = 0.8 * (row.stop_s - row.start_s) * row.sliding_speed_m_s
    assert slid / ups == pytest.approx(row.stick_slip_wavelength_m, rel=0.12)
    assert np.ptp(signal) == pytest.approx(drop * row.friction_coefficient, rel=0.25)


def test_in_glycerol_stick_slip_is_weaker_and_shorter_at_higher_speed_then_gone(glycerol, dry):
    wet = glycerol.segments.query("direction == 1").set_index("sliding_speed_m_s")
    spread = {}
    for row in glycerol.segments[::2].itertuples():
        signal = glycerol.noise_free.friction_coefficient.values[inside(glycerol, row)]
        spread[row.sliding_speed_m_s] = signal.std() / row.friction_coefficient
    assert spread[1e-6] > 2 * spread[2.15e-6] > 3 * spread[4.64e-6] > 4 * spread[1e-5]
    assert (wet.stick_slip_wavelength_m.loc[:5e-6].diff().dropna() < 0).all()
    assert set(wet.stick_slip.loc[9e-6:]) == {"none"}
    dried = dry.segments.query("direction == 1").set_index("sliding_speed_m_s")
    assert dried.stick_slip_wavelength_m.loc[:1e-4].nunique() == 1
    assert dried.stick_slip_wavelength_m.loc[1e-6] < wet.stick_slip_wavelength_m.loc[1e-6]


@pytest.mark.parametrize("medium", ["dry", "glycerol"])
@pytest.mark.parametrize("surface", ["Sb-S", "Sb-R"])
def test_rough_surfaces_do_not_stick(surface, medium):
    run = rig.simulate_run(surface, medium, rig=rig.Rig(rig.Protocol(speeds=(1e-6,))), seed=4)
    assert set(run.segments.stick_slip) == {"none"}
    for row in run.segments.itertuples():
        signal = run.noise_free.friction_coefficient.values[inside(run, row)]
        assert signal.std() < 0.01 * row.friction_coefficient


def test_repeats_scatter_by_one_percent():
    still = rig.Rig(rig.Protocol(speeds=(1e-2,)))
    factors = [rig.simulate_run(rig=still, seed=seed).facts["repeat_factor"] for seed in range(60)]
    assert np.mean(factors) == pytest.approx(1, abs=0.005)
    assert np.std(factors) == pytest.approx(0.01, rel=0.3)


def test_any_function_of_speed_can_be_the_law():
    run = rig.simulate_run(law=lambda v: 0.2 + 0 * v, slip=rig.StickSlip(), rig=rig.Rig(FEW, QUIET))
    assert set(run.segments.friction_coefficient) == {0.2}


def test_boundary_friction_follows_from_the_fitted_shear_stress():
    # sigma_f A / (A0 p) with the printed areas and pressure
    for name, stress, area in (("Sb-S", 0.84, 0.0692), ("Sb-R", 1.08, 0.0428)):
        plateau = rig.friction_law(name, "glycerol", 31.0)(1e-12)
        assert plateau == pytest.approx(stress * area / 0.0417, rel=3e-3)
    smooth = rig.friction_law("Smooth", "glycerol", 31.0)(1e-9)
    assert smooth == pytest.approx(0.127 * 0.876 / 0.0417, rel=0.01)


def test_dry_shear_stress_of_the_two_rough_surfaces_has_the_published_ratio():
    stress = {
        name: rig.friction_law(name, "dry", 31.0)(1e-4) / xu2026.surface(name).area_ratio_dry
        for name in ("Sb-S", "Sb-R")
    }
    assert stress["Sb-R"] / stress["Sb-S"] == pytest.approx(1.5, rel=0.01)


@pytest.mark.parametrize("load", xu2026.system.loads)
@pytest.mark.parametrize("surface", list(xu2026.surfaces))
def test_lubricated_friction_falls_from_a_plateau(surface, load):
    law = rig.friction_law(surface, "glycerol", load)
    mu = law(np.array(xu2026.SPEEDS))
    assert mu[0] > 0.9 * law(1e-9)
    assert mu.min() < 0.5 * mu[0]
    assert rig.friction_law(surface, "dry", load)(1e-6) > law(1e-6)


def test_smoother_surfaces_are_carried_by_the_film_first():
    # Sb-R is still mixed at 1 cm/s; Sb-S and Smooth have passed their minimum and rise
    lowest = {}
    for name in xu2026.surfaces:
        speeds = np.geomspace(1e-6, 1e-2, 400)
        lowest[name] = speeds[np.argmin(rig.friction_law(name, "glycerol", 31.0)(speeds))]
    assert lowest["Smooth"] < lowest["Sb-S"] < 0.9e-2
    assert lowest["Sb-R"] == pytest.approx(1e-2)


def test_what_the_rig_does_not_know_is_refused():
    with pytest.raises(AnalysisError, match="did you mean 'glycerol'"):
        rig.simulate_run("Sb-S", "glycerin")
    with pytest.raises(AnalysisError, match="no surface 'Rough'"):
        rig.simulate_run("Rough")
    with pytest.raises(UnitError, match="normal_force"):
        rig.simulate_run(normal_force="31 m")
