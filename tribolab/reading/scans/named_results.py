"""Results of roughness testers as lines of a name and a value: ``Ra = 0.523 um``."""

from __future__ import annotations

import re

import numpy as np
import xarray as xr

from tribolab.errors import ReadError, UnitError, shown
from tribolab.provenance import provenance
from tribolab.quantities import QUANTITIES
from tribolab.reading.scans.formats.profilometers import result
from tribolab.reading.text.first_bytes import File, named_values
from tribolab.stamping import stamp
from tribolab.units import conversion

_NAMES = {"rdq": "Rdq", "rδq": "Rdq"}
_CUTOFFS = (
    (re.compile(r"(?i)^(λ|l|lambda)_? ?c$|^cut-? ?off"), "lambda_c_m"),
    (re.compile(r"(?i)^(λ|l|lambda)_? ?s$"), "lambda_s_m"),
)
_WITHOUT_UNIT = ("1", "%")


def read_named_results(file: File) -> xr.Dataset:
    """Read roughness parameters that stand in lines of a name, a value and its unit.

    Parameters
    ----------
    file
        From `tribolab.reading.text.first_bytes.peek`; UTF-8 or Latin-1, decimal point or comma.

    Returns
    -------
    xarray.Dataset
        As from `tribolab.reading.scans.results.read_tester_results`. A value of asterisks
        (``*.*******um``) could not be computed: it is NaN and named in ``instrument_errors``.

    Raises
    ------
    ReadError
        If no roughness parameter stands in it, or one of them has no unit.
    """
    attrs: dict[str, str | float] = {"instrument": "results by name"}
    values: dict[str, float] = {}
    errors = []
    for line, (name, number, unit) in named_values(file.head):
        where = f"{file.path}: line {line}, '{shown(name, 40)}'"
        name = _NAMES.get(name.lower(), name)
        cutoff = next((key for pattern, key in _CUTOFFS if pattern.search(name)), "")
        value = np.nan if "*" in number else float(number.replace(",", "."))
        if cutoff:
            attrs[cutoff] = float(f"{value * _metres(unit, where):.15g}")
            continue
        if "*" in number:
            errors.append(f"{name}: {number}{unit}")
        if not unit and name in QUANTITIES and QUANTITIES[name].unit not in _WITHOUT_UNIT:
            raise ReadError(f"{where}: the value has no unit; write it behind the number, e.g. um")
        try:
            attribute = result(name, value, unit)
        except UnitError as error:
            raise ReadError(f"{where}: {error}; is the line damaged?") from error
        if name in QUANTITIES:
            values[name] = next(iter(attribute.values()))
        attrs.update(attribute)
    if not values:
        raise ReadError(f"{file.path}: no roughness parameter (Ra, Rq, Rz ...) stands in the file")
    attrs["instrument_errors"] = "; ".join(errors) if errors else "none"
    data = xr.Dataset({name: ((), value) for name, value in values.items()})
    return stamp(data, **provenance([file.path], "read roughness results"), **attrs)


def _metres(unit: str, where: str) -> float:
    try:
        return conversion(unit, "m")[0]
    except UnitError as error:
        raise ReadError(f"{where}: {error}; is the line damaged?") from error
