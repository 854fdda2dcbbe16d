"""A run that is analysed anew is not read anew, unless what reading depends on changed."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from campaigns import RUNS, copied

from tribolab.app.run import run_campaign
from tribolab.campaign.runs import analysis
from tribolab.campaign.runs.reading import READING, Earlier, earlier_signals, mark_of, note_reading
from tribolab.campaign.runs.sources import sources_of_run
from tribolab.campaign.settings.plan import PlannedRun
from tribolab.campaign.store.data_files import read_data, write_data
from tribolab.qc.run.checks import check_run
from tribolab.reading.runs.read_run import read_run


@pytest.fixture(scope="module")
def original(two_runs):
    """A campaign with results; not to be changed."""
    return two_runs


@pytest.fixture(scope="module")
def fresh(original, tmp_path_factory):
    """The tables of the same raw files with another trim."""
    campaign = copied(original, tmp_path_factory.mktemp("fresh"))
    edit(campaign, "trim = 0.10", "trim = 0.12")
    return tables(run(campaign, campaign.parent / "fresh"))


@pytest.fixture
def read(monkeypatch):
    """Names of the first files of the runs that are read."""
    names = []

    def spied(paths, *given, **more):
        names.append((paths if isinstance(paths, Path) else paths[0]).name)
        return read_run(paths, *given, **more)

    monkeypatch.setattr("tribolab.reading.runs.read_run.read_run", spied)
    return names


def run(campaign, output=None, **options):
    outcome = run_campaign(campaign, output=output, jobs=1, figures="none", **options)
    assert len(outcome.runs) == 2 and all(run.done for run in outcome.runs)
    return outcome.folder


def edit(campaign, old, new):
    text, count = re.subn(old, new, campaign.read_text("utf-8"))
    assert count
    campaign.write_text(text, "utf-8")


def tables(folder):
    return {path.name: path.read_text("utf-8") for path in (folder / "tables").glob("*.csv")}


@pytest.mark.slow
def test_all_that_a_changed_trim_gives_is_what_a_fresh_analysis_gives(original, tmp_path, read):
    campaign = copied(original, tmp_path)
    before = tables(campaign.parent / "results")
    edit(campaign, "trim = 0.10", "trim = 0.12")
    edit(campaign, 'normal_force = "31 N"', 'normal_force = "30.5 N"')
    folder = run(campaign)
    assert read == []
    fresh = run(campaign, tmp_path / "fresh")
    assert len(read) == 2
    assert tables(folder) == tables(fresh)
    assert tables(folder)["friction.csv"] != before["friction.csv"]
    for name in (RUNS[0], RUNS[2]):
        for group in ("run", "segments", "friction", "stick_slip"):
            one, other = (read_data(at / f"data/{name}.nc", group) for at in (folder, fresh))
            one.attrs["history"] = other.attrs.get("history")  # when it was made
            assert one.drop_attrs(deep=False).identical(other.drop_attrs(deep=False))
            assert {**one.attrs, "history": ""} == {**other.attrs, "history": ""}

    # what was not read is known as well as what was, and once more
    edit(campaign, "trim = 0.12", "trim = 0.1")
    edit(campaign, 'normal_force = "30.5 N"', 'normal_force = "31 N"')
    del read[:]
    assert tables(run(campaign)) == before and read == []


def shifted(campaign):
    edit(campaign, 'medium = "dry"\n', 'medium = "dry"\nclock_shift = "1 s"\n')


def dialect(campaign):
    from tribolab.reading.dialect.find import known_dialects

    shutil.copy(known_dialects()["linear_slider"], campaign.parent / "mine.toml")
    edit(
        campaign,
        'medium = "dry"(.*\n)*?instrument = ".*"',
        'medium = "dry"\ninstrument = "mine.toml"',
    )


def rewritten(campaign):
    log = campaign.parent / f"raw/friction/{RUNS[2]}_force.csv"
    log.write_text(log.read_text("utf-8").replace("rate:", "rate :"), "utf-8")


def spoilt(campaign):
    file = campaign.parent / f"results/data/{RUNS[2]}.nc"
    file.write_bytes(file.read_bytes()[:-200])


def gone(campaign):
    (campaign.parent / f"results/data/{RUNS[2]}.nc").unlink()


@pytest.mark.slow
@pytest.mark.parametrize("change", [shifted, dialect, rewritten, spoilt, gone])
def test_what_reading_depends_on_is_noticed(original, fresh, tmp_path, read, change):
    campaign = copied(original, tmp_path)
    edit(campaign, "trim = 0.10", "trim = 0.12")
    change(campaign)
    folder = run(campaign)
    assert read == [f"{RUNS[2]}_force.csv"]
    damaged = change in (spoilt, gone)  # results only: the raw files are what they were
    after = tables(folder)
    assert damaged == (after == fresh)
    if change is not shifted:  # another name or comment moves no number
        assert after["friction.csv"] == fresh["friction.csv"]
    else:
        assert after == tables(run(campaign, tmp_path / "fresh"))


FILES = [
    "actuator_friction_CC0/Circle_1bar.csv",
    "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt",
    "stickslip_paper_CeCILL-B/k168Nm_v1100.mat",
    "cetr_umt2_MIT/HT-2n-6-4 2_001.csv",
]


def stored(run, tmp_path):
    """Signals as they are read, and where they are stored as a campaign stores them."""
    read = analysis._read(run)
    marked = check_run(read.copy()).marked
    marked.attrs |= {"quality": "pass", "instrument": "another", "trim": np.float64(0.1)}
    note_reading(run, read, marked)
    write_data({"run": marked}, tmp_path / "run.nc")
    return read, Earlier(tmp_path / "run.nc", mark_of(run, sources_of_run(run, read.attrs)))


def planned(*files, **more):
    names = tuple(file.name for file in files)
    return PlannedRun("a", files, names, "", "", None, None, None, None, **more)


@pytest.mark.parametrize("name", FILES)
def test_signals_of_real_files_come_back_as_they_were_read(shared_data, tmp_path, name):
    read, earlier = stored(planned(shared_data / name), tmp_path)
    again = earlier_signals(earlier)
    assert again.identical(read)
    assert [*again.variables] == [*read.variables] and [*again.attrs] == [*read.attrs]
    for key, variable in read.variables.items():
        assert variable.dtype == again[key].dtype
    assert earlier_signals(earlier._replace(mark="another")) is None
    assert earlier_signals(earlier._replace(mark="")) is None


@pytest.mark.parametrize(
    ("zero", "kept"), [("first 2 s", True), ("1 s to 3 s", True), ("file blank.csv", False)]
)
def test_signals_whose_zero_another_file_tells_are_read_again(shared_data, tmp_path, zero, kept):
    run = planned(shared_data / FILES[0])
    read = analysis._read(run).assign_attrs(zeros_read={"friction_force": zero})
    marked = read.copy()
    note_reading(run, read, marked)
    assert (READING in marked.attrs) == kept


def test_the_mark_tells_files_their_order_and_settings_apart(tmp_path):
    a, b = Path("a.csv"), Path("b.csv")
    sums = (("a", "1", 1), ("b", "2", 1))
    marks = [
        mark_of(planned(a, b), sums),
        mark_of(planned(b, a), sums[::-1]),
        mark_of(planned(a, b), (sums[0], ("b", "3", 1))),
        mark_of(planned(a, b, reading_sha256="other"), sums),
        mark_of(planned(a, Path("c.csv")), sums),
    ]
    assert len(set(marks)) == len(marks)
    assert mark_of(planned(a, b), (sums[0], ("b", "", 1))) == ""


@pytest.mark.slow
def test_a_run_with_a_log_that_may_come_or_change_unnoticed_is_read_again(original, tmp_path):
    force, motion = (
        original.parent / f"raw/friction/{RUNS[0]}_{log}.csv" for log in ("force", "motion")
    )
    for beside in (True, False):  # its companion is not named, or not there
        place = tmp_path / str(beside)
        place.mkdir()
        for log in (force, motion) if beside else (force,):
            shutil.copy(log, place)
        read, earlier = stored(planned(place / force.name), place)
        assert ("sliding_velocity" in read) == beside
        assert READING not in read_data(earlier.file, "run").attrs
        assert earlier_signals(earlier) is None
