"""Results of a roughness tester without the profile: RES files of a Surftest SJ-410."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.errors import ReadError, UnitError
from tribolab.provenance import provenance
from tribolab.quantities import QUANTITIES
from tribolab.reading.raw.source import read_unchanged
from tribolab.reading.scans.formats.profilometers import result
from tribolab.reading.scans.named_results import read_named_results
from tribolab.reading.text.first_bytes import is_surftest_results, named_values, peek, results_error
from tribolab.stamping import stamp
from tribolab.units import conversion

_SETTINGS = {"Lc": "lambda_c", "Ls": "lambda_s", "Pitch": "pitch", "M-Speed": "measuring_speed"}
_NAMES = {"RDq": "Rdq"}


def read_tester_results(path: str | Path) -> xr.Dataset:
    r"""Read the roughness parameters that a roughness tester, such as a Surftest, computed itself.

    Parameters
    ----------
    path
        A RES file: ``name;value;unit;condition`` with a decimal comma; or lines of a name and a
        value with its unit, see `tribolab.reading.scans.named_results`.

    Returns
    -------
    xarray.Dataset
        Without dims: ``Ra``, ``Rq``, ``Rz`` [m], ``Rsk``, ``Rku``, ``Rdq`` [1] where given. Other
        parameters and the measuring conditions are attributes, with their unit in the name; a
        parameter given twice has its condition in the name. What the instrument could not compute
        is NaN and named in ``instrument_errors``. The date stays as it is written: 11/01 can be
        two days.

    Raises
    ------
    ReadError
        If the file is no such file, or a value is neither a number nor an error code.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "A1.TXT"
    >>> head = "// Header\nMode;RES\n// Condition-A\nLc;0,8;mm\n// CalcResult\n"
    >>> _ = file.write_text(head + "Ra;3,246;um;;\nRc;Err110;um;;\n")
    >>> found = read_tester_results(file)
    >>> float(found.Ra), found.attrs["lambda_c_m"], found.attrs["instrument_errors"]
    (3.246e-06, 0.0008, 'Rc: Err110')
    """
    return read_unchanged([Path(path)], lambda: _results(path))


def _results(path: str | Path) -> xr.Dataset:
    file = peek(path)
    if not is_surftest_results(file.head):
        if named_values(file.head):
            return read_named_results(file)
        if error := results_error(file.head, file.path):
            raise error
        raise ReadError(
            f"{file.path}: these are no results of a roughness tester (neither 'Mode;RES' nor "
            "lines such as 'Ra = 0.5 um')"
        )
    attrs: dict[str, str | float] = {"instrument": "surftest_res"}
    values: dict[str, float] = {}
    errors, section = [], ""
    lines = file.head.decode("latin-1").splitlines()
    names = [line.split(";")[0].strip() for line in lines]
    for number, line in enumerate(lines, start=1):
        if line.startswith("//"):
            section = line.strip("/ \r")
            continue
        cells = [cell.strip() for cell in line.split(";")] + ["", "", ""]
        name, value, unit, condition = cells[:4]
        if not name:
            continue
        where = f"{file.path}: line {number}, '{name[:40]}'"
        if section == "CalcResult":
            twice = names.count(name) > 1
            name = _NAMES.get(name, name)
            numeric = np.nan if value.startswith("Err") else _number(value, where)
            if value.startswith("Err"):
                errors.append(f"{name}: {value}")
            attribute = _result(name, numeric, unit, where)
            if name in QUANTITIES:
                values[name] = next(iter(attribute.values()))
            elif twice:
                attribute = _result(f"{name} {condition}", numeric, unit, where)
            attrs.update(attribute)
        elif name in _SETTINGS:
            wanted = "m/s" if unit.endswith("/s") else "m"
            key = f"{_SETTINGS[name]}_{wanted.replace('/', '_')}"
            attrs[key] = float(f"{_number(value, where) * _scale(unit, wanted, where):.15g}")
        elif section == "Header" and name == "Date":
            attrs["recorded_at_as_written"] = " ".join(filter(None, [value, unit]))
        elif section:
            key = "setting_" + re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_").lower()
            attrs[key] = " ".join(filter(None, [value, unit]))
    if not values:
        raise ReadError(f"{file.path}: the section '// CalcResult' holds no roughness parameter")
    attrs["instrument_errors"] = "; ".join(errors) if errors else "none"
    data = xr.Dataset({name: ((), value) for name, value in values.items()})
    return stamp(data, **provenance([file.path], "read roughness results"), **attrs)


def _result(name: str, value: float, unit: str, where: str) -> dict[str, float]:
    try:
        return result(name, value, unit)
    except UnitError as error:
        raise ReadError(f"{where}: {error}; is the line damaged?") from error


def _scale(unit: str, wanted: str, where: str) -> float:
    try:
        return conversion(unit, wanted)[0]
    except UnitError as error:
        raise ReadError(f"{where}: {error}; is the line damaged?") from error


def _number(text: str, where: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError as error:
        raise ReadError(f"{where}: '{text[:40]}' is neither a number nor an error code") from error
