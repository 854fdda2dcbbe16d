"""Damaged files: a dataset or one TribolabError that names the file; and what once went wrong.

The same mutators, on more files and with limits on time and memory, run for thousands of files in
``tests/robustness/fuzz.py``.
"""

import io
import struct
import zipfile
import zlib

import h5py
import numpy as np
import pytest
import scipy.io
import xarray as xr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mutations import mat_inside, mutate

import tribolab as tl
from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.dialect.delimited.tables import find_tables
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.netcdf import seal
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
from tribolab.reading.raw.containers.mat import read_variables
from tribolab.reading.raw.opening import report_damage
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown.proposal.draft import draft_dialect
from tribolab.reading.unknown.proposal.questions import GuessedError
from tribolab.rubber.modulus import read_modulus

COLUMNS = [
    {"quantity": "time", "position": 1, "unit": "s"},
    {"quantity": "friction_force", "position": 2, "unit": "N"},
]
HEAD = "# Surftest profile\nx [mm],z [um]\n"
REAL = {
    "bearing_profiles_MIT/NU206-RE-1.txt": read_scans,
    "cetr_umt2_MIT/HT-2n-6-4 2_001.csv": tl.read,
    "mitutoyo_sj410_res_MIT/12A11003.TXT": read_tester_results,
    "nanovea_map_MIT/test1.txt": lambda path: read_scans(path, "nanovea_map"),
    "pcs_mtm_ehd_MIT/demo_2.txt": tl.read,
    "pcs_mtm_ehd_MIT/demo_3.txt": tl.read,
    "stickslip_paper_CeCILL-B/k168Nm_v4300.mat": tl.read,
    "surfacetopography_MIT/gwyddion-export-german.txt": read_scans,
    "surfacetopography_MIT/sdf-1.sdf": read_scans,
    "tdms_force_MIT/TDMSSample.tdms": tl.read,
}


@pytest.mark.slow
@settings(deadline=None, max_examples=40, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(sorted(REAL)), st.integers(0, 2**32 - 1))
def test_a_damaged_file_is_a_dataset_or_our_error(shared_data, tmp_path_factory, name, seed):
    content, _ = mutate((shared_data / name).read_bytes(), np.random.default_rng(seed))
    path = tmp_path_factory.mktemp("damaged") / name.split("/")[1]
    path.write_bytes(content)
    try:
        data = REAL[name](path)
    except TribolabError as error:
        assert path.name in str(error)
        assert len(str(error)) < 1500
        assert "\n" not in str(error) or isinstance(error, GuessedError)  # a table of guesses
    else:
        assert isinstance(data, xr.Dataset) and len(data) > 0
        if "time" in data.dims:
            assert (np.diff(data.time) > 0).all()


# ---- text whose lines do not end


def test_a_line_longer_than_any_row_is_refused_where_it_begins(tmp_path):
    path = tmp_path / "long.csv"
    head = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n"
    path.write_text(f"{head}{'0,1,2' + chr(10)}{'0.1,' * (5 << 20)}")
    with pytest.raises(ReadError, match=r"long.csv: line 4 is longer than 4 MB"):
        tl.read(path)


def test_a_line_without_end_below_a_header_that_repeats_is_refused_too(tmp_path):
    path = tmp_path / "steps.txt"
    path.write_text("Step 1\n" + "1," * (3 << 20))
    settings = {"name": "d", "title": "d", "column": COLUMNS}
    settings["header"] = {"pattern": "^Step", "repeats": True}
    with pytest.raises(ReadError, match=r"steps.txt: line 2 is longer than 4 MB"):
        find_tables(path, Dialect.model_validate(settings))


@pytest.mark.parametrize("end", ["\r", "\r\n", "\r\r\n"])
def test_a_table_is_the_same_with_any_line_end(tmp_path, end):
    lines = [
        "# Linear slider, force log",
        "Time [s],Fx [N],Fz [N]",
        *(f"{n},1,2" for n in range(9)),
    ]
    found = []
    for ends in ("\n", end):
        path = tmp_path / "a.csv"
        path.write_bytes(ends.join(lines).encode() + ends.encode())
        found.append(tl.read(path).drop_attrs())
    xr.testing.assert_identical(*found)


