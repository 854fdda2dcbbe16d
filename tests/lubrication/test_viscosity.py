"""Viscosity of liquids known by name, against published numbers."""

import numpy as np
import pytest

from tribolab.core.errors import TribolabError
from tribolab.lubrication.viscosity import liquid_viscosity


def test_glycerol_with_one_per_cent_of_water_is_as_published():
    found = liquid_viscosity("glycerol", "23 °C", "1 %")
    assert found.value == pytest.approx(0.872, abs=5e-4)
    assert found.per_kelvin == pytest.approx(-0.086, abs=5e-4)
    assert -0.01 * found.per_water == pytest.approx(0.21, abs=5e-3)
    half = 1 / np.sqrt(3)  # half a degree and a per cent of water make twelve
    bare = found._replace(formula=0.0)
    assert bare.uncertainty(0.5 * half, 0.01 * half) == pytest.approx(0.12, abs=0.005)


@pytest.mark.parametrize(
    ("liquid", "temperature", "milli", "within"),
    [
        ("glycerol", "20 °C", 1412, 0.01),  # Segur and Oberstar (1951)
        ("glycerol", "25 °C", 934, 0.04),
        ("water", "20 °C", 1.0016, 0.005),  # IAPWS
        ("water", "40 °C", 0.6527, 0.005),
        ("silicone oil 1000 cSt", "25 °C", 970, 1e-6),
        ("silicone oil 100 cSt", "25 °C", 96.5, 1e-6),
    ],
)
def test_liquids_have_their_published_viscosity(liquid, temperature, milli, within):
    found = liquid_viscosity(liquid, temperature)
    assert 1e3 * found.value == pytest.approx(milli, rel=within)


def test_oils_fall_by_what_the_table_says_and_grades_between_lie_between():
    cold, warm = (liquid_viscosity("silicone oil 100 cSt", t + 273.15).value for t in (37.8, 98.9))
    thinner = 1 - 9.5e-4 * (98.9 - 37.8) / (1 - 9.5e-4 * (37.8 - 25))
    assert 1 - warm / cold / thinner == pytest.approx(0.60, abs=1e-3)
    values = [liquid_viscosity(f"silicone oil {n} cSt", 300.0).value for n in (100, 350, 1000)]
    assert values == sorted(values)


def test_derivatives_are_those_of_the_value():
    for liquid, water in (("glycerol", 0.1), ("water", 0.0), ("silicone oil 350 cSt", 0.0)):
        found = liquid_viscosity(liquid, 296.0, water)
        warmer = liquid_viscosity(liquid, 296.1, water).value
        assert np.log(warmer / found.value) / 0.1 == pytest.approx(found.per_kelvin, rel=0.01)
    wetter = liquid_viscosity("glycerol", 296.0, 0.101).value
    mixed = liquid_viscosity("glycerol", 296.0, 0.1)
    assert np.log(wetter / mixed.value) / 0.001 == pytest.approx(mixed.per_water, rel=0.01)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("glycrol", 296.0), "did you mean 'glycerol'"),
        (("silicone oil 1e9 cSt", 296.0), "from 1 to 100000 cSt"),
        (("water", "120 °C"), "from 0 to 100 °C"),
        (("water", 296.0, 0.1), "water in glycerol"),
        (("glycerol", "23"), "no unit"),
    ],
)
def test_what_is_not_known_is_said(given, words):
    with pytest.raises(TribolabError, match=words):
        liquid_viscosity(*given)
