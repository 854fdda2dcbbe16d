"""The columns of an unknown table as they are understood."""

from __future__ import annotations

from enum import Enum
from typing import Any, Literal, NamedTuple

import numpy as np


class Reason(Enum):
    """Why a column is not read as it is, in words for its note."""

    TEXT = "not a number: '{}'"
    UNKNOWN_NAME = "the name is not known"
    ADDS = "one of several loads that add up"
    EITHER_FORCE = "whether '{}' is the friction force or the normal force"


Kind = Literal["run", "scan", "table"]


class DraftColumn(NamedTuple):
    """One column as it is understood.

    `name` is None where the reader has to find it by `place` (from 1). `unit` is what the dialect
    has to say; `file_unit` what the file says. Only a column with ``used`` is read.
    `group` is that of a TDMS channel. A converter's counts are `counted`: what one is worth is to
    be said.
    One of its numbers is `scale` units, and `zero` says from where its zero is read; `said` is what
    a person called it that is no quantity: a torque, or an angle. `note` says in words why it is
    not used; `reason` is what other rules may ask of that.
    `options` is what it may be instead, where something is guessed; `form` that of its dates;
    `epoch` the moment that a column of time counts from; `zero` where its zero is read.
    """

    place: int
    label: str
    name: str | None = None
    occurrence: int = 1
    file_unit: str | None = None
    unit: str | None = None
    quantity: str | None = None
    sign: int = 1
    optional: bool = False
    used: bool = False
    guessed: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    note: str = ""
    reason: Reason | None = None
    fill_in: str = ""
    form: str = ""
    epoch: str = ""
    group: str = ""
    counted: bool = False
    scale: float = 1.0
    offset: float = 0.0
    zero: str = ""
    said: Literal["", "torque", "angle"] = ""

    def unused(self, note: str, **more: Any) -> DraftColumn:
        """Return the column as one that is not read, without open questions, and why."""
        nothing: dict[str, Any] = {"used": False, "guessed": (), "options": (), "fill_in": ""}
        return self._replace(**(nothing | {"note": note} | more))

    @property
    def read_unit(self) -> str | None:
        """The unit the numbers are read in."""
        return "s" if self.form else self.unit or self.file_unit


Agreed = Literal["radius", "load", "speed"]


class Understood(NamedTuple):
    """Columns of a table, what kind of file it is, and their numbers (rows, columns) as written.

    With `period` the column of time held intervals; its numbers are their sums by now.
    `radius`, `load`, `speed` and `rate` (with their units) and `drive` are what a person said of a
    track, of what presses, of how fast it slides, of the rows, and of what drives it; `strokes` the
    length and the frequency of strokes, "" for what was not said. `agreed` are lines of the text
    that a person took for the radius, the load or the speed, by what they are.
    Where no column is time, `rate_pattern` finds the sample rate before the table, if it is there;
    where no column is a position, `pitch_pattern` the distance of a profile's points,
    `length_pattern` its length, or `pitch` is what is known of the distance.
    With `points` each row is a result at one speed.
    """

    kind: Kind
    columns: tuple[DraftColumn, ...]
    numbers: np.ndarray
    missing: tuple[str, ...]
    on_repeat: Literal["", "drop", "interpolate"]
    restart: bool
    guesses: tuple[str, ...]
    period: bool = False
    rate_pattern: str = ""
    rate_unit: str = ""
    radius: str = ""
    load: str = ""
    speed: str = ""
    rate: str = ""
    drive: str = ""
    strokes: tuple[str, str] | None = None
    agreed: tuple[tuple[Agreed, str], ...] = ()
    zero: str = ""
    pitch_pattern: str = ""
    length_pattern: str = ""
    pitch: str = ""
    points: bool = False

    @property
    def pitched(self) -> bool:
        """Whether it is known how far heights without positions lie apart."""
        return bool(self.pitch_pattern or self.length_pattern or self.pitch)


_UNITS = {
    "s": ("s", "ms", "min"),
    "m": ("mm", "um", "m"),
    "height": ("um", "nm", "mm", "m"),
    "N": ("N", "mN", "gf"),
    "m/s": ("mm/s", "m/s", "um/s"),
    "rad/s": ("1/min", "Hz", "rad/s"),
    "K": ("degC", "K"),
    "Pa": ("MPa", "kPa", "bar", "Pa"),
    "V": ("V", "mV"),
    "Pa s": ("mPa s", "Pa s"),
}


def other_units(si_unit: str, chosen: str = "") -> tuple[str, ...]:
    """Return units that instruments write for what is measured in an SI unit, but the chosen one.

    Heights of a scan are written in smaller ones than ways: "height" is for them.

    >>> other_units("s", "ms")
    ('s', 'min')
    """
    return tuple(unit for unit in _UNITS.get(si_unit, (si_unit,)) if unit != chosen)


def time_unit(values: np.ndarray) -> str:
    """Whole numbers that proceed by five and more are milliseconds, other numbers seconds.

    By a thousand and more, and not in tens, they are microseconds, as of Arduino's micros().
    """
    steps = np.diff(values[np.isfinite(values)])
    whole = steps.size and (values == np.round(values)).all()
    if whole and np.median(steps) >= 1000 and (values % 10 != 0).mean() > 0.5:
        return "us"
    return "ms" if whole and np.median(steps) >= 5 else "s"


def proceeds_by_seconds(values: np.ndarray) -> bool:
    """Whether a clock without a unit has decimals and steps by a round part of a second.

    A clock of milliseconds is a whole number; a second is no round part of a minute.
    File: Rtec MFT, "Timestamp" 0.168, 0.268 (Dichimanaym/Tribometer-Data-Processing).

    >>> proceeds_by_seconds(np.array([0.168, 0.268, 0.368, 0.468]))
    True
    >>> proceeds_by_seconds(np.arange(4) / 60), proceeds_by_seconds(np.arange(4) * 10.0)
    (False, False)
    """
    steps = np.diff(values[np.isfinite(values)])
    if steps.size < 2 or not (steps >= 0).any() or (values == np.round(values)).all():
        return False
    step = float(np.median(steps))
    parts = step / 10.0 ** np.floor(np.log10(step)) if step > 0 else 0.0
    return bool(step <= 1 and min(abs(parts / n - 1) for n in (1, 2, 2.5, 4, 5, 8, 10)) < 1e-3)
