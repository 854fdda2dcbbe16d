"""Faults of real scans that can be added to simulated ones, each with the check that finds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.reading.scans.grid import even
from tribolab.rig.scans.profiles import scans as simulate
from tribolab.rig.scans.profiles import touch
from tribolab.studies import xu2026
from tribolab.surface.form import remove_form
from tribolab.surface.roughness import roughness_parameters
from tribolab.units.stamping import stamp

Strike = Callable[[xr.Dataset, np.random.Generator], xr.Dataset]


@dataclass(frozen=True)
class ScanFault:
    """Fault in the scans of a surface, and the check that must find it.

    Attributes
    ----------
    name
        Name of the fault.
    what
        Effect, in a sentence.
    severity
        "suspect" or "fail": lowest expected status of the check.
    check
        Name of the check on scans that should find it.
    strike
        Function ``strike(scans, rng)`` that returns scans with the fault.
    fewest
        Fewest scans of one surface with which the fault can be detected.
    """

    name: str
    what: str
    severity: str
    check: str
    strike: Strike
    fewest: int = 1


def exported(scans: xr.Dataset) -> xr.Dataset:
    """Return simulated scans in the form in which scans are read from files, with metadata.

    Parameters
    ----------
    scans
        From `tribolab.rig.scans.profiles.scans`.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (scan, x) with ``file`` (scan), pitch, length and tip radius, stated and
        real, and the instrument's Ra and Rq of each scan, of the profile without form.
    """
    tool = xu2026.profilometer
    data = scans[["height"]].rename({scans.height.dims[0]: "scan"})
    roughness = roughness_parameters(remove_form(data, "circle"), lambda_c="auto")
    name = str(scans.attrs["surface"]).lower()
    x = data.x.values
    length, pitch = float(x[-1] - x[0]), float(x[-1] - x[0]) / (x.size - 1)
    data = data.assign_coords(
        file=("scan", [f"{name}_{n}.csv" for n in range(1, data.scan.size + 1)])
    )
    return stamp(
        data,
        source="; ".join(data.file.values.tolist()),
        instrument="surftest_csv",
        pitch_m=pitch,
        length_m=length,
        stated_pitch_m=pitch,
        stated_length_m=length,
        tip_radius_m=tool.tip_radius,
        x_unevenness=0.0,
        instrument_Ra_m=_joined(roughness.Ra.values),
        instrument_Rq_m=_joined(roughness.Rq.values),
    )


def strike(
    scans: xr.Dataset, faults: str | Iterable[str], rng: int | np.random.Generator = 0
) -> xr.Dataset:
    """Return scans with faults added.

    Parameters
    ----------
    scans
        From `exported`; not changed.
    faults
        Names of faults, in the order of application.
    rng
        Seed or generator.

    Raises
    ------
    ConfigError
        If a fault is unknown.

    Examples
    --------
    >>> scans = exported(simulate("Sb-R", length=2e-3))
    >>> int(strike(scans, "dropouts").height.isnull().sum()) > 0
    True
    """
    rng = np.random.default_rng(rng)
    for name in [faults] if isinstance(faults, str) else faults:
        if name not in SCAN_FAULTS:
            raise ConfigError(
                f"the rig has no fault of scans '{shown(name)}'{nearest(name, SCAN_FAULTS)}"
            )
        scans = SCAN_FAULTS[name].strike(scans, rng)
    return scans


def _joined(values: Iterable[float]) -> str:
    return "; ".join(f"{value:.9g}" for value in values)


def _change_heights(scans: xr.Dataset, height: np.ndarray, **attrs: float | str) -> xr.Dataset:
    """Return scans with new heights, rounded to the resolution of the instrument."""
    digits = np.round(height / 1e-9) * 1e-9
    return scans.assign(height=scans.height.copy(data=digits)).assign_attrs(attrs)


def _one(scans: xr.Dataset, rng: np.random.Generator) -> int:
    return int(rng.integers(scans.sizes["scan"]))


def _dropouts(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    height = scans.height.values.copy()
    row = _one(scans, rng)
    for first in rng.integers(0, height.shape[1] - 200, 6):
        height[row, first : first + int(rng.integers(20, 200))] = np.nan
    return _change_heights(scans, height)


def _lifted(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    height = scans.height.values.copy()
    points = height.shape[1]
    first = int(rng.integers(0, points // 2))
    height[_one(scans, rng), first : first + points // 4] = np.nan
    return _change_heights(scans, height)


def _steps(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    height = scans.height.values.copy()
    row = _one(scans, rng)
    largest = np.abs(np.diff(height[row])).max()
    for place in rng.integers(1000, height.shape[1] - 1000, 2):
        height[row, place:] += rng.choice([-1, 1]) * rng.uniform(5, 10) * largest
    return _change_heights(scans, height)


def _saturation(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    height = scans.height.values
    top = np.quantile(height, 1 - rng.uniform(0.03, 0.1))
    return _change_heights(scans, np.minimum(height, top))


def _tilt(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    slope = np.tan(np.radians(rng.uniform(6.0, 12.0))) * rng.choice([-1, 1])
    return _change_heights(scans, scans.height.values + slope * scans.x.values)


def _blunt_tip(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    radius = float(rng.uniform(50e-6, 100e-6))
    height = touch(scans.height.values, scans.attrs["pitch_m"], radius)
    noise = 5e-9 * rng.standard_normal(height.shape)
    return _change_heights(scans, height + noise, tip_radius_m=radius)


def _uneven(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    x, pitch = scans.x.values, scans.attrs["pitch_m"]
    speed = 1.0 + 0.3 * np.sin(2 * np.pi * x / x[-1] * rng.uniform(1, 4) + rng.uniform(0, 6))
    places = np.concatenate([[0.0], np.cumsum(speed[1:])]) * pitch
    places *= x[-1] / places[-1]
    rows = [np.interp(places, x, row) for row in scans.height.values]
    brought = [even("scan", places, row) for row in rows]
    resampled = _change_heights(scans, np.stack([b[1] for b in brought]), **brought[0][2])
    return resampled.assign_coords(recorded_x=("x", places))  # the uneven x of the file


def _wrong_length(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    return scans.assign_attrs(stated_length_m=scans.attrs["length_m"] * float(rng.uniform(1.2, 3)))


def _odd_scan(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    surface = scans.file.values[0].split("_")[0]
    other = next(name for name in ("Sb-S", "Sb-R") if name.lower() != surface)
    length = scans.attrs["length_m"]
    strange = simulate(other, 1, seed=rng, length=length).height.values[0]
    height = scans.height.values.copy()
    height[_one(scans, rng)] = strange
    return _change_heights(scans, height)


def _wrong_results(scans: xr.Dataset, rng: np.random.Generator) -> xr.Dataset:
    factor = float(rng.choice([25.4, 39.37, 0.0254]))
    wrong = {
        key: _joined(factor * float(v) for v in scans.attrs[key].split("; "))
        for key in ("instrument_Ra_m", "instrument_Rq_m")
    }
    return scans.assign_attrs(wrong)


_ALL = (
    ScanFault(
        "dropouts", "An optical gauge sees nothing in dark spots.", "suspect", "dropouts", _dropouts
    ),
    ScanFault(
        "lifted",
        "The gauge loses the surface for a quarter of a scan.",
        "suspect",
        "dropouts",
        _lifted,
    ),
    ScanFault("steps", "The specimen slips under the stylus, twice.", "suspect", "steps", _steps),
    ScanFault(
        "saturation", "The gauge's range ends below the summit.", "fail", "clipping", _saturation
    ),
    ScanFault(
        "tilt", "The specimen is mounted askew by 6 to 12 degrees.", "suspect", "form", _tilt
    ),
    ScanFault(
        "blunt_tip", "A tip of 50 to 100 um is mounted, and stated.", "suspect", "tip", _blunt_tip
    ),
    ScanFault(
        "uneven", "The traverse's speed wavers; x is recorded.", "suspect", "spacing", _uneven
    ),
    ScanFault("wrong_length", "The header states a longer scan.", "fail", "length", _wrong_length),
    ScanFault(
        "odd_scan", "One scan of three is of another surface.", "fail", "repeats", _odd_scan, 3
    ),
    ScanFault(
        "wrong_results",
        "The instrument's results are in inches.",
        "fail",
        "results",
        _wrong_results,
    ),
)
SCAN_FAULTS: dict[str, ScanFault] = {fault.name: fault for fault in _ALL}
