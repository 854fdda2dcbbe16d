"""What `tribolab dialect` does beside drafting: it asks, and tries the draft on the files."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from tribolab.draft.columns.follows import lacking, what_follows
from tribolab.draft.columns.may_say import may_say
from tribolab.draft.columns.stated_load import stated_number
from tribolab.draft.dialect.answers import column_of, corrected, fits, written
from tribolab.draft.dialect.draft import Draft, as_profile, holds_counts, holds_heights
from tribolab.draft.file.header import converts, is_unit
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn, Understood, other_units
from tribolab.errors import TribolabError, shown
from tribolab.quantities import quantity
from tribolab.units import positive
from tribolab.words import Count

if TYPE_CHECKING:
    import xarray as xr

_NONE = "-"
_COMMA = re.compile(r"^(\d+),(\d{1,2}|\d{4,})(?=\D)")  # no mark of thousands
_RUN = {
    "time": "time",
    "friction_force": "the friction force",
    "normal_force": "the normal force",
    "friction_coefficient": "the friction coefficient",
    "sliding_velocity": "the sliding speed",
    "position": "the position along the direction of sliding",
}
_SCAN = {"x": "the coordinate along the profile", "height": "the height"}


class Ask(Protocol):
    """How a question is asked: it returns what was typed, or the default."""

    def __call__(self, question: str, default: str) -> str:
        """Ask."""


def ask_about(draft: Draft, ask: Ask, say: Callable[[str], None]) -> Draft:
    """Ask a person which column is what, in which unit, and how it is counted.

    Parameters
    ----------
    draft
        What was understood; its guesses are the defaults.
    ask
        How to ask.
    say
        How to say why an answer cannot be taken; it is then asked for again.

    Returns
    -------
    Draft
        The draft with the answers in it, which are no guesses any more.
    """
    if draft.layout is None or draft.understood is None:
        return draft
    if draft.kind == "table" and (holds_heights(draft) or holds_counts(draft)):
        return _ask_for_pitch(draft, ask, say)
    for name, words in (_SCAN if draft.kind == "scan" else _RUN).items():
        draft = _ask_for(draft, name, words, ask, say)
    return _ask_for_motion(draft, ask, say) if draft.kind == "run" else draft


def _ask_for_motion(draft: Draft, ask: Ask, say: Callable[[str], None]) -> Draft:
    """Ask for what the speed follows from, if that is all that is missing."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    speed = what_follows(layout, understood).speed
    if speed is not None and speed.guess and speed.source == "stroke":
        crank = f"does a crank drive it ({_NONE}: its speed is constant both ways)?"
        drive = "constant speed" if ask(crank, "yes").strip() == _NONE else "crank"
        understood = understood._replace(drive=drive)
    return _ask_for_lengths(draft, layout, understood, ask, say)


def _ask_for_lengths(
    draft: Draft, layout: Layout, understood: Understood, ask: Ask, say: Callable[[str], None]
) -> Draft:
    """Ask for the radius of the track, and for the load, where the file does not say them."""
    follows = what_follows(layout, understood)
    lacks = " ".join(lacking(understood, follows))
    if follows.zero_in_doubt is not None:
        text = follows.zero_in_doubt.text
        taken = ask(f"was '{text}' taken off the signal ({_NONE}: it is still in it)?", "yes")
        understood = understood._replace(zero="in it" if taken.strip() == _NONE else "taken off")
        follows = what_follows(layout, understood)
    guessed = [value for value in follows.values if value.guess]
    if guessed or "the radius of the track" in lacks:
        guess = f"{stated_number(guessed[0]):.6g} {guessed[0].unit}" if guessed else _NONE
        said = may_say(layout, follows, "the radius")
        question = "what is the radius of the track, with its unit"
        question += f"; is it in {said}?" if said else "?"
        radius = _ask_amount(question, "radius", "m", guess, ask, say)
        understood = understood._replace(radius=radius)
    if "the load" in " ".join(lacking(understood, what_follows(layout, understood))):
        said = may_say(layout, follows, "the load")
        question = "what is the load, with its unit, if it is one for all of the run"
        question += f"; is it {said}?" if said else "?"
        load = _ask_amount(question, "load", "N", _NONE, ask, say)
        understood = understood._replace(load=load)
    return written(draft, layout, understood)