@pytest.mark.parametrize("mark", [b"", b"\xff\xfe"])
def test_a_file_of_empty_lines_is_empty_in_any_encoding(tmp_path, mark):
    path = tmp_path / "a.csv"
    path.write_bytes(mark + (b"\n\0" if mark else b"\n") * 5_000_000)
    with pytest.raises(ReadError, match=r"a.csv: the file is empty"):
        tl.read(path)


# ---- MAT


@pytest.mark.parametrize("packed", [True, False])
@pytest.mark.parametrize("kind", ["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"])
def test_every_class_of_numbers_comes_back(tmp_path, kind, packed):
    wanted = np.arange(24, dtype=kind).reshape(2, 3, 4)
    content = {"some_numbers": wanted, "a": wanted[0, 0, :1], "none": np.zeros((0, 2))}
    scipy.io.savemat(tmp_path / "a.mat", content, do_compression=packed)
    found = {v.name: v.numbers for v in read_variables(tmp_path / "a.mat")}
    np.testing.assert_array_equal(found["some_numbers"], wanted, strict=True)
    assert found["a"].tolist() == [[0]]
    assert found["none"].shape == (0, 2)


def test_what_is_no_array_of_numbers_is_none(tmp_path):
    content = {"text": "abc", "struct": {"a": "abc"}, "complex": np.array([1j]), "cell": [1, "b"]}
    content["cell"] = np.array([1, "b"], dtype=object)
    scipy.io.savemat(tmp_path / "a.mat", content)
    names = ["text", "struct.a", "complex", "cell"]  # a structure is its fields
    assert {v.name: v.numbers for v in read_variables(tmp_path / "a.mat")} == dict.fromkeys(names)


@pytest.mark.parametrize("seed", range(40))
def test_a_mat_file_damaged_beneath_its_compression_does_not_crash(shared_data, tmp_path, seed):
    # such files end SciPy's reader, and the process that it runs in, with a segmentation fault
    real = (shared_data / "stickslip_paper_CeCILL-B" / "k168Nm_v4300.mat").read_bytes()
    path = tmp_path / "k168Nm_v4300.mat"
    path.write_bytes(mat_inside(real, np.random.default_rng(seed)))
    for reader in (tl.read, read_scans):
        try:
            reader(path)
        except ReadError as error:
            assert "k168Nm_v4300.mat" in str(error)


def test_sizes_that_a_mat_file_claims_are_held_against_what_is_there(tmp_path):
    def element(kind, data):
        return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    inner = element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", 1 << 30, 1 << 30))
    inner += element(1, b"Fnorm") + element(9, struct.pack("<d", 1.0))
    packed = zlib.compress(element(14, inner))
    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
    (tmp_path / "a.mat").write_bytes(head + struct.pack("<II", 15, len(packed)) + packed)
    with pytest.raises(ReadError, match=r"a\.mat: this MAT file cannot be read.*array of size 1"):
        read_variables(tmp_path / "a.mat")


# ---- netCDF


@pytest.fixture
def run_file(tmp_path):
    time = np.arange(3000) / 100
    run = xr.Dataset({"friction_force": ("time", np.sin(time))}, {"time": time})
    return write_netcdf(run, tmp_path / "run.nc", group="run")


def test_what_is_written_is_sealed_also_when_groups_are_added(run_file):
    assert seal.carries_seal(run_file)
    write_netcdf(xr.Dataset({"a": ("n", [1.0])}), run_file, group="other")
    assert seal.carries_seal(run_file)
    assert read_netcdf(run_file, "other").a.item() == 1.0
    assert read_netcdf(run_file, "run").sizes["time"] == 3000
    assert run_file.read_bytes().count(b"tribolab sha256") == 1


def test_a_file_of_another_program_is_tried_and_read(tmp_path):
    data = xr.Dataset({"a": ("time", [1.0, 2.0])}, {"time": [0.0, 1.0]})
    data.to_netcdf(tmp_path / "a.nc", format="NETCDF3_64BIT")
    assert read_netcdf(tmp_path / "a.nc").a.values.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("place", [200, 1000, 5000, -300])
def test_one_flipped_byte_breaks_the_seal_and_the_file_is_refused(run_file, place):
    content = bytearray(run_file.read_bytes())
    content[place] ^= 0xFF
    run_file.write_bytes(content)
    with pytest.raises(ReadError, match="checksum does not match its content"):
        read_netcdf(run_file, "run")


