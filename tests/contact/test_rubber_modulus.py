"""The modulus of rubber: causality, tables, and the DMA files of a real instrument."""

import warnings

import numpy as np
import pytest
from contact_cases import properties
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from typer.testing import CliRunner

from tribolab import cli
from tribolab.core.errors import AnalysisError, ReadError
from tribolab.reading.moduli import is_modulus_file, read_modulus_table
from tribolab.rubber.modulus import (
    PDMS_STAND_IN,
    FractionalZener,
    TabulatedModulus,
    read_modulus,
)

CSV = "dma_pyvisco_BSD3/freq_user_master.csv"


@pytest.mark.parametrize("exponent", [0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("frequency", [1e6, 1e9, 1e11])
def test_storage_follows_from_loss_by_kramers_and_kronig(exponent, frequency):
    solid = FractionalZener("1.5 MPa", "1 GPa", "1 ns", exponent)

    # E'(w) = E'(0) + (2/pi) P int E''(x) w^2 / (x (w^2 - x^2)) dx; over ln x the two sides of the
    # pole cancel when folded onto t = |ln(x/w)|: 1/(1 - e^2t) and 1/(1 - e^-2t)
    def folded(t):
        high, low = (solid(frequency * np.exp(s * t)).imag for s in (1, -1))
        return high / -np.expm1(2 * t) - low / np.expm1(-2 * t)

    value = quad(folded, 1e-12, 60, limit=400, epsrel=1e-10, points=[1, 5])[0]
    storage = solid.relaxed + 2 / np.pi * value
    assert solid(frequency).real == pytest.approx(storage, rel=1e-5)


@properties
@given(exponent=st.floats(0.1, 1), log_omega=st.floats(-6, 18), log_time=st.floats(-12, 0))
def test_the_model_stays_between_its_plateaus_and_never_gives_energy(exponent, log_omega, log_time):
    solid = FractionalZener(1.5e6, 1e9, 10**log_time, exponent)
    value = complex(solid(10**log_omega))
    assert 1.5e6 <= value.real <= 1e9 * (1 + 1e-12)
    assert 0 <= value.imag <= 0.5e9
    assert complex(solid(-(10**log_omega))) == value.conjugate()


def test_the_model_at_rest_is_the_rubber_and_the_loss_peaks_at_the_relaxation_time():
    assert complex(PDMS_STAND_IN(0.0)) == 1.5e6
    omega = np.geomspace(1e8, 1e12, 4001)
    peak = omega[np.argmax(PDMS_STAND_IN(omega).imag)]
    assert peak == pytest.approx(1 / PDMS_STAND_IN.relaxation_time, rel=0.01)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((1e9, 1e6, 1e-9, 0.5), "softer"),
        ((0.0, 1e9, 1e-9, 0.5), "relaxed"),
        ((1e6, 1e9, -1.0, 0.5), "relaxation_time"),
        ((1e6, 1e9, 1e-9, 1.5), "exponent"),
    ],
)
def test_what_is_no_solid_is_refused(arguments, words):
    with pytest.raises(AnalysisError, match=words):
        FractionalZener(*arguments)


def test_a_fine_table_of_the_model_is_the_model():
    omega = np.geomspace(1e-2, 1e14, 400)
    exact = PDMS_STAND_IN(omega)
    table = TabulatedModulus(omega, exact.real, exact.imag)
    np.testing.assert_allclose(table(omega), exact, rtol=1e-12)
    between = np.sqrt(omega[1:] * omega[:-1])
    np.testing.assert_allclose(table(between), PDMS_STAND_IN(between), rtol=1e-3)
    np.testing.assert_array_equal(table(-between), np.conj(table(between)))


def test_outside_a_table_the_loss_fades_and_the_storage_stays():
    table = TabulatedModulus([1.0, 10.0], [1e6, 2e6], [1e5, 4e5])
    assert complex(table(0.0)) == pytest.approx(1e6, rel=1e-14)
    assert complex(table(0.01)) == pytest.approx(1e6 + 1e3j)
    assert complex(table(1e3)) == pytest.approx(2e6 + 4e3j)


def test_a_table_with_zero_loss_is_interpolated_straight():
    table = TabulatedModulus([1.0, 100.0], [1e6, 1e6], [0.0, 2e5])
    assert complex(table(10.0)) == pytest.approx(1e6 + 1e5j)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        (([2.0, 1.0], [1e6, 1e6], [1.0, 1.0]), "increase strictly"),
        (([1.0, 2.0], [1e6, -1e6], [1.0, 1.0]), "positive"),
        (([1.0, 2.0], [1e6, 1e6], [1.0, np.nan]), "finite"),
        (([1.0], [1e6], [1.0]), "two or more rows"),
    ],
)
def test_what_is_no_table_is_refused(columns, words):
    with pytest.raises(AnalysisError, match=words):
        TabulatedModulus(*columns)


