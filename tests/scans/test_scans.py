"""Scans: real profilometers' files, text by dialect, and what cannot be read."""

import numpy as np
import pytest
import xarray as xr
from real_runs import mitutoyo

from tribolab.core.errors import ReadError
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.grid import even
from tribolab.reading.scans.results import read_tester_results
from tribolab.rig.files import scan_file

HEAD = "# Surftest profile\n# tip radius: 2 um\n# pitch: 0.5 um\n# length: 25 mm\nx [mm],z [um]\n"


def write_text(path, x_mm, z_um):
    rows = "".join(f"{x:.4f},{z:.3f}\n" for x, z in zip(x_mm, z_um, strict=True))
    path.write_text(HEAD + rows)
    return path


# ---- real files


def test_cr_only_roller_profile_has_its_units_from_the_dialect(shared_data):
    scan = read_scans(shared_data / "bearing_profiles_MIT" / "NU206-RE-1.txt")
    assert scan.sizes == {"scan": 1, "x": 7952}
    assert scan.attrs["length_m"] == pytest.approx(9.859871e-3, rel=1e-12)
    assert float(scan.height[0, 0]) == pytest.approx(-96.103005e-6, rel=1e-12)
    assert "resampled" not in scan.attrs  # dx alternates in its last digit only


def test_second_bearing_profile_with_crlf(shared_data):
    scan = read_scans(shared_data / "bearing_profiles_MIT" / "NU208-IR-1.txt")
    assert scan.sizes["x"] == 8064
    assert float(scan.height[0, -1]) == pytest.approx(-49.415752e-6, rel=1e-12)


def test_dektak_with_rounded_positions_is_even(shared_data):
    scan = read_scans(shared_data / "surfacetopography_MIT" / "dektak-1.csv")
    # 1500 um in 9600 samples; the file's x is rounded to 0.1 um and says 0.156
    assert scan.attrs["pitch_m"] == pytest.approx(1500e-6 / 9600, rel=1e-6)
    assert "resampled" not in scan.attrs
    assert scan.attrs["tip_radius_m"] == 2.5e-6
    assert scan.attrs["instrument_Ra_m"] == pytest.approx(5.25e-9)
    assert scan.attrs["instrument_Rq_m"] == pytest.approx(1.143e-8)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "points", "pitch", "rq", "cutoff"),
    [
        ("mitutoyo_2_mock", 6664, 1.5e-6, 3.959e-6, 2.5e-3),
        ("mitutoyo_mock", 960, 0.5e-6, 0.027e-6, 0.08e-3),
    ],
)
def test_mitutoyo_workbooks(shared_data, name, points, pitch, rq, cutoff):
    scan = mitutoyo(shared_data, name)
    assert scan.sizes["x"] == points
    assert scan.attrs["pitch_m"] == pytest.approx(pitch, rel=1e-9)
    assert scan.attrs["length_m"] == pytest.approx((points - 1) * pitch, rel=1e-9)
    assert scan.attrs["instrument_Rq_m"] == pytest.approx(rq)
    assert scan.attrs["lambda_c_m"] == pytest.approx(cutoff)


def test_two_bare_columns_need_units(shared_data):
    path = shared_data / "surfacetopography_MIT" / "xy-4.txt"
    with pytest.raises(ReadError, match="x_unit="):
        read_scans(path)
    scan = read_scans(path, x_unit="mm", height_unit="um")
    assert scan.sizes == {"scan": 1, "x": 10001}
    assert float(scan.height[0, -1]) == pytest.approx(-0.005702e-6, rel=1e-6)
    assert scan.attrs["length_m"] == pytest.approx(0.995613e-3, rel=1e-9)


def test_german_map_export(shared_data):
    scan = read_scans(shared_data / "surfacetopography_MIT" / "gwyddion-export-german.txt")
    assert scan.height.dims == ("y", "x")
    rows = [[1, 1.5, 3], [-2, -3, -6], [0, 0, 0], [9, 9, 9]]
    np.testing.assert_allclose(scan.height, rows)
    np.testing.assert_allclose(np.diff(scan.x), 12.34e-6 / 3)
    np.testing.assert_allclose(np.diff(scan.y), 5678.9e-9 / 4)


def test_sdf_map(shared_data):
    scan = read_scans(shared_data / "surfacetopography_MIT" / "sdf-1.sdf")
    assert dict(scan.sizes) == {"y": 4, "x": 7}
    np.testing.assert_allclose(scan.height[0, :3], [1.0e-6, 0.99874e-6, 0.99495e-6], rtol=1e-9)


