"""Interpretation of the columns of an unknown table."""

from __future__ import annotations

from enum import Enum
from typing import Any, Literal, NamedTuple

import numpy as np


class Reason(Enum):
    """Reason why a column is not read, in the words of its note."""

    TEXT = "not a number: '{}'"
    UNKNOWN_NAME = "the name is not known"
    ADDS = "one of several loads that add up"
    EITHER_FORCE = "whether '{}' is the friction force or the normal force"


Kind = Literal["run", "scan", "table"]


class DraftColumn(NamedTuple):
    """Interpretation of one column of a table.

    The reader finds the column by `name`, or by `place` (from 1) if `name` is None. `file_unit` is
    the unit that the file states, `unit` the one that the dialect must state. Only columns with
    `used` are read. `counted` marks raw counts of a converter, which need a calibration factor:
    `scale` is the number of units per count. `zero` is the interval from which the zero is read.
    `guessed` lists guesses, `options` their alternatives, and `fill_in` what the user must state.
    `note` says why the column is not used; `reason` is the same as a constant. `form` is the format
    of dates, `epoch` the epoch of a clock, `group` the group of a TDMS channel, and `said` the name
    by the user if the column is a torque or angle, which are no quantities of a run.
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
        """Return the column as not used, with the reason as its note and without open questions."""
        nothing: dict[str, Any] = {"used": False, "guessed": (), "options": (), "fill_in": ""}
        return self._replace(**(nothing | {"note": note} | more))

    @property
    def read_unit(self) -> str | None:
        """Unit of the numbers; times of day and dates are read as seconds."""
        return "s" if self.form else self.unit or self.file_unit


Agreed = Literal["radius", "load", "speed"]


class Understood(NamedTuple):
    """Interpretation of a table: its columns, its kind, and the numbers (rows, columns) as written.

    With `period`, the time column of the file contains intervals, which `numbers` has as sums.
    `radius`, `load`, `speed` and `rate` (sampling rate) with units, `drive` and `strokes` (length
    and frequency) are answers of the user, "" if not given. `agreed` are the lines of text that the
    user confirmed as the radius, load or speed. Without a time column, `rate_pattern` finds the
    sampling rate above the table. Without positions, `pitch_pattern` finds the pitch of a profile
    and `length_pattern` its length, or `pitch` is the pitch. With `points`, each row is a result at
    one speed.
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
        """Whether the pitch of heights without positions is known."""
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
    """Return the usual units of a dimension, given by its SI unit, without the chosen unit.

    "height" instead of "m" gives the smaller units that are usual for heights.

    >>> other_units("s", "ms")
    ('s', 'min')
    """
    return tuple(unit for unit in _UNITS.get(si_unit, (si_unit,)) if unit != chosen)


def time_unit(values: np.ndarray) -> str:
    """Return the likely unit of a clock: "ms" for integers in steps of five or more, else "s".

    In steps of a thousand or more, integers that are rarely multiples of ten are "us", as from
    Arduino's micros().
    """
    steps = np.diff(values[np.isfinite(values)])
    whole = steps.size and (values == np.round(values)).all()
    if whole and np.median(steps) >= 1000 and (values % 10 != 0).mean() > 0.5:
        return "us"
    return "ms" if whole and np.median(steps) >= 5 else "s"


def proceeds_by_seconds(values: np.ndarray) -> bool:
    """Whether the steps of a clock without a unit show that it counts seconds.

    They do if they are round decimal fractions: milliseconds would be integers, and a second is no
    round fraction of a minute.
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
