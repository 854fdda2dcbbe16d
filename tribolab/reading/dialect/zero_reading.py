"""Zeros of signals, read in an interval that the user states, or in a blank run."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import lowered
from tribolab.core.errors import Cure, ReadError, UnitError, shown
from tribolab.core.untyped import Json
from tribolab.units.conversion import to_si
from tribolab.units.quantities import quantity

_SAMPLES = re.compile(r"^\s*first\s+(\d+)\s+samples?\s*$")
_FIRST = re.compile(r"^\s*first\s+(\S.*?)\s*$")
_BETWEEN = re.compile(r"^\s*(\S.*?)\s+to\s+(\S.*?)\s*$")
_BLANK = re.compile(r"^\s*file\s+(\S.*?)\s*$")
_MIN_SAMPLES = 10  # needed to read a zero
_RUBS = 0.12  # contact if friction exceeds this share of its 90th percentile
_MOVES, _MOSTLY = 0.01, 0.5  # motion: share of the highest speed that this share of samples exceeds
_BATCHES = 16  # batches whose scatter gives the error of the zero


class ZeroRule(NamedTuple):
    """Source of a zero: first samples, an interval [s], or a file."""

    samples: int = 0
    start: float = -np.inf
    stop: float = np.inf
    file: str = ""


def parse_zero(text: str) -> ZeroRule:
    """Return the samples, interval or file in which a zero is read, from a text.

    Parameters
    ----------
    text
        ``"first 200 samples"``, ``"first 2 s"``, ``"1.5 s to 3 s"`` (time from the first sample) or
        ``"file blank.csv"`` (in the folder of the run's file).

    Raises
    ------
    UnitError
        If the text has another form.

    Examples
    --------
    >>> parse_zero("first 200 samples").samples, parse_zero("1.5 s to 3 s").stop
    (200, 3.0)
    >>> parse_zero("file blank.csv").file
    'blank.csv'
    """
    if match := _SAMPLES.match(text):
        return ZeroRule(samples=int(match[1]))
    if match := _BLANK.match(text):
        return ZeroRule(file=match[1])
    if match := _FIRST.match(text):
        return ZeroRule(stop=to_si(match[1], "s", "zero"))
    if match := _BETWEEN.match(text):
        return ZeroRule(start=to_si(match[1], "s", "zero"), stop=to_si(match[2], "s", "zero"))
    raise UnitError(
        f"zero: '{shown(text)}' does not say where the zero is read; write 'first 200 samples', "
        "'first 2 s', '1.5 s to 3 s' or 'file blank.csv'"
    )


def take_zeros(
    columns: dict[str, np.ndarray],
    time: np.ndarray,
    rules: Mapping[str, str],
    blank: Callable[[str], Mapping[str, np.ndarray]],
    where: str,
    units: Mapping[str, str] | None = None,
) -> Json:
    """Subtract the zero of each signal that has a rule, and return attributes on the zeros.

    Parameters
    ----------
    columns
        Signals in SI by quantity (time); those with a rule are replaced.
    time
        Time since the first sample [s] (time).
    rules
        Source of each quantity's zero, see `parse_zero`.
    blank
        Function that returns the columns of a file named in a rule.
    where
        The run, for messages.
    units
        SI units of symbols that are not quantities; their attributes have no unit in the name.

    Returns
    -------
    dict
        Attributes: ``<quantity>_zero_N``, its standard error from the scatter of 16 batches
        (``..._zero_sem_N``), and its source, ``zeros_read``.

    Raises
    ------
    ReadError
        If the signal is missing, or has fewer than 10 samples for its zero.
    """
    attrs: Json = {}
    said = {}
    for name, text in rules.items():
        if name not in columns:
            continue
        samples = _samples(name, parse_zero(text), columns, time, blank, where)
        zero, error = _zero_of(name, text, samples, where)
        unit = "1" if name in (units or {}) else quantity(name).unit
        ending = "" if unit == "1" else f"_{unit}"
        columns[name] = lowered(columns[name], zero)
        attrs |= {f"{name}_zero{ending}": zero, f"{name}_zero_sem{ending}": error}
        said[name] = text
    if said:
        attrs["zeros_read"] = said
    return attrs


def zeros_of_derived(
    columns: Mapping[str, np.ndarray],
    signals: Mapping[str, np.ndarray],
    attrs: Json,
) -> None:
    """Transfer the zero of a signal to the attributes of a force derived from it.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time).
    signals
        Signals with their zero subtracted, by symbol (time).
    attrs
        Attributes of the run, with ``derived`` and those of `take_zeros`; changed in place.
    """
    for name, formula in dict(attrs.get("derived", {})).items():
        used = [symbol for symbol in signals if re.search(rf"\b{symbol}\b", str(formula))]
        if len(used) != 1 or name not in columns or f"{used[0]}_zero" not in attrs:
            continue
        signal, unit = signals[used[0]], quantity(name).unit
        large = np.abs(signal) > 0.5 * np.nanmax(np.abs(signal), initial=0.0)
        # the force is proportional to the signal
        factor = float(np.median(columns[name][large] / signal[large]))
        for key in ("zero", "zero_sem", "zero_uncertainty"):
            if (value := attrs.pop(f"{used[0]}_{key}", None)) is not None:
                times = factor if key == "zero" else abs(factor)
                attrs[f"{name}_{key}_{unit}"] = times * value
        read = {**attrs["zeros_read"], name: attrs["zeros_read"][used[0]]}
        attrs["zeros_read"] = {k: v for k, v in read.items() if k != used[0]}


def free_while_zeroed(columns: dict[str, np.ndarray], time: np.ndarray, attrs: Json) -> Json:
    """Set a stated load to zero where the zero of friction is read during motion.

    If the zero is read during motion, the bodies are not in contact, and the load does not act.

    Parameters
    ----------
    columns
        Signals in SI by quantity (time); the load is replaced.
    time
        Time since the first sample [s] (time).
    attrs
        Attributes of the run, with ``zeros_read`` and ``derived``.

    Returns
    -------
    dict
        ``load_stated_from_s`` if the load was changed.
    """
    read, made = attrs.get("zeros_read", {}), attrs.get("derived", {})
    moves = ("sliding_velocity", "rotation_speed", "set_speed")
    motion = next((columns[name] for name in moves if name in columns), None)
    stated = isinstance(made, Mapping) and "normal_force" in made and "normal_force" in columns
    if not isinstance(read, Mapping) or "friction_force" not in read or not stated:
        return {}
    load = columns["normal_force"]
    rule = parse_zero(str(read["friction_force"]))
    from_start = not rule.file and rule.start == -np.inf
    rows = rule.samples or (int(np.searchsorted(time, rule.stop)) if from_start else 0)
    if motion is None or not 0 < rows < load.size or np.ptp(load[np.isfinite(load)]) > 0:
        return {}
    size = np.abs(motion)
    if not np.mean(size[:rows] > _MOVES * np.nanmax(size, initial=0.0)) > _MOSTLY:
        return {}
    rows += _samples_without_friction(np.abs(columns["friction_force"]), rows)
    free = load.copy()
    free[:rows] = 0.0
    columns["normal_force"] = free
    return {"load_stated_from_s": float(time[min(rows, load.size - 1)])}


def _samples_without_friction(friction: np.ndarray, rows: int) -> int:
    """Return how many samples follow the first `rows` until five in a row show friction."""
    rubs = friction[rows:] > _RUBS * np.nanpercentile(friction, 90)
    held = np.convolve(rubs, np.ones(5), "valid") >= 5
    return int(np.argmax(held)) if held.any() else 0


def _zero_of(name: str, text: str, values: np.ndarray, where: str) -> tuple[float, float]:
    """Return the mean of the samples for a zero, and its standard error."""
    values = values[np.isfinite(values)]
    if values.size < _MIN_SAMPLES:
        raise ReadError(
            f"zero of {name}: '{shown(text)}' holds {values.size} numbers, and {_MIN_SAMPLES} are "
            "needed",
            where=where,
            cure=Cure(*["name a longer stretch in `zero`"] * 3),
        )
    batches = np.array([part.mean() for part in np.array_split(values, _BATCHES) if part.size])
    return float(values.mean()), float(batches.std(ddof=1) / np.sqrt(batches.size))


def _samples(
    name: str,
    rule: ZeroRule,
    columns: Mapping[str, np.ndarray],
    time: np.ndarray,
    blank: Callable[[str], Mapping[str, np.ndarray]],
    where: str,
) -> np.ndarray:
    """Return the samples of a signal in which its zero is read, of the run or of a blank run."""
    if rule.file:
        of_file = blank(rule.file)
        if name not in of_file:
            raise ReadError(f"{rule.file}: the blank run holds no {name}", where=where)
        return of_file[name]
    if rule.samples:
        return columns[name][: rule.samples]
    first, last = np.searchsorted(time, [rule.start, rule.stop])
    return columns[name][first:last]
