"""The catalogue: what goes in comes out; what is damaged is not known; files are known again."""

import os
import time
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tribolab.campaign.store import new_catalogue
from tribolab.campaign.store.catalogue import CATALOGUE, Catalogue
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.errors import OutputError
from tribolab.core.provenance import sha256_of_file
from tribolab.records.models.mode_record import EvidenceRow, ModeRecord
from tribolab.records.part_records import (
    CurveRecord,
    FigureRecord,
    ModelRecord,
    ModelRows,
    SurfaceRecord,
    SurfaceRows,
)
from tribolab.records.parts import (
    CurveOutcome,
    Finding,
    FlaggedSpan,
    ModelOutcome,
    Notice,
    PageTrace,
    RunOutcome,
    RunZero,
    SurfaceOutcome,
)
from tribolab.records.runs.run_record import (
    CheckRow,
    Highlight,
    LeftOut,
    RunFacts,
    RunRecord,
    Waveform,
)

ROW = {"segment": 1, "sliding_speed_m_s": 1 / 3, "steady": "yes", "pair": None, "fine": True}
SYSTEM = {"surface": "S", "medium": "wet"}
RUN = RunRecord(
    RunOutcome(
        **{"name": "ä", "files": ("raw/ä.csv",), **SYSTEM, "normal_force": None},
        status="done",
        data_file="data/a.nc",
        segments=2,
    ),
    (("raw/ä.csv", "ab" * 32, 9),),
    RunZero("slider", 0.1, None),
    RunFacts(
        quantity="friction_coefficient",
        value_min=1e-300,
        stick_slip=Waveform("smooth sliding", ""),
        position_range_m=(0.1, 0.2),
        checks=(CheckRow("spikes", "pass", "friction_force", "none", None, ""),),
        highlights=(Highlight("all", None, 0.1 + 0.2, None, 2e-17, 4e-17, 3),),
        omitted=(LeftOut("at rest", 2, 1.5),),
        segments=(ROW,),
        flagged=(FlaggedSpan("friction_force", "fail", 0.0, 1.0, ("spikes",)),),
    ),
    (Notice("note", "ä", "columns", "not used: T"),),
    (ROW,),
)
PARTS = [
    RUN,
    CurveRecord(CurveOutcome("c", "S", "dry", 31.0, "", ("ä",), "failed", "none"), (ROW,), (0.9,)),
    SurfaceRecord(
        SurfaceOutcome(
            name="S", files=("s.csv",), status="done", findings=(Finding("note", "x", "tip"),)
        ),
        (("s.csv", "", 0),),
        SurfaceRows("S", ROW, (ROW,), (), "stand-in", "pass"),
    ),
    ModelRecord(
        ModelOutcome(name="m", curve="c", **SYSTEM, normal_force=None, status="skipped"),
        ModelRows(None, (ROW,)),
    ),
    ModelRecord(
        ModelOutcome(
            name="m", curve="c", **SYSTEM, normal_force=31.0, status="done", parts=("curve",)
        ),
        ModelRows(ROW, (), (ROW,), "T", (ROW,), (-0.1, 0.2)),
    ),
    FigureRecord("figures/a.svg", "", "A.", "µ from 0.1", "curve"),
    ModeRecord(
        curve="c",
        condition="dry",
        verdict="not known",
        text="t",
        paragraph="p",
        decide=("d",),
        evidence=(EvidenceRow("for", "t", "x"),),
        numbers={"a": 1.5, "b": None},
        segments=1,
        segments_oscillating=0,
        scaling="none",
        scaling_exponent=None,
        scaling_error=0.1,
        speeds=(ROW,),
        moves=False,
    ),
]


@pytest.fixture
def store(tmp_path):
    made = Store(tmp_path)
    (tmp_path / "data").mkdir()
    (tmp_path / "figures").mkdir()
    (tmp_path / "data/a.nc").write_bytes(b"signals")
    (tmp_path / "figures/a.svg").write_bytes(b"<svg/>")
    yield made
    made.close()


@pytest.mark.parametrize("record", PARTS, ids=lambda record: type(record).__name__)
def test_every_record_comes_back_as_it_was(store, record):
    store.put("part", "a", 0, "made so", record)
    assert store.get("part", "a", type(record)) == ("a", "made so", record)
    store.save()
    assert list(Catalogue.of(store.folder).all("part", type(record))) == [("a", "made so", record)]
    outcome = getattr(record, "outcome", None)
    if outcome is not None:
        assert store.outcomes("part", type(outcome)) == [outcome]


@given(value=st.floats(allow_nan=False, allow_infinity=False), text=st.text())
def test_numbers_and_words_keep_every_digit(tmp_path_factory, value, text):
    text = text.encode("utf-8", "ignore").decode()
    store = Store(tmp_path_factory.mktemp("store"))
    record = CurveRecord(CurveOutcome("c", text, "", value, "", ()), ({"x": value, "t": text},))
    store.put("curve", "c", 0, "", record)
    assert store.get("curve", "c", CurveRecord).record == record
    store.close()


def test_parts_stand_in_their_order_and_what_is_not_named_goes(store):
    for place, name in enumerate("dbca"):
        store.put("run", name, place, name, RUN, PageTrace(name, ""))
    assert [entry.name for entry in store.all("run", RunRecord)] == list("dbca")
    store.order("run", "acd")
    assert [entry.name for entry in store.all("run", RunRecord)] == list("acd")
    assert store.fingerprints("run") == {name: name for name in "acd"}
    assert store.trace("run", "b") is None and store.trace("run", "d") == PageTrace("d", "")