def test_map_as_rows_of_xyz_is_put_on_its_grid(shared_data):
    path = shared_data / "nanovea_map_MIT" / "test1.txt"
    scan = read_scans(path, instrument="nanovea_map")
    assert dict(scan.sizes) == {"y": 101, "x": 101}
    rows = np.loadtxt(path, delimiter=",")
    row = rows[4321]
    found = scan.height.sel(x=row[0] * 1e-3, y=row[1] * 1e-3, method="nearest")
    assert float(found) == pytest.approx(row[2] * 1e-6, rel=1e-12)
    assert float(scan.height.mean()) == pytest.approx(rows[:, 2].mean() * 1e-6, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "ra", "rq", "rz"),
    [
        ("12A11003", 3.246, 4.335, 32.701),
        ("12A11004", 2.991, 3.318, 9.517),
        ("8A2", 0.07, 0.09, 0.512),
    ],
)
def test_results_files_of_the_paper_s_profilometer(shared_data, name, ra, rq, rz):
    path = shared_data / "mitutoyo_sj410_res_MIT" / f"{name}.TXT"
    found = read_tester_results(path)
    np.testing.assert_allclose([found.Ra, found.Rq, found.Rz], np.array([ra, rq, rz]) * 1e-6)
    assert found.attrs["lambda_s_m"] == 2.5e-6
    assert found.attrs["pitch_m"] == 5e-7
    with pytest.raises(ReadError, match="no profile"):
        read_scans(path)


def test_error_codes_and_names_used_twice(shared_data):
    found = read_tester_results(shared_data / "mitutoyo_sj410_res_MIT" / "12A11003.TXT").attrs
    assert found["instrument_errors"] == "Rc: Err110; RPc: Err110; RSm: Err110"
    assert np.isnan(found["instrument_Rc_m"])
    assert found["instrument_Rmr_c_P_10_0_percent"] == 0.075
    assert found["instrument_Rmr_c_P_15_0_percent"] == 0.15
    assert found["recorded_at_as_written"] == "11/01/2012 22:05:47"


# ---- text of our own


def test_the_rig_s_file_comes_back_to_its_last_digit(tmp_path):
    x = 0.5e-6 * np.arange(2001)
    height = np.random.default_rng(3).normal(0, 1e-6, (3, x.size)).round(9)
    for number, row in enumerate(height):
        (tmp_path / f"sb-r_{number}.csv").write_bytes(scan_file(x, row))
    scans = read_scans(str(tmp_path / "sb-r_*.csv"))
    np.testing.assert_allclose(scans.height, height, rtol=0, atol=1e-18)
    np.testing.assert_allclose(scans.x, x, rtol=0, atol=1e-15)
    assert scans.attrs["tip_radius_m"] == 2e-6
    assert scans.file.values.tolist() == ["sb-r_0.csv", "sb-r_1.csv", "sb-r_2.csv"]
    assert len(scans.attrs["source_sha256"].split("; ")) == 3


def test_scans_survive_netcdf(tmp_path):
    write_text(tmp_path / "a.csv", [0, 0.0005, 0.001], [1, 2, 3])
    scans = read_scans(tmp_path / "a.csv")
    write_netcdf(scans, tmp_path / "a.nc")
    xr.testing.assert_equal(read_netcdf(tmp_path / "a.nc"), scans)


