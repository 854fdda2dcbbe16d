"""Files that no dialect knows: read by what they say themselves, or asked about all at once."""

import json
import pickle
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect
from tribolab.reading.unknown.proposal.questions import GuessedError

GOOD = "Temps (s);Force de frottement (N);Charge (N);Vitesse (mm/s)"
OPEN = "Zeit;Reibkraft;Load Cell [N];Weg [mm]"


def table(header, n=400):
    rng = np.random.default_rng(1)
    t = np.arange(n) / 10
    columns = [t, 6 + 0.1 * rng.standard_normal(n), 30 + 0.1 * rng.standard_normal(n)]
    columns.append(10 + 0.01 * rng.standard_normal(n))
    rows = "\n".join(";".join(f"{v:.4f}" for v in row) for row in zip(*columns, strict=True))
    return f"{header}\n{rows}\n"


@pytest.fixture
def good(tmp_path):
    file = tmp_path / "bon essai.csv"
    file.write_text(table(GOOD), encoding="latin-1")
    return file


@pytest.fixture
def unclear(tmp_path):
    file = tmp_path / "odd.csv"
    file.write_text(table(OPEN))
    return file


def command(*words):
    return CliRunner().invoke(cli.app, [str(word) for word in words])


def test_a_file_that_says_everything_is_read_and_says_how_to_keep_the_draft(good):
    run = tl.read(good)
    assert run.attrs["instrument"] == "drafted from the file"
    assert run.attrs["to_keep_it"] == "tribolab info 'bon essai.csv' --write my.toml"
    mu = tl.friction_coefficient(run, tl.find_segments(run, trim=0.1))
    assert float(mu.friction_coefficient[0]) == pytest.approx(0.2, abs=0.002)
    [same] = tl.read(good.parent / "*.csv")
    assert same.friction_force.equals(run.friction_force)
    by_hand = tl.read(good, tl.reading.draft_dialect(good).dialect)
    assert by_hand.friction_force.equals(run.friction_force)


def test_several_files_of_one_run_are_read_by_the_draft_of_the_first(good):
    header, *rows = good.read_bytes().splitlines(keepends=True)
    whole = tl.read(good).friction_force.values
    second = good.with_name("z.csv")
    good.write_bytes(header + b"".join(rows[:150]))
    second.write_bytes(header + b"".join(rows[150:]))
    run = tl.read([good, second])
    np.testing.assert_array_equal(run.friction_force, whole)
    assert np.unique(run.cycle).tolist() == [1, 2]


def test_what_is_open_is_asked_all_at_once_with_the_alternatives(unclear):
    with pytest.raises(GuessedError) as caught:
        tl.read(unclear)
    error = pickle.loads(pickle.dumps(caught.value))
    told = str(error)
    assert "Understood: normal_force 'Load Cell' (N), position 'Weg' (mm)\n" in told
    assert told.count("\n") <= 4
    assert "Unclear: column 1 'Zeit': time is in s (or ms, min)\n" in told
    assert "column 2 'Reibkraft': friction_force, in which unit: N, mN or gf?" in told
    assert "Load Cell" not in str(error.asked)  # beside a friction force it is the other
    assert told.endswith("'tribolab info odd.csv --write my.toml' drafts a description of it: "
                         "name it with instrument=")  # fmt: skip
    assert "\n" not in error.message_for("campaign") and "in which unit:" in error.message_for(
        "campaign"
    )
    assert "linear_slider" not in told  # nor any other of the known


def test_numbers_without_names_are_asked_about_and_not_read(tmp_path):
    file = tmp_path / "bare.txt"
    position = 20 * np.sin(np.arange(900) / 60)
    force = np.random.default_rng(0).normal(0, 1, 900)
    np.savetxt(file, np.column_stack([np.arange(900) * 10, position, force]), fmt="%.4f")
    with pytest.raises(GuessedError, match="it is the position in mm"):
        tl.read(file)
    told = command("info", file)
    assert told.exit_code == 3 and "it is time in ms" in told.stderr
    assert "(or s, min, not used)" in told.stderr


