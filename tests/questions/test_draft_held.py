"""Files of others that hold columns by name: read at once as they lie, or asked about."""

from __future__ import annotations

import gzip
import zipfile

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.interpret.names import split_unit

N = 300
T = np.arange(N) / 20
LOAD = 20 + 0.1 * np.sin(T)
FRICTION = 0.25 * LOAD
SPEED = np.where(T < 8, 2.0, 5.0)  # mm/s
COLUMNS = {"time_s": T, "Ff_N": FRICTION, "Fn_N": LOAD, "v_mm_s": SPEED}


def is_right(run):
    np.testing.assert_allclose(run.time, T, atol=1e-6)
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-6)
    np.testing.assert_allclose(run.normal_force, LOAD, atol=1e-6)
    np.testing.assert_allclose(run.sliding_velocity, 1e-3 * SPEED, atol=1e-9)


def mat(path):
    from scipy.io import savemat

    savemat(path, COLUMNS)


def mat_structure(path):
    from scipy.io import savemat

    savemat(path, {"test": {"operator": "B. Person", "log": COLUMNS}}, do_compression=True)


def rows_in_hdf5(path):
    import h5py

    rows = np.zeros(N, dtype=[(name, "f8") for name in COLUMNS])
    for name, values in COLUMNS.items():
        rows[name] = values
    with h5py.File(path, "w") as file:
        file["data/table"] = rows


def matrix_in_hdf5(path):
    import h5py

    with h5py.File(path, "w") as file:
        matrix = file.create_dataset("log", data=np.column_stack(list(COLUMNS.values())))
        matrix.attrs["columns"] = ["Time [s]", "Friction force [N]", "Load [N]", "Speed [mm/s]"]


def frame(**time):
    import pandas as pd

    table = {"Friction force [N]": FRICTION, "Load [N]": LOAD, "Speed [mm/s]": SPEED}
    return pd.DataFrame({**time, **table})


def moments():
    return np.datetime64("2025-03-01T10:00:00", "us") + (1e6 * T).astype("timedelta64[us]")


def parquet_of_moments(path):
    frame(recorded=moments()).to_parquet(path)


def feather_of_durations(path):
    frame(passed=moments() - moments()[0]).to_feather(path)


def sheet_of_moments(path):
    frame(Date=moments()).to_excel(path, index=False)


def sheet_of_text(path):
    frame(**{"Time [s]": T}).map(lambda x: f"{x:.9f}".replace(".", ",")).to_excel(path, index=False)


@pytest.mark.parametrize(
    ("write", "ending"),
    [
        (mat, "mat"),
        (mat_structure, "mat"),
        (rows_in_hdf5, "h5"),
        (matrix_in_hdf5, "h5"),
        (parquet_of_moments, "parquet"),
        (feather_of_durations, "feather"),
        (sheet_of_moments, "xlsx"),
        (sheet_of_text, "xlsx"),
    ],
)
def test_columns_are_read_at_once_however_a_format_holds_them(write, ending, tmp_path):
    write(tmp_path / f"run.{ending}")
    is_right(tl.read(tmp_path / f"run.{ending}"))


@pytest.mark.parametrize("write", [rows_in_hdf5, mat])
def test_what_is_compressed_is_read_as_what_it_holds(write, tmp_path):
    inner = tmp_path / "run.bin"
    write(inner)
    with zipfile.ZipFile(tmp_path / "run.zip", "w") as archive:
        archive.write(inner, "run.h5")
        archive.writestr("__MACOSX/._run.h5", "of the system")
    (tmp_path / "run.gz").write_bytes(gzip.compress(inner.read_bytes()))
    is_right(tl.read(tmp_path / "run.zip"))
    is_right(tl.read(tmp_path / "run.gz"))


def waveforms(path, step, speed, start=None, offset=0.0):
    """Write forces at 20 Hz and speed in a group of its own, each with its interval."""
    from nptdms import ChannelObject, TdmsWriter

    def said(interval, unit, begins="2025-01-01T10:00:00", after=0.0):
        clock = {"wf_start_time": np.datetime64(begins), "wf_start_offset": after}
        return {"wf_increment": interval, "unit_string": unit, **clock}

    motion = said(step, "mm/s", start or "2025-01-01T10:00:00", offset)
    with TdmsWriter(path) as file:
        file.write_segment(
            [
                ChannelObject("Forces", "Friction force", FRICTION, said(0.05, "N")),
                ChannelObject("Forces", "Load", LOAD, said(0.05, "N")),
                ChannelObject("Motion", "Speed", speed, motion),
            ]
        )


