"""Results of roughness testers as names and values: Latin-1, decimal commas, what is not told."""

import numpy as np
import pytest

from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError
from tribolab.reading.kinds import kind_of
from tribolab.reading.results_table import find_results_table
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown.proposal.draft import draft_dialect

TEXT = "Report\nRa\t0,523µm\nRq\t0,661 µm\nRz\t*.*******µm\nRsk\t-0,31\nRt\t4,2 µm\nλc\t0,8mm\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
@pytest.mark.parametrize("separator", ["\t", " = ", ": ", ";"])
def test_names_and_values_are_results(tmp_path, encoding, separator):
    text = TEXT if encoding != "latin-1" else TEXT.replace("λc", "Lc")
    path = tmp_path / "tester.txt"
    path.write_bytes(text.replace("\t", separator).encode(encoding))
    found = read_tester_results(path)
    np.testing.assert_allclose([found.Ra, found.Rq, found.Rsk], [0.523e-6, 0.661e-6, -0.31])
    assert np.isnan(found.Rz)
    assert found.attrs["instrument_errors"] == "Rz: *.*******µm"
    assert found.attrs["lambda_c_m"] == 8e-4 and found.attrs["instrument_Rt_m"] == 4.2e-6
    assert kind_of(path) == "results"
    assert any("results of a roughness tester" in line for line in file_lines(path))
    assert "results of a roughness tester" in draft_dialect(path).answer
    with pytest.raises(ReadError, match="no profile"):
        read_scans(path)


def test_a_value_without_a_unit_is_refused(tmp_path):
    path = tmp_path / "tester.txt"
    path.write_text("Ra = 0.5\nRq = 0.6\nRz = 3\n")
    with pytest.raises(ReadError, match="line 1, 'Ra': the value has no unit"):
        read_tester_results(path)


def test_a_profile_below_its_results_is_a_profile(tmp_path):
    path = tmp_path / "line.txt"
    rows = "".join(f"{n * 0.001:.3f},{n % 7}\n" for n in range(50))
    path.write_text("Ra = 0.5 um\nRq = 0.6 um\nRz = 3 um\nX [mm],Z [um]\n" + rows)
    assert kind_of(path) == "unknown"
    assert read_scans(path).sizes["x"] == 50


TABLES = {
    "Ra of scans": "File;Ra [\u00b5m];Rq [\u00b5m]\nbrake_01;0,41;0,52\nbrake_02;0,43;0,55\n",
    "with units in a row": "Sample\tRa\tRz\n\tum\tum\nA1\t0.41\t3.1\nA2\t0.43\t3.3\nA3\t0.4\t3.0\n",
    "Mohr-Coulomb": (
        "Test,Normal stress [kPa],Peak shear stress [kPa],Residual shear stress [kPa]\n"
        "1,50,38.2,31.1\n2,100,71.0,58.9\n3,200,139.5,116.2\n"
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_of_results_is_reported_as_such(tmp_path, name):
    path = tmp_path / "table.csv"
    path.write_text(TABLES[name], "latin-1")
    for reader in (read_scans, read, read_tester_results):
        with pytest.raises(ReadError, match="table of results") as refused:
            reader(path)
        assert "read_tester_results" not in str(refused.value)


@pytest.mark.parametrize(
    "text",
    [
        "Ra;Rz\n0.4;3\n" + "x [mm];z [um]\n" + "".join(f"{n / 10};{n % 3}\n" for n in range(40)),
        "Time [s];Normal stress [kPa];Peak shear stress [kPa]\n"
        + "".join(f"{n / 10};50;{20 + n % 3}\n" for n in range(40)),
    ],
)
def test_a_table_below_results_and_one_along_time_are_none(text):
    assert find_results_table(text) is None
