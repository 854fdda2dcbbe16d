"""Results come back as they were, and no cell of theirs does anything in a spreadsheet."""

import csv

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tribolab as tl
from tribolab.errors import ReadError
from tribolab.report import tables

HOSTILE = ["=1+1", "+cmd|'/c calc'!A0", "-x", "@SUM(A1)", "\t=1", "'quoted", "''", "＝1"]


def test_no_cell_begins_like_a_formula_and_all_come_back(tmp_path):
    table = pd.DataFrame({"run": HOSTILE, "=mu": [-0.5, 1, 2, 3, 4, 5, 6, 7], "text": "sb-r"})
    (tmp_path / "tables").mkdir()
    tables.write(table, tmp_path / "tables" / "runs.csv")
    with (tmp_path / "tables" / "runs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert not any(cell.startswith(("=", "+", "@", "\t", "＝")) for row in rows for cell in row)
    assert rows[1][1] == "-0.5"  # a number stays one
    back = tl.read_results(tmp_path)
    assert list(back) == ["runs"]
    pd.testing.assert_frame_equal(back["runs"], table)


@given(st.text(st.characters(codec="utf-8", exclude_characters="\r\0"), min_size=1))
def test_what_is_made_harmless_is_undone(text):
    assert tables.as_it_was(tables.harmless(text)) == text


def test_what_is_no_folder_of_results_says_so(tmp_path):
    with pytest.raises(ReadError, match="no folder of results"):
        tl.read_results(tmp_path)
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "friction.csv").write_text("run\na\n")
    with pytest.raises(ReadError, match="did you mean 'friction'"):
        tl.read_results(tmp_path)["fricton"]
    with pytest.raises(ReadError, match="no data of 'x'"):
        tl.read_results(tmp_path).data("x")