def test_a_table_keeps_its_own_frozen_numbers():
    omega = np.array([1.0, 2.0])
    table = TabulatedModulus(omega, [1e6, 2e6], [1e4, 1e4])
    omega[0] = 5.0
    assert table.angular_frequency[0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        table.storage[0] = 0.0


def test_a_master_curve_in_csv_is_read_in_si(shared_data):
    table = read_modulus(shared_data / CSV)
    assert table.angular_frequency.size == 206
    assert table.angular_frequency[0] == pytest.approx(2 * np.pi * 1e-12)
    assert table.storage[0] == pytest.approx(88.79651575665739e6, rel=1e-14)
    assert table.loss[0] == pytest.approx(10.502460140936773e6, rel=1e-14)
    assert table.storage[-1] == pytest.approx(9580.501294188056e6, rel=1e-14)


def test_a_raw_file_with_a_bom_holds_sweeps_and_one_must_be_named(shared_data):
    path = shared_data / "dma_pyvisco_BSD3/freq_user_raw.csv"
    with pytest.raises(ReadError, match="freq_user_raw.csv: .*21 sweeps.*sweep=0 to 20"):
        read_modulus(path)
    with pytest.raises(ReadError, match="21 sweeps"):
        read_modulus(path, sweep=21)
    last = read_modulus(path, sweep=20)
    assert last.angular_frequency[[0, -1]] == pytest.approx([0.2 * np.pi, 200 * np.pi])
    assert last.storage[-1] == pytest.approx(585.8391184e6)


def test_the_instruments_own_spreadsheet_holds_the_same_as_its_csv(shared_data):
    pytest.importorskip("python_calamine")
    folder = shared_data / "dma_pyvisco_BSD3"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        book = read_modulus(folder / "freq_Eplexor_raw.xls", sweep=20)
        master = read_modulus(folder / "freq_Eplexor_master.xls")
    text = read_modulus(folder / "freq_user_raw.csv", sweep=20)
    np.testing.assert_allclose(book.angular_frequency, text.angular_frequency, rtol=1e-5)
    np.testing.assert_allclose(book.storage, text.storage, rtol=1e-9)
    assert master.angular_frequency.size == 210


def test_a_spreadsheet_without_its_reader_says_what_to_install(shared_data, without):
    without("python_calamine")
    with pytest.raises(ReadError, match="needs the package python-calamine; install it: pip"):
        read_modulus(shared_data / "dma_pyvisco_BSD3/freq_Eplexor_raw.xls")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("f,E_stor\nHz,MPa\n1,2\n", "columns for frequency, storage and loss.*it has f, E_stor"),
        ("f,E',E''\nHz,MPa,furlong\n1,2,3\n2,3,4\n", "column 'E'''.*furlong"),
        ("f,E',E''\n1,2,3\n2,3,4\n", "units are read from .*the row below the names"),
    ],
)
def test_a_file_that_is_no_dma_table_is_refused_with_the_column(tmp_path, text, words):
    path = tmp_path / "dma.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ReadError, match=f"dma.csv: .*{words}"):
        read_modulus(path)


@pytest.mark.parametrize(
    "content",
    [
        b"root:x:0:0:hunter2:/root:/bin/bash\ndaemon:x:1:1:hunter2:/usr/sbin:/bin/sh\n",
        b"hunter2,\xff\xfe,1\n1,2,3\n",
        b"hunter2\n1,2\n1,2,3\n",
        b"",
    ],
)
def test_what_a_file_that_is_no_dma_table_holds_is_not_told(tmp_path, content):
    path = tmp_path / "dma.csv"
    path.write_bytes(content)
    with pytest.raises(ReadError, match=r"dma.csv: ") as error:
        read_modulus(path)
    assert "hunter2" not in str(error.value) and "root" not in str(error.value)


def test_units_and_order_of_the_rows_do_not_matter(tmp_path):
    path = tmp_path / "dma.txt"
    path.write_text("omega;E'';E'\nrad/s;kPa;GPa\n20;5;2\n10;4;1\n", encoding="utf-8")
    table = read_modulus(path)
    np.testing.assert_allclose(table.angular_frequency, [10, 20])
    np.testing.assert_allclose(table.storage, [1e9, 2e9])
    np.testing.assert_allclose(table.loss, [4e3, 5e3])


