"""Friction of each cycle of a reciprocating contact."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.arrays.medians import median_of_known
from tribolab.core.errors import AnalysisError, Cure
from tribolab.friction.coefficient import limits
from tribolab.friction.mean_error.estimates import estimate_of
from tribolab.friction.segments.limits import MIN_LOAD_OF_CONTACT
from tribolab.friction.segments.stretches import name_of
from tribolab.friction.segments.strokes import Strokes, find_strokes
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp


@of_runs
def friction_per_cycle(run: xr.Dataset, middle: str | float = 0.5) -> xr.Dataset:
    """Return the friction coefficient of each cycle of a reciprocating contact.

    Parameters
    ----------
    run
        With ``position`` or a signed ``sliding_velocity``, and ``friction_force`` with
        ``normal_force``, or ``friction_coefficient``.
    middle
        Share of each stroke's length over which friction is averaged, around the middle of the
        stroke, where a sinusoidal motion is fastest. 0 < middle <= 1; ``"50 %"`` is 0.5.

    Returns
    -------
    xarray.Dataset
        On dim ``cycle`` (a forward stroke and the next backward one, from 1): ``time`` [s],
        ``friction_coefficient``, ``friction_coefficient_energy`` (where forces are known),
        ``friction_force_offset`` or ``friction_coefficient_offset``, ``normal_force`` [N],
        ``sliding_speed`` (mean over the middle parts) [m/s], ``stroke_length`` [m],
        ``frequency`` [Hz], ``samples``. Without dim: ``mean_friction_coefficient`` with its
        ``_std`` and ``_sem`` over the cycles, ``effective_samples``, ``trend`` [1/s],
        ``trend_change`` and ``trend_p_value``.

    Raises
    ------
    AnalysisError
        If the run does not reciprocate, has no friction, or lost the sign of friction without the
        attribute stating it (``friction_force_rectified``).

    Notes
    -----
    With F_f, F_b the mean forces over the middle parts of the two strokes of a cycle and N_f, N_b
    their mean normal forces, mu = (F_f - F_b)/(N_f + N_b): a constant zero of the force drops out.
    The energy friction coefficient is the area of the loop over the distance, mu_E = (closed
    integral of F dx)/(2 L N) with the stroke L and the mean load N [1]_; the ends of the strokes,
    where parts deform elastically before they slide back, are included. The standard error of the
    mean includes the correlation of neighbouring cycles, and is taken about the trend if that is
    significant (p < 1 %).

    References
    ----------
    .. [1] Fouvry, Kapsa and Vincent (1996), Wear 200, 186-205.
       doi:10.1016/S0043-1648(96)07306-1

    Examples
    --------
    >>> time = np.arange(0, 10, 1e-3)
    >>> phase = 2 * np.pi * 2 * time
    >>> force = 3.0 * np.sign(np.cos(phase)) + 0.7
    >>> data = {"position": 5e-3 * np.sin(phase), "friction_force": force}
    >>> data["normal_force"] = np.full(time.size, 10.0)
    >>> run = xr.Dataset({name: ("time", v) for name, v in data.items()}, {"time": time})
    >>> cycles = friction_per_cycle(run)
    >>> cycles.sizes["cycle"], round(float(cycles.mean_friction_coefficient), 3)
    (19, 0.3)
    """
    share = to_si(middle, "1", "middle")
    if not 0 < share <= 1:
        raise AnalysisError(f"middle: a share above 0 and at most 1 is wanted; got {middle!r}")
    strokes = find_strokes(run)
    forward, backward = _pairs(strokes)
    if not forward.size:
        raise AnalysisError("no two whole strokes follow each other", where=name_of(run))
    name = _signal(run)
    means, counts = _means(run, strokes, share)
    good = (counts[forward] >= limits.MIN_SAMPLES_OF_MIDDLE.value) & (
        counts[backward] >= limits.MIN_SAMPLES_OF_MIDDLE.value
    )
    forward, backward = forward[good], backward[good]
    if not forward.size:
        raise AnalysisError(
            "the middle parts of the strokes hold fewer than "
            f"{limits.MIN_SAMPLES_OF_MIDDLE.value} samples each: the motion "
            "is too fast for the sample rate, or `middle` too small",
            where=name_of(run),
        )
    force, load = means[name], means.get("normal_force")
    mu, zero = _coefficient(run, name, force, load, forward, backward)
    time = run["time"].values
    first, last = np.minimum(forward, backward), np.maximum(forward, backward)
    begin, end = time[strokes.first[first]], time[strokes.first[last + 1] - 1]
    data = {
        "time": (begin + end) / 2,
        "friction_coefficient": mu,
        f"{name}_offset": zero,
        "sliding_speed": (np.abs(means["speed"][forward]) + np.abs(means["speed"][backward])) / 2,
        "stroke_length": (strokes.length[forward] + strokes.length[backward]) / 2,
        "frequency": 1 / (end - begin),
        "samples": counts[forward] + counts[backward],
    }
    if load is not None:
        data["normal_force"] = (load[forward] + load[backward]) / 2
    if name == "friction_force" and load is not None:
        data["friction_coefficient_energy"] = _energy(run, strokes, first, last, data)
    whole = estimate_of(data["time"], mu)
    alone = {
        "mean_friction_coefficient": whole.mean,
        "mean_friction_coefficient_std": whole.std,
        "mean_friction_coefficient_sem": whole.sem,
        "mean_friction_coefficient_dof": whole.dof,
        "mean_friction_coefficient_U95": whole.u95,
        "effective_samples": whole.effective_samples,
        "trend": whole.trend,
        "trend_change": whole.trend_change,
        "trend_p_value": whole.trend_p_value,
    }
    table = xr.Dataset(
        {k: ("cycle", v) for k, v in data.items()} | alone,
        coords={"cycle": np.arange(1, mu.size + 1)},
    )
    return stamp(table, **(run.attrs | {"middle": share}))


def _signal(run: xr.Dataset) -> str:
    for name in ("friction_force", "friction_coefficient"):
        if name in run:
            return name
    raise AnalysisError(
        "the run has neither a friction force nor a coefficient", where=name_of(run)
    )


def _pairs(strokes: Strokes) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of the forward and backward stroke of each cycle, each used once."""
    whole = np.flatnonzero(strokes.usual)
    follows = np.flatnonzero(np.diff(whole) == 1)
    follows = follows[strokes.way[whole[follows]] == 1]
    forward = whole[follows]
    return forward, forward + 1


