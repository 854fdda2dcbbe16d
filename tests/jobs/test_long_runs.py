"""A run too long for the memory comes to the same, in scratch files and in many pieces."""

import dataclasses
import mmap
import os
from pathlib import Path

import numpy as np
import pytest
from campaigns import RUNS, simulated
from hypothesis import given
from hypothesis import strategies as st
from reviews import entry

from tribolab.arrays import chunks as pieces
from tribolab.arrays import scratch as room
from tribolab.campaign.runs import stage
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.settings.plan import PlannedRun, planned_runs
from tribolab.campaign.settings.review import REVIEW_FILE
from tribolab.core.errors import ReadError
from tribolab.friction.segments.noise import running_median
from tribolab.friction.segments.slopes import block_slopes, position_noise, without_resets
from tribolab.reading.netcdf.netcdf import read_groups
from tribolab.reading.runs.read_run import read_run

GROUPS = ("run", "segments", "friction", "stick_slip", "friction_as_found")
COLUMNS = {
    "Time [s]": "time",
    "Fx [N]": "friction_force",
    "Fz [N]": "normal_force",
    "Position [mm]": "position",
    "Velocity [mm/s]": "sliding_velocity",
}


@pytest.fixture
def cut_up(monkeypatch):
    """Makes every record a long one, which is worked on in pieces of so many samples."""

    def cut(samples):
        monkeypatch.setattr("tribolab.arrays.scratch.LONG", min(5000, 10 * samples))
        monkeypatch.setattr("tribolab.arrays.chunks.PIECE", samples)

    return cut


def strokes(seed=1, rate=250.0):
    """Columns of strokes at three speeds, with rests, some without load."""
    rng = np.random.default_rng(seed)
    speeds = np.repeat([0.5, 2.0, 8.0], 2) * np.tile([1.0, -1.0], 3)  # mm/s
    velocity, load = [np.zeros(800)], [np.zeros(800)]
    for speed in speeds:
        count = int(rate * 8 / abs(speed))
        velocity += [np.zeros(200), np.full(count, speed), np.zeros(200)]
        load += [np.full(count + 400, 31.0)]
    velocity, load = (np.concatenate([*part, np.zeros(700)]) for part in (velocity, load))
    position = np.cumsum(velocity) / rate
    slip = 0.2 * ((position / 0.05) % 1.0 - 0.5)
    noise = rng.normal(0, 1, (4, velocity.size))
    force = np.sign(velocity) * load * (0.8 + slip) + 0.4 + 0.1 * noise[0]
    return {
        "Time [s]": np.arange(velocity.size) / rate,
        "Fx [N]": np.round(force / 0.0153) * 0.0153,
        "Fz [N]": np.round((load + 0.05 * noise[1]) / 0.0153) * 0.0153,
        "Position [mm]": np.round(position + 2e-5 * noise[2], 5),
        "Velocity [mm/s]": np.round(velocity + 1e-3 * noise[3], 6),
    }


def without(*names):
    return lambda columns: [columns.pop(name) for name in names]


