"""Where time comes from: intervals, dates in a column, clocks that count from a date, counters."""

import datetime as dt

import numpy as np
import pytest
from pydantic import ValidationError

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.dialect.time_rule import Time

N = 300
STEP = 0.125  # s: a power of two, so that sums are exact
T = STEP * np.arange(N)


def dialect(folder, time, column='name = "Time"', delimiter=";"):
    toml = folder / "rig.toml"
    toml.write_text(
        f'name = "rig"\ntitle = "a rig"\n[text]\ndelimiter = "{delimiter}"\n[header]\nline = 1\n'
        f'[time]\n{time}\n[speed]\nsource = "none"\n[[column]]\nquantity = "time"\n{column}\n'
        '[[column]]\nquantity = "friction_force"\nname = "Fx"\n'
    )
    return toml


def table(folder, times, header="Time"):
    file = folder / "log.txt"
    rows = "\n".join(f"{time};{n}" for n, time in enumerate(times))
    file.write_text(f"{header};Fx [N]\n{rows}\n")
    return file


def test_intervals_are_summed(tmp_path):
    file = table(tmp_path, [1e3 * (STEP if n % 2 else 2 * STEP) for n in range(N)], "Time [ms]")
    run = tl.read(file, dialect(tmp_path, 'source = "period"'))
    intervals = np.where(np.arange(1, N) % 2, STEP, 2 * STEP)
    np.testing.assert_allclose(run.time, np.concatenate([[0], np.cumsum(intervals)]), rtol=1e-12)
    assert run.attrs["time_origin_s"] == 2 * STEP


@pytest.mark.parametrize("bad", ["-1", "nan"])
def test_an_interval_that_is_none_is_refused_with_its_row(bad, tmp_path):
    times = ["1"] * N
    times[41] = bad
    with pytest.raises(ReadError, match="the interval of row 42 is"):
        tl.read(table(tmp_path, times, "Time [s]"), dialect(tmp_path, 'source = "period"'))


@pytest.mark.parametrize(
    ("epoch", "unit", "number", "moment"),
    [
        ("excel", "d", 45000.25, "2023-03-15T06:00:00"),
        ("labview", "s", 3.8e9, "2024-05-31T11:33:20+00:00"),
        ("unix", "ms", 1.7e12, "2023-11-14T22:13:20+00:00"),
    ],
)
def test_a_clock_that_counts_from_a_date_says_when_the_run_was(
    epoch, unit, number, moment, tmp_path
):
    scale = {"d": 86400, "s": 1, "ms": 1e-3}[unit]
    file = table(tmp_path, [f"{number + t / scale:.12f}" for t in T])
    toml = dialect(tmp_path, f'epoch = "{epoch}"', f'name = "Time"\nunit = "{unit}"')
    run = tl.read(file, toml)
    np.testing.assert_allclose(run.time, T, atol=2e-6)  # what eight bytes hold of such dates
    assert run.attrs["recorded_at"] == moment


def stamps(form, start, zone=""):
    moments = [start + dt.timedelta(seconds=t) for t in T]
    return [moment.strftime(form)[: None if "%f" not in form else -3] + zone for moment in moments]


@pytest.mark.parametrize(
    ("form", "written", "zone", "moment"),
    [
        ("iso", "%Y-%m-%dT%H:%M:%S.%f", "", "2024-02-29T23:59:50"),
        ("iso", "%Y-%m-%d %H:%M:%S.%f", "", "2024-02-29T23:59:50"),
        ("iso with zone", "%Y-%m-%dT%H:%M:%S.%f", "+01:00", "2024-02-29T22:59:50+00:00"),
        ("iso with zone", "%Y-%m-%dT%H:%M:%S.%f", "Z", "2024-02-29T23:59:50+00:00"),
        ("%d.%m.%Y %H:%M:%S,%f", "%d.%m.%Y %H:%M:%S,%f", "", "2024-02-29T23:59:50"),
    ],
)
def test_dates_and_times_in_a_column_are_read(form, written, zone, moment, tmp_path):
    file = table(tmp_path, stamps(written, dt.datetime(2024, 2, 29, 23, 59, 50), zone))
    run = tl.read(file, dialect(tmp_path, f'format = "{form}"'))
    np.testing.assert_allclose(run.time, T, atol=1e-6)
    assert run.attrs["recorded_at"] == moment
    assert run.sizes["time"] == N


