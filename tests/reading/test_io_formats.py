"""The same run in every format that holds columns, and compressed, is read as from text."""

from __future__ import annotations

import gzip
import zipfile

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from pyarrow import feather

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError

N = 200
RNG = np.random.default_rng(5)
TIME = 0.1 * np.arange(N)
DATA = {
    "t [s]": TIME,
    "v [mm/s]": np.where(TIME < 10, 1.0, -1.0),
    "Fx [N]": np.where(TIME < 10, 3.0, -3.0) + 0.01 * RNG.standard_normal(N),
    "Fz [N]": 10 + 0.01 * RNG.standard_normal(N),
}
COLUMNS = {
    "time": "t",
    "sliding_velocity": "v",
    "friction_force": "Fx",
    "normal_force": "Fz",
}


def dialect(folder, form, more="", names=COLUMNS, units=None):
    text = f'name = "mine"\ntitle = "mine"\nformat = "{form}"\n{more}\n'
    for quantity, name in names.items():
        text += f'[[column]]\nquantity = "{quantity}"\nname = "{name}"\n'
        if units:
            text += f'unit = "{units[quantity]}"\n'
    path = folder / "mine.toml"
    path.write_text(text)
    return path


def csv(folder, name="run.csv"):
    pd.DataFrame(DATA).to_csv(folder / name, index=False)
    return folder / name


@pytest.fixture
def wanted(tmp_path):
    folder = tmp_path / "plain"
    folder.mkdir()
    return tl.read(csv(folder), dialect(folder, "text", "[header]\nline = 1"))