def test_the_commands_take_the_same_way(good, unclear, tmp_path):
    told = command("info", good, unclear)
    assert told.exit_code == 3 and "bon essai.csv: drafted from the file\n" in told.stdout
    assert f"to keep it: tribolab info '{good}' --write my.toml" in told.stdout
    assert "column 2 'Reibkraft'" in told.stderr and "name it with --instrument" in told.stderr
    checked = command("check", good)
    assert checked.exit_code != 3 and "unreadable" not in checked.stdout
    (tmp_path / "raw").mkdir()
    for file in (good, unclear):
        file.rename(tmp_path / "raw" / file.name)
    (tmp_path / "campaign.toml").write_text(
        f'[campaign]\nname = "a"\n[[run]]\nfiles = "{good.name}"\n'
        f'[[run]]\nfiles = "{unclear.name}"\n'
    )
    made = command("run", tmp_path / "campaign.toml", "-q", "-j", "1")
    assert made.exit_code == 3 and "odd failed: " in made.stderr
    assert "column 1 'Zeit': time is in s (or ms, min); column 2" in made.stderr
    friction = (tmp_path / "results/tables/friction.csv").read_text()
    assert "bon_essai" in friction


def test_a_table_that_is_no_run_stays_unknown(tmp_path):
    file = tmp_path / "dma.csv"
    file.write_text("f,E_stor\nHz,MPa\n1,2\n2,3\n")
    with pytest.raises(ReadError, match="no signals along time and no profile") as caught:
        tl.read(file)
    assert not isinstance(caught.value, GuessedError)


def test_writing_the_draft_down_and_naming_it_reads_the_same(good, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert command("info", good.name, "--write", "bon_essai.toml").exit_code == 0
    run = tl.read(good, "bon_essai.toml")
    assert run.attrs["instrument"] == "bon_essai"
    assert run.friction_force.equals(tl.read(good).friction_force)
    assert tomllib.loads((tmp_path / "bon_essai.toml").read_text("utf-8"))["name"] == "bon_essai"


@pytest.mark.parametrize(
    "said", ["# Sample rate: 200 Hz", "Abtastrate [kHz];0.2", "Sampling frequency = 0.2 kHz"]
)
def test_a_sample_rate_before_the_table_is_its_clock(said, tmp_path):
    file = tmp_path / "daq.txt"
    rows = "\n".join(f"{5 + n % 3};30" for n in range(100))
    file.write_text(f"{said}\nFx [N];Fz [N]\n{rows}\n")
    run = tl.read(file)
    assert run.attrs["time_source"] == "sample rate"
    np.testing.assert_allclose(run.time, np.arange(100) / 200)
    file.write_text(f"Frequency: 2 Hz\nFx [N];Fz [N]\n{rows}\n")  # of the strokes, it may be
    with pytest.raises(GuessedError, match="rows are counted as seconds .or a sample rate"):
        tl.read(file)


@pytest.mark.parametrize(
    ("settings", "speed"),
    [
        ("Stroke=12\nStroke unit=mm\nMode=Sine", "stroke"),
        ("Stroke [mm]=12\nWaveform=sinusoidal", "stroke"),
        ("stroke_mm=12\nreciprocating rig, crank drive", "stroke"),
        ("Stroke=12\nMode=Sine", "none"),
    ],
)
def test_settings_are_used_with_their_units_and_told_without(settings, speed, tmp_path):
    file = tmp_path / "wiper.dat"
    rows = "\n".join(f"{n};{3 * np.cos(0.8 * np.pi * n / 100):.3f}" for n in range(1000))
    head = f"Logger rate=100 S/s\nFrequency (Hz)=0.4\nLoad=15 N\n{settings}"
    file.write_text(f"{head}\nsample;Ff [N]\n{rows}\n")
    run = tl.read(file)
    assert run.attrs["speed_from"] == speed
    assert run.attrs.get("without_unit") == ("Stroke=12" if speed == "none" else None)
    if speed == "stroke":
        assert float(run.sliding_velocity.max()) == pytest.approx(0.4 * np.pi * 0.012, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "clock", "epoch", "recorded"),
    [
        ("timestamp", lambda t: np.round(1.7726e12 + 1e3 * t), "unix", "2026-03-04"),
        ("timestamp", lambda t: 1.7726e9 + t, "unix", "2026-03-04"),
        ("Time [s]", lambda t: 3.8554512e9 + t, "labview", "2026-03-04"),
        ("Date", lambda t: 46085.25 + t / 86400, "excel", "2026-03-04"),
        ("millis", lambda t: np.round(5e3 + 1e3 * t), None, None),
        ("micros", lambda t: np.round(5e6 + 1e6 * t), None, None),
    ],
)
def test_a_clock_says_by_its_numbers_since_when_it_counts(name, clock, epoch, recorded, tmp_path):
    time = np.arange(200) / 50
    file = tmp_path / "logger.csv"
    rows = "\n".join(f"{c:.12f};{5 + n % 3};30;2" for n, c in enumerate(clock(time)))
    file.write_text(f"{name};Ff [N];Fn [N];v [mm/s]\n{rows}\n")
    run = tl.read(file)
    np.testing.assert_allclose(run.time, time, atol=1e-5)
    assert str(run.attrs.get("recorded_at"))[:10] == str(recorded)
    draft = draft_dialect(file)
    assert draft.dialect.time.epoch == epoch