def _ask_for_pitch(draft: Draft, ask: Ask, say: Callable[[str], None]) -> Draft:
    """Ask how far heights lie apart that stand in a file without positions."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return draft
    pitch = ""
    if not understood.pitched:
        question = "how far do neighbouring heights lie apart, with its unit?"
        pitch = _ask_amount(question, "pitch", "m", _NONE, ask, say)
    if not (pitch or understood.pitched):
        return draft
    if not holds_counts(draft):
        return as_profile(draft, pitch, _ask_unit(understood.columns[0], "height", ask))
    question = "how much is one count, with its unit (e.g. 0.5 nm)?"
    count = _ask_amount(question, "count", "m", _NONE, ask, say)
    return as_profile(draft, pitch, count) if count else draft


def _ask_amount(
    question: str, name: str, si_unit: str, guess: str, ask: Ask, say: Callable[[str], None]
) -> str:
    """Ask for a number with a unit until it is one; "" if it is not known."""
    while True:
        typed = ask(f"{question} ({_NONE}: not known)", guess).strip()
        if typed == _NONE:
            return ""
        typed = _COMMA.sub(r"\1.\2", typed)  # as the file may write it
        try:
            positive(typed, si_unit, f"the {name}")
        except TribolabError as error:
            say(str(error.what))
            continue
        return typed


def _ask_for(draft: Draft, name: str, words: str, ask: Ask, say: Callable[[str], None]) -> Draft:
    held = column_of(draft, name)
    if name == "friction_coefficient" and held is None and column_of(draft, "friction_force"):
        return draft  # it is their ratio
    while True:
        typed = ask(
            f"which column is {words}? (its number; {_NONE} for none)",
            str(held.place) if held else _NONE,
        )
        if typed == _NONE:
            return draft if held is None else corrected(draft, name, None)
        try:
            column = _column(draft, typed)
            if held and column.place == held.place and held.used and not held.guessed:
                return draft
            unit = _ask_unit(column, name, ask)
            return corrected(draft, name, column.place, unit, _ask_sign(draft, column, name, ask))
        except TribolabError as error:
            say(str(error.what))


def _column(draft: Draft, typed: str) -> DraftColumn:
    """Return the column that was named by its number or by its name."""
    columns = draft.understood.columns if draft.understood else ()
    for column in columns:
        if typed.strip() in (str(column.place), column.label, column.name):
            return column
    raise TribolabError(f"there is no column '{shown(typed)}': type a number from 1 on")


def _ask_unit(column: DraftColumn, name: str, ask: Ask) -> str | None:
    """Return the unit to be written down; None if the file says it and it may be taken."""
    si_unit = quantity(name).unit
    said = column.file_unit is not None and fits(column.file_unit, name)
    if column.file_unit and not said and is_unit(column.file_unit):
        what = f"column {column.place} is in {shown(column.file_unit)}, which measures no "
        what += quantity(name).long_name
        if converts(column.file_unit, "N m"):
            what += f": it is a torque; type {_NONE}, and then the radius at which friction acts"
        raise TribolabError(what)
    if si_unit == "1" or (said and column.unit is None):
        return None
    guess = column.unit if column.unit and fits(column.unit, name) else other_units(si_unit)[0]
    return ask(f"in which unit does column {column.place} write it?", guess).strip()


def _ask_sign(draft: Draft, column: DraftColumn, name: str, ask: Ask) -> int:
    """Ask how a force is counted whose numbers are on one side of zero only, the wrong one."""
    if name != "normal_force" or draft.understood is None:
        return 1
    values = draft.understood.numbers[:, column.place - 1]
    values = values[np.isfinite(values)]
    if not values.size or not values.min() < 0:
        return 1
    counted = f"{values.min():.4g} to {values.max():.4g}"
    guess = "yes" if column.sign < 0 or values.max() <= 0 else "no"
    typed = ask(f"column {column.place} goes from {counted}: is pressing negative?", guess)
    return -1 if typed.strip().lower().startswith(("y", "j", "o", "s")) else 1


def try_on(files: Sequence[Path], dialect: Path, kind: str) -> list[str]:
    """Read files with a dialect and say what comes of it: mu of the segments, or what is missing.

    Parameters
    ----------
    files
        The files that it was drafted from.
    dialect
        The TOML file.
    kind
        ``run`` or ``scan``.
    """
    lines = []
    for file in files:
        try:
            said = _run_said(file, dialect) if kind == "run" else _scan_said(file, dialect)
        except TribolabError as error:
            said = error.told("terminal").removeprefix(f"{file}: ")
        lines.append(f"tried:  {file.name}: {said}")
    return lines


def _run_said(file: Path, dialect: Path) -> str:
    # late: starting stays quick
    from tribolab.friction.coefficient.coefficient import friction_coefficient
    from tribolab.friction.reversals import reversals
    from tribolab.friction.segments.find import find_segments, why_no_segment
    from tribolab.io.runs import read_run

    run = read_run(file, dialect, pair=False)
    time = run["time"].values
    said = f"{Count(len(time)):row|rows} over {float(time[-1]):.4g} s"
    if run.attrs.get("rows_are") == "points":
        said = f"{Count(len(time)):result|results}, each at one speed"
    if not {"friction_force", "friction_coefficient", "shear_stress"} & set(run.variables):
        return f"{said}; no friction coefficient yet: nothing holds the friction"
    try:
        segments = find_segments(run)
        friction = friction_coefficient(run, segments)
    except TribolabError as error:
        why = error.told("terminal").removeprefix(f"{file.name}: ")
        return f"{said}; no friction coefficient: {why}"
    if why := why_no_segment(segments):
        return f"{said}; {why}"
    said += f", {Count(segments.sizes['segment']):segment|segments}"
    if "friction_coefficient" not in friction:
        return f"{said}, a friction force without a load: no friction coefficient"
    signal = "friction_force" if "friction_force" in run else "friction_coefficient"
    turned = reversals(run[signal].values) if _undirected(segments) else 0
    if turned:
        return (
            f"{said}; friction changes its sign {turned} times while nothing tells the way: it "
            "looks like motion to and fro, whose mean is no friction coefficient; state stroke and "
            'frequency under [speed], with source = "stroke"'
        )
    mu = np.atleast_1d(friction["friction_coefficient"].values)
    sem = np.atleast_1d(friction["friction_coefficient_sem"].values)[np.isfinite(mu)]
    mu = mu[np.isfinite(mu)]
    if not mu.size:
        return said
    span = f"{mu.min():.3g}" + (f" to {mu.max():.3g}" if mu.size > 1 else "")
    known = sem[np.isfinite(sem)]
    width = f"at most {known.max():.2g}" if known.size else "not known"
    return f"{said}, friction coefficient {span} (standard error {width}, statistical only)"


def _undirected(segments: xr.Dataset) -> bool:
    """Whether nothing tells which way it slid."""
    unknown = bool(segments["sliding_speed"].isnull().any())
    return unknown or segments.attrs["velocity_source"] == "set speed"


def _scan_said(file: Path, dialect: Path) -> str:
    # late: starting stays quick
    from tribolab.draft.scans import read_scans
    from tribolab.io.scans.extent import doubt_about_heights

    scan = read_scans(file, dialect)
    height = scan["height"]
    span = float(height.max() - height.min())
    doubt = doubt_about_heights(scan)
    said = f"{Count(height.size):point|points}, heights over {1e6 * span:.4g} um"
    return f"{said}; doubtful: {doubt}" if doubt else said
