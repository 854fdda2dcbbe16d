"""Results of checks that compare one number per segment with limits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.wording import Count
from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT
from tribolab.qc.register import Result, Skip
from tribolab.qc.run.subject import RunSubject


def grade(values: np.ndarray, suspect: float, fail: float) -> np.ndarray:
    """Return flags: suspect or fail for values whose magnitude exceeds a limit, else good.

    Examples
    --------
    >>> grade(np.array([0.01, -0.2, np.nan]), 0.02, 0.1)
    array([1, 4, 2], dtype=int8)
    """
    size = np.abs(values)
    flags = np.where(size > fail, FAIL, np.where(size > suspect, SUSPECT, GOOD)).astype(np.int8)
    flags[np.isnan(values)] = NOT_EVALUATED
    return flags


def segment_results(
    subject: RunSubject, variable: str, values: np.ndarray, limits: Mapping[str, float], what: str
) -> list[Result]:
    """Return the result of comparing one number per segment with limits, and flags on samples."""
    flags = grade(values, limits["suspect"], limits.get("fail", np.inf))
    if (flags == NOT_EVALUATED).all():
        raise Skip(f"{what}: no reference value")
    samples = subject.sample_flags(flags)
    bad = np.flatnonzero((flags == SUSPECT) | (flags == FAIL))
    worst = int(np.nanargmax(np.abs(values)))
    if bad.size == 0:
        text = f"{what}: at most {abs(values[worst]):.2%}"
        return [Result("pass", variable, text, float(values[worst]), flags=samples)]
    where = f"{subject.segment_label(worst)}"
    status = "fail" if (flags[bad] == FAIL).any() else "suspect"
    text = f"{what}: {values[worst]:+.2%} in {where}; {bad.size} of "
    text += f"{Count(flags.size):segment|segments}"
    return [Result(status, variable, text, float(values[worst]), "1", where, bad.size, samples)]


def status_of(value: float, limits: Mapping[str, float]) -> str:
    """Return the status of a number, by its limits ``suspect`` and ``fail``.

    Examples
    --------
    >>> status_of(-0.3, {"suspect": 0.1, "fail": 0.5})
    'suspect'
    """
    if abs(value) > limits["fail"]:
        return "fail"
    return "suspect" if abs(value) > limits["suspect"] else "pass"
