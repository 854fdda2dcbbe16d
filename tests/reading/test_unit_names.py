"""Units as laboratories write them in headers, and drafts that read back what they propose."""

import numpy as np
import pytest

from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft
from tribolab.reading.unknown_run import read_run
from tribolab.units.conversion import conversion
from tribolab.units.quantities import unit_conversion

LBF = 4.4482216152605
SPELT = {
    "s": {"Sec": 1, "Sekunden": 1, "с": 1, "mS": 1e-3, "Std": 3600, "秒": 1, "min.": 60},
    "N": {"Newtons": 1, "KN": 1e3, "kp": 9.80665, "Lbf": LBF, "lb-f": LBF, "Н": 1, "牛": 1},
    "m": {"mil": 2.54e-5, "mils": 2.54e-5, '"': 0.0254, "мкм": 1e-6, "mkm": 1e-6, "MM": 1e-3},
    "m/s": {"fpm": 0.3048 / 60, "ips": 0.0254, "мм/с": 1e-3, "mm/мин": 1e-3 / 60},
    "Pa": {"PSI": 6894.757293168, "kg/cm²": 98066.5, "Torr": 133.322368421, "Nmm-2": 1e6},
    "V": {"Volts": 1, "мВ": 1e-3},
    "ohm": {"Ohm": 1, "Ω": 1, "kΩ": 1e3, "mohm": 1e-3, "MOhm": 1e6, "Ом": 1, "µΩ": 1e-6},
    "N m": {"lb-in": LBF * 0.0254, "ft-lb": LBF * 0.3048, "kg·cm": 0.0980665, "g-cm": 9.80665e-5},
    "Pa s": {"mPas": 1e-3, "cp": 1e-3, "Poise": 0.1},
    "rad/s": {"об/мин": np.pi / 30, "vueltas/min": np.pi / 30, "r.p.m.": np.pi / 30},
    "1": {"none": 1, "n/a": 1, "sans unité": 1},
    "m**2/N": {"mm3/Nm": 1e-9},
}


@pytest.mark.parametrize(
    ("unit", "si_unit", "scale"),
    [(unit, si, scale) for si, units in SPELT.items() for unit, scale in units.items()],
)
def test_a_unit_is_known_as_laboratories_spell_it(unit, si_unit, scale):
    known = conversion(unit, si_unit, "cycles" if si_unit == "rad/s" else None)
    assert known == pytest.approx((scale, 0.0), rel=1e-9)


@pytest.mark.parametrize("unit", ["deg C", "℃", "Celsius", "oC", "DegC"])
def test_degrees_have_their_zero(unit):
    assert conversion(unit, "K") == pytest.approx((1.0, 273.15))


def test_fahrenheit_is_no_farad():
    scale, offset = conversion("F", "K")
    assert scale * 212 + offset == pytest.approx(373.15)


def a_file(folder, heading):
    """A run of strokes with another column, of the values 3.0 to 4.0."""
    time = np.arange(600) / 50
    place = 5 * abs((time / 2) % 2 - 1)
    force = 2 * np.sign(np.gradient(place)) + 0.01 * np.sin(37 * time)
    columns = time, place, force, 10 + 0.01 * np.cos(41 * time), 3.5 + 0.5 * np.sin(time)
    head = f"Time [s]\tPosition [mm]\tFriction force [N]\tNormal force [N]\t{heading}"
    rows = ("\t".join(f"{value:.6g}" for value in row) for row in zip(*columns, strict=True))
    file = folder / "file.txt"
    file.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return file


PROPOSED = {
    "Contact resistance [kOhm]": ("contact_resistance", 3500.0),
    "Résistance de contact (ohm)": ("contact_resistance", 3.5),
    "Übergangswiderstand [mΩ]": ("contact_resistance", 3.5e-3),
    "ECR [%]": ("electrical_contact_resistance", 0.035),
    "Temperature [deg C]": ("temperature", 276.65),
    "Temp. (℃)": ("temperature", 276.65),
    "Pressure [PSI]": ("ambient_pressure", 3.5 * 6894.757293168),
    "Voltage (Volts)": ("voltage", 3.5),
    "Cycles [cycles]": ("cycle", 3.5),
    "Wear volume [mm³]": (None, None),
    "Wear rate (mm3/Nm)": (None, None),
    "Wear area (µm²)": (None, None),
    "Charge [pC]": (None, None),
    "Motor current (A)": (None, None),
    "Humidity [%RH]": (None, None),
}


@pytest.mark.parametrize("heading", PROPOSED)
def test_a_draft_reads_back_what_it_proposes(heading, tmp_path):
    file = a_file(tmp_path, heading)
    name, mean = PROPOSED[heading]
    run = read_run(file)
    assert (abs(run.friction_force) / run.normal_force).median() == pytest.approx(0.2, abs=0.01)
    if name is None:
        assert heading.split()[0] in run.attrs["columns_not_used"]
    else:
        middle = (float(run[name].min()) + float(run[name].max())) / 2
        assert middle == pytest.approx(mean, rel=0.01)
    dialect = save_draft(draft_dialect(file, "own"), tmp_path / "own.toml")
    assert set(read_run(file, dialect).data_vars) == set(run.data_vars)


def test_a_count_of_cycles_is_in_cycles_alone():
    assert unit_conversion("cycles", "cycle") == (1.0, 0.0)
