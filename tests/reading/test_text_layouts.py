"""Arrangements of text that other labs write: read with their names, units and settings."""

import json
from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.text.endless import refuse_endless
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft
from tribolab.reading.unknown.proposal.questions import missing_words

RNG = np.random.default_rng(21)
TIME = np.round(0.1 * np.arange(300), 3)
FORCE = np.round(1.2 + 0.02 * RNG.normal(size=TIME.size), 4)
LOAD = np.round(10 + 0.05 * RNG.normal(size=TIME.size), 3)


def both_ways(path):
    """Return a run as drafted on the fly, and as read by the dialect that was kept."""
    kept = save_draft(draft_dialect(path), path.with_suffix(".toml"))
    return tl.read(path), tl.read(path, instrument=kept)


def columnar():
    return {"t": TIME.tolist(), "Ft": FORCE.tolist(), "Fn": LOAD.tolist(), "v": [5.0] * TIME.size}


UNITS = {"t": "s", "Ft": "N", "Fn": "N", "v": "mm/s"}


JSON = {
    "split": lambda: {
        "columns": [f"{n} [{u}]" for n, u in UNITS.items()],
        "data": [list(row) for row in zip(*columnar().values(), strict=True)],
    },
    "records": lambda: [
        {
            f"{n}_{u.replace('/', '_')}": value
            for (n, u), value in zip(UNITS.items(), row, strict=True)
        }
        for row in zip(*columnar().values(), strict=True)
    ],
    "channels": lambda: {
        "test": {"radius": {"value": 4, "unit": "cm"}},
        "channels": [{"name": n, "unit": UNITS[n], "samples": v} for n, v in columnar().items()],
    },
    "counted": lambda: {
        f"{n} [{UNITS[n]}]": {str(k): value for k, value in enumerate(v)}
        for n, v in columnar().items()
    },
}


@pytest.mark.parametrize("form", JSON)
@pytest.mark.parametrize("indent", [None, 1])
def test_columns_in_json_are_a_table(tmp_path, form, indent):
    (tmp_path / "a.json").write_text(json.dumps(JSON[form](), indent=indent))
    for run in both_ways(tmp_path / "a.json"):
        np.testing.assert_allclose(run.friction_force, FORCE)
        np.testing.assert_allclose(run.normal_force, LOAD)
        np.testing.assert_allclose(run.sliding_velocity, 5e-3)
        np.testing.assert_allclose(np.diff(run.time), 0.1, rtol=1e-6)


def test_settings_in_objects_of_json_are_found(tmp_path):
    said = {"geometry": {"contact_radius_mm": 15.0}, "load": {"value": 3, "unit": "N"}}
    data = {"t": TIME.tolist(), "M": (1000 * FORCE).tolist(), "rpm": [30.0] * TIME.size}
    units = {"t": "s", "M": "uN.m", "rpm": "1/min"}
    document = {"meta": {"units": units, **said}, "data": data}
    (tmp_path / "a.json").write_text(json.dumps(document))
    run = tl.read(tmp_path / "a.json")
    np.testing.assert_allclose(run.friction_force, FORCE * 1e-3 / 0.015)
    np.testing.assert_allclose(run.sliding_velocity, 0.015 * np.pi)
    np.testing.assert_allclose(run.normal_force, 3)


SIGNALS = {"Time": "s", "Friction force": "N", "Normal force": "N", "Speed": "mm/s"}
COLUMNS = (TIME, FORCE, LOAD, 0 * TIME + 5)


def check(path):
    for run in both_ways(path):
        np.testing.assert_allclose(run.friction_force, FORCE)
        np.testing.assert_allclose(run.normal_force, LOAD)
        np.testing.assert_allclose(run.sliding_velocity, 5e-3)
        np.testing.assert_allclose(np.diff(run.time), 0.1, rtol=1e-6)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_wide_letters_without_a_mark_are_text(tmp_path, encoding):
    head = "\t".join(f"{name} [{unit}]" for name, unit in SIGNALS.items())
    rows = ("\t".join(map(str, row)).replace(".", ",") for row in zip(*COLUMNS, strict=True))
    (tmp_path / "a.txt").write_bytes("\r\n".join([head, *rows, ""]).encode(encoding))
    check(tmp_path / "a.txt")


