"""Quantities of the columns of an unknown table: from names and units, else from numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.cells import Cells, read_cells, take_dates
from tribolab.reading.unknown.columns.clock import are_points, find_clock, in_seconds, summed
from tribolab.reading.unknown.columns.friction_signal import (
    against_motion,
    disagreement,
    force_or_ratio,
)
from tribolab.reading.unknown.columns.labels import (
    as_heights,
    bare_name,
    in_stated_unit,
    labelled,
    side_by_side,
)
from tribolab.reading.unknown.columns.names import decide_by_name, has_meaning
from tribolab.reading.unknown.columns.proven import (
    add_proven_units,
    add_unit_of_load,
    add_unit_of_stroke,
    proven,
)
from tribolab.reading.unknown.columns.rotating_parts import angle_of, torque_of
from tribolab.reading.unknown.columns.unit_and_sign import FORCES
from tribolab.reading.unknown.derivations.inclined_contact import guesses_of_inclined
from tribolab.reading.unknown.derivations.known_amounts import loads_that_add
from tribolab.reading.unknown.derivations.stated_lines import find_gain, take_stated_missing
from tribolab.reading.unknown.derivations.two_bodies import (
    exclude_surface_speeds,
    find_surface_speeds,
    numbered_in_doubt,
)
from tribolab.reading.unknown.header.factors import unapplied_factors, unapplied_height_factors
from tribolab.reading.unknown.header.profiles import (
    find_height_unit,
    find_pitch,
    find_profile_length,
    find_unit_along,
)
from tribolab.reading.unknown.header.run_amounts import (
    as_entrainment_speed,
    confirm_lever_arm_force,
    find_load,
)
from tribolab.reading.unknown.header.sampling import find_pace, find_sampling
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.header.stroke_settings import find_stroke_length
from tribolab.reading.unknown.header.zero import load_zeros_in_doubt, unloaded_start_in_doubt
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Kind, Reason, Understood

_MIN_NUMBERED = 24  # least columns of a map; fewer may be the channels of a logger
_REACH = 0.05  # of the length of a scan; heights with a larger range are in a smaller unit


class _Spacing(NamedTuple):
    """Pitch or length of a profile as stated above its table."""

    pitch: Amount | None
    length: Amount | None

    @property
    def is_stated(self) -> bool:
        """Whether the positions of heights follow from a stated pitch or length."""
        return self.pitch is not None or self.length is not None


class _Interpretation(NamedTuple):
    """Kind of a file, its columns, and guesses about them."""

    kind: Kind
    columns: list[DraftColumn]
    guesses: Sequence[str] = ()
    pitched: bool = False  # heights have a pitch instead of positions


def understand(layout: Layout) -> Understood:
    """Return the interpretation of the table of a file."""
    cells = read_cells(layout)
    spacing = _stated_spacing(layout)
    found = _interpret(layout, cells, spacing)
    guesses = [*unapplied_factors(layout), *found.guesses]
    columns = found.columns
    if found.kind == "run":
        columns, doubts = _combined_forces(layout, columns, cells.numbers)
        guesses += doubts
    columns = _without_words(take_dates(columns, layout, cells), cells)
    found = found._replace(columns=columns, guesses=guesses)
    if found.kind == "run":
        return _of_run(layout, cells, found)
    return _of_other(layout, cells, spacing, found)


def _stated_spacing(layout: Layout) -> _Spacing:
    pitch = find_pitch(layout)
    return _Spacing(pitch, None if pitch is not None else find_profile_length(layout))


def _interpret(layout: Layout, cells: Cells, spacing: _Spacing) -> _Interpretation:
    """Return the kind of a table and its columns, by stated settings, names, or else numbers."""
    numbers, unit = cells.numbers, find_height_unit(layout)
    along = find_unit_along(layout)
    columns = in_stated_unit(labelled(layout), unit, along)
    proofs = proven(columns, numbers)
    columns = add_proven_units(columns, proofs)
    stated = numeric_settings(layout)
    columns = add_unit_of_load(columns, numbers, find_load(stated))
    columns = add_unit_of_stroke(columns, numbers, find_stroke_length(stated))
    profile = _profile_of(layout, columns, numbers, spacing, stated=bool(unit))
    if profile is not None:
        return profile
    if _numbers_its_points(columns, numbers):
        return _Interpretation("table", columns)
    if has_meaning(columns):
        kind, columns = decide_by_name(layout, columns, numbers, proofs, placed=spacing.is_stated)
        if kind == "table" and find_gain(layout, columns, "friction_force") is not None:
            kind = "run"  # volts with a stated gain
        return _Interpretation(kind, columns, pitched=spacing.is_stated)
    # imported late for a quick start
    from tribolab.reading.unknown.columns.behaviour import by_behaviour

    kind, columns, guesses = by_behaviour(columns, numbers, (along, unit))
    return _Interpretation(kind, columns, guesses, pitched=spacing.is_stated)


def _numbers_its_points(columns: Sequence[DraftColumn], numbers: np.ndarray) -> bool:
    """Whether rows and columns are numbered like those of a map."""
    if len(columns) <= _MIN_NUMBERED:
        return False
    # imported late for a quick start
    from tribolab.reading.scans.formats.matrix import are_numbered

    counted = bool((np.diff(numbers[:, 0]) == 1).all())
    return counted and are_numbered([column.label for column in columns[1:]])


def _profile_of(
    layout: Layout,
    columns: list[DraftColumn],
    numbers: np.ndarray,
    spacing: _Spacing,
    *,
    stated: bool,
) -> _Interpretation | None:
    """Return the columns as profiles if they are only heights with a stated pitch, else None."""
    alone = layout.width == 1 and _may_be_heights(columns[0])
    if spacing.is_stated and (alone or side_by_side(columns)):
        likely = _likely_unit(numbers, spacing.pitch)
        columns = [as_heights(column, stated=stated, unit=likely) for column in columns]
        return _Interpretation("scan", columns, pitched=True)
    return None


def _combined_forces(
    layout: Layout, columns: list[DraftColumn], numbers: np.ndarray
) -> tuple[list[DraftColumn], list[str]]:
    """Return the columns after comparing forces and speeds with each other, and the doubts."""
    columns = force_or_ratio(columns)
    pair = find_surface_speeds(layout, columns, numbers)
    columns = exclude_surface_speeds(columns, pair)
    columns = confirm_lever_arm_force(layout, columns)
    columns = as_entrainment_speed(layout, columns)
    doubts = disagreement(columns, numbers) + guesses_of_inclined(layout, columns)
    doubts += numbered_in_doubt(layout, pair)
    return columns, doubts + load_zeros_in_doubt(layout, columns)


def _without_words(columns: list[DraftColumn], cells: Cells) -> list[DraftColumn]:
    """Mark columns of words as not used."""
    return [
        column.unused(Reason.TEXT.value.format(shown(text)), reason=Reason.TEXT)
        if (text := cells.text[column.place - 1]) and not column.form
        else column
        for column in columns
    ]


def _of_run(layout: Layout, cells: Cells, found: _Interpretation) -> Understood:
    """Return the interpretation of a run with its clock or sampling rate."""
    numbers = cells.numbers
    columns = _without_counter(layout, found.columns, numbers)
    period = summed(columns, numbers)
    columns = in_seconds(columns, numbers)
    columns = against_motion(columns, numbers)
    result = _clocked(layout, cells, found._replace(columns=columns))._replace(period=period)
    doubts = unloaded_start_in_doubt(layout, result.columns)
    result = result._replace(guesses=(*result.guesses, *doubts))
    if result.kind == "run" and are_points(result.columns, numbers):
        return result._replace(points=True)
    return _sampled(layout, result) if result.kind == "run" else result


def _of_other(
    layout: Layout, cells: Cells, spacing: _Spacing, found: _Interpretation
) -> Understood:
    """Return the interpretation of a scan, or of a table that is neither scan nor run."""
    numbers = cells.numbers
    period = summed(found.columns, numbers)
    result = _clocked(layout, cells, found)._replace(period=period)
    columns = list(result.columns)
    if found.kind == "scan":
        heights = [c.place - 1 for c in columns if c.used and c.quantity == "height"]
        factors = unapplied_height_factors(layout, numbers[:, heights], columns)
        known = " ".join(result.guesses)
        guesses = (*result.guesses, *(said for said in factors if said[-45:] not in known))
        marks = take_stated_missing(layout, columns, numbers)
        words = tuple(dict.fromkeys([*marks, *result.missing]))
        result = result._replace(guesses=guesses, missing=words)
    if (
        found.kind != "scan"
        or not found.pitched
        or any(c.used and c.quantity == "x" for c in columns)
    ):
        return _sampled(layout, result) if result.kind == "run" else result
    pitch, length = spacing.pitch, spacing.length
    doubt = [length.guess] if length is not None and length.guess else []
    return result._replace(
        kind="scan",
        on_repeat="",
        restart=False,
        period=False,
        guesses=(*result.guesses, *doubt),
        pitch_pattern=pitch.pattern if pitch is not None else "",
        length_pattern=length.pattern if length is not None else "",
    )


def _clocked(layout: Layout, cells: Cells, found: _Interpretation) -> Understood:
    """Return the interpretation with the settings of the clock."""
    on_repeat, restart, columns = find_clock(layout, found.columns, cells.numbers)
    return Understood(
        _kind_by_columns(found.kind, layout, columns),
        tuple(columns),
        cells.numbers,
        _missing_words(cells, columns),
        on_repeat,
        restart,
        tuple(found.guesses),
    )


def _missing_words(cells: Cells, columns: Sequence[DraftColumn]) -> tuple[str, ...]:
    """Return the words that stand for missing values in the columns that are read."""
    used = (cells.missing[column.place - 1] for column in columns if column.used)
    return tuple(dict.fromkeys(word for words in used for word in words))


def _kind_by_columns(kind: Kind, layout: Layout, columns: list[DraftColumn]) -> Kind:
    """Return the kind of a file; a run without signals is a table, unless a force follows."""
    if kind == "table" or any(c.used and c.quantity != "time" for c in columns):
        return kind
    if any(c.fill_in and c.quantity in FORCES for c in columns):  # the user is asked for the unit
        return kind
    timed = any(c.quantity == "time" and c.used for c in columns)
    made = torque_of(columns) is not None or angle_of(columns) is not None
    made = made or find_gain(layout, columns, "friction_force") is not None
    return "run" if timed or made or loads_that_add(columns) else "table"


def _sampled(layout: Layout, result: Understood) -> Understood:
    """Add the stated sampling rate, or speed of a position, to a run without a clock."""
    columns = list(result.columns)
    if any(column.used and column.quantity == "time" for column in columns):
        return result
    sampling = find_sampling(layout)
    if sampling is None:
        sampling = find_pace(layout, columns, result.numbers)
        result = result._replace(restart=sampling is not None and len(layout.blocks) > 1)
    if sampling is None:
        return result
    return result._replace(
        rate_pattern=sampling.pattern,
        rate_unit=sampling.unit,
        guesses=(*result.guesses, *([sampling.guess] if sampling.guess else [])),
    )


def _without_counter(
    layout: Layout, columns: list[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Ignore a row counter as the clock if the text states the sampling rate."""
    clock = next((c for c in columns if c.used and c.quantity == "time"), None)
    if clock is None or not clock.guessed or clock.file_unit is not None:
        return columns
    sampling = find_sampling(layout)
    if sampling is None or sampling.guess or (np.diff(numbers[:, clock.place - 1]) != 1).any():
        return columns
    note = "it counts the rows, whose rate the text states"
    other = clock.unused(note, quantity=None, unit=None)
    return [other if column is clock else column for column in columns]


def _may_be_heights(column: DraftColumn) -> bool:
    """Whether the only column of a table may be heights, by its name and unit."""
    name, unit, _ = bare_name(column)
    if unit is None:
        return not matches(name, None)
    scan = matches(name, unit, scan=True)
    height = not scan or scan[0].quantity == "height"
    return converts(unit, "m") and height and not matches(name, unit)


def _likely_unit(numbers: np.ndarray, pitch: Amount | None) -> str:
    """Return the likely unit of heights: um, or nm if um would be too large for the scan."""
    step = pitch.si("m") if pitch is not None else 0.0
    reach = float(np.nanmax(numbers) - np.nanmin(numbers)) if np.isfinite(numbers).any() else 0.0
    return "nm" if 0 < step * len(numbers) * _REACH < 1e-6 * reach else "um"
