"""Cycles are 2 pi: what a unit per time counts, for every quantity and in every way of writing."""

import numpy as np
import pytest
from dialects import dialect_of

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError, TribolabError, UnitError
from tribolab.reading.unit_texts import is_unit
from tribolab.rubber.modulus import read_modulus
from tribolab.units.conversion import conversion, to_si
from tribolab.units.quantities import QUANTITIES, dictionary, quantity, unit_conversion
from tribolab.units.reciprocals import reciprocal
from tribolab.units.stamping import labelled

PER_MINUTE = (
    "1/min /min min-1 min^-1 min⁻¹ min−1 min**-1 rev/min rev./min r/min U/min Umdr./min tr/min "
    "giri/min rpm RPM r.p.m. cpm cycles/min turns/min [1/min]"
).split() + ["1 / min", "rev per minute", "min^{-1}"]
PER_SECOND = "1/s s-1 s⁻¹ Hz rps rev/s turn/s cycles/s cps".split()


@pytest.mark.parametrize("unit", PER_MINUTE)
def test_a_rotation_speed_per_minute_counts_turns(unit):
    assert unit_conversion(unit, "rotation_speed")[0] == pytest.approx(2 * np.pi / 60, rel=1e-14)
    assert unit_conversion(unit, "frequency")[0] == pytest.approx(1 / 60, rel=1e-14)


@pytest.mark.parametrize("unit", PER_SECOND)
def test_a_rotation_speed_per_second_counts_turns(unit):
    assert unit_conversion(unit, "rotation_speed")[0] == pytest.approx(2 * np.pi, rel=1e-14)


@pytest.mark.parametrize(
    ("unit", "rad_s"),
    [
        ("rad/s", 1),
        ("rad s^-1", 1),
        ("rad·s⁻¹", 1),
        ("°/s", np.pi / 180),
        ("deg/min", np.pi / 10800),
    ],
)
def test_radians_and_degrees_stay_what_they_are(unit, rad_s):
    for name in ("rotation_speed", "angular_frequency"):
        assert unit_conversion(unit, name)[0] == pytest.approx(rad_s, rel=1e-14)
    assert unit_conversion(unit, "frequency")[0] == pytest.approx(rad_s / 2 / np.pi, rel=1e-14)


@pytest.mark.parametrize("unit", ["1/s", "s-1", "1/min", "/h"])
def test_where_cycles_and_radians_are_both_usual_the_error_asks(unit):
    with pytest.raises(UnitError, match="cycles or radians.*write 'cycles/.*' or 'rad/"):
        unit_conversion(unit, "angular_frequency")
    assert unit_conversion("Hz", "angular_frequency")[0] == pytest.approx(2 * np.pi)


@pytest.mark.parametrize("unit", ["Hz", "rpm", "rad/s", "krpm", "deg/s"])
def test_a_shear_rate_counts_nothing(unit):
    with pytest.raises(UnitError, match="counts"):
        unit_conversion(unit, "shear_rate")
    assert unit_conversion("1/min", "shear_rate")[0] == pytest.approx(1 / 60)


def test_wavenumbers_count_radians_and_inverse_wavelengths_cycles():
    assert unit_conversion("1/mm", "wavenumber") == (1000.0, 0.0)
    assert unit_conversion("cycles/mm", "wavenumber")[0] == pytest.approx(2000 * np.pi)
    assert unit_conversion("rad/mm", "inverse_wavelength")[0] == pytest.approx(500 / np.pi)
    assert labelled(["1 1/mm"], "inverse_wavelength").item() == 1000.0


def test_every_quantity_per_time_or_length_says_what_it_counts():
    for known in QUANTITIES.values():
        counted = reciprocal(known.unit) is not None or known.name == "cycle"
        assert (known.bare is not None) == counted, known.name
    with pytest.raises(TribolabError, match="does not name what it counts"):
        dictionary([("spin", "n", "1/s", "spin")])
    assert quantity("rotation_speed_std").bare == "cycles"


