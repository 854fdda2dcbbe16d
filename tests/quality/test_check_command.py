"""`tribolab check` on files of every kind: runs, scans, and results of roughness testers."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from tribolab import cli, rig
from tribolab.app.info import excerpt, file_info
from tribolab.core.errors import ReadError
from tribolab.qc.register import Check
from tribolab.qc.run import checks as run_checks
from tribolab.qc.scan import checks as scan_checks
from tribolab.reading.kinds import kind_of
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.rig.files import scan_file


def tribolab_check(*words):
    return CliRunner().invoke(cli.app, ["check", *map(str, words)])


def told(*words):
    return json.loads(tribolab_check(*words, "--json").stdout)


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """Three scans of one surface, the second of four times the height, and one of another."""
    folder = tmp_path_factory.mktemp("scans")
    found = rig.scans("Sb-R", 3, seed=1001, length=4e-3)
    for number, factor in enumerate((1, 4, 1), start=1):
        text = scan_file(found.x.values, factor * found.height.values[number - 1]).decode()
        (folder / f"sb-r_{number}.csv").write_text(re.sub(r"# length:.*\n", "", text))
    (folder / "other_1.csv").write_text((folder / "sb-r_1.csv").read_text())
    return folder


def test_scans_are_recognised_and_repeats_compared_by_their_names(scans):
    found = told(*sorted(scans.glob("*.csv")))
    by_name = {one["name"]: one for one in found["runs"]}
    assert {one["kind"] for one in found["runs"]} == {"scan"}
    assert {name: one["status"] for name, one in by_name.items()} == {
        "other_1.csv": "pass",
        "sb-r_1.csv": "pass",
        "sb-r_2.csv": "fail",
        "sb-r_3.csv": "pass",
    }
    assert found["exit_code"] == 1
    [row] = [row for row in by_name["sb-r_2.csv"]["findings"] if row["status"] == "fail"]
    assert row["check"] == "repeats" and row["message"].startswith("sb-r_2.csv has a spectrum")
    [row] = [row for row in by_name["sb-r_3.csv"]["findings"] if row["check"] == "repeats"]
    assert row["message"] == "agrees with the other scans but sb-r_2.csv"


def test_whether_scans_are_repeats_can_be_said(scans):
    files = sorted(scans.glob("sb-r_*.csv"))
    assert tribolab_check(*files, "--no-repeats").exit_code == 0
    pair = [scans / "other_1.csv", scans / "sb-r_2.csv"]
    assert tribolab_check(*pair).exit_code == 0
    found = told(*pair, "--repeats")
    assert [one["status"] for one in found["runs"]] == ["fail", "fail"]


def test_runs_scans_and_rubbish_can_be_given_together(scans, shared_data, tmp_path):
    rubbish = tmp_path / "odd.csv"
    rubbish.write_text("nothing,here\nbut,words\n")
    rock = shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt"
    found = told(scans / "sb-r_1.csv", rubbish, rock)
    assert [one["kind"] for one in found["runs"]] == ["scan", "file", "run"]
    assert found["runs"][1]["status"] == "unreadable" and found["exit_code"] == 3
    assert "odd.csv: no table of numbers was found in the file" in found["runs"][1]["error"]


def test_err110_of_the_roughness_tester_is_found(shared_data):
    folder = shared_data / "mitutoyo_sj410_res_MIT"
    found = told(*sorted(folder.glob("*.TXT")))["runs"]
    assert [(one["kind"], one["status"]) for one in found] == [
        ("results", "suspect"),
        ("results", "pass"),
        ("results", "pass"),
    ]
    assert "RSm: Err110" in found[0]["findings"][0]["message"]


def test_results_beside_their_profile_are_compared_with_it(scans, shared_data, tmp_path):
    results = (shared_data / "mitutoyo_sj410_res_MIT/12A11003.TXT").read_bytes()
    profile = (scans / "sb-r_1.csv").read_bytes()
    (tmp_path / "s_1.txt").write_bytes(results)
    (tmp_path / "s_1.csv").write_bytes(profile)
    [one] = told(tmp_path / "s_1.txt", tmp_path / "s_1.csv")["runs"]
    rows = [row for row in one["findings"] if row["check"] == "results"]
    assert {"results", "Ra", "Rq"} == {row["variable"] for row in rows}


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("stickslip_paper_CeCILL-B/k168Nm_v1100.mat", r"note +hum .*mains hum at 49\.96 Hz"),
        ("rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt", r"note +rate_changes .*changes 1"),
        ("cetr_umt2_MIT/HT-2n-6-4 2_001.csv", r"note +restarts .*2 steps"),
        ("surfacetopography_MIT/dektak-1.csv", r"note +spacing .*are uneven"),
    ],
)
def test_known_troubles_too_small_to_object_to_are_shown(shared_data, path, said):
    done = tribolab_check(shared_data / path, "--verbose")
    assert done.exit_code == 0
    assert re.search(said, done.stdout)


def test_what_every_file_of_the_data_holds_is_told(shared_data):
    kinds = {
        "surfacetopography_MIT/dektak-1.csv": "scan",
        "bearing_profiles_MIT/NU208-IR-1.txt": "scan",
        "surfacetopography_MIT/mitutoyo_mock.xlsx": "unknown",
        "mitutoyo_sj410_res_MIT/8A2.TXT": "results",
        "tdms_force_MIT/TDMSSample.tdms": "run",
        "stickslip_paper_CeCILL-B/k168Nm_v1100.mat": "run",
        "pcs_mtm_ehd_MIT/demo_2.txt": "run",
        "no such file": "unknown",
    }
    assert {path: kind_of(shared_data / path) for path in kinds} == kinds


@pytest.mark.parametrize("which", ["run", "scan"])
def test_a_check_that_raises_is_a_row_and_exit_code_3(monkeypatch, scans, shared_data, which):
    def crash(subject, limits):
        raise ZeroDivisionError("division by zero")

    home, name = (run_checks, "RUN_CHECKS") if which == "run" else (scan_checks, "SCAN_CHECKS")
    broken = Check("broken", 30, "Broken?", "Mend it.", {}, crash)
    monkeypatch.setitem(getattr(home, name), "broken", broken)
    file = scans / "sb-r_1.csv"
    if which == "run":
        file = shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt"
    found = told(file, "--fail-on", "never")
    assert found["exit_code"] == 3
    row = found["runs"][0]["findings"][0]
    assert (row["check"], row["status"]) == ("broken", "error")
    assert "ZeroDivisionError: division by zero" in row["message"]


@pytest.mark.slow
def test_quick_answers_wait_for_no_library_that_they_do_not_need(shared_data):
    file = shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt"
    code = (
        "import contextlib, sys\nfrom tribolab import cli\n"
        "for command in ('check', 'info'):\n"
        f"    with contextlib.suppress(SystemExit):\n        cli.app([command, {str(file)!r}])\n"
        "slow = {'pint', 'dask', 'matplotlib', 'SurfaceTopography', 'scipy.stats', 'netCDF4'}\n"
        "sys.stderr.write(str(sorted(slow & set(sys.modules))))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "[]"


def test_a_map_and_a_single_scan_have_nothing_to_be_compared_with(tmp_path):
    for number in (1, 2):
        headless_map(tmp_path / f"map_{number}.txt")
    found = told(*sorted(tmp_path.glob("*.txt")), "--instrument", "nanovea_map")
    for one in found["runs"]:
        [row] = [row for row in one["findings"] if row["check"] == "repeats"]
        assert row["status"] == "skipped", row


def test_info_describes_scans_and_results_as_check_reads_them(scans, tmp_path):
    results = tmp_path / "a.txt"
    results.write_text("// Header\nMode;RES\n// CalcResult\nRa;3,246;um;;\n")
    done = CliRunner().invoke(cli.app, ["info", str(scans / "sb-r_1.csv"), str(results)])
    assert done.exit_code == 0 and done.stderr == ""
    assert "sb-r_1.csv: surftest_csv (" in done.stdout
    assert re.search(r"profile of \d+ points\n  x +4 mm, one point every 0.5 um\n", done.stdout)
    assert "results of a roughness tester" in done.stdout and "Ra  3.246e-06 m" in done.stdout


@pytest.mark.parametrize("command", ["info", "check"])
def test_the_terminal_names_options_and_not_arguments_of_functions(
    scans, tmp_path, command, monkeypatch
):
    monkeypatch.chdir(tmp_path)  # the folder's name is no part of the sentence's length
    unknown, squeezed = Path("unknown.txt"), Path("run.csv.gz")
    unknown.write_text("one,two\n" + "1,2\n2,5\n3,4\n" * 9)
    squeezed.write_bytes(b"PK\x03\x04")
    done = CliRunner().invoke(cli.app, [command, str(unknown), str(squeezed)])
    assert done.exit_code == 3
    assert "; write names and units above the columns" in done.stderr
    assert all(len(line) < 300 for line in done.stderr.splitlines())
    assert not re.search(r"\w=[ ,;]|\w\(\)", done.stderr)


def headless_map(file):
    """Write a map as profilometers export it: three columns of numbers and not a word."""
    x, y = np.meshgrid(np.arange(20) * 1e-3, np.arange(20) * 1e-3)
    z = np.random.default_rng(0).standard_normal(x.size)
    rows = np.column_stack([x.ravel(), y.ravel(), z])
    np.savetxt(file, rows, fmt="%.6f", delimiter=",")
    return str(file)


@pytest.mark.parametrize("command", ["info", "check"])
def test_of_a_map_without_units_the_terminal_says_how_to_describe_it(tmp_path, command):
    file = headless_map(tmp_path / "map.txt")
    done = CliRunner().invoke(cli.app, [command, file])
    assert done.exit_code == 3
    assert "treated as a profile or map: the file states no units (xyz); " in done.stderr
    assert f"'tribolab info {file} --write my.toml' drafts a description of it" in done.stderr
    assert not re.search(r"\w=|\w\(\)", done.stderr)
    assert CliRunner().invoke(cli.app, [command, file, "-i", "nanovea_map"]).exit_code == 0


def test_run_names_the_key_of_the_campaign_file_and_no_option_that_it_lacks(tmp_path):
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw/odd.txt").write_text("one,two\n" + "1,2\n2,5\n3,4\n" * 9)
    headless_map(tmp_path / "raw/map.txt")
    (tmp_path / "campaign.toml").write_text(
        '[campaign]\nname = "a"\n[[surface]]\nname = "S"\nscans = "map.txt"\n'
        '[[run]]\nfiles = "odd.txt"\n'
    )
    done = CliRunner().invoke(cli.app, ["run", str(tmp_path / "campaign.toml"), "-q", "-j", "1"])
    assert done.exit_code == 3
    of_run, of_surface = done.stderr.splitlines()[:2]
    assert "a table of one, two: no signals along time and no profile" in of_run
    assert 'says them with instrument = "..." in its [[surface]]' in of_surface
    page = (tmp_path / "results/report.html").read_text()
    said = (tmp_path / "results/tables/checks.csv").read_text()
    assert "no signals along time" in page and "no signals along time" in said
    assert "instrument=" not in page + said and "read_scans" not in page + said
    assert "--instrument" not in done.stderr


def test_a_file_in_the_wrong_table_of_a_campaign_is_told_the_right_one(scans, tmp_path):
    log = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n5.0,1.0,31.0\n5.1,2.0,31.0\n"
    (tmp_path / "run.csv").write_text(log)
    with pytest.raises(ReadError) as error:
        read_scans(tmp_path / "run.csv")
    assert error.value.message_for("campaign").endswith("; it belongs in a [[run]]")
    with pytest.raises(ReadError) as error:
        read(scans / "sb-r_1.csv")
    assert error.value.message_for("campaign").endswith("; it belongs under scans of a [[surface]]")
    assert "a campaign under scans of a [[surface]]" in error.value.message_for("terminal")


def test_info_on_a_long_file_takes_an_excerpt_in_which_each_range_is_nearly_the_whole_files(
    tmp_path, monkeypatch
):
    rows = 60_000
    time = np.arange(rows) / 100
    speed = np.sign(np.sin(time / 3)) * (1 + time // 40)
    force = 5 * np.sign(speed)
    lines = [f"{t:.2f},{f:.3f},20.0,{v:.3f}\n" for t, f, v in zip(time, force, speed, strict=True)]
    file = tmp_path / "own.csv"
    head = "Slider\nTime [s],Friction force [N],Normal force [N],Speed [mm/s]\n"
    file.write_text(head + "".join(lines))
    whole = file_info.file_lines(file)
    monkeypatch.setattr(excerpt, "_MAX_WHOLE", 1 << 19)
    part = file_info.file_lines(file)
    assert "estimate" in part[2]
    assert [line for line in part if line in whole] == [whole[0], *whole[2:]]
    estimated = int(part[1].split()[0])
    assert estimated == pytest.approx(rows, rel=0.01)

    # a known instrument, whose second log is missing, or there
    known = tmp_path / "k_force.csv"
    head = "# Linear slider, force log\nTime [s],Fx [N],Fz [N],V [mm/s]\n"
    known.write_text(head + "".join(lines))
    part = file_info.file_lines(known)
    assert "estimate" in part[2] and "companion log: k_motion.csv does not exist" in part[-1]
    (tmp_path / "k_motion.csv").write_text("no numbers\n")
    part = file_info.file_lines(known)
    assert "estimate" not in part[2] and "companion log: refused" in "".join(part)
