"""Merging of two logs with separate clocks into one run on the clock of the force log."""

from __future__ import annotations

import datetime as dt

import numpy as np

from tribolab.core.errors import Cure, ReadError
from tribolab.core.untyped import Json
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.shift import estimate_clock_shift
from tribolab.reading.signals import Signals

_STEPWISE = {"set_speed", "set_normal_force", "step", "cycle"}  # held constant between samples


def merge(run: Signals, motion: Signals, clock_shift: float | None = None) -> Signals:
    """Merge a companion log's signals into a run, on the run's clock.

    Parameters
    ----------
    run
        The force log.
    motion
        The companion log.
    clock_shift
        Motion clock + shift = force clock [s]; estimated by default.

    Returns
    -------
    Signals
        The part of the run that both logs cover, with the companion's signals linearly interpolated
        (set-points and step numbers keep their last value). ``clock_shift_s``, its source
        ("estimated", "given" or "none") and its uncertainty are attributes. An estimated shift
        applies to the middle of the companion log; if the signals show that one clock is faster,
        ``clock_rate`` is not zero, and force clock = motion clock + ``clock_shift_s`` +
        ``clock_rate`` (motion clock - its middle).

        The source is "none" if the signals do not determine the shift. Then ``clock_shift_s`` is a
        guess, and ``clock_shift_refused`` is the reason. ``clock_shift_ways`` contains the result
        of each method.

    Raises
    ------
    ReadError
        If the logs do not overlap, or were recorded at quite different times.
    """
    force_clock = run.time + run.attrs["time_origin_s"]
    motion_clock = motion.time + motion.attrs["time_origin_s"]
    shift, source, attrs = _shift(run, motion, force_clock, motion_clock, clock_shift)
    middle = 0.5 * (motion_clock[0] + motion_clock[-1])
    shifted = motion_clock + shift + attrs["clock_rate"] * (motion_clock - middle)
    first = int(np.searchsorted(force_clock, shifted[0], side="left"))
    last = int(np.searchsorted(force_clock, shifted[-1], side="right"))
    names = f"{run.attrs['source']} and {motion.attrs['source']}"
    if last - first < 2:
        verb = "correct" if clock_shift is not None else "give"
        raise ReadError(
            f"the logs do not overlap: on the force log's clock, one runs from "
            f"{force_clock[0]:.6g} to {force_clock[-1]:.6g} s, the other from {shifted[0]:.6g} to "
            f"{shifted[-1]:.6g} s (shift {shift:.6g} s, {source})",
            where=names,
            cure=_say_shift(verb),
        )
    clock = force_clock[first:last]
    columns = {name: values[first:last] for name, values in run.columns.items()}
    columns |= {
        name: _resampled(name, values, shifted, clock)
        for name, values in motion.columns.items()
        if name not in run.columns
    }
    attrs = run.attrs | _joined_provenance(run, motion) | attrs
    attrs |= {"time_origin_s": float(clock[0])}
    attrs |= {"clock_shift_s": shift, "clock_shift_source": source}
    return Signals(clock - clock[0], columns, attrs)


def _say_shift(say: str) -> Cure:
    return Cure(
        notebook=f"{say} clock_shift=",
        terminal=f"{say} clock_shift in the [[run]] of a campaign file",
        campaign=f"{say} clock_shift in its [[run]]",
    )


def _shift(
    run: Signals,
    motion: Signals,
    force_clock: np.ndarray,
    motion_clock: np.ndarray,
    given: float | None,
) -> tuple[float, str, Json]:
    if given is not None:
        return float(given), "given", {"clock_shift_uncertainty_s": 0.0, "clock_rate": 0.0}
    apart = _start_difference(run, motion)
    gap = 0.0 if apart is None else _gap(apart, force_clock, motion_clock)
    if gap > limits.MAX_GAP_BETWEEN_LOGS.value:
        raise ReadError(
            f"{run.attrs['source']} was recorded at {run.attrs['recorded_at']}, its companion "
            f"{motion.attrs['source']} at {motion.attrs['recorded_at']}: another run's log; put "
            "the right one next to it",
            cure=_say_shift("if the dates are wrong, give"),
        )
    expected = 0.0 if apart is None else apart + force_clock[0] - motion_clock[0]
    velocity = _velocity(motion, motion_clock)
    friction = ("friction_force", "friction_coefficient")
    signal = next((run.columns[name] for name in friction if name in run.columns), None)
    if velocity is not None and signal is not None:
        estimate = estimate_clock_shift(
            force_clock, signal, motion_clock, velocity, expected, apart is not None
        )
        if estimate is not None:
            ways = {
                name: f"{estimate_of_way.shift:.6g} s +- {estimate_of_way.uncertainty:.2g} s"
                for name, estimate_of_way in estimate.ways.items()
            }
            attrs = {
                "clock_shift_uncertainty_s": estimate.uncertainty,
                "clock_rate": estimate.rate,
                "clock_shift_explained": estimate.explained,
                "clock_shift_ways": ways,
            }
            refused = estimate.refused
            if gap > limits.MAX_GAP_OF_ONE_RUN.value:
                refused = f"by their dates one log ended {gap:.0f} s before the other began"
            if not refused:
                return estimate.shift, "estimated", attrs
            attrs |= {"clock_shift_uncertainty_s": float("nan"), "clock_shift_refused": refused}
            return estimate.shift, "none", attrs
    return float(expected), "none", {"clock_shift_uncertainty_s": float("nan"), "clock_rate": 0.0}


def _gap(apart: float, force_clock: np.ndarray, motion_clock: np.ndarray) -> float:
    """Return the time [s] between the end of one log and the start of the other, by their dates."""
    return max(apart - float(np.ptp(force_clock)), -apart - float(np.ptp(motion_clock)), 0.0)


def _velocity(motion: Signals, clock: np.ndarray) -> np.ndarray | None:
    if "sliding_velocity" in motion.columns:
        return motion.columns["sliding_velocity"]
    if "position" in motion.columns:
        return np.gradient(motion.columns["position"], clock)
    return None


def _start_difference(run: Signals, motion: Signals) -> float | None:
    """Return the time [s] from the start of the run to that of the companion; None if unknown."""
    try:
        begins = [dt.datetime.fromisoformat(data.attrs["recorded_at"]) for data in (run, motion)]
        return (begins[1] - begins[0]).total_seconds()
    except (KeyError, TypeError, ValueError):  # missing, or not comparable as dates
        return None


def _resampled(name: str, values: np.ndarray, clock: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    if name in _STEPWISE or values.dtype.kind in "iub":
        return values[np.clip(np.searchsorted(clock, wanted, side="right") - 1, 0, None)]
    return np.interp(wanted, clock, values)


def _joined_provenance(run: Signals, motion: Signals) -> Json:
    """Return the joined provenance of both logs."""
    attrs: Json = {
        key: f"{run.attrs[key]}; {motion.attrs[key]}" for key in ("source", "source_sha256")
    }
    unused = [data.attrs["columns_not_used"] for data in (run, motion)]
    attrs["columns_not_used"] = "; ".join(text for text in unused if text)
    attrs["columns_used"] = run.attrs["columns_used"] | motion.attrs["columns_used"]
    attrs["companion_instrument"] = motion.attrs["instrument"]
    attrs["speed_from"] = motion.attrs["speed_from"]
    return attrs