def torn(columns):
    """Missing values, spikes, a stuck stretch, a pause, a denser rate."""
    rng = np.random.default_rng(5)
    count = columns["Fx [N]"].size
    columns["Fx [N]"][rng.integers(0, count, 40)] = np.nan
    columns["Fx [N]"][rng.integers(0, count, 20)] += 60.0
    columns["Fz [N]"][count // 3 : count // 3 + 300] = columns["Fz [N]"][count // 3]
    columns["Velocity [mm/s]"][rng.integers(0, count, 15)] = np.nan
    columns["Time [s]"][count // 2 :] += 3.0
    columns["Time [s]"][2 * count // 3 :] += 0.003 * np.arange(count - 2 * count // 3)


def rectified(columns):
    columns["Fx [N]"] = np.abs(columns["Fx [N]"] - 0.4)


def turned(columns):
    columns["Fx [N]"] *= -1
    columns["Fz [N]"] -= 2.0


def reset(columns):
    """A position alone, which is set to zero in mid-stroke."""
    without("Velocity [mm/s]")(columns)
    columns["Position [mm]"][2400:] -= 3.0


def beyond(columns):
    columns["Fx [N]"][1234] = 1e80
    columns["Fz [N]"][4321] = 1e-80


MADE = {
    "velocity and position": without(),
    "velocity": without("Position [mm]"),
    "position": without("Velocity [mm/s]"),
    "no load": without("Fz [N]", "Position [mm]"),
    "torn": torn,
    "rectified": rectified,
    "turned": turned,
    "reset": reset,
    "beyond": beyond,
}


def written(folder, columns, spoil=None, time=""):
    """A raw file and its dialect as a planned run."""
    rows = np.column_stack(list(columns.values()))
    form = ",".join(["%.9g"] * len(columns))
    lines = [(form % tuple(row)).replace("nan", "") for row in rows.tolist()]
    if spoil:
        spoil(lines)
    (folder / "long.csv").write_text("\n".join([",".join(columns), *lines]) + "\n")
    dialect = 'name = "long"\ntitle = "A log"\n[header]\nline = 1\nunits = "brackets"\n'
    for name in columns:
        quantity, bare = COLUMNS[name], name.split(" [")[0]
        dialect += f'[[column]]\nquantity = "{quantity}"\nname = "{bare}"\n'
    (folder / "long.toml").write_text(dialect + time)
    (folder / "data").mkdir(exist_ok=True)
    file = folder / "long.csv"
    return PlannedRun(
        "long", (file,), (file.name,), "S", "dry", 31.0, None, None, str(folder / "long.toml")
    )


def come_to(run, folder):
    """All that a run comes to, but for moments and durations."""
    (folder / "data").mkdir(exist_ok=True)
    record, trace = stage.process_run(stage.RunTask(run, folder, 300, 40_000))
    plain = dataclasses.replace(record.outcome, seconds=0.0)
    facts = record.facts
    if plain.done:
        facts = dataclasses.replace(facts, history="")
    groups = {}
    if plain.done:
        groups = read_groups(folder / plain.data_file, GROUPS, optional=True)
        for data in groups.values():
            data.attrs = {k: v for k, v in data.attrs.items() if k not in ("history", "created")}
    return groups, (plain, dataclasses.replace(record, outcome=plain, facts=facts), trace)


def same(one, other):
    (groups, said), (other_groups, other_said) = one, other
    assert groups.keys() == other_groups.keys()
    for name, data in groups.items():
        assert data.identical(other_groups[name]), name
        assert all(data[v].dtype == other_groups[name][v].dtype for v in data.variables)
    for part, other_part in zip(said, other_said, strict=True):
        assert repr(part) == repr(other_part)


@pytest.mark.slow
@pytest.mark.parametrize("name", MADE)
def test_a_run_in_scratch_files_and_in_pieces_comes_to_the_same(name, tmp_path, cut_up):
    columns = strokes()
    MADE[name](columns)
    run = written(tmp_path, columns)
    whole = come_to(run, tmp_path)
    assert whole[1][0].done and whole[1][0].segments >= 4, whole[1][0].reason
    cut_up(487)
    same(whole, come_to(run, tmp_path))


def swapped(lines):
    lines[5000], lines[5400] = lines[5400], lines[5000]


SPOILT = {
    "a word": lambda lines: lines.__setitem__(5000, lines[5000].replace(",", ",x", 1)),
    "a cell less": lambda lines: lines.__setitem__(5000, lines[5000].rsplit(",", 1)[0]),
    "a cell more": lambda lines: lines.__setitem__(5000, lines[5000] + ",1"),
    "time falls back": lambda lines: lines.__setitem__(slice(5000, 5000), lines[100:4000]),
    "stray times": swapped,
    "no time": lambda lines: lines.__setitem__(5000, "," + lines[5000].split(",", 1)[1]),
    "endless time": lambda lines: lines.__setitem__(5000, "1e90," + lines[5000].split(",", 1)[1]),
    "cut short": lambda lines: lines.__setitem__(-1, "31"),
}
TIMES = {
    "as it is": "",
    "dropped": '[time]\nsource = "column"\non_repeat = "drop"\n',
    "interpolated": '[time]\nsource = "column"\non_repeat = "interpolate"\n',
    "joined": '[time]\nsource = "column"\nrestart = "continue"\non_repeat = "drop"\n',
}


def understood(run):
    """What is read of a run, or why it cannot be."""
    try:
        data = read_run(run.files, run.instrument)
    except ReadError as error:
        return error.message_for("terminal")
    data.attrs.pop("history")  # says when
    return data


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "time"),
    [(name, time) for name in SPOILT for time in TIMES if time == "as it is" or "time" in name],
)
def test_bad_rows_in_the_middle_are_told_the_same_way(name, time, tmp_path, cut_up):
    run = written(tmp_path, strokes(), SPOILT[name], TIMES[time])
    whole = understood(run)
    cut_up(997)
    again = understood(run)
    assert again == whole if isinstance(whole, str) else again.identical(whole)


def test_the_files_of_one_run_come_to_the_same(tmp_path, cut_up):
    columns = strokes()
    half = columns["Time [s]"].size // 2
    run = written(tmp_path, {name: values[:half] for name, values in columns.items()})
    (tmp_path / "long.csv").rename(tmp_path / "first.csv")
    columns = {name: values[half:] for name, values in columns.items()}
    columns["Time [s]"] -= columns["Time [s]"][0]
    written(tmp_path, columns, time=TIMES["joined"])
    names = ("first.csv", "long.csv")
    run = dataclasses.replace(run, files=tuple(tmp_path / n for n in names), labels=names)
    whole = come_to(run, tmp_path)
    assert whole[1][0].segments >= 4 and "cycle" in whole[0]["run"]
    cut_up(997)
    same(whole, come_to(run, tmp_path))


def test_a_long_data_file_is_read_into_scratch_files(tmp_path, cut_up, monkeypatch):
    monkeypatch.setattr("tribolab.reading.raw.child_results._MAPPED", 5000)
    run = written(tmp_path, strokes())
    come_to(run, tmp_path)
    file = tmp_path / "data/long.nc"
    whole = read_groups(file, ["run"])["run"]
    cut_up(997)
    again = read_groups(file, ["run"])["run"]
    assert again.identical(whole)
    for name in ("friction_force", "friction_force_qc"):
        base = again[name].values
        while isinstance(base, np.ndarray):
            base = base.base
        assert isinstance(base.obj, mmap.mmap), name


@pytest.mark.slow
def test_two_logs_and_a_persons_decisions_come_to_the_same(tmp_path, cut_up):
    file = simulated(tmp_path, repeats=1)
    name = RUNS[0]

    def planned():
        return next(run for run in planned_runs(load_campaign(file)) if run.name == name)

    segments = come_to(planned(), tmp_path)[0]["segments"]
    start, stop = segments["start"].values, segments["stop"].values
    third = (stop - start) / 3
    times = [{"start": a, "stop": b} for a, b in zip(start + third, stop - third, strict=True)]
    decided = entry(name, "reject", **times[0]) + entry(name, "accept")
    decided += entry(name, "bounds", **times[1], new_start=start[1] + 0.4 * third[1])
    (file.parent / REVIEW_FILE).write_text(decided, "utf-8")
    run = planned()
    assert len(run.files) == 2 and len(run.decisions) == 3
    whole = come_to(run, tmp_path)
    assert "friction_as_found" in whole[0]
    cut_up(1000)
    same(whole, come_to(run, tmp_path))


@given(st.integers(0, 2**32 - 1), st.integers(5, 400), st.integers(1, 50))
def test_what_is_summed_up_in_pieces_does_not_show_where_they_were_cut(seed, count, samples):
    rng = np.random.default_rng(seed)
    values = rng.normal(1.0, 1.0, count).cumsum()
    values[rng.integers(0, count, 3)] += 1000.0
    time = rng.uniform(0.5, 1.5, count).cumsum()

    def done():
        return [
            pieces.running_total(values, values[0]),
            running_median(values),
            *block_slopes(time, values, 5),
            np.array(position_noise(time, values)),
            *without_resets(time, values),
            pieces.stretches(lambda a, b: values[a:b] > count / 2, count),
        ]

    whole = done()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pieces, "PIECE", samples)
        assert all(np.array_equal(a, b) for a, b in zip(whole, done(), strict=True))
    total = np.concatenate([[0.0], np.cumsum(values - values[0])])
    assert np.array_equal(whole[0], total)


