"""Quantities and units of columns that their numbers prove."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_count, is_track_radius, matches
from tribolab.reading.interpret.physics import Candidate, Proof, known_quantities, prove
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.evidence import BOTH_FORCES
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.quantities import QUANTITIES, unit_conversion

_SCORE_MARGIN = 0.1  # quantities with a score that much below the best are possible, too
_READS_LOAD = 0.1  # largest relative deviation of a controlled load from the stated one
_INNER = (0.02, 0.98)  # quantiles of a position, which may exceed the stroke before the test
_SHORTEST, _LONGEST = 0.6, 1.2  # range of a position divided by the stroke
_LENGTHS = ("um", "mm", "cm", "m")
_MAX_COLUMNS = 100  # columns; with more, too many combinations would have to be tested
_NAMED = ("mass", "turns", "distance", "torque")


def proven(columns: Sequence[DraftColumn], numbers: np.ndarray) -> dict[int, Proof]:
    """Return the quantities and units that rules of physics prove, by column index from 0."""
    bare = [bare_name(column) for column in columns]
    if len(columns) > _MAX_COLUMNS or all(unit is not None for _, unit, _ in bare):
        return {}  # nothing is left to prove
    candidates = [_candidate(*one, values) for one, values in zip(bare, numbers.T, strict=True)]
    return prove(candidates, numbers)


def add_proven_units(columns: Sequence[DraftColumn], proofs: dict[int, Proof]) -> list[DraftColumn]:
    """Return the columns with the proven units where the file states none."""
    return [
        column._replace(unit=proof.unit)
        if (proof := proofs.get(place)) is not None and bare_name(column)[1] is None
        else column
        for place, column in enumerate(columns)
    ]


def add_unit_of_load(
    columns: Sequence[DraftColumn], numbers: np.ndarray, load: Amount | None
) -> list[DraftColumn]:
    """Give forces without a unit the unit of the stated load, if a load cell reads that load.

    File: Fx, Fy and Fz = -20.3 of "PAO4+OA-10_20N_100mms" (liampond/EgbertsTribometer).
    """
    forces = {place: _force_of(column) for place, column in enumerate(columns)}
    forces = {place: force for place, force in forces.items() if force}
    unit = load.own_unit if load is not None else None
    if load is None or unit is None or set(forces.values()) != set(BOTH_FORCES):
        return list(columns)
    read = [np.abs(numbers[:, p]) for p, force in forces.items() if force == "normal_force"]
    sizes = [float(np.nanmedian(values)) for values in read if np.isfinite(values).any()]
    if not any(abs(size - load.number) <= _READS_LOAD * load.number for size in sizes):
        return list(columns)
    return [
        column._replace(unit=unit) if place in forces else column
        for place, column in enumerate(columns)
    ]


def add_unit_of_stroke(
    columns: Sequence[DraftColumn], numbers: np.ndarray, stroke: Amount | None
) -> list[DraftColumn]:
    """Give positions without a unit the unit in which their range is the stated stroke.

    File: "Track length [mm]: 5" above an x-Position from 0 to 5602 (liampond/EgbertsTribometer).
    """
    if stroke is None or stroke.unit is None:
        return list(columns)
    length = stroke.number * stroke.scale * unit_conversion(stroke.unit, "position")[0]
    result = []
    for place, column in enumerate(columns):
        name, unit, _ = bare_name(column)
        options = matches(name, unit) if unit is None else []
        values = numbers[np.isfinite(numbers[:, place]), place]
        if options and options[0].quantity == "position" and values.size:
            low, high = np.quantile(values, _INNER)
            spans = {u: (high - low) * unit_conversion(u, "position")[0] / length for u in _LENGTHS}
            unit = next((u for u, s in spans.items() if _SHORTEST < s < _LONGEST), None)
            column = column._replace(unit=unit) if unit else column
        result.append(column)
    return result


def _force_of(column: DraftColumn) -> str:
    """Return which force the name of a column without a unit certainly means; "" if none."""
    name, unit, _ = bare_name(column)
    options = matches(name, unit) if unit is None else []
    sure = bool(options) and options[0].score >= KNOWN_WORD
    return options[0].quantity if sure and options[0].quantity in BOTH_FORCES else ""


def _candidate(name: str, unit: str | None, say: bool, values: np.ndarray) -> Candidate:
    moves = bool(np.isfinite(values).any()) and not (unit is not None and is_count(unit))
    if not moves:
        return Candidate(frozenset(), unit)
    plain = normalise_label(name)
    options = matches(name, unit)
    near = {o.quantity for o in options if o.score >= options[0].score - _SCORE_MARGIN}
    quantities = near & known_quantities()
    quantities |= {concept for concept in _NAMED if key_pattern(concept).search(plain)}
    if is_track_radius(plain):
        quantities = {"track_radius"}
    if "distance" in quantities and not converts(unit or "m", "m"):
        quantities.discard("distance")
    if "sliding_velocity" in quantities and unit is None:
        quantities.add("rotation_speed")  # "Speed" may be either
    return Candidate(frozenset(quantities), unit)


def restrict_to_proofs(
    matched: Sequence[list[Match]], proofs: dict[int, Proof], numbers: np.ndarray
) -> list[list[Match]]:
    """Return the possible quantities of each column, after excluding what the proofs contradict."""
    taken: dict[str, int] = {}
    for place in sorted(proofs):
        taken.setdefault(proofs[place].quantity, place)
    # with a known sliding speed, a distance adds no information
    settled = {*taken, "position"} if "sliding_velocity" in taken else set(taken)

    def options_of(place: int, options: list[Match]) -> list[Match]:
        proof = proofs.get(place)
        if proof is None or proof.quantity not in QUANTITIES:
            kept = [option for option in options if option.quantity not in settled]
            return kept if proof is None or proof.quantity != "distance" else []
        if place == taken[proof.quantity] or not _same(numbers, place, taken[proof.quantity]):
            # a load in g is read in gf, as by its name alone
            unit = next((o.unit for o in options if o.quantity == proof.quantity), None)
            return [Match(proof.quantity, 1.0, unit)]
        return []

    return [options_of(place, options) for place, options in enumerate(matched)]


def _same(numbers: np.ndarray, one: int, other: int) -> bool:
    return bool(np.array_equal(numbers[:, one], numbers[:, other], equal_nan=True))
