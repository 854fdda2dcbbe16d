"""Several tables of the same columns in one file, and what else files with named columns hold."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.core.errors import ReadError

RATE, N, ZERO = 20.0, 300, 0.5
STEPS = {1.0: 0.30, 2.0: 0.28, 5.0: 0.25}  # mm/s: coefficient
NOISE = np.random.default_rng(5)


def step(speed, mu, load=10.0, zero=ZERO):
    """Return columns of a step, whose clock starts at zero and whose forces have offsets."""
    time = np.arange(N) / RATE
    normal = load + 0.05 * NOISE.standard_normal(N)
    friction = mu * normal + zero + 0.02 * NOISE.standard_normal(N)
    motion = speed * (1 + 0.002 * NOISE.standard_normal(N))
    return {"time": time, "Ff": friction, "Fn": normal - 0.2, "v": motion}


def tables():
    return {f"step {k}": step(v, mu) for k, (v, mu) in enumerate(STEPS.items(), 1)}


UNITS = {"time": "s", "Ff": "N", "Fn": "N", "v": "mm/s"}


def workbook(path, found):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["Test", "pin on disc"])
    for name, columns in found.items():
        page = book.create_sheet(name)
        page.append([None, name, "rig 3"])
        page.append([None, *UNITS])
        page.append([None, *UNITS.values()])
        for row in zip(*columns.values(), strict=True):
            page.append([None, *map(float, row)])
    book.save(path)


def groups(path, found):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        for name, columns in found.items():
            for label, values in columns.items():
                file[f"log/{name}/{label}"] = values
                file[f"log/{name}/{label}"].attrs["units"] = UNITS[label]


def curve(path, dialect=None):
    run = tl.read(path, dialect)
    segments = tl.find_segments(run)
    found = tl.friction_coefficient(run, segments)
    return run, 1e3 * segments.sliding_speed.values, found.friction_coefficient.values


@pytest.mark.parametrize(("write", "name"), [(workbook, "run.xlsx"), (groups, "run.h5")])
def test_of_several_tables_alike_one_is_proposed_and_the_others_are_named(write, name, tmp_path):
    write(tmp_path / name, tables())
    with pytest.raises(ReadError, match="longest of several alike is meant, not .*step 2"):
        tl.read(tmp_path / name)


@pytest.mark.parametrize("kind", ["parquet", "feather"])
def test_metadata_of_a_table_are_settings_and_dictionaries_numbers(kind, tmp_path):
    pa = pytest.importorskip("pyarrow")
    size = 600
    turns = np.repeat([10.0, 20.0, 50.0], size // 3).tolist()
    columns = {
        "time": pa.array(np.arange(size) / RATE),
        "phase": pa.array(["run"] * size).dictionary_encode(),
        "speed": pa.array(turns).dictionary_encode(),
        "Ft": pa.array(3 + 0.05 * NOISE.standard_normal(size)),
        "Fn": pa.array(10 + 0.05 * NOISE.standard_normal(size)),
    }
    units = {"time": "s", "speed": "rpm", "Ft": "N", "Fn": "N"}
    plain = pa.table(columns)
    fields = [
        f.with_metadata({"unit": units[f.name]} if f.name in units else {}) for f in plain.schema
    ]
    setup = {"rig": "A", "track radius": "20 mm"}
    table = plain.cast(pa.schema(fields, metadata=setup))
    if kind == "parquet":
        from pyarrow import parquet

        parquet.write_table(table, tmp_path / "run.parquet")
    else:
        from pyarrow import feather

        feather.write_feather(table, tmp_path / "run.feather")
    _, speed, coefficient = curve(tmp_path / f"run.{kind}")
    np.testing.assert_allclose(speed, 20 * 2 * np.pi * np.array([10, 20, 50]) / 60, rtol=1e-6)
    np.testing.assert_allclose(coefficient, 0.3, rtol=5e-3)


def test_rows_of_hdf5_have_units_in_a_list_and_names_that_only_a_text_explains(tmp_path):
    h5py = pytest.importorskip("h5py")
    columns = step(2.0, 0.3, zero=0.0)
    rows = np.zeros(N, dtype=[(name, "f8") for name in columns])
    for name, values in columns.items():
        rows[name] = values
    with h5py.File(tmp_path / "rows.h5", "w") as file:
        file["data"] = rows
        file["data"].attrs["units"] = [unit.encode() for unit in UNITS.values()]
    assert curve(tmp_path / "rows.h5")[1] == pytest.approx([2.0], rel=2e-3)
    with h5py.File(tmp_path / "told.h5", "w") as file:
        for name, told in zip(("tt", "c1", "c2", "c3"), columns, strict=True):
            file[name] = columns[told]
            file[name].attrs["units"] = UNITS[told]
        meanings = ("time", "friction force (x)", "normal force, by a beam", "sliding speed")
        for name, told in zip(("tt", "c1", "c2", "c3"), meanings, strict=True):
            file[name].attrs["long_name"] = told
    assert curve(tmp_path / "told.h5")[2] == pytest.approx([0.3], rel=0.03)


def test_a_sled_that_is_lifted_on_its_way_back_is_asked_about(tmp_path):
    rest, out = np.zeros(200), np.linspace(0, 100, 2000)
    cycle = np.concatenate([rest, out, np.full(200, 100.0), np.linspace(100, 0, 500)])
    way = np.tile(cycle, 3) + 0.01 * NOISE.standard_normal(3 * cycle.size)
    pulled = np.tile(np.concatenate([rest, np.full(2000, 0.6), np.zeros(700)]), 3)
    force = pulled - 0.05 + 0.005 * NOISE.standard_normal(way.size)
    time = np.arange(way.size) / 100
    rows = "\n".join(f"{t:.2f};{x:.3f};{f:.4f}" for t, x, f in zip(time, way, force, strict=True))
    head = "Sled mass: 203.9 g\nRemark: sled lifted off during return, cell not tared\n"
    names = "Time [s];Position [mm];Friction force [N]\n"
    (tmp_path / "sled.txt").write_text(f"{head}{names}{rows}\n")
    with pytest.raises(ReadError, match="although 'Remark: sled lifted off during return"):
        tl.read(tmp_path / "sled.txt")


def test_friction_that_is_counted_against_the_motion_is_turned(tmp_path):
    speed = np.repeat([0.0, 1.0, 5.0], 200)
    force = np.where(speed > 0, -3.0, 0.0) + 0.4 + 0.02 * NOISE.standard_normal(600)
    columns = (
        np.arange(600) / 10,
        speed,
        force,
        np.full(600, 10.0) + 0.05 * np.sin(np.arange(600)),
    )
    rows = "\n".join(",".join(f"{x:.4f}" for x in row) for row in zip(*columns, strict=True))
    (tmp_path / "run.csv").write_text(f"time [s],speed [mm/s],Fx [N],Fz [N]\n{rows}\n")
    run = tl.read(tmp_path / "run.csv")
    assert run.friction_force.values[-100:].mean() == pytest.approx(2.6, abs=0.02)
    assert run.attrs["counted_negative"] == "friction_force"


@pytest.mark.parametrize("offset", [0.0, -10.0])
def test_friction_that_falls_from_a_creep_to_fast_sliding_keeps_its_sign(offset, tmp_path):
    speed = np.repeat([0.1, 10.0, 100.0], 200)
    force = np.repeat([3.0, 2.5, 1.5], 200) + offset + 0.02 * NOISE.standard_normal(600)
    columns = (np.arange(600) / 10, speed, force, 10.0 + 0.05 * np.sin(np.arange(600)))
    rows = "\n".join(",".join(f"{x:.4f}" for x in row) for row in zip(*columns, strict=True))
    (tmp_path / "run.csv").write_text(f"time [s],speed [mm/s],Fx [N],Fz [N]\n{rows}\n")
    run = tl.read(tmp_path / "run.csv")
    np.testing.assert_allclose(run.friction_force, np.round(force, 4), atol=1e-9)


def test_of_a_crank_a_plateau_by_chance_is_not_taken_for_all_strokes():
    chance = np.random.default_rng(3)  # of six such records this has one stretch that seems even
    told = ((0.5, 6), (1, 10), (2, 60), (5, 60))  # Hz, cycles
    ways = [-5e-3 * np.cos(2 * np.pi * f * np.arange(0, n / f, 1 / 500)) for f, n in told]
    way = np.concatenate(ways)
    force = 4 * np.sign(np.gradient(way)) + 0.08 * chance.standard_normal(way.size)
    position = way + 5e-6 * chance.standard_normal(way.size)
    run = xr.Dataset(
        {"position": ("time", position), "friction_force": ("time", force)},
        {"time": np.arange(way.size) / 500},
    )
    assert tl.find_segments(run).sizes["segment"] > 250
