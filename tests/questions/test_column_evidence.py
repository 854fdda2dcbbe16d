"""Each rule of evidence decides something: without it the same columns are taken otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from tribolab.reading.interpret.names import matches
from tribolab.reading.text.first_bytes import peek
from tribolab.reading.unknown.columns import evidence, text_evidence
from tribolab.reading.unknown.columns.decide import decide
from tribolab.reading.unknown.columns.evidence import Facts, Rule
from tribolab.reading.unknown.columns.labels import bare_name, labelled
from tribolab.reading.unknown.columns.motion_evidence import MOTION_RULES
from tribolab.reading.unknown.columns.text_evidence import (
    legend_evidence,
    mean_coefficient_evidence,
    stated_load_evidence,
)
from tribolab.reading.unknown.layout.text_layout import Layout, find_layout
from tribolab.reading.unknown.model import DraftColumn

RULES = (*evidence.RULES, *MOTION_RULES)
N = 60
T = np.arange(N) / 10
TURNS = np.sign(np.sin(T))
BACK_AND_FORTH = 5 * np.sin(T)
TEXT_RULES = ("legend_evidence", "stated_load_evidence", "mean_coefficient_evidence")


def decided(
    folder: Path, above: str, columns: dict[str, np.ndarray], without: str = ""
) -> list[DraftColumn]:
    numbers = np.column_stack([np.broadcast_to(x, N) for x in columns.values()]).astype(float)
    rows = "\n".join("\t".join(f"{x:.6g}" for x in row) for row in numbers)
    file = folder / "a.txt"
    file.write_text(f"{above}\n" * bool(above) + "\t".join(columns) + f"\n{rows}\n")
    layout = find_layout(peek(file))
    found = labelled(layout)
    bare = [bare_name(column) for column in found]
    options = [matches(name, unit) for name, unit, _ in bare]
    return decide(Facts(found, bare, options, numbers, "run"), _rules(layout, without))


def _rules(layout: Layout, without: str) -> Sequence[Rule]:
    by_text = {
        "legend_evidence": legend_evidence(layout),
        "stated_load_evidence": stated_load_evidence(layout),
        "mean_coefficient_evidence": mean_coefficient_evidence(layout),
    }
    general = [rule for rule in RULES if rule.__name__ != without]
    return [*general, *(rule for name, rule in by_text.items() if name != without)]


CASES = {
    "name_evidence": ("", {"Time [s]": T, "Friction force [N]": TURNS}),
    "role_evidence": (
        "",
        {"Load setpoint [N]": T, "Load [N]": 5 + 0.1 * T, "Actual load [N]": 5 + T},
    ),
    "repeated_name_evidence": ("", {"Fx [N]": TURNS, "Load [N]": 5.0, "Fx [N] ": TURNS}),
    "number_evidence": ("", {"t": BACK_AND_FORTH, "Fx [N]": TURNS}),
    "advance_evidence": ("", {"Step time": 60.0, "Test time": T, "Fx [N]": TURNS}),
    "size_evidence": ("", {"Fx [N]": 0.1 * TURNS, "Ft [N]": 0.0 * T, "Fr [N]": 3 * TURNS}),
    "rectified_evidence": ("", {"Ff [N]": abs(TURNS), "Fx [N]": TURNS}),
    "direction_evidence": (
        "",
        {"Y [mm]": 5 * np.cos(3 * T), "Fx [N]": np.sign(np.sin(3 * T))},
    ),
    "row_count_evidence": ("", {"n": np.arange(N), "Fx [N]": TURNS}),
    "distance_evidence": ("", {"Position [mm]": BACK_AND_FORTH, "Sliding distance [mm]": T}),
    "motion_evidence": ("", {"LVDT [mm]": 0.1 * T, "Speed [mm/s]": 5.0, "Fx [N]": TURNS}),
    "torque_evidence": ("", {"Torque [N m]": TURNS, "Load cell [N]": 5.0}),
    "stroke_setting_evidence": ("", {"Stroke [mm]": 5.0, "Frequency [Hz]": 2.0, "Fx [N]": TURNS}),
    "stage_axis_evidence": (
        "",
        {"Stage.X [mm]": 0 * T + 3, "Rotation [rpm]": 60.0, "Fx [N]": TURNS},
    ),
    "rotation_evidence": (
        "",
        {"Position [mm]": T**2, "Rotation speed [rpm]": 60.0, "Fx [N]": TURNS},
    ),
    "legend_evidence": ("Fx = vertical; Fz = tangential", {"Fx [N]": 5.0, "Fz [N]": TURNS}),
    "stated_load_evidence": ("Load: 20 N", {"Force [N]": 6 * TURNS, "Speed [mm/s]": 5.0}),
    "mean_coefficient_evidence": (
        "Load: 20 N",
        {"Friction [N]": TURNS, "Mean COF [-]": 0.05},
    ),
}


@pytest.mark.parametrize("rule", CASES)
def test_a_rule_changes_what_is_decided(rule: str, tmp_path: Path) -> None:
    assert decided(tmp_path, *CASES[rule]) != decided(tmp_path, *CASES[rule], without=rule)


def test_every_rule_has_a_case() -> None:
    assert set(CASES) == {rule.__name__ for rule in RULES} | set(TEXT_RULES)
    assert all(hasattr(text_evidence, name) for name in TEXT_RULES)


@pytest.mark.parametrize("rule", CASES)
def test_the_order_of_rules_does_not_matter(
    rule: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    forwards = decided(tmp_path, *CASES[rule])
    monkeypatch.setattr(f"{__name__}.RULES", RULES[::-1])
    assert decided(tmp_path, *CASES[rule]) == forwards


def test_names_are_tried_together_and_not_one_after_the_other(tmp_path: Path) -> None:
    # either cell may be either force; the one that is named leaves the other to the second
    columns = decided(tmp_path, "", {"Load cell [N]": TURNS, "Normal force [N]": 5 + 0.1 * T})
    assert [column.quantity for column in columns] == ["friction_force", "normal_force"]
    assert not columns[0].guessed and columns[0].used
    assert evidence.NEAR < 0.1


def test_the_load_of_a_testing_machine_may_be_the_friction(tmp_path: Path) -> None:
    _, load = decided(tmp_path, "", {"Extension (mm)": T, "Load (N)": 2 + TURNS})
    assert load.guessed and "friction_force" in load.options
    _, load, _ = decided(tmp_path, "", {"Position (mm)": T, "Load (N)": 5.0, "Fx [N]": TURNS})
    assert load.quantity == "normal_force" and not load.guessed
