"""Checks on scans: each fault is found where it is, and good scans are left in peace."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from real_runs import mitutoyo

import tribolab as tl
from tribolab import rig
from tribolab.core.errors import AnalysisError, ConfigError, UnitError
from tribolab.qc.flags import SUSPECT
from tribolab.qc.register import STATUSES
from tribolab.qc.scan import profiles
from tribolab.qc.scan.checks import SCAN_CHECKS, check_scans
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.extent import doubt_about_heights, impossible_heights
from tribolab.reading.scans.results import read_tester_results
from tribolab.rig.scans.faults import SCAN_FAULTS, exported, strike

LENGTH = 6e-3


@pytest.fixture(scope="module")
def clean():
    return exported(rig.scans("Sb-R", seed=1003, length=LENGTH))


def status(found, check):
    return max((r.status for c, r in found.results if c.name == check), key=STATUSES.index)


def made(height, pitch=1e-6, **attrs):
    return xr.Dataset({"height": ("x", height)}, {"x": pitch * np.arange(height.size)}, attrs)


def rough(seed=0, points=4096):
    return 1e-8 * np.random.default_rng(seed).standard_normal(points).cumsum()


# ---- the virtual rig


@pytest.mark.parametrize("surface", ["Smooth", "Sb-S", "Sb-R"])
def test_clean_scans_of_the_rig_pass_every_check(surface):
    found = check_scans(exported(rig.scans(surface, seed=1001, length=LENGTH)))
    assert found.status == "pass", found.table[["check", "status", "message"]].to_string()


@pytest.mark.parametrize("name", SCAN_FAULTS)
def test_each_fault_is_found_as_gravely_as_it_is(clean, name):
    fault = SCAN_FAULTS[name]
    found = check_scans(strike(clean, name, 1003))
    assert STATUSES.index(status(found, fault.check)) >= STATUSES.index(fault.severity)


@pytest.mark.parametrize("name", SCAN_FAULTS)
def test_faults_are_seeded_and_change_nothing_in_place(clean, name):
    before = clean.copy(deep=True)
    one, again = strike(clean, name, 5), strike(clean, name, 5)
    assert one.identical(again)
    assert clean.identical(before)
    assert not one.identical(clean)


def test_the_odd_scan_is_named(clean):
    struck = strike(clean, "odd_scan", 8)
    changed = [n for n in range(3) if not np.array_equal(struck.height[n], clean.height[n])]
    found = check_scans(struck)
    message = found.table.query("check == 'repeats'").message.item()
    assert message.startswith(str(clean.file.values[changed[0]]))


def test_flags_stand_where_the_heights_are_missing(clean):
    struck = strike(clean, "dropouts", 2)
    flagged = check_scans(struck).flagged
    missing = np.isnan(struck.height.values)
    bit = 1 << SCAN_CHECKS["dropouts"].bit
    np.testing.assert_array_equal((flagged.height_qc_tests.values & bit) > 0, missing)
    assert (flagged.height_qc.values[missing] == 9).all()


# ---- real scans


@pytest.mark.slow
def test_real_profiles_a_person_would_accept_are_not_failed(shared_data):
    scans = [
        read_scans(shared_data / "bearing_profiles_MIT" / "NU206-RE-1.txt"),
        read_scans(shared_data / "bearing_profiles_MIT" / "NU208-IR-1.txt"),
        read_scans(shared_data / "nanovea_map_MIT" / "test1.txt", "nanovea_map"),
        read_scans(shared_data / "surfacetopography_MIT" / "dektak-1.csv"),
        mitutoyo(shared_data, "mitutoyo_2_mock"),
        read_scans(
            shared_data / "surfacetopography_MIT" / "xy-4.txt", x_unit="mm", height_unit="um"
        ),
    ]
    for scan in scans:
        found = check_scans(scan)
        assert found.status in ("pass", "suspect"), found.table.to_string()


def test_dektak_s_rounded_positions_are_told_as_rounding(shared_data):
    found = check_scans(read_scans(shared_data / "surfacetopography_MIT" / "dektak-1.csv"))
    row = found.table.query("check == 'spacing'").iloc[0]
    assert row.status == "pass"
    assert "are uneven" in row.message and "rounding" in row.message
    assert row.value == pytest.approx(0.3, abs=0.05)


def test_results_that_do_not_belong_to_their_profile_are_found(shared_data):
    # the README of the data calls this workbook noise: its Ra is an eighth of the profile's
    found = check_scans(mitutoyo(shared_data, "mitutoyo_mock"))
    assert status(found, "results") == "fail"


def test_what_the_instrument_could_not_compute_is_found(shared_data, clean):
    results = read_tester_results(shared_data / "mitutoyo_sj410_res_MIT" / "12A11003.TXT")
    table = check_scans(clean, results=results).table
    row = table.query("check == 'results' and variable == 'results'").iloc[0]
    assert row.status == "suspect"
    assert "Rc: Err110; RPc: Err110; RSm: Err110" in row.message


# ---- single checks


def test_a_jump_is_found_at_its_place_and_a_flank_is_none():
    height = rough()
    height[1500:] += 5e-7
    assert np.flatnonzero(profiles.steps(height) == SUSPECT).tolist() == [1500]
    flank = rough()
    flank += 5e-7 * np.clip((np.arange(flank.size) - 1500) / 10, 0, 1)
    assert not (profiles.steps(flank) == SUSPECT).any()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_steps_do_not_depend_on_scale_or_height(seed, scale, offset):
    height = rough(seed % 1000, 1024)
    height[500:] += 1e-6
    one = profiles.steps(height)
    np.testing.assert_array_equal(one, profiles.steps(scale * height + offset * 1e-6))


def test_gaussian_roughness_has_no_steps():
    counts = [(profiles.steps(rough(seed, 20_000)) == SUSPECT).sum() for seed in range(20)]
    assert sum(counts) == 0


def test_a_range_cut_off_is_found_at_top_and_bottom():
    height = 1e-9 * np.round(1e3 * np.sin(np.linspace(0, 50, 5000)))
    assert not (profiles.flag_clipping(np.round(rough(), 9), 8) == SUSPECT).any()
    top = np.minimum(height + np.round(1e-1 * rough(1, 5000), 9), 0.8e-6)
    assert (profiles.flag_clipping(top, 8) == SUSPECT).sum() == (top == 0.8e-6).sum() > 100


def test_of_two_scans_that_differ_none_is_blamed_alone():
    rows = np.stack([rough(0, 8192), 3 * rough(0, 8192)])
    data = xr.Dataset({"height": (("scan", "x"), rows)}, {"x": 1e-6 * np.arange(8192)})
    row = check_scans(data).table.query("check == 'repeats'").iloc[0]
    assert row.status in ("suspect", "fail")
    assert row.message.startswith("the spectra of the two scans differ")
    assert row.value == pytest.approx(9.0, rel=1e-6)  # three times the height


def test_repeats_of_one_random_surface_agree():
    for seed in range(10):
        rows = np.stack([rough(10 * seed + n, 8192) for n in range(3)])
        data = xr.Dataset({"height": (("scan", "x"), rows)}, {"x": 1e-6 * np.arange(8192)})
        assert status(check_scans(data), "repeats") == "pass"


def test_n_points_are_a_length_of_n_or_n_minus_one_steps():
    for steps in (4095, 4096):
        found = check_scans(made(rough(), stated_length_m=steps * 1e-6))
        assert status(found, "length") == "pass"
    assert status(check_scans(made(rough(), stated_length_m=4.3e-3)), "length") == "suspect"
    assert status(check_scans(made(rough(), stated_length_m=4.1)), "length") == "fail"


def test_each_stacked_scan_keeps_its_own_stated_length(tmp_path):
    for number, length in ((1, 3.999), (2, 3.999), (3, 12.5)):
        rows = "".join(f"{n / 1000:.4f},{n % 7}\n" for n in range(4000))
        text = f"# Surftest profile\n# length: {length} mm\nx [mm],z [um]\n{rows}"
        (tmp_path / f"s_{number}.csv").write_text(text)
    found = check_scans(read_scans(tmp_path / "s_*.csv"), skip=["repeats"])
    row = found.table.query("check == 'length'").iloc[0]
    assert row.status == "fail" and "12.5 mm" in row.message


def test_roughness_of_few_digits_is_quantisation_also_where_it_was_levelled_after():
    slope = 3.7e-8 * np.arange(4096)
    for coarse in (1e-7 * np.round(rough() / 1e-7), 1e-7 * np.round(rough() / 1e-7) - slope):
        assert status(check_scans(made(coarse)), "rounding") == "suspect"
    fine = made(1e-9 * np.round(rough() / 1e-9))
    assert status(check_scans(fine), "rounding") == "pass"


def test_rq_is_given_with_and_without_a_grain_and_a_sound_profile_has_none(clean):
    height = clean.height.values[0].copy()
    sound = clean.isel(scan=[0])
    assert status(check_scans(sound), "outliers") == "pass"
    x = clean.x.values - clean.x.values.mean()
    struck = height + np.maximum(0.0, 4e-4 - np.abs(x) * 40)
    row = check_scans(sound.assign(height=(("scan", "x"), struck[None]))).table.query(
        "check == 'outliers'"
    )
    rq = float(sound.attrs["instrument_Rq_m"].split("; ")[0])
    told = [float(part.split(" um")[0].split()[-1]) for part in row.message.item().split("; ")[1:2]]
    without = float(row.message.item().split(" um without")[0].split()[-1])
    assert row.status.item() == "suspect"
    assert told[0] > 1.05e6 * rq
    assert without == pytest.approx(1e6 * rq, rel=0.05)


@pytest.mark.parametrize("noise", [0.0, 1e-8])
def test_a_stuck_stylus_is_found_where_it_is_and_a_bridged_gap_is_none(clean, noise):
    height = clean.height.values[:1].copy()
    stuck = slice(2000, 2000 + height.shape[1] // 5)
    rng = np.random.default_rng(0)
    height[0, stuck] = height[0, 2000] + noise * rng.standard_normal(stuck.stop - stuck.start)
    struck = clean.isel(scan=[0]).assign(height=(("scan", "x"), height))
    found = check_scans(struck)
    assert status(found, "stuck_stylus") == "suspect"
    bit = 1 << SCAN_CHECKS["stuck_stylus"].bit
    flagged = np.flatnonzero(found.flagged.height_qc_tests.values[0] & bit)
    assert abs(flagged[0] - stuck.start) < 20 and abs(flagged[-1] - stuck.stop) < 20
    height[0, stuck] = np.nan
    gap = clean.isel(scan=[0]).assign(height=(("scan", "x"), height))
    assert status(check_scans(gap), "stuck_stylus") == "pass"


def test_a_stop_is_found_under_the_noise_of_the_gauge(clean):
    rng = np.random.default_rng(0)
    height = clean.height.values[:1]
    stopped = np.minimum(height, np.quantile(height, 0.95)) + 2e-8 * rng.standard_normal(
        height.shape
    )
    struck = clean.isel(scan=[0]).assign(height=(("scan", "x"), stopped))
    assert status(check_scans(struck), "clipping") == "fail"
    noisy = clean.isel(scan=[0]).assign(
        height=(("scan", "x"), height + 2e-8 * rng.standard_normal(height.shape))
    )
    assert status(check_scans(noisy), "clipping") == "pass"


@pytest.mark.parametrize(
    "height",
    [np.full(4096, 1e-6), 1e-6 + 1e-8 * np.arange(4096), np.zeros(4096)],
    ids=["equal", "tilted", "zero"],
)
def test_a_scan_without_roughness_fails(height):
    found = check_scans(made(height))
    assert status(found, "level") == "fail"
    assert "rounding alone" in found.table.query("check == 'level'").message.item()
    plane = height[:40] + height[:40, None]
    axis = 1e-6 * np.arange(40)
    data = xr.Dataset({"height": (("y", "x"), plane)}, {"y": axis, "x": axis})
    assert status(check_scans(data), "level") == "fail"


def test_a_map_with_level_rows_is_no_level_map():
    steps = np.repeat(1e-9 * np.array([0, 1, 1, 0, 2, 1, 0, 0])[:, None], 512, axis=1)
    data = xr.Dataset(
        {"height": (("y", "x"), steps)}, {"x": 1e-6 * np.arange(512), "y": 1e-6 * np.arange(8)}
    )
    assert status(check_scans(data), "level") == "pass"
    assert status(check_scans(made(np.round(rough(), 9))), "level") == "pass"


# ---- odd input


@pytest.mark.parametrize(
    "height",
    [np.full(500, np.nan), np.zeros(500), np.arange(500.0), np.ones(2), np.ones(70)],
    ids=["nothing", "level", "ramp of metres", "two points", "short"],
)
def test_no_scan_crashes_a_check(height):
    found = check_scans(made(height))
    assert found.status != "error", found.table.query("status == 'error'").message.tolist()


def test_a_map_is_checked_by_rows():
    height = np.stack([rough(n, 512) for n in range(8)])
    height[3, 7] = np.nan
    data = xr.Dataset(
        {"height": (("x", "y"), height.T)}, {"x": 1e-6 * np.arange(512), "y": 1e-6 * np.arange(8)}
    )
    found = check_scans(data)
    assert found.status != "error"
    assert found.flagged.height_qc.dims == ("x", "y")
    assert found.flagged.height_qc.values[7, 3] == 9
    assert "row 4" in found.table.query("check == 'dropouts'").message.item()


def test_every_check_explains_itself_and_has_a_bit_of_its_own():
    bits = [check.bit for check in SCAN_CHECKS.values()]
    assert len(set(bits)) == len(bits) and max(bits) < 31
    for check in SCAN_CHECKS.values():
        assert check.question.endswith("?") and check.cure.endswith(".")
        assert all(limit.reason and limit.unit for limit in check.limits.values())


def test_limits_and_names_are_the_user_s():
    tilted = made(rough() + 0.06 * 1e-6 * np.arange(4096))
    assert status(check_scans(tilted), "form") == "pass"
    limits = {"form": {"tilt": "2 deg"}}
    assert status(check_scans(tilted, limits=limits), "form") == "suspect"
    assert status(check_scans(tilted, skip=["form"]), "form") == "skipped"
    with pytest.raises(ConfigError, match="did you mean 'form'"):
        check_scans(tilted, limits={"from": {}})
    with pytest.raises(ConfigError, match="no check is called"):
        check_scans(tilted, skip=["nothing"])
    for value in (-0.1, float("nan")):
        with pytest.raises(ConfigError, match="must not be negative"):
            check_scans(tilted, limits={"form": {"tilt": value}})
    with pytest.raises(UnitError, match="tilt"):
        check_scans(tilted, limits={"form": {"tilt": "2 mm"}})
    with pytest.raises(AnalysisError, match="read_scans"):
        check_scans(xr.Dataset({"force": ("time", [1.0])}))
    with pytest.raises(ConfigError, match="no fault of scans"):
        strike(exported(rig.scans("Sb-R", length=2e-3)), "stepps")


def test_a_map_whose_heights_are_far_larger_than_itself_is_suspect(shared_data):
    scan = read_scans(shared_data / "surfacetopography_MIT/gwyddion-export-german.txt")
    assert "span 14.8 m on a length of 8.23e-06 m" in scan.attrs["doubtful"]
    x = 1e-6 * np.arange(32)
    rough = np.random.default_rng(2).normal(0, 1e-7, (32, 32))
    bare = xr.Dataset({"height": (("y", "x"), rough)}, {"y": x, "x": x})
    assert doubt_about_heights(bare) == "" and impossible_heights(bare) == ""
    assert "rms slope" in doubt_about_heights(bare.assign(height=1000 * bare.height))
    assert "no instrument" in impossible_heights(bare.assign(height=1e6 * bare.height))


def test_the_public_check_takes_scans_alone_and_compares_those_of_a_list():
    scans = [made(rough(1)), made(rough(2)), made(9 * rough(3))]
    assert tl.check(scans[0]).rows == check_scans(scans[0]).rows
    assert [found.status for found in tl.check(scans)] == ["pass", "pass", "fail"]
    with pytest.raises(AnalysisError, match="^check was given the text 'a.csv' as run"):
        tl.check("a.csv")
