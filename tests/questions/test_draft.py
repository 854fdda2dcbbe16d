"""Drafting dialects: what the drafted TOML reads is what an independent look at the file says."""

import re
import tomllib

import numpy as np
import pytest
from drafts import drafted

from tribolab.core.errors import OutputError, ReadError
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft

ACTUATOR = "actuator_friction_CC0"
CETR = "cetr_umt2_MIT/HT-2n-6-4 2_00"
PCS = "pcs_mtm_ehd_MIT"
GF = 9.80665e-3


def rows_of(path, delimiter, width, encoding="utf-8-sig"):
    """Rows of numbers of a file, found without any of the code under test."""
    lines = re.split(r"[\r\n]+", path.read_bytes().decode(encoding))
    cells = [line.split(delimiter) for line in lines]
    return [row for row in cells if len(row) == width and re.fullmatch(r"-?[\d.]+", row[0])]


def column(rows, place, scale=1.0, offset=0.0):
    return (
        np.array([float(row[place - 1]) if row[place - 1] else np.nan for row in rows]) * (scale)
        + offset
    )


def agree(data, rows, columns, origin_of_time):
    """Number of rows, first and last values, and all between, as the file says them."""
    assert data.sizes["time"] == len(rows)
    for name, values in columns.items():
        np.testing.assert_allclose(data[name].values, values, rtol=1e-12, atol=0, err_msg=name)
    time = data.time.values
    assert time[0] == 0 and (np.diff(time) > 0).all()
    assert data.attrs["time_origin_s"] == pytest.approx(origin_of_time, rel=1e-12)


