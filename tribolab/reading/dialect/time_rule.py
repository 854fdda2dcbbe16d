"""Where a dialect says that time comes from."""

from __future__ import annotations

import contextlib
from typing import Literal, Self

from pydantic import Field, model_validator

from tribolab.core.errors import UnitError, shown
from tribolab.reading.dialect.checked_text import Pattern, Strict
from tribolab.reading.text.dates import Epoch, is_form
from tribolab.units.conversion import positive


class Time(Strict):
    """Where time comes from: a column (the default), intervals, a sample rate, or nowhere."""

    source: Literal["column", "period", "rate", "position", "none"] = Field(
        "column",
        description="'period': the column of 'time' contains the time since the row before, "
        "and is summed; 'position': the way over the speed at which a machine goes on, which rate "
        "(or rate_pattern) states; 'none': rows are counted as seconds, and the run says so",
    )
    format: str | None = Field(
        None,
        description="the column holds dates and times (or times of day): 'iso', 'iso with zone', "
        "or as for strptime, e.g. '%d.%m.%Y %H:%M:%S,%f'",
    )
    epoch: Epoch | None = Field(
        None,
        description="the column counts from a date, which tells when it was recorded: 'excel' "
        "(days since 1899-12-30: unit = \"d\"), 'labview' (1904, UTC), 'unix' (1970, UTC)",
    )
    rate: str | None = Field(
        None,
        description="sample rate with unit, e.g. '2 kHz', or the interval of samples: '0.5 ms'; "
        "for source 'position' a speed: '150 mm/min'",
    )
    rate_pattern: Pattern | None = Field(
        None, description="group 1 is the rate, or the interval of samples, in the preamble"
    )
    rate_unit: str = Field(
        "Hz",
        description="its unit; one of time ('ms') where it is the interval of samples, of speed "
        "where it is one",
    )
    restart: Literal["error", "continue"] = Field(
        "error",
        description="'continue': where the clock restarts (in a table, at a step, in a file), "
        "time goes on",
    )
    wrap: str | None = Field(
        None, description="the clock's counter restarts after this time, e.g. '65.536 s'"
    )
    on_repeat: Literal["error", "drop", "interpolate"] = Field(
        "error",
        description="rows whose time is not later than all before: 'drop' leaves them out, "
        "'interpolate' gives them times evenly between their neighbours'",
    )
    start_pattern: Pattern | None = Field(
        None, description="group 1 is the date and time at which a step (or the file) starts"
    )
    start_format: str | None = Field(None, description="its format as for strptime")

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
    """Return the time [s] between samples from their rate or from the interval itself.

    Parameters
    ----------
    text
        A number with a unit, of frequency or of time.
    name
        What it is called, for messages.

    Raises
    ------
    UnitError
        If it is neither.

    Examples
    --------
    >>> sampling_interval("2 kHz", "rate"), sampling_interval("0.5 ms", "rate")
    (0.0005, 0.0005)
    """
    if "Hz" not in text:  # a unit that does not fit is slow to refuse
        with contextlib.suppress(UnitError):
            return positive(text, "s", name)
    return 1.0 / positive(text, "Hz", name)
