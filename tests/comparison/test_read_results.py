"""Results come back as they were, and no cell of theirs does anything in a spreadsheet."""

import csv

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from report_pages import RUNS
from reporting import made_outcome

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.core.provenance import escape_controls
from tribolab.friction.joined import joined_curves
from tribolab.report import tables
from tribolab.report.results import write_report


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    failed = [("broken", "bad.csv: column 'Fx' has no unit")]
    outcome = made_outcome(tmp_path_factory.mktemp("made"), RUNS, failed=failed, samples=40)
    write_report(outcome, figures="none")
    return tl.read_results(outcome.folder)


HOSTILE = ["=1+1", "+cmd|'/c calc'!A0", "-x", "@SUM(A1)", "\t=1", "'quoted", "''", "＝1"]


def test_no_cell_begins_like_a_formula_and_all_come_back(tmp_path):
    table = pd.DataFrame({"run": HOSTILE, "=mu": [-0.5, 1, 2, 3, 4, 5, 6, 7], "text": "sb-r"})
    (tmp_path / "tables").mkdir()
    tables.write_csv(table, tmp_path / "tables" / "runs.csv")
    with (tmp_path / "tables" / "runs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert not any(cell.startswith(("=", "+", "@", "\t", "＝")) for row in rows for cell in row)
    assert rows[1][1] == "-0.5"  # a number stays one
    back = tl.read_results(tmp_path)
    assert list(back) == ["runs"]
    pd.testing.assert_frame_equal(back["runs"], table)


@given(st.text(st.characters(codec="utf-8", exclude_characters="\r\0"), min_size=1))
def test_what_is_made_harmless_is_undone(text):
    # control characters stay escaped: they would steer a terminal
    assert tables.as_it_was(tables.uncomputed(text)) == escape_controls(text)


def test_what_is_no_folder_of_results_says_so(tmp_path):
    with pytest.raises(ReadError, match="no folder of results"):
        tl.read_results(tmp_path)
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "friction.csv").write_text("run\na\n")
    with pytest.raises(ReadError, match="did you mean 'friction'"):
        tl.read_results(tmp_path)["fricton"]
    with pytest.raises(ReadError, match="no data of 'x'"):
        tl.read_results(tmp_path).data("x")


def test_all_runs_come_back_at_once_each_with_what_it_is(results):
    runs = results.runs()
    assert runs.run.values.tolist() == [name for name, *_ in RUNS]  # not the one that failed
    assert runs.surface.values.tolist() == [surface for _, surface, *_ in RUNS]
    for number, (name, _, medium, load, _) in enumerate(RUNS):
        one, alone = runs.sel(run=name), results.data(f"run{number}", "friction")
        count = alone.sizes["segment"]
        assert (one.medium, one.nominal_normal_force) == (medium, load)
        assert one.friction_coefficient[:count].values.tolist() == (
            alone.friction_coefficient.values.tolist()
        )
        assert one.friction_coefficient[count:].isnull().all()
        assert one.friction_coefficient.attrs == alone.friction_coefficient.attrs
    dry = runs.groupby("medium").mean().friction_coefficient.sel(medium="dry")
    assert dry.mean() == pytest.approx(runs.friction_coefficient.sel(run="sb-s_1").mean().item())
    assert (tl.variables(results.runs("stick_slip")).unit[["drop", "periods"]] == "1").all()
    assert results.runs("stick_slip").waveform.dims == ("run", "segment")
    with pytest.raises(ReadError, match="did you mean 'segments'"):
        results.runs("segment")


def test_curves_are_selected_by_surface_medium_and_load(results):
    curves = results.curves()
    dims = {"surface": 2, "medium": 2, "normal_force": 1, "sliding_speed": 3}
    assert dict(curves.sizes) == dims
    one = curves.sel(surface="Sb-S", medium="dry", normal_force=31)
    alone = results.data("curve1")
    assert (alone.attrs["surface"], alone.attrs["medium"]) == ("Sb-S", "dry")
    np.testing.assert_array_equal(one.friction_coefficient, alone.friction_coefficient)
    np.testing.assert_array_equal(one.measured_speed, alone.sliding_speed)
    assert curves.friction_coefficient.sel(surface="Sb-R", medium="dry").isnull().all()
    drawn = tl.plot.figure_data(tl.plot.stribeck(curves))
    assert set(drawn.series) == {"Sb-R, glycerol", "Sb-S, dry", "Sb-S, glycerol"}
    runs = tl.plot.figure_data(tl.plot.stribeck(results.runs()))
    assert set(runs.series) == set(drawn.series) and len(runs) > len(drawn)


def test_speeds_of_one_curve_stay_apart_however_near_those_of_another_lie():
    rows = [([1.00e-3, 1.08e-3], "dry"), ([1.04e-3, 1e-2], "wet")]
    curves = joined_curves(
        [
            (
                xr.Dataset({"half_loop": ("sliding_speed", v)}, {"sliding_speed": v}),
                {"medium": m, "normal_force": np.nan},
            )
            for v, m in rows
        ]
    )
    for v, medium in rows:
        assert sorted(curves.half_loop.sel(medium=medium).dropna("sliding_speed").squeeze()) == v
