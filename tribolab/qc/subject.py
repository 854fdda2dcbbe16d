"""What the checks on a run look at: its signals, its segments, and what is known of the contact."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import xarray as xr

from tribolab.friction.coefficient import friction_coefficient
from tribolab.friction.segments import find_segments
from tribolab.qc.signals import noise_level

_FORCES = ("friction_force", "normal_force", "friction_coefficient")
_SIGNALS = (*_FORCES, "sliding_velocity", "position", "normal_stress", "temperature")


class RunSubject:
    """A run under examination; what several checks need is computed once, when first asked for.

    Parameters
    ----------
    run
        The run dataset.
    segments, friction
        Found if not given.
    set_normal_force
        [N] set-point of the normal force, NaN if unknown.
    contact_width
        [m] width of the contact, NaN if unknown.
    """

    def __init__(
        self,
        run: xr.Dataset,
        segments: xr.Dataset | None = None,
        friction: xr.Dataset | None = None,
        *,
        set_normal_force: float = float("nan"),
        contact_width: float = float("nan"),
    ) -> None:
        self.run = run
        self._segments, self._friction = segments, friction
        self.set_normal_force = set_normal_force
        self.contact_width = contact_width

    @cached_property
    def time(self) -> np.ndarray:
        """Time of the samples [s]."""
        return self.run["time"].values

    @cached_property
    def signals(self) -> dict[str, np.ndarray]:
        """The recorded signals by name."""
        return {name: self.run[name].values for name in _SIGNALS if name in self.run}

    @cached_property
    def force_signals(self) -> dict[str, np.ndarray]:
        """The signals that carry friction and load."""
        return {name: values for name, values in self.signals.items() if name in _FORCES}

    @cached_property
    def segments(self) -> xr.Dataset:
        """Segments of constant speed."""
        return find_segments(self.run) if self._segments is None else self._segments

    @cached_property
    def friction(self) -> xr.Dataset:
        """Friction of each segment."""
        if self._friction is None:
            return friction_coefficient(self.run, self.segments)
        return self._friction

    @cached_property
    def slices(self) -> list[slice]:
        """The samples of each trimmed segment."""
        first = np.searchsorted(self.time, self.segments["trimmed_start"].values, "left")
        last = np.searchsorted(self.time, self.segments["trimmed_stop"].values, "right")
        return [slice(int(a), int(b)) for a, b in zip(first, last, strict=True)]

    @cached_property
    def in_segments(self) -> np.ndarray:
        """Which samples lie within a trimmed segment."""
        inside = np.zeros(self.time.size, dtype=bool)
        for part in self.slices:
            inside[part] = True
        return inside

    def inside_segment(self, time: float) -> bool:
        """Whether a moment [s] lies within a trimmed segment."""
        starts, stops = self.segments["trimmed_start"].values, self.segments["trimmed_stop"].values
        return bool(((starts < time) & (time < stops)).any())

    @cached_property
    def durations(self) -> np.ndarray:
        """Duration of each segment [s]."""
        return self.segments["stop"].values - self.segments["start"].values

    @cached_property
    def friction_signal(self) -> str | None:
        """Name of the signal that carries friction, if there is one."""
        names = ("friction_force", "friction_coefficient")
        return next((name for name in names if name in self.signals), None)

    @cached_property
    def target_normal_force(self) -> np.ndarray:
        """Set-point of the normal force [N] for each segment, NaN where unknown."""
        size = self.segments.sizes["segment"]
        if np.isfinite(self.set_normal_force):
            return np.full(size, self.set_normal_force)
        if "set_normal_force" in self.segments:
            return self.segments["set_normal_force"].values
        return np.full(size, float(self.run.attrs.get("set_normal_force_N", np.nan)))

    def segment_means(self, name: str) -> np.ndarray:
        """Mean of a signal over each trimmed segment; empty if it was not recorded."""
        if name not in self.signals:
            return np.zeros(0)
        return np.array([_mean(self.signals[name][part]) for part in self.slices])

    def segment_stds(self, name: str) -> np.ndarray:
        """Return the standard deviation of a signal over each trimmed segment."""
        return np.array([np.nanstd(self.signals[name][part]) for part in self.slices])

    @cached_property
    def mean_force(self) -> float:
        """Typical magnitude of the friction force over the segments [N], NaN if unknown.

        The mean of the magnitudes of the half loops where strokes go both ways, so that an
        offset does not count as friction.
        """
        means = self.segment_means("friction_force")
        directions = self.segments["direction"].values
        forward, backward = means[directions > 0], means[directions < 0]
        if forward.size and backward.size:
            return float(abs(np.nanmean(forward) - np.nanmean(backward)) / 2)
        return float(np.nanmean(np.abs(means))) if means.size else float("nan")

    @cached_property
    def mean_normal_force(self) -> float:
        """Typical normal force over the segments [N], NaN if unknown."""
        means = self.segment_means("normal_force")
        return float(np.nanmean(means)) if means.size else float("nan")

    def unloaded_levels(self, name: str) -> list[float]:
        """Mean of a signal in each unloaded rest, in the order of time.

        A rest is unloaded where the normal force stays below 5 % of its mean over the segments
        for at least 20 samples, before, between or after the segments.
        """
        if name not in self.signals or not np.isfinite(self.mean_normal_force):
            return []
        low = np.abs(self.signals["normal_force"]) < 0.05 * self.mean_normal_force
        low &= ~self.in_segments
        edges = np.flatnonzero(np.diff(low.astype(np.int8), prepend=0, append=0))
        stretches = edges.reshape(-1, 2)
        values = self.signals[name]
        return [_mean(values[a:b]) for a, b in stretches if b - a >= 20]

    def speed_of(self, number: int) -> float:
        """Sliding speed of a segment [m/s]."""
        return float(self.segments["sliding_speed"].values[number])

    def segment_label(self, number: int) -> str:
        """Return what a person calls a segment: its number, speed, direction and time."""
        speed, start = self.speed_of(number), float(self.segments["start"].values[number])
        arrow = {1: "forward", -1: "backward"}.get(int(self.segments["direction"][number]), "")
        how = f"{speed:.3g} m/s {arrow}".strip() if np.isfinite(speed) else "speed unknown"
        return f"segment {number} ({how}, from t = {start:.6g} s)"

    @cached_property
    def _periods(self) -> np.ndarray:
        name = self.friction_signal
        if name is None:
            return np.full(len(self.slices), np.nan)
        return np.array([stick_slip_periods(self.signals[name][part]) for part in self.slices])

    def periods(self, number: int) -> float:
        """How many stick-slip periods a segment holds; NaN where there is no stick-slip."""
        return float(self._periods[number])

    def unit(self, name: str) -> str:
        """Return the unit of a variable as text, empty for pure numbers."""
        unit = self.run[name].attrs.get("units", "")
        return "" if unit == "1" else unit

    def noise(self, name: str) -> float:
        """Sample-to-sample noise of a signal, in its unit."""
        return noise_level(self.signals[name])


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")


def stick_slip_periods(values: np.ndarray, correlation: float = 0.4) -> float:
    """Count the periods of an oscillation that dominates a signal; NaN if none does.

    Parameters
    ----------
    values
        (time), evenly sampled.
    correlation
        Least autocorrelation at the lag of one period.

    Notes
    -----
    The lag of the highest peak of the autocorrelation behind its first zero, of the straightened
    signal: on means over stretches for slow waves, on the first samples as they are for fast ones.
    """
    best, count = correlation, float("nan")
    size = values.size // 4096
    views = [values[:4096]]
    if size > 1:
        views.append(values[: 4096 * size].reshape(4096, size).mean(axis=1))
    for view, share in zip(views, (4096 / values.size, 1.0), strict=False):
        n = view.size
        if n < 32 or not np.isfinite(view).all() or np.ptp(view) == 0:
            continue
        place = np.linspace(-1, 1, n)
        part = view - np.polynomial.polynomial.polyval(
            place, np.polynomial.polynomial.polyfit(place, view, 1)
        )
        power = np.abs(np.fft.rfft(part, 2 * n)) ** 2
        auto = np.fft.irfft(power)[: n // 2] / np.arange(n, n - n // 2, -1)
        auto /= auto[0]
        below = np.flatnonzero(auto < 0)
        if below.size == 0:
            continue
        lag = below[0] + int(np.argmax(auto[below[0] :]))
        if auto[lag] > best and lag < n // 2 - 1:
            best, count = float(auto[lag]), n / lag / min(share, 1.0)
    return count