def test_seconds_since_the_start_of_a_counter_are_no_date(tmp_path):
    """A counter of milliseconds that has run for a fortnight has the size of seconds since 1970."""
    file = tmp_path / "logger.csv"
    rows = "\n".join(f"{1_200_000_000 + 20 * n};{5 + n % 3};30;2" for n in range(200))
    file.write_text(f"timestamp;Ff [N];Fn [N];v [mm/s]\n{rows}\n")
    with pytest.raises(GuessedError, match="time is in ms"):
        tl.read(file)


def test_turns_and_a_radius_make_the_way(tmp_path):
    file = tmp_path / "disc.csv"
    rows = "\n".join(f"{n / 10},{5 + n % 3},30,{n / 40}" for n in range(100))
    file.write_text(f"Track radius: 20 mm\nTime [s],Ft [N],Fn [N],Revolutions\n{rows}\n")
    run = tl.read(file)
    np.testing.assert_allclose(run.position, 2 * np.pi * 0.02 * np.arange(100) / 40)
    rows = "\n".join(f"{n / 10},{5 + n % 3},30,{n // 40}" for n in range(100))  # counted
    file.write_text(f"Track radius: 20 mm\nTime [s],Ft [N],Fn [N],Revolutions\n{rows}\n")
    assert "position" not in tl.read(file)


def test_json_is_no_table_but_may_stand_above_one(tmp_path):
    file = tmp_path / "run.json"
    rows = "\n".join(f"{n / 10},{5 + n % 3},30,2" for n in range(100))
    about = {"operator": "me", "gain": [1, 2]}
    file.write_text(json.dumps({"time": "now", "force": [[1.0]] * 5000}))
    with pytest.raises(tl.TribolabError, match="this is JSON"):
        tl.read(file)
    file.write_text("[[" * 100_000)
    with pytest.raises(tl.TribolabError, match="this is JSON"):
        tl.read(file)
    file.write_text(f"{json.dumps(about, indent=1)}\nTime [s],Ft [N],Fn [N],v [mm/s]\n{rows}\n")
    assert tl.read(file).sizes["time"] == 100


def test_a_distance_of_heights_without_a_unit_is_told(tmp_path):
    file = tmp_path / "trace.txt"
    heights = "\n".join(f"{n % 7}" for n in range(200))
    file.write_text(f"# spacing: 0.8\n# heights in nm\n\n{heights}\n")
    with pytest.raises(tl.TribolabError, match="'# spacing: 0.8' has no unit"):
        tl.read_scans(file)