def test_a_catalogue_that_is_gone_damaged_or_of_another_format_knows_nothing(store, tmp_path):
    store.put("run", "a", 0, "", RUN)
    store.save()
    assert Catalogue.of(tmp_path).get("run", "a", RunRecord).record == RUN
    whole = (tmp_path / CATALOGUE).read_bytes()
    store.say("format", "another")
    store._new.execute("COMMIT")
    other = (tmp_path / CATALOGUE).read_bytes()
    store._new.execute("BEGIN")
    spoilt = tmp_path / "spoilt"
    spoilt.mkdir()
    for content in (other, b"", b"no database" * 100, whole[: len(whole) // 2], whole[:5000]):
        (spoilt / CATALOGUE).write_bytes(content)
        known = Catalogue.of(spoilt)
        assert known.get("run", "a", RunRecord) is None
        assert known.outcomes("run", RunOutcome) == [] and known.files() == {}
        assert known.trace("run", "a") is None and known.fact("format") in ("", "1")
        known.close()
    assert Catalogue.of(tmp_path / "nowhere").get("run", "a", RunRecord) is None


def test_a_record_of_another_shape_is_not_known(store):
    store.put("run", "a", 0, "", PARTS[1])
    store.put("run", "b", 1, "", RUN)
    assert [entry.name for entry in store.all("run", RunRecord)] == ["b"]
    store._new.execute("UPDATE part SET record=?", (b"torn",))
    assert store.get("run", "b", RunRecord) is None


# data files


def test_a_data_file_is_taken_over_only_as_it_was_written(store, tmp_path):
    store.put("run", "a", 0, "", RUN)
    store.save()
    new = tmp_path / "new"
    new.mkdir()
    later = Store(new, tmp_path)
    assert later.link("run", "a", "data/a.nc", "data/b.nc")
    assert (new / "data/b.nc").samefile(tmp_path / "data/a.nc")
    (tmp_path / "data/a.nc").unlink()
    assert not later.link("run", "a", "data/a.nc", "data/c.nc")
    (tmp_path / "data/a.nc").write_bytes(b"another")  # as long, but of another time
    assert not later.link("run", "a", "data/a.nc", "data/c.nc")
    later.close()


# raw files


def old(path, content, age=60):
    path.write_bytes(content)
    os.utime(path, (time.time() - age,) * 2)
    return path


@pytest.fixture
def read(monkeypatch):
    """Names of the files that are read for their checksums."""
    names = []

    def checksum(path):
        names.append(path.name)
        return sha256_of_file(path)

    monkeypatch.setattr("tribolab.campaign.store.new_catalogue.sha256_of_file", checksum)
    return names


def passed_on(first, folder, **options):
    """Close a store, and open the one of the next results."""
    first.close()
    folder.mkdir(exist_ok=True)
    return Store(folder, first.folder, **options)


def test_a_file_is_known_by_size_time_and_inode_without_reading_it(tmp_path, read):
    raw = [(old(tmp_path / f"{n}.csv", b"t,F\n%d" % n), f"raw/{n}.csv") for n in range(3)]
    (tmp_path / "0").mkdir()
    store = Store(tmp_path / "0")
    sources = store.sources(raw)
    assert sorted(read) == ["0.csv", "1.csv", "2.csv"]
    assert [source[:1] + source[2:] for source in sources] == [(n, 5) for _, n in raw]
    store = passed_on(store, tmp_path / "1")
    assert store.sources(raw) == sources and len(read) == 3
    store = passed_on(store, tmp_path / "2")  # what is known is passed on
    assert store.sources(raw) == sources and len(read) == 3

    del read[:]
    os.utime(raw[0][0], (1e9, 1e9))  # touched
    again = tmp_path / "again.csv"
    again.write_bytes(raw[1][0].read_bytes())
    state = raw[1][0].stat()
    os.utime(again, ns=(state.st_atime_ns, state.st_mtime_ns))
    again.replace(raw[1][0])  # another file of the same size and time
    store = passed_on(store, tmp_path / "3")
    assert store.sources(raw) == sources and sorted(read) == ["0.csv", "1.csv"]
    store = passed_on(store, tmp_path / "4", verify=True)
    assert store.sources(raw) == sources and len(read) == 5
    store.close()


def test_a_file_that_changed_while_it_was_read_or_just_before_is_read_again(tmp_path, read):
    file = old(tmp_path / "a.csv", b"1", age=0)
    (tmp_path / "0").mkdir()
    store = Store(tmp_path / "0")
    began = time.time_ns()
    [source] = store.sources([(file, "a")])
    store.note_sources([(file, source)], began)
    store = passed_on(store, tmp_path / "1")
    assert store.before.files() == {}
    [again] = store.sources([(file, "a")])
    assert again == source and len(read) == 2
    # noted as read before an edit that left another size
    old(file, b"22")
    store.note_sources([(file, source)], time.time_ns())
    store = passed_on(store, tmp_path / "2")
    assert store.before.files() == {}
    store.close()


def test_a_file_that_cannot_be_read_has_no_checksum(tmp_path, read):
    store = Store(tmp_path)
    assert store.sources([(tmp_path / "gone.csv", "raw/gone.csv")]) == (("raw/gone.csv", "", 0),)
    store.close()


def test_a_run_of_thousands_of_cycles_is_read_back_and_a_larger_one_is_refused(store, monkeypatch):
    rows = tuple(ROW | {"segment": number, "note": "x" * 400} for number in range(40_000))
    long = replace(RUN, facts=replace(RUN.facts, segments=rows))  # 20 MB
    store.put("run", "ä", 0, "f", long)
    assert store.get("run", "ä", RunRecord).record == long
    monkeypatch.setattr(new_catalogue, "MAX_RECORD", 1 << 24)
    with pytest.raises(OutputError, match="run ä: its record of .* exceeds .* 16 MB"):
        store.put("run", "ä", 0, "f", long)