def _means(
    run: xr.Dataset, strokes: Strokes, share: float
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return the mean of each signal over the middle part of each stroke, and its sample count."""
    inside = np.abs(strokes.place - 0.5) <= share / 2
    number = strokes.number[inside]
    size = strokes.way.size
    counts = np.bincount(number, minlength=size)
    time = run["time"].values[inside]
    means = {}
    for name in ("friction_force", "friction_coefficient", "normal_force"):
        if name not in run:
            continue
        values = np.asarray(run[name].values, float)[inside]
        known = np.isfinite(values)
        total = np.bincount(number[known], weights=values[known], minlength=size)
        with np.errstate(invalid="ignore", divide="ignore"):
            means[name] = total / np.bincount(number[known], minlength=size)
    begin = np.searchsorted(number, np.arange(size), side="left").clip(max=number.size - 1)
    end = (np.searchsorted(number, np.arange(size), side="right") - 1).clip(min=0)
    gone = strokes.place[inside]
    with np.errstate(invalid="ignore", divide="ignore"):
        speed = (gone[end] - gone[begin]) * strokes.length / (time[end] - time[begin])
    return means | {"speed": speed}, counts


def _coefficient(
    run: xr.Dataset,
    name: str,
    force: np.ndarray,
    load: np.ndarray | None,
    forward: np.ndarray,
    backward: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the friction coefficient of each cycle, and the zero of the signal."""
    there, back = force[forward], force[backward]
    lost = bool(run.attrs.get(f"{name}_rectified", False))
    if not lost and np.mean(there * back > 0) > limits.MAX_CYCLES_OF_ONE_SIGN.value:
        raise AnalysisError(
            "friction has one sign in both directions: it was recorded without its sign, or its "
            "zero is larger than friction",
            where=name_of(run),
            cure=Cure(
                f'say run.attrs["{name}_rectified"] = True, or take the zero off',
                *["say rectified = true for its column in the dialect, or where its zero is"] * 2,
            ),
        )
    turned = -1.0 if lost else 1.0
    if name == "friction_coefficient" or load is None:
        if name == "friction_force":
            raise AnalysisError("the normal force is not known", where=name_of(run))
        return np.abs(there - turned * back) / 2, (there + turned * back) / 2
    n_there, n_back = load[forward], load[backward]
    usual = float(median_of_known(np.abs(load)))
    pressed = (n_there > MIN_LOAD_OF_CONTACT.value * usual) & (
        n_back > MIN_LOAD_OF_CONTACT.value * usual
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        mu = np.abs(there - turned * back) / (n_there + n_back)
        zero = (there * n_back + turned * back * n_there) / (n_there + n_back)
    return np.where(pressed, mu, np.nan), zero


def _energy(
    run: xr.Dataset,
    strokes: Strokes,
    first: np.ndarray,
    last: np.ndarray,
    data: dict[str, np.ndarray],
) -> np.ndarray:
    """Return each cycle's energy friction coefficient: loop area / (2 * stroke * load)."""
    force = np.nan_to_num(np.asarray(run["friction_force"].values, float))
    if run.attrs.get("friction_force_rectified", False):
        return np.full(first.size, np.nan)
    number = strokes.number
    way = np.append(strokes.way, 0)[number] * np.append(strokes.length, 0.0)[number]
    place = np.where(np.isfinite(strokes.place), strokes.place, 0.0)
    begin, stop = strokes.first[:-1], strokes.first[1:]
    # no work between strokes: at a reversal the position hardly changes
    step = np.diff(place) * way[:-1]
    step[stop[stop - 1 < step.size] - 1] = 0.0
    work = np.append((force[1:] + force[:-1]) / 2 * step, 0.0)
    total = np.concatenate([[0.0], np.cumsum(work)])
    area = total[stop[last]] - total[begin[first]]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.abs(area) / (2 * data["stroke_length"] * data["normal_force"])
