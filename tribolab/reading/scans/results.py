"""Results of roughness testers without profile: Surftest RES files, `Ra = 0.523 um`."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, UnitError, shown
from tribolab.core.provenance import provenance
from tribolab.reading.raw.source import read_unchanged
from tribolab.reading.scans.formats.profilometers import result
from tribolab.reading.text.first_bytes import (
    File,
    is_surftest_results,
    named_values,
    peek,
    results_error,
)
from tribolab.units.conversion import conversion
from tribolab.units.quantities import QUANTITIES
from tribolab.units.stamping import stamp

_SETTINGS = {"Lc": "lambda_c", "Ls": "lambda_s", "Pitch": "pitch", "M-Speed": "measuring_speed"}
_NAMES = {"rdq": "Rdq", "r\u03b4q": "Rdq"}
_CUTOFFS = (
    (re.compile(r"(?i)^(\u03bb|l|lambda)_? ?c$|^cut-? ?off"), "lambda_c_m"),
    (re.compile(r"(?i)^(\u03bb|l|lambda)_? ?s$"), "lambda_s_m"),
)
_WITHOUT_UNIT = ("1", "%")


def read_tester_results(path: str | Path) -> xr.Dataset:
    r"""Read the roughness parameters computed by a roughness tester such as a Surftest.

    Parameters
    ----------
    path
        A RES file: ``name;value;unit;condition`` with a decimal comma; or lines of a name and a
        value with its unit in UTF-8 or Latin-1, with decimal point or comma.

    Returns
    -------
    xarray.Dataset
        Without dims: ``Ra``, ``Rq``, ``Rz`` [m], ``Rsk``, ``Rku``, ``Rdq`` [1] where given. Other
        parameters and the measuring conditions are attributes, with their unit in the name; a
        parameter given twice has its condition in the name. Values that the instrument could not
        compute (an error code, ``*.***um``) are NaN and named in ``instrument_errors``. The date is
        not converted, as 11/01 is ambiguous.

    Raises
    ------
    ReadError
        If the file has another format, or a value is neither a number nor an error code.

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


class _Results:
    """Results of a tester: roughness parameters [m] or [1], attributes, and failed parameters."""

    def __init__(self, instrument: str) -> None:
        self.attrs: dict[str, str | float] = {"instrument": instrument}
        self.values: dict[str, float] = {}
        self.errors: list[str] = []

    def add(self, name: str, text: str, unit: str, where: str, condition: str = "") -> None:
        """Add a roughness parameter; `condition` is added to the name of one given twice."""
        name = _NAMES.get(name.lower(), name)
        failed = "*" in text or text.startswith("Err")
        value = np.nan if failed else _number(text, where)
        if failed:
            self.errors.append(f"{name}: {text}{unit if '*' in text else ''}")
        if not unit and name in QUANTITIES and QUANTITIES[name].unit not in _WITHOUT_UNIT:
            raise ReadError(f"{where}: the value has no unit; write it behind the number, e.g. um")
        if name in QUANTITIES:
            self.values[name] = next(iter(_result(name, value, unit, where).values()))
        self.attrs |= _result(f"{name} {condition}" if condition else name, value, unit, where)

    def add_length(self, key: str, text: str, unit: str, wanted: str, where: str) -> None:
        """Add a cut-off, a pitch or a speed."""
        try:
            scale = conversion(unit, wanted)[0]
        except UnitError as error:
            raise ReadError(f"{where}: {error}; is the line damaged?") from error
        value = np.nan if "*" in text else _number(text, where)
        self.attrs[key] = float(f"{value * scale:.15g}")

    def dataset(self, path: Path) -> xr.Dataset:
        """Return the parameters as a dataset; raise if there are none."""
        if not self.values:
            raise ReadError(f"{path}: no roughness parameter (Ra, Rq, Rz ...) is in the file")
        self.attrs["instrument_errors"] = "; ".join(self.errors) or "none"
        data = xr.Dataset({name: ((), value) for name, value in self.values.items()})
        return stamp(data, **provenance([path], "read roughness results"), **self.attrs)


def _results(path: str | Path) -> xr.Dataset:
    file = peek(path)
    if is_surftest_results(file.head):
        return _read_surftest(file).dataset(file.path)
    if named_values(file.head):
        return _read_named_values(file).dataset(file.path)
    if error := results_error(file.head, file.path):
        raise error
    raise ReadError(
        f"{file.path}: these are no results of a roughness tester (neither 'Mode;RES' nor "
        "lines such as 'Ra = 0.5 um')"
    )


def _read_named_values(file: File) -> _Results:
    """Return the results in lines of a name, a value and its unit."""
    found = _Results("results by name")
    for line, (name, number, unit) in named_values(file.head):
        where = f"{file.path}: line {line}, '{shown(name, 40)}'"
        cutoff = next((key for pattern, key in _CUTOFFS if pattern.search(name)), "")
        if cutoff:
            found.add_length(cutoff, number, unit, "m", where)
        else:
            found.add(name, number, unit, where)
    return found


def _read_surftest(file: File) -> _Results:
    """Return the results and settings in a RES file of a Surftest."""
    found, section = _Results("surftest_res"), ""
    lines = file.head.decode("latin-1").splitlines()
    names = [line.split(";")[0].strip() for line in lines]
    for number, line in enumerate(lines, start=1):
        if line.startswith("//"):
            section = line.strip("/ \r")
            continue
        cells = [cell.strip() for cell in line.split(";")] + ["", "", ""]
        name, value, unit, condition = cells[:4]
        where = f"{file.path}: line {number}, '{name[:40]}'"
        if not name:
            continue
        if section == "CalcResult":
            twice = names.count(name) > 1 and name not in QUANTITIES
            found.add(name, value, unit, where, condition if twice else "")
        elif name in _SETTINGS:
            wanted = "m/s" if unit.endswith("/s") else "m"
            key = f"{_SETTINGS[name]}_{wanted.replace('/', '_')}"
            found.add_length(key, value, unit, wanted, where)
        elif section == "Header" and name == "Date":
            found.attrs["recorded_at_as_written"] = " ".join(filter(None, [value, unit]))
        elif section:
            key = "setting_" + re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_").lower()
            found.attrs[key] = " ".join(filter(None, [value, unit]))
    return found


def _result(name: str, value: float, unit: str, where: str) -> dict[str, float]:
    try:
        return result(name, value, unit)
    except UnitError as error:
        raise ReadError(f"{where}: {error}; is the line damaged?") from error


def _number(text: str, where: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError as error:
        raise ReadError(f"{where}: '{text[:40]}' is neither a number nor an error code") from error
