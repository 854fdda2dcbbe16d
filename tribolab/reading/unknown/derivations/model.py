"""Derived quantities of a run: formulas, their inputs, and the rule for the speed."""

from __future__ import annotations

from typing import NamedTuple

from tribolab.reading.dialect.formula import names_in, parse_formula
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.derive import Derivation, Given
from tribolab.reading.unknown.model import DraftColumn

SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}
CRANK = "drive"  # name of the value that describes a crank drive
Source = DraftColumn | Amount | None  # None for answers of the user and for constants
Known = dict[str, Given[Source]]
_BEFORE_FRICTION = ("torque", "torque_reading", "arm_force", "friction_reading")
_WIDE_RING = "friction acts at the mean of the inner and the outer radius"


class DraftedFormula(NamedTuple):
    """Derived quantity: its name, formula, explanation, and the interval that gives its zero."""

    quantity: str
    formula: str
    about: str
    zero: str = ""


class SpeedBy(NamedTuple):
    """Rule for the sliding speed: the keys of [speed], a guess about them, and its alternatives."""

    source: str
    settings: tuple[tuple[str, str], ...] = ()
    guess: str = ""
    options: tuple[str, ...] = ()


class Follows(NamedTuple):
    """Derived quantities: formulas, the columns (with symbols) and values in them, and the speed.

    `zero_in_doubt` is a stated zero that may or may not be subtracted from the signal already;
    `given` are the known quantities by name in physics.toml, `facts` facts about the rig.
    """

    formulas: tuple[DraftedFormula, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()
    values: tuple[Amount, ...] = ()
    speed: SpeedBy | None = None
    zero_in_doubt: Amount | None = None
    given: Known = {}
    facts: frozenset[str] = frozenset()

    def with_values(self, *values: Amount | None) -> Follows:
        """Return a copy with further values that formulas need or the run keeps."""
        known = (value for value in values if value is not None)
        return self._replace(values=tuple(dict.fromkeys((*self.values, *known))))

    def with_symbols(self, *symbols: tuple[str, DraftColumn]) -> Follows:
        """Return a copy with further columns that formulas or the speed need."""
        return self._replace(symbols=tuple(dict.fromkeys((*self.symbols, *symbols))))

    def add_derivation(self, derived: Derivation[Source], about: str = "") -> Follows:
        """Return a copy with the formula of a derived quantity, and its columns and values."""
        leaves = derived.leaves
        values = [leaf.source for leaf in leaves if isinstance(leaf.source, Amount)]
        if derived.is_doubtful:
            values = [
                v._replace(guess=_WIDE_RING) if v.name == "outer_radius" else v for v in values
            ]
        columns = [  # the zero of such a column is the zero of the friction derived from it
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
