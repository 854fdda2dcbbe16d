"""What the columns of an unknown table hold: by their names and units, else by their numbers."""

from __future__ import annotations

import io

import numpy as np

from tribolab.draft.columns.against_motion import against_motion
from tribolab.draft.columns.decide import SIGNALS, decide
from tribolab.draft.columns.epochs import counted_from
from tribolab.draft.columns.evidence import RULES, Facts
from tribolab.draft.columns.fill_in import Bare
from tribolab.draft.columns.heights import (
    as_heights,
    beside_x,
    heights_by_clock,
    in_stated_unit,
    side_by_side,
)
from tribolab.draft.columns.labels import bare_name, labelled
from tribolab.draft.columns.plain_numbers import plain_numbers
from tribolab.draft.columns.proven import add_proven_units, proven, restrict_to_proofs
from tribolab.draft.columns.ratio import disagreement, force_or_ratio
from tribolab.draft.columns.results_table import are_points
from tribolab.draft.columns.text_evidence import by_legend, by_mean, by_stated_load
from tribolab.draft.columns.turning import angle_of, torque_of
from tribolab.draft.columns.unloaded import with_zero
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.calibrations import find_calibrations
from tribolab.draft.follows.inclined import guesses_of_inclined
from tribolab.draft.follows.sensor import of_sensor
from tribolab.draft.follows.stated_missing import take_stated_missing
from tribolab.draft.follows.sums import adding_up, loads_that_add
from tribolab.draft.follows.surfaces import exclude_surface_speeds, find_surface_speeds
from tribolab.draft.model import NO_NUMBERS, DraftColumn, Kind, Understood
from tribolab.draft.stated.columns_from_settings import columns_from_settings
from tribolab.draft.stated.counts import apply_count_scale
from tribolab.draft.stated.factors import unapplied_factors, unapplied_height_factors
from tribolab.draft.stated.lengths import confirm_lever_arm_force
from tribolab.draft.stated.profiles import (
    find_height_unit,
    find_pitch,
    find_point_density,
    find_profile_length,
    find_unit_along,
    pitch_of_clock,
)
from tribolab.draft.stated.sampling import find_pace, find_sampling
from tribolab.draft.stated.slip import as_entrainment_speed
from tribolab.draft.stated.stated_zero import load_zeros_in_doubt
from tribolab.errors import ReadError, brief, shown
from tribolab.io.dialects.cells import split_row
from tribolab.io.dialects.dates import seconds
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import Match, is_date, matches
from tribolab.reading.interpret.physics import Proof
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.raw.missing_marks import LARGEST, take_marks
from tribolab.units import conversion, positive

_RISES = 0.9  # share of the steps from row to row; a clock may start anew
_BY_UNIT = 0.6  # score of a name that says nothing beside a unit that does
_PURE = ("1", "-")  # what stands for the unit of a pure number
_REACH = 0.05  # of a scan's length; heights that reach farther are in a smaller unit