def test_channels_with_clocks_of_their_own_are_brought_together(tmp_path):
    file = tmp_path / "run.tdms"
    waveforms(file, 0.05, SPEED)
    is_right(tl.read(file))
    waveforms(file, 0.2, SPEED[::4])
    run = tl.read(file)
    assert run.attrs["time_source"] == "sample rate"
    assert "sliding_velocity: a value every 0.2 s" in run.attrs["interpolated"]
    np.testing.assert_allclose(run.friction_force / run.normal_force, 0.25, rtol=1e-12)
    assert set(np.round(1e3 * run.sliding_velocity.values[T[: run.time.size] < 7], 6)) == {2.0}


@pytest.mark.parametrize("said", [{"start": "2025-01-01T10:00:03"}, {"offset": 3.0}])
@pytest.mark.parametrize("step", [0.05, 0.13, 0.004])
def test_a_channel_that_begins_later_is_read_at_the_times_of_friction(step, said, tmp_path):
    """Speed is 2 + 0.5 t mm/s, sampled by a clock of its own from 3 s on."""
    own = 3 + step * np.arange(int(9 / step))
    waveforms(tmp_path / "run.tdms", step, 2 + 0.5 * own, **said)
    run = tl.read(tmp_path / "run.tdms")
    np.testing.assert_allclose(run.friction_force, FRICTION, rtol=1e-12)
    inside = (T >= own[0]) & (T <= own[-1])
    speed = 1e3 * run.sliding_velocity.values
    np.testing.assert_allclose(speed[inside], (2 + 0.5 * T)[inside], rtol=1e-9)
    assert np.isnan(speed[~inside]).all() and 0 < inside.sum() < T.size


def test_channels_of_different_times_are_no_run(tmp_path):
    waveforms(tmp_path / "run.tdms", 0.05, SPEED, start="2025-01-01T11:00:00")
    with pytest.raises(tl.TribolabError, match="recorded from 3600 to 3614.95 s") as told:
        tl.read(tmp_path / "run.tdms")
    assert "Speed" in str(told.value) and "no signals of one run" in str(told.value)


def test_of_signals_that_stand_twice_it_is_asked_which_are_meant(tmp_path):
    import h5py

    with h5py.File(tmp_path / "runs.h5", "w") as file:
        for name, lost in (("raw", 0.0), ("filtered", 0.01)):
            for label, values in COLUMNS.items():
                file[f"{name}/{label}"] = values * (1 - lost * (label == "Ff_N"))
    with pytest.raises(tl.TribolabError, match="not 'raw'"):
        tl.read(tmp_path / "runs.h5")


@pytest.mark.parametrize(
    ("label", "parts"),
    [
        *[("Ff_N", ("Ff", "N")), ("t_s", ("t", "s")), ("F_N", ("F_N", None))],
        *[("F/Fn", ("F/Fn", None)), ("F_R/F_N", ("F_R/F_N", None)), ("Ft/W", ("Ft/W", None))],
        *[("Ff/N", ("Ff", "N")), ("F / N", ("F", "N")), ("Fn/N", ("Fn", "N"))],
    ],
)
def test_a_symbol_and_its_unit_make_no_other_symbol(label, parts):
    """Ff in N, read as the coefficient F/Fn, would be a wrong one."""
    assert split_unit(label) == parts


@pytest.mark.parametrize("beside", ["another sheet", "rows above", "attributes"])
def test_settings_that_stand_beside_a_table_of_a_workbook_or_hdf5_are_used(beside, tmp_path):
    settings = {"Normal load [N]": 30, "Track radius [mm]": 20, "Rotational speed [rpm]": 150}
    time = 0.1 * np.arange(500)
    force = 9.6 + 0.1 * np.random.default_rng(6).standard_normal(500)
    if beside == "attributes":
        h5py = pytest.importorskip("h5py")
        with h5py.File(tmp_path / "run.h5", "w") as file:
            file.attrs.update({"Normal load": "30 N", "Track radius": "20 mm", "Speed": "150 rpm"})
            file["Time [s]"], file["Friction force [N]"] = time, force
        file_name = "run.h5"
    else:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        page = book.active
        for row in [["Test", "pin on disc"], *settings.items(), []]:
            page.append(list(row))
        table = page if beside == "rows above" else book.create_sheet("Data")
        for row in [["Time [s]", "Friction force [N]"], *zip(time, force, strict=True)]:
            table.append(list(map(str, row) if row[0] == "Time [s]" else map(float, row)))
        book.save(tmp_path / "run.xlsx")
        file_name = "run.xlsx"
    run = tl.read(tmp_path / file_name)
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert float(found.sliding_speed[0]) == pytest.approx(2 * np.pi * 150 / 60 * 0.02)
    assert float(found.friction_coefficient[0]) == pytest.approx(0.32, rel=0.01)
