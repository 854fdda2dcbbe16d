"""Exact heights far from all others are no heights."""

import numpy as np
import pytest

from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.sentinels import take_isolated
from tribolab.surface.form import remove_form


def profile(number, value, scale=3e-7):
    """A rough profile [m] with so many points of one value."""
    height = np.random.default_rng(3).normal(0.0, scale, 2000)
    height[(np.arange(number) * 37 + 500) % height.size] = value
    return height


@pytest.mark.parametrize(("number", "value"), [(1, -0.0254), (1, 1e-3), (3, -5.1234e-6)])
def test_an_exact_height_far_from_all_others_is_missing(number, value):
    height = profile(number, value)
    assert [mark.rows for mark in take_isolated(height)] == [number]
    assert np.isnan(height).sum() == number


@pytest.mark.parametrize(
    ("number", "value"), [(1, 2.01234e-5), (1, 3e-6), (3, 2.5e-6), (1200, -1e-5)]
)
def test_grains_and_steps_are_heights(number, value):
    assert take_isolated(profile(number, value)) == []


def test_levels_of_a_drawing_are_heights():
    assert take_isolated(np.repeat([0.0, 1e-6, 0.0, 5e-6], 50)) == []


def test_a_lost_point_of_a_real_map_is_missing(shared_data):
    file = shared_data / "nanovea_dropout_MIT" / "test4.txt"
    scan = read_scans(file, x_unit="mm", height_unit="um")
    assert int(np.isnan(scan.height).sum()) == 1
    flat = remove_form(scan, "tilt").height
    assert float(flat.std()) == pytest.approx(8.7246e-6, rel=1e-4)
    assert "-1 um 1 time" in scan.attrs["taken_for_missing"]
