"""What the columns of an unknown table hold: by their names and units, else by their numbers."""

from __future__ import annotations

import io
from typing import NamedTuple

import numpy as np
import pandas as pd

from tribolab.draft.header import converts, is_unit
from tribolab.draft.layout import Layout
from tribolab.draft.lvm import units_above
from tribolab.draft.model import (
    UNKNOWN_NAME,
    DraftColumn,
    Kind,
    Understood,
    other_units,
    time_unit,
)
from tribolab.draft.values import find_rate
from tribolab.draft.words import SURE, Match, is_axis, matches, split_unit
from tribolab.errors import ReadError, brief, shown
from tribolab.io.content.model import LARGEST
from tribolab.io.dialects.dates import seconds
from tribolab.io.dialects.headers import split_name, split_row
from tribolab.quantities import QUANTITIES, quantity

_SIGNALS = {
    "friction_force",
    "normal_force",
    "friction_coefficient",
    "sliding_velocity",
    "position",
    "shear_stress",
    "film_thickness",
}
# beside friction: which of several such columns is taken changes no coefficient of friction
_ASIDE = {"temperature", "ambient_pressure", "voltage", "height_displacement", "set_normal_force"}


def understand(layout: Layout) -> Understood:
    """Tell what the columns of a file hold.

    Parameters
    ----------
    layout
        From `tribolab.draft.layout.find_layout`.
    """
    numbers, text, missing = _numbers(layout)
    columns = _labelled(layout)
    guesses: list[str] = []
    if _say_something(columns):
        kind, columns = _by_name(columns, numbers)
    else:
        from tribolab.draft.behaviour import by_behaviour

        kind, columns, guesses = by_behaviour(columns, numbers)
    columns = _dated(columns, layout, numbers, text)
    columns = [
        column._replace(
            used=False,
            guessed=(),
            fill_in="",
            note=f"not a number: '{shown(text[column.place - 1])}'",
        )
        if text[column.place - 1] and not column.form
        else column
        for column in columns
    ]
    from tribolab.draft.clock import find_clock

    on_repeat, restart, columns = find_clock(layout, columns, numbers)
    used = [column.place - 1 for column in columns if column.used]
    words = tuple(dict.fromkeys(word for index in used for word in missing[index]))
    if kind != "table" and not [c for c in columns if c.used and (c.quantity != "time")]:
        # time alone is a run only if something can be filled in
        kind = "run" if any(c.quantity == "time" and c.used for c in columns) else "table"
    result = Understood(
        kind, tuple(columns), numbers, tuple(words), on_repeat, restart, tuple(guesses)
    )
    timed = any(column.used and column.quantity == "time" for column in columns)
    rate = None if timed or kind != "run" else find_rate(layout)
    if rate is None:
        return result
    return result._replace(rate_pattern=rate.pattern, rate_unit=rate.unit or "Hz")


def _dated(
    columns: list[DraftColumn], layout: Layout, numbers: np.ndarray, text: list[str]
) -> list[DraftColumn]:
    """Where no column of numbers is time, take the first of dates, and put its numbers in."""
    timed = [c for c in columns if c.quantity == "time" and c.used and not text[c.place - 1]]
    if timed or not any(text):
        return columns
    from tribolab.draft.dates import find_form

    rows = [split_row(line, layout.delimiter) for line in layout.rows()]
    for column in columns:
        index = column.place - 1
        if not text[index]:
            continue
        cells = [row[index] if index < len(row) else "" for row in rows]
        form, other = find_form(cells)
        if not form:
            continue
        numbers[:, index] = seconds(cells, form)
        dated = column._replace(
            quantity="time",
            unit=None,
            form=form,
            used=True,
            guessed=(f"dates are written {form}",) if other else (),
            options=(other,) if other else (),
            note="",
            fill_in="",
        )
        return [
            dated
            if c is column
            else c._replace(quantity=None, used=False)
            if c.quantity == "time"
            else c
            for c in columns
        ]
    return columns


def _numbers(layout: Layout) -> tuple[np.ndarray, list[str], list[list[str]]]:
    """Numbers of all rows; for each column a text that is no number, and its words for no value."""
    blank = layout.delimiter == "whitespace"
    try:
        frame = pd.read_csv(
            io.StringIO("\n".join(layout.rows())),
            sep=r"\s+" if blank else layout.delimiter,
            header=None,
            names=range(layout.width),
            decimal=layout.decimal,
            index_col=False,
            keep_default_na=False,
            na_values=[""],
            skipinitialspace=True,
            on_bad_lines="skip",
            low_memory=False,
        )
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise ReadError(
            f"{layout.file.path}: the table cannot be read: {brief(error, 100)}; is a quotation "
            "mark left open in it?"
        ) from error
    numbers = np.full(frame.shape, np.nan)
    text = [""] * layout.width
    missing: list[list[str]] = [[] for _ in range(layout.width)]
    understood = np.array([dtype.kind in "fiu" for dtype in frame.dtypes], dtype=bool)
    numbers[:, understood] = frame.loc[:, understood].to_numpy(dtype=float)
    for index in np.flatnonzero(~understood).tolist():
        column = frame[index]
        values = pd.to_numeric(column, errors="coerce")
        numbers[:, index] = values.to_numpy(dtype=float)
        odd = column[values.isna() & column.notna()].astype(str).str.strip()
        odd = odd[~odd.str.lower().isin(["nan", ""])]
        if len(odd) > 0.5 * column.notna().sum():
            text[index] = odd.iloc[0][:30]
        else:
            missing[index] = odd.unique()[:10].tolist()
    numbers[np.abs(numbers) > LARGEST] = np.nan
    return numbers, text, missing


