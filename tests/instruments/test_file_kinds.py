"""Files of many kinds, written by the rig with known truth: understood, and right."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from file_kinds import AT_ONCE, DESCRIBED, DRAFTED, judge, read_in_some_way
from layouts import KINDS, write_kind
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core.errors import AnalysisError, ReadError
from tribolab.reading.runs.stroke_speed import velocity_of_strokes

WAYS = {
    "rotary_steps": AT_ONCE,
    "rotary_torque": AT_ONCE,
    "two_load_channels": AT_ONCE,
    "mini_traction": AT_ONCE,
    "stroke_settings": AT_ONCE,
    "stresses": AT_ONCE,
    "tribox": AT_ONCE,
    "compressed": AT_ONCE,
    "intervals": AT_ONCE,
    "workbook": AT_ONCE,
    "tdms": AT_ONCE,
    "hdf5": AT_ONCE,
    "zipped": AT_ONCE,
    "sled": AT_ONCE,
    "stated_ratio": AT_ONCE,
    "settings_sheet": AT_ONCE,
    "radius_unsaid": DRAFTED,
    "bridges": DESCRIBED,
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WAYS)
def test_a_file_of_this_kind_is_read_in_its_way_and_right(name, tmp_path):
    written = write_kind(name, tmp_path, seed=40)
    read = read_in_some_way(written, tmp_path)
    assert read.way == WAYS[name], read.why
    judged = judge(written, read.run)
    assert not judged.faults
    assert (judged.sem < 0.03 * judged.truth).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["workbook", "tdms", "hdf5", "feather"])
def test_what_is_drafted_from_columns_is_written_down_and_reads_the_file(name, tmp_path):
    path = write_kind(name, tmp_path).path
    at_once = tl.read(path)
    assert at_once.attrs["instrument"] == "drafted from the file"
    toml = tl.reading.draft_dialect(path).toml
    (tmp_path / "kept.toml").write_text(toml)
    assert tl.read(path, tmp_path / "kept.toml").drop_attrs().identical(at_once.drop_attrs())
    if name == "feather":  # the command does the same with each
        told = CliRunner().invoke(
            cli.app, ["info", str(path), "--write", str(tmp_path / "run.toml")]
        )
        assert told.exit_code == 0 and (tmp_path / "run.toml").read_text() == toml


def test_a_sheet_with_units_below_its_names_is_told_from_one_of_words(tmp_path):
    book = pd.ExcelWriter(tmp_path / "run.xlsx")
    words = pd.DataFrame([["Operator", "A. Person"], ["Load", "20 N"]])
    rows = [["Rig 7", "", ""], ["Zeit", "Reibkraft", "Normalkraft"], ["s", "N", "N"]]
    rows += [[0.1 * n, 3.0, 10.0] for n in range(200)]
    with book:
        words.to_excel(book, sheet_name="About", index=False, header=False)
        pd.DataFrame(rows).to_excel(book, sheet_name="Lauf", index=False, header=False)
    dialect = tl.reading.draft_dialect(tmp_path / "run.xlsx").dialect
    assert (dialect.header.sheet, dialect.header.line, dialect.header.units) == ("Lauf", 2, "row")
    run = tl.read(tmp_path / "run.xlsx")
    assert run.sizes["time"] == 200 and run["friction_force"].values[7] == 3.0


def test_columns_without_numbers_are_no_run(tmp_path):
    pd.DataFrame({"a": ["x", "y"], "b": ["1", "2"]}).to_parquet(tmp_path / "words.parquet")
    with pytest.raises(ReadError, match="no known instrument writes such a file"):
        tl.read(tmp_path / "words.parquet")
    with pytest.raises(ReadError, match="no columns of numbers"):
        tl.reading.draft_dialect(tmp_path / "words.parquet")
    (tmp_path / "bad.parquet").write_bytes(b"PAR1 and no more")
    with pytest.raises(ReadError, match="this parquet file cannot be read"):
        tl.reading.draft_dialect(tmp_path / "bad.parquet")


@pytest.mark.parametrize("unit", ["Nm", "N m", "mNm", "Nmm", "Ncm", "N-m", "µNm"])
def test_a_torque_is_understood_however_its_unit_is_written(unit, tmp_path):
    factor = {"Nm": 1, "N m": 1, "N-m": 1, "mNm": 1e3, "Nmm": 1e3, "Ncm": 100, "µNm": 1e6}[unit]
    path = write_kind("rotary_torque", tmp_path).path
    head, *rows = path.read_bytes().decode("latin-1").split("Time [s]")[1].split("\n")
    cells = [row.split(";") for row in rows if row]
    for row in cells:
        row[1] = f"{float(row[1].replace(',', '.')) * factor:.6f}".replace(".", ",")
    text = "Reibradius: 25,0 mm\nTime [s]" + head.replace("N m", unit) + "\n"
    path.write_text(text + "\n".join(";".join(row) for row in cells) + "\n", "utf-8")
    run = tl.read(path)
    assert float(np.abs(run["friction_force"]).max()) == pytest.approx(4.0, rel=0.1)
    assert float(run["sliding_velocity"].max()) == pytest.approx(0.2, rel=1e-3)


def test_a_kind_that_nobody_writes_is_an_error_with_the_nearest():
    with pytest.raises(AnalysisError, match="did you mean 'stresses'"):
        write_kind("stress", ".")
    assert set(WAYS) < set(KINDS)


def test_what_shows_without_contact_is_taken_off_stresses_and_told(tmp_path):
    written = write_kind("stresses", tmp_path, seed=41)
    run = tl.read(written.path)
    load = written.record.set_force / 100e-6  # over the rig's area
    error = 0.003 * load / np.sqrt(640)  # noise of the sensor, samples at rest without load
    assert run.attrs["normal_stress_zero_Pa"] == pytest.approx(0.01 * load, abs=4 * error)
    loaded = written.path.read_text().splitlines()
    always = [loaded[0], *loaded[700:-500]]  # never unloaded
    written.path.write_text("\n".join(always))
    assert "normal_stress_zero_Pa" not in tl.read(written.path).attrs


@pytest.mark.parametrize(("drive", "top"), [("crank", np.pi), ("constant speed", 2.0)])
def test_the_speed_of_strokes_has_the_phase_of_the_friction_and_its_frequency(drive, top):
    time = np.arange(0, 60, 0.002)
    true = 2.03  # set to 2 Hz, and a little fast
    moves = (time > 5) & (time < 55)
    angle = 2 * np.pi * true * time + 0.7
    friction = np.where(moves, np.sign(np.cos(angle)), 0.0) + 0.4  # an unknown zero
    friction = friction + 0.05 * np.random.default_rng(0).standard_normal(time.size)
    strokes = velocity_of_strokes(time, friction, 5e-3, 2.0, drive)
    assert strokes.frequency == pytest.approx(true, rel=1e-3)
    want = np.cos(angle) if drive == "crank" else np.sign(np.cos(angle))
    inside = (time > 6) & (time < 54)
    off = strokes.velocity[inside] / (top * true * 5e-3) - want[inside]
    assert np.sqrt(np.mean(off**2)) < (0.02 if drive == "crank" else 0.15)
    assert not strokes.velocity[(time < 4) | (time > 56)].any()


def test_friction_without_sign_tells_no_phase_and_the_mean_speed_is_all():
    time = np.arange(0, 20, 0.005)
    rectified = np.abs(np.sign(np.cos(2 * np.pi * time))) + 0.01 * np.cos(40 * time)
    assert velocity_of_strokes(time, rectified, 5e-3, 1.0, "crank") is None
    assert velocity_of_strokes(time[:300], np.cos(6 * time[:300]), 5e-3, 1.0, "crank") is None


def test_what_drives_the_strokes_is_a_guess_unless_it_is_said(tmp_path):
    path = write_kind("stroke_settings", tmp_path).path
    text = path.read_text().replace("Drive: crank\n", "")
    path.write_text(text)
    with pytest.raises(ReadError, match="a crank drives it: the speed is a sine .or constant"):
        tl.read(path)
    path.write_text(text.replace("Stroke length: 10 mm", "Stroke length: 10 mm\nMotion: triangle"))
    speed = np.abs(tl.read(path)["sliding_velocity"].values)
    assert np.median(speed) == pytest.approx(2 * 10e-3 * 1.0, rel=1e-3)


def test_a_diameter_of_the_track_and_the_turns_of_a_crank_are_understood(tmp_path):
    path = write_kind("rotary_steps", tmp_path).path
    text = path.read_text()
    path.write_text(text.replace("Track radius: 25 mm", "Wear track diameter (mm): 50"))
    assert float(tl.read(path)["sliding_velocity"].max()) == pytest.approx(0.2, rel=1e-3)
    path.write_text(text.replace("Track radius: 25 mm", "Disc diameter (mm): 50"))
    with pytest.raises(ReadError, match="is twice the radius of the track"):
        tl.read(path)
    path = write_kind("stroke_settings", tmp_path).path
    turns = path.read_text().replace("Frequency: 1 Hz", "Crank speed: 60 rpm")
    path.write_text(turns)
    run = tl.read(path)
    assert run.attrs["stroke_frequency_Hz"] == pytest.approx(1.0, rel=1e-3)
    assert float(run["sliding_velocity"].max()) == pytest.approx(np.pi * 10e-3, rel=1e-2)


def test_a_person_is_asked_for_the_radius_of_the_track(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = write_kind("radius_unsaid", tmp_path).path
    typed = "25\n25 mm\n"
    done = CliRunner().invoke(
        cli.app, ["info", file.name, "--write", f"{file.stem}.toml", "--ask"], input=typed
    )
    assert done.exit_code == 0 and "what is the radius of the track" in done.stdout
    assert "3 segments, friction coefficient 0.38" in done.stdout
    assert 'radius = "25 mm"' in file.with_suffix(".toml").read_text()


def test_columns_of_unknown_names_are_asked_for_where_no_friction_is_known(tmp_path):
    file = tmp_path / "unnamed.csv"
    file.write_text("Time [s],Weg [mm],Kanal 7 [mV]\n" + "\n".join(f"{n},{n},1" for n in range(30)))
    with pytest.raises(ReadError, match="no column is known to hold it: column 3 'Kanal 7"):
        tl.read(file)
