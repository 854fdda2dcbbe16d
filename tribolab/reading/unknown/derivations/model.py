"""Quantities of a run that follow from others: formulas, their inputs, and the speed."""

from __future__ import annotations

from typing import NamedTuple

from tribolab.reading.dialect.formula import names_in, parse_formula
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.derive import Derivation, Given
from tribolab.reading.unknown.model import DraftColumn

SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}
CRANK = "drive"  # the value that says of a run what turns there
Source = DraftColumn | Amount | None  # None of what a person said, or what is no amount
Known = dict[str, Given[Source]]
_BEFORE_FRICTION = ("torque", "torque_reading", "arm_force", "friction_reading")
_WIDE_RING = "friction acts at the mean of the inner and the outer radius"


class DraftedFormula(NamedTuple):
    """A quantity that follows: its name, formula, inputs, and the location of its zero."""

    quantity: str
    formula: str
    about: str
    zero: str = ""


class SpeedBy(NamedTuple):
    """Rule for the sliding speed: the keys of [speed], and those that are guessed."""

    source: str
    settings: tuple[tuple[str, str], ...] = ()
    guess: str = ""
    options: tuple[str, ...] = ()


class Follows(NamedTuple):
    """Formulas, the columns (with their symbols) and values that they need, and the speed.

    `zero_in_doubt` is a stated zero of which nothing says whether it is still in the signal;
    `given` what is known by quantity of physics.toml, and `facts` of the rig.
    """

    formulas: tuple[DraftedFormula, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    values: tuple[Amount, ...] = ()
    speed: SpeedBy | None = None
    zero_in_doubt: Amount | None = None
    given: Known = {}
    facts: frozenset[str] = frozenset()

    def with_values(self, *values: Amount | None) -> Follows:
        """Return this with values that a run keeps, or formulas need."""
        known = (value for value in values if value is not None)
        return self._replace(values=tuple(dict.fromkeys((*self.values, *known))))

    def with_symbols(self, *symbols: tuple[str, DraftColumn]) -> Follows:
        """Return this with columns that formulas or the speed need."""
        return self._replace(symbols=tuple(dict.fromkeys((*self.symbols, *symbols))))

    def add_derivation(self, derived: Derivation[Source], about: str = "") -> Follows:
        """Return this with the formula of what follows by a rule, and all that it needs."""
        leaves = derived.leaves
        values = [leaf.source for leaf in leaves if isinstance(leaf.source, Amount)]
        if derived.is_doubtful:
            values = [
                v._replace(guess=_WIDE_RING) if v.name == "outer_radius" else v for v in values
            ]
        columns = [  # of what friction follows from, the zero is that of the friction
            (name, leaf.source, leaf.quantity in _BEFORE_FRICTION)
            for leaf in leaves
            if isinstance(leaf.source, DraftColumn)
            for name in names_in(parse_formula(leaf.symbol)) - {leaf.source.quantity}
        ]
        stated_zero = any(leaf.quantity.endswith("_zero") for leaf in leaves)
        zeros = [column.zero for _, column, moved in columns if moved and column.zero]
        zero = zeros[0] if zeros and not stated_zero else ""
        if not about:
            about = "; ".join([str(derived.rule), *(f"'{value.text}'" for value in values)])
        formula = DraftedFormula(derived.quantity, derived.formula, about, zero)
        symbols = ((name, c._replace(zero="" if moved else c.zero)) for name, c, moved in columns)
        more = self.with_values(*values).with_symbols(*symbols)
        return more._replace(formulas=(*self.formulas, formula))
