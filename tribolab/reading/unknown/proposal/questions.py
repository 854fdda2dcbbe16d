"""Open questions about a file of an unknown instrument: guesses, and their alternatives."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tribolab.core.errors import ReadError, shown
from tribolab.reading import cures
from tribolab.reading.interpret.missing import MissingInput
from tribolab.reading.raw.source import check_regular
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.columns.text_evidence import unused_force_columns
from tribolab.reading.unknown.derivations.derive import what_follows
from tribolab.reading.unknown.derivations.missing_inputs import Uncalibrated, lacking, unknown_of
from tribolab.reading.unknown.derivations.model import Follows
from tribolab.reading.unknown.derivations.stated_lines import candidate_lines
from tribolab.reading.unknown.header.factors import calibration_lines
from tribolab.reading.unknown.header.settings import lines_without_unit
from tribolab.reading.unknown.header.zero import STILL
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Reason, Understood
from tribolab.reading.unknown.proposal.model import Drafted
from tribolab.units.quantities import quantity

_UNSAID = {
    "count": "how much one count of the heights is",
    "pitch": 'the distance of neighbouring heights, pitch = "(a length)"',
}
_OF_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_WANTED = {*_OF_FRICTION, "normal_force", "normal_stress", "sliding_velocity", "position", "time"}
_LIKE_NUMBER = re.compile(r"[<>~]?\s*[+-]?\d[\d.,' ]*(?:[eE][+-]?\d+)?\s*[A-Za-z%µ°/]{0,6}")
_IN_LINE = 12  # questions about one file that are listed in one line
_LINES = 3  # lines of an error message (of five) for what is unclear or missing
_LISTED = 6  # columns that are listed as understood
_UNKNOWN = "the instrument is not known, and the file does not state everything"
_MAX_DRAFTS = 50  # TOML files in the file's folder that are inspected
_RADII = ("another length",)
_RATE = ("a sample rate, e.g. 100 Hz", "a column of time")


class Question(NamedTuple):
    """Open question about a file: its subject, the guess and the alternatives."""

    about: str
    guess: str
    options: tuple[str, ...] = ()
    is_open: bool = False  # there is no guess: the user has to choose an option

    @property
    def line(self) -> str:
        """The question with its alternatives in one line."""
        if self.is_open and self.options:
            *first, last = self.options
            choice = f"{', '.join(first)} or {last}" if first else last
            return f"{self.about}: {self.guess.rstrip('?')}: {choice}?"
        others = f" (or {', '.join(self.options)})" if self.options else ""
        return f"{self.guess if self.about == 'table' else f'{self.about}: {self.guess}'}{others}"


def questions(draft: Drafted) -> list[Question]:
    """Return the questions about guesses and missing inputs; empty if the header is complete."""
    layout, understood = draft.layout, draft.understood
    if layout is None or understood is None:
        return []
    asked = [Question("table", guess) for guess in (*layout.guesses, *understood.guesses)]
    if (
        understood.kind == "run"
        and not (understood.rate_pattern or understood.rate or understood.points)
        and not any(c.used and c.quantity == "time" for c in understood.columns)
    ):
        asked.append(Question("time", "rows are counted as seconds", _RATE))
    asked += _of_texts(understood)
    follows = what_follows(layout, understood)
    if understood.kind == "run":
        places = {column.place for _, column in follows.symbols}
        aside = unused_force_columns(layout, understood.columns, places)
        asked += [Question("forces", said, ("to be taken off, or added",)) for said in aside]
    asked += _of_roles(understood, follows)
    held = {column.quantity for column in understood.columns if column.used}
    asks = any(column.guessed or column.fill_in for column in understood.columns)
    if understood.kind == "scan" and "height" not in held and not asks:
        names = [f"column {c.place} '{shown(c.label, 20)}'" for c in understood.columns]
        asked.append(
            Question("heights", "no column is known to hold them", (*names,), is_open=True)
        )
    moves = bool(held & {"sliding_velocity", "position"}) and "time" in held
    for column in understood.columns:
        if moves and column.quantity == "rotation_speed" and column.fill_in:
            continue  # the motion is known without the rotation speed
        if column.guessed or column.fill_in:
            asked.append(_of_column(layout, column))
    return asked


def _of_texts(understood: Understood) -> list[Question]:
    """Return questions about text in place of numbers, so that no value is dropped silently."""
    asked = []
    held = {column.quantity for column in understood.columns if column.used}
    for column in understood.columns:
        if column.reason is Reason.TEXT and column.quantity in _WANTED - held:
            about = f"column {column.place} '{shown(column.label, 30)}'"
            asked.append(Question(about, f"left out, {column.note}"))
    if understood.kind == "run":
        odd = [word for word in understood.missing if _LIKE_NUMBER.fullmatch(word)]
        asked += [Question("cells", f"'{shown(word, 20)}' is taken for no value") for word in odd]
    return asked


def _of_roles(understood: Understood, follows: Follows) -> list[Question]:
    """Return questions about speed, zero and radius, and about the column of the friction."""
    asked = []
    if follows.speed is not None and follows.speed.guess:
        asked.append(Question("speed", follows.speed.guess, follows.speed.options))
    if follows.zero_in_doubt is not None:
        guess = f"'{follows.zero_in_doubt.text}' was taken off the signal"
        asked.append(Question("zero", guess, (STILL,)))
    asked += [Question("radius", v.guess, _RADII) for v in follows.values if v.guess]
    names = {column.quantity for column in understood.columns}
    names |= {formula.quantity for formula in follows.formulas}
    unknown = unknown_of(understood.columns)
    torque = torque_of(understood.columns) is not None
    if understood.kind == "run" and unknown and not torque and not names & _OF_FRICTION:
        options = tuple(f"column {c.place} '{shown(c.label, 30)}'" for c in unknown[:_IN_LINE])
        asked.append(Question("friction", "no column is known to hold it", options, is_open=True))
    return asked


def _of_column(layout: Layout, column: DraftColumn) -> Question:
    about = f"column {column.place}" + (f" '{shown(column.label, 30)}'" if column.label else "")
    guess = "; ".join(column.guessed)
    if column.fill_in and (column.counted or column.read_unit is None):
        asks = "what is one count?" if column.counted else "in which unit?"
        lines = calibration_lines(layout, bare=True) if column.counted else ""
        unsaid = f"{column.quantity}, {asks}" + (f" (the file states {lines})" if lines else "")
        guess = f"{guess}; {unsaid}" if guess else unsaid
    is_open = bool(column.fill_in) and not column.guessed
    return Question(about, guess, tuple(dict.fromkeys(column.options)), is_open)


def lacks_friction(draft: Drafted) -> bool:
    """Whether friction cannot be computed, e.g. from a torque without a radius."""
    lacks = (lack for lack in _lacks(draft) if lack.member != "friction_force")
    return any("friction" in lack.goals for lack in lacks)


def missing_words(draft: Drafted, *, by_option: bool = False) -> list[str]:
    """Return in words what is missing for the coefficient of friction against speed.

    The words include how to state each input in a file; with `by_option`, inputs that have a
    command-line option are named only.
    """
    lacks = _lacks(draft)
    unused = [f"the unit of '{line}', which is not used" for line in _unused(draft, lacks)]
    if draft.layout is None or draft.understood is None:
        return [str(lack) for lack in lacks] + unused
    follows = what_follows(draft.layout, draft.understood)
    lines = [
        (str(lack), calibration_lines(draft.layout))
        if isinstance(lack, Uncalibrated)
        else (
            lack.what if by_option and lack.option else str(lack),
            candidate_lines(draft.layout, follows, lack.member),
        )
        for lack in lacks
    ]
    return [lack + (f"; is it {line}?" if line else "") for lack, line in lines] + unused


def without_unit_and_missed(draft: Drafted) -> list[str]:
    """Return lines that may state a missing input, but without a unit: 'Stroke=12'."""
    return _unused(draft, _lacks(draft))


def missing_options(draft: Drafted, asked: Sequence[Question]) -> list[str]:
    """Return the command-line options that state everything a file lacks, with examples.

    The list is empty if options cannot state everything, or if a question has no guess.
    """
    lacks = _lacks(draft)
    options = [lack.option for lack in lacks if isinstance(lack, MissingInput) and lack.option]
    whole = len(options) == len(lacks) and not any(question.is_open for question in asked)
    return sorted(options) if whole else []


def _lacks(draft: Drafted) -> list[MissingInput | Uncalibrated]:
    if draft.layout is None or draft.understood is None or draft.kind != "run":
        return []
    return lacking(draft.understood, what_follows(draft.layout, draft.understood))


def _unused(draft: Drafted, lacks: Sequence[object]) -> list[str]:
    lines = lines_without_unit(draft.layout) if draft.layout and lacks else []
    return [shown(line, 40) for line in lines]


def missing_height_unit(draft: Drafted) -> str:
    """Return what is missing to read heights without positions, with lines that may state it."""
    lines = lines_without_unit(draft.layout, bare=True) if draft.layout else []
    said = ", ".join(f"'{shown(line, 40)}'" for line in lines if draft.unsaid == "pitch")
    return _UNSAID[draft.unsaid] + (f"; {said} has no unit" if said else "")


class GuessedError(ReadError):
    """Error: a file could be read only by guessing. At most five lines list the open questions.

    In a campaign, the message is one line.
    """

    def __init__(
        self,
        path: Path,
        asked: Sequence[Question],
        table: str = cures.RUN,
        lacks: Sequence[str] = (),
        understood: Sequence[str] = (),
        options: Sequence[str] = (),
        by_option: Sequence[str] = (),
    ) -> None:
        super().__init__(_UNKNOWN, where=path, cure=cures.unknown_instrument(path, table))
        said = map(tuple, (lacks, understood, options, by_option))
        self.args = (path, tuple(asked), table, *said)
        self.asked = tuple(asked)
        self.lacks = tuple(lacks)
        self.understood = tuple(understood)
        self.options = tuple(options)
        self.by_option = tuple(by_option)

    def message_for(self, audience: str) -> str:
        """Return the message for an audience."""
        cure = self.cure if isinstance(self.cure, str) else self.cure.message_for(audience)
        unclear = [f"Unclear: {question.line}" for question in self.asked]
        lacks = (self.by_option or self.lacks) if audience == "terminal" else self.lacks
        missing = [f"Missing: {lack}" for lack in lacks]
        known = f"Understood: {', '.join(self.understood) or 'nothing yet'}"
        if audience == "campaign":
            lines = [question.line for question in self.asked[:_IN_LINE]]
            lines += _and_more(len(self.asked) - _IN_LINE)
            said = [f"unclear: {'; '.join(lines)}"] if lines else []
            said += [f"missing: {'; '.join(self.lacks)}"] if self.lacks else []
            return "; ".join([f"{self.where}: {self.what}", *said, cure])
        kept = [f"--instrument {name} is a description of it" for name in _drafts_of(self.where)]
        if self.options and audience == "terminal":
            cure = f"State {' '.join(self.options)}, or {cure}"
        first = unclear[: max(_LINES - len(missing), _LINES - 1)]
        lines = [*first, *missing[: _LINES - len(first)]]
        more = " ".join(_and_more(len(unclear) + len(missing) - len(lines)))
        lines[-1:] = [f"{line} ({more})" if more else line for line in lines[-1:]]
        return "\n".join([f"{self.where}: {self.what}. {known}", *lines, *(kept or [cure])])


def _and_more(count: int) -> list[str]:
    return [f"and {count} more"] if count > 0 else []


def understood_columns(draft: Drafted) -> list[str]:
    """Return a text for each column without doubt: quantity, name in the file, unit."""
    said = []
    for column in draft.understood.columns if draft.understood else ():
        if column.used and column.quantity and not column.guessed:
            name = split_name(column.label)[0]
            label = f"'{shown(name, 20)}'" if name else f"in column {column.place}"
            unit = column.read_unit or quantity(column.quantity).unit
            said.append(f"{column.quantity} {label}" + ("" if unit == "1" else f" ({unit})"))
    if not (said or draft.labels):
        return ["none of its columns has a name: write names and units above the numbers"]
    return said[:_LISTED] + _and_more(len(said) - _LISTED)


def _drafts_of(path: object) -> list[str]:
    """Return the first dialect in the file's folder that was drafted from the file, as a list."""
    file = Path(str(path))
    first = f"# Drafted from '{file.name}'."
    found = []
    for draft in sorted(file.parent.glob("*.toml"))[:_MAX_DRAFTS]:
        try:
            check_regular(draft)
            with draft.open(encoding="utf-8") as text:
                found += [str(draft)] if text.readline().startswith(first) else []
        except (OSError, ValueError, ReadError):
            continue
    return found[:1]


def how_to_keep(path: Path | str) -> str:
    """Return the command that saves the dialect drafted from a file.

    >>> how_to_keep(Path("raw/odd one.csv"))
    "tribolab info 'odd one.csv' --write my.toml"
    >>> how_to_keep("raw/odd one.csv")
    "tribolab info 'raw/odd one.csv' --write my.toml"
    """
    file = shlex.quote(path.name if isinstance(path, Path) else path)
    return f"tribolab info {file} --write my.toml"
