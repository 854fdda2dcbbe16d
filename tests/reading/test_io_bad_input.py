"""Whatever a file holds: a run, or a ReadError that says what, where and how to mend."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import tribolab as tl
from tribolab.core.errors import ReadError, TribolabError, UnitError

HEAD = "# Linear slider, force log\n# date: 2026-03-02T09:12:31\n"


def force_log(folder, rows, header="Time [s],Fx [N],Fz [N]", name="sb-r_dry_31N_01_force.csv"):
    file = folder / name
    file.write_bytes((HEAD + "\n".join([header, *rows]) + "\n").encode())
    return file


def rows(count=5, **changed):
    lines = [f"{n / 10},{1.0 + n},31.0" for n in range(count)]
    for row, text in changed.items():
        lines[int(row[1:])] = text
    return lines


@pytest.mark.parametrize(
    ("header", "lines", "told"),
    [
        ("Time [s],Fy [N],Fz [N]", rows(), "column 'Fx' .* is missing.*known are Fy, Fz"),
        ("Time [s],Fx,Fz [N]", rows(), r"'Fx' has no unit; say it in the dialect 'linear_slider'"),
        ("Time [s],Fx [mm],Fz [N]", rows(), "'Fx'.*'mm' cannot be turned into 'N'"),
        ("Time [s],Fx [bla],Fz [N]", rows(), "'Fx'.*'bla' is not a unit"),
        ("Time [s],Fx [N],Fz [N]", [], "no row of numbers below"),
        ("Time [s],Fx [N],Fz [N]", ["", "  ", ""], "no row of numbers below"),
        (
            "Time [s],Fx [N],Fz [N]",
            rows(r2="0.05,1,31"),
            "backwards at row 3: from 0.1 s to 0.05 s",
        ),
        ("Time [s],Fx [N],Fz [N]", rows(r2="0.1,1,31"), "stands still at row 3.*on_repeat"),
        ("Time [s],Fx [N],Fz [N]", rows(r2=",1,31"), "time is missing in row 3"),
        ("Time [s],Fx [N],Fz [N]", rows(r2="0.2,Err110,31"), "line 6.*'Fx.*'Err110'.*missing ="),
        ("Time [s],Fx [N],Fz [N]", rows(r2="0.2,1"), "line 6 has 2 cells where 3.*end ="),
        ("Time [s],Fx [N],Fz [N]", rows(r2="0.2,1,31,4"), "line 6 has 4 cells where 3"),
        ("Time [s],Fx [N],Fz [N]", ["0,nan,31", "1,,31"], "'Fx.*has no value in any row"),
        ("Time [s],Fx [N],Fz [N]", ["0,1,-31", "1,1,0"], "nowhere above zero.*sign = -1"),
        ("Time [s],Fx [N],Fz [N]", ["0,1", "1,1"], "first row of numbers has 2.*'Fz'"),
        ("t [s],Fx [N],Fz [N]", rows(), "no line matches"),
    ],
)
def test_a_bad_table_is_refused_with_place_and_cure(tmp_path, header, lines, told):
    file = force_log(tmp_path, lines, header)
    with pytest.raises(ReadError, match=told) as error:
        tl.read(file)
    assert "sb-r_dry_31N_01_force.csv" in str(error.value)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "is empty"),
        (b"\xef\xbb\xbf\r\n \n", "is empty"),
        (bytes(range(256)) * 20, "neither text nor"),
        (b"PK\x03\x04" + b"x" * 50, "zip or Office"),
        (b"\x1f\x8b" + b"x" * 50, "compressed"),
        (b"MATLAB 5.0 MAT-file" + b"\x00" * 200, "damaged"),
        (b"TDSm\x0e\x00" + b"\xff" * 10, "no known instrument writes"),
        (b"\x89HDF\r\n\x1a\n" + b"\x00" * 100, "this HDF5 or netCDF file cannot be read"),
        (b"CDF\x01" + b"\xff" * 5, "netCDF"),
        (b"lorem ipsum " * 1000, "no table of numbers"),
    ],
)
def test_content_that_is_no_table_is_refused(tmp_path, content, told):
    file = tmp_path / "file"
    file.write_bytes(content)
    with pytest.raises(ReadError, match=told):
        tl.read(file)


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(ReadError, match="matches nothing in"):  # an empty folder
        tl.read(tmp_path)
    with pytest.raises(ReadError, match="not a file"):
        tl.read([tmp_path])
    with pytest.raises(ReadError, match="no such file"):
        tl.read(tmp_path / "gone.csv")
    with pytest.raises(ReadError, match="no file is given"):
        tl.read([])


def test_a_file_that_vanishes_between_looking_and_reading_is_a_read_error(tmp_path, monkeypatch):
    from tribolab.reading.dialect.delimited import read_text as text

    file = force_log(tmp_path, rows())
    original = text._opened

    def vanish(raw):
        file.unlink()
        return original(raw)

    monkeypatch.setattr(text, "_opened", vanish)
    with pytest.raises(ReadError, match="cannot be read any more"):
        tl.read(file)


def test_a_last_row_cut_short_by_a_stopped_logger_is_left_out_and_counted(tmp_path):
    file = force_log(tmp_path, [*rows(), "0.5,1"])
    run = tl.read(file)
    assert run.sizes["time"] == 5 and run.attrs["rows_left_out"] == 1


def test_a_huge_line_is_refused_quickly(tmp_path):
    file = force_log(tmp_path, rows(r2="0.2," + "9" * 5_000_000))
    with pytest.raises(ReadError, match="line 6 has 2 cells"):
        tl.read(file)
    (tmp_path / "one").write_bytes(b"1.5 " * 2_000_000)
    with pytest.raises(ReadError, match="columns are more than a measurement or a map has"):
        tl.read(tmp_path / "one")


def test_a_normal_force_that_is_zero_for_a_while_is_left_to_later_stages(tmp_path):
    run = tl.read(force_log(tmp_path, rows(r2="0.2,1,-0.1")))
    assert float(run["normal_force"].min()) == -0.1


def test_repeated_times_can_be_dropped_by_the_dialect(tmp_path):
    from tribolab.reading.schema_folder import schema_folder

    text = (schema_folder() / "instruments/linear_slider.toml").read_text()
    (tmp_path / "mine.toml").write_text(text + '\n[time]\non_repeat = "drop"\n')
    file = force_log(tmp_path, rows(8, r2="0.1,9,31", r4="0.0,9,31", r5=",9,31"))
    run = tl.read(file, tmp_path / "mine.toml")
    assert run["friction_force"].values.tolist() == [1, 2, 4, 7, 8]
    assert run.attrs["rows_left_out"] == 3


def test_files_of_different_instruments_are_not_one_run(tmp_path, shared_data):
    with pytest.raises(ReadError, match="different instruments: cetr_umt2, linear_slider"):
        tl.read([force_log(tmp_path, rows()), *(shared_data / "cetr_umt2_MIT").glob("*.csv")])


def test_a_clock_shift_without_a_unit_is_refused(tmp_path):
    with pytest.raises(UnitError, match="clock_shift: '0.3' has no unit"):
        tl.read(force_log(tmp_path, rows()), clock_shift="0.3")


@settings(deadline=None, max_examples=150)
@given(st.binary(max_size=300), st.booleans())
@example(b"0,1,1\n\x00", True)
@example(b"0,1,1\r0.1,1,1\r", True)
@example(b'0,"1,1\n', True)
def test_no_content_ends_in_anything_but_a_run_or_our_error(tmp_path_factory, content, with_head):
    file = tmp_path_factory.mktemp("any") / "file_force.csv"
    head = (HEAD + "Time [s],Fx [N],Fz [N]\n").encode() if with_head else b""
    file.write_bytes(head + content)
    try:
        run = tl.read(file)
    except TribolabError as error:
        assert len(str(error)) < 1500
    else:
        assert (np.diff(run["time"]) > 0).all()


@pytest.mark.parametrize("seed", range(25))
def test_a_damaged_real_file_ends_in_a_run_or_our_error(shared_data, tmp_path, seed):
    rng = np.random.default_rng(seed)
    real = [
        "cetr_umt2_MIT/HT-2n-6-4 2_001.csv",
        "pcs_mtm_ehd_MIT/demo_12.txt",
        "tdms_force_MIT/TDMSSample.tdms",
        "stickslip_paper_CeCILL-B/k168Nm_v4300.mat",
        "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt",
    ]
    content = bytearray((shared_data / real[seed % 5]).read_bytes())
    if seed % 2:
        content = content[: rng.integers(1, len(content))]
    for place in rng.integers(0, len(content), 20):
        content[place] = rng.integers(0, 256)
    file = tmp_path / "damaged"
    file.write_bytes(content)
    try:
        assert tl.read(file).sizes["time"] > 0
    except TribolabError as error:
        assert str(file) in str(error)


def test_what_is_not_there_is_told_as_far_as_it_is_not_there(tmp_path):
    for name, said in {
        "a.csv": "a.csv: there is no such file",
        "*.csv": f"the pattern matches nothing in {tmp_path}",
        "*/a.csv": "the pattern matches nothing",
        "rock/*.csv": f"there is no folder {tmp_path / 'rock'}",
    }.items():
        with pytest.raises(ReadError) as caught:
            tl.read(tmp_path / name)
        assert str(caught.value).endswith(said)
