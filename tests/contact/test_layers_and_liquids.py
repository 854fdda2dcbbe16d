"""Elastic layers, two soft bodies, flooded outlets and shear-thinning liquids."""

from dataclasses import replace

import numpy as np
import pytest
from ball_cases import COARSE
from contact_cases import CONTACT, reference_psd

from tribolab.contact.geometry import LineContact, PointContact
from tribolab.contact.hertz import hertz_half_width, hertz_max_pressure
from tribolab.contact.layer import layer_compliance
from tribolab.contact.line import rough_line_contact
from tribolab.contact.point import rough_point_contact
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.parameters import Interface, Liquid, parameters_of
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.lubrication.thinning import (
    carreau_yasuda,
    cross,
    power_law,
    rheometer_table,
    viscous_heating,
)

# thickness [mm]: half-width [mm] and highest pressure [kPa] at 310 and 2110 N/m
LAYERS = {
    2: (2.4523, 86.56, 4.4692, 345.9),
    5: (3.1564, 63.56, 6.3075, 229.8),
    10: (3.5061, 56.42, 7.7460, 178.4),
    20: (3.6551, 54.01, 8.8667, 152.3),
}
SPEEDS = [1e-4, 1e-3, 1e-2, 0.1]
# friction of the fluid with the outlet vented, flooded down to -20 kPa and to -1 bar
OUTLETS = {
    None: (
        [0.002121, 0.006116, 0.019603, 0.070447],
        [0.002351, 0.007470, 0.027333, 0.112447],
        [0.002351, 0.007470, 0.027333, 0.114436],
    ),
    "Sb-S": (
        [0.009745, 0.011897, 0.019777, 0.070467],
        [0.010354, 0.013859, 0.027561, 0.112481],
        [0.010354, 0.013859, 0.027561, 0.114473],
    ),
}
XANTHAN = carreau_yasuda("10 s", 0.4, rest=0.002)


@pytest.mark.parametrize("thickness", LAYERS)
def test_line_contacts_on_layers(thickness):
    layer = replace(CONTACT, thickness=thickness * 1e-3)
    loads = np.array([310.0, 2110.0])
    found = np.stack([hertz_half_width(loads, layer) * 1e3, hertz_max_pressure(loads, layer) / 1e3])
    assert found.T.ravel() == pytest.approx(LAYERS[thickness], rel=5e-4)


@pytest.mark.parametrize(
    ("contact", "limit"),
    [
        (LineContact(1.0, 1.0, 1.5, 0.5), lambda f, d: (15 * f * d**3 / (2 * 0.5)) ** (1 / 5)),
        (PointContact(1.0, 1.5, 0.5), lambda f, d: (32 * f * d**3 / (np.pi * 0.5)) ** (1 / 6)),
    ],
)
def test_thin_layers_go_slowly_to_their_limit(contact, limit):
    ratios = []
    for d in (0.003, 0.001):
        layer = replace(contact, thickness=d)
        # the limit takes the load at which the contact is some 6.5 and 20 thicknesses wide
        load = 0.5 * (0.02 / limit(1.0, d)) ** (6 if contact.is_round else 5)
        ratios.append(hertz_half_width(load, layer) / limit(load, d))
    assert 0.75 < ratios[0] < ratios[1] < 1
    assert hertz_half_width(1e-9, replace(contact, thickness=1e3)) == pytest.approx(
        hertz_half_width(1e-9, contact), rel=1e-6
    )


def test_a_layer_yields_as_theory_says():
    assert layer_compliance(np.array([20.0]), 0.3) == pytest.approx(1, abs=1e-12)
    x = np.array([1e-3])  # uniaxial: d (1 + nu)(1 - 2 nu)/(E (1 - nu)) over 2/(E* q)
    assert layer_compliance(x, 0.3) == pytest.approx(x * 0.4 / (2 * 0.7**2), rel=1e-3)


def test_rough_contacts_on_layers_are_as_wide_as_smooth_ones():
    psd = reference_psd("Smooth")
    layer = replace(CONTACT, thickness=5e-3)
    rough = rough_line_contact(2110.0, layer, psd)
    assert float(rough.max_pressure) == pytest.approx(229.8e3, rel=5e-3)
    ball = PointContact("70 mm", "1.5 MPa", 0.5, thickness="2 mm")
    rough = rough_point_contact(5.0, ball, psd)
    assert float(rough.max_pressure) == pytest.approx(hertz_max_pressure(5.0, ball), rel=1e-2)


def test_a_lubricated_layer_has_a_thinner_film_and_its_pressure():
    thick, thin = (
        stribeck_curve(replace(CONTACT, thickness=d), None, 1.4, 2110.0, 0.0, [1e-3])
        for d in (1.0, 2e-3)
    )
    plain = stribeck_curve(CONTACT, None, 1.4, 2110.0, 0.0, [1e-3])
    assert float(thick.minimum_separation[0]) == pytest.approx(
        float(plain.minimum_separation[0]), rel=1e-3
    )
    assert float(thin.minimum_separation[0]) < 0.9 * float(plain.minimum_separation[0])
    assert abs(float(thin.load_balance[0])) < 1e-8


