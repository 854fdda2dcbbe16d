"""A pattern reads all the runs that it names; a name is a name even where it looks like one."""

import shutil

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.rig.parameters import Protocol, Rig
from tribolab.rig.runs import simulate_run

HEAD = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n"


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    folder = tmp_path_factory.mktemp("raw")
    for number in (2, 1):
        rig = Rig(Protocol(speeds=(1e-4, 1e-3)))
        tl.rig.write_run(simulate_run("Sb-S", "dry", number=number, rig=rig, seed=4), folder)
    return folder


def test_a_pattern_reads_each_run_once_whichever_of_its_logs_it_names(raw):
    runs = tl.read(raw / "*.csv", clock_shift=0.0)
    names = [run.attrs["source"] for run in runs]
    assert len(names) == 2 and names == sorted(names)
    assert all("sliding_velocity" in run and ";" in run.attrs["source"] for run in runs)
    by_force = tl.read(str(raw / "*_force.csv"), clock_shift=0.0)
    assert all(a.equals(b) for a, b in zip(runs, by_force, strict=True))


def test_without_pairs_every_file_stands_alone(raw):
    alone = tl.read(raw / "*.csv", pair=False)
    assert len(alone) == 4
    assert all(("friction_force" in r) != ("sliding_velocity" in r) for r in alone)


def test_a_pattern_that_nothing_matches_says_so(raw):
    with pytest.raises(ReadError, match=r"nothing_\*.csv: the pattern matches nothing in"):
        tl.read(raw / "nothing_*.csv")
    with pytest.raises(ReadError, match=r"only folders"):
        tl.read(raw.parent / f"{raw.name[:-1]}?")


def test_a_folder_is_separated_into_runs_and_scans(raw, tmp_path):
    folder = tmp_path / "both"
    shutil.copytree(raw, folder)
    for number in (1, 2):
        lines = [f"{0.5 * k},{k % 7 + number}" for k in range(300)]
        text = "\n".join(["x [um],z [um]", *lines, ""])
        (folder / f"rough_{number}.csv").write_text(text)
    (folder / "notes.md").write_text("not a measurement")
    for runs in (tl.read(folder, clock_shift=0.0), tl.read(folder / "*", clock_shift=0.0)):
        assert len(runs) == 2 and all("friction_force" in run for run in runs)
    assert tl.read_scans(folder).sizes["scan"] == tl.read_scans(f"{folder}/*").sizes["scan"] == 2
    with pytest.raises(ReadError, match=r"none of the files is a run \(found: 2 x scan\)"):
        tl.read(folder / "rough*")


def test_a_file_whose_name_looks_like_a_pattern_is_that_file(tmp_path):
    folder = tmp_path / "rig [2]"
    folder.mkdir()
    (folder / "a[1].csv").write_text(HEAD + "0,7,31\n0.1,7,31\n")
    (folder / "a1.csv").write_text(HEAD + "0,9,31\n0.1,9,31\n")
    assert [r.friction_force.values[0] for r in tl.read(folder / "*.csv")] == [9, 7]
    assert tl.read(folder / "a[1].csv").friction_force.values.tolist() == [7, 7]


def test_variables_stand_with_meaning_unit_and_range(raw):
    run = tl.read(raw / "*_01_*.csv", clock_shift=0.0)[0]
    table = tl.variables(run)
    assert table.index[0] == "time" and table.unit["friction_force"] == "N"
    assert table.column["friction_force"] == "Fx [N]"
    assert table.highest["normal_force"] == run.normal_force.max()
    segments = tl.variables(tl.find_segments(run))
    assert (segments.meaning != "").all()
    assert segments.unit["omitted_reason"] == "" and segments.lowest["omitted_reason"] == "at rest"
    gap = run.friction_force.where(run.time > 1)
    assert tl.variables(gap).missing["friction_force"] == np.isnan(gap).sum() > 0
