"""Rules of physics: what follows from what is known, and what has to be asked for."""

import numpy as np
import pytest
from test_physics_rules import CASES, PRODUCTS, proven

from tribolab.reading.dialect.formula import Operand, dimension_of, evaluate, in_base_units
from tribolab.reading.interpret import derive as derivations
from tribolab.reading.interpret import physics
from tribolab.reading.interpret.derive import Given, derive, missing_members
from tribolab.reading.interpret.missing import missing_inputs
from tribolab.reading.interpret.rules import rules, si_unit

RULES = {str(rule) + (" (crank)" if rule.condition else ""): rule for rule in rules()}
# what is known in SI, what follows, and how much it is
FOLLOWS = [
    ({"first_surface": 3.0, "second_surface": 2.0}, "sliding_velocity", 1.0),
    ({"first_surface": 3.0, "second_surface": 2.0}, "rolling_speed", 2.5),
    (
        {"first_rotation": 10.0, "first_radius": 0.02, "second_rotation": 5, "second_radius": 0.02},
        "sliding_velocity",
        0.1,
    ),
    (
        {"first_rotation": 10.0, "first_radius": 0.02, "second_rotation": 5, "second_radius": 0.02},
        "rolling_speed",
        0.15,
    ),
    ({"stroke": 0.01, "rotation_speed": 2 * np.pi}, "sliding_velocity", 0.02),
    ({"rotation_speed": 10.0, "track_radius": 0.02}, "sliding_velocity", 0.2),
    ({"angle": 2.0, "track_radius": 0.02}, "position", 0.04),
    ({"slide_roll_ratio": 0.5, "rolling_speed": 2.0}, "sliding_velocity", 1.0),
    ({"stroke": 0.01, "frequency": 5.0}, "sliding_velocity", 0.1),
    ({"set_rotation": 10.0, "track_radius": 0.02}, "sliding_velocity", 0.2),
    ({"set_speed": 0.3}, "sliding_velocity", 0.3),
    ({"arm_force": 10.0, "arm": 0.25, "track_radius": 0.05}, "friction_force", 50.0),
    ({"torque_reading": 0.5, "torque_zero": 0.1}, "torque", 0.4),
    ({"torque": 0.5, "track_radius": 0.02}, "friction_force", 25.0),
    ({"torque": 0.5, "arm": 0.25}, "friction_force", 2.0),
    ({"friction_reading": 5.0, "friction_zero": 0.5}, "friction_force", 4.5),
    ({"shear_stress": 2e4, "contact_area": 1e-4}, "friction_force", 2.0),
    ({"load_1": 3.0, "load_2": 4.0, "load_3": 5.0}, "normal_force", 12.0),
    ({"load_1": 3.0, "load_2": 4.0}, "normal_force", 7.0),
    ({"axial_force": 10.0, "contact_cosine": 0.5}, "normal_force", 20.0),
    ({"normal_stress": 1e5, "contact_area": 1e-4}, "normal_force", 10.0),
    ({"set_normal_force": 20.0}, "normal_force", 20.0),
    ({"inner_radius": 0.02, "outer_radius": 0.03}, "track_radius", 0.025),
    ({"ball_radius": 0.006, "contact_sine": 0.5}, "track_radius", 0.003),
    ({"friction_force_signal": 2.0, "friction_force_gain": 5.0}, "friction_force", 10.0),
    ({"normal_force_signal": 2.0, "normal_force_gain": 5.0}, "normal_force", 10.0),
]
FACTS = frozenset({"crank"})


def known(numbers):
    return {name: Given(name, name, None, number) for name, number in numbers.items()}


def worth(derived, numbers):
    """Evaluate the formula of a derivation, with the dimensions of what it needs."""
    operands = {name: in_base_units(float(x), si_unit(name)) for name, x in numbers.items()}
    return evaluate(derived.formula, operands, si_unit(derived.quantity))


def of_case(numbers, goal):
    return derive(goal, known(numbers), FACTS if "rotation_speed" in numbers else ())


