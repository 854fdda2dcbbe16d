"""What a process keeps of short groups is what the file says now."""

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import ReadError
from tribolab.reading.netcdf import cache as kept
from tribolab.reading.netcdf.cache import SHORT, read_kept
from tribolab.reading.netcdf.netcdf import read_netcdf, write_groups


def dataset(value, size=3):
    values = np.full(size, value)
    return xr.Dataset(
        {"friction_coefficient": ("segment", values, {"units": "1", "flags": {"seen": True}})},
        {"segment": np.arange(size)},
    )


@pytest.fixture
def file(tmp_path):
    groups = {None: xr.Dataset(attrs={"name": "a"}), "short": dataset(1.0)}
    return write_groups(groups | {"long": dataset(2.0, SHORT)}, tmp_path / "a.nc")


def test_what_is_kept_is_what_is_read(file):
    for group in (None, "short", "long", None, "short"):
        data = read_kept(file, group)
        xr.testing.assert_identical(data, read_netcdf(file, group))


def test_a_file_is_opened_once_for_its_short_groups(file, monkeypatch):
    first = read_kept(file, "short")
    monkeypatch.setattr(kept, "read_netcdf", None)
    monkeypatch.setattr(kept, "read_groups", None)
    xr.testing.assert_identical(read_kept(file, "short"), first)
    assert read_kept(file).attrs["name"] == "a"


def test_what_is_done_to_a_copy_does_not_show_in_the_next(file):
    data = read_kept(file, "short")
    data["friction_coefficient"][:] = 7.0
    data["friction_coefficient"].attrs["flags"]["seen"] = False
    data.attrs["more"] = 1
    xr.testing.assert_identical(read_kept(file, "short"), read_netcdf(file, "short"))


def test_a_file_that_is_another_now_is_read_anew(file):
    assert read_kept(file, "short")["friction_coefficient"][0] == 1.0
    write_groups({"short": dataset(3.0)}, file.with_name("b.nc")).replace(file)
    assert read_kept(file, "short")["friction_coefficient"][0] == 3.0
    file.unlink()
    with pytest.raises(ReadError, match="there is no such file"):
        read_kept(file, "short")


def test_a_group_that_is_not_there_is_told_with_those_that_are(file):
    with pytest.raises(ReadError, match="no group 'shrt'; there are short, long"):
        read_kept(file, "shrt")


def test_no_more_is_kept_than_a_process_can_spare(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_MAX_CACHED", 40)
    mine = kept.KeptReading()
    files = [write_groups({"short": dataset(float(k))}, tmp_path / f"{k}.nc") for k in range(10)]
    for file in files:
        assert mine.groups(file)["short"].identical(read_netcdf(file, "short"))
    assert len(mine._files) == 40 // 6 and mine._values == 6 * len(mine._files)
    assert {key[0] for key in mine._files} == {str(file) for file in files[-6:]}