def test_a_frequency_sweep_of_a_rheometer_is_read_from_utf16_and_from_its_workbook(shared_data):
    folder = shared_data / "anton_paar_rheology_MIT"
    text = read_modulus_table(folder / "freqsweep.csv")
    book = read_modulus_table(folder / "freqsweep_excel_format.xlsx")
    assert text.angular_frequency.size == 11 and text.angular_frequency[-1] == 50
    # of shear: E = 3 G
    assert text.storage[-1] == pytest.approx(3 * 6.2589e-5) and text.loss[-1] == 3 * 1.2518
    for mine, other in zip(text[:3], book[:3], strict=True):
        np.testing.assert_allclose(mine, other)
    assert "multiplied by 3" in text.remarks[0]


def test_columns_that_are_aligned_with_blanks_are_read(shared_data):
    table = read_modulus_table(shared_data / "dma_eplexor_text_MIT/T15.txt")
    assert table.angular_frequency[0] == pytest.approx(0.2 * np.pi, rel=1e-6)
    assert table.storage[0] == pytest.approx(2817.27e6) and table.loss[0] == pytest.approx(38.359e6)
    assert table.temperature == pytest.approx(13, abs=1) and not table.remarks


def test_a_unit_that_the_file_does_not_state_is_asked_for_and_taken(shared_data):
    path = shared_data / "dma_names_MIT/Testdata_Einf.xlsx"
    with pytest.raises(ReadError, match="'Storage-Modulus' is not stated.*unit='MPa'"):
        read_modulus(path)
    table = read_modulus(path, unit="MPa")
    assert table.storage[0] == pytest.approx(78.3864e6) and table.angular_frequency.size == 21
    assert "'Frequency' has no unit and is taken for Hz" in table.remarks[0]