@pytest.mark.parametrize("name", RULES)
def test_both_sides_of_a_rule_have_one_dimension(name):
    rule = RULES[name]
    operands = {n: Operand(1.0, dimension_of(si_unit(n))) for n in rule.needs}
    unit = f"{si_unit(rule.gives)}/s" if rule.rate else si_unit(rule.gives)
    assert np.isfinite(evaluate(rule.formula, operands, unit))


@pytest.mark.parametrize(("numbers", "goal", "value"), FOLLOWS)
def test_what_is_known_makes_what_follows(numbers, goal, value):
    derived = of_case(numbers, goal)
    assert derived.rule is not None
    assert {leaf.quantity for leaf in derived.leaves} == set(numbers)
    assert worth(derived, numbers) == pytest.approx(value)


def test_a_speed_follows_from_a_position_and_that_from_an_angle():
    derived = derive("sliding_velocity", known({"angle": 1.0, "track_radius": 0.02}))
    assert derived.rule.speed == "position" and derived.rule.rate
    assert derived.needs[0].formula == "angle * track_radius"


def outcomes(without=None):
    """Return what all cases make of the rules, but one."""
    kept = tuple(rule for rule in rules() if rule != without)
    patch = pytest.MonkeyPatch()
    with patch.context() as patched:
        patched.setattr(derivations, "rules", lambda: kept)
        patched.setattr(physics, "rules", lambda: kept)
        derived = [of_case(numbers, goal) for numbers, goal, _ in FOLLOWS]
        derived.append(derive("sliding_velocity", known({"position": 1.0})))
        proofs = [proven(columns, ("", "")) for columns, *_ in CASES.values()]
        proofs += [proven(columns, stated) for columns, stated, _ in PRODUCTS.values()]
    formulas = [one and one.formula for one in derived]
    return formulas, [{name: proof.unit for name, proof in one.items()} for one in proofs]


@pytest.fixture(scope="module")
def with_all():
    return outcomes()


@pytest.mark.parametrize("name", RULES)
def test_no_rule_can_be_taken_away(name, with_all):
    assert outcomes(RULES[name]) != with_all


@pytest.mark.parametrize(
    ("names", "goal", "missing"),
    [
        ({"torque"}, "friction_force", ("track_radius",)),
        ({"torque", "arm"}, "friction_force", ()),
        ({"arm_force", "arm"}, "friction_force", ("track_radius",)),
        ({"rotation_speed"}, "sliding_velocity", ("track_radius",)),
        ({"angle"}, "sliding_velocity", ("track_radius",)),
        ({"frequency"}, "sliding_velocity", ("stroke",)),
        ({"normal_force"}, "friction_force", ("friction_force",)),
        (set(), "sliding_velocity", ("sliding_velocity",)),
    ],
)
def test_a_member_that_nothing_fills_is_what_is_asked_for(names, goal, missing):
    assert missing_members(goal, known(dict.fromkeys(names, 1.0))) == missing


@pytest.mark.parametrize(("outer", "doubtful"), [(0.0299, False), (0.031, True)])
def test_the_mean_radius_of_a_wide_ring_is_doubtful(outer, doubtful):
    derived = derive("track_radius", known({"inner_radius": 0.02, "outer_radius": outer}))
    assert derived.is_doubtful == doubtful


def test_one_radius_is_asked_for_friction_and_speed_together():
    (asked,) = missing_inputs({"torque", "rotation_speed", "normal_force"})
    assert asked.member == "track_radius" and asked.goals == ("friction", "speed")


def test_what_was_measured_goes_before_what_was_set():
    numbers = {"rotation_speed": 10.0, "track_radius": 0.02, "set_speed": 0.5, "position": 1.0}
    assert derive("sliding_velocity", known(numbers)).formula == "rotation_speed * track_radius"
    numbers["sliding_velocity"] = 0.3
    assert derive("sliding_velocity", known(numbers)).rule is None
