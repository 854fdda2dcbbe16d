"""Quantities that no column holds follow by formulas; nothing in a formula is evaluated."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError, UnitError
from tribolab.reading.dialect.formula import evaluate, in_base_units, parse_formula

DISC = """
name = "disc"
title = "A pin on a disc"
[header]
line = 2
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "rotation_speed"
name = "Rot"
[[column]]
symbol = "torque"
name = "Torque"
[[column]]
symbol = "arm"
name = "Offset"
[[column]]
quantity = "normal_force"
name = "Load"
[[value]]
name = "track"
pattern = "track ([0-9.]+) mm"
unit = "mm"
to = "m"
"""
FORMULAS = """
[[derived]]
quantity = "friction_force"
formula = "torque / (track + arm)"
[[derived]]
quantity = "sliding_velocity"
formula = "rotation_speed * (track + arm)"
"""
DATA = """Pin on disc, track 12.5 mm
Time [s],Rot [rpm],Torque [N mm],Load [N],Offset [mm]
0.0,60,12.5,10,0.5
0.1,30,13.0,10,0.5
0.2,60,12.6,10,1.5
"""


def write(folder, dialect, data, name="disc.csv"):
    (folder / "disc.toml").write_text(dialect)
    (folder / name).write_text(data)
    return folder / name, folder / "disc.toml"


def test_torque_and_a_moving_radius_give_force_and_speed(tmp_path):
    run = tl.read(*write(tmp_path, DISC + FORMULAS, DATA))
    radius = np.array([13e-3, 13e-3, 14e-3])
    assert run["friction_force"].values == pytest.approx(
        np.array([12.5e-3, 13e-3, 12.6e-3]) / radius
    )
    speed = 2 * np.pi * np.array([1.0, 0.5, 1.0]) * radius
    assert run["sliding_velocity"].values == pytest.approx(speed)
    assert run["sliding_velocity"].attrs["units"] == "m/s"
    assert run.attrs["speed_from"] == "formula"
    assert run.attrs["derived"]["friction_force"] == "torque / (track + arm)"
    assert not {"torque", "arm"} & set(run)


def test_a_value_of_each_step_enters_a_formula(tmp_path):
    dialect = """