def test_a_seal_that_anyone_can_append_protects_nothing_from_the_limits(tmp_path):
    """A dataset of 8 TB of which nothing is stored asks for all memory when it is read."""
    with h5py.File(tmp_path / "a.nc", "w") as file:
        file.create_dataset("time", (10**12,), "f8", chunks=(10**6,))
    seal.seal(tmp_path / "a.nc")
    with pytest.raises(ReadError, match="more memory than a sound file|cannot be read"):
        read_netcdf(tmp_path / "a.nc")


# ---- archives


def workbook(shared_data, change):
    source = io.BytesIO((shared_data / "surfacetopography_MIT/mitutoyo_mock.xlsx").read_bytes())
    out = io.BytesIO()
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            new.writestr(name, change(name, old.read(name)))
        change(None, new)
    return out.getvalue()


def test_a_workbook_that_unpacks_to_hundredfold_is_refused_unopened(shared_data, tmp_path):
    def blow_up(name, data):
        return data + b" " * (80 << 20) if name == "xl/worksheets/sheet1.xml" else data

    (tmp_path / "bomb.xlsx").write_bytes(workbook(shared_data, blow_up))
    with pytest.raises(ReadError, match=r"bomb\.xlsx: the file unpacks to \d+ MB, \d+ times"):
        read_scans(tmp_path / "bomb.xlsx")


def test_entities_are_not_unfolded(shared_data, tmp_path):
    levels = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 10))
    bomb = f"<?xml version='1.0'?><!DOCTYPE x [<!ENTITY e0 'boom'>{levels}]>".encode()

    def change(name, data):
        if name != "xl/workbook.xml":
            return data
        body = data[data.index(b"?>") + 2 :]
        return bomb + body.replace(b"<sheets>", b"<sheets>&e9;", 1)

    (tmp_path / "bomb.xlsx").write_bytes(workbook(shared_data, change))
    with pytest.raises(ReadError, match=r"bomb\.xlsx"):
        read_scans(tmp_path / "bomb.xlsx")


def test_a_member_with_a_path_outside_is_written_nowhere(shared_data, tmp_path):
    def change(name, data):
        if name is None:
            data.writestr("../../outside.xml", "x")
            return None
        return data

    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.xlsx").write_bytes(workbook(shared_data, change))
    assert read_scans(tmp_path / "in" / "a.xlsx").sizes["x"] == 960
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["a.xlsx", "in"]


# ---- text


def test_text_that_is_no_profile_is_refused_at_once(tmp_path):
    # its reader of columns begins anew at each of the first 200 lines
    rows = ["1 2 3"] * 40_000
    rows[20_000] = "1 2"
    (tmp_path / "a.dat").write_text("\n".join(rows))
    with pytest.raises(ReadError, match=r"a\.dat: its format is not known"):
        read_scans(tmp_path / "a.dat")
    (tmp_path / "b.dat").write_text("a " * 100_000 + "\n1 2\n3 4\n")
    with pytest.raises(ReadError, match=r"b\.dat: line 1 has 200000 characters"):
        read_scans(tmp_path / "b.dat")


def test_a_line_of_blanks_does_not_take_for_ever(shared_data, tmp_path):
    real = (shared_data / "cetr_umt2_MIT" / "HT-2n-6-4 2_001.csv").read_bytes().splitlines(True)
    real.insert(60, b"\t" * 250_000 + b"1\r\n")
    (tmp_path / "a.csv").write_bytes(b"".join(real))
    with pytest.raises(ReadError, match=r"a\.csv: line "):
        tl.read(tmp_path / "a.csv")


def test_a_quotation_mark_left_open_is_told_in_a_short_message(tmp_path):
    rows = "".join(f"{n / 1000},1\n" for n in range(2000))
    (tmp_path / "a.csv").write_text(HEAD + '0.0,1\n"' + rows)
    with pytest.raises(ReadError, match=r"a\.csv") as error:
        read_scans(tmp_path / "a.csv")
    assert len(str(error.value)) < 500


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ("0,1\n0.001,2\n1e308,3\n", "x reaches 1e\\+305 m"),
        ("0,1\n1e-310,2\n2e-310,3\n", r"x spans .* no profile is so short"),
        ("0,1\n0.001,2\ninf,3\n", "x does not proceed"),
    ],
)
def test_positions_that_cannot_be_are_refused(tmp_path, rows, told):
    (tmp_path / "a.csv").write_text(HEAD + rows)
    with pytest.raises(ReadError, match=f"a.csv.*{told}"):
        read_scans(tmp_path / "a.csv")


