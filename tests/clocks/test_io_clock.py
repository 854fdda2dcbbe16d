"""No row is lost quietly: clocks that start anew, wrap, jitter or stand still."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError
from tribolab.qc.run.checks import check_run
from tribolab.reading.clocks.faults import find_faults, rows_at_fault
from tribolab.reading.unknown.proposal.draft import draft_dialect
from tribolab.reading.unknown.proposal.questions import questions

HEAD = "Time [s],Friction force [N],Normal force [N],Position [mm]"
TOML = """
name = "mine"
title = "Mine"
[header]
line = 1
[speed]
source = "position"
[time]
{}
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "friction_force"
name = "Friction force"
[[column]]
quantity = "normal_force"
name = "Normal force"
[[column]]
quantity = "position"
name = "Position"
{}"""
STROKES, ROWS, STEP = 6, 1200, 0.01


def record(seed=3):
    """True time and signals (rows, 3) of strokes to and fro."""
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(STROKES * ROWS)
    stroke = np.arange(time.size) // ROWS
    sign = 1 - 2 * (stroke % 2)
    position = np.cumsum(sign) * STEP * 2.0
    noise = rng.normal(0, 0.05, (time.size, 2))
    return time, np.column_stack([9 * sign + noise[:, 0], 30 + noise[:, 1], position]), stroke


def write(folder, clock, signals, dialect="", more="", name="run.csv", between=None, head=HEAD):
    lines = [head] if head else []
    for number, (t, row) in enumerate(zip(clock, signals, strict=True)):
        if between and number % ROWS == 0:
            lines += between(number // ROWS)
        stamp = "" if np.isnan(t) else f"{t:.6f}"
        lines.append(",".join([stamp, *(f"{value:.6g}" for value in row)]))
    (folder / name).write_text("\n".join(lines) + "\n")
    (folder / "mine.toml").write_text(TOML.format(dialect, more))
    return folder / name, folder / "mine.toml"


def status(run):
    return next(row for row in check_run(run).rows if row["check"] == "rows_left_out")


def drafted(file):
    toml = file.with_suffix(".toml")
    toml.write_text(draft_dialect(file).toml)
    return tl.read(file, toml)


def test_a_clock_that_starts_anew_inside_a_table_goes_on(tmp_path):
    time, signals, stroke = record()
    file, mine = write(tmp_path, time - stroke * ROWS * STEP, signals, 'restart = "continue"')
    run = tl.read(file, mine)
    np.testing.assert_allclose(run["time"], time, atol=1e-9)
    np.testing.assert_array_equal(run["step"], stroke + 1)
    assert status(run)["status"] == "pass" and run.attrs["rows_in_file"] == time.size
    assert tl.find_segments(run).sizes["segment"] == STROKES
    with pytest.raises(ReadError, match="row 1201: .*goes on from there.*restart = 'continue'"):
        tl.read(file, write(tmp_path, time[:1], signals[:1], name="other.csv")[1])


def test_a_column_of_steps_stays_as_it_is(tmp_path):
    time, signals, stroke = record()
    signals = np.column_stack([signals, 10 * (stroke // 2) + 7])
    more = '[[column]]\nquantity = "step"\nname = "Step"\n'
    clock = time - stroke * ROWS * STEP
    file, mine = write(tmp_path, clock, signals, 'restart = "continue"', more, head=HEAD + ",Step")
    run = tl.read(file, mine)
    np.testing.assert_allclose(run["time"], time, atol=1e-9)
    assert np.unique(run["step"]).tolist() == [7, 17, 27]


@pytest.mark.parametrize("period", [65.536, 32.768, 16.384])
@pytest.mark.parametrize("start", [0.0, 11.3])
def test_a_counter_that_wraps_is_unwrapped_by_what_it_holds(tmp_path, period, start):
    time, signals, _ = record()
    jitter = np.random.default_rng(1).uniform(-0.3, 0.3, time.size) * STEP
    true = time + start + jitter + STEP
    file, mine = write(tmp_path, true % period, signals, 'restart = "continue"')
    run = tl.read(file, mine)
    np.testing.assert_allclose(run["time"], true - true[0], atol=2e-6)
    assert "wraps" in run.attrs["clock_joined"] and "step" not in run


def test_a_gap_at_a_wrap_is_a_gap_where_the_period_is_known(tmp_path):
    time, signals, _ = record()
    kept = ~((time > 60) & (time < 70))
    file, mine = write(tmp_path, time[kept] % 65.536, signals[kept], 'wrap = "65.536 s"')
    np.testing.assert_allclose(tl.read(file, mine)["time"], time[kept], atol=2e-6)


@pytest.mark.parametrize("seed", range(8))
def test_jitter_is_no_new_start(seed):
    rng = np.random.default_rng(seed)
    clock = 0.01 * np.arange(3000) + rng.normal(0, 0.01 * 10 ** rng.uniform(-1, 1.5), 3000)
    assert find_faults(clock).starts == ()


@pytest.mark.parametrize("seed", range(8))
def test_every_new_start_is_found_at_its_row(seed):
    rng = np.random.default_rng(seed + 100)
    lengths = rng.integers(5, 900, 7)
    parts = [s + 0.02 * np.arange(n) for n, s in zip(lengths, rng.uniform(0, 0.02, 7), strict=True)]
    clock = np.concatenate(parts) + rng.normal(0, 0.002, lengths.sum())
    faults = find_faults(clock)
    assert [start.row for start in faults.starts] == np.cumsum(lengths)[:-1].tolist()
    joined = clock + faults.offsets()
    assert np.abs(np.diff(joined) - 0.02).max() < 0.02


@pytest.mark.parametrize("seed", range(8))
def test_groups_of_stamps_astray_are_no_new_starts(seed):
    rng = np.random.default_rng(seed + 200)
    count = int(rng.integers(300, 3000))
    clock = 0.2 * np.arange(count) + rng.normal(0, 0.02, count)
    right = clock.copy()
    many = int(rng.integers(1, 6))
    for first in rng.choice(np.arange(20, count - 20, 12), 5, replace=False):
        clock[first : first + many] = rng.choice([0.0, -1.0, 1e6, 4294967.295, clock[first] - 9])
    faults = find_faults(clock)
    assert faults.starts == ()
    kept = ~rows_at_fault(clock, faults)
    np.testing.assert_array_equal(clock[kept], right[kept])
    assert count - kept.sum() <= 5 * many + 5


def test_stamps_astray_are_told_from_new_starts():
    clock = 0.1 * np.arange(500)
    clock[100:103], clock[300], clock[400] = [0.0, 0.1, 0.2], 999.0, np.nan
    faults = find_faults(clock)
    assert faults.starts == ()
    assert np.flatnonzero(rows_at_fault(clock, faults)).tolist() == [100, 101, 102, 300, 400]


def test_rows_with_a_bad_stamp_are_kept_where_the_dialect_says_so(tmp_path):
    time, signals, _ = record()
    clock = time.copy()
    clock[[50, 700, 701]], clock[900] = [0.0, 500.0, 501.0], np.nan
    file, mine = write(tmp_path, clock, signals, 'on_repeat = "interpolate"')
    run = tl.read(file, mine)
    np.testing.assert_allclose(run["time"], time, atol=1e-9)
    assert run.attrs["rows_time_interpolated"] == 4 and "rows_left_out" not in run.attrs


def test_coarse_stamps_are_spread_over_their_interval(tmp_path):
    time, signals, _ = record()
    file, mine = write(
        tmp_path, time[np.arange(time.size) // 10 * 10], signals, 'on_repeat = "interpolate"'
    )
    np.testing.assert_allclose(tl.read(file, mine)["time"], time, atol=1e-6)


@pytest.mark.parametrize(("lost", "expected"), [(0.005, "pass"), (0.03, "suspect"), (0.2, "fail")])
def test_rows_left_out_are_counted_and_judged(tmp_path, lost, expected):
    time, signals, _ = record()
    count = round(lost * time.size)
    clock, doubled = np.append(time, np.zeros(count)), np.vstack([signals, signals[:count]])
    order = np.argsort(np.append(time, time[:count]), kind="stable")
    clock = np.where(np.append(np.zeros(time.size), np.ones(count)), time[0], clock)
    clock[time.size :] = time[:count]
    file, mine = write(tmp_path, clock[order], doubled[order], 'on_repeat = "drop"')
    run = tl.read(file, mine)
    found = status(run)
    assert (found["status"], found["count"]) == (expected, count)
    assert found["value"] == pytest.approx(count / (count + time.size))
    told = [line for line in file_lines(file, mine) if "left out" in line]
    assert told[0].startswith(f"  left out: {count} of {count + time.size} rows")


def test_what_drop_takes_of_a_clock_that_starts_anew_fails(tmp_path):
    time, signals, stroke = record()
    file, mine = write(tmp_path, time - stroke * ROWS * STEP, signals, 'on_repeat = "drop"')
    found = status(tl.read(file, mine))
    assert found["status"] == "fail" and found["count"] == (STROKES - 1) * ROWS
    assert "restart = 'continue' would keep them" in found["message"]


def test_rows_below_the_end_of_a_table_are_missed(tmp_path):
    time, signals, _ = record()
    gap = {3: ["End of part 1"]}
    file, mine = write(tmp_path, time, signals, between=lambda k: gap.get(k, []))
    mine.write_text(mine.read_text() + '[text]\nend = "^End"\n')
    run = tl.read(file, mine)
    assert run.sizes["time"] == 3 * ROWS
    assert status(run)["status"] == "fail" and status(run)["count"] == 3 * ROWS
    mine.write_text(mine.read_text().replace("end =", "skip_lines ="))
    assert tl.read(file, mine).sizes["time"] == time.size


MARKS = {
    "restart": None,
    "blank lines": lambda k: [""] if k else [],
    "headers": lambda k: [f"Step {k + 1}", HEAD],
    "bare headers": lambda k: [HEAD],
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", MARKS)
def test_a_draft_reads_every_row_of_every_part(tmp_path, kind):
    time, signals, stroke = record()
    head = None if "headers" in kind else HEAD
    file, _ = write(tmp_path, time - stroke * ROWS * STEP, signals, between=MARKS[kind], head=head)
    run = drafted(file)
    np.testing.assert_allclose(run["time"], time, atol=1e-9)
    np.testing.assert_allclose(run["friction_force"], signals[:, 0], rtol=1e-5)
    assert status(run)["status"] == "pass" and np.unique(run["step"]).size == STROKES


@pytest.mark.parametrize("line", ["Step 2", "# stroke 2 begins"])
def test_rows_below_a_line_of_text_are_asked_about(tmp_path, line):
    time, signals, stroke = record()
    marks = {1: [line]}
    clock = time - stroke * ROWS * STEP
    file, _ = write(tmp_path, clock, signals, between=lambda k: marks.get(k, []), head=HEAD)
    (asked,) = questions(draft_dialect(file))
    assert (
        asked.guess == f"the table ends at '{line}': {len(time) - ROWS} rows below it are not read"
    )


@pytest.mark.parametrize("kind", ["wrap", "coarse", "jitter", "astray"])
def test_a_draft_drops_no_row_that_another_reading_keeps(tmp_path, kind):
    time, signals, _ = record()
    clock = time.copy()
    if kind == "wrap":
        clock %= 65.536
    elif kind == "coarse":
        clock = time[np.arange(time.size) // 10 * 10]
    elif kind == "jitter":
        clock += np.random.default_rng(0).normal(0, STEP, time.size)
    else:
        clock[77::200] = 0.0
    run = drafted(write(tmp_path, clock, signals)[0])
    assert run.sizes["time"] == time.size and "rows_left_out" not in run.attrs
    assert np.abs(run["time"].values - (time - time[0])).max() < (0.2 if kind == "jitter" else 1e-3)


def test_columns_that_change_places_from_step_to_step_are_followed(tmp_path):
    time, signals, stroke = record()
    names = HEAD.split(",")
    lines = []
    for k in range(STROKES):
        order = [0, 1, 2, 3] if k < 3 else [0, 3, 1, 2]
        lines.append(",".join(names[i] for i in order))
        table = np.column_stack([time, signals])[stroke == k][:, order]
        lines += [",".join(f"{value:.6g}" for value in row) for row in table]
    (tmp_path / "run.csv").write_text("\n".join(lines) + "\n")
    run = drafted(tmp_path / "run.csv")
    np.testing.assert_allclose(run["friction_force"], signals[:, 0], rtol=1e-5)
    np.testing.assert_allclose(run["position"], signals[:, 2] / 1000, rtol=1e-5)


def test_unnamed_columns_with_a_clock_that_starts_anew_are_drafted_whole(tmp_path):
    time, signals, stroke = record()
    file, _ = write(tmp_path, time - stroke * ROWS * STEP, signals, head="")
    run = drafted(file)
    np.testing.assert_allclose(run["time"], time, atol=1e-9)


def test_a_counter_of_rows_that_wraps_is_a_clock_where_its_interval_is_stated(tmp_path):
    """Rows that the logger lost around the wrap are a gap and not a shorter run."""
    rows = np.arange(5000)
    kept = ~np.isin(rows, [1022, 1023, 1024, 3071, 3072])
    lines = (f"{row % 1024},{np.sin(row / 50):.4f},10" for row in rows[kept])
    (tmp_path / "a.csv").write_text("Index,Fx [N],Fz [N]\n" + "\n".join(lines) + "\n")
    (tmp_path / "mine.toml").write_text(
        'name = "mine"\ntitle = "counter"\n[header]\nline = 1\n'
        '[time]\nrestart = "continue"\nwrap = "2.048 s"\n[speed]\nsource = "none"\n'
        '[[column]]\nquantity = "time"\nname = "Index"\nunit = "s"\nscale = 0.002\n'
        '[[column]]\nquantity = "friction_force"\nname = "Fx"\n'
        '[[column]]\nquantity = "normal_force"\nname = "Fz"\n'
    )
    run = tl.read(tmp_path / "a.csv", tmp_path / "mine.toml")
    np.testing.assert_allclose(run.time, 0.002 * rows[kept], atol=1e-9)
