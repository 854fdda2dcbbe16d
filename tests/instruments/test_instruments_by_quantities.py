"""Instruments whose tables nobody published: known by their name and by what they measure."""

import numpy as np
import pytest
from file_kinds import AT_ONCE, judge, read_in_some_way
from layouts import write_kind

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError
from tribolab.qc.run.checks import check_run
from tribolab.reading.dialect.find import known_dialects, load_dialect, recognise

SECONDS = np.arange(120.0)
HFRR = ("Time (s)", "Friction coefficient", "Film (%)", "Temperature (°C)")


def rng(seed=0):
    return np.random.default_rng(seed)


def table(names, columns, mark=",", point="."):
    rows = zip(*(np.broadcast_to(c, np.shape(columns[0])) for c in columns), strict=True)
    body = "".join(mark.join(f"{v:.6f}".replace(".", point) for v in row) + "\n" for row in rows)
    return mark.join(names) + "\n" + body


def said_elsewhere(run):
    return [result for check, result in check_run(run).results if check.name == "said_elsewhere"]


def hfrr(mark=",", point="."):
    columns = [SECONDS, 0.2 + 0.01 * np.sin(SECONDS), 30 + SECONDS / 10, 60]
    return columns, table(HFRR, columns, mark, point)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
@pytest.mark.parametrize(("mark", "point"), [(",", "."), (";", ","), ("\t", "."), ("\t", ",")])
def test_a_table_is_understood_however_it_is_delimited(mark, point, encoding, tmp_path):
    columns, text = hfrr(mark, point)
    file = tmp_path / "test.csv"
    head = f"HFRR test report\nStroke: 1{point}5 mm\nFrequency: 40 Hz\nLoad: 500 g\n"
    file.write_bytes((head + text).encode(encoding))
    run = tl.read(file)
    assert run.attrs["instrument"] == "pcs_hfrr"
    np.testing.assert_allclose(run.time, SECONDS)
    np.testing.assert_allclose(run.friction_coefficient, columns[1], atol=1e-6)
    np.testing.assert_allclose(run.temperature, 333.15)
    np.testing.assert_allclose(run.electrical_contact_resistance, columns[2] / 100, atol=1e-6)
    np.testing.assert_allclose(run.normal_force, 0.5 * 9.80665)
    assert run.attrs["set_speed_m_s"] == pytest.approx(2 * 1.5e-3 * 40)
    assert "assumed" not in run.attrs