def _labelled(layout: Layout) -> list[DraftColumn]:
    """Columns with their names and units as the header says them."""
    heading = layout.heading
    cells = list(heading.cells if heading else ())[: layout.width]
    cells += [""] * (layout.width - len(cells))
    row = list(heading.unit_cells if heading else ()) + [""] * layout.width
    columns: list[DraftColumn] = []
    above = units_above(layout)
    seen: dict[str, int] = {}
    for place, cell in enumerate(cells, start=1):
        name, unit = split_name(cell)
        if unit is not None and not is_unit(unit):
            unit = None  # brackets around something else
        if heading and heading.units is not None:
            name, unit = cell, row[place - 1].strip("[]() ") or None
        seen[name] = seen.get(name, 0) + 1
        known = name if name and heading and heading.aligned else None
        columns.append(
            DraftColumn(
                place,
                cell,
                known,
                seen[name] if known else 1,
                file_unit=unit,
                unit=above.get(place) if unit is None else None,
            )
        )
    return columns


def _bare(column: DraftColumn) -> tuple[str, str | None, bool]:
    """Name without its unit, the unit, and whether the dialect has to say it."""
    name = split_name(column.label)[0] if column.name is None else column.name
    if column.unit is not None:
        return name, column.unit, True
    if column.file_unit is not None:
        return name, column.file_unit, column.name is None
    name, unit = split_unit(name)
    return name, unit, unit is not None


def _say_something(columns: list[DraftColumn]) -> bool:
    """Whether the header says more than 'Channel 1, Channel 2'."""
    bare = [_bare(column)[:2] for column in columns if column.label]
    return any(unit is not None or matches(name, unit) for name, unit in bare)


def _by_name(columns: list[DraftColumn], numbers: np.ndarray) -> tuple[Kind, list[DraftColumn]]:
    bare = [_bare(column) for column in columns]
    run = [matches(name, unit) for name, unit, _ in bare]
    scan = [matches(name, unit, scan=True) for name, unit, _ in bare]
    best = {options[0].quantity for options in run if options}
    profile = {options[0].quantity for options in scan if options}
    if not best & {"time", "friction_force", "normal_force", "sliding_velocity"} and (
        {"x", "height"} <= profile
    ):
        return "scan", _assigned(columns, bare, scan, numbers, "scan")
    kind: Kind = "run" if best & ({"time"} | _SIGNALS) else "table"
    return kind, _assigned(columns, bare, run, numbers, kind)


class _Proposal(NamedTuple):
    """A column for a quantity; of several the one of the highest rank is taken."""

    rank: tuple[float, bool, int]
    place: int
    option: Match


def _assigned(
    columns: list[DraftColumn],
    bare: list[tuple[str, str | None, bool]],
    matched: list[list[Match]],
    numbers: np.ndarray,
    kind: Kind,
) -> list[DraftColumn]:
    """Give each quantity to the column whose name fits best."""
    matched = _without_axes(bare, matched)
    has_units = any(unit is not None for _, unit, _ in bare)
    filled = np.isfinite(numbers).any(axis=0)
    proposals: dict[str, list[_Proposal]] = {}
    for index, options in enumerate(matched):
        option = _preferred(options, bare[index][1], numbers[:, index], has_units)
        if option:
            # of names used twice the later counts: exporters repeat first what was plotted
            rank = (option.score, bool(filled[index]), index)
            proposals.setdefault(option.quantity, []).append(_Proposal(rank, index, option))
    _give_way(proposals, matched)
    result = list(columns)
    for index, column in enumerate(columns):
        if not column.label:
            continue
        unit = bare[index][1]
        if unit is not None and not matched[index]:
            same = [q for q in _SIGNALS if _told_by(unit, quantity(q).unit)]
            hint = f"its unit fits {' or '.join(sorted(same))}" if same else ""
            result[index] = column._replace(note=hint or UNKNOWN_NAME)
        elif not matched[index]:
            result[index] = column._replace(note=UNKNOWN_NAME)
    for name, rivals in proposals.items():
        best = max(rivals)
        names = [f"column {place + 1}" for place in sorted(r.place for r in rivals)]
        for _, index, option in rivals:
            if index == best.place:
                second = sorted(rivals)[-2] if len(rivals) > 1 else None
                several = second is not None and second.rank[0] > best.rank[0] - 0.05
                others = [o.quantity for o in matched[index] if o.quantity != name]
                column = _column(
                    columns[index], bare[index], option, numbers[:, index], kind, several
                )
                if several:
                    own = f"column {index + 1}"
                    column = column._replace(
                        options=(*column.options, *(n for n in names if n != own))
                    )
                if option.score < SURE:
                    column = column._replace(options=(*column.options, *others, "not used"))
                result[index] = column
            else:
                note = f"also looks like {name}; column {best.place + 1} is used"
                result[index] = columns[index]._replace(quantity=name, note=note)
    return result


