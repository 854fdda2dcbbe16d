"""Repeats combine into a curve whose error knows what spreads them."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from made_runs import strokes, with_friction
from scipy import stats
from scipy.signal import lfilter

from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.reading.run_files import read
from tribolab.reading.runs.logs import group_files
from tribolab.records.frames import friction_columns, rows_of
from tribolab.records.runs.run_facts import friction_facts
from tribolab.report.page_figures.points import run_points
from tribolab.rig.campaign import simulate_campaign
from tribolab.rig.truth import read_truth


def table(speed, mu, sem=0.002, std=0.01, pair=None):
    speed, mu = np.atleast_1d(speed).astype(float), np.atleast_1d(mu).astype(float)
    columns = {
        "sliding_speed": speed,
        "friction_coefficient": mu,
        "friction_coefficient_std": np.broadcast_to(std, mu.shape),
        "friction_coefficient_sem": np.broadcast_to(sem, mu.shape),
        "pair": np.full(mu.size, -1) if pair is None else np.asarray(pair),
    }
    offset = "none: not wanted" if pair is None else "half loop"
    return xr.Dataset(
        {name: ("segment", values) for name, values in columns.items()}, attrs={"offset": offset}
    )


def test_one_run_keeps_its_own_error_and_claims_no_spread_between_runs():
    curve = measured_stribeck_curve([table([1e-4, 1e-3], [0.3, 0.4])])
    assert curve["friction_coefficient"].values.tolist() == [0.3, 0.4]
    assert curve["friction_coefficient_sem"].values.tolist() == [0.002, 0.002]
    assert np.isnan(curve["friction_coefficient_between"].values).all()
    assert curve["runs"].values.tolist() == [1, 1]


def test_two_strokes_of_a_pair_count_once():
    paired = measured_stribeck_curve([table([1e-3, 1e-3], [0.3, 0.3], pair=[0, 0])])
    apart = measured_stribeck_curve([table([1e-3, 1e-3], [0.3, 0.3])])
    assert paired["friction_coefficient_sem"].item() == pytest.approx(0.002)
    assert apart["friction_coefficient_sem"].item() == pytest.approx(0.002 / np.sqrt(2))
    assert paired["segments"].item() == apart["segments"].item() == 2


def test_agreeing_runs_average_as_independent_errors_do():
    rng = np.random.default_rng(0)
    runs = [table(1e-3, 0.3 + 0.002 * rng.standard_normal()) for _ in range(200)]
    curve = measured_stribeck_curve(runs)
    assert curve["friction_coefficient"].item() == pytest.approx(0.3, abs=0.0005)
    assert curve["friction_coefficient_sem"].item() == pytest.approx(0.002 / np.sqrt(200), rel=0.15)


def test_disagreeing_runs_are_known_only_as_well_as_they_agree():
    rng = np.random.default_rng(0)
    means = 0.3 + 0.02 * rng.standard_normal(8)
    curve = measured_stribeck_curve([table(1e-3, mu, sem=0.001) for mu in means])
    assert curve["friction_coefficient_between"].item() == pytest.approx(np.std(means, ddof=1))
    assert curve["friction_coefficient_sem"].item() == pytest.approx(
        np.std(means, ddof=1) / np.sqrt(8)
    )
    assert curve["friction_coefficient_dof"].item() == pytest.approx(7, rel=1e-3)
    assert curve["friction_coefficient_U95"].item() == pytest.approx(
        np.std(means, ddof=1) / np.sqrt(8) * stats.t.ppf(0.975, 7)
    )


@pytest.mark.slow
@pytest.mark.parametrize("runs", [5, 10])
@pytest.mark.parametrize("between", [0.0, 0.01])
def test_error_of_the_curve_covers_the_truth(runs, between):
    rng = np.random.default_rng(1)
    errors = []
    for _ in range(120):
        sems = rng.uniform(0.001, 0.005, runs)
        means = 0.3 + between * rng.standard_normal(runs) + sems * rng.standard_normal(runs)
        curve = measured_stribeck_curve(
            [table(1e-3, mu, sem=s) for mu, s in zip(means, sems, strict=True)]
        )
        errors.append((curve["friction_coefficient"] - 0.3) / curve["friction_coefficient_U95"])
    assert np.mean(np.abs(errors) < 1) >= 0.90


def test_deviation_is_pooled_over_all_segments():
    curve = measured_stribeck_curve([table(1e-3, 0.3, std=0.03), table(1e-3, 0.3, std=0.04)])
    assert curve["friction_coefficient_std"].item() == pytest.approx(np.sqrt(12.5e-4))


def test_scatter_within_a_run_is_told_from_scatter_between_runs():
    runs = [table([1e-3] * 3, [0.29, 0.30, 0.31]), table([1e-3] * 3, [0.39, 0.40, 0.41])]
    curve = measured_stribeck_curve(runs)
    assert curve["friction_coefficient_within"].item() == pytest.approx(0.01)
    assert curve["friction_coefficient_between"].item() == pytest.approx(0.1 / np.sqrt(2))


def test_speeds_within_the_tolerance_belong_together():
    runs = [table([1.00e-3, 2.15e-3], [0.3, 0.4]), table([1.04e-3, 2.10e-3], [0.3, 0.4])]
    assert measured_stribeck_curve(runs).sizes["sliding_speed"] == 2
    assert measured_stribeck_curve(runs, speed_tolerance=0.01).sizes["sliding_speed"] == 4


def test_missing_coefficients_are_left_out():
    curve = measured_stribeck_curve([table([1e-4, 1e-3], [np.nan, 0.4])])
    assert curve["sliding_speed"].values == pytest.approx([1e-3])
    empty = measured_stribeck_curve([table([1e-4], [np.nan])])
    assert empty.sizes["sliding_speed"] == 0


def test_no_run_and_no_coefficient_are_errors():
    with pytest.raises(AnalysisError, match="at least one run"):
        measured_stribeck_curve([])
    with pytest.raises(AnalysisError, match="normal force"):
        measured_stribeck_curve([table(1e-3, 0.3).drop_vars("friction_coefficient")])


@settings(deadline=None, max_examples=30)
@given(
    st.lists(st.floats(0.1, 1.0), min_size=1, max_size=6),
    st.floats(1e-4, 0.05),
    st.floats(0.1, 10),
)
def test_curve_follows_the_scale_and_not_the_order_of_the_runs(means, sem, scale):
    runs = [table(1e-3, mu, sem=sem) for mu in means]
    scaled = [table(1e-3, scale * mu, sem=scale * sem) for mu in reversed(means)]
    a, b = measured_stribeck_curve(runs), measured_stribeck_curve(scaled)
    for name in ("friction_coefficient", "friction_coefficient_sem"):
        assert b[name].item() == pytest.approx(scale * a[name].item(), rel=1e-6)
    assert min(means) - 1e-12 <= a["friction_coefficient"].item() <= max(means) + 1e-12


def test_curve_of_made_runs_has_their_speeds_and_their_law():
    speeds = np.geomspace(1e-5, 1e-2, 4)
    frictions = []
    for seed in range(2):
        run = with_friction(strokes(speeds, samples=200, seed=seed), mu=0.25, offset=3.0, seed=seed)
        frictions.append(friction_coefficient(run, find_segments(run)))
    curve = measured_stribeck_curve(frictions)
    assert curve["sliding_speed"].values == pytest.approx(speeds, rel=0.02)
    assert curve["friction_coefficient"].values == pytest.approx([0.25] * 4, rel=0.01)
    assert curve["segments"].values.tolist() == [4] * 4


@pytest.mark.slow
def test_virtual_rig_is_found_again_within_the_error(tmp_path):
    path = simulate_campaign(tmp_path / "rig", small=True, surfaces=["Sb-R"], seed=3)
    truth = read_truth(path.parent)
    errors = []
    for files in group_files(sorted((path.parent / "raw" / "friction").glob("*.csv"))):
        name = files[0].name.removesuffix("_force.csv")
        shift = truth.facts["runs"][name]["clock_shift_at_middle_s"]
        run = read(files, clock_shift=shift)
        segments = find_segments(run)
        true = truth.segments[name]
        assert segments.sizes["segment"] == len(true)
        assert segments["direction"].values.tolist() == true["direction"].tolist()
        speed = true["sliding_speed_m_s"].to_numpy()
        assert segments["sliding_speed"].values == pytest.approx(speed, rel=0.005)
        friction = friction_coefficient(run, segments)
        assert friction.attrs["offset"] == "half loop"
        mean = true["friction_coefficient_trimmed_mean"].to_numpy().reshape(-1, 2).mean(axis=1)
        found = friction["friction_coefficient"].values.reshape(-1, 2).mean(axis=1)
        errors.append((found - mean) / friction["friction_coefficient_sem"].values[::2])
    errors = np.abs(np.concatenate(errors))
    assert np.mean(errors < 2) >= 0.75
    assert errors.max() < 6


@pytest.mark.parametrize("offset", ["half loop", "unloaded stroke"])
@pytest.mark.parametrize("apart", [0.0, 0.04])
def test_the_table_of_runs_the_card_and_the_curve_have_one_mean_and_error(offset, apart):
    data = {
        "sliding_speed": [1e-3, 1.01e-3],
        "friction_coefficient": [0.30, 0.30 + apart],
        "friction_coefficient_std": [0.01, 0.01],
        "friction_coefficient_sem": [0.002, 0.002],
        "effective_samples": [25.0, 25.0],
        "pair": [0, 0],
    }
    run = xr.Dataset({k: ("segment", v) for k, v in data.items()}, attrs={"offset": offset})
    curve = measured_stribeck_curve([run])
    [mu], [error] = curve.friction_coefficient.values, curve.friction_coefficient_sem.values
    [mark] = friction_facts(run).highlights
    rows = rows_of(friction_columns(run))
    [point] = run_points("r", rows, offset)
    alone = 0.002 / (1 if offset == "half loop" else np.sqrt(2))
    # strokes that disagree are known no better than they agree
    assert error == pytest.approx(alone) if not apart or offset == "half loop" else error > 0.015
    assert (mark.value, point.mu) == pytest.approx((mu, mu))
    wide = float(curve.friction_coefficient_U95[0])
    assert (mark.sem, mark.U95, point.within) == pytest.approx((error, wide, wide))


def test_the_entrainment_speed_may_be_the_abscissa():
    # a ball and a disc at half the slide-to-roll ratio of 0.5: u is twice the sliding speed
    v = np.repeat([0.01, 0.02, 0.04], 300)
    run = xr.Dataset(
        {
            "sliding_velocity": ("time", v * (1 + 1e-4 * np.sin(np.arange(v.size)))),
            "rolling_speed": ("time", 2 * v),
            "slide_roll_ratio": ("time", np.full(v.size, 0.5)),
            "friction_force": ("time", 0.1 * np.log10(v / 1e-3)),
            "normal_force": ("time", np.ones(v.size)),
        },
        {"time": 0.01 * np.arange(v.size)},
        attrs={"friction_force_zero_uncertainty_N": 1e-3},
    )
    friction = friction_coefficient(run, find_segments(run))
    assert friction["slide_roll_ratio"].values == pytest.approx([0.5] * 3)
    sliding = measured_stribeck_curve([friction])
    rolling = measured_stribeck_curve([friction], over="rolling_speed")
    assert rolling["rolling_speed"].values == pytest.approx([0.02, 0.04, 0.08])
    assert rolling["rolling_speed"].attrs["units"] == "m/s"
    assert rolling["friction_coefficient"].values == pytest.approx(
        sliding["friction_coefficient"].values
    )
    both = measured_stribeck_curve([friction] * 2, over="rolling_speed", medium=["a", "b"])
    assert set(both["friction_coefficient"].dims) == {"medium", "rolling_speed"}
    with pytest.raises(AnalysisError, match="no 'temperature'"):
        measured_stribeck_curve([friction], over="temperature")


def test_no_interval_is_shorter_than_the_standard_error_beside_it():
    """Few observations may agree by chance far better than each of them is known."""
    rng = np.random.default_rng(11)
    held = 0
    for _ in range(300):
        runs = [
            xr.Dataset(
                {
                    "sliding_speed": ("segment", [1e-3]),
                    "friction_coefficient": ("segment", [0.3 + 0.01 * rng.standard_normal()]),
                    "friction_coefficient_std": ("segment", [0.05]),
                    "friction_coefficient_sem": ("segment", [0.01]),
                }
            )
            for _ in range(3)
        ]
        curve = measured_stribeck_curve(runs).isel(sliding_speed=0)
        dof = float(curve.friction_coefficient_dof)
        wide = stats.t.ppf(0.975, dof) * float(curve.friction_coefficient_u)
        assert wide >= float(curve.friction_coefficient_sem)
        held += abs(float(curve.friction_coefficient) - 0.3) < wide
    assert held >= 0.93 * 300


def test_strokes_that_wander_together_are_not_independent():
    rng = np.random.default_rng(4)
    count, rho, inside = 119, 0.7, []
    for _ in range(60):
        steps = np.sqrt(1 - rho**2) * rng.standard_normal(count + 60)
        mu = 0.2 + 0.01 * lfilter([1.0], [1.0, -rho], steps)[60:]
        run = xr.Dataset(
            {
                "sliding_speed": ("segment", np.full(count, 1e-2)),
                "friction_coefficient": ("segment", mu),
                "friction_coefficient_std": ("segment", np.full(count, 0.01)),
                "friction_coefficient_sem": ("segment", np.full(count, 1e-3)),
            }
        )
        curve = measured_stribeck_curve([run])
        assert curve.friction_coefficient_dof.item() < 0.6 * count
        off = curve.friction_coefficient.item() - 0.2
        inside.append(abs(off) < 1.96 * curve.friction_coefficient_sem.item())
    assert np.mean(inside) > 0.85  # 0.61 if each counted by itself
