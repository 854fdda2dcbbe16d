"""Units at the edge and the dictionary of quantities."""

import contextlib

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.core.errors import TribolabError, UnitError
from tribolab.units import common_units as common
from tribolab.units import conversion as units
from tribolab.units.conversion import conversion, positive, registry, to_si
from tribolab.units.grammar import parse_unit
from tribolab.units.quantities import QUANTITIES, quantity
from tribolab.units.stamping import labelled, stamp


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("31 N", "N", 31.0),
        ("7 cm", "m", 0.07),
        ("1.4 Pa s", "Pa s", 1.4),
        ("51 mJ/m^2", "J/m2", 0.051),
        ("20 °C", "K", 293.15),
        ("-200 gf", "N", -1.96133),
        ("60 rpm", "rad/s", 2 * np.pi),
        ("1e3 µm/s", "m/s", 1e-3),
        (0.25, "m", 0.25),
    ],
)
def test_text_with_a_unit_becomes_si(text, unit, expected):
    assert to_si(text, unit) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "words"),
    [("31", "has no unit"), ("N", "has no number"), ("3 parsecs/N", "load"), ("3 s", "load")],
)
def test_bad_units_say_what_and_where(text, words):
    with pytest.raises(UnitError, match="load") as caught:
        to_si(text, "N", name="load")
    assert words in str(caught.value)


def test_usual_units_are_what_the_units_library_says():
    prefixed = [(f"{p}{u}", u) for p in common._PREFIXES for u in ("m", "m/s", "N", "Pa", "s", "V")]
    for unit, si_unit in [*common.CONVERSIONS, *prefixed]:
        ureg = units.registry()
        source, target = (
            ureg.Unit(units.pint_spelling(unit)),
            ureg.Unit(units.pint_spelling(si_unit)),
        )
        zero, one = (ureg.Quantity(x, source).to(target).magnitude for x in (0.0, 1.0))
        assert conversion(unit, si_unit) == pytest.approx((one - zero, zero), rel=1e-14), unit


def test_what_is_told_without_the_units_library_is_what_it_says():
    ureg = registry()
    for prefix in ("", "p", "n", "u", "m", "c", "k", "M", "G"):
        for unit in ("s", "m", "N", "Pa", "V", "m/s"):
            for asked in common._ASKED:
                if common.measures_another(prefix + unit, asked):
                    target = ureg.Unit(units.pint_spelling(asked).replace(" ", "*"))
                    assert not ureg.Unit(prefix + unit).is_compatible_with(target), (unit, asked)
    assert not common.measures_another("mN", "N") and common.measures_another("mN", "m")


def test_every_unit_in_the_dictionary_is_si():
    for known in QUANTITIES.values():
        assert conversion(known.unit, known.unit) == (1.0, 0.0), known.name


def test_stamp_overwrites_what_arithmetic_carried_along():
    run = stamp(
        xr.Dataset(
            {"friction_force": ("time", [1.0, 2.0]), "normal_force": ("time", [4.0, 4.0])},
            coords={"time": [0.0, 1.0]},
        )
    )
    with xr.set_options(keep_attrs=True):
        ratio = (run.friction_force / run.normal_force).to_dataset(name="friction_coefficient")
    assert stamp(ratio).friction_coefficient.attrs["units"] == "1"
    assert run.friction_force.attrs["units"] == "N"
    assert run.time.attrs["units"] == "s"


def test_stamp_refuses_unknown_names_and_names_the_nearest():
    with pytest.raises(TribolabError, match="normal_force"):
        stamp(xr.Dataset({"normal_forse": ("time", [1.0])}))


def test_derived_quantities_follow_their_base():
    assert quantity("friction_force_sem").unit == "N"


def test_lists_of_text_are_quantities_like_text_and_numbers():
    assert labelled(["42 kPa", 1e5, np.str_("0.1 MPa")], "pressure").values.tolist() == [
        42e3,
        1e5,
        1e5,
    ]
    over = xr.DataArray(["310 N/m", "9.1 N/cm"], dims="run")
    assert labelled(over, "load").values.tolist() == [310.0, 910.0]
    assert labelled(over, "load").dims == ("run",)


@pytest.mark.parametrize(
    "wrong", [["42 kN"], ["42"], [None, 1.0], [[1.0], [1.0, 2.0]], {}, [1j], ["x", 1.0]]
)
def test_what_is_no_quantity_is_refused_by_its_name(wrong):
    with pytest.raises(UnitError, match="pressure: "):
        labelled(wrong, "pressure")


@pytest.mark.parametrize("wrong", [["310 N/m"], None, {}])
def test_several_values_where_one_is_wanted_are_refused(wrong):
    with pytest.raises(UnitError, match="load: one number"):
        positive(wrong, "N/m", "load")


@pytest.mark.parametrize(
    "text",
    [
        *("9**9**9**9", "9**9", "m**9**9", "10**1000 N", "m^99999", "1e400 m", "N" * 5000),
        *("__import__('os').getpid()", "m.__class__", "(" * 5000 + "m", "N/0", "N**", "*N", "N)"),
        *("N; m", "lambda: 1", "N//m", "\x1b[31mN", "m**(1/0)", "10**10**10"),
    ],
)
def test_units_are_parsed_and_never_evaluated(text):
    with pytest.raises(UnitError) as caught:
        conversion(text, "N")
    assert len(str(caught.value)) < 300 and str(caught.value).isprintable()
    with pytest.raises(UnitError):
        to_si(f"1 {text}", "N")


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet="mNs19.*/^()- kµ%e+", max_size=40))
def test_any_text_is_a_unit_or_an_error_at_once(text):
    with contextlib.suppress(UnitError):
        parsed = parse_unit(text)
        assert 1e-60 < abs(parsed.factor) < 1e60
        assert all(abs(power) <= 12 for power in parsed.powers.values())


def test_products_and_quotients_go_from_left_to_right():
    ureg = registry()
    for text in ("N/m*s", "kg*m**2/s**3", "N/(m*s)", "mm**-1", "J/mol/K", "m*(s/kg)**2"):
        factor, powers = parse_unit(text)
        mine = ureg.Unit("")
        for name, power in powers.items():
            mine = mine * ureg.Unit(name) ** power
        assert factor == 1.0 and mine == ureg.Unit(text)


def test_a_number_that_is_none_is_refused():
    with pytest.raises(UnitError, match="larger than any number"):
        to_si("1e999 N", "N")
