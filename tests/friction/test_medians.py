"""Medians by sorting are those of numpy, and those of a long record are those of all of it."""

import numpy as np
import pytest

from tribolab.arrays import medians
from tribolab.arrays.medians import (
    median,
    median_in_pieces,
    median_of_known,
    medians_of_rows,
    quantile_in_pieces,
)


def _numbers(size: int, digits: int | None, gaps: float) -> np.ndarray:
    rng = np.random.default_rng(size)
    numbers = rng.normal(np.linspace(0, 9, size), 1 + np.arange(size) / size)
    if digits is not None:
        numbers = np.round(numbers, digits)
    numbers[rng.random(size) < gaps] = np.nan
    return numbers


@pytest.mark.parametrize("size", [1, 2, 7, 300, 4001])
def test_the_median_is_that_of_numpy(size):
    numbers = _numbers(size, 1, 0.0)
    assert median(numbers) == np.median(numbers)
    rows = numbers[: size // 7 * 7].reshape(-1, 7)
    np.testing.assert_array_equal(medians_of_rows(rows), np.median(rows, axis=1))
    np.testing.assert_array_equal(medians_of_rows(rows[:, :4]), np.median(rows[:, :4], axis=1))


def test_of_nothing_and_of_gaps_there_is_no_median():
    assert np.isnan(median(np.zeros(0))) and np.isnan(median_of_known(np.full(3, np.nan)))
    assert np.isnan(median(np.array([1.0, np.nan, 2.0])))
    assert median_of_known(np.array([1.0, np.nan, 2.0])) == 1.5


@pytest.mark.parametrize("digits", [None, 1, 0], ids=["smooth", "quantised", "coarse"])
@pytest.mark.parametrize("gaps", [0.0, 0.3])
def test_the_median_of_a_long_record_is_found_by_what_lies_about_it(monkeypatch, digits, gaps):
    numbers = _numbers(300_001, digits, gaps)
    whole = np.nanmedian(numbers)
    monkeypatch.setattr(medians, "_MAX_SORTED", 1000)
    kept = []

    def part(first: int, last: int) -> np.ndarray:
        kept.append(last - first)
        return numbers[first:last]

    assert median_in_pieces(part, numbers.size) == whole
    # seen once to look about, and once or twice to find it
    assert sum(kept) < 2.5 * numbers.size


@pytest.mark.parametrize("size", [1, 2, 5, 300_001])
@pytest.mark.parametrize("share", [0.0, 0.02, 0.95, 0.991, 1.0])
def test_a_quantile_of_a_long_record_is_that_of_numpy(monkeypatch, size, share):
    monkeypatch.setattr(medians, "_MAX_SORTED", 1000)
    numbers = np.append(_numbers(size, None, 0.2), 7.0)
    found = quantile_in_pieces(lambda a, b: numbers[a:b], numbers.size, share)
    assert found == np.nanquantile(numbers, share)


def test_of_nothing_there_is_no_quantile():
    assert np.isnan(quantile_in_pieces(lambda a, b: np.full(b - a, np.nan), 9, 0.5))


def test_a_record_whose_short_stretches_deceive_is_sorted_as_a_whole(monkeypatch):
    monkeypatch.setattr(medians, "_MAX_SORTED", 1000)
    # all that is tried is small, all that lies between is large
    numbers = np.full(300_000, 5.0) + np.arange(300_000) * 1e-9
    for start in np.linspace(0, numbers.size - medians._SHORT, medians._STRETCHES).astype(int):
        numbers[start : start + medians._SHORT] = 0.0
    assert median_in_pieces(lambda a, b: numbers[a:b], numbers.size) == np.median(numbers)
