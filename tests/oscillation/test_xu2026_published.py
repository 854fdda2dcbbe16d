"""The paper's numbers travel with the package, and each gets the verdict that computing gives."""

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.core.errors import AnalysisError, ReadError
from tribolab.studies import xu2026
from tribolab.studies.comparison import compare_with_paper
from tribolab.studies.published import Published, find_published, read_published
from tribolab.studies.verdict import (
    BY_CONSTRUCTION,
    DIFFERS,
    INCONSISTENT,
    MEASURED,
    REPRODUCED,
    WIDE,
    Computed,
    Measured,
    Own,
    verdict_on,
)


@pytest.fixture(scope="module")
def compared():
    return compare_with_paper()


def rows(compared, quantity, condition=""):
    chosen = compared[compared.quantity == quantity]
    return chosen[chosen.condition.str.contains(condition, regex=False)]


def printed(text, unit="1", quantity="number"):
    return Published(quantity, "", "", text, unit, "", "", "")


def test_shipped_numbers_are_the_reference_ones(shared):
    path = Path(xu2026.__file__).with_name("xu2026_published.csv")
    assert path.read_text(encoding="utf-8") == (shared / "targets.csv").read_text(encoding="utf-8")
    assert len(xu2026.published) == len(pd.read_csv(shared / "targets.csv"))


def test_contact_is_the_papers():
    assert xu2026.contact.effective_modulus == xu2026.system.effective_modulus
    assert xu2026.contact.load("31 N") == 310.0


@pytest.mark.parametrize(
    ("text", "unit", "si", "last", "relation"),
    [
        ("0.0692", "1", 0.0692, 1e-4, ""),
        ("37", "mm", 0.037, 1e-3, ""),
        ("about 8 %", "1", 0.08, 0.01, "about"),
        ("1.75 to 1.95", "1", 1.85, 0.01, ""),
        ("below 1e-9", "m/s", 1e-9, 1e-9, "below"),
        ("> 0", "mJ/m2", 0.0, 1e-3, ">"),
        ("15.76", "um", 15.76e-6, 1e-8, ""),
    ],
)
def test_printed_text_is_read_as_it_is_meant(text, unit, si, last, relation):
    number = printed(text, unit)
    assert number.si == pytest.approx(si)
    assert number.last_digit == pytest.approx(last)
    assert number.relation == relation


def test_what_is_no_number_is_refused(tmp_path):
    with pytest.raises(ReadError, match="'many' in 'mm' is no number"):
        printed("many", "mm")
    with pytest.raises(ReadError, match="furlong"):
        printed("3", "furlong")
    file = tmp_path / "numbers.csv"
    file.write_text("quantity,surface,condition,published,unit,where,kind,note\na,b,c,1,m,,,\n")
    with pytest.raises(ReadError, match="published a"):
        read_published(file)
    with pytest.raises(AnalysisError, match="0 published numbers for rms_slope, Sb-X"):
        find_published(xu2026.published, "rms_slope", "Sb-X")


@pytest.mark.slow
def test_every_number_has_its_row(compared, shared):
    targets = pd.read_csv(shared / "targets.csv")
    columns = ["quantity", "surface", "condition"]
    assert compared[columns].values.tolist() == targets[columns].values.tolist()
    assert (compared.note.str.len() + compared.computed.str.len() > 0).all()
    with pytest.raises(AnalysisError, match="did you mean 'rms_slope'"):
        compare_with_paper([printed("1", quantity="rms_slopes")])


def test_only_what_was_measured_is_not_computed(compared):
    empty = compared[compared.computed == ""]
    assert set(empty.quantity) == {"shear_stress", "effective_shear_stress_ratio"}
    assert set(empty.status) == {MEASURED, INCONSISTENT}
    assert empty.relative_difference.isna().all()
    assert empty.note.str.contains("not public").all()


