"""Quality flags: QARTOD severities and the bit mask of tests, as CF flag variables.

Every variable ``X`` may carry ``X_qc`` (one severity per sample) and ``X_qc_tests`` (a bit per
check that objected). The convention is stated here and nowhere else:

===== ============== =====================================================
value meaning        when
===== ============== =====================================================
1     good           at least one check looked at the sample, none objected
2     not_evaluated  no check looked at it; never to be read as good
3     suspect        a check objected; a person should look
4     fail           a check objected; not to be used as it is
9     missing        there is no value
===== ============== =====================================================
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import xarray as xr

GOOD, NOT_EVALUATED, SUSPECT, FAIL, MISSING = 1, 2, 3, 4, 9
_VALUES = np.array([GOOD, NOT_EVALUATED, SUSPECT, FAIL, MISSING], dtype=np.int8)
_MEANINGS = "good not_evaluated suspect fail missing"

# Which severity wins where several checks spoke about one sample. "Not evaluated" loses to
# everything: a check that did look knows more.
_PRECEDENCE = np.zeros(10, dtype=np.int8)
_PRECEDENCE[[NOT_EVALUATED, GOOD, SUSPECT, FAIL, MISSING]] = [0, 1, 2, 3, 4]
_BY_PRECEDENCE = np.array([NOT_EVALUATED, GOOD, SUSPECT, FAIL, MISSING], dtype=np.int8)


def combine(flags: Iterable[np.ndarray]) -> np.ndarray:
    """Worst severity of each sample over several checks.

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
    flags = iter(flags)
    worst = _PRECEDENCE[next(flags)]
    for other in flags:
        np.maximum(worst, _PRECEDENCE[other], out=worst)
    return _BY_PRECEDENCE[worst]


def attach(
    data: xr.Dataset, name: str, flags: Mapping[str, np.ndarray], bits: Mapping[str, int]
) -> xr.Dataset:
    """Return the dataset with ``<name>_qc`` and ``<name>_qc_tests`` from the flags of each check.

    Parameters
    ----------
    data
        Dataset that holds the variable `name`.
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
    result = data.copy()
    shape, dims = data[name].shape, data[name].dims
    severity = combine([np.full(shape, NOT_EVALUATED, np.int8), *flags.values()])
    severity[np.isnan(data[name].values)] = MISSING
    tests = np.zeros(shape, dtype=np.int32)
    for check, values in flags.items():
        tests[np.isin(values, (SUSPECT, FAIL, MISSING))] |= np.int32(1 << bits[check])
    known = sorted(bits, key=bits.__getitem__)
    result[f"{name}_qc"] = (
        dims,
        severity,
        {
            "long_name": f"quality of {data[name].attrs.get('long_name', name)}",
            "standard_name": "aggregate_quality_flag",
            "flag_values": _VALUES,
            "flag_meanings": _MEANINGS,
        },
    )
    result[f"{name}_qc_tests"] = (
        dims,
        tests,
        {
            "long_name": f"checks that objected to {data[name].attrs.get('long_name', name)}",
            "flag_masks": np.array([1 << bits[check] for check in known], dtype=np.int32),
            "flag_meanings": " ".join(known),
        },
    )
    result[name].attrs["ancillary_variables"] = f"{name}_qc {name}_qc_tests"
    return result


def severity_of(flags: np.ndarray) -> int:
    """Worst severity that stands anywhere in an array of flags; not evaluated if it is empty."""
    if flags.size == 0:
        return NOT_EVALUATED
    return int(max(np.unique(flags).tolist(), key=lambda value: _PRECEDENCE[value]))
