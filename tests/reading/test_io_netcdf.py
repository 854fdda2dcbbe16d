"""What is written as netCDF comes back the same."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import tribolab as tl
from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.netcdf.netcdf import read_groups, read_netcdf, write_groups, write_netcdf
from tribolab.reading.netcdf.seal import seal, unseal
from tribolab.reading.netcdf.storage import CHUNK, encoded, storage

ATTRIBUTES = st.dictionaries(
    st.from_regex(r"[a-z][a-z0-9_]{0,10}", fullmatch=True).filter(lambda k: k != "units"),
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(-(2**31), 2**31 - 1),
        st.floats(allow_nan=False),
        st.text(st.characters(codec="utf-8", exclude_characters="\0"), min_size=1, max_size=20),
        st.lists(st.text(st.characters(codec="utf-8"), max_size=5), max_size=4),
        st.dictionaries(st.text(st.characters(codec="utf-8"), max_size=4), st.integers()),
        st.tuples(st.text(st.characters(codec="utf-8"), max_size=4), st.booleans()),
    ),
    max_size=5,
)


def test_a_file_of_any_name_comes_back(tmp_path):
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe"))
    folder.mkdir()
    run = xr.Dataset({"friction_force": ("time", [1.0, 2.0])}, {"time": [0.0, 0.1]})
    for group in ("run", "friction"):
        write_netcdf(run, folder / "a.nc", group)
    assert [path.name for path in folder.iterdir()] == ["a.nc"]
    for group in ("run", "friction"):
        xr.testing.assert_identical(read_netcdf(folder / "a.nc", group), run)
    unseal(folder / "a.nc")  # tried out in another process first
    xr.testing.assert_identical(read_netcdf(folder / "a.nc", "run"), run)


def example_run(n=200_000):
    time = np.arange(n) / 1000.0
    force = np.sin(time)
    force[5] = np.nan
    data = xr.Dataset(
        {
            "friction_force": ("time", force, {"units": "N", "ancillary_variables": "f_qc"}),
            "f_qc": ("time", np.tile([1, 2, 3, 4], n // 4).astype(np.int8), {"flag": (1, 2)}),
            "f_qc_tests": ("time", np.arange(n, dtype=np.uint32)),
            "step": ("time", np.ones(n, dtype=np.int32)),
        },
        coords={"time": ("time", time, {"units": "s"})},
        attrs={"source": "a.csv", "nothing": None, "sure": True, "of": {"a": [1, None]}},
    )
    return data


def test_values_types_flags_and_attributes_come_back_the_same(tmp_path):
    data = example_run()
    back = read_netcdf(write_netcdf(data, tmp_path / "run.nc"))
    assert back.identical(data)
    assert {n: v.dtype for n, v in back.variables.items()} == {
        n: v.dtype for n, v in data.variables.items()
    }
    assert back.attrs["sure"] is True and back.attrs["nothing"] is None


@settings(deadline=None, max_examples=40)
@given(ATTRIBUTES)
def test_any_attribute_comes_back_the_same(tmp_path_factory, attrs):
    file = tmp_path_factory.mktemp("nc") / "a.nc"
    data = xr.Dataset({"x": ("segment", [1.5], attrs)}, attrs=attrs)
    back = read_netcdf(write_netcdf(data, file))
    assert back.attrs == attrs and back["x"].attrs == attrs
    assert {k: type(v) for k, v in back.attrs.items()} == {k: type(v) for k, v in attrs.items()}


def test_text_that_looks_encoded_stays_text(tmp_path):
    data = xr.Dataset(attrs={"a": "json:1", "b": "json-tuple:[]", "c": ""})
    assert read_netcdf(write_netcdf(data, tmp_path / "a.nc")).attrs == data.attrs


def test_long_arrays_are_chunked_and_compressed(tmp_path):
    file = write_netcdf(example_run(), tmp_path / "run.nc")
    with netCDF4.Dataset(file) as opened:
        variable = opened["friction_force"]
        assert variable.chunking() == [CHUNK]
        assert variable.filters()["zlib"] and variable.filters()["shuffle"]


def test_groups_share_a_file_and_text_variables_survive(tmp_path):
    file = tmp_path / "all.nc"
    run = example_run(100)
    omitted = xr.Dataset({"omitted_reason": ("omitted", np.array(["ramp", "at rest"], object))})
    write_netcdf(run, file, group="run")
    write_netcdf(omitted, file, group="segments")
    assert read_netcdf(file, group="run").identical(run)
    assert read_netcdf(file, group="segments")["omitted_reason"].values.tolist() == [
        "ramp",
        "at rest",
    ]
    assert tl.read(file).identical(run)
    with pytest.raises(ReadError, match="no group 'friction'; there are run, segments"):
        read_netcdf(file, group="friction")


def test_the_root_of_a_file_of_groups_names_them(tmp_path):
    file = tmp_path / "all.nc"
    write_netcdf(xr.Dataset(attrs={"source": "a.csv"}), file)
    for name in ("run", "segments"):
        write_netcdf(example_run(60), file, group=name)
    with xr.open_dataset(file) as root:
        assert root.attrs == {"source": "a.csv", "groups": "run; segments"}


def test_several_groups_are_read_at_once_and_travel_to_other_processes(tmp_path):
    file = tmp_path / "all.nc"
    parts = {"run": example_run(100), "second": example_run(60)}
    for name, data in parts.items():
        write_netcdf(data, file, group=name)
    read = pickle.loads(pickle.dumps(read_groups(file, ["second", "run"])))
    assert list(read) == ["second", "run"]
    assert all(read[name].identical(parts[name]) for name in parts)
    assert list(read_groups(file, ["no", "run"], optional=True)) == ["run"]
    with pytest.raises(ReadError, match="no group 'no'"):
        read_groups(file, ["run", "no"])


SIZES = {"time": 3, "segment": 2, "event": 0, "long": 1500}
TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=6)
KINDS = st.sampled_from(
    "int8 int16 int32 int64 uint8 uint16 uint32 uint64 float32 float64 >f8 >i2 bool str object "
    "datetime64[ns] timedelta64[ns] S3".split()
)


@st.composite
def variables(draw):
    """A variable of any type that a dataset may hold, over any of the dims, or none."""
    kind = draw(KINDS)
    dims = tuple(draw(st.lists(st.sampled_from(sorted(SIZES)), max_size=2, unique=True)))
    shape = tuple(SIZES[dim] for dim in dims)
    rng = np.random.default_rng(draw(st.integers(0, 99)))
    if kind in ("str", "object"):
        words = draw(st.lists(TEXT, min_size=1, max_size=4))
        values = np.array(words, dtype=object)[rng.integers(0, len(words), shape)]
        values = np.asarray(values, dtype=kind)
    else:
        values = rng.integers(0, 100, shape).astype(kind)
    if kind == "float64" and draw(st.booleans()):
        values = np.where(values > 50, np.nan, values / 7)
    unit = {} if kind.startswith(("datetime", "timedelta")) else {"units": "N"}
    attrs = draw(st.sampled_from([{}, unit, {"flags": (1, 2), "sure": True}]))
    return xr.Variable(dims, values, attrs)


def written_by_xarray(groups, path):
    """Write groups one by one, as xarray does it."""
    for group, data in groups.items():
        data = data.copy()
        data.attrs = encoded(data.attrs)
        for name in data.variables:
            data[name].attrs = encoded(data[name].attrs)
            if data[name].dtype.kind in "fiu":
                data[name].encoding = {"_FillValue": None}
        data.to_netcdf(path, mode="a" if path.exists() else "w", group=group)
    seal(path)  # else each file is tried in another process first
    return path


@pytest.mark.slow
@settings(deadline=None, max_examples=15)
@given(
    st.dictionaries(st.sampled_from([*SIZES, *"abcdef"]), variables(), max_size=6),
    st.lists(st.sampled_from("abcdef"), max_size=2),
)
def test_groups_come_back_as_from_the_files_of_xarray(tmp_path_factory, content, coords):
    folder = tmp_path_factory.mktemp("nc")
    content = {k: v for k, v in content.items() if k not in SIZES or v.dims == (k,)}
    data = xr.Dataset(content, attrs={"source": "a.csv"})
    data = data.set_coords([name for name in coords if name in data])
    groups = {None: data.assign_attrs(root=True), "run": data}
    groups["second"] = data[[name for name in coords[:1] if name in data]]
    own, other = write_groups(groups, folder / "own.nc"), folder / "other.nc"
    found, wanted = (read_groups(path, groups) for path in (own, written_by_xarray(groups, other)))
    for name, expected in wanted.items():
        got = found[name]
        got.attrs.pop("groups", None)
        assert got.identical(expected)
        assert list(got.variables) == list(expected.variables)
        assert {n: v.dtype for n, v in got.variables.items()} == {
            n: v.dtype for n, v in expected.variables.items()
        }
        plain = xr.load_dataset(own, group=name, decode_times=False, mask_and_scale=False)
        for own_name, variable in plain.variables.items():
            assert variable.dtype == got[own_name].dtype
            np.testing.assert_array_equal(variable.values, got[own_name].values)
        assert set(plain.coords) == set(got.coords)


@pytest.mark.parametrize(
    "attribute", [{"scale_factor": 0.5}, {"_FillValue": 3.0}, {"missing_value": 3.0}]
)
def test_what_another_program_scaled_is_read_as_xarray_reads_it(tmp_path, attribute):
    path = tmp_path / "other.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", 3)
        fill = attribute.get("_FillValue")
        variable = file.createVariable("force", "f8", ("time",), fill_value=fill)
        variable.setncatts({k: v for k, v in attribute.items() if k != "_FillValue"})
        variable.set_auto_maskandscale(False)
        variable[:] = [1.0, 2.0, 3.0]
    wanted = xr.load_dataset(path, decode_times=False, mask_and_scale=False)
    assert read_netcdf(path).identical(wanted)


@pytest.mark.parametrize(
    "data",
    [
        xr.Dataset({"a/b": ("n", [1.0])}),
        xr.Dataset({"a": ("n/m", [1.0])}),
        xr.Dataset({"a": ("n", np.array([{}, 1], object))}),
        xr.Dataset({"a": ("n", np.zeros(2, np.float16))}),
        xr.Dataset({"a": ("n", [1.0], {"": 1})}),
        xr.Dataset(attrs={"a": np.array([None])}),
    ],
)
def test_what_netcdf_cannot_hold_is_our_error(tmp_path, data):
    with pytest.raises(TribolabError, match=r"run\.nc: the netCDF file cannot be written"):
        write_groups({"run": data}, tmp_path / "run.nc")


def test_a_group_that_is_there_can_be_added_to(tmp_path):
    file = write_groups({"run": xr.Dataset({"a": ("n", [1.0, 2.0])})}, tmp_path / "run.nc")
    write_netcdf(xr.Dataset({"b": ("n", [3, 4])}), file, group="run")
    found = read_netcdf(file, "run")
    assert found.a.values.tolist() == [1.0, 2.0] and found.b.values.tolist() == [3, 4]


def test_a_signal_from_a_converter_takes_a_quarter_of_its_bytes(tmp_path):
    steps = np.round(np.random.default_rng(0).normal(31, 0.5, 20_000) / 0.0153) * 0.0153
    data = xr.Dataset({"normal_force": ("time", steps)})
    file = write_netcdf(data, tmp_path / "run.nc")
    assert file.stat().st_size < 0.25 * steps.nbytes + 12_000
    assert read_netcdf(file).identical(data)
    assert storage(np.random.default_rng(0).random(9000)).get("zlib") in (None, True)
    assert "zlib" not in storage(np.random.default_rng(0).integers(0, 2**63, 9000))


def test_an_empty_table_comes_back_empty(tmp_path):
    data = xr.Dataset({"start": ("segment", np.empty(0)), "n": ("segment", np.empty(0, np.int8))})
    assert read_netcdf(write_netcdf(data, tmp_path / "a.nc")).identical(data)


def test_a_real_run_comes_back_from_its_netcdf(shared_data, tmp_path):
    run = tl.read(shared_data / "cetr_umt2_MIT/HT-2n-6-4 2_001.csv")
    assert tl.read(write_netcdf(run, tmp_path / "run.nc")).identical(run)


def test_what_cannot_be_written_or_read_is_our_error(tmp_path):
    with pytest.raises(TribolabError, match="cannot be written"):
        write_netcdf(xr.Dataset(), tmp_path / "no" / "folder.nc")
    with pytest.raises(ReadError, match="no such file"):
        read_netcdf(tmp_path / "no.nc")
    (tmp_path / "text.nc").write_text("no netCDF")
    with pytest.raises(ReadError, match="this .*netCDF file cannot be read"):
        read_netcdf(tmp_path / "text.nc")


def test_of_a_group_only_the_wanted_variables_are_read(tmp_path):
    run = xr.Dataset({"a": ("time", [1.0, 2.0]), "b": ("time", [3.0, 4.0])}, {"time": [0.0, 0.1]})
    path = write_netcdf(run, tmp_path / "run.nc", "run")
    found = read_groups(path, ["run"], only={"run": ("b", "c")})["run"]
    assert found.identical(run[["b"]])


_READ_IN_THREADS = """
import sys
from concurrent.futures import ThreadPoolExecutor
from tribolab.reading.netcdf.netcdf import read_netcdf
with ThreadPoolExecutor(6) as threads:
    read = threads.map(read_netcdf, 20 * sys.argv[1:], 60 * ["run"])
    sizes = [data.sizes["time"] for data in read]
print(sum(sizes))
"""


@pytest.mark.slow
def test_threads_read_one_after_the_other_as_the_library_stands_no_two(tmp_path):
    values = {f"signal_{k}": ("time", np.arange(100.0)) for k in range(20)}
    files = [write_groups({None: xr.Dataset(), "run": xr.Dataset(values)}, tmp_path / f"{k}.nc")
             for k in range(3)]  # fmt: skip
    told = subprocess.run(
        [sys.executable, "-c", _READ_IN_THREADS, *map(str, files)], capture_output=True, text=True
    )
    assert (told.returncode, told.stdout) == (0, "6000\n"), told.stderr[-300:]
