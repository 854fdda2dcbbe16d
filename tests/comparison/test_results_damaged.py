"""Damaged, forged and lost files of the results are noticed, named and computed again."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from campaigns import copied
from hostile.damage import KINDS, spoil
from typer.testing import CliRunner

from tribolab import cli
from tribolab.app.run import run_campaign
from tribolab.app.verifying import mend, problems, recomputed
from tribolab.campaign.store import ledger as ledgers
from tribolab.campaign.store.ledger import MARKER, Ledger
from tribolab.core.errors import ConfigError, TribolabError

RUN = "data/sb-r_dry_31N_01.nc"


@pytest.fixture
def campaign(two_runs, tmp_path):
    return copied(two_runs, tmp_path)


def run(campaign):
    return run_campaign(campaign, jobs=1, figures="none")


def noticed(results: Path, name: str) -> bool:
    """Whether the next run does not believe a file."""
    ledger = Ledger.read(results)
    damaged = ledger.damaged(ledger.intact())
    return name in damaged or not ledger.files  # a marker of which nothing is left is refused


@pytest.mark.parametrize("name", KINDS)
def test_eighty_random_corruptions_of_each_kind_of_file_are_noticed(campaign, name):
    results, random = campaign.parent / "results", np.random.default_rng(KINDS.index(name))
    for path in list(results.rglob("*")):  # few, so that 80 checks are quick
        inside = path.relative_to(results).as_posix()
        if path.is_file() and inside not in KINDS:
            path.unlink()
    Ledger(results).write(results)
    whole = (results / name).read_bytes()
    believed = []
    for number in range(80):
        (results / name).write_bytes(whole)
        spoil(results / name, random)
        if not noticed(results, name):
            believed.append(number)
    assert believed == []


def test_a_large_file_is_known_by_size_time_inode_and_samples(tmp_path, monkeypatch):
    monkeypatch.setattr(ledgers, "ALWAYS_READ", ledgers.SAMPLE)
    path = tmp_path / "large.nc"
    path.write_bytes(np.random.default_rng(0).bytes(4_000_000))
    Ledger(tmp_path).write(tmp_path)
    state, content = path.stat(), bytearray(path.read_bytes())
    content[100_000] ^= 1  # between two samples
    path.write_bytes(content)
    assert not Ledger.read(tmp_path).is_ours("large.nc")  # by its time
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
    assert Ledger.read(tmp_path).is_ours("large.nc")
    assert not Ledger.read(tmp_path).is_ours("large.nc", whole=True)
    content[10] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
    assert not Ledger.read(tmp_path).is_ours("large.nc")


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_what_is_damaged_is_named_and_computed_again_from_the_raw_files(campaign, name):
    results = campaign.parent / "results"
    tables = {p.name: p.read_text("utf-8") for p in (results / "tables").glob("*.csv")}
    content = bytearray((results / name).read_bytes())
    content[len(content) // 2] ^= 4
    state = (results / name).stat()
    (results / name).write_bytes(content)
    os.utime(results / name, ns=(state.st_atime_ns, state.st_mtime_ns))
    assert [text.split(":")[0] for text in problems(results)][:1] == [name]
    outcome = run(campaign)
    assert name in outcome.damaged and problems(results) == []
    assert tables == {n: (results / "tables" / n).read_text("utf-8") for n in tables}
    if name != MARKER:
        stem = Path(name).stem
        [beside] = [n for n in outcome.foreign if Path(n).name.startswith(f"{stem}.changed-")]
        assert (results / beside).read_bytes() == bytes(content)
    assert run(campaign).damaged == ()


@pytest.mark.slow
def test_results_with_figures_are_the_same_when_computed_again(campaign):
    run_campaign(campaign, jobs=1, figures="curves")
    assert list((campaign.parent / "results/figures").glob("*.svg"))
    assert recomputed(campaign.parent / "results", jobs=1) == []


@pytest.mark.slow
def test_a_forged_table_with_a_matching_marker_is_told_by_recomputing_alone(campaign):
    results = campaign.parent / "results"
    assert recomputed(results, jobs=1) == []
    table = results / "tables/friction.csv"
    table.write_text(table.read_text("utf-8").replace("0", "1"), "utf-8")
    assert [text.split(":")[0] for text in problems(results)] == ["tables/friction.csv"]
    Ledger(results).write(results)
    assert problems(results) == []
    [told] = recomputed(results, jobs=1)
    assert told.startswith("tables/friction.csv: differs from the recomputed values, first at line")


@pytest.mark.slow
def test_a_lost_marker_is_repaired_and_what_a_person_changed_stays(campaign):
    results = campaign.parent / "results"
    with pytest.raises(ConfigError, match=r"tribolab-results exists"):
        mend(results)
    (results / MARKER).unlink()
    (results / "tables/friction.csv").write_text("mine", "utf-8")
    with pytest.raises(TribolabError, match="verify --repair"):
        run(campaign)
    done = CliRunner().invoke(cli.app, ["verify", str(results), "--repair"])
    assert done.exit_code == 0, done.output
    outcome = run(campaign)
    assert problems(results) == [] and not any(part.reused for part in outcome.runs)
    kept = [n for n in outcome.foreign if n.startswith("tables/friction.changed-")]
    assert "mine" in [(results / n).read_text("utf-8") for n in kept if n.endswith("csv")]


@pytest.mark.slow
def test_data_of_a_raw_file_that_is_empty_outlive_a_damaged_catalogue(campaign):
    results = campaign.parent / "results"
    data = (results / RUN).read_bytes()
    with (results / "catalogue.sqlite").open("ab") as file:
        file.write(b"x")
    for path in (campaign.parent / "raw").rglob("*dry*"):
        path.write_text("")
    outcome = run(campaign)
    [beside] = [n for n in outcome.foreign if n.startswith("data/sb-r_dry_31N_01.changed-")]
    assert (results / beside).read_bytes() == data


def test_a_marker_that_names_files_elsewhere_is_not_believed(tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "secret").write_text("a")
    (tmp_path / "results/a").write_text("a")
    Ledger(tmp_path / "results").write(tmp_path / "results")
    listed = json.loads((tmp_path / "results" / MARKER).read_text("utf-8"))
    listed["files"]["../secret"] = listed["files"]["a"]
    del listed["blake2b"]
    (tmp_path / "results" / MARKER).write_text(json.dumps(listed), "utf-8")
    ledger = Ledger.read(tmp_path / "results")
    assert not ledger.sound and set(ledger.files) == {"a"}


def test_a_marker_of_an_earlier_version_is_read(tmp_path):
    (tmp_path / "a").write_text("a")
    Ledger(tmp_path).write(tmp_path)
    listed = json.loads((tmp_path / MARKER).read_text("utf-8"))
    del listed["blake2b"]
    listed["files"] = {name: entry[:3] for name, entry in listed["files"].items()}
    (tmp_path / MARKER).write_text(json.dumps(listed), "utf-8")
    ledger = Ledger.read(tmp_path)
    assert ledger.sound and ledger.intact() == {"a"} and problems(tmp_path) == []
    shutil.copytree(tmp_path, tmp_path.parent / "copy")
    assert Ledger.read(tmp_path.parent / "copy").intact() == {"a"}