def test_a_rotation_and_a_radius_in_the_header_make_the_speed(tmp_path):
    file = tmp_path / "disc.csv"
    rows = "\n".join(f"{n / 10},{5 + n % 3},30,{60 if n < 50 else 120}" for n in range(100))
    table = f"Time [s],Ft [N],Fn [N],Speed [rpm]\n{rows}\n"
    file.write_text(f"Ball radius: 3 mm\nTrack radius: 20 mm\n{table}")
    run = tl.read(file)
    speed = np.repeat([1, 2], 50) * 2 * np.pi * 0.02
    np.testing.assert_allclose(run.sliding_velocity, speed, rtol=1e-6)
    assert run.attrs["speed_from"] == "rotation" and run.attrs["track_radius_m"] == 0.02
    file.write_text(f"Inner radius: 10 mm\nOuter radius: 20 mm\n{table}")
    with pytest.raises(GuessedError, match="the mean of the inner and the outer radius"):
        tl.read(file)  # a wide ring, or a disc with a hole


def test_turns_whose_unit_is_not_said_are_not_asked_about_where_the_way_is_known(tmp_path):
    rows = "\n".join(f"{n / 10:.1f};{n / 20:.2f};{n / 7:.2f};0.3;5" for n in range(200))
    head = "Time [s];Position [mm];Rotation speed [xy];Friction force [N];Load [N]"
    (tmp_path / "a.csv").write_text(f"{head}\n{rows}\n")
    run = tl.read(tmp_path / "a.csv")
    assert "rotation_speed" not in run and run.attrs["speed_from"] == "position"


def test_a_zero_that_is_to_be_subtracted_is_taken_off(tmp_path):
    rows = "\n".join(f"{n / 10:.1f};2.0;3.118;10" for n in range(200))
    said = "Zero da célula de força: 0,118 N (descontar de Fat)"
    head = "Tempo [s];Velocidade [mm/s];Fat [N];Carga [N]"
    (tmp_path / "a.csv").write_text(f"{said}\n{head}\n{rows}\n", encoding="utf-8")
    assert float(tl.read(tmp_path / "a.csv").friction_force.mean()) == pytest.approx(3.0)


def test_of_two_stated_zeros_that_of_the_friction_is_taken_off(tmp_path):
    rows = "\n".join(f"{n / 10:.1f};2.0;3.124;10" for n in range(200))
    said = "Zéro du capteur tangentiel (N);0,124\nZéro du capteur normal (N);0\n"
    said += "Remarque;forces brutes : retrancher le zéro"
    head = "Temps [s];Vitesse [mm/s];Force tangentielle [N];Charge [N]"
    (tmp_path / "a.csv").write_text(f"{said}\n{head}\n{rows}\n", encoding="utf-8")
    assert float(tl.read(tmp_path / "a.csv").friction_force.mean()) == pytest.approx(3.0)


def test_seconds_that_a_text_calls_the_zero_are_asked_about(tmp_path):
    force = [0.5 + 0.001 * (n % 3) if n < 300 else 3.5 for n in range(2000)]
    rows = "\n".join(
        f"{n / 100:.2f};{max(n - 350, 0) / 50:.3f};{f:.3f}" for n, f in enumerate(force)
    )
    said = (
        "Masa del patín: 1000 g\nObservaciones: los primeros 3 s máquina parada (cero de la célula)"
    )
    head = "Tiempo (s);Desplazamiento (mm);Fuerza de rozamiento (N)"
    (tmp_path / "a.csv").write_text(f"{said}\n{head}\n{rows}\n", encoding="utf-8")
    with pytest.raises(GuessedError, match="the friction is read as it stands, although"):
        tl.read(tmp_path / "a.csv")


def test_a_radial_force_beside_a_torque_is_no_friction(tmp_path):
    """Fr of a bearing passed for its friction, a thousand times too large."""
    rows = "\n".join(f"{n / 10:.1f};0.3;{1.5 + n % 2 / 100:.2f};120" for n in range(200))
    (tmp_path / "a.csv").write_text(f"t [s];C [N.m];Fr [kN];n [tr/min]\n{rows}\n")
    with pytest.raises(GuessedError, match="'Fr \\[kN\\]'.*means normal force"):
        tl.read(tmp_path / "a.csv")


