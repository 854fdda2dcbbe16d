"""Data that the checks on a run examine: signals, segments and contact."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import xarray as xr

from tribolab.arrays.chunks import PIECE, one_by_one, pieces, stretches
from tribolab.arrays.medians import median_in_pieces, median_of_known
from tribolab.arrays.reversals import reversals
from tribolab.arrays.scratch import filled
from tribolab.core.attributes import RunAttributes, SegmentAttributes
from tribolab.core.errors import AnalysisError
from tribolab.core.wording import number as number_text
from tribolab.core.wording import speed_text
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.coefficient.segment_samples import trimmed_slices
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.oscillation.spectrum.lines import Line, segment_lines
from tribolab.friction.segments.find import find_segments
from tribolab.friction.segments.no_segment import consists_of_ramps, why_no_segment
from tribolab.qc.flags import NOT_EVALUATED
from tribolab.qc.register import Skip

_FORCES = ("friction_force", "normal_force", "friction_coefficient")
_SIGNALS = (*_FORCES, "sliding_velocity", "position", "normal_stress", "temperature")


class RunSubject:
    """A run to be checked, with quantities that several checks need; each is computed once.

    Parameters
    ----------
    run
        The run dataset.
    segments, friction, slip
        Computed if not given.
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
        slip: xr.Dataset | None = None,
        *,
        set_normal_force: float = float("nan"),
        contact_width: float = float("nan"),
    ) -> None:
        self.run = run
        self._segments, self._friction, self._slip = segments, friction, slip
        self.set_normal_force = set_normal_force
        self.contact_width = contact_width

    @cached_property
    def time(self) -> np.ndarray:
        """Time of the samples [s]."""
        return self.run["time"].values

    @cached_property
    def signals(self) -> dict[str, np.ndarray]:
        """Recorded signals by name."""
        return {name: self.run[name].values for name in _SIGNALS if name in self.run}

    @cached_property
    def force_signals(self) -> dict[str, np.ndarray]:
        """Signals of friction and load."""
        return {name: values for name, values in self.signals.items() if name in _FORCES}

    @cached_property
    def _segments_or_skip(self) -> xr.Dataset | Skip:
        if self._segments is not None:
            return self._segments
        try:
            return find_segments(self.run)
        except AnalysisError as why:  # e.g. the speed is unknown, which the check `schema` reports
            return Skip(f"no segments: {why}")

    @property
    def missing_segment_reason(self) -> str:
        """Why there is no segment, as a sentence; "" if there is one."""
        if isinstance(self._segments_or_skip, Skip):
            raise self._segments_or_skip  # the speed is unknown, which the check `schema` reports
        return why_no_segment(self._segments_or_skip)

    @property
    def is_ramp(self) -> bool:
        """Whether the speed increases or decreases throughout the run."""
        found = self._segments_or_skip
        return not isinstance(found, Skip) and consists_of_ramps(found)

    @property
    def segments(self) -> xr.Dataset:
        """Segments of constant speed; the check is skipped if there are none."""
        if isinstance(self._segments_or_skip, Skip):
            raise self._segments_or_skip
        if self._segments_or_skip.sizes["segment"] == 0:
            raise Skip("no segment of constant speed was found")
        return self._segments_or_skip

    @cached_property
    def about(self) -> RunAttributes:
        """Attributes of the run."""
        return RunAttributes.from_attrs(self.run.attrs)

    @property
    def segment_about(self) -> SegmentAttributes:
        """Attributes of the segments; the check is skipped if there are none."""
        return SegmentAttributes.from_attrs(self.segments.attrs)

    @property
    def is_points(self) -> bool:
        """Whether the rows are results of the instrument and not samples."""
        found = self._segments_or_skip
        return not isinstance(found, Skip) and (
            SegmentAttributes.from_attrs(found.attrs).rows_are == "points"
        )

    @cached_property
    def _friction_or_skip(self) -> xr.Dataset | Skip:
        if self._friction is not None:
            return self._friction
        try:
            return friction_coefficient(self.run, self.segments)
        except AnalysisError as why:
            return Skip(f"no friction: {why}")

    @property
    def friction(self) -> xr.Dataset:
        """Friction of each segment; the check is skipped if there is none."""
        if isinstance(self._friction_or_skip, Skip):
            raise self._friction_or_skip
        return self._friction_or_skip

    @property
    def sliding(self) -> bool:
        """Whether the run has any segment."""
        segments = self._segments_or_skip
        return not isinstance(segments, Skip) and segments.sizes["segment"] > 0

    @cached_property
    def slices(self) -> list[slice]:
        """Index range of the samples of each trimmed segment."""
        return trimmed_slices(self.run, self.segments)

    @cached_property
    def segment_mask(self) -> np.ndarray:
        """Mask of the samples in trimmed segments."""
        inside = np.zeros(self.time.size, dtype=bool)
        for part in self.slices if self.sliding else []:
            inside[part] = True
        return inside

    def typical_size(self, name: str) -> float:
        """Return a signal's median magnitude in the segments; without any, in the whole run."""
        values = self.signals[name]
        inside = self.segment_mask if self.segment_mask.any() else np.ones(values.size, dtype=bool)

        def sizes(first: int, last: int) -> np.ndarray:
            return np.abs(values[first:last][inside[first:last]])

        return float(median_in_pieces(sizes, values.size))

    def sample_flags(self, flags: np.ndarray) -> np.ndarray:
        """Return flags on the samples (time), from one flag per segment."""
        samples = filled(self.time.size, NOT_EVALUATED, np.int8)
        for part, flag in one_by_one(zip(self.slices, flags, strict=True)):
            samples[part] = flag
        return samples

    @cached_property
    def friction_signal(self) -> str | None:
        """Name of the friction signal; None if there is none."""
        names = ("friction_force", "friction_coefficient")
        return next((name for name in names if name in self.signals), None)

    @property
    def required_friction_signal(self) -> str:
        """Name of the friction signal; the check is skipped if there is none."""
        if self.friction_signal is None:
            raise Skip("no friction was recorded")
        return self.friction_signal

    @cached_property
    def target_normal_force(self) -> np.ndarray:
        """Set-point of the normal force [N] of each segment; NaN if unknown."""
        size = self.segments.sizes["segment"]
        if np.isfinite(self.set_normal_force):
            return np.full(size, self.set_normal_force)
        if "set_normal_force" in self.segments:
            return self.segments["set_normal_force"].values
        return np.full(size, float(self.run.attrs.get("set_normal_force_N", np.nan)))

    def segment_means(self, name: str) -> np.ndarray:
        """Return the mean of a signal in each trimmed segment; skip the check without it."""
        if name not in self.signals:
            raise Skip(f"{name} was not recorded")
        return np.array([_mean(self.signals[name][part]) for part in one_by_one(self.slices)])

    def segment_stds(self, name: str) -> np.ndarray:
        """Return the standard deviation of a signal in each trimmed segment."""
        parts = (self.signals[name][part] for part in one_by_one(self.slices))
        return np.array([_std(values) for values in parts])

    @cached_property
    def typical_friction(self) -> float:
        """Typical magnitude of the friction signal in the segments, in its unit.

        Half the difference between the directions if there are two, so that an offset does not
        count as friction; else the mean magnitude.
        """
        means = self.segment_means(self.required_friction_signal)
        directions = self.segments["direction"].values
        forward, backward = _mean(means[directions > 0]), _mean(means[directions < 0])
        loop = abs(forward - backward) / 2
        # a rectified coefficient has the same sign in both strokes
        typical = loop if loop > 0.1 * _mean(np.abs(means)) else _mean(np.abs(means))
        if not typical > 0:
            raise Skip("there is no friction to compare with")
        return typical

    @cached_property
    def typical_normal_force(self) -> float:
        """Typical normal force in the segments [N]."""
        typical = abs(_mean(self.segment_means("normal_force")))
        if not typical > 0:
            raise Skip("there is no normal force to compare with")
        return typical

    def unloaded_levels(self, name: str) -> list[float]:
        """Return the median of a signal in each unloaded rest, in order of time.

        A rest is unloaded if the normal force is below a tenth of its mean over the segments for at
        least 20 samples outside the segments. The load ramp may begin in it, hence the median.
        """
        if name not in self.signals:
            raise Skip(f"{name} was not recorded")
        if "normal_force" not in self.signals:
            raise Skip("no normal force was recorded that would show a rest without load")
        force, light = self.signals["normal_force"], 0.10 * self.typical_normal_force
        inside = self.segment_mask
        rests = stretches(lambda a, b: (np.abs(force[a:b]) < light) & ~inside[a:b], force.size)
        parts = [self.signals[name][a:b] for a, b in rests if b - a >= 20]
        return [float(median_of_known(part)) for part in parts if np.isfinite(part).any()]

    def speed_of(self, number: int) -> float:
        """Return the sliding speed of a segment [m/s]."""
        return float(self.segments["sliding_speed"].values[number])

    def segment_label(self, number: int) -> str:
        """Return a label of a segment: its number in tables, speed, direction and start time."""
        speed, start = self.speed_of(number), float(self.segments["start"].values[number])
        own = int(self.segments["segment"].values[number])  # rejected segments are numbered, too
        arrow = {1: "forward", -1: "backward"}.get(int(self.segments["direction"][number]), "")
        how = f"{speed_text(speed)} {arrow}".strip()
        return f"segment {own + 1} ({how}, from t = {number_text(start, 4)} s)"

    @cached_property
    def _slip_or_skip(self) -> xr.Dataset | Skip:
        if self._slip is not None:
            return self._slip
        try:
            return stick_slip(self.run, self.segments)
        except AnalysisError as why:
            return Skip(f"no oscillation was looked for: {why}")

    @property
    def slip(self) -> xr.Dataset:
        """Stick-slip of each segment."""
        if isinstance(self._slip_or_skip, Skip):
            raise self._slip_or_skip
        return self._slip_or_skip

    def strong_periods(self, least: float) -> np.ndarray:
        """Return the number of stick-slip periods in each segment; NaN if not significant.

        A wave with too few periods to be reported as stick-slip counts as well.

        Parameters
        ----------
        least
            Smallest relevant standard deviation, relative to the run's typical friction.
        """
        return np.where(self.oscillates_strongly(least), self.slip["periods"].values, np.nan)

    def oscillates_strongly(self, least: float) -> np.ndarray:
        """Return a mask of segments whose standard deviation exceeds a share of the friction."""
        name = self.required_friction_signal
        return self.segment_stds(name) > least * self.typical_friction

    @cached_property
    def sliding_lines(self) -> list[Line]:
        """Spectral lines of friction, except those of a reciprocation that was not recorded."""
        values = self.signals[self.required_friction_signal]
        significant = [
            segment_lines(self.time[part], values[part], number, self.speed_of(number))
            for number, part in enumerate(one_by_one(self.slices))
        ]
        if all(lines is None for lines in significant):
            raise Skip("sampled too slowly or too shortly for a spectrum")
        found = [line for lines in significant for line in lines or []]
        return [line for line in found if not self.reversals[line.segment]]

    @cached_property
    def reversals(self) -> np.ndarray:
        """Return the number of sign changes of friction in each segment of unknown direction."""
        values = self.signals[self.required_friction_signal]
        unknown = np.isnan(self.segments["sliding_speed"].values)
        if self.segment_about.velocity_source in ("set speed", "step"):
            unknown[:] = True  # the set-point of the speed has no direction
        return np.array(
            [
                reversals(values[part]) if lost else 0
                for part, lost in zip(self.slices, unknown, strict=True)
            ]
        )

    def unit(self, name: str) -> str:
        """Return the unit of a variable as text; "" for pure numbers."""
        unit = self.run[name].attrs.get("units", "")
        return "" if unit == "1" else unit


def _known(values: np.ndarray) -> np.ndarray:
    good = np.isfinite(values)
    return values if good.all() else values[good]  # avoids copying long parts


def _mean(values: np.ndarray) -> float:
    known = _known(values)
    return float(known.mean()) if known.size else float("nan")


def _std(values: np.ndarray) -> float:
    known = _known(values)
    if not known.size:
        return float("nan")
    if known.size <= PIECE:
        return float(known.std())
    level = known.mean()
    squares = [np.square(known[a:b] - level).sum() for a, b in pieces(0, known.size)]
    return float(np.sqrt(sum(squares) / known.size))