def test_lubrication_gives_what_the_paper_prints(compared):
    for quantity, status in (
        ("percolation_separation", WIDE),  # printed with one digit
        ("boundary_onset_speed", WIDE),  # by one of two definitions
        ("corrected_shear_stress", BY_CONSTRUCTION),
    ):
        [row] = rows(compared, quantity).itertuples()
        assert row.status == status, row
    assert "0.079 to 0.12" in rows(compared, "percolation_separation").iloc[0].note


def test_the_shear_stress_that_its_own_ratio_excludes_is_found(compared):
    stresses = rows(compared, "shear_stress")
    wrong = stresses[stresses.status == INCONSISTENT]
    assert wrong[["surface", "condition"]].values.tolist() == [["Sb-R", "2110 N/m"]]
    assert "2.01 to 2.12, not 1.75 to 1.95" in wrong.note.iloc[0]
    assert "at 2110 N/m" in rows(compared, "corrected_shear_stress_ratio").note.iloc[0]


@pytest.mark.parametrize(
    ("quantity", "condition", "count", "tolerance", "status"),
    [
        ("contact_area_ratio", "0.042 MPa; no adhesion", 3, 0.01, REPRODUCED),
        ("contact_area_ratio", "0.1 MPa; no adhesion", 2, 0.01, BY_CONSTRUCTION),
        ("contact_area_ratio", "adhesion in glycerol", 5, 0.03, BY_CONSTRUCTION),
        ("contact_area_ratio", "adhesion dry", 3, 0.03, BY_CONSTRUCTION),
        ("area_enhancement", "", 5, 0.03, BY_CONSTRUCTION),
        ("hertz_max_pressure", "", 1, 0.005, REPRODUCED),
        ("hertz_contact_width", "", 1, 0.005, REPRODUCED),
        ("contact_max_pressure", "", 2, 0.015, REPRODUCED),
        ("contact_width", "", 2, 0.025, BY_CONSTRUCTION),
        ("rms_roughness", "", 3, 0.005, BY_CONSTRUCTION),
        ("rms_slope", "", 3, 0.005, BY_CONSTRUCTION),
        ("work_of_adhesion", "", 2, 0.01, REPRODUCED),
    ],
)
def test_published_numbers_come_out_within_their_tolerance(
    compared, quantity, condition, count, tolerance, status
):
    found = rows(compared, quantity, condition)
    assert len(found) == count
    assert (found.tolerance == tolerance).all()
    assert (found.relative_difference.abs() <= tolerance).all(), found.to_string()
    assert (found.status == status).all()
    assert found.note.str.contains("by construction").eq(status == BY_CONSTRUCTION).all()


def test_only_smooth_has_a_pull_off_force(compared):
    found = rows(compared, "macroscopic_work_of_adhesion")
    assert (found.status == REPRODUCED).all()
    smooth, *sandblasted = found.computed
    assert float(smooth.split()[0]) > 1
    assert sandblasted == ["0 mJ/m2"] * 2


def test_misprints_are_found_by_computing(compared):
    wrong = compared[compared.status == INCONSISTENT]
    assert set(wrong.quantity) == {
        "nominal_pressure",  # 0.072 for 0.0714 MPa
        "half_width_no_adhesion",
        "half_width_with_adhesion",
        "separation_decay_alpha",
        "dry_over_glycerol_area",
        "shear_stress",  # 0.98 MPa
        "corrected_shear_stress_ratio",
    }
    assert list(wrong[wrong.quantity == "nominal_pressure"].published) == ["0.072 MPa"]
    width = rows(compared, "half_width_with_adhesion").iloc[0]
    assert width.computed == "4.044 mm" and "10 times the computed one" in width.note
    assert "reciprocal" in rows(compared, "separation_decay_alpha").iloc[0].note
    assert "0.1313/0.119" in rows(compared, "dry_over_glycerol_area").iloc[0].note