name = "steps"
title = "Steps"
[header]
pattern = '^Time'
repeats = true
step = '^Step (\\d+)'
[time]
restart = "continue"
[[column]]
quantity = "time"
name = "Time"
[[column]]
quantity = "friction_force"
name = "F"
[[column]]
quantity = "normal_force"
name = "L"
[[value]]
name = "track"
source = "step"
pattern = 'track (\\d+) mm'
unit = "mm"
to = "m"
[[value]]
name = "turns"
source = "step"
pattern = '(\\d+) rpm'
unit = "rpm"
to = "rad/s"
[[derived]]
quantity = "sliding_velocity"
formula = "turns * track"
"""
    head = "Time [s],F [N],L [N]\n0,1,2\n1,1,2\n"
    data = f"Step 1 track 10 mm 60 rpm\n{head}\nStep 2 track 20 mm 30 rpm\n{head}"
    dialect = dialect.replace("[time]", "[text]\nend = '^\\s*$'\n[time]")
    run = tl.read(*write(tmp_path, dialect, data))
    speed = 2 * np.pi * 1e-2 * np.ones(4)
    assert run["sliding_velocity"].values == pytest.approx(speed)
    assert "track" not in run and run["step"].values.tolist() == [1, 1, 2, 2]


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("torque + arm", "cannot be added"),
        ("torque * arm", "gives m3 kg/s2, and not N"),
    ],
)
def test_units_that_do_not_fit_are_told(tmp_path, formula, said):
    rule = f'[[derived]]\nquantity = "friction_force"\nformula = "{formula}"\n'
    with pytest.raises(ReadError, match=said):
        tl.read(*write(tmp_path, DISC + rule, DATA))


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        ("torque / radius", "called 'radius'"),
        ("torque / ", "invalid syntax"),
        ("__import__('os')", "'__import__.'os'.' is not allowed"),
        ("torque ** 2", "'torque .. 2' is not allowed"),
        ("torque * True", "'True' is not allowed"),
        ("torque / 'a' 'b'", "is not allowed"),
        ("torque / '3 parsnips'", "parsnips"),
        ("(" * 250 + "torque" + ")" * 40, "has to be names and numbers"),
    ],
)
def test_formulas_that_cannot_be_are_refused_when_the_dialect_is_read(tmp_path, formula, said):
    rule = f'[[derived]]\nquantity = "friction_force"\nformula = "{formula}"\n'
    with pytest.raises(ConfigError, match=said):
        tl.read(*write(tmp_path, DISC + rule, DATA))


def test_what_formulas_miss_is_told_at_once(tmp_path):
    data = DATA.replace("track 12.5 mm", "")
    with pytest.raises(ReadError) as error:
        tl.read(*write(tmp_path, DISC + FORMULAS, data))
    assert "friction_force = torque / (track + arm) needs track" in str(error.value)
    assert "sliding_velocity = rotation_speed * (track + arm) needs track" in str(error.value)


def test_columns_that_are_missing_are_told_at_once(tmp_path):
    data = DATA.replace("Torque", "Moment").replace("Load", "Last")
    with pytest.raises(ReadError) as error:
        tl.read(*write(tmp_path, DISC + FORMULAS, data))
    assert "'Torque' (torque) is missing" in str(error.value)
    assert "'Load' (normal_force) is missing" in str(error.value)


def test_a_symbol_without_a_unit_is_asked_for_it(tmp_path):
    data = DATA.replace("Torque [N mm]", "Torque")
    with pytest.raises(ReadError, match="'Torque' has no unit"):
        tl.read(*write(tmp_path, DISC + FORMULAS, data))


CHANNELS = """
name = "disc"
title = "Two load cells"
[header]
line = 1
[[column]]
quantity = "time"
name = "t"
[[column]]
quantity = "friction_force"
name = "F"
[[column]]
quantity = "normal_force"
name = "Fz low"
optional = true
[[column]]
quantity = "normal_force"
name = "Fz high"
optional = true
"""


@pytest.mark.parametrize(
    ("low", "high", "load"), [("5", "0", 5.0), ("0", "50", 50.0), ("", "50", 50.0), ("5", "", 5.0)]
)
def test_the_load_is_the_channel_that_is_filled(tmp_path, low, high, load):
    rows = "".join(f"{n / 10},1,{low},{high}\n" for n in range(5))
    run = tl.read(*write(tmp_path, CHANNELS, "t [s],F [N],Fz low [N],Fz high [N]\n" + rows))
    assert run["normal_force"].values.tolist() == [load] * 5
    other = "Fz high" if load == 5.0 else "Fz low"
    assert other in run.attrs["columns_not_used"]
    assert run.attrs["columns_used"]["normal_force"].startswith("Fz low" if load == 5 else "Fz hi")


def test_two_columns_for_one_quantity_have_to_be_optional(tmp_path):
    dialect = CHANNELS.replace("optional = true", "", 1)
    with pytest.raises(ConfigError, match="optional = true for all"):
        tl.read(*write(tmp_path, dialect, "t [s],F [N]\n0,1\n"))


def test_stresses_give_the_coefficient_as_forces_do(tmp_path):
    rng = np.random.default_rng(1)
    time = 0.01 * np.arange(2400)
    way = np.where((time // 6) % 2 == 0, 1.0, -1.0)
    shear = 1e5 * (0.4 * way + 0.01 * rng.standard_normal(time.size) + 0.05)
    table = np.column_stack([time, 1e-3 * way * 1e3, shear / 1e3, np.full(time.size, 0.1)])
    head = "t [s],v [mm/s],tau [kPa],sigma_n [MPa]"
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=head, comments="")
    columns = ("time", "t"), ("sliding_velocity", "v"), ("shear_stress", "tau")
    text = "".join(
        f'[[column]]\nquantity = "{quantity}"\nname = "{name}"\n'
        for quantity, name in (*columns, ("normal_stress", "sigma_n"))
    )
    (tmp_path / "a.toml").write_text(f'name = "a"\ntitle = "a"\n[header]\nline = 1\n{text}')
    run = tl.read(tmp_path / "a.csv", tmp_path / "a.toml")
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    error = (friction["friction_coefficient"] - 0.4) / friction["friction_coefficient_sem"]
    assert friction.sizes["segment"] == 4 and (np.abs(error.values) < 3.5).all()


NAMES = st.sampled_from(["a", "b", "pi", "'2 mm'", "3", "1.5e-3", "+", "-", "*", "/", "(", ")"])


@given(st.lists(NAMES, max_size=25).map(" ".join) | st.text(max_size=60))
def test_any_text_is_a_formula_or_a_clear_error(text):
    known = {"a": in_base_units(np.array([1.0, -2.0, 0.0]), "m"), "b": in_base_units(3.0, "m")}
    try:
        parse_formula(text)
        value = evaluate(text, known, "m")
    except UnitError as error:
        assert "formula" in str(error)
    else:
        plain = text.replace("'2 mm'", "2e-3")
        with np.errstate(all="ignore"):
            same = eval(
                plain,
                {"__builtins__": {}},
                {"a": known["a"].value, "b": np.float64(3), "pi": np.pi},
            )  # noqa: E501, S307
        np.testing.assert_allclose(value, same, rtol=1e-12)
