"""First passage through a moving boundary: closed forms, a random walk, convergence."""

import numpy as np
import pytest
from adhesion_cases import above_receding_line, random_walk, survival
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import erf

from tribolab.core.errors import AnalysisError

properties = settings(deadline=None, derandomize=True, max_examples=30)


@properties
@given(
    start=st.floats(0.01, 5),
    steps=st.lists(st.floats(1e-4, 10), min_size=1, max_size=40),
)
def test_a_boundary_at_rest_gives_the_error_function_on_any_nodes(start, steps):
    time = np.concatenate([[0.0], np.cumsum(steps)])
    got = survival(start, np.zeros(time.size), time)
    expected = erf(start / np.sqrt(2 * np.maximum(time, 1e-300)))
    np.testing.assert_allclose(got, expected, atol=1e-12)


@pytest.mark.parametrize("speed", [0.5, 2.0, 10.0, -0.5, -1.0])
def test_a_boundary_that_moves_evenly_gives_bachelier_and_levy(speed):
    time = np.linspace(0, 1, 201) ** 2
    error = np.abs(survival(0.3, -speed * time, time) - above_receding_line(0.3, speed, time))
    assert error.max() < 2.5e-4


def test_the_error_falls_with_the_three_halves_power_of_the_step():
    errors = []
    for n in (100, 200, 400):
        time = np.linspace(0, 1, n + 1) ** 2
        exact = above_receding_line(0.3, 2.0, time)
        errors.append(np.abs(survival(0.3, -2 * time, time) - exact).max())
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    assert ((order > 1.4) & (order < 1.7)).all(), order


def test_a_random_walk_meets_a_boundary_that_bends_as_often():
    time = np.linspace(0, 1, 301) ** 2
    # at rest at first, then away ever faster: the shape that adhesion gives
    boundary = -6.0 * np.maximum(time - 0.2, 0.0) ** 1.5 / (1.05 - time)
    walked, error = random_walk(0.4, boundary, time, walks=100_000, seed=7)
    got = survival(0.4, boundary, time)[-1]
    assert abs(got - walked) < 3 * error
    assert got - erf(0.4 / np.sqrt(2)) > 60 * error  # the motion matters, the walk can see it


def test_a_boundary_that_leaps_out_of_reach_keeps_all_that_is_left():
    time = np.linspace(0, 1, 101)
    boundary = np.where(time < 0.5, 0.0, -1e6)
    got = survival(0.5, boundary, time)
    assert got[49:].max() - got[-1] < 0.02  # the step that holds the leap still loses a little
    np.testing.assert_array_equal(got[51:], got[51])


def test_many_starts_at_once_equal_one_at_a_time():
    time = np.linspace(0, 2, 60) ** 2
    starts = np.array([0.1, 1.0, 3.0])
    boundary = -np.array([[0.2], [1.0], [0.0]]) * np.sqrt(time)
    together = survival(starts, boundary, time)
    for k in range(3):
        np.testing.assert_allclose(together[k], survival(starts[k], boundary[k], time), atol=1e-15)


def test_nothing_is_lost_while_time_stands_still():
    time = np.array([0.0, 0.5, 0.5, 0.5, 1.0])
    got = survival(1.0, np.zeros(5), time)
    np.testing.assert_allclose(got[[1, 2, 3]], erf(1.0), atol=1e-14)
    np.testing.assert_allclose(got[4], erf(1 / np.sqrt(2)), atol=1e-12)


@properties
@given(scale=st.floats(1e-3, 1e9))
def test_stress_and_time_have_no_scale_of_their_own(scale):
    time = np.linspace(0, 1, 40) ** 2
    boundary = -0.5 * time
    expected = survival(0.7, boundary, time)
    got = survival(0.7 * scale, boundary * scale, time * scale**2)
    np.testing.assert_allclose(got, expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("time", "boundary", "start", "words"),
    [
        ([0.1, 1.0], [0.0, 0.0], 1.0, "start with 0"),
        ([0.0, 1.0, 0.5], [0.0, 0.0, 0.0], 1.0, "never decrease"),
        ([0.0, 0.0], [0.0, 0.0], 1.0, "end above 0"),
    ],
)
def test_what_cannot_be_walked_is_refused(time, boundary, start, words):
    with pytest.raises(AnalysisError, match=words):
        survival(start, boundary, time)