def test_a_second_entry_of_one_name_is_refused():
    rows = [("gap", "u", "m", "gap"), ("gap", "g", "m", "another gap")]
    with pytest.raises(TribolabError, match="'gap' stands twice.*'gap' and as 'another gap'"):
        dictionary(rows)
    assert quantity("balance_residual").long_name != quantity("residual").long_name


def test_an_angle_is_no_pure_number_and_a_rare_unit_is_still_read():
    with pytest.raises(UnitError, match="angle"):
        to_si("17 deg", "1")
    assert to_si("60 deg", "rad") == pytest.approx(np.pi / 3)
    assert conversion("mm/s/mm", "rad/s", "cycles")[0] == pytest.approx(2 * np.pi)
    assert to_si("2 kHz", "Hz") == 2000.0 and is_unit("rpm") and is_unit("U/min")


ROTATION = '[speed]\nsource = "rotation"\nradius = "21.5 mm"\n'
DIALECT = dialect_of("disc", more=ROTATION, time="t", rotation_speed="n", friction_force="F")


@pytest.mark.parametrize("unit", ["1/min", "min-1", "rev/min", "U/min", "rpm"])
def test_the_sliding_speed_of_a_disc_is_that_of_its_turns(tmp_path, unit):
    (tmp_path / "disc.toml").write_text(DIALECT)
    (tmp_path / "disc.csv").write_text(f"t [s],n [{unit}],F [N]\n0,37,1\n1,74,1\n")
    run = tl.read(tmp_path / "disc.csv", tmp_path / "disc.toml")
    speeds = 0.0215 * 2 * np.pi / 60 * np.array([37.0, 74.0])
    np.testing.assert_allclose(run["sliding_velocity"], speeds, rtol=1e-14)


def test_a_radius_in_words_is_told_how_a_value_is_named(tmp_path):
    (tmp_path / "disc.toml").write_text(DIALECT.replace("21.5 mm", "shaft_diameter / 2"))
    (tmp_path / "disc.csv").write_text("t [s],n [rpm],F [N]\n0,37,1\n1,74,1\n")
    with pytest.raises(ConfigError, match="write radius_value = .* scale = 0.5"):
        tl.read(tmp_path / "disc.csv", tmp_path / "disc.toml")


def test_a_single_value_counts_as_its_quantity_does_and_one_of_no_quantity_asks(tmp_path):
    value = '[[value]]\nname = "{}"\npattern = "n=(.*)"\nunit = "1/min"\n{}'
    file, dialect = tmp_path / "disc.csv", tmp_path / "disc.toml"
    file.write_text("n=30\nt [s],n [rpm],F [N]\n0,37,1\n1,74,1\n")
    below = DIALECT.replace("line = 1", "line = 2")
    dialect.write_text(below + value.format("rotation_speed", ""))
    assert tl.read(file, dialect).attrs["rotation_speed_rad_s"] == pytest.approx(np.pi)
    dialect.write_text(below + value.format("motor", 'to = "rad/s"'))
    with pytest.raises(ConfigError, match="cycles or radians"):
        tl.read(file, dialect)


@pytest.mark.parametrize(
    ("name", "unit", "factor"),
    [("f", "Hz", 2 * np.pi), ("f", "1/s", 2 * np.pi), ("f", "rad/s", 1), ("omega", "rad/s", 1)],
)
def test_a_modulus_is_read_over_radians(tmp_path, name, unit, factor):
    file = tmp_path / "dma.csv"
    file.write_text(f"{name},E',E''\n{unit},MPa,MPa\n0.5,1.5,0.1\n10,1.8,0.3\n")
    np.testing.assert_allclose(read_modulus(file).angular_frequency, np.array([0.5, 10]) * factor)


@pytest.mark.parametrize(("unit", "told"), [("1/s", "cycles or radians"), ("Hz", "says radians")])
def test_a_modulus_over_omega_in_cycles_asks(tmp_path, unit, told):
    file = tmp_path / "dma.csv"
    file.write_text(f"omega,E',E''\n{unit},MPa,MPa\n0.5,1.5,0.1\n10,1.8,0.3\n")
    with pytest.raises(ReadError, match=told):
        read_modulus(file)
