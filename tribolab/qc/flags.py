"""Quality flags as CF variables: severities as in QARTOD, and one bit for each check.

Every variable ``X`` may carry ``X_qc`` (one severity per sample) and ``X_qc_tests`` (a bit per
check that objected). The convention is defined here:

===== ============== =====================================================
value meaning        when
===== ============== =====================================================
1     good           at least one check examined the sample, none objected; or
                     a person accepted it nevertheless (`tribolab.qc.manual`)
2     not_evaluated  no check examined it; not to be read as good
3     suspect        a check objected; a person should look
4     fail           a check objected, or a person rejected it; not to be
                     used as it is
9     missing        there is no value
===== ============== =====================================================
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from tribolab.arrays.chunks import anywhere, pieces
from tribolab.arrays.scratch import filled, room

if TYPE_CHECKING:
    import xarray as xr

GOOD, NOT_EVALUATED, SUSPECT, FAIL, MISSING = 1, 2, 3, 4, 9
_VALUES = np.array([GOOD, NOT_EVALUATED, SUSPECT, FAIL, MISSING], dtype=np.int8)
_MEANINGS = "good not_evaluated suspect fail missing"

# Severity that wins if several checks judge the same sample. "Not evaluated" loses to
# all others, because at least one check did examine the sample.
_PRECEDENCE = np.zeros(10, dtype=np.int8)
_PRECEDENCE[[NOT_EVALUATED, GOOD, SUSPECT, FAIL, MISSING]] = [0, 1, 2, 3, 4]
_BY_PRECEDENCE = np.array([NOT_EVALUATED, GOOD, SUSPECT, FAIL, MISSING], dtype=np.int8)


def combine(flags: Iterable[np.ndarray]) -> np.ndarray:
    """Return the worst severity of each sample over several checks.

    Parameters
    ----------
    flags
        Arrays of severities (int8), all of one shape.

    Returns
    -------
    ndarray
        One array of severities; missing > fail > suspect > good > not evaluated.

    Examples
    --------
    >>> combine([np.array([1, 1, 2]), np.array([2, 3, 2])])
    array([1, 3, 2], dtype=int8)
    """
    first, *others = flags
    if not others:
        return first
    shape = np.shape(first)
    grave = max((_PRECEDENCE[f.flat[0]] for f in (first, *others) if is_uniform(f)), default=0)
    single = [f for f in (first, *others) if not is_uniform(f)]
    if not single:
        return uniform(shape, int(_BY_PRECEDENCE[grave]))
    combined = room(int(np.prod(shape)), np.int8)
    flat = [other.reshape(-1) for other in single]
    for start, stop in pieces(0, combined.size):
        worst = np.full(stop - start, grave, np.int8)
        for other in flat:
            np.maximum(worst, _PRECEDENCE.take(other[start:stop]), out=worst)
        _BY_PRECEDENCE.take(worst, out=combined[start:stop], mode="clip")
    return combined.reshape(shape)


def uniform(shape: int | tuple[int, ...], severity: int) -> np.ndarray:
    """Return a read-only array with one severity for all samples, in the memory of one number.

    Examples
    --------
    >>> uniform(3, GOOD)
    array([1, 1, 1], dtype=int8)
    """
    return np.broadcast_to(np.int8(severity), shape)


def is_uniform(flags: np.ndarray) -> bool:
    """Return whether an array of flags was made by `uniform` and has at least one sample."""
    return flags.size > 0 and not any(flags.strides)


_Flags = tuple[tuple[Hashable, ...], np.ndarray, dict[str, object]]  # dims, values, attrs


def attach(
    data: xr.Dataset, name: str, flags: Mapping[str, np.ndarray], bits: Mapping[str, int]
) -> xr.Dataset:
    """Return a dataset with ``<name>_qc`` and ``<name>_qc_tests``, from each check's flags.

    Parameters
    ----------
    data
        Dataset that contains the variable `name`.
    name
        The variable that was checked.
    flags
        Severities (int8, the variable's shape) by name of the check.
    bits
        Bit number (0 to 30) of every known check; the mask's meanings list all of them, so that
        masks of different runs can be compared.

    Notes
    -----
    The pair is linked to the variable by ``ancillary_variables`` (CF-1.11, section 3.5).
    """
    return attach_all(data, [(name, flags)], bits)


def attach_all(
    data: xr.Dataset, flags: Iterable[tuple[str, Mapping[str, np.ndarray]]], bits: Mapping[str, int]
) -> xr.Dataset:
    """Return a dataset with quality flags of several variables; see `attach`."""
    pairs: dict[str, _Flags] = {}
    names = []
    for name, own in flags:
        quality, objections = _pair(name, data.variables[name], own, bits)
        pairs |= {f"{name}_qc": quality, f"{name}_qc_tests": objections}
        names.append(name)
    result = data.assign(pairs)
    for name in names:
        result.variables[name].attrs["ancillary_variables"] = f"{name}_qc {name}_qc_tests"
    return result


def _pair(
    name: str, variable: xr.Variable, flags: Mapping[str, np.ndarray], bits: Mapping[str, int]
) -> tuple[_Flags, _Flags]:
    """Return the quality flags of a variable, and the bits of the checks that objected."""
    shape, called = variable.shape, variable.attrs.get("long_name", name)
    severity = combine([uniform(shape, NOT_EVALUATED), *flags.values()])
    if anywhere(np.isnan, variable.values):
        severity = np.where(np.isnan(variable.values), np.int8(MISSING), severity)
    tests = _objecting(shape, {1 << bits[check]: values for check, values in flags.items()})
    known = sorted(bits, key=bits.__getitem__)
    of_quality: dict[str, object] = {
        "long_name": f"quality of {called}",
        "standard_name": "aggregate_quality_flag",
        "flag_values": _VALUES,
        "flag_meanings": _MEANINGS,
    }
    of_tests: dict[str, object] = {
        "long_name": f"checks that flagged {called}",
        "flag_masks": np.array([1 << bits[check] for check in known], dtype=np.int32),
        "flag_meanings": " ".join(known),
    }
    return (variable.dims, severity, of_quality), (variable.dims, tests, of_tests)


def _objecting(shape: tuple[int, ...], flags: Mapping[int, np.ndarray]) -> np.ndarray:
    """Return the bits of the checks that objected to each sample."""
    # the severities suspect, fail and missing have the largest numbers
    flat = {bit: values.reshape(-1) for bit, values in flags.items()}
    flat = {bit: values for bit, values in flat.items() if anywhere(_is_bad, values)}
    if not flat:
        return np.broadcast_to(np.int32(0), shape)
    tests = filled(int(np.prod(shape)), 0, np.int32)
    for start, stop in pieces(0, tests.size):
        for bit, values in flat.items():
            tests[start:stop] |= np.where(_is_bad(values[start:stop]), np.int32(bit), np.int32(0))
    return tests.reshape(shape)


def _is_bad(flags: np.ndarray) -> np.ndarray:
    return flags >= SUSPECT
