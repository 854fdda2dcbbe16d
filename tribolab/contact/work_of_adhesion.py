"""Work of adhesion, dry and in a liquid, from surface energies with their literature bounds."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, fields
from typing import NamedTuple, TypeVar

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp


class BoundedValue(NamedTuple):
    """Value with its lower and upper bounds in the literature."""

    value: float
    low: float
    high: float


StatedWork = str | float | tuple[str | float, str | float, str | float] | BoundedValue
Works = TypeVar("Works", float, np.ndarray)


@dataclass(frozen=True)
class SurfaceEnergies:
    """Surface energies and contact angles of two solids and a liquid, each with its bounds.

    Parameters
    ----------
    solid_1, solid_2
        Surface energies of the solids [J/m2]: a value, or (value, lowest, highest).
    liquid
        Surface tension of the liquid [J/m2].
    angle_1, angle_2
        Contact angles of the liquid on the solids [rad], or text such as ``"104 deg"``.

    Examples
    --------
    >>> energies = SurfaceEnergies(
    ...     solid_1=("22 mJ/m^2", "19.4 mJ/m^2", "24.3 mJ/m^2"), solid_2="46 mJ/m^2",
    ...     liquid="64 mJ/m^2", angle_1="104 deg", angle_2="64 deg")
    >>> round(1e3 * energies.wet, 1)
    51.1
    """

    solid_1: StatedWork
    solid_2: StatedWork
    liquid: StatedWork
    angle_1: StatedWork
    angle_2: StatedWork

    def __post_init__(self) -> None:
        """Convert text to SI ranges and raise an error if the bounds exclude the value."""
        for field in fields(self):
            read = _angle if field.name.startswith("angle") else _energy
            stated = getattr(self, field.name)
            parts = stated if isinstance(stated, tuple) else (stated, stated, stated)
            if len(parts) != 3:
                raise AnalysisError(
                    f"{field.name}: a value or (value, lowest, highest) is wanted; got {stated}"
                )
            given = BoundedValue(*(read(part, field.name) for part in parts))
            if not given.low <= given.value <= given.high:
                raise AnalysisError(
                    f"{field.name}: the value {given.value:g} must lie between its bounds "
                    f"{given.low:g} and {given.high:g}; the order is (value, lowest, highest)"
                )
            object.__setattr__(self, field.name, given)

    @property
    def dry(self) -> float:
        """Work of adhesion [J/m2] of the dry solids at the chosen values, Eq. (13)."""
        solid_1, solid_2, *_ = _ranges(self)
        return float(_dry(solid_1.value, solid_2.value))

    @property
    def wet(self) -> float:
        """Work of adhesion [J/m2] in the liquid at the chosen values, Eq. (14)."""
        *_, liquid, angle_1, angle_2 = _ranges(self)
        return float(_wet(self.dry, liquid.value, angle_1.value, angle_2.value))


def sample_work_of_adhesion(
    energies: SurfaceEnergies, samples: int = 1000, seed: int = 0
) -> np.ndarray:
    """Return random dry and wet works of adhesion; each input is uniform between its bounds.

    Returns
    -------
    numpy.ndarray
        gamma_dry and gamma_wet [J/m2] (2, samples).
    """
    random = np.random.default_rng(seed)
    draws = (random.uniform(r.low, r.high, samples) for r in _ranges(energies))
    return np.stack(_works(*draws))


def work_of_adhesion_spread(
    energies: SurfaceEnergies | None = None, *, samples: int = 1000, seed: int = 0
) -> xr.Dataset:
    """Return the dry and wet work of adhesion, with their spread due to uncertain surface energies.

    Parameters
    ----------
    energies
        Surface energies and contact angles with their bounds; by default those of PDMS, PMMA and
        glycerol of the reference study.
    samples, seed
        Number of random draws for the standard deviation, and their seed.

    Returns
    -------
    xarray.Dataset
        ``work_of_adhesion`` [J/m2] (medium) at the chosen values, ``_low`` and ``_high``: the
        smallest and largest values inside the bounds, ``_std``: standard deviation when every
        input is uniform between its bounds and independent. Media are ``dry`` and ``wet``.

    Notes
    -----
    Eqs. (13) and (14) are monotonic in each input, so the bounds are exact values at the corners,
    for any distribution. The chosen values need not be in the middle.

    Examples
    --------
    >>> spread = work_of_adhesion_spread(PDMS_PMMA_GLYCEROL)
    >>> (1e3 * spread.work_of_adhesion_low).round(1).values
    array([50.6, 21.2])
    """
    energies = energies or PDMS_PMMA_GLYCEROL
    corners = np.array(list(itertools.product(*((r.low, r.high) for r in _ranges(energies)))))
    bounds = np.stack(_works(*corners.T))
    drawn = sample_work_of_adhesion(energies, samples, seed)
    return stamp(
        xr.Dataset(
            {
                "work_of_adhesion": ("medium", [energies.dry, energies.wet]),
                "work_of_adhesion_low": ("medium", bounds.min(axis=1)),
                "work_of_adhesion_high": ("medium", bounds.max(axis=1)),
                "work_of_adhesion_std": ("medium", drawn.std(axis=1, ddof=1)),
            },
            coords={"medium": ["dry", "wet"]},
        ),
        samples=samples,
        seed=seed,
        distribution="uniform and independent between the bounds",
    )


def _ranges(energies: SurfaceEnergies) -> list[BoundedValue]:
    return [getattr(energies, field.name) for field in fields(energies)]


def _works(
    solid_1: Works, solid_2: Works, liquid: Works, angle_1: Works, angle_2: Works
) -> tuple[Works, Works]:
    dry = _dry(solid_1, solid_2)
    return dry, _wet(dry, liquid, angle_1, angle_2)


def _dry(first: Works, second: Works) -> Works:
    return 2 * np.sqrt(first * second)


def _wet(dry: Works, tension: Works, first: Works, second: Works) -> Works:
    return dry - tension * (np.cos(first) + np.cos(second))


def _energy(value: str | float, name: str) -> float:
    energy = to_si(value if isinstance(value, str) else float(value), "J/m^2", name=name)
    if not 0 < energy < math.inf:
        raise AnalysisError(
            f"{name}: a positive surface energy is wanted, e.g. '22 mJ/m^2'; got {energy:g} J/m2"
        )
    return energy


def _angle(value: str | float, name: str) -> float:
    angle = to_si(value if isinstance(value, str) else float(value), "rad", name=name)
    if not 0 <= angle <= math.pi:
        raise AnalysisError(
            f"{name}: a contact angle lies between 0 and 180 deg; got {math.degrees(angle):.4g} "
            "deg. A bare number is in radians: write e.g. '104 deg'"
        )
    return angle


# Values and literature bounds of Sec. 5 of Xu et al. (2026), which states a single value for the
# surface tension of glycerol.
PDMS_PMMA_GLYCEROL = SurfaceEnergies(
    solid_1=(22e-3, 19.4e-3, 24.3e-3),
    solid_2=(46e-3, 33e-3, 46e-3),
    liquid=64e-3,
    angle_1=(math.radians(104), math.radians(94), math.radians(104)),
    angle_2=(math.radians(64), math.radians(58), math.radians(69)),
)
