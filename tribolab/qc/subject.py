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

    def unit(self, name: str) -> str:
        """Unit of a variable as text, empty for pure numbers."""
        unit = self.run[name].attrs.get("units", "")
        return "" if unit == "1" else unit

    def noise(self, name: str) -> float:
        """Sample-to-sample noise of a signal, in its unit."""
        return noise_level(self.signals[name])