def test_verdicts_do_not_read_the_remarks(compared):
    """With the reader's remarks exchanged for nonsense every verdict is the same."""
    blind = [replace(row, kind="computed", note="a fine number") for row in xu2026.published[:8]]
    assert compare_with_paper(blind).status.tolist() == compared.status[:8].tolist()


def test_a_mended_number_is_reproduced():
    [row] = [row for row in xu2026.published if row.quantity == "half_width_no_adhesion"]
    mended = compare_with_paper([replace(row, text="3.7")])
    assert mended.status.tolist() == [REPRODUCED]


@settings(deadline=None, derandomize=True, max_examples=60)
@given(st.floats(0.01, 900), st.sampled_from([1.03, 1.2, 2.0, 0.5]))
def test_what_merely_differs_is_not_called_a_misprint(value, ratio):
    number = printed(f"{value:.4f}")
    far = Computed(number.si * ratio, 0.01)
    verdict = verdict_on(number, far).status
    reciprocal = abs(1 / far.value / number.si - 1) < 0.02
    assert verdict == DIFFERS or reciprocal or value < 0.1


def test_agreement_that_needs_much_room_is_not_called_reproduced():
    number = printed("0.500")
    assert verdict_on(number, Computed(0.504, 0.1)).status == REPRODUCED
    far = verdict_on(number, Computed(0.53, 0.1))
    assert far.status == WIDE and "only within 10 %" in far.note
    assert verdict_on(number, Computed(0.57, 0.1)).status == DIFFERS
    assert verdict_on(printed("0.042"), Computed(0.04248, 0.001)).status == REPRODUCED  # last digit
    assert verdict_on(printed("0.2"), Computed(0.24, 0.001)).status == WIDE  # one digit says little
    assert verdict_on(printed("at most 0.1"), Computed(0.15, 1.0)).status == WIDE


def test_what_was_put_in_agrees_by_construction_and_may_still_be_missed():
    number, given = printed("0.500"), "an input was chosen for it"
    found = verdict_on(number, Computed(0.501, 0.01, given=given))
    assert found.status == BY_CONSTRUCTION and given in found.note
    assert verdict_on(number, Computed(0.6, 0.01, given=given)).status == DIFFERS
    contradicted = verdict_on(
        number, Computed(0.501, 0.01, given=given), Own(0.6, 0.7, "it is not")
    )
    assert contradicted.status == INCONSISTENT


def test_other_numbers_of_the_paper_outweigh_agreement():
    number, computed = printed("0.50"), Computed(0.5, 0.01)
    assert verdict_on(number, computed).status == REPRODUCED
    assert verdict_on(number, computed, Own(0.49, 0.60, "fits")).status == REPRODUCED
    assert verdict_on(number, computed, Own(0.55, 0.60, "it is not")).status == INCONSISTENT


def test_ranges_are_judged_as_ranges():
    number = printed("1.75 to 1.95")
    assert number.ends == (1.75, 1.95)
    assert verdict_on(number, Computed(1.99, 0.0, low=1.9, high=2.1)).status == REPRODUCED
    assert verdict_on(number, Computed(2.2, 0.0, low=2.1, high=2.3)).status == DIFFERS
    assert verdict_on(number, Computed(1.8, 0.0), Own(1.94, 2.1, "")).status == REPRODUCED
    assert verdict_on(number, Computed(1.8, 0.0), Own(2.0, 2.1, "not so")).status == INCONSISTENT
    assert verdict_on(number, Measured("seen")) == (MEASURED, "seen")


def test_bounds_are_judged_as_bounds():
    assert verdict_on(printed("> 0"), Computed(1e-3, 0.0)).status == REPRODUCED
    assert verdict_on(printed("> 0"), Computed(0.0, 0.0)).status == DIFFERS
    assert verdict_on(printed("at most 0.1"), Computed(0.05, 0.0)).status == REPRODUCED
    assert verdict_on(printed("at most 0.1"), Computed(1.0, 0.0)).status == DIFFERS
