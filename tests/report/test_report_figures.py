"""Figures when asked for, taken over where nothing changed; tables twice; all from the records."""

import json
import shutil
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from campaigns import fingerprint
from report_pages import details_of, figures_of
from reporting import made_outcome

import tribolab as tl
from tribolab.app.run import run_campaign
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.errors import ConfigError
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome
from tribolab.records.runs.run_record import RunRecord
from tribolab.report.figures.choice import wanted
from tribolab.report.other_tables import write_other_tables
from tribolab.report.page_figures.curves import FrictionOverSpeed, card_figures
from tribolab.report.results import write_report
from tribolab.report.slowest import slow_segments
from tribolab.report.table_format import table_format
from tribolab.report.tables import read_csv, write_csv, write_rows

RUNS = [
    ("sb-r_1", "Sb-R", "glycerol", 31.0, 0.8),
    ("sb-s_1", "Sb-S", "glycerol", 31.0, 1.1),
    ("nameless", "", "", None, 0.5),
]
FIGURES = ("figures", "surface_figures", "model_figures", "sliding_figures")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A report with all its figures; not to be changed."""
    folder = tmp_path_factory.mktemp("made")
    outcome = made_outcome(folder, RUNS, failed=[("broken", "no unit")], samples=60)
    write_report(outcome, pdf=True)
    return outcome


def report_of(outcome):
    return json.loads((outcome.folder / "report.json").read_text("utf-8"))


def drawn(outcome):
    return [figure["file"] for key in FIGURES for figure in report_of(outcome)[key]]


def the_next(made, folder, **changes):
    """The same results, of which nothing is written yet but the data."""
    for name in ("data", "figures"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    store = Store(folder, made.folder)
    for kind, record in (("run", RunRecord), ("curve", CurveRecord)):
        for place, entry in enumerate(made.store.all(kind, record)):
            if entry.record.outcome.data_file:
                store.link_file(entry.record.outcome.data_file)
            trace = store.before.trace(kind, entry.name)
            store.put(kind, entry.name, place, entry.fingerprint, entry.record, trace)
    return replace(made, folder=folder, store=store, **changes)


@pytest.mark.slow
def test_figures_of_the_same_data_are_taken_over_and_not_drawn(made, tmp_path, monkeypatch):
    def refuse(*given, **more):
        raise AssertionError("drawn again")

    monkeypatch.setattr("tribolab.report.figures.stage.draw_figure", refuse)
    again = the_next(made, tmp_path)
    write_report(again, pdf=True)
    assert drawn(again) == drawn(made) and drawn(made)
    assert fingerprint(again.folder / "figures") == fingerprint(made.folder / "figures")


def test_figures_whose_data_changed_are_drawn_again_alone(made, tmp_path, monkeypatch):
    from tribolab.report.figures import stage as figures

    again = the_next(made, tmp_path)
    (run,) = (run for run in again.runs if run.name == "sb-s_1")
    file = again.folder / run.data_file
    content = file.read_bytes()
    file.unlink()
    file.write_bytes(content)
    done, draw = [], figures.draw_figure

    def noted(spec, folder, **more):
        done.append(spec.section)
        return draw(spec, folder, **more)

    monkeypatch.setattr(figures, "draw_figure", noted)
    write_report(again)
    assert set(done) == {"sliding"}  # which alone read the data of runs
    assert drawn(again) == drawn(made)


def test_as_many_figures_as_are_asked_for(made, tmp_path):
    kept = {}
    for which in ("all", "curves", "none"):
        outcome = the_next(made, tmp_path / which)
        write_report(outcome, figures=which)
        report = report_of(outcome)
        kept[which] = {key: len(report[key]) for key in FIGURES}
        on_disk = {path.name for path in (outcome.folder / "figures").iterdir()}
        assert {f"figures/{n}" for n in on_disk if n.endswith(".svg")} == set(drawn(outcome))
        traces = ["".join(details_of(o.folder)).count("live trace") for o in (outcome, made)]
        assert traces == [3, 3]  # of each run that is done
        assert figures_of(outcome.folder) == figures_of(made.folder) != {}
        for name in ("friction", "stribeck"):  # what a figure shows is in the tables in any case
            tables = [o.folder / f"tables/{name}.csv" for o in (outcome, made)]
            assert tables[0].read_bytes() == tables[1].read_bytes()
    assert kept["all"]["figures"] == kept["curves"]["figures"] > 3
    assert kept["all"]["sliding_figures"] > 0 == kept["curves"]["sliding_figures"]
    assert not any(kept["none"].values())


def test_every_figure_is_a_pdf_too_if_that_is_asked_for(made):
    for file in drawn(made):
        assert (made.folder / file).with_suffix(".pdf").read_bytes().startswith(b"%PDF")


def test_an_unknown_choice_of_figures_is_refused_with_those_that_there_are():
    assert [wanted(word) for word in ("all", "curves", "none")] == ["all", "curves", "none"]
    with pytest.raises(ConfigError, match="figures: 'some' is not all, curves or none"):
        wanted("some")


def test_nothing_is_read_back_to_be_shown(made, tmp_path, monkeypatch):
    again = the_next(made, tmp_path)
    # what judges a curve's sliding mode reads it: done before, it is known
    write_report(again, figures="none")
    later = the_next(again, tmp_path / "later")

    def refuse(*given, **more):
        raise AssertionError("a data file was opened to be shown")

    for name in ("read_netcdf", "read_groups"):
        monkeypatch.setattr(f"tribolab.reading.netcdf.netcdf.{name}", refuse)
    write_report(later, figures="none")
    here, before = report_of(later), report_of(made)
    for key in ("runs", "curves", "verdict", "sliding_mode"):
        assert here[key] == before[key] and here[key]
    assert not [f for f in here["findings"] if f["severity"] == "error"]


@pytest.mark.parametrize("form", ["parquet", "xlsx"])
def test_tables_in_other_formats_have_the_same_values(made, tmp_path, form):
    names = {"friction", "stribeck", "stick_slip", "static_friction", "checks"}
    assert {file.stem for file in (made.folder / "tables").glob("*.csv")} >= names
    assert not list((made.folder / "tables").glob("*.parquet"))
    for name in names:
        shutil.copy(made.folder / "tables" / f"{name}.csv", tmp_path)
    write_other_tables(tmp_path, form)
    for name in names:
        table = read_csv(tmp_path / f"{name}.csv")
        if form == "parquet":
            other = pd.read_parquet(tmp_path / f"{name}.parquet")
        else:
            sheet = pd.read_excel(tmp_path / "tables.xlsx", name, engine="openpyxl")
            units, other = sheet.iloc[0], sheet.iloc[1:].reset_index(drop=True)
            assert name != "friction" or units["normal_force_N"] == "N"
        assert list(other.columns) == list(table.columns)
        for column in table.select_dtypes(float):
            values = pd.to_numeric(other[column]).to_numpy(float)
            np.testing.assert_allclose(values, table[column].to_numpy(float), rtol=1e-14)
    with pytest.raises(ConfigError, match="xlsx"):
        table_format("xls")


def test_a_long_table_is_the_same_whole_as_in_pieces(tmp_path, monkeypatch):
    rows = [
        {"run": f"=r{n}", "n": n, "x": None if n % 5 == 2 else n / 3, "on": n % 2 == 0}
        | ({"late": "text"} if n > 6 else {})
        for n in range(23)
    ]
    write_csv(pd.DataFrame(rows), tmp_path / "whole.csv")
    monkeypatch.setattr("tribolab.report.tables._CHUNK", 4)
    write_rows(lambda: iter(rows), tmp_path / "pieces.csv", ["run"])
    assert (tmp_path / "whole.csv").read_text() == (tmp_path / "pieces.csv").read_text()
    assert read_csv(tmp_path / "pieces.csv")["run"][0] == "=r0"  # as it was
    write_rows(lambda: iter(()), tmp_path / "none.csv", ["run", "x"])
    assert (tmp_path / "none.csv").read_text() == "run,x\n"


def test_results_open_by_name_with_every_digit(made):
    results = tl.read_results(made.folder)
    rows = [r for run in report_of(made)["runs"] for r in run["segments"]]
    assert results["friction"]["friction_coefficient"].tolist() == [
        row["friction_coefficient"] for row in rows
    ]
    run = results.data("run0", "run")
    assert run.sizes["time"] == report_of(made)["runs"][0]["samples"]


def test_an_option_that_does_not_exist_is_refused_before_anything_is_read(tmp_path):
    with pytest.raises(ConfigError, match="is not all"):
        run_campaign(tmp_path / "nowhere.toml", figures="some")


def test_strokes_that_a_person_rejected_are_not_looked_at_closely():
    rows = [
        {"sliding_speed_m_s": speed, "direction": direction, "rejected": rejected}
        for speed, direction, rejected in (
            *((1e-6, 1, 1), (1e-5, -1, 0), (1e-5, 1, 0), (1.1e-5, 1, 0), (1e-4, 1, 0)),
            *((1e-3, 1, 0), (None, 1, 0)),
        )
    ]
    outcome = SimpleNamespace(done=True, data_file="data/a.nc")
    entry = SimpleNamespace(record=SimpleNamespace(outcome=outcome, slip=rows))
    store = SimpleNamespace(get=lambda kind, name, record: entry if name == "a" else None)
    curve = SimpleNamespace(run_names=("gone", "a"))
    slow = slow_segments(curve, SimpleNamespace(store=store))
    assert slow == ("a", "data/a.nc", ((2, 1e-5), (4, 1e-4)))


@pytest.mark.parametrize("surface", ["", "Sb-R"])
def test_runs_of_neither_surface_nor_medium_are_seen_at_once_whatever_their_load(surface):
    """Of a surface one load is chosen; what names nothing is of as many systems."""
    row = {"sliding_speed_m_s": 1e-3, "friction_coefficient": 0.3, "segments": 1, "runs": 1}
    row |= {"friction_coefficient_sem": 0.01, "normal_force_N": None}
    curves = [
        CurveRecord(CurveOutcome(name, surface, "", load, "a.nc", (name,)), (row,))
        for name, load in (("one", 10.0), ("two", 20.0))
    ]
    (card,) = card_figures(FrictionOverSpeed(curves, {}, {}, {}, ()))
    assert card.loads == ([10.0, 20.0] if surface else [])
    labels = [series.label for series in card.series]
    assert labels == (["measured", "measured"] if surface else ["one", "two"])