def understand(layout: Layout) -> Understood:
    """Tell what the columns of a file hold.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    numbers, text, missing = _numbers(layout)
    unit = find_height_unit(layout)
    along = find_unit_along(layout)
    columns = in_stated_unit(labelled(layout), unit, along)
    proofs = proven(columns, numbers)
    columns = add_proven_units(columns, proofs)
    pitch = find_pitch(layout)
    density = "" if pitch is not None else find_point_density(layout)
    length = None if pitch is not None or density else find_profile_length(layout)
    apart = pitch is not None or bool(density) or length is not None
    guesses = unapplied_factors(layout)
    lacks = ""
    kind: Kind
    if apart and (layout.width == 1 and _may_be_heights(columns[0]) or side_by_side(columns)):
        likely = _likely_unit(layout, numbers, pitch, density)
        kind = "scan"
        columns = [as_heights(column, stated=bool(unit), unit=likely) for column in columns]
    elif (beside := beside_x(columns)) is not None:
        kind, columns = "scan", beside
    elif (taken := heights_by_clock(columns)) is not None and (
        density := pitch_of_clock(layout, _seconds(taken[0], numbers))
    ):
        kind, columns, apart = "scan", taken, True
    elif not apart and (sensed := of_sensor(layout, columns, numbers)) is not None:
        kind, columns, density, lacks = "scan", sensed.columns, sensed.pitch, sensed.lacks
        apart = bool(density or lacks)
    elif _say_something(columns):
        kind, columns = _by_name(layout, columns, numbers, proofs, placed=apart)
    else:
        # late: starting stays quick
        from tribolab.draft.columns.behaviour import by_behaviour

        kind, columns, behaving = by_behaviour(columns, numbers, (along, unit))
        guesses += behaving
    if kind == "run":
        columns = force_or_ratio(columns)
        columns = exclude_surface_speeds(columns, find_surface_speeds(layout, columns, numbers))
        columns = confirm_lever_arm_force(layout, columns)
        columns = adding_up(layout, columns, numbers)
        columns = as_entrainment_speed(layout, columns)
        guesses += disagreement(columns, numbers)
        guesses += guesses_of_inclined(layout, columns) + load_zeros_in_doubt(layout, columns)
    columns = _dated(apply_count_scale(layout, columns, numbers), layout, numbers, text)
    columns = [
        column._replace(
            used=False,
            guessed=(),
            fill_in="",
            note=f"{NO_NUMBERS}'{shown(text[column.place - 1])}'",
        )
        if text[column.place - 1] and not column.form
        else column
        for column in columns
    ]
    # late: starting stays quick
    from tribolab.draft.columns.clock import find_clock, summed

    if kind == "run":  # what a force is reckoned with is not left out
        spoken_for = [
            shown(made.text, 40) for made in find_calibrations(layout, columns) if made.text
        ]
        guesses = [said for said in guesses if not any(text in said for text in spoken_for)]
    columns = _without_counter(layout, columns, numbers) if kind == "run" else columns
    period = summed(columns, numbers)
    if kind == "run":
        columns = against_motion(columns_from_settings(layout, columns, numbers), numbers)
    on_repeat, restart, columns = find_clock(layout, columns, numbers)
    columns = with_zero(layout, columns, numbers) if kind == "run" else columns
    used = [column.place - 1 for column in columns if column.used]
    if kind == "scan":
        heights = [c.place - 1 for c in columns if c.used and c.quantity == "height"]
        factors = unapplied_height_factors(layout, numbers[:, heights], columns)
        guesses += [said for said in factors if said[-45:] not in " ".join(guesses)]
    said = take_stated_missing(layout, columns, numbers) if kind == "scan" else []
    words = tuple(dict.fromkeys([*said, *(word for index in used for word in missing[index])]))
    placed = any(c.used and c.quantity == "x" for c in columns)
    if kind == "scan" and apart and not placed:
        guesses += [length.guess] if length is not None and length.guess else []
        return Understood(
            kind,
            tuple(columns),
            numbers,
            tuple(words),
            "",
            False,
            tuple(guesses),
            pitch_pattern=pitch.pattern if pitch is not None else "",
            length_pattern=length.pattern if length is not None else "",
            pitch=density,
            lacks=lacks,
        )
    if kind != "table" and not [c for c in columns if c.used and (c.quantity != "time")]:
        # time alone is a run only if something can be filled in
        timed = any(c.quantity == "time" and c.used for c in columns)
        made = torque_of(columns) is not None or angle_of(columns) is not None
        made = made or bool(find_calibrations(layout, columns))
        kind = "run" if timed or made or loads_that_add(columns) else "table"
    result = Understood(
        kind, tuple(columns), numbers, tuple(words), on_repeat, restart, tuple(guesses), period
    )
    if kind == "run" and are_points(columns, numbers):
        return result._replace(points=True)
    timed = any(column.used and column.quantity == "time" for column in columns)
    sampling = None if timed or kind != "run" else find_sampling(layout)
    if sampling is None and not timed and kind == "run":
        sampling = find_pace(layout, columns, numbers)
        result = result._replace(restart=sampling is not None and len(layout.blocks) > 1)
    if sampling is None:
        return result
    guesses += [sampling.guess] if sampling.guess else []
    return result._replace(
        rate_pattern=sampling.pattern, rate_unit=sampling.unit, guesses=tuple(guesses)
    )


def _without_counter(
    layout: Layout, columns: list[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Take no count of the rows for a clock where the text states how often they come."""
    clock = next((c for c in columns if c.used and c.quantity == "time"), None)
    if clock is None or not clock.guessed or clock.file_unit is not None:
        return columns
    sampling = find_sampling(layout)
    if sampling is None or sampling.guess or (np.diff(numbers[:, clock.place - 1]) != 1).any():
        return columns
    note = "it counts the rows, whose rate the text states"
    other = clock._replace(quantity=None, unit=None, used=False, guessed=(), options=(), note=note)
    return [other if column is clock else column for column in columns]


def _dated(
    columns: list[DraftColumn], layout: Layout, numbers: np.ndarray, text: list[str]
) -> list[DraftColumn]:
    """Where no column of numbers is time, take the first of dates, and put its numbers in."""
    timed = [c for c in columns if c.quantity == "time" and c.used and not text[c.place - 1]]
    if timed or not any(text):
        return columns
    # late: starting stays quick
    from tribolab.draft.columns.dates import find_form

    rows = [split_row(line, layout.delimiter) for line in layout.rows()]
    found = []
    for column in columns:
        index = column.place - 1
        cells = [row[index] if index < len(row) else "" for row in rows] if text[index] else []
        form, other = find_form(cells)
        if form and len(cells) == len(numbers):  # a damaged row is split in two ways
            found.append((column, seconds(cells, form), form, other))
    if not found:
        return columns
    # a date beside a time of day stays the same for the whole day
    column, moments, form, other = next((one for one in found if np.ptp(one[1]) > 0), found[0])
    numbers[:, column.place - 1] = moments
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