@pytest.mark.parametrize("said", ["2 Hz (0-30 s), 5 Hz (30-60 s)", "2 Hz / 5 Hz"])
def test_several_frequencies_in_a_line_are_asked_about(tmp_path, said):
    rows = "\n".join(f"{n / 200:.3f};{3 * (-1) ** (n // 50)};10" for n in range(2000))
    head = f"Stroke: 5 mm\nFrequency: {said}\nDrive: crank\nTime [s];Friction force [N];Load [N]"
    (tmp_path / "a.csv").write_text(f"{head}\n{rows}\n")
    with pytest.raises(GuessedError, match="the first holds all along"):
        tl.read(tmp_path / "a.csv")


@pytest.mark.parametrize("name", ["fuerza_friccion_N", "forza_attrito_N", "force_frottement_N"])
def test_a_force_of_friction_needs_no_article(tmp_path, name):
    rows = "\n".join(f"{n / 10:.1f};2.0;3.0;10" for n in range(200))
    (tmp_path / "a.csv").write_text(f"Time [s];Speed [mm/s];{name};Load [N]\n{rows}\n")
    assert float(tl.read(tmp_path / "a.csv").friction_force.mean()) == 3.0


@pytest.mark.parametrize(
    ("header", "left"),
    [
        ("Time [s];COF;Velocity [mm/s];Load", "Load"),
        ("Time [s];Friction force [N];Velocity [mm/s];Position;Normal force [N]", "Position"),
    ],
)
def test_a_doubtful_column_that_no_result_needs_is_left_out_and_reported(header, left, tmp_path):
    width = header.count(";") + 1
    rows = [[0.1 * n, 0.3, 2.0, 0.2 * n, 10.0][:width] for n in range(200)]
    path = tmp_path / "run.csv"
    lines = [header, *(";".join(f"{x:.3f}" for x in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", "utf-8")
    run = tl.read(path)
    assert left in run.attrs["left_out"] and left in run.attrs["columns_not_used"]
    assert float(run.sliding_velocity[0]) == pytest.approx(2e-3)


def test_a_doubtful_column_that_a_result_needs_is_asked_about(tmp_path):
    rows = "\n".join(f"{0.1 * n:.1f};3.0;2.0;10.0" for n in range(200))
    path = tmp_path / "run.csv"
    path.write_text(f"Time [s];Friction force [N];Velocity [mm/s];Load\n{rows}\n", "utf-8")
    with pytest.raises(GuessedError, match="in which unit"):
        tl.read(path)


def test_a_rock_friction_log_with_an_effective_stress_is_read_at_once(shared_data, tmp_path):
    source = shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt"
    text = source.read_text("utf-8").replace("Normal_stress", "Effective_Normal_stress", 1)
    (tmp_path / "rock.txt").write_text(text, "utf-8")
    run = tl.read(tmp_path / "rock.txt")
    assert float(run.normal_stress.median()) == pytest.approx(19.97e6, rel=1e-3)
    assert float(run.friction_coefficient.median()) == pytest.approx(0.61, abs=0.01)


def test_a_pressure_or_a_shear_stress_over_a_stated_area_is_a_force(tmp_path):
    for names, column in (
        ("Friction force [N];Normal stress [kPa]", "normal_force"),
        ("Shear stress [kPa];Normal force [N]", "friction_force"),
    ):
        rows = "\n".join(f"{0.1 * n:.1f};3.0;100.0;2.0" for n in range(100))
        head = f"Contact area (mm\u00b2): 100\nTime [s];{names};Velocity [mm/s]"
        (tmp_path / f"{column}.csv").write_text(f"{head}\n{rows}\n", "utf-8")
        size = {"normal_force": 10.0, "friction_force": 0.3}[column]
        np.testing.assert_allclose(tl.read(tmp_path / f"{column}.csv")[column], size)


def test_a_column_of_applied_masses_presses_with_their_weight(tmp_path):
    rows = "\n".join(f"{0.1 * n:.1f};3.0;1000;2.0" for n in range(100))
    head = "Time [s];Friction force [N];Applied mass [g];Velocity [mm/s]"
    (tmp_path / "mass.csv").write_text(f"{head}\n{rows}\n", "utf-8")
    np.testing.assert_allclose(tl.read(tmp_path / "mass.csv").normal_force, 9.80665)
