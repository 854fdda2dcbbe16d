"""Work of adhesion: the paper's numbers, the literature's spread, bad input."""

import math

import numpy as np
import pytest
from contact_cases import target
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.contact.work_of_adhesion import (
    PDMS_PMMA_GLYCEROL,
    SurfaceEnergies,
    sample_work_of_adhesion,
    work_of_adhesion_spread,
)
from tribolab.core.errors import AnalysisError, UnitError

properties = settings(deadline=None, derandomize=True, max_examples=30)


def test_published_works_of_adhesion_are_reproduced_to_the_printed_digit(shared):
    published = SurfaceEnergies("22 mJ/m^2", "46 mJ/m^2", "64 mJ/m^2", "104 deg", "64 deg")
    assert round(1e3 * published.dry) == target(shared, "work_of_adhesion", "all", "dry")
    assert round(1e3 * published.wet) == target(shared, "work_of_adhesion", "all", "glycerol")


def test_degrees_and_radians_are_one_angle():
    in_text = SurfaceEnergies(0.02, 0.04, 0.064, "104 deg", "64 deg")
    bare = SurfaceEnergies(0.02, 0.04, 0.064, math.radians(104), math.radians(64))
    assert in_text.wet == pytest.approx(bare.wet, rel=1e-13)


@properties
@given(solid=st.floats(0.01, 0.2), tension=st.floats(0.01, 0.08), angle=st.floats(0.1, 3.0))
def test_supplementary_angles_cancel(solid, tension, angle):
    energies = SurfaceEnergies(solid, solid, tension, angle, math.pi - angle)
    assert energies.wet == pytest.approx(energies.dry)


def test_a_liquid_that_wets_gives_a_negative_work():
    assert SurfaceEnergies(0.03, 0.03, "64 mJ/m^2", "10 deg", "10 deg").wet < 0


def test_the_literature_bounds_are_those_of_the_worst_corners():
    spread = work_of_adhesion_spread(PDMS_PMMA_GLYCEROL)
    dry = 2e-3 * np.sqrt([19.4 * 33, 24.3 * 46])
    c = {angle: math.cos(math.radians(angle)) for angle in (94, 104, 58, 69)}
    wet = dry - 64e-3 * np.array([c[94] + c[58], c[104] + c[69]])
    np.testing.assert_allclose(spread.work_of_adhesion_low, [dry[0], wet[0]])
    np.testing.assert_allclose(spread.work_of_adhesion_high, [dry[1], wet[1]])
    assert spread.work_of_adhesion_std.attrs["units"] == "J/m2"


def test_every_draw_lies_inside_the_bounds_and_the_seed_fixes_them():
    spread = work_of_adhesion_spread(PDMS_PMMA_GLYCEROL)
    drawn = sample_work_of_adhesion(PDMS_PMMA_GLYCEROL, 500, seed=3)
    assert (drawn >= spread.work_of_adhesion_low.values[:, None]).all()
    assert (drawn <= spread.work_of_adhesion_high.values[:, None]).all()
    np.testing.assert_array_equal(drawn, sample_work_of_adhesion(PDMS_PMMA_GLYCEROL, 500, seed=3))
    assert (drawn != sample_work_of_adhesion(PDMS_PMMA_GLYCEROL, 500, seed=4)).any()


def test_certain_energies_have_no_spread():
    sure = SurfaceEnergies("22 mJ/m^2", "46 mJ/m^2", "64 mJ/m^2", "104 deg", "64 deg")
    spread = work_of_adhesion_spread(sure)
    np.testing.assert_array_equal(spread.work_of_adhesion_low, spread.work_of_adhesion_high)
    np.testing.assert_allclose(spread.work_of_adhesion_std, 0, atol=1e-15)
    np.testing.assert_allclose(spread.work_of_adhesion, [sure.dry, sure.wet])


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: SurfaceEnergies("22", 0.04, 0.06, 1.0, 1.0), UnitError, "solid_1.*no unit"),
        (lambda: SurfaceEnergies(-0.02, 0.04, 0.06, 1.0, 1.0), AnalysisError, "solid_1"),
        (
            lambda: SurfaceEnergies(0.02, 0.04, 0.06, 104, 1.0),
            AnalysisError,
            "write e.g. '104 deg'",
        ),
        (lambda: SurfaceEnergies(0.02, 0.04, 0.06, "104 mm", 1.0), UnitError, "angle_1"),
        (
            lambda: SurfaceEnergies((0.02, 0.021, 0.03), 0.04, 0.06, 1.0, 1.0),
            AnalysisError,
            "solid_1.*between its bounds",
        ),
        (
            lambda: SurfaceEnergies((0.02, 0.03), 0.04, 0.06, 1.0, 1.0),
            AnalysisError,
            "value, lowest, highest",
        ),
    ],
)
def test_bad_input_is_named(call, error, words):
    with pytest.raises(error, match=words):
        call()