def _numbers(layout: Layout) -> tuple[np.ndarray, list[str], list[list[str]]]:
    """Numbers of all rows; for each column a text that is no number, and its words for no value."""
    plain = plain_numbers(layout)
    if plain is not None:
        return _measured(plain), [""] * layout.width, [[] for _ in range(layout.width)]
    # late: takes longer to load than a plain table to read
    import pandas as pd

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
        pointed = column.astype(str).str.replace(",", ".") if layout.decimal == "," else column
        try:
            known = pd.to_numeric(pointed, errors="coerce")
        except OverflowError:  # whole numbers of hundreds of digits
            known = pd.to_numeric(pointed.astype(str), errors="coerce")
        numbers[:, index] = known.to_numpy(dtype=float)
        odd = column[known.isna() & column.notna()].astype(str).str.strip()
        odd = odd[~odd.str.lower().isin(["nan", ""])]
        if len(odd) > 0.5 * column.notna().sum():
            text[index] = odd.iloc[0][:30]
        else:
            missing[index] = odd.unique()[:10].tolist()
    return _measured(numbers), text, missing


def _measured(numbers: np.ndarray) -> np.ndarray:
    """Return numbers without those that stand for no value, as the reader leaves them out."""
    numbers[np.abs(numbers) > LARGEST] = np.nan
    for values in numbers.T:
        take_marks([values])
    return numbers


def _seconds(column: DraftColumn, numbers: np.ndarray) -> np.ndarray:
    """Return the numbers of a column of time in seconds."""
    return conversion(column.read_unit or "s", "s")[0] * numbers[:, column.place - 1]


def _may_be_heights(column: DraftColumn) -> bool:
    """Whether a single column may be heights: its name is not known, nor its unit another's."""
    name, unit, _ = bare_name(column)
    if unit is None:
        return not matches(name, None)
    scan = matches(name, unit, scan=True)
    height = not scan or scan[0].quantity == "height"
    return converts(unit, "m") and height and not matches(name, unit)


def _likely_unit(layout: Layout, numbers: np.ndarray, pitch: Amount | None, density: str) -> str:
    """Return the unit that heights may be in: um, or nm where they were as large as the scan."""
    step = (
        pitch.si("m") if pitch is not None else positive(density, "m", "pitch") if density else 0.0
    )
    reach = float(np.nanmax(numbers) - np.nanmin(numbers)) if np.isfinite(numbers).any() else 0.0
    return "nm" if 0 < step * len(numbers) * _REACH < 1e-6 * reach else "um"


def _say_something(columns: list[DraftColumn]) -> bool:
    """Whether the header says more than 'Channel 1, Channel 2'."""
    bare = [bare_name(column)[:2] for column in columns if column.label]
    return any(unit is not None or matches(name, unit) for name, unit in bare)


def _by_name(
    layout: Layout,
    columns: list[DraftColumn],
    numbers: np.ndarray,
    proofs: dict[int, Proof],
    *,
    placed: bool = False,
) -> tuple[Kind, list[DraftColumn]]:
    bare = [bare_name(column) for column in columns]
    run = [matches(name, unit) for name, unit, _ in bare]
    scan = [matches(name, unit, scan=True) for name, unit, _ in bare]
    run = restrict_to_proofs(_timed(bare, run, numbers), proofs, numbers)
    best = {options[0].quantity for options in run if options}
    profile = {options[0].quantity for options in scan if options}
    if not best & {"time", "friction_force", "normal_force", "sliding_velocity"} and (
        {"x", "height"} <= profile or (placed and "height" in profile)
    ):
        return "scan", decide(Facts(columns, bare, scan, numbers, "scan"), RULES)
    kind: Kind = "run" if best & ({"time"} | SIGNALS) else "table"
    rules = (*RULES, by_legend(layout), by_stated_load(layout), by_mean(layout))
    return kind, decide(Facts(columns, bare, run, numbers, kind), rules)


def _timed(bare: list[Bare], run: list[list[Match]], numbers: np.ndarray) -> list[list[Match]]:
    """Take the one column in a unit of time that rises for time, where no name says which it is."""
    if any(options and options[0].quantity == "time" for options in run):
        return run
    for place, (name, unit, _) in enumerate(bare):
        dated = is_date(name) and not run[place]
        if dated and counted_from(numbers[:, place], unit, dated=True):
            named = [Match("time", 1.0, None)]
            return [named if index == place else options for index, options in enumerate(run)]
    rising = [
        place
        for place, (_, unit, _) in enumerate(bare)
        if unit is not None and not run[place] and converts(unit, "s")
        if (np.diff(numbers[:, place]) >= 0).mean() > _RISES
    ]
    if len(rising) != 1:
        return run
    guess = [Match("time", _BY_UNIT, None)]
    return [guess if place == rising[0] else options for place, options in enumerate(run)]


def first_cells_of(layout: Layout, number: int) -> list[list[str]]:
    """Cells of the first rows as they stand in the file."""
    return [split_row(line, layout.delimiter) for line in layout.rows(number)]