def test_a_clock_goes_on_where_daylight_saving_ends(tmp_path):
    file = tmp_path / "log.txt"
    file.write_text("Time;Fx [N]\n2024-10-27T02:59:59+02:00;1\n2024-10-27T02:00:00+01:00;2\n")
    run = tl.read(file, dialect(tmp_path, 'format = "iso with zone"'))
    assert run.time.values.tolist() == [0, 1]


def test_times_of_day_go_on_over_midnight(tmp_path):
    file = table(tmp_path, stamps("%H:%M:%S.%f", dt.datetime(2024, 2, 29, 23, 59, 50)))
    run = tl.read(file, dialect(tmp_path, 'format = "%H:%M:%S.%f"\nwrap = "24 h"'))
    np.testing.assert_allclose(run.time, T, atol=1e-6)
    assert "recorded_at" not in run.attrs


def test_a_row_counter_that_wraps_goes_on(tmp_path):
    counts = (200 + np.arange(N)) % 256
    toml = dialect(tmp_path, 'wrap = "32 s"', f'name = "Time"\nunit = "s"\nscale = {STEP}')
    run = tl.read(table(tmp_path, counts), toml)
    np.testing.assert_allclose(run.time, T)
    assert "wraps" in run.attrs["clock_joined"]


def test_what_is_no_date_is_told_with_the_form(tmp_path):
    times = stamps("%Y-%m-%d %H:%M:%S.%f", dt.datetime(2024, 2, 29))
    times[7] = "yesterday"
    with pytest.raises(ReadError, match="'yesterday' is no date and time of the form 'iso'"):
        tl.read(table(tmp_path, times), dialect(tmp_path, 'format = "iso"'))
    zoned = table(tmp_path, [f"{time}+01:00" for time in stamps("%Y-%m-%dT%H:%M:%S", T_START)])
    with pytest.raises(ReadError, match="no date and time of the form 'iso'"):
        tl.read(zoned, dialect(tmp_path, 'format = "iso"'))


T_START = dt.datetime(2024, 1, 1)


@pytest.mark.parametrize(
    "said",
    [
        {"source": "none", "format": "iso"},
        {"format": "iso", "epoch": "unix"},
        {"format": "dd.mm.yyyy"},
        {"epoch": "mac"},
    ],
)
def test_what_cannot_be_is_refused(said):
    with pytest.raises(ValidationError):
        Time.model_validate(said)


@pytest.mark.parametrize(
    ("written", "zone", "recorded"),
    [
        ("%Y-%m-%dT%H:%M:%S.%f", "+01:00", "2024-02-29T22:59:50+00:00"),
        ("%d.%m.%Y %H:%M:%S,%f", "", "2024-02-29T23:59:50"),
        ("%d/%m/%Y %H:%M:%S.%f", "", "2024-02-29T23:59:50"),
        ("%H:%M:%S.%f", "", None),
    ],
)
def test_a_column_of_dates_is_found_and_read_without_a_dialect(written, zone, recorded, tmp_path):
    times = stamps(written, dt.datetime(2024, 2, 29, 23, 59, 50), zone)
    run = tl.read(table(tmp_path, times, "Zeitstempel"))
    assert run.attrs["instrument"] == "drafted from the file"
    np.testing.assert_allclose(run.time, T, atol=1e-6)
    assert run.attrs.get("recorded_at") == recorded


def test_whether_day_or_month_comes_first_is_asked_where_the_dates_do_not_tell(tmp_path):
    file = table(tmp_path, stamps("%d/%m/%Y %H:%M:%S.%f", dt.datetime(2024, 3, 4, 10)))
    with pytest.raises(ReadError, match=r"dates are written %d/%m/%Y .*or %m/%d/%Y"):
        tl.read(file)