RECORDS = """CAPTURE V1.4
header_bytes=512
{kind}
channels=3
layout={layout}
sample_rate_hz=100
{formula}
ch1=FRICTION_FORCE unit=N scale=0.001 bias={bias}
ch2=NORMAL_FORCE unit=N scale=0.01 bias=0
ch3=ENCODER unit=counts (1000 per turn, wraps to 0) scale=1 bias=0
track_radius_mm=20
end_header
"""


@pytest.mark.parametrize("kind", ["data_type=int16\nbyte_order=little", "dtype=>i2"])
@pytest.mark.parametrize("layout", ["interleaved", "sequential"])
@pytest.mark.parametrize("inside", [True, False])
def test_a_header_of_text_declares_the_binary_numbers_behind_it(tmp_path, kind, layout, inside):
    turns = 0.03 * np.arange(1000)
    raw = np.column_stack([np.full(1000, 1500), np.full(1000, 2000), (1000 * turns) % 1000 // 1])
    raw = raw if layout == "interleaved" else raw.T
    formula = "; physical = (raw - bias)*scale" if inside else "; physical = raw*scale + bias"
    bias = 500 if inside else -0.5
    head = RECORDS.format(kind=kind, layout=layout, formula=formula, bias=bias).encode()
    numbers = np.ascontiguousarray(raw.astype(">i2" if ">" in kind else "<i2")).tobytes()
    (tmp_path / "a.bin").write_bytes(head.ljust(512, b"\0") + numbers)
    for run in both_ways(tmp_path / "a.bin"):
        np.testing.assert_allclose(run.friction_force, 1.0)
        np.testing.assert_allclose(run.normal_force, 20)
        np.testing.assert_allclose(np.diff(run.time), 0.01, rtol=1e-6)
        way = 0.02 * 2 * np.pi * turns
        np.testing.assert_allclose(run.position, way, atol=0.02 * 2 * np.pi * 2e-3)


def test_a_load_that_steps_at_one_speed_parts_the_segment(tmp_path):
    t = 0.1 * np.arange(1800)
    load = 10 + 10 * np.clip((t - 60) / 2, 0, 1) + 20 * np.clip((t - 120) / 2, 0, 1)
    load += 0.05 * RNG.normal(size=t.size)
    rows = np.column_stack([t, 0.3 * load, load, 0 * t + 5])
    head = "time [s],friction force [N],normal force [N],speed [mm/s]"
    np.savetxt(tmp_path / "a.csv", rows, "%.4f", ",", header=head, comments="")
    run = tl.read(tmp_path / "a.csv")
    mu = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(mu.normal_force, [10, 20, 40], rtol=2e-3)
    np.testing.assert_allclose(mu.friction_coefficient, 0.3, rtol=1e-3)


def test_a_load_that_rises_all_the_time_parts_nothing(tmp_path):
    t = 0.1 * np.arange(900)
    rows = np.column_stack([t, 1 + 0.03 * t, 5 + 0.1 * t, 0 * t + 5])
    head = "time [s],friction force [N],normal force [N],speed [mm/s]"
    np.savetxt(tmp_path / "a.csv", rows, "%.4f", ",", header=head, comments="")
    assert tl.find_segments(tl.read(tmp_path / "a.csv")).sizes["segment"] == 1


def lacks(path):
    return missing_words(draft_dialect(path))


def test_what_a_volt_is_worth_is_told_to_be_missing(tmp_path):
    rows = (f"{t},{f},{n},{5 * t:.2f},\n" for t, f, n in zip(TIME, FORCE, LOAD, strict=True))
    head = "Time [s],Friction [Volts],Load [N],x [mm],Comment\n0,0,0,0,start\n"
    (tmp_path / "a.csv").write_text(head + "".join(rows))
    (told,) = lacks(tmp_path / "a.csv")
    assert told.startswith("what a volt of 'Friction [Volts]' is worth")


def test_a_frequency_without_a_stroke_asks_for_the_stroke(tmp_path):
    rows = (f"{t},{f},{n},2\n" for t, f, n in zip(TIME, FORCE, LOAD, strict=True))
    head = "Time [s],Friction force [N],Load [N],Frequency [Hz]\n"
    (tmp_path / "a.csv").write_text(head + "".join(rows))
    (told,) = lacks(tmp_path / "a.csv")
    assert told.startswith("the length of the stroke, for the sliding speed")


def test_turns_without_a_radius_ask_for_the_radius_alone(tmp_path):
    rows = (f"{t},{f},{n},30\n" for t, f, n in zip(TIME, FORCE, LOAD, strict=True))
    head = "Time [s],Friction force [N],Load [N],Speed [rpm]\n"
    (tmp_path / "a.csv").write_text(head + "".join(rows))
    with pytest.raises(tl.TribolabError, match="needs the radius of"):
        tl.find_segments(tl.read(tmp_path / "a.csv"))


def test_a_temperature_is_no_clock(tmp_path):
    rows = (f"{t},{f},{21 + t / 10:.3f},{n}\n" for t, f, n in zip(TIME, FORCE, LOAD, strict=True))
    (tmp_path / "a.csv").write_text("t [s],FT [N],T [degC],FN [N]\n" + "".join(rows))
    run = tl.read(tmp_path / "a.csv")
    assert run.sizes["time"] == TIME.size
    np.testing.assert_allclose(run.normal_force, LOAD)


def test_settings_may_stand_below_a_table_that_begins_the_file(tmp_path):
    rows = "\n".join(f"{t},120,{0.02 * f:.5f}" for t, f in zip(TIME, FORCE, strict=True))
    foot = "\nTest parameters\nTrack radius: 20 mm\nNormal load: 10 N\nOperator: A. Person\n"
    for name, text in (("short", rows), ("long", "\n".join([rows] * 400))):
        if name == "long":  # only its end is looked at
            numbers = (f"{k / 10:.1f},120,0.024" for k in range(120_000))
            text = "\n".join(numbers)
        file = tmp_path / f"{name}.csv"
        file.write_text(f"Time [s],Speed [rpm],Torque [N m]\n{text}\n{foot}")
        run, kept = both_ways(file)
        assert run.attrs["track_radius_m"] == 0.02 and run.attrs["set_normal_force_N"] == 10
        np.testing.assert_array_equal(run.friction_force, kept.friction_force)
    # what stands above goes before, and results below are no settings
    file.write_text(
        f"Load: 5 N\nTrack radius: 30 mm\nTime [s],Speed [rpm],Torque [N m]\n{rows}\n{foot}"
    )
    run = tl.read(file)
    assert run.attrs["track_radius_m"] == 0.03 and run.attrs["set_normal_force_N"] == 5


@pytest.mark.parametrize("head", ["", "Time [s],Fx [N]\n"])
def test_rows_of_more_cells_than_a_map_are_refused_before_a_table_is_looked_for(head, tmp_path):
    row = ",".join(["1.5"] * 10_001) + "\n"
    (tmp_path / "a.txt").write_text(head + 3 * row)
    for reader in (tl.read, tl.read_scans):
        with pytest.raises(ReadError, match=r"a\.txt: some 10001 columns are more than a"):
            reader(tmp_path / "a.txt")


@pytest.mark.parametrize("line", ["Load: 31 N\n", "Load of the ball on the plate\n"])
def test_a_megabyte_of_words_above_a_table_is_refused(line, tmp_path):
    table = "Time [s],Fx [N],Fz [N]\n" + "".join(f"{n / 10},0.5,31.0\n" for n in range(100))
    (tmp_path / "a.txt").write_text(line * (1_100_000 // len(line)) + table)
    with pytest.raises(ReadError, match="no line of the first megabyte is a row of numbers"):
        tl.read(tmp_path / "a.txt")


@pytest.mark.parametrize(
    "line",
    [
        "2026-11-27 12:00:00;0.5;31.0",
        '"A";0,5;31',
        "run 7;0.5;31.0;ok",
        "(0.5 31.0)",
        "Fx; 0.5",
        "-.5e-3",
        "\x00".join("0.5 31.0\x00"),
    ],
)
def test_a_megabyte_of_rows_of_numbers_is_looked_at(line):
    head = (line + "\n").encode() * 60_000
    refuse_endless(Path("a.txt"), head, 2 * len(head))


def test_one_line_of_a_whole_profile_is_looked_at():
    refuse_endless(Path("a.txt"), b"# heights\n" + b"0.5 " * 50_000 + b"\n", 200_011)
