"""Numbers that do not stand below a line of names: read, kept in a dialect, and never in part."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.errors import ReadError
from tribolab.reading.text.arrangements import (
    below_names,
    groups_beside,
    holds_names,
    listed_columns,
)
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft

RNG = np.random.default_rng(12)
FORCE = 1.2 + 0.02 * RNG.normal(size=400)


def both_ways(path):
    """Return a run as drafted on the fly, and as read by the dialect that was kept."""
    kept = save_draft(draft_dialect(path), path.with_suffix(".toml"))
    return tl.read(path), tl.read(path, instrument=kept)


def serial_log(clock="t:{0} ", stamp="14:{1:02d}:{2:04.1f} -> "):
    head = ["home tribometer v0.7", "# dead weight on pin = 500 g", "# track radius 4 cm"]
    head += ["# F in gram-force, t in ms"] if clock else ["# F in gram-force"]
    row = stamp + clock + "F:{3:.2f} rpm:{4:.1f}"
    rows = [
        row.format(900 + 100 * n, n // 600, n / 10 % 60, 100 * force, 30.0)
        for n, force in enumerate(FORCE)
    ]
    lines = [stamp.format(0, 0, 0.0) + line for line in head] if stamp else head
    return "\n".join([*lines, *rows[:200], rows[200][:20], *rows[200:]]) + "\n"


@pytest.mark.parametrize("stamp", ["", "14:{1:02d}:{2:04.1f} -> ", "[14:{1:02d}:{2:04.1f}] "])
def test_rows_that_name_their_numbers_are_a_table(tmp_path, stamp):
    (tmp_path / "serial.txt").write_text(serial_log(stamp=stamp))
    for run in both_ways(tmp_path / "serial.txt"):
        np.testing.assert_allclose(run.friction_force, 0.980665 * np.round(FORCE, 4), rtol=2e-4)
        np.testing.assert_allclose(np.diff(run.time), 0.1, rtol=1e-6)
        assert float(run.normal_force[0]) == pytest.approx(4.903325)
        assert float(run.sliding_velocity[0]) == pytest.approx(0.04 * np.pi)


def test_times_of_day_before_the_rows_are_the_clock_where_they_hold_no_other(tmp_path):
    (tmp_path / "serial.txt").write_text(serial_log(clock=""))
    run = tl.read(tmp_path / "serial.txt")
    np.testing.assert_allclose(np.diff(run.time), 0.1, rtol=1e-6)


def test_a_converter_at_its_end_is_no_force(tmp_path):
    lines = serial_log().split("\n")
    for place in (60, 150, 260):
        lines[place] = lines[place].replace(lines[place].split("F:")[1].split()[0], "-8388.6")
    (tmp_path / "serial.txt").write_text("\n".join(lines))
    run = tl.read(tmp_path / "serial.txt")
    assert int(np.isnan(run.friction_force).sum()) == 3
    assert "-8388.6 3 times" in run.attrs["taken_for_missing"]


def test_columns_that_are_listed_above_their_numbers_have_those_names(tmp_path):
    head = "[PARAMETRES]\nEffort normal=0,5 daN\n[VOIES]\nVoie 1=temps écoulé;ms\n"
    head += "Voie 2=déplacement;µm\nVoie 3=effort tangentiel;N\nVoie 4=résistance;mV\n[DONNEES]\n"
    rows = [f"{2 * n};{1.5 * n:.1f};{f:.4f};{9 + n % 3}" for n, f in enumerate(FORCE)]
    text = head + "\n".join(row.replace(".", ",") for row in rows) + "\n[FIN]\nSomme=4F2A\n"
    (tmp_path / "essai.dat").write_text(text, "latin-1")
    for run in both_ways(tmp_path / "essai.dat"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 4))
        np.testing.assert_allclose(run.position[-1], 399 * 1.5e-6)
        np.testing.assert_allclose(np.diff(run.time), 2e-3)
        assert float(run.normal_force[0]) == pytest.approx(5)


@pytest.mark.parametrize(
    "said",
    [
        "# Columns: time (s), friction force (N), normal force (N), speed (mm/s)",
        "# 1 = time [s]; 2 = friction force [N]; 3 = normal force [N]; 4 = speed [mm/s]",
        "Spalten: Zeit [s] | Reibkraft [N] | Normalkraft [N] | Geschwindigkeit [mm/s]",
    ],
)
@pytest.mark.parametrize("mark", [" ", "; "])
def test_one_line_may_list_the_columns(tmp_path, said, mark):
    rows = "\n".join(
        mark.join((f"{n / 50:.2f}", f"{f:.4f}", "20", "5")) for n, f in enumerate(FORCE)
    )
    (tmp_path / "a.dat").write_text(f"{said}\n{rows}\n")
    for run in both_ways(tmp_path / "a.dat"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 4))
        assert float(run.sliding_velocity[0]) == pytest.approx(5e-3)


def test_a_record_of_json_to_a_line_is_a_row(tmp_path):
    rows = [
        f'{{"t_s": {n / 50}, "friction_N": {f:.4f}, "load_N": 20, "speed_mm_s": 5}}'
        for n, f in enumerate(FORCE)
    ]
    (tmp_path / "a.json").write_text("\n".join(rows) + "\n")
    for run in both_ways(tmp_path / "a.json"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 4))
        assert float(run.normal_force[0]) == 20


def test_units_in_capitals_below_the_names_are_units(tmp_path):
    rows = [f"{n / 50:8.3f} {f:8.3f} {20:8.3f} {5:8.3f}" for n, f in enumerate(FORCE)]
    head = "    TIME     FRIC     LOAD    SPEED\n     [S]      [N]      [N]   [MM/S]\n"
    (tmp_path / "a.txt").write_text(head + "\n".join(rows) + "\n")
    for run in both_ways(tmp_path / "a.txt"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 3))
        assert float(run.sliding_velocity[0]) == pytest.approx(5e-3)


def sled():
    names = ["Tiempo", "Desplazamiento", "FUERZA"]
    units = ["(s)", "(mm)", "(cN)"]
    parts = []
    for k, rows in enumerate((400, 330, 390)):
        t = 0.02 * np.arange(rows)
        force = 100 * (0.5 + 0.1 * k) * FORCE[:rows]
        cells = np.column_stack([t, 2.5 * t, force])
        table = [[f"{v:.3f}".replace(".", ",") for v in row] for row in cells]
        parts.append([[f"Probeta {k + 1}", "", ""], names, units, *table])
    longest = max(map(len, parts))
    parts = [part + [[""] * 3] * (longest - len(part)) for part in parts]
    rows = [";".join([*a, *b, *c]) for a, b, c in zip(*parts, strict=True)]
    head = "Ensayo: ISO 8295\nMasa del patín;200 g\n\n"
    return head + "\n".join(rows) + "\n\nAprobado por;M. Ibáñez\n"


def test_specimens_side_by_side_are_steps_of_one_run(tmp_path):
    (tmp_path / "patin.csv").write_text(sled(), "utf-8-sig")
    for run in both_ways(tmp_path / "patin.csv"):
        steps = run.step.values
        assert [int((steps == k).sum()) for k in (1, 2, 3)] == [400, 330, 390]
        mean = [float(run.friction_force.values[steps == k].mean()) for k in (1, 2, 3)]
        np.testing.assert_allclose(mean, [0.6, 0.72, 0.84], rtol=0.01)
        assert float(run.normal_force[0]) == pytest.approx(1.96133)


@pytest.mark.parametrize(
    ("cells", "groups"),
    [
        (["t", "x", "F", "", "t", "x", "F", ""], 2),
        (["Time (1)", "Force (1)", "Time (2)", "Force (2)"], 2),
        (["t", "F", "N", "t", "F"], 1),
        (["F1", "F2", "F3"], 1),
        ([""], 1),
    ],
)
def test_tables_stand_side_by_side_under_the_same_names_only(cells, groups):
    assert groups_beside(cells) == groups


def test_sensors_beside_each_other_are_no_tables(tmp_path):
    rows = "\n".join(
        f"{f:.4f},{20 + n % 3},{f + 0.5:.4f},{20 + n % 2}" for n, f in enumerate(FORCE)
    )
    head = "Rate: 10 Hz\nSpeed: 5 mm/s\nFx1 [N],Fz1 [N],Fx2 [N],Fz2 [N]\n"
    (tmp_path / "two.csv").write_text(head + rows + "\n")
    draft = draft_dialect(tmp_path / "two.csv")
    assert draft.layout.arrangement == "below names" and draft.layout.width == 4


def test_a_list_that_does_not_count_all_columns_names_none():
    lines = ["Channel 1: t;s", "Channel 2: F;N", "Channel 4: N;N"]
    assert listed_columns(lines, 3) == []
    assert listed_columns(lines[:2], 2) == ["t [s]", "F [N]"]
    assert listed_columns(["0\tTime [s]", "1\tForce [N]"], 2) == ["Time [s]", "Force [N]"]


def test_what_is_said_above_a_table_is_no_row_of_names():
    head = [f"Setting {n}: {n} a: 1" for n in range(9)]
    assert not holds_names([*head, *(f"{n};{n + 1}" for n in range(100))])
    assert not holds_names([f"F: {n} N" for n in range(100)])  # results, one to a line
    assert below_names("1;2\n", "names in rows", ";") == "1;2\n"
    assert below_names("1;2\n", "side by side", ";") == "1;2\n"
    assert below_names("1;2\n", "columns listed", ";") == "1;2\n"


@pytest.mark.parametrize("place", [0, 1, 250])
def test_a_delimiter_too_many_behind_a_row_ends_no_table(tmp_path, place):
    rows = [f"{n / 10:.1f}\t{force:.4f}\t20.0\t5.0" for n, force in enumerate(FORCE)]
    rows[place] += "\t"
    head = "Time\tFriction force\tNormal force\tSpeed\n[s]\t[N]\t[N]\t[mm/s]\n"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    for run in both_ways(tmp_path / "a.lvm"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 4))


def test_a_cell_too_many_in_a_row_is_an_error(tmp_path):
    rows = [f"{n / 10:.1f}\t{force:.4f}\t20.0\t5.0" for n, force in enumerate(FORCE)]
    head = "Time\tFriction force\tNormal force\tSpeed\n[s]\t[N]\t[N]\t[mm/s]\n"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    kept = save_draft(draft_dialect(tmp_path / "a.lvm"), tmp_path / "a.toml")
    rows[250] += "\t7"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    with pytest.raises(ReadError, match="line 253 has 5 cells where 4 are expected"):
        tl.read(tmp_path / "a.lvm", instrument=kept)


def test_samples_that_move_the_mean_are_no_matter_of_peaks(tmp_path):
    force = FORCE.copy()
    force[[50, 130, 290]] = -40.0, -41.0, -43.0
    rows = [f"{n / 10:.1f},{f:.4f},20,5" for n, f in enumerate(force)]
    head = "Time [s],Friction force [N],Normal force [N],Speed [mm/s]\n"
    (tmp_path / "a.csv").write_text(head + "\n".join(rows) + "\n")
    found = next(
        row
        for row in tl.check(tl.read(tmp_path / "a.csv")).rows
        if row["check"] == "spikes" and row["variable"] == "friction_force"
    )
    assert found["status"] == "suspect"
    assert "with them the mean of its size is 26.6%" in found["message"]
    assert "[text] missing" in found["cure"]
