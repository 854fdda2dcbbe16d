"""Maps and profiles that files hold as arrays by name, and grids whose units a name says."""

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError
from tribolab.reading.kinds import kind_of
from tribolab.reading.scan_files import read_scans

Z = np.round(np.random.default_rng(3).normal(size=(12, 20)).cumsum(1), 3)  # um
X, Y = 1.5 * np.arange(20), 2.0 * np.arange(12)  # um


def _pitch(path):
    savemat(path, {"scan": {"topo_um": Z, "dx_um": 1.5, "dy_um": 2.0, "sample": "disc 3"}})


def _counts(path):
    with h5py.File(path, "w") as file:
        data = file.create_dataset("scan/height", data=np.round(Z / 0.001).astype("i4"))
        data.attrs.update(units="um", scale_factor=0.001, add_offset=0.0)
        for name, values in (("x", X), ("y", Y)):
            file.create_dataset(f"scan/{name}", data=1e-3 * values).attrs["units"] = "mm"


def _pitch_beside(path):
    with h5py.File(path, "w") as file:
        data = file.create_dataset("meting/hoogte", data=np.round((Z - 2.5) / 0.001).astype("i4"))
        data.attrs.update(eenheid="um", scale_factor=0.001, add_offset=2.5, dx_um=1.5, dy_um=2.0)
        file.create_dataset("meting/intensiteit", data=np.ones(Z.shape, "u1"))


def _archive(path):
    np.savez(path, height_um=Z, x_mm=1e-3 * X, y_mm=1e-3 * Y, operator="IK")


MAPS = {
    "pitch.mat": _pitch,
    "counts.h5": _counts,
    "pitch.h5": _pitch_beside,
    "archive.npz": _archive,
}


@pytest.mark.parametrize("name", MAPS)
def test_a_map_is_told_by_the_names_of_its_arrays(tmp_path, name):
    MAPS[name](tmp_path / name)
    scan = read_scans(tmp_path / name)
    np.testing.assert_allclose(scan.height, 1e-6 * Z, atol=1e-12)
    np.testing.assert_allclose(scan.x, 1e-6 * X, atol=1e-12)
    np.testing.assert_allclose(scan.y, 1e-6 * Y, atol=1e-12)
    assert kind_of(tmp_path / name) == "scan"
    assert any("map of 20 x 12 points" in line for line in file_lines(tmp_path / name))


def test_what_an_attribute_says_to_be_no_height_is_none(tmp_path):
    counts = np.round(Z / 0.001).astype("i2")
    counts[3, 4:6] = -32768
    with h5py.File(tmp_path / "a.h5", "w") as file:
        data = file.create_dataset("height_um", data=counts)
        data.attrs.update(scale_factor=0.001, _FillValue=np.int16(-32768), dx_um=1.5, dy_um=2.0)
    scan = read_scans(tmp_path / "a.h5")
    assert int(np.isnan(scan.height).sum()) == 2
    assert "-32768 2 times, as '_FillValue' says" in scan.attrs["taken_for_missing"]


@pytest.mark.parametrize("beside", [{"valid": Z > 0}, {"z_scale_nm": 0.5}, {"offset": 3.0}])
def test_a_mask_or_a_scale_beside_the_heights_is_not_passed_over(tmp_path, beside):
    np.savez(tmp_path / "a.npz", z_um=Z, pixel_size_um=1.5, **beside)
    with pytest.raises(ReadError, match=f"'{next(iter(beside))}' may change or exclude heights"):
        read_scans(tmp_path / "a.npz")


def test_rows_over_one_x_are_profiles_and_a_unit_that_is_missing_is_all_that_is_asked(tmp_path):
    rows = Z[:4]
    np.savez(tmp_path / "ring.npz", scan_x_mm=1e-3 * X, scan_z=rows, names=list("abcd"))
    with pytest.raises(ReadError, match=r"the unit of the heights \('scan_z'\) is not said"):
        read_scans(tmp_path / "ring.npz")
    (tmp_path / "ring.npz").rename(tmp_path / "ring_z-um.npz")
    scan = read_scans(tmp_path / "ring_z-um.npz")
    np.testing.assert_allclose(scan.height, 1e-6 * rows, atol=1e-12)
    assert scan.attrs["units_by_file_name"] == "heights in um"


def test_two_arrays_that_may_be_the_heights_are_told(tmp_path):
    np.savez(tmp_path / "a.npz", z_left_um=Z, z_right_um=Z, x_um=X, y_um=Y)
    with pytest.raises(ReadError, match="'z_left_um', 'z_right_um'"):
        read_scans(tmp_path / "a.npz")


def test_signals_are_no_scan(tmp_path):
    savemat(tmp_path / "a.mat", {"t": X, "z": X, "Fx": X})
    assert kind_of(tmp_path / "a.mat") != "scan"


def esri(heights, corner="corner"):
    rows = "\n".join(" ".join(f"{z:.3f}" for z in row) for row in heights)
    return (
        f"ncols 20\nnrows 12\nxll{corner} 0.0\nyll{corner} 0.0\ncellsize 0.0015\n"
        f"NODATA_value -9999\n{rows}\n"
    )


def test_units_in_a_files_name_hold_where_it_states_none(tmp_path):
    heights = Z.copy()
    heights[0, 0] = -9999
    (tmp_path / "plate_xy-mm_z-um.asc").write_text(esri(heights))
    scan = read_scans(tmp_path / "plate_xy-mm_z-um.asc")
    np.testing.assert_allclose(scan.height.values[1:], 1e-6 * Z[1:], atol=1e-12)
    assert np.isnan(scan.height.values[0, 0])
    assert scan.attrs["pitch_m"] == pytest.approx(1.5e-6)
    (tmp_path / "plate.asc").write_text(esri(heights))
    with pytest.raises(ReadError, match="the unit of 'cellsize 0.0015'.*'plate_xy-mm_z-um.asc'"):
        read_scans(tmp_path / "plate.asc")


def test_a_surfer_grid_is_read_with_its_units(tmp_path):
    ends = f"0 {19 * 0.0015}\n0 {11 * 0.002}\n-9 9"
    numbers = [1.70141e38, *Z.ravel()[1:]]  # ten in a line, as Surfer writes them
    lines = [" ".join(f"{z:.6g}" for z in numbers[k : k + 10]) for k in range(0, 240, 10)]
    text = f"DSAA\n20 12\n{ends}\n" + "\n".join(lines) + "\n"
    (tmp_path / "a_xy_mm_z_um.grd").write_text(text)
    scan = read_scans(tmp_path / "a_xy_mm_z_um.grd")
    np.testing.assert_allclose(scan.height.values[1:], 1e-6 * Z[1:], atol=1e-12)
    assert np.isnan(scan.height.values[0, 0])
    np.testing.assert_allclose(scan.y, 1e-6 * Y, atol=1e-12)
    (tmp_path / "a.grd").write_text(text)
    with pytest.raises(ReadError, match="the unit of its positions and the unit of its heights"):
        read_scans(tmp_path / "a.grd")
