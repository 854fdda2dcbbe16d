"""Amounts: numbers with a unit that a file states of itself, and queries for them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import key_pattern
from tribolab.reading.numbers import decimal
from tribolab.units.conversion import conversion
from tribolab.units.spellings import WEIGHTS


class Amount(NamedTuple):
    """A number that a file states of itself, in a line of text, an attribute or its name.

    Attributes
    ----------
    name
        Under which a dialect keeps it.
    pattern
        Finds the number in `text`, the line or the name.
    unit, to
        Its unit, and the SI unit of its dimension, if it has one that is known.
    source
        ``preamble``, ``step`` or ``file name``.
    own_unit
        The unit as the file writes it: a weight's, too.
    scale
        By which the number is multiplied: 0.5 if it is a diameter and wanted is a radius.
    key
        What the file calls it, normalised.
    guess
        What of it is a guess.
    """

    name: str
    pattern: str
    unit: str | None
    to: str | None
    text: str
    source: str = "preamble"
    own_unit: str | None = None
    scale: float = 1.0
    key: str = ""
    guess: str = ""

    @property
    def number(self) -> float:
        """The number as the file has it; NaN if it is none."""
        match = re.search(self.pattern, self.text)
        return decimal(match[1]) if match else float("nan")

    def means(self, *concepts: str) -> bool:
        """Whether what the file calls it means one of some concepts of settings.toml."""
        return any(key_pattern(concept).search(self.key) for concept in concepts)

    def is_in(self, si_unit: str) -> bool:
        """Whether its unit converts to an SI unit; that of a weight, to newtons."""
        return converts(self._unit(si_unit), si_unit)

    def si(self, si_unit: str) -> float:
        """Return its size in an SI unit; NaN if it has another dimension."""
        if not self.is_in(si_unit):
            return float("nan")
        return self.scale * self.number * conversion(self._unit(si_unit), si_unit)[0]

    def _unit(self, si_unit: str) -> str:
        unit = self.unit or self.own_unit or ""
        return WEIGHTS.get(unit, unit) if si_unit == "N" else unit


class Amounts(tuple[Amount, ...]):
    """What a file states, to be asked for by concept and unit."""

    __slots__ = ()

    def of(
        self, *concepts: str, unit: str | None = None, but: Sequence[str] = (), source: str = ""
    ) -> Amounts:
        """Return the amounts of any of some concepts.

        Parameters
        ----------
        concepts
            Names in settings.toml; every amount if there are none.
        unit
            SI unit that theirs converts to; "" if they must have none.
        but
            Concepts that they must not mean.
        source
            Where they stand; "" for anywhere.
        """
        return Amounts(
            one
            for one in self
            if (not concepts or one.means(*concepts))
            and (unit is None or (one.is_in(unit) if unit else one.own_unit is None))
            and not one.means(*but)
            and (not source or one.source == source)
        )

    def only(
        self, *concepts: str, unit: str | None = None, but: Sequence[str] = (), source: str = ""
    ) -> Amount | None:
        """Return the one amount of some concepts; None if there is none, or several."""
        found = self.of(*concepts, unit=unit, but=but, source=source)
        return found[0] if len(found) == 1 else None
