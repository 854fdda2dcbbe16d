"""Two moving surfaces (ball and disc, two rollers), which slide at their speed difference."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.lexicon.lexicon import normalise_label, pairs_of_bodies, part_pattern, role_of
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.reciprocals import reciprocal
from tribolab.units.spellings import plain_unit

_SURFACE = "the speed of one of two surfaces"
_SPEEDS = {"rotation_speed": "Hz", "sliding_velocity": "m/s"}
_REST = 0.1  # of the largest slip speed; below it, the surfaces do not slide
_NUMBERED = (re.compile("1$"), re.compile("2$"))


class Pair(NamedTuple):
    """Speed columns of two surfaces (rotation speeds if `turns`), and patterns of their names."""

    columns: tuple[DraftColumn, DraftColumn]
    turns: bool
    opposed: bool
    bodies: tuple[re.Pattern[str], re.Pattern[str]]


def find_surface_speeds(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> Pair | None:
    """Return the two surface speed columns, if their names identify the two bodies; else None."""
    speeds = [(column, _speed_of(column)) for column in columns]
    for quantity in _SPEEDS:
        mine = [column for column, held in speeds if held == quantity]
        for bodies in (*pairs_of_bodies(), *((_NUMBERED,) if len(mine) == 2 else ())):
            pairs = [(a, b) for a in mine for b in mine if a is not b and _are(bodies, a, b)]
            if len(pairs) == 1:
                first, second = (numbers[:, c.place - 1] for c in pairs[0])
                both = first * second
                opposed = bool((both < 0).sum() > 0.5 * np.isfinite(both).sum())
                return Pair(pairs[0], quantity == "rotation_speed", opposed, bodies)
    return None


def numbered_in_doubt(layout: Layout, pair: Pair | None) -> list[str]:
    """Ask whether numbered speeds belong to two surfaces, unless the text mentions two bodies."""
    twin = part_pattern("two_bodies")
    said = any(twin.search(normalise_label(text)) for text in layout.named_sentences)
    if pair is None or pair.bodies is not _NUMBERED or said:
        return []
    one, other = (shown(column.label, 30) for column in pair.columns)
    what = "the speeds of two surfaces, which slide at the difference (or one speed, twice)"
    return [f"'{one}' and '{other}' are {what}"]


def _are(bodies: tuple[re.Pattern[str], re.Pattern[str]], a: DraftColumn, b: DraftColumn) -> bool:
    names = [normalise_label(bare_name(column)[0]) for column in (a, b)]
    own = [pattern.search(name) for pattern, name in zip(bodies, names, strict=True)]
    other = [pattern.search(name) for pattern, name in zip(bodies[::-1], names, strict=True)]
    return all(own) and not any(other)


def _speed_of(column: DraftColumn) -> str:
    """Return the kind of speed that a column is by name and unit; "" if none or a set-point."""
    name, unit, _ = bare_name(column)
    if not column.label or role_of(name) in ("set", "extreme"):
        return ""
    unit = column.unit or unit
    options = [match.quantity for match in matches(name, unit)]
    if unit is None or (options and not set(options) & set(_SPEEDS)):
        return ""
    return next((held for held, si in _SPEEDS.items() if converts(unit, si)), "")


def exclude_surface_speeds(columns: Sequence[DraftColumn], pair: Pair | None) -> list[DraftColumn]:
    """Return all columns, with those of surface speeds marked as not the sliding speed."""
    places = {column.place for column in pair.columns} if pair is not None else set()
    return [c.unused(_SURFACE, quantity=None) if c.place in places else c for c in columns]


def radii_of_surfaces(pair: Pair, values: Sequence[Amount]) -> tuple[Amount, ...]:
    """Return the stated radii of two bodies, or the only stated radius for both."""
    sizes = [v._replace(to="m") for v in values if v.unit and converts(v.unit, "m")]
    sizes = [
        v._replace(scale=0.5) if v.means("diameter") else v
        for v in sizes
        if v.means("diameter", "track_radius")
    ]
    found = [
        [v for v in sizes if own.search(v.key) and not other.search(v.key)]
        for own, other in (pair.bodies, pair.bodies[::-1])
    ]
    if all(len(of_body) == 1 for of_body in found):
        return tuple(v[0]._replace(name=f"radius_{n}") for n, v in enumerate(found, 1))
    if len(sizes) == 1 and not any(found):
        return (sizes[0]._replace(name="radius_1"),)
    return ()


def second_is_faster(
    pair: Pair, radii: Sequence[Amount], numbers: np.ndarray, friction: DraftColumn | None
) -> bool:
    """Whether the friction is positive while the second surface is faster than the first.

    The first value is taken as the zero of the friction only if nothing slides then. File: a
    twin-disc rig, whose record starts during the test.
    """
    if friction is None:
        return False
    first, second = (np.abs(numbers[:, column.place - 1]) for column in pair.columns)
    sizes = [value.number * value.scale for value in radii]
    one, other = sizes if len(sizes) == 2 else (1.0, 1.0)
    slip, signal = one * first - other * second, numbers[:, friction.place - 1]
    known = np.isfinite(slip * signal)
    slip, signal = slip[known], signal[known]
    rests = slip.size and abs(slip[0]) < _REST * np.abs(slip).max()
    return bool((slip * (signal - signal[0] if rests else signal)).sum() < 0)


def speed_symbol(column: DraftColumn, name: str) -> tuple[DraftColumn, str]:
    """Return the speed column that a formula uses, and the term that stands for it there.

    Rotation in cycles is multiplied by 2 pi, as formulas need radians.
    """
    _, unit, say = bare_name(column)
    counted = reciprocal(plain_unit(unit or ""))
    in_cycles = counted is not None and counted.counts != "radians"
    symbol = f"2 * pi * {name}" if in_cycles else name
    return column._replace(unit=unit if say else None, used=True), symbol