def test_what_the_standard_fixes_stands_for_what_the_file_does_not_say_and_is_told(tmp_path):
    _, text = hfrr()
    file = tmp_path / "test.csv"
    file.write_text(f"HFRR\nStroke (um),2000\n{text}", encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["set_speed_m_s"] == pytest.approx(2 * 2e-3 * 50)
    np.testing.assert_allclose(run.normal_force, 0.2 * 9.80665)
    assert run.attrs["assumed"] == "stroke_frequency 50 Hz; load 200 gf"
    told = said_elsewhere(run)
    assert [x.status for x in told] == ["pass"] and "50 Hz" in told[0].message


def test_units_may_stand_below_the_names(tmp_path):
    names = ("Time", "Load", "Stroke", "Frequency", "COF")
    body = table(names, [SECONDS, 200, 1.5, 50, 0.11]).split("\n", 1)
    file = tmp_path / "run.txt"
    file.write_text(f"OPTIMOL SRV5\n{body[0]}\ns,N,mm,Hz,-\n{body[1]}", encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["instrument"] == "optimol_srv"
    assert run.attrs["set_speed_m_s"] == pytest.approx(2 * 1.5e-3 * 50)
    np.testing.assert_allclose(run.normal_force, 200)
    np.testing.assert_allclose(run.friction_coefficient, 0.11)


def test_an_oscillating_run_without_its_stroke_says_what_is_missing(tmp_path):
    file = tmp_path / "run.txt"
    file.write_text("SRV\n" + table(("Time [s]", "COF"), [SECONDS, 0.1]), encoding="utf-8")
    with pytest.raises(ReadError, match="the stroke and the frequency is missing"):
        tl.read(file)


@pytest.mark.parametrize("unit", ["N", "kgf", "lbf"])
@pytest.mark.parametrize("maker", ["IMADA ZT-Logger", "SHIMPO FG-7000"])
def test_a_force_gauge_alone_gives_a_force_with_its_sign(maker, unit, tmp_path):
    force = 3 * np.sign(np.sin(SECONDS / 9 + 0.1)) + 0.01 * rng().standard_normal(SECONDS.size)
    names = ("No.", "Time [s]", f"Force [{unit}]")
    file = tmp_path / "pull.csv"
    file.write_text(f"{maker}\n" + table(names, [SECONDS, SECONDS / 10, force]), encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["instrument"] == "force_gauge"
    newton = {"N": 1.0, "kgf": 9.80665, "lbf": 4.4482216}[unit]
    np.testing.assert_allclose(run.friction_force, force * newton, atol=1e-5 * newton)
    assert "normal_force" not in run


@pytest.mark.parametrize("name", ["optimol_srv", "pcs_hfrr", "tribox"])
def test_files_of_the_rig_s_are_known_and_right(name, tmp_path):
    made = write_kind(name, tmp_path, seed=70)
    read = read_in_some_way(made, tmp_path)
    assert read.way == AT_ONCE and read.run.attrs["instrument"] == name
    assert not judge(made, read.run).faults


FOREIGN = {
    "a rheometer's note on a lubricant": "Compared with HFRR\nTime [s],Shear stress [Pa]\n",
    "a servo": "SRV\nTime [s],Position [mm]\n",
    "a hand-written table": "my HFRR-like rig\nt,mu\n",
    "a testing machine": "with Imada grips\nTime [s],Load [N]\n",
    "friction with a gauge's name": "Imada\nTime [s],Friction force [N],Normal force [N]\n",
    "no name": "Time (s),Friction coefficient,Film (%),Temperature (°C)\n",
    "a gauge without its name": "No.,Time [s],Force [N]\n",
}


@pytest.mark.parametrize("what", FOREIGN)
def test_files_of_others_are_not_taken_for_these(what, tmp_path):
    file = tmp_path / "other.csv"
    cells = FOREIGN[what].rstrip("\n").rsplit("\n", 1)[-1].count(",") + 1
    rows = "".join(",".join([str(n)] * cells) + "\n" for n in range(30))
    file.write_text(FOREIGN[what] + rows, encoding="utf-8")
    with pytest.raises(ReadError, match="no known instrument"):
        recognise(file)


def test_a_pin_on_disc_tester_of_known_layout_stays_itself_under_its_program_s_name(tmp_path):
    names = ("Time [s]", "Distance [m]", "Laps", "Nominal Load [N]", "µ", "Linear Position [mm]")
    text = table((*names, "Friction Force [N]"), [SECONDS, 1, 1, 5, 0.2, SECONDS, 1], "\t")
    file = tmp_path / "disc.txt"
    file.write_text(f"TriboX 4.5\n{text}", encoding="utf-8")
    assert recognise(file).name == "anton_paar_trb3_linear"


def test_named_a_table_needs_no_maker_s_name(tmp_path):
    names = ("Time [s]", "Laps", "Fn [N]", "Ft [N]", "COF", "Speed [cm/s]")
    file = tmp_path / "run.csv"
    file.write_text(table(names, [SECONDS, SECONDS, -5, 1, 0.2, 10], ";", ","), encoding="utf-8")
    run = tl.read(file, "tribox")
    np.testing.assert_allclose(run.normal_force, 5)
    np.testing.assert_allclose(run.sliding_velocity, 0.1)


# Torque and axial force of a rheometer: ball of 12.7 mm on three plates at 45 degrees.
ARM, SHARE = 6.35e-3 * np.sin(np.pi / 4), np.cos(np.pi / 4)


def cell(mu, axial, *, arm=ARM, share=SHARE, force=False, torque=True):
    """Return an export with the torque that a coefficient makes under an axial force."""
    names = ["Interval data:", "Point No.", "Time", "Sliding Speed", "Friction Factor"]
    units = ["", "", "[s]", "[m/s]", "[1]"]
    friction = mu * axial / share
    columns = [np.arange(1, mu.size + 1), 10.0 * np.arange(1, mu.size + 1), 1e-3, mu]
    more = [("Torque", "[mN·m]", 1e3 * friction * arm)] if torque else []
    more += [("Friction Force", "[N]", friction)] if force else []
    for name, unit, values in [*more, ("Normal Force", "[N]", axial)]:
        names.append(name)
        units.append(unit)
        columns.append(values)
    tabs = "\t" * (len(names) - 1)
    head = f"Interval and data points:\t1\t{mu.size}\n" + "\t".join(names)
    head += f"\n{tabs}\n" + "\t".join(units) + "\n"
    rows = zip(*(np.broadcast_to(c, mu.size) for c in columns), strict=True)
    return head + "".join("\t" + "\t".join(f"{v:.6g}" for v in row) + "\n" for row in rows)


def stribeck(seed):
    draw = rng(seed)
    return 0.05 + 0.1 * draw.random(50), 10 + 0.1 * draw.standard_normal(50)


def written(tmp_path, text):
    file = tmp_path / "stribeck.csv"
    file.write_bytes(text.encode("utf-16"))
    return file


@pytest.mark.parametrize("force", [False, True])
def test_torque_and_axial_force_make_the_forces_of_three_plates(force, tmp_path):
    mu, axial = stribeck(1)
    run = tl.read(written(tmp_path, cell(mu, axial, force=force)))
    assert run.attrs["instrument"] == "anton_paar_mcr_tribology"
    np.testing.assert_allclose(run.normal_force, axial * np.sqrt(2), rtol=2e-5)
    np.testing.assert_allclose(run.friction_force, mu * axial * np.sqrt(2), rtol=2e-5)
    np.testing.assert_allclose(run.friction_force / run.normal_force, mu, rtol=4e-5)
    assert run.attrs["ratio_to_stated_coefficient"] == pytest.approx(1, abs=1e-4)
    assert ("6.35 mm" in run.attrs["assumed"]) is not force
    assert "axial_share 0.70711" in run.attrs["assumed"] and "forces_left_out" not in run.attrs


def test_forces_of_another_cell_are_left_out_and_told(tmp_path):
    mu, axial = stribeck(2)  # a pin on a disc at 12 mm: what is axial presses as it is
    file = written(tmp_path, cell(mu, axial, arm=12e-3, share=1.0))
    run = tl.read(file)
    assert not {"friction_force", "normal_force"} & set(run)
    np.testing.assert_allclose(run.friction_coefficient, mu, atol=1e-6)
    factor = 12e-3 / ARM * SHARE
    assert run.attrs["ratio_to_stated_coefficient"] == pytest.approx(factor, rel=1e-3)
    told = said_elsewhere(run)
    assert "suspect" in [x.status for x in told]
    known = known_dialects()["anton_paar_mcr_tribology"].read_text(encoding="utf-8")
    own = known.replace('"6.35 mm"', '"12 mm"').replace('"0.70711"', '"1"')
    (tmp_path / "mine.toml").write_text(own, encoding="utf-8")
    mended = tl.read(file, tmp_path / "mine.toml")
    np.testing.assert_allclose(mended.normal_force, axial, rtol=1e-5)
    np.testing.assert_allclose(mended.friction_force, mu * axial, rtol=2e-5)


def test_without_torque_nothing_confirms_the_geometry_and_the_load_stands_as_it_is(tmp_path):
    mu, axial = stribeck(3)
    run = tl.read(written(tmp_path, cell(mu, axial, torque=False)))
    np.testing.assert_allclose(run.normal_force, axial, rtol=1e-5)
    assert "friction_force" not in run


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('delimiter = "any"', 'delimiter = "some"', "'whitespace' or 'any'"),
        ("pattern = '(?i)^(?=", "patter = '(?i)^(?=", "no such key"),
        ('default = "1 mm"', 'default = "1 N"', "a value in m is wanted"),
        ('formula = "load"', 'formula = "load"\nbeside = ["lode"]', "called 'lode'"),
        ("name_pattern = '(?i)frequency'", "name = 'f'\nname_pattern = 'f'", "either name, name_p"),
    ],
)
def test_a_mistake_in_such_a_description_is_told(old, new, said, tmp_path):
    text = known_dialects()["pcs_hfrr"].read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "mine.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ConfigError, match=said):
        load_dialect(tmp_path / "mine.toml")