@pytest.mark.parametrize("x", ["1e400", "inf", "1e300", ""])
def test_a_map_with_a_point_far_off_is_refused(tmp_path, x):
    (tmp_path / "a.txt").write_text(f"0,0,1\n1,0,1\n0,1,1\n{x},1,1\n")
    with pytest.raises(
        ReadError, match=r"a\.txt: (a point has no place|the points do not lie|4 points do not)"
    ):
        read_scans(tmp_path / "a.txt", "nanovea_map")


@pytest.mark.parametrize("line", ["Ra;3,246;mm/s;;", "Ls;2,5;kg;", "Lc;0,8;;"])
def test_a_unit_that_cannot_be_names_file_and_line(tmp_path, line):
    text = f"// Header\nMode;RES\n// Condition-A\n{line}\n// CalcResult\n{line}\n"
    (tmp_path / "a.TXT").write_text(text)
    with pytest.raises(ReadError, match=rf"a\.TXT: line \d, '{line[:2]}': .*unit"):
        read_tester_results(tmp_path / "a.TXT")


def test_uneven_positions_are_not_continued_beyond_their_ends(tmp_path):
    x = np.linspace(0, 1, 400) ** 2  # mm: dense at the start
    rows = "".join(f"{a:.6f},{b:.4f}\n" for a, b in zip(x, 1 + 10 * x, strict=True))
    (tmp_path / "a.csv").write_text(HEAD + rows)
    scan = read_scans(tmp_path / "a.csv")
    assert "resampled" in scan.attrs
    assert scan.attrs["length_m"] == pytest.approx(1e-3, rel=1e-9)
    # a straight line stays one: nothing flat is added where nothing was measured
    np.testing.assert_allclose(np.diff(scan.height.values[0]), 10e-6 / 399, rtol=1e-2)


# ---- the wrong door


def test_a_profile_given_to_read_is_sent_to_read_scans(shared_data, tmp_path):
    (tmp_path / "a.csv").write_text(HEAD + "0,1\n0.001,2\n")
    for path in (
        tmp_path / "a.csv",
        shared_data / "surfacetopography_MIT" / "dektak-1.csv",
        shared_data / "bearing_profiles_MIT" / "NU206-RE-1.txt",
    ):
        with pytest.raises(
            ReadError, match="looks like a profile .*; read it with read_scans"
        ) as error:
            tl.read(path)
        assert path.name in str(error.value)
    with pytest.raises(ReadError, match="read it with read_scans"):
        tl.read(tmp_path / "a.csv", "surftest_csv")
    with pytest.raises(ReadError, match="read it with read_scans"):
        tl.read(shared_data / "surfacetopography_MIT" / "mitutoyo_mock.xlsx")
    with pytest.raises(ReadError, match="results of a roughness tester, .*read_tester_results"):
        tl.read(shared_data / "mitutoyo_sj410_res_MIT" / "8A2.TXT")


def test_a_run_given_to_read_scans_is_sent_to_read(shared_data):
    for name in ("cetr_umt2_MIT/HT-2n-6-4 2_001.csv", "tdms_force_MIT/TDMSSample.tdms"):
        with pytest.raises(ReadError, match="looks like a run .*; read it with read\\(\\)"):
            read_scans(shared_data / name)


def test_a_mat_file_of_version_7_3_wants_a_description(tmp_path):
    (tmp_path / "a.mat").write_bytes(b"MATLAB 7.3 MAT-file".ljust(512, b"\0"))
    with pytest.raises(ReadError, match=r"a\.mat: no known instrument .*\(hdf5\); describe it"):
        tl.read(tmp_path / "a.mat")


@pytest.mark.parametrize(
    "rows", ["inf,1,31\n0.1,1,31", "0.0,1,31\ninf,1,31\ninf,1,31", "0,1,31\n1e999,1,31"]
)
def test_infinite_times_are_refused_with_their_row(tmp_path, rows):
    head = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n"
    (tmp_path / "a.csv").write_text(head + rows + "\n")
    with pytest.raises(ReadError, match=r"a\.csv: time is infinite in row [12]"):
        tl.read(tmp_path / "a.csv")


