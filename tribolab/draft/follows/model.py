"""What follows of a run where no column holds it: formulas, what they rest on, and the speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.model import DraftColumn
from tribolab.reading.interpret.amounts import Amount

SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}
CRANK = "drive"  # the value that says of a run what turns there


class DraftedFormula(NamedTuple):
    """A quantity that follows: its name, the formula, what it rests on, where its zero is read.

    With `way` it is so on the way out alone: nothing presses on the way back.
    """

    quantity: str
    formula: str
    about: str
    zero: str = ""
    way: str = ""


class SpeedBy(NamedTuple):
    """How the sliding speed follows: what [speed] says, by keys, and what of it is guessed."""

    source: str
    settings: tuple[tuple[str, str], ...] = ()
    guess: str = ""
    options: tuple[str, ...] = ()


class Follows(NamedTuple):
    """Formulas, the columns (with their symbols) and values that they need, and the speed.

    `zero_in_doubt` is a stated zero of which nothing says whether it is still in the signal.
    """

    formulas: tuple[DraftedFormula, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    values: tuple[Amount, ...] = ()
    speed: SpeedBy | None = None
    zero_in_doubt: Amount | None = None


class Track(NamedTuple):
    """A radius as it stands in a formula, and the value or the column that it rests on."""

    formula: str = ""
    values: tuple[Amount, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()


def of_value(value: Amount | None) -> Track:
    """Return a value of the text as it stands in a formula."""
    return Track() if value is None else Track(value.name, (value,))


def and_also(
    before: Follows,
    formula: DraftedFormula,
    values: Sequence[Amount] = (),
    symbols: tuple[tuple[str, DraftColumn], ...] = (),
) -> Follows:
    """Add a formula, and the values and columns that it needs."""
    return before._replace(
        formulas=(*before.formulas, formula),
        symbols=tuple(dict.fromkeys((*before.symbols, *symbols))),
        values=tuple(dict.fromkeys((*before.values, *values))),
    )