def resident():
    """Memory of this process [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="only Linux tells")
def test_a_long_array_takes_no_memory_but_for_the_piece_at_hand(cut_up):
    cut_up(1 << 16)
    before, most = resident(), 0
    values = room.filled(1 << 25, 3.0)
    for first, last in pieces.pieces(0, values.size):
        values[first:last] += first
        most = max(most, resident() - before)
    assert most < 0.1 * values.nbytes
    assert all(values[k] == 3 + (k >> 16 << 16) for k in range(0, values.size, 9999))


def test_without_room_for_a_scratch_file_arrays_are_in_memory(cut_up, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    cut_up(100)
    monkeypatch.setattr("os.posix_fallocate", full, raising=False)
    assert room.filled(1000, 2.0).sum() == 2000.0


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="only Linux tells")
def test_a_scratch_file_lies_where_one_says_and_has_no_name(cut_up, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", None)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    cut_up(100)
    values = room.filled(1 << 20, 1.0)
    maps = [
        line for line in Path("/proc/self/maps").read_text().splitlines() if str(tmp_path) in line
    ]
    assert maps and all(line.endswith("(deleted)") for line in maps)
    assert not list(tmp_path.iterdir())
    del values
    assert str(tmp_path) not in Path("/proc/self/maps").read_text()