OMEGA, STORAGE, LOSS = [1.0, 10.0, 100.0], [1e6, 1.5e6, 2.5e6], [1e5, 3e5, 5e5]
FACTOR = [b / a for a, b in zip(STORAGE, LOSS, strict=True)]
LAYOUTS = {  # name: head, rows (omega, storage, loss, factor) and how many Pa one is
    "TRIOS": (
        "[step]\nFrequency sweep - 1\nAngular frequency\tStep time\tStorage modulus\tLoss modulus\t"
        "Tan(delta)\nrad/s\ts\tMPa\tMPa\t\n",
        lambda w, s, b, d: f"{w}\t1\t{s / 1e6}\t{b / 1e6}\t{d}",
        1,
    ),
    "RheoWin": (
        "Pos;t in [s];f in [Hz];G' in [Pa];G\" in [Pa];tan(\u03b4) in [-]\n",
        lambda w, s, b, d: f"1;2;{w / 2 / np.pi};{s};{b};{d}".replace(".", ","),
        3,
    ),
    "w, Gp, Gpp": (
        "w [rad/s], Gp [kPa], Gpp [kPa]\n",
        lambda w, s, b, d: f"{w}, {s / 1e3}, {b / 1e3}",
        3,
    ),
    "loss factor": (
        "Frequenz;Speichermodul;Verlustfaktor\nHz;MPa;1\n",
        lambda w, s, b, d: f"{w / 2 / np.pi};{s / 1e6};{d}",
        1,
    ),
    "complex modulus": (
        "Ang. frequency (rad/s)\t|E*| (Pa)\tPhase angle (deg)\n",
        lambda w, s, b, d: f"{w}\t{np.hypot(s, b)}\t{np.degrees(np.arctan2(b, s))}",
        1,
    ),
    "falling": (
        "Angular Frequency  E'  E''\n[rad/s]  [Pa]  [Pa]\n",
        lambda w, s, b, d: f"{w}  {s}  {b}",
        1,
    ),
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-8-sig"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_what_rheometers_export_is_read(layout, encoding, tmp_path):
    head, row, times = LAYOUTS[layout]
    rows = [row(*values) for values in zip(OMEGA, STORAGE, LOSS, FACTOR, strict=True)]
    rows = rows[::-1] if layout == "falling" else rows
    path = tmp_path / "sweep.txt"
    path.write_text(head + "\n".join(rows) + "\n", encoding)
    table = read_modulus(path)
    np.testing.assert_allclose(table.angular_frequency, OMEGA, rtol=1e-9)
    np.testing.assert_allclose(table.storage, times * np.array(STORAGE), rtol=1e-9)
    np.testing.assert_allclose(table.loss, times * np.array(LOSS), rtol=1e-9)


def test_a_sweep_is_named_by_its_temperature(shared_data):
    path = shared_data / "dma_pyvisco_BSD3/freq_user_raw.csv"
    assert read_modulus(path, "100 C").storage[-1] == pytest.approx(585.8391184e6)
    with pytest.raises(ReadError, match="no sweep at 300 C"):
        read_modulus(path, "300 C")


def test_a_file_that_cannot_be_opened_costs_one_message(tmp_path, monkeypatch):
    path = tmp_path / "sweep.txt"
    path.write_text("f,E',E''\nHz,MPa,MPa\n1,2,3\n2,3,4\n", "utf-8")

    def closed(self, *_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.open", closed)
    assert not is_modulus_file(path)
    with pytest.raises(ReadError, match="sweep.txt.*cannot be opened.*Permission denied"):
        read_modulus_table(path)


def test_info_says_that_a_modulus_is_one(shared_data):
    done = CliRunner().invoke(cli.app, ["info", str(shared_data / "dma_eplexor_text_MIT/T15.txt")])
    assert done.exit_code == 0 and "modulus_file" in done.stdout
    assert "tribolab check" not in done.stdout


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ReadError, match="nowhere.csv"):
        read_modulus(tmp_path / "nowhere.csv")


EXPORTS = {  # of HAAKE RheoWin, TA Q800 and RepTate, after files in public repositories
    "rheowin.csv": (
        ',t in s,f in Hz,G\' in Pa,"G"" in Pa",T in °C\n',
        "1|{n},{n}00,{hz},17130,1299,37\n",
        (2 * np.pi, 3 * 17130, 37),
    ),
    "q800.txt": (
        "Module\tDMA Multi-Frequency - Strain\nNsig\t4\nSig1\tTime (min)\nSig2\tFrequency (Hz)\n"
        "Sig3\tStorage Modulus (MPa)\nSig4\tLoss Modulus (MPa)\nStartOfData\n",
        "{n}\t{hz}\t1500\t80\n",
        (2 * np.pi, 1.5e9, np.nan),
    ),
    "pi.tts": ("Mw=94.9;T=-35;chem=PI\n", "{hz} 500 20\n", (1, 1500, np.nan)),
    "units.osc": (
        "T=0;Mw=94.9;\nFreq\tG'\tG\"\nrad/s\tPa\tPa\n",
        "{hz}\t500\t20\n",
        (1, 1500, np.nan),
    ),
}


@pytest.mark.parametrize("name", EXPORTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_names_that_stand_elsewhere_or_twice_are_found(name, encoding, tmp_path):
    above, row, (scale, storage, celsius) = EXPORTS[name]
    rows = "".join(row.format(n=n, hz=2**n) for n in range(1, 9))
    (tmp_path / name).write_text(above + rows, encoding=encoding)
    read = read_modulus_table(tmp_path / name)
    np.testing.assert_allclose(read.angular_frequency, scale * 2.0 ** np.arange(1, 9))
    np.testing.assert_allclose(read.storage, storage)
    np.testing.assert_equal(read.temperature, celsius)


@pytest.mark.parametrize(
    ("columns", "test"),
    [
        ("Time [s],Compliance [1/Pa]", "a creep test"),
        ("Time [s],Relaxation Modulus [Pa]", "a test of stress relaxation"),
        ("Shear Rate [1/s],Shear Stress [Pa]", "a flow curve"),
        ("T (°C),aT", "shift factors of a master curve"),
        (
            "Time (min),Temperature (°C),Storage Modulus (MPa),Loss Modulus (MPa),Frequency (Hz)",
            "1 Hz",
        ),
    ],
)
def test_another_test_of_a_rheometer_is_named(columns, test, tmp_path):
    file = tmp_path / "a.csv"
    wide = columns.splitlines()[-1].count(",") - 1
    file.write_text(f"{columns}\n" + "".join(f"{n},{n + 1}{',1' * wide}\n" for n in range(1, 30)))
    result = CliRunner().invoke(cli.app, ["info", str(file)])
    assert result.exit_code == 3
    assert test in result.output


def test_what_cannot_be_a_modulus_is_left_out_or_refused(tmp_path):
    file = tmp_path / "a.csv"
    head = "f [Hz],E' [MPa],E'' [MPa]\n"
    good = "".join(f"{2**n},{50 + n},{5 + n}\n" for n in range(5))
    file.write_text(f"{head}0.1,-1.1,0.3\n0.3,2.3,-6.1\n{good}")
    read = read_modulus_table(file)
    np.testing.assert_allclose(read.storage, 1e6 * (50 + np.arange(5)))
    assert "2 rows with a negative modulus are left out (0.1 to 0.3 Hz)" in read.remarks[0]
    file.write_text(head + good.replace("50", "-50").replace("2,", "-2,"))
    with pytest.raises(ReadError, match="logarithms"):
        read_modulus_table(file)
    file.write_text(f"{head}{good}{'1,0.7,1.5' + chr(10)}{'1,0.8,1.6' + chr(10)}{good}")
    assert read_modulus_table(file, sweep=1).storage.size == 5
    with pytest.raises(ReadError, match="2 sweeps are in it"):
        read_modulus_table(file)
