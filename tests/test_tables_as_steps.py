"""Several tables of the same columns in one file are the steps of one run."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft
from tribolab.reading.unknown_run import holds_run

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


def tables(after=None):
    found = {"zero": step(0.0, 0.0, 0.0)}
    found |= {f"step {k}": step(v, mu) for k, (v, mu) in enumerate(STEPS.items(), 1)}
    return found | ({} if after is None else {"zero after": step(0.0, 0.0, 0.0, after)})


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


def structures(path, found):
    from scipy.io import savemat

    steps = [columns for name, columns in found.items() if name.startswith("step")]
    array = np.zeros((1, len(steps)), dtype=[(name, object) for name in UNITS])
    for place, columns in enumerate(steps):
        array[0, place] = tuple(values[:, None] for values in columns.values())
    said = {"units": {k: u for k, u in UNITS.items()}, "fs_Hz": RATE}
    zero = {k: v for k, v in found["zero"].items() if k != "time"}
    savemat(path, {"test": {"info": said, "zero": zero, "stage": array}})


def channels(path, found):
    tdms = pytest.importorskip("nptdms")
    said = []
    for name, columns in found.items():
        clock = {"wf_increment": 1 / RATE, "wf_start_offset": 0.0}
        for label in ("Ff", "Fn", "v"):
            about = clock | {"unit_string": UNITS[label]}
            said.append(tdms.ChannelObject(name, label, columns[label], about))
    with tdms.TdmsWriter(path) as file:
        file.write_segment(said)


def archive(path, found):
    said = {"units": UNITS, "fs_Hz": RATE}
    arrays = {
        f"{name.replace(' ', '')}_{label}": values
        for name, columns in found.items()
        if name.startswith("step")
        for label, values in columns.items()
        if label != "time"
    }
    for name in [name for name in arrays if name.endswith("_Ff")]:
        arrays[name] = arrays[name] - ZERO
    np.savez(path, meta=json.dumps(said), **arrays)


def curve(path, dialect=None):
    run = tl.read(path, dialect)
    segments = tl.find_segments(run)
    found = tl.friction_coefficient(run, segments)
    return run, 1e3 * segments.sliding_speed.values, found.friction_coefficient.values


@pytest.mark.parametrize(
    ("write", "name"),
    [
        (workbook, "run.xlsx"),
        (groups, "run.h5"),
        (structures, "run.mat"),
        (channels, "run.tdms"),
    ],
)
def test_tables_alike_are_steps_and_one_without_contact_is_their_zero(write, name, tmp_path):
    write(tmp_path / name, tables())
    run, speed, coefficient = curve(tmp_path / name)
    np.testing.assert_allclose(speed, list(STEPS), rtol=2e-3)
    np.testing.assert_allclose(coefficient, list(STEPS.values()), rtol=5e-3)
    assert set(run.step.values) == {1, 2, 3} and run.sizes["time"] == 3 * N
    np.testing.assert_allclose(run.normal_force.mean(), 10.0, rtol=2e-3)
    assert holds_run(tmp_path / name) and run.attrs["zeros_read"]
    own = save_draft(draft_dialect(tmp_path / name), tmp_path / "own.toml")
    write(tmp_path / f"b_{name}", tables())
    np.testing.assert_allclose(
        curve(tmp_path / f"b_{name}", own)[2], list(STEPS.values()), rtol=5e-3
    )


def test_arrays_of_an_archive_that_are_numbered_are_steps(tmp_path):
    archive(tmp_path / "run.npz", tables())
    run, speed, _ = curve(tmp_path / "run.npz")
    np.testing.assert_allclose(speed, list(STEPS), rtol=2e-3)
    assert run.attrs["steps_are"] == "step1, step2, step3"


def test_between_a_zero_before_and_one_after_the_zero_goes_evenly(tmp_path):
    workbook(tmp_path / "run.xlsx", tables(after=ZERO + 0.3))
    run = tl.read(tmp_path / "run.xlsx")
    assert run.attrs["zeros_read"]["friction_force"] == "table zero to table zero after"
    taken = step(1.0, 0.3)["Ff"].mean() - run.friction_force.values[:N].mean()
    assert taken == pytest.approx(ZERO + 0.3 / 6, abs=0.01)  # in the middle of the first of three
    doubt = run.attrs["friction_force_zero_uncertainty_N"]
    assert doubt == pytest.approx(0.3 / np.sqrt(12), rel=0.05)


def test_a_table_that_is_called_a_zero_but_is_loaded_is_asked_about(tmp_path):
    found = tables() | {"zero": step(3.0, 0.3)}
    groups(tmp_path / "run.h5", found)
    with pytest.raises(ReadError, match="though it is under load"):
        tl.read(tmp_path / "run.h5")


def test_steps_are_in_the_order_of_their_numbers_and_each_has_its_settings(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file.attrs["normal_load_N"] = 12.0
        for k in range(1, 12):
            group = file.create_group(f"s{k}")
            group.attrs["set_speed_mm_per_s"] = float(k)
            group["time_s"] = np.arange(60) / 10
            group["friction_N"] = 3.0 + 0.1 * NOISE.standard_normal(60)
    run = tl.read(tmp_path / "run.h5")
    np.testing.assert_allclose(1e3 * run.set_speed.values[::60], np.arange(1, 12))
    np.testing.assert_allclose(run.normal_force, 12.0)


def test_a_gain_in_a_structure_makes_a_force_of_volts_whose_zero_was_read(tmp_path):
    from scipy.io import savemat

    found = tables()
    for columns in found.values():
        columns["Ff"] = columns["Ff"] / 4.0
    array = np.zeros((1, 3), dtype=[(name, object) for name in UNITS])
    for place, columns in enumerate(c for name, c in found.items() if name != "zero"):
        array[0, place] = tuple(columns.values())
    gain = {"Ff_N_per_V": 4.0, "Ff_unit": "V", "Fn_unit": "N", "v_unit": "mm/s"}
    content = {"cal": gain, "stage": array, "zero": found["zero"], "fs_Hz": RATE}
    savemat(tmp_path / "run.mat", {"e": content})
    run, _, coefficient = curve(tmp_path / "run.mat")
    np.testing.assert_allclose(coefficient, list(STEPS.values()), rtol=5e-3)
    assert run.attrs["friction_force_zero_N"] == pytest.approx(ZERO, abs=0.01)


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
    setup = {"rig": "A", "track": {"radius": {"value": 20, "unit": "mm"}}}
    table = plain.cast(pa.schema(fields, metadata={"setup": json.dumps(setup)}))
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


def test_an_archive_of_arrays_is_read_with_its_scales(tmp_path):
    columns = step(2.0, 0.3, zero=0.0)
    counts = {k: np.round(columns[k] / 0.001).astype("i4") for k in ("Ff", "Fn")}
    scales = {k: {"scale": 0.001, "unit": "N"} for k in counts}
    said = json.dumps({"fs_Hz": RATE, **scales, "units": {"v": "mm/s"}})
    np.savez(tmp_path / "run.npz", **counts, v=columns["v"], meta=said)
    run, speed, _ = curve(tmp_path / "run.npz")
    np.testing.assert_allclose(run.friction_force, columns["Ff"], atol=6e-4)
    assert speed == pytest.approx([2.0], rel=2e-3)
    (tmp_path / "cut.npz").write_bytes((tmp_path / "run.npz").read_bytes()[:-300])
    with pytest.raises(tl.TribolabError):
        tl.read(tmp_path / "cut.npz")


def test_a_sled_that_is_lifted_on_its_way_back_has_no_load_there(tmp_path):
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
    run, speed, coefficient = curve(tmp_path / "sled.txt")
    np.testing.assert_allclose(coefficient, 0.3, rtol=0.02)
    np.testing.assert_allclose(speed, 5.0, rtol=0.01)
    assert coefficient.size == 3 and (run.normal_force.values == 0).mean() == pytest.approx(
        500 / cycle.size, abs=0.01
    )


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
