"""Columns that prove each other by rules of physics: what they hold, and in which units."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.interpret.physics import Candidate, prove
from tribolab.reading.interpret.rules import to_si

T = np.arange(400) * 0.5
RPM = 60 + 40 * np.sin(T / 20)
RADIUS = np.full(T.size, 14.0)  # mm
SPEED = RPM * 2 * np.pi / 60 * RADIUS / 1000
LOAD = 50 + 10 * np.cos(T / 30)
MU = 0.2 + 0.05 * np.sin(T / 7)
STRESS = 2.0 + 0.5 * np.cos(T / 30)  # MPa


def summed(rate):
    return np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(T))])


TURNS = summed(RPM / 60)
CASES = {  # columns as they are written, and the units that their numbers prove
    "speed = rotation x radius": (
        {"sliding_velocity": SPEED, "rotation_speed": RPM, "track_radius": RADIUS},
        {"sliding_velocity": "m/s", "rotation_speed": "1/min", "track_radius": "mm"},
    ),
    "load = mass x g": (
        {"normal_force": LOAD, "mass": LOAD / 9.81e-3},
        {"normal_force": "N", "mass": "g"},
    ),
    "distance = turns x radius": (
        {"distance": TURNS * 2 * np.pi * 0.014, "turns": TURNS, "track_radius": RADIUS},
        {"distance": "m", "turns": "turn", "track_radius": "mm"},
    ),
    "turns grow with rotation": (
        {"turns": TURNS, "rotation_speed": RPM, "time": T},
        {"turns": "turn", "rotation_speed": "1/min", "time": "s"},
    ),
}
PRODUCTS = {  # of which one member's unit is stated
    "distance grows with speed": (
        {"distance": summed(SPEED * 1000), "sliding_velocity": SPEED * 1000, "time": T},
        ("distance", "mm"),
        {"sliding_velocity": "mm/s", "time": "s"},
    ),
    "friction = ratio x load": (
        {"friction_force": MU * LOAD, "friction_coefficient": MU, "normal_force": LOAD},
        ("normal_force", "mN"),
        {"friction_force": "mN", "friction_coefficient": "1"},
    ),
    "torque = force x radius": (
        {"torque": MU * LOAD * 14, "friction_force": MU * LOAD, "track_radius": RADIUS},
        ("track_radius", "mm"),
        {},
    ),
    "shear stress = ratio x pressure": (
        {"shear_stress": MU * STRESS, "friction_coefficient": MU, "normal_stress": STRESS},
        ("normal_stress", "MPa"),
        {"shear_stress": "MPa", "friction_coefficient": "1"},
    ),
}


def proven(columns, stated=("", "")):
    candidates = [
        Candidate(frozenset({name}), stated[1] if name == stated[0] else None) for name in columns
    ]
    found = prove(candidates, np.stack(list(columns.values()), axis=1))
    return {list(columns)[place]: proof for place, proof in found.items()}


@pytest.mark.parametrize("case", CASES)
def test_a_rule_proves_the_units_of_its_members(case):
    columns, units = CASES[case]
    found = proven(columns)
    assert {name: proof.unit for name, proof in found.items()}.items() >= units.items()
    assert all(proof.rules for proof in found.values())


@pytest.mark.parametrize("case", PRODUCTS)
def test_a_stated_unit_tells_those_of_the_others(case):
    columns, stated, units = PRODUCTS[case]
    found = proven(columns, stated)
    assert stated[0] in found
    assert {name: proof.unit for name, proof in found.items()}.items() >= units.items()


@pytest.mark.parametrize("case", [*CASES, *PRODUCTS])
def test_numbers_that_do_not_agree_prove_nothing(case):
    columns = (CASES | PRODUCTS)[case][0]
    first = next(iter(columns))
    wrong = columns | {first: columns[first] * np.linspace(1, 1.5, T.size)}
    assert not proven(wrong)
    odd = columns | {first: columns[first] * 1.37}  # a factor that no unit makes
    assert not proven(odd)


def test_numbers_in_units_that_are_of_no_plausible_size_are_not_taken():
    # in N and kg the numbers agree as well, but a load of 60 kN is none
    found = proven({"normal_force": LOAD, "mass": LOAD / 9.81e-3})
    assert found["normal_force"].unit == "N"
    assert to_si("mass", "g") == pytest.approx(1e-3)


def test_one_candidate_may_be_either_of_two_quantities():
    either = frozenset({"sliding_velocity", "rotation_speed"})
    candidates = [
        Candidate(either, None),
        Candidate(either, None),
        Candidate(frozenset({"track_radius"}), None),
    ]
    found = prove(candidates, np.stack([RPM, SPEED, RADIUS], axis=1))
    assert [found[k].quantity for k in range(3)] == [
        "rotation_speed",
        "sliding_velocity",
        "track_radius",
    ]


def test_a_pin_on_disc_log_whose_columns_prove_every_unit_is_read_at_once(shared_data):
    run = tl.read(shared_data / "te67_pin_on_disc_MIT/PPS_60N_1.tsv")
    assert float(run.sliding_velocity.max()) == pytest.approx(0.264)
    np.testing.assert_allclose(run.normal_force, 59.841)
    assert float(run.time[-1]) == pytest.approx(1799.7, abs=1)
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert found.sliding_speed.item() == pytest.approx(0.150, abs=5e-4)
    assert found.friction_coefficient.item() == pytest.approx(0.11539, rel=0.002)
    assert found.friction_coefficient_std.item() == pytest.approx(0.0069, abs=2e-4)


def test_a_load_in_grams_is_a_force_and_a_torque_in_volts_proves_nothing():
    load = np.linspace(100.0, 200.0, 50)
    columns = np.column_stack([0.3 * load, np.full(50, 0.3), load])
    named = ["friction_force", "friction_coefficient", "normal_force"]
    proofs = prove(
        [Candidate(frozenset({n}), u) for n, u in zip(named, (None, None, "g"), strict=True)],
        columns,
    )
    assert {proofs[0].quantity, proofs[2].quantity} == {"friction_force", "normal_force"}
    assert to_si("friction_force", proofs[0].unit) == pytest.approx(9.80665e-3)
    volts = [Candidate(frozenset({"torque"}), "V"), Candidate(frozenset({"friction_force"}), "N")]
    radius = Candidate(frozenset({"track_radius"}), "mm")
    assert prove([*volts, radius], columns) == {}
