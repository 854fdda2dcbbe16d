"""Moving mass between contact and sensor, from the dependence of force on acceleration."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.arrays.medians import median
from tribolab.core.errors import AnalysisError
from tribolab.friction import limits
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.segments.strokes import find_strokes
from tribolab.reading.runs.inertia import acceleration, take_inertia
from tribolab.units.conversion import positive

_MAX_CONDITION = 1e6  # condition number above which the fit to a pair of strokes is not unique
_MAX_SAMPLES = 1 << 20  # most samples used: the mass is constant within a run


class MovingMass(NamedTuple):
    """Mass with its standard error [kg], and the number of stroke pairs used."""

    mass: float
    error: float
    pairs: int


def moving_mass(run: xr.Dataset) -> MovingMass | None:
    """Return the mass whose inertia adds to the measured friction force; None if undetermined.

    Parameters
    ----------
    run
        With ``friction_force`` and ``position`` or a signed ``sliding_velocity``, of a
        reciprocating contact whose speed changes continuously, as with a crank.

    Returns
    -------
    MovingMass or None
        None for strokes at constant speed, for fewer than 4 pairs of strokes, if the acceleration
        is mostly noise, or if the mass is below 5 standard errors or its force below 2 % of the
        friction.

    Notes
    -----
    At a given position friction has opposite signs in the forward and the backward stroke, while
    the acceleration is the same. In each pair of strokes the force is fitted by a constant, by
    friction that changes sign with the direction and with the speed, and by m a; samples during the
    reversal of friction (below 40 % of the highest speed) are not used. The error is that of the
    mean over the pairs. A spring parallel to the contact, or friction that lags the speed, has the
    same sign as a mass: the result is the force in phase with the acceleration, which does no work
    over a cycle, whatever its cause.

    Examples
    --------
    >>> time = np.arange(0, 10, 2e-3)
    >>> phase = 2 * np.pi * 2 * time
    >>> speed = 2 * np.pi * 2 * 5e-3 * np.cos(phase)
    >>> force = 3 * np.sign(speed) - 2.0 * 2 * np.pi * 2 * speed.max() * np.sin(phase)
    >>> force += 0.01 * np.random.default_rng(0).standard_normal(time.size)
    >>> data = {"sliding_velocity": ("time", speed), "friction_force": ("time", force)}
    >>> round(moving_mass(xr.Dataset(data, {"time": time})).mass, 2)
    2.0
    """
    if "friction_force" not in run or "inertial_force" in run:
        return None
    try:
        strokes = find_strokes(run)
    except AnalysisError:
        return None
    time, force = run["time"].values, run["friction_force"].values
    signals = {n: run[n].values for n in ("sliding_velocity", "position") if n in run}
    # a parabola through a sixth of a stroke underestimates a sine's acceleration by 1 %
    widest = max(int(median(np.diff(strokes.first)) / 12), 2)
    known = acceleration(signals, time, 0.0, widest)
    if known is None:
        return None
    velocity = signals.get("sliding_velocity")
    velocity = np.gradient(signals["position"], time) if velocity is None else velocity
    top = float(np.quantile(np.abs(velocity), 0.98))
    number = strokes.number
    inside = (
        (number >= 0)
        & (np.abs(velocity) > limits.MIN_SPEED_OF_MASS.value * top)
        & np.isfinite(force)
    )
    spread = float(np.var(known.value[inside])) if inside.any() else 0.0
    if known.error**2 > limits.MAX_NOISE_OF_ACCELERATION.value * spread or _is_steady(
        known.value[inside]
    ):
        return None
    way, share = np.sign(velocity[inside]), np.abs(velocity[inside]) / top
    ones = np.ones(way.size)
    terms = [ones, way, way * share, known.value[inside]]
    fitted = _fits(number[inside] // 2, terms, force[inside])
    if len(fitted) < limits.MIN_PAIRS_OF_STROKES.value:
        return None
    friction = float(np.mean(fitted[:, 1] + 0.8 * fitted[:, 2]))
    period = 2 * float(median(np.diff(strokes.first)))
    kept = known.gain(period) * spread / (spread - known.error**2)
    masses = fitted[:, 3] * np.sign(friction) * kept
    mass, error = float(masses.mean()), float(masses.std(ddof=1) / np.sqrt(masses.size))
    most = mass * float(np.quantile(np.abs(known.value[inside]), 0.98))
    if (
        mass < limits.MIN_ERRORS_OF_MASS.value * error
        or most < limits.MIN_FORCE_OF_MASS.value * abs(friction)
    ):
        return None
    return MovingMass(mass, error, int(masses.size))


def without_inertia(run: xr.Dataset, mass: str | float | None = None) -> xr.Dataset:
    """Remove the inertia of a moving mass from the friction force.

    Parameters
    ----------
    run
        With ``friction_force`` and ``position`` or ``sliding_velocity``.
    mass
        Mass between contact and sensor ("1.2 kg", or a number in kg); default: from `moving_mass`.

    Returns
    -------
    xarray.Dataset
        The run with ``inertial_force`` [N] (time) subtracted from ``friction_force``; attributes
        ``moving_mass_kg``, ``moving_mass_source`` and, if it was found, ``moving_mass_sem_kg``. The
        run is unchanged if no mass is stated or found.

    Raises
    ------
    ReadError
        If a mass is stated and the run has no friction force, or no motion.
    AnalysisError
        If the inertia was already removed.

    Examples
    --------
    >>> time = np.arange(0, 4, 0.01)
    >>> speed = 0.1 * np.clip(time - 1, 0, 1)  # it is accelerated for a second
    >>> force = np.where(time > 1, 5.0, 0.0) + 2.0 * 0.1 * ((time > 1) & (time < 2))
    >>> data = {"sliding_velocity": ("time", speed), "friction_force": ("time", force)}
    >>> mended = without_inertia(xr.Dataset(data, {"time": time}), "2 kg")
    >>> mended["friction_force"].sel(time=[1.5, 3.0]).values.round(6).tolist()
    [5.0, 5.0]
    """
    if "inertial_force" in run:
        if mass is None:
            return run
        raise AnalysisError("the inertia was taken out of the run before", where=name_of(run))
    if mass is not None:
        kilograms = positive(mass, "kg", "mass")
        return take_inertia(run, kilograms, name_of(run), moving_mass_source="stated")
    known = moving_mass(run.isel(time=slice(0, _MAX_SAMPLES)))
    if known is None:
        return run
    source = f"force in phase with the acceleration, {known.pairs} pairs of strokes"
    return take_inertia(
        run, known.mass, name_of(run), moving_mass_source=source, moving_mass_sem_kg=known.error
    )


def _is_steady(acceleration: np.ndarray) -> bool:
    """Return whether a stroke is mostly at constant speed, so that only ramps are accelerated.

    In ramps friction builds up and relaxes, which symmetry cannot separate from inertia. The median
    magnitude of a sine's acceleration is at least half of its maximum; for ramps it is far less.
    """
    size = np.abs(acceleration)
    return bool(median(size) < limits.MAX_EVEN_ACCELERATION.value * np.quantile(size, 0.98))


def _fits(pair: np.ndarray, terms: list[np.ndarray], force: np.ndarray) -> np.ndarray:
    """Fit the terms to the force of each pair of strokes; return the coefficients (pair, term)."""
    count = int(pair.max()) + 1
    size = np.bincount(pair, minlength=count)
    normal = np.array(
        [[np.bincount(pair, a * b, minlength=count) for b in terms] for a in terms]
    ).transpose(2, 0, 1)
    right = np.array([np.bincount(pair, a * force, minlength=count) for a in terms]).T
    good = size >= limits.MIN_SAMPLES_OF_PAIR.value
    scale = np.sqrt(np.einsum("pii->pi", normal[good]))
    good[good] = (scale > 0).all(axis=1)
    scale = scale[(scale > 0).all(axis=1)]
    shaped = normal[good] / scale[:, :, None] / scale[:, None, :]
    solvable = np.linalg.cond(shaped) < _MAX_CONDITION
    answer = np.linalg.solve(shaped[solvable], (right[good] / scale)[solvable][:, :, None])[:, :, 0]
    return np.asarray(answer / scale[solvable])
