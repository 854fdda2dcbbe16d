"""Rules of a dialect for the sources of time and of the sliding speed."""

from __future__ import annotations

import contextlib
from typing import Literal, Self

from pydantic import Field, model_validator

from tribolab.core.errors import UnitError, shown
from tribolab.reading.dialect.checked_text import Pattern, Strict
from tribolab.reading.text.dates import Epoch, is_form
from tribolab.units.conversion import positive


class Time(Strict):
    """Source of time: a column (the default), intervals, a sampling rate, or none."""

    source: Literal["column", "period", "rate", "position", "none"] = Field(
        "column",
        description="'period': the column 'time' is the time since the previous row; 'position': "
        "position divided by the constant speed of a machine, stated by rate (or rate_pattern); "
        "'none': rows are counted as seconds, and the run says so",
    )
    format: str | None = Field(
        None,
        description="format of dates and times (or times of day): 'iso', 'iso with zone', or a "
        "strptime format, e.g. '%d.%m.%Y %H:%M:%S,%f'",
    )
    epoch: Epoch | None = Field(
        None,
        description="date from which the column counts: 'excel' (days since 1899-12-30: "
        "unit = \"d\"), 'labview' (1904, UTC), 'unix' (1970, UTC); gives the recording time",
    )
    rate: str | None = Field(
        None,
        description="sampling rate with unit, e.g. '2 kHz', or sampling interval: '0.5 ms'; for "
        "source 'position' a speed: '150 mm/min'",
    )
    rate_pattern: Pattern | None = Field(
        None, description="group 1 is the sampling rate or interval in the text above the table"
    )
    rate_unit: str = Field(
        "Hz",
        description="unit of that rate: of frequency, time (interval) or speed",
    )
    restart: Literal["error", "continue"] = Field(
        "error",
        description="'continue': time continues if the clock restarts (in a table, at a step, in a "
        "file)",
    )
    wrap: str | None = Field(None, description="range of the clock's counter, e.g. '65.536 s'")
    on_repeat: Literal["error", "drop", "interpolate"] = Field(
        "error",
        description="for rows that are not later than all before: 'drop' removes them, "
        "'interpolate' spaces them evenly between their neighbours",
    )
    start_pattern: Pattern | None = Field(
        None, description="group 1 is the date and time of the start of a step (or of the file)"
    )
    start_format: str | None = Field(None, description="strptime format of that date and time")

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.source in ("rate", "position")) != bool(self.rate or self.rate_pattern):
            raise ValueError(
                "source = 'rate' (or 'position') and rate (or rate_pattern) belong together"
            )
        if self.source != "column" and (self.format or self.epoch):
            raise ValueError("format and epoch are for source = 'column'")
        if self.format and self.epoch:
            raise ValueError("format and epoch exclude one another")
        if self.format and not is_form(self.format):
            raise ValueError(
                f"format: 'iso', 'iso with zone', or codes such as %d and %H; not "
                f"'{shown(self.format)}'"
            )
        if self.rate and self.source == "position":
            positive(self.rate, "m/s", "time.rate")
        elif self.rate:
            sampling_interval(self.rate, "time.rate")
        if self.wrap:
            positive(self.wrap, "s", "time.wrap")
        if bool(self.start_pattern) != bool(self.start_format):
            raise ValueError("start_pattern and start_format belong together")
        return self


def sampling_interval(text: str, name: str) -> float:
    """Return the sampling interval [s] from a rate or an interval.

    Parameters
    ----------
    text
        Number with a unit of frequency or time.
    name
        Name for messages.

    Raises
    ------
    UnitError
        If it is neither a rate nor an interval.

    Examples
    --------
    >>> sampling_interval("2 kHz", "rate"), sampling_interval("0.5 ms", "rate")
    (0.0005, 0.0005)
    """
    if "Hz" not in text:  # avoids a conversion that fails slowly
        with contextlib.suppress(UnitError):
            return positive(text, "s", name)
    return 1.0 / positive(text, "Hz", name)


class Speed(Strict):
    """Source of the sliding speed."""

    source: Literal["column", "position", "rotation", "stroke", "set speed", "none"] = "column"
    radius: str | None = Field(None, description="track radius with unit, for source 'rotation'")
    radius_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the radius"
    )
    stroke: str | None = Field(
        None, description="stroke, end to end, with unit, for source 'stroke'"
    )
    stroke_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the stroke"
    )
    frequency: str | None = Field(None, description="frequency of the cycles, e.g. '5 Hz'")
    frequency_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the frequency"
    )
    drive: Literal["crank", "constant speed"] = Field(
        "crank", description="for source 'stroke': sinusoidal or constant velocity"
    )

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.source == "rotation") != bool(self.radius or self.radius_value):
            raise ValueError("source = 'rotation' and radius (or radius_value) belong together")
        of_strokes = [self.stroke or self.stroke_value, self.frequency or self.frequency_value]
        if (self.source == "stroke") != all(of_strokes) or (any(of_strokes) != all(of_strokes)):
            raise ValueError(
                "source = 'stroke', stroke (or stroke_value) and frequency (or frequency_value) "
                "belong together"
            )
        for key, unit in (("radius", "m"), ("stroke", "m"), ("frequency", "Hz")):
            text = getattr(self, key)
            if text and text.strip()[:1].isalpha():
                raise ValueError(
                    f"speed.{key}: '{shown(text)}' is no number with a unit; write {key}_value = "
                    '"(name of the [[value]])", which may have scale = 0.5 for half of it'
                )
            if text:
                positive(text, unit, f"speed.{key}")
        return self

    @property
    def values_named(self) -> dict[str, str]:
        """Names of the values used, by key."""
        keys = ("radius_value", "stroke_value", "frequency_value")
        return {key: value for key in keys if (value := getattr(self, key))}