def _give_way(proposals: dict[str, list[_Proposal]], matched: list[list[Match]]) -> None:
    """Let a vague name mean what nothing else is called, where a better one has its quantity."""
    for rivals in list(proposals.values()):
        best = max(rivals)
        for rival in [r for r in rivals if r is not best and r.option.score < SURE]:
            others = [o for o in matched[rival.place] if o.score >= rival.option.score - 0.05]
            free = [o for o in others if o.quantity not in proposals]
            if free and best.option.score >= SURE:
                rivals.remove(rival)
                proposals[free[0].quantity] = [rival._replace(option=free[0])]


def _without_axes(
    bare: list[tuple[str, str | None, bool]], matched: list[list[Match]]
) -> list[list[Match]]:
    """Where something turns, the axes of the machine's stage are no sliding position."""
    if not any(options and options[0].quantity == "rotation_speed" for options in matched):
        return matched
    return [
        [option for option in options if option.quantity != "position"]
        if is_axis(name) and options and options[0].quantity == "position"
        else options
        for (name, _, _), options in zip(bare, matched, strict=True)
    ]


def _told_by(unit: str, si_unit: str) -> bool:
    """Whether a unit tells something of the quantity: a number without a unit may be anything."""
    return si_unit != "1" and converts(unit, si_unit)


def _preferred(
    options: list[Match], unit: str | None, values: np.ndarray, has_units: bool
) -> Match | None:
    """Of several quantities that a name may stand for, the one that suits unit and numbers."""
    if not options or unit is not None:
        return options[0] if options else None
    top = [option for option in options if option.score > options[0].score - 0.05]
    if len(top) > 1:
        ratio = next((o for o in top if QUANTITIES[o.quantity].unit == "1"), None)
        sizes = np.abs(values[np.isfinite(values)])
        if ratio and (has_units or (sizes.size and np.median(sizes) < 2)):
            return ratio
        steps = np.diff(values)
        if top[0].quantity == "time" and not (steps >= 0).all():
            return top[1]
    return options[0]


def _column(
    column: DraftColumn,
    bare: tuple[str, str | None, bool],
    option: Match,
    values: np.ndarray,
    kind: Kind,
    several: bool,
) -> DraftColumn:
    """Fill in a column that holds a quantity."""
    _, unit, say_unit = bare
    si_unit = quantity(option.quantity).unit
    guessed = []
    options: tuple[str, ...] = ()
    if option.score < SURE:
        guessed.append(f"the name means {quantity(option.quantity).long_name}")
    if several and option.quantity not in _ASIDE:
        guessed.append(f"of several columns for {option.quantity} it is the one meant")
    written = unit if say_unit else None
    if option.unit:
        written = option.unit
        guessed.append(f"'{shown(unit)}' means {option.unit}")
    fill_in = ""
    if unit is None and si_unit not in ("", "1"):
        if option.quantity == "time":
            written = time_unit(values)
            guessed.append(f"time is in {written}")
            options = other_units("s", written)
        elif kind == "scan":
            written = "mm" if option.quantity in ("x", "y") else "um"
            guessed.append(f"{option.quantity} is in {written}")
            options = other_units("m", written)
        else:
            fill_in = f"the unit of '{shown(column.label)}' ({option.quantity}), e.g. \"{si_unit}\""
            options = other_units(si_unit)
    finite = values[np.isfinite(values)]
    sign = 1
    if option.quantity == "normal_force" and finite.size and finite.max() <= 0 > finite.min():
        sign = -1
        guessed.append("the normal force is counted negative")
        options = (*options, "counted positive")
    used, note = not fill_in, ""
    if option.quantity == "position" and finite.size > 2 and np.ptp(finite) == 0:
        used, note, fill_in = False, "it stands still", ""
    return column._replace(
        quantity=option.quantity,
        unit=written,
        sign=sign,
        optional=not finite.size and option.quantity != "time",
        used=used and (bool(finite.size) or option.quantity != "time"),
        guessed=tuple(guessed),
        options=options,
        note=note or ("" if finite.size else "no value in this file"),
        fill_in=fill_in,
    )


def first_cells_of(layout: Layout, number: int) -> list[list[str]]:
    """Cells of the first rows as they stand in the file."""
    return [split_row(line, layout.delimiter) for line in layout.rows()[:number]]