def test_missing_heights_stay_missing(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(HEAD + "0.0,1\n0.0005,\n0.001,3\n")
    assert np.isnan(read_scans(path).height.values).tolist() == [[False, True, False]]


def test_a_scan_that_runs_backwards_is_turned_round(tmp_path):
    path = write_text(tmp_path / "a.csv", [0.001, 0.0005, 0], [3, 2, 1])
    np.testing.assert_allclose(read_scans(path).height[0], [1e-6, 2e-6, 3e-6])


def test_truly_uneven_positions_are_interpolated_and_said_so():
    rng = np.random.default_rng(1)
    x = np.cumsum(rng.uniform(0.5e-6, 1.5e-6, 500))
    pitch, height, attrs = even("scan", x, 3.0 * x)
    assert "interpolated" in attrs["resampled"]
    grid = attrs["x_origin_m"] + pitch * np.arange(height.size)
    inside = (grid > x[0]) & (grid < x[-1])
    np.testing.assert_allclose(height[inside], 3.0 * grid[inside], rtol=1e-12)


# ---- what cannot be read


def test_different_lengths_are_named_and_can_be_had_as_a_list(tmp_path):
    write_text(tmp_path / "a.csv", [0, 0.0005, 0.001], [1, 2, 3])
    write_text(tmp_path / "b.csv", [0, 0.0005], [1, 2])
    with pytest.raises(ReadError, match=r"b\.csv.*stack=False"):
        read_scans(tmp_path / "*.csv")
    assert [s.sizes["x"] for s in read_scans(tmp_path / "*.csv", stack=False)] == [3, 2]


def test_different_pitches_are_named(tmp_path):
    write_text(tmp_path / "a.csv", [0, 0.0005, 0.001], [1, 2, 3])
    write_text(tmp_path / "b.csv", [0, 0.001, 0.002], [1, 2, 3])
    with pytest.raises(ReadError, match="different\\s+pitch"):
        read_scans([tmp_path / "a.csv", tmp_path / "b.csv"])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (HEAD + "0.0,\n0.0005,\n", "no value"),
        (HEAD + "0.0,1\n0.0005,two\n", "not a number"),
        (HEAD + "0.001,1\n0.001,2\n", "does not proceed"),
        (HEAD + "0.0,1\n0.001,2\n0.0005,3\n0.004,3\n", "goes back"),
        (HEAD + "0.0,1\n", "at least two points"),
        ("", "empty"),
        ("no numbers here\n", "its format is not known"),
    ],
)
def test_bad_profiles_say_what_is_wrong(tmp_path, content, words):
    path = tmp_path / "bad.csv"
    path.write_text(content)
    with pytest.raises(ReadError, match=words) as caught:
        read_scans(path)
    assert "bad.csv" in str(caught.value)


def test_bytes_are_no_map_for_want_of_a_header(tmp_path):
    """A satellite's map is any bytes of twice a square number, so only its name can tell it."""
    content = bytes(range(256)) * 200
    assert len(content) == 2 * 160**2
    (tmp_path / "a.csv").write_bytes(content)
    (tmp_path / "a.hgt").write_bytes(content)
    with pytest.raises(ReadError, match=r"a\.csv: neither text nor a format .* as text \(csv\)"):
        read_scans(tmp_path / "a.csv")
    with pytest.raises(ReadError, match=r"does not say how large the scan is \(hgt\)"):
        read_scans(tmp_path / "a.hgt")


def test_no_such_file_and_no_such_pattern(tmp_path):
    with pytest.raises(ReadError, match="no such file"):
        read_scans(tmp_path / "a.csv")
    with pytest.raises(ReadError, match="the pattern matches nothing in"):
        read_scans(tmp_path / "*.csv")
    with pytest.raises(ReadError, match="no file is given"):
        read_scans([])


def test_a_force_log_s_dialect_is_refused(tmp_path):
    path = write_text(tmp_path / "a.csv", [0, 0.0005], [1, 2])
    with pytest.raises(ReadError, match="writes no profiles.*surftest_csv"):
        read_scans(path, instrument="linear_slider")


def test_a_map_with_a_hole_is_refused(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("0,0,1\n1,0,1\n0,1,1\n")
    with pytest.raises(ReadError, match="do not fill"):
        read_scans(path, instrument="nanovea_map")


def write_map(path, size=(16, 20), step=0.001, seed=1):
    y, x = np.mgrid[: size[0], : size[1]] * step
    z = np.random.default_rng(seed).normal(size=size)
    rows = zip(x.ravel(), y.ravel(), z.ravel(), strict=True)
    path.write_text("".join(f"{a:.4f},{b:.4f},{c:.4f}\n" for a, b, c in rows))
    return z


def test_maps_alike_are_stacked(tmp_path):
    heights = [write_map(tmp_path / f"map_{n}.txt", seed=n) for n in (1, 2, 3)]
    scans = read_scans(tmp_path / "map_*.txt", instrument="nanovea_map")
    assert scans.height.dims == ("scan", "y", "x")
    assert scans.file.values.tolist() == ["map_1.txt", "map_2.txt", "map_3.txt"]
    np.testing.assert_allclose(scans.height, 1e-6 * np.array(heights), atol=1e-10)


def test_maps_that_differ_are_not_stacked(tmp_path):
    files = [tmp_path / name for name in ("a.txt", "b.txt", "c.txt")]
    write_map(files[0])
    write_map(files[1], size=(18, 20))
    write_map(files[2], step=0.002)
    for other, words in ((1, "18 points of 1 um.*16 points of 1 um"), (2, "of 2 um.*of 1 um")):
        with pytest.raises(ReadError, match=words):
            read_scans([files[0], files[other]], instrument="nanovea_map")
    assert len(read_scans(files, instrument="nanovea_map", stack=False)) == 3