def test_a_map_that_states_one_size_of_two_is_refused(tmp_path):
    (tmp_path / "a.txt").write_text(
        "# Channel: Height\n# Width: 10 µm\n# Value units: m\n1 2 3\n4 5 6\n7 8 9\n"
    )
    with pytest.raises(ReadError, match=r"a\.txt: "):
        read_scans(tmp_path / "a.txt")


def test_numbers_run_into_each_other_do_not_take_for_ever(shared_data, tmp_path):
    rows = (shared_data / "surfacetopography_MIT" / "xy-4.txt").read_text().splitlines()
    rows[8687] = "-1.7e308" + rows[8687]
    (tmp_path / "a.txt").write_text("\n".join(rows))
    with pytest.raises(ReadError, match=r"a\.txt: its format is not known"):
        read_scans(tmp_path / "a.txt", x_unit="mm", height_unit="um")


def test_a_tdms_file_cut_short_says_so(shared_data, tmp_path):
    whole = (shared_data / "tdms_force_MIT" / "TDMSSample.tdms").read_bytes()
    (tmp_path / "a.tdms").write_bytes(whole[:-30_000])
    run = tl.read(tmp_path / "a.tdms")
    assert "ends before" in run.attrs["file_incomplete"]
    assert "file_incomplete" not in tl.read(shared_data / "tdms_force_MIT/TDMSSample.tdms").attrs


TABLE = "Time [s],Fx [N],Fz [N]\n" + "".join(f"{k / 10},1.5,10\n" for k in range(40))


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(TABLE + "\n" * 400_000, id="blank lines without end"),
        pytest.param("\n" * 400_000 + TABLE, id="blank lines above"),
        pytest.param("".join(f"Load = 31 N{k}\n" for k in range(30_000)) + TABLE, id="settings"),
        pytest.param(TABLE.replace("Fx [N]", f"Fx [{'<a>' * 400_000}]"), id="a unit of letters"),
        pytest.param("9" * 200_000 + "\n" + TABLE, id="a number of digits"),
    ],
)
def test_a_file_that_is_endless_in_one_way_is_drafted_or_refused(tmp_path, text):
    (tmp_path / "endless.csv").write_text(text)
    try:
        columns = draft_dialect(tmp_path / "endless.csv").understood.columns
    except ReadError as error:
        assert "endless.csv" in str(error)
    else:
        assert [column.quantity for column in columns][::2] == ["time", "normal_force"]


def changed(shared_data, tmp_path, case):
    """Return a workbook without one block of its bytes."""
    place, size = case
    content = (shared_data / "dma_pyvisco_BSD3" / "freq_Eplexor_master.xls").read_bytes()
    (tmp_path / "a.xls").write_bytes(content[:place] + content[place + size :])
    return tmp_path / "a.xls"


@pytest.mark.parametrize("case", [(30_000, 60), (60_000, 360), (512, 512), (80_000, 20)])
def test_an_old_workbook_that_is_damaged_is_refused(shared_data, tmp_path, case):
    path = changed(shared_data, tmp_path, case)
    for reader in (tl.read, draft_dialect, read_modulus):
        with pytest.raises(ReadError, match=r"a\.xls: "):
            reader(path)


def test_a_panic_of_a_library_is_a_read_error(tmp_path):
    PanicException = type("PanicException", (BaseException,), {})  # noqa: N806, as it is called
    with pytest.raises(ReadError, match=r"a\.xlsx: this workbook cannot be read: .*slice"):
        with report_damage(tmp_path / "a.xlsx", "workbook"):
            raise PanicException("slice index starts at 5")
    with pytest.raises(KeyboardInterrupt):
        with report_damage(tmp_path / "a.xlsx", "workbook"):
            raise KeyboardInterrupt


def test_columns_of_an_hdf5_file_that_is_damaged_are_refused(tmp_path):
    time = np.arange(500) / 10
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for name in ("Time [s]", "Fx [N]", "Fz [N]"):
            file.create_dataset(name, data=time, chunks=(50,), compression="gzip")
    content = bytearray((tmp_path / "a.h5").read_bytes())
    whole = draft_dialect(tmp_path / "a.h5").kind
    assert whole == "run"
    for place in range(0, len(content), 97):
        broken = bytearray(content)
        broken[place : place + 4] = b"\xff\xff\xff\x7f"
        path = tmp_path / f"b{place}.h5"
        path.write_bytes(broken)
        if place > 900:
            break
        try:
            draft_dialect(path)
        except ReadError as error:
            assert path.name in str(error)
