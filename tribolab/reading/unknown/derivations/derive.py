"""Quantities of a run that no column contains, derived from columns and stated values."""

from __future__ import annotations

import functools
import operator
from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.derive import Derivation, Given, derive
from tribolab.reading.unknown.derivations.known_amounts import KnownRun, find_known
from tribolab.reading.unknown.derivations.model import SAYS_FRICTION, SAYS_LOAD, Follows, Source
from tribolab.reading.unknown.derivations.speed import add_speed
from tribolab.reading.unknown.derivations.stated_lines import find_stated_load
from tribolab.reading.unknown.header.stroke_settings import stated_strokes
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Understood
from tribolab.units.quantities import unit_conversion

_MEASURED = ("friction_reading", "arm_force", "friction_force_signal")
_PRESSED = 0.5  # of the largest load; below it, the contact is open
_HELD = 1.1  # largest ratio of a controlled load to its set-point, or the inverse


def what_follows(layout: Layout, understood: Understood) -> Follows:
    """Return the quantities of a run that follow from others by the rules of physics.toml.

    Only amounts that are stated with a unit are used.
    """
    return _derived(_CacheKey(layout, understood)) if understood.kind == "run" else Follows()


class _CacheKey(NamedTuple):
    """Layout and interpretation of a file as a key of the cache, compared by identity."""

    layout: Layout
    understood: Understood

    def __hash__(self) -> int:
        return hash((id(self.layout), id(self.understood)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _CacheKey) and all(map(operator.is_, self, other))


@functools.lru_cache(maxsize=2)  # the result is needed for questions, remarks and the dialect
def _derived(found: _CacheKey) -> Follows:
    layout, understood = found
    known = find_known(layout, understood)
    result = Follows(zero_in_doubt=known.zero_in_doubt, given=known.given, facts=known.facts)
    turning = derive("rotation_speed", known.given)
    if turning is not None and turning.rule is not None:
        result = result.add_derivation(turning)
        known.given["rotation_speed"] = Given("rotation_speed", "rotation_speed", None)
    result = add_speed(result, layout, understood, known)
    result = _add_friction(result, known, understood)
    return _add_load(result, understood, known)


def held_quantities(understood: Understood) -> set[str]:
    """Return the quantities of all columns, including columns whose unit is still missing."""
    return {c.quantity for c in understood.columns if c.quantity and (c.used or c.fill_in)}


def _add_friction(result: Follows, known: KnownRun, understood: Understood) -> Follows:
    """Add the formula of the friction force if no column contains it."""
    friction = derive("friction_force", known.given, known.facts)
    others = held_quantities(understood) & (SAYS_FRICTION - {"friction_force"})
    by_area = "contact_area" in known.given and "normal_force" in known.given
    wanted = not others or by_area or any(name in known.given for name in _MEASURED)
    if friction is None or friction.rule is None or not wanted:
        return result
    return result.add_derivation(friction)


def _add_load(result: Follows, understood: Understood, known: KnownRun) -> Follows:
    """Add the formula of the load on the contacts, or the stated load."""
    names = held_quantities(understood)
    friction = names | {formula.quantity for formula in result.formulas}
    if "position" in names and result.speed is None:
        result = result.with_values(*stated_strokes(known.values))
    load = derive("normal_force", known.given, known.facts)
    set_to = _set_load(load)
    if load is not None and load.rule is not None and set_to is None:
        of_forces = "axial_force" not in known.given or "friction_force" in friction
        return result.add_derivation(load) if of_forces else result
    stated = None if understood.load else find_stated_load(known.values, understood)
    wanted = friction & SAYS_FRICTION and not names & SAYS_LOAD
    if set_to is not None and load is not None and wanted:
        about = f"nothing measures it: {_quoted(set_to)} is taken for all of the run"
        return result.add_derivation(load, about)
    measured = names & {"normal_force", "normal_stress", "set_normal_force"}
    if stated is not None and (not measured or _is_held(stated, understood)):
        # the load of a recorded coefficient, or the set-point of a measured load
        return result.with_values(stated)
    return result


def _set_load(load: Derivation[Source] | None) -> Source | str:
    """Return the set or stated load from which the load is derived; None if it is measured."""
    for leaf in load.leaves if load is not None and load.rule is not None else ():
        measured = isinstance(leaf.source, DraftColumn) and leaf.source.quantity == "normal_force"
        if leaf.quantity in ("set_normal_force", "axial_force") and not measured:
            return leaf.source if leaf.source is not None else leaf.symbol
    return None


def _quoted(source: Source | str) -> str:
    if isinstance(source, Amount):
        return f"'{source.text}'"
    return "the load that was set" if isinstance(source, DraftColumn) else f"{source}, as was said,"


def _is_held(load: Amount, understood: Understood) -> bool:
    """Whether the only measured load stays at the stated load, which is then its set-point."""
    columns = [c for c in understood.columns if c.used and c.quantity == "normal_force"]
    if len(columns) != 1 or load.source != "preamble":
        return False
    if "set_normal_force" in held_quantities(understood):
        return False
    scale, _ = unit_conversion(columns[0].read_unit or "N", "normal_force")
    values = np.abs(columns[0].scale * scale * understood.numbers[:, columns[0].place - 1])
    pressed = values[values > _PRESSED * np.nanmax(values, initial=0.0)]
    set_to = load.value * unit_conversion(load.unit or "N", "normal_force")[0]
    if not pressed.size or not set_to > 0:
        return False
    low, high = np.nanquantile(pressed, (0.05, 0.95)) / set_to
    return bool(low > 1 / _HELD and high < _HELD)