def test_two_soft_bodies_share_the_compliance():
    both = replace(CONTACT, counter_modulus="1.5 MPa")
    assert both.effective_modulus == pytest.approx(CONTACT.effective_modulus / 2)
    assert both.compliance_share == pytest.approx(0.5)
    psd = reference_psd("Sb-S")
    sides = [Interface(0.0, roughness_balance=b) for b in (-1.0, 0.0, 1.0)]
    sides += [Interface(0.0, "stationary"), Interface(0.0, "moving")]
    still, equal, moving, *stated = (
        float(stribeck_curve(both, psd, 1.4, 310.0, side, [1e-3]).minimum_separation[0])
        for side in sides
    )
    assert stated == [still, moving]
    assert moving < equal < still


@pytest.mark.parametrize("name", OUTLETS)
def test_flooded_outlets(name):
    psd = None if name is None else reference_psd(name)
    liquids = [Liquid(1.4), *(Liquid(1.4, None, "flooded", p) for p in (-2e4, -1e5))]
    for liquid, expected in zip(liquids, OUTLETS[name], strict=True):
        curve = stribeck_curve(CONTACT, psd, liquid, 310.0, 0.0, SPEEDS)
        assert curve.friction_coefficient.values == pytest.approx(expected, rel=2e-3)
        assert np.abs(curve.load_balance).max() < 1e-8
        assert curve.flux_variation.max() < 1e-8


def test_a_thinning_liquid_has_the_friction_of_the_closure():
    liquid = Liquid(1.0, thinning=XANTHAN)
    speeds = [1e-4, 1e-3, 1e-2, 0.1, 1.0]
    curve = stribeck_curve(CONTACT, reference_psd("Sb-S"), liquid, 310.0, 0.0, speeds)
    expected = [3.54e-4, 0.00109, 0.00415, 0.01429, 0.01226]
    assert curve.friction_coefficient.values == pytest.approx(expected, rel=5e-3)
    assert float(curve.friction_per_shear_stress[3]) == pytest.approx(5.59e-7, rel=5e-3)


def test_thinning_has_the_limits_of_newtonian_liquids():
    # the same domain: at 1 mm/s the drag beyond it is 0.2 %
    def friction(viscosity, thinning):
        liquid = Liquid(viscosity, "0.2 m", thinning=thinning)
        curve = stribeck_curve(CONTACT, None, liquid, 310.0, 0.0, [1e-3])
        return float(curve.friction_coefficient[0])

    newtonian = friction(1.4, None)
    assert friction(1.4, carreau_yasuda("10 s", 1.0)) == pytest.approx(newtonian, rel=2e-3)
    assert friction(1.4, carreau_yasuda("1 us", 0.4)) == pytest.approx(newtonian, rel=2e-3)
    beyond = carreau_yasuda("1e9 s", 0.3, rest=0.5)
    assert friction(2.8, beyond) == pytest.approx(newtonian, rel=5e-3)


def test_a_ball_in_a_thinning_liquid_lies_between_its_newtonian_limits():
    ball = PointContact("9.5 mm", "1 MPa", 0.5)
    thick, thin, between = (
        float(stribeck_curve(ball, None, liquid, 3.0, 0.0, [1e-2], COARSE).central_separation[0])
        for liquid in (Liquid(1.0), Liquid(0.002), Liquid(1.0, thinning=XANTHAN))
    )
    assert thin < between < thick


def test_laws_of_thinning():
    rate = np.array([1e-9, 1.0, 1e9])
    assert cross("1 s", 0.3, 0.1)(rate) == pytest.approx([1, 0.55, 0.1], rel=1e-3)
    assert power_law("1 1/s", 0.5)(rate) == pytest.approx([1, 1, 1e-4**1.125], rel=1e-6)
    eta, table = rheometer_table([0.1, 1, 10], [2.0, 2.0, 0.5])
    assert eta == 2.0 and table(rate) == pytest.approx([1, 1, 0.25])
    law = power_law("1 1/s", 0.5)
    fast = np.array([100.0])
    assert law.tangent(fast) == pytest.approx(0.5 * law(fast), rel=1e-3)
    assert law.pressure_flow(fast) == pytest.approx(law(fast) * 0.25 ** (1 / 3), rel=1e-3)
    with pytest.raises(AnalysisError, match="exponent"):
        cross("1 s", 1.5)
    assert viscous_heating(0.02, 310.0, 1e-3, 4e-3) < 0.01 < viscous_heating(0.02, 310.0, 1, 4e-3)


def test_old_options_work_and_say_where_they_went():
    with pytest.warns(FutureWarning, match="cells.*Solver"):
        old = stribeck_curve(CONTACT, None, viscosity=1.4, load=310.0, shear_stress=0.0,
                             speed=[1e-3], cells=100)  # fmt: skip
    new = parameters_of(1.4, 0.0, cells=100)
    assert float(old.iterations[0]) > 0 and old.cells == new.solver.cells
    with pytest.raises(AnalysisError, match="no parameter.*cells"):
        parameters_of(1.4, 0.0, cels=100)