def same(run, wanted):
    assert set(run) == set(wanted)
    for name in wanted:
        np.testing.assert_allclose(run[name].values, wanted[name].values, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(run["time"].values, wanted["time"].values, atol=1e-12)


def test_parquet_and_feather(tmp_path, wanted):
    table = pa.table(DATA)
    pq.write_table(table, tmp_path / "run.parquet")
    feather.write_feather(table, tmp_path / "run.feather")
    for form in ("parquet", "feather"):
        same(tl.read(tmp_path / f"run.{form}", dialect(tmp_path, form)), wanted)


@pytest.mark.parametrize("units", ["brackets", "row"])
def test_a_sheet_of_a_workbook(tmp_path, wanted, units):
    frame = pd.DataFrame(DATA)
    more = '[header]\nline = 1\nsheet = "Run 7"'
    if units == "row":
        head = {name: name.split(" ")[1].strip("[]") for name in DATA}
        frame = pd.concat([pd.DataFrame([head]), frame.astype(object)])
        frame.columns = [name.split(" ")[0] for name in DATA]
        more += '\nunits = "row"'
    with pd.ExcelWriter(tmp_path / "run.xlsx") as book:
        pd.DataFrame({"Operator": ["A. Person"]}).to_excel(book, sheet_name="About", index=False)
        frame.to_excel(book, sheet_name="Run 7", index=False)
    same(tl.read(tmp_path / "run.xlsx", dialect(tmp_path, "excel", more)), wanted)
    with pytest.raises(ReadError, match=r"no sheet 'Run 8'; there are About, Run 7"):
        tl.read(tmp_path / "run.xlsx", dialect(tmp_path, "excel", more.replace("Run 7", "Run 8")))


@pytest.mark.parametrize("user_block", [0, 512])
def test_hdf5_and_matlab_7_3(tmp_path, wanted, user_block):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.mat"
    with h5py.File(path, "w", userblock_size=user_block) as file:
        for name, values in DATA.items():
            bare, unit = name.split(" ")
            # MATLAB writes a column as one row
            made = file.create_dataset(f"log/{bare}", data=values[None, :])
            made.attrs["units"] = unit.strip("[]")
        file["log/comment"] = "words"
    if user_block:
        with path.open("r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116))
    names = {quantity: f"log/{name}" for quantity, name in COLUMNS.items()}
    same(tl.read(path, dialect(tmp_path, "hdf5", names=names)), wanted)


@pytest.mark.parametrize("kind", ["<f8", ">f4"])
def test_records_behind_a_header_of_bytes(tmp_path, wanted, kind):
    record = np.zeros(N, dtype=[(name, kind) for name in COLUMNS.values()])
    for name, values in DATA.items():
        record[name.split(" ")[0]] = values
    path = tmp_path / "run.bin"
    path.write_bytes(b"HEAD\0\1\2\3".ljust(64, b"\0") + record.tobytes() + b"cut")
    fields = ", ".join(f'"{name} {kind}"' for name in COLUMNS.values())
    more = f"[binary]\noffset = 64\nfields = [{fields}]"
    units = dict(zip(COLUMNS, ("s", "mm/s", "N", "N"), strict=True))
    run = tl.read(path, dialect(tmp_path, "binary", more, units=units))
    if kind == "<f8":
        same(run, wanted)
    np.testing.assert_allclose(run["friction_force"], wanted["friction_force"], rtol=1e-6)
    with pytest.raises(ConfigError, match="is not a name and a type"):
        tl.read(
            path, dialect(tmp_path, "binary", more.replace(f"Fx {kind}", "Fx long"), units=units)
        )
    path.write_bytes(b"\0" * 70)
    with pytest.raises(ReadError, match="a record has"):
        tl.read(path, dialect(tmp_path, "binary", more, units=units))


@pytest.mark.parametrize("how", ["gz", "zip"])
@pytest.mark.parametrize("form", ["text", "parquet"])
def test_compressed_files_are_read_as_what_they_hold(tmp_path, wanted, how, form):
    inner = csv(tmp_path)
    if form == "parquet":
        inner = tmp_path / "run.parquet"
        pq.write_table(pa.table(DATA), inner)
    path = tmp_path / f"{inner.name}.{how}"
    if how == "gz":
        path.write_bytes(gzip.compress(inner.read_bytes()))
    else:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(inner, f"some folder/{inner.name}")
    inner.unlink()
    run = tl.read(path, dialect(tmp_path, form, "[header]\nline = 1" if form == "text" else ""))
    same(run, wanted)
    assert run.attrs["source"] == path.name
    assert len(run.attrs["source_sha256"]) == 64


def test_archives_that_cannot_be_read_say_why(tmp_path):
    rule = dialect(tmp_path, "text", "[header]\nline = 1")
    two = tmp_path / "two.zip"
    with zipfile.ZipFile(two, "w") as archive:
        for name in ("a.csv", "b.csv"):
            archive.writestr(name, "t [s]\n0\n")
    with pytest.raises(ReadError, match=r"holds 2 files \(a\.csv, b\.csv\)"):
        tl.read(two, rule)
    cut = tmp_path / "cut.csv.gz"
    cut.write_bytes(gzip.compress(csv(tmp_path).read_bytes())[:-40])
    with pytest.raises(ReadError, match="damaged"):
        tl.read(cut, rule)
    bomb = tmp_path / "bomb.csv.gz"
    bomb.write_bytes(gzip.compress(b"\0" * (80 << 20)))
    with pytest.raises(ReadError, match="no measurement"):
        tl.read(bomb, rule)


@pytest.mark.parametrize("form", ["parquet", "feather", "excel", "hdf5"])
def test_damaged_files_are_clear_errors(tmp_path, form):
    magic = {"parquet": b"PAR1", "feather": b"ARROW1", "excel": b"\xd0\xcf\x11\xe0"}
    path = tmp_path / "run.dat"
    path.write_bytes(magic.get(form, b"\x89HDF\r\n\x1a\n") + b"\0nothing of the kind" * 20)
    with pytest.raises(ReadError, match="cannot be read"):
        tl.read(path, dialect(tmp_path, form))


def test_columns_of_words_or_of_unequal_length_are_refused(tmp_path):
    table = pa.table({**DATA, "Fz [N]": ["words"] * N})
    pq.write_table(table, tmp_path / "words.parquet")
    with pytest.raises(ReadError, match="'Fz' holds no numbers"):
        tl.read(tmp_path / "words.parquet", dialect(tmp_path, "parquet"))
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        for k, (name, values) in enumerate(DATA.items()):
            file[name] = values[k:]
    with pytest.raises(ReadError, match="differ in length"):
        tl.read(tmp_path / "run.h5", dialect(tmp_path, "hdf5"))


def test_a_matrix_of_an_archive_has_the_names_and_units_that_another_array_lists(tmp_path):
    time = np.arange(600) / 100
    names = ["time [s]", "Ft [N]", "Fn [N]", "v [mm/s]"]
    data = np.column_stack([time, 3 + 0 * time, 10 + 0 * time, 5 + 0 * time])
    np.savez(tmp_path / "a.npz", data=data, columns=np.array(names))
    run = tl.read(tmp_path / "a.npz")
    np.testing.assert_allclose(run.sliding_velocity, 5e-3)
    np.testing.assert_allclose(run.friction_force, 3)