RUNS = {
    **{
        f"{ACTUATOR}/{name}.csv": ("\t", 7, {"position": (5, 1e-3)}, (1, 1e-3))
        for name in ("Circle_1bar", "Kidney_2bar", "O-ring257_1bar")
    },
    "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt": (
        "\t",
        4,
        {"position": (2, 1e-6), "friction_coefficient": (3,), "normal_stress": (4, 1e6)},
        (1, 1.0),
    ),
    **{
        f"{CETR}{number}.csv": (
            ",",
            11,
            {
                "friction_force": (1, GF),
                "normal_force": (2, -GF),
                "height_displacement": (3, 1e-3),
                "friction_coefficient": (11,),
            },
            (9, 1.0),
        )
        for number in (1, 2, 3)
    },
    f"{PCS}/demo_5.txt": (
        "\t",
        38,
        {
            "friction_force": (34,),
            "friction_coefficient": (35,),
            "normal_force": (12,),
            "sliding_velocity": (27, 1e-3),
            "rolling_speed": (26, 1e-3),
            "slide_roll_ratio": (28, 1e-2),
            "temperature": (11, 1.0, 273.15),
        },
        (9, 1.0),
    ),
    **{
        f"{PCS}/demo_{number}.txt": (
            "\t",
            36,
            {
                "normal_force": (12,),
                "rolling_speed": (18, 1e-3),
                "sliding_velocity": (19, 1e-3),
                "film_thickness": (29, 1e-9),
                "temperature": (10, 1.0, 273.15),
            },
            (9, 1.0),
        )
        for number in (12, 2, 3)
    },
    f"{PCS}/trios_demo.txt": (
        "\t",
        6,
        {
            "shear_stress": (1, 0.1),
            "shear_rate": (2,),
            "viscosity": (3,),
            "temperature": (5, 1.0, 273.15),
            "normal_stress": (6, 0.1),
        },
        (4, 1.0),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("file", RUNS)
def test_a_drafted_dialect_reads_every_run(file, shared_data, tmp_path):
    delimiter, width, columns, (time, unit) = RUNS[file]
    path = shared_data / file
    data, draft = drafted(path, tmp_path)
    rows = rows_of(path, delimiter, width)
    expected = {name: column(rows, *where) for name, where in columns.items()}
    agree(data, rows, expected, float(rows[0][time - 1]) * unit)
    assert draft.kind == "run" and not draft.to_fill_in
    for name, values in draft.first_rows(5).items():
        if name in expected:
            np.testing.assert_allclose(values, expected[name][:5], rtol=1e-12, err_msg=name)


SCANS = {
    "bearing_profiles_MIT/NU206-RE-1.txt": ("\t", 2, 1e-3, 1e-6),
    "bearing_profiles_MIT/NU208-IR-1.txt": ("\t", 2, 1e-3, 1e-6),
    "surfacetopography_MIT/dektak-1.csv": (",", 4, 1e-6, 1e-6),
    "surfacetopography_MIT/xy-4.txt": ("\t", 2, 1e-3, 1e-3),
}


@pytest.mark.parametrize("file", SCANS)
def test_a_drafted_dialect_reads_every_profile(file, shared_data, tmp_path):
    delimiter, width, x_unit, z_unit = SCANS[file]
    path = shared_data / file
    data, draft = drafted(path, tmp_path)
    rows = rows_of(path, delimiter, width, "latin-1")
    x, height = column(rows, 1, x_unit), column(rows, 2, z_unit)
    assert draft.kind == "scan" and data.sizes == {"scan": 1, "x": len(rows)}
    np.testing.assert_allclose(data.height.values[0], height, rtol=1e-12)
    assert data.x.values[-1] == pytest.approx(x[-1] - x[0], rel=1e-4)


def test_a_map_is_told_by_its_grid(shared_data, tmp_path):
    path = shared_data / "nanovea_map_MIT/test1.txt"
    data, draft = drafted(path, tmp_path)
    values = np.loadtxt(path, delimiter=",")
    assert data.height.shape == (101, 101)
    np.testing.assert_allclose(data.height.values.ravel(), values[:, 2] * 1e-6, rtol=1e-12)
    assert any("map" in guess for guess in draft.guesses)


def test_results_and_tables_are_called_what_they_are(shared_data, tmp_path):
    results = shared_data / "mitutoyo_sj410_res_MIT/12A11003.TXT"
    draft = draft_dialect(results)
    assert (draft.kind, draft.toml, draft.dialect) == ("table", "", None)
    assert "'tribolab check' reads it without a dialect" in draft.answer
    assert draft.cells[0][:3] == ("Ra", "3,246", "um")
    assert float(read_tester_results(results).Ra) == 3.246e-6  # the answer tells the truth

    dma = draft_dialect(shared_data / "dma_pyvisco_BSD3/freq_user_raw.csv")
    assert dma.kind == "table" and "f, E_stor, E_loss, T, Set: no signals" in dma.answer
    assert dma.cells[0] == ("0.1", "8097.175545", "93.07449045", "-49.9612", "0")
    with pytest.raises(OutputError, match="no dialect"):
        save_draft(dma, tmp_path / "dma.toml")
    assert not (tmp_path / "dma.toml").exists()


@pytest.mark.parametrize(
    ("file", "points"), [("gwyddion-export-german.txt", (4, 3)), ("sdf-1.sdf", (4, 7))]
)
def test_a_matrix_of_heights_is_left_to_those_who_read_it(file, points, shared_data):
    path = shared_data / "surfacetopography_MIT" / file
    draft = draft_dialect(path)
    assert draft.kind == "table" and "'tribolab check'" in draft.answer
    assert read_scans(path).height.shape == points  # the answer tells the truth
    assert len(draft.cells[0]) == points[1]


@pytest.mark.slow
def test_every_text_file_of_the_collection_is_accounted_for(shared_data):
    """Prose has no table; any other text file is drafted or answered, and none is forgotten."""
    seen = {"run": 0, "scan": 0, "table": 0, "prose": 0}
    for path in sorted(shared_data.glob("*/*")):
        if path.suffix.lower() not in (".txt", ".csv", ".sdf") or path.parent.name == "cases":
            continue  # the small cases have tests of their own
        try:
            seen[draft_dialect(path).kind] += 1
        except ReadError as error:
            assert "no table of numbers" in str(error) and "icen" in path.name.lower()
            seen["prose"] += 1
    # beside those with a reference above: three runs on a disc, two frequency sweeps, two maps
    assert seen == {"run": len(RUNS) + 5, "scan": len(SCANS) + 2, "table": 8, "prose": 6}


def test_what_was_guessed_is_marked_and_what_the_file_says_is_not(shared_data):
    rock = draft_dialect(shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt")
    assert rock.guesses == () and "guessed:" not in rock.toml
    cetr = draft_dialect(shared_data / f"{CETR}1.csv")
    assert cetr.toml.count("sign = -1") == 1
    assert cetr.toml.count("# guessed: 'g' means gf") == 2
    actuator = draft_dialect(shared_data / ACTUATOR / "Circle_1bar.csv")
    assert "the same signal as column 7" in actuator.toml
    assert "# guessed: it is time in ms" in actuator.toml


def test_a_missing_unit_is_asked_for_and_the_rest_is_read(tmp_path):
    file = tmp_path / "versuch.csv"
    file.write_text("Zeit;Reibkraft;Weg [mm];Bemerkung\n0,0;1,5;0,1;a\n0,1;1,6;0,2;b\n")
    data, draft = drafted(file, tmp_path)
    assert data.position.values.tolist() == [1e-4, 2e-4]
    assert "friction_force" not in data
    [(line, what)] = draft.to_fill_in.items()
    assert "Reibkraft" in what
    lines = draft.toml.splitlines()
    assert "FILL IN" in lines[line - 1]
    # doing as it says makes the dialect whole
    block = range(line, next(n for n in range(line, len(lines) + 1) if not lines[n].strip()))
    for number in block:
        lines[number] = lines[number].removeprefix("# ").replace('"?"', '"mN"')
    whole = tmp_path / "whole.toml"
    whole.write_text("\n".join(lines))
    assert read(file, instrument=whole).friction_force.values.tolist() == [1.5e-3, 1.6e-3]


def test_without_time_rows_are_counted_and_the_rate_is_asked_for(tmp_path):
    file = tmp_path / "forces.txt"
    file.write_text("Fx [N]\tFz [N]\n1.5\t10\n1.6\t10\n1.7\t10\n")
    data, draft = drafted(file, tmp_path)
    assert data.time.values.tolist() == [0, 1, 2] and data.attrs["time_source"] == "row number"
    assert any("sample rate" in what for what in draft.to_fill_in.values())


@pytest.mark.parametrize(
    ("header", "quantities"),
    [
        ("t/s;F_R/N;F_N/N;v in mm/s", "time friction_force normal_force sliding_velocity"),
        (
            "Zeit [s];Reibkraft [mN];Normalkraft [N];Reibwert",
            "time friction_force normal_force friction_coefficient",
        ),
        ("T [s];T [°C];Weg (µm);µ", "time temperature position friction_coefficient"),
        (
            "time_s;friction;load_N;speed_mm/s",
            "time friction_coefficient normal_force sliding_velocity",
        ),
        (
            "# Time [s];Friction [N];Load [kg];COF",
            "time friction_force normal_force friction_coefficient",
        ),
    ],
)
def test_names_are_understood_in_two_languages(header, quantities, tmp_path):
    file = tmp_path / "names.csv"
    file.write_text(f"{header}\n0,1;0,5;2,5;0,2\n0,2;0,6;2,5;0,2\n", encoding="latin-1")
    data, draft = drafted(file, tmp_path)
    assert [c.quantity for c in draft.understood.columns if c.used] == quantities.split()
    assert data.sizes["time"] == 2


@pytest.mark.parametrize(
    ("unit", "rad_s"),
    [("1/min", 0.1047198), ("U/min", 0.1047198), ("Hz", 6.2831853), ("min-1", 0.1047198)],
)
def test_turns_are_not_taken_for_radians(unit, rad_s, tmp_path):
    file = tmp_path / "turns.csv"
    file.write_text(f"Zeit [s];Drehzahl [{unit}];Last [N]\n0;1;9\n1;1;9\n2;1;9\n")
    data, _ = drafted(file, tmp_path)
    np.testing.assert_allclose(data.rotation_speed.values, rad_s, rtol=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "Time [s]  Normal force [N]  Fx [mN]\n  0.0   31  2.0\n  0.1   31  2.5\n 0.2 31 3.0\n",
        "# t[s] Fz[N] Fx[mN]\n0.0 31 2.0\n0.1 31 2.5\n0.2 31 3.0\n",
        "Time,Load,Friction\nsec,N,mN\nch 1,ch 2,ch 3\n0.0,31,2.0\n0.1,31,2.5\n0.2,31,3\n",
        "sep=;\nTime [s];Load [N];Friction [mN]\n0,0;31;2,0\n0,1;31;2,5\n0,2;31;3,0\n",
        '"Time [s]","Load [N]","Friction [mN]"\n"0","31","2.0"\n"0.1","31","2.5"\n"0.2","31","3"\n',
        "Time [s]\tLoad [N]\tFriction [mN]\t\n0\t31\t2.0\t\n0.1\t31\t2.5\t\n0.2\t31\t3\t\n",
        "Time [s],Load [N],Friction [mN]\n0,31,2.0\n0.1,31,2.5\n0.2,31,3\n0.3,31",
    ],
    ids=["blanks", "comment", "third line", "sep=", "quotes", "trailing", "cut off"],
)
def test_headers_in_many_forms_say_the_same(text, tmp_path):
    file = tmp_path / "form.txt"
    file.write_text(text)
    data, draft = drafted(file, tmp_path)
    np.testing.assert_allclose(data.friction_force.values, [2e-3, 2.5e-3, 3e-3])
    np.testing.assert_allclose(data.normal_force.values, 31)
    np.testing.assert_allclose(data.time.values, [0, 0.1, 0.2])
    assert not draft.to_fill_in


def test_names_that_say_nothing_leave_it_to_the_numbers(tmp_path):
    file = tmp_path / "channels.csv"
    rows = "\n".join(f"{10 * i},{i % 7},{(3 * i) % 5}" for i in range(50))
    file.write_text(f"Channel 1,Channel 2,Channel 3\n{rows}\n")
    data, draft = drafted(file, tmp_path)
    assert draft.kind == "run" and data.time.values[-1] == pytest.approx(0.49)
    assert "it is time in ms" in draft.guesses[0]


def test_decimal_commas_in_quotes_are_no_delimiters(tmp_path):
    file = tmp_path / "quoted.csv"
    rows = "".join(f'"{n / 10:.1f}","{2 + n / 4:.2f}","31"\n' for n in range(30)).replace(".", ",")
    file.write_text('"Zeit [s]","Reibkraft [N]","Last [N]"\n' + rows)
    data, draft = drafted(file, tmp_path)
    np.testing.assert_allclose(data.time, 0.1 * np.arange(30))
    np.testing.assert_allclose(data.friction_force, 2 + 0.25 * np.arange(30))
    np.testing.assert_array_equal(data.normal_force, 31)
    assert not draft.guesses


@pytest.mark.parametrize("bad", ["OVL", "Err110", "***.**um", "#N/A", "kaputt"])
def test_words_for_no_value_are_found(bad, tmp_path):
    file = tmp_path / "gaps.csv"
    file.write_text(f"Time [s],Fx [N]\n0,1\n1,{bad}\n2,3\n3,4\n")
    data, draft = drafted(file, tmp_path)
    assert bad in tomllib.loads(draft.toml)["text"]["missing"]
    np.testing.assert_array_equal(data.friction_force.values, [1, np.nan, 3, 4])


def uncommented(toml, heading):
    """The TOML with every commented-out table of a kind made active, as a person would do it."""
    blocks = toml.split("\n\n")
    for number, block in enumerate(blocks):
        if f"# {heading}" in block:
            before, after = block.split(f"# {heading}")
            blocks[number] = before + heading + after.replace("\n# ", "\n")
    return "\n\n".join(blocks)


def test_single_values_are_proposed_and_work_when_they_are_taken(shared_data, tmp_path):
    file = tmp_path / "pmma_31N_01.csv"
    file.write_text(
        "# Rig 7\n# rate: 10 Hz\n# tip radius = 2.5 um\n# operator: Weber\nRun no;4\n"
        "Time [s];Fx [N]\n0;1\n1;2\n"
    )
    draft = draft_dialect(file)
    assert [value.name for value in draft.dialect.value] == ["set_normal_force"]  # nothing else is
    toml = tmp_path / "rig.toml"
    toml.write_text(uncommented(draft.toml, "[[value]]"))
    attrs = read(file, instrument=toml).attrs
    assert attrs["set_normal_force_N"] == 31 and attrs["tip_radius_m"] == 2.5e-6
    assert attrs["rate_Hz"] == 10 and attrs["run_no"] == "4"

    real = shared_data / f"{PCS}/demo_5.txt"
    toml.write_text(uncommented(draft_dialect(real).toml, "[[value]]"))
    attrs = read(real, instrument=toml).attrs
    assert attrs["disc_track_radius_used_for_this_step_m"] == pytest.approx(21.232e-3)
    assert attrs["zero_traction_force_N"] == 0.1467


def test_a_footer_ends_the_table(tmp_path):
    file = tmp_path / "footer.txt"
    file.write_text("Time [s]\tFx [N]\n0\t1\n1\t2\n2\t3\nEnd of test, 3 samples\n")
    data, _ = drafted(file, tmp_path)
    assert data.friction_force.values.tolist() == [1, 2, 3]


def test_a_clock_that_starts_anew_at_each_step_is_joined(tmp_path):
    step = "Step {}\nTime [s],Fx [N]\n0.0,{}\n0.5,2\n1.0,3\n\n"
    file = tmp_path / "steps.csv"
    file.write_text(step.format(1, 7) + step.format(2, 8) + step.format(3, 9))
    data, draft = drafted(file, tmp_path)
    assert draft.dialect.time.restart == "continue"
    assert data.step.values.tolist() == [1, 1, 1, 2, 2, 2, 3, 3, 3]
    assert data.friction_force.values[::3].tolist() == [7, 8, 9]


def test_a_long_file_with_a_footer_beyond_what_is_looked_at(tmp_path):
    n = 120_000
    body = "\n".join(f"{i / 100:.2f},{i % 97}" for i in range(n))
    file = tmp_path / "long.csv"
    file.write_text(f"Long log\nTime [s],Fx [N]\n{body}\n\nThe end\n")
    assert file.stat().st_size > 1 << 20
    data, draft = drafted(file, tmp_path)
    assert not draft.layout.whole
    assert data.sizes["time"] == n and data.friction_force.values[-1] == (n - 1) % 97
