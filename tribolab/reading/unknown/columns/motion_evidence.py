"""Evidence for positions and speeds from columns of motion and of friction.

See `evidence` for the meaning of a rule.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tribolab.reading.interpret.names import is_axis, is_stroke_frequency, is_stroke_length
from tribolab.reading.lexicon.lexicon import normalise_label, part_pattern
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.evidence import RULED_OUT, Evidence, Facts, Rule
from tribolab.reading.unknown.columns.rotating_parts import angle_of
from tribolab.units.quantities import unit_conversion

_MOTION = {"rotation_speed", "sliding_velocity", "position"}
_MIN_ROWS_FOR_ROTATION = 20
_EXPLAINED_BY_ROTATION = 0.98  # share of a displacement's variance
_SMALLEST_TURN = 2 * math.pi * 0.5e-3  # m slid per turn on the smallest track (physics.toml)
_MOVING = 0.2  # of the highest speed; below it, the friction may be reversing
_MIN_TURNS = 2  # fewest reversals, as a single one might be chance
_AGREES = 0.9  # mean product of the signs: 95 % of the rows agree


def direction_evidence(facts: Facts) -> Iterator[Evidence]:
    """Take a length as the position if friction reverses whenever the length does.

    Friction opposes sliding. File: Bruker UMT, "Y" next to "Fx" (okilitive/CETR-tribometer).
    """
    if facts.kind != "run" or any(map(facts.places, _MOTION)):
        return
    for force in facts.places("friction_force"):
        for place, (_, unit, _) in enumerate(facts.bare):
            if facts.options[place] or unit is None or not converts(unit, "m"):
                continue
            rate = np.gradient(facts.numbers[:, place])
            moving = np.abs(rate) > _MOVING * np.nanmax(np.abs(rate), initial=0.0)
            way, drag = np.sign(rate[moving]), np.sign(facts.numbers[moving, force])
            turns = np.count_nonzero(np.diff(way))
            if turns >= _MIN_TURNS and abs(np.mean(way * drag)) > _AGREES:
                why = "the friction turns with it"
                yield Evidence(place, "position", 0.0, why, proposes=True, sure=True)


def distance_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out a length as the position if it only grows while another position reverses."""
    steps = {
        place: np.diff(facts.numbers[np.isfinite(facts.numbers[:, place]), place])
        for place in facts.places("position")
    }
    if any((moved < 0).any() and (moved > 0).any() for moved in steps.values()):
        for place, moved in steps.items():
            if moved.size and (moved >= 0).all():
                yield Evidence(place, "", RULED_OUT, "it is the distance travelled")


def motion_evidence(facts: Facts) -> Iterator[Evidence]:
    """Take a displacement as perpendicular to the motion if another column gives the motion."""
    if not any(facts.any_named(name) for name in _MOTION):
        return
    for place, options in enumerate(facts.options):
        either = {option.quantity for option in options} == {"position", "height_displacement"}
        if either and not facts.is_named(place):
            why = "another column gives the motion"
            yield Evidence(place, "position", RULED_OUT, why)
            yield Evidence(place, "height_displacement", 0.0, why, sure=True)


def stroke_setting_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out stroke lengths as positions, and stroke frequencies as rotation speeds.

    File: an Optimol SRV export, which repeats both in each row.
    """
    lengths = {place for place, (name, _, _) in enumerate(facts.bare) if is_stroke_length(name)}
    often = {p for p, (name, unit, _) in enumerate(facts.bare) if is_stroke_frequency(name, unit)}
    for place in lengths | often if lengths and often else ():
        yield Evidence(place, "", RULED_OUT)


def stage_axis_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out the axes of a machine's stage as sliding positions if something rotates.

    Files: Rtec MFT, "XYZ.X Position", and "Rotary.Position", which is an angle without a unit
    (Dichimanaym/Tribometer-Data-Processing).
    """
    for place in facts.places("position"):
        name, unit, _ = facts.bare[place]
        if unit is None and part_pattern("turns_in_angles").search(normalise_label(name)):
            yield Evidence(place, "position", RULED_OUT, "the position of what turns: an angle")
    if facts.places("rotation_speed") or angle_of(facts.columns) is not None:
        for place in facts.places("position"):
            if is_axis(facts.bare[place][0]):
                yield Evidence(place, "position", RULED_OUT)


def rotation_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out a length as the position if it does not grow with the recorded rotation."""
    turning, ways = facts.places("rotation_speed"), facts.places("position")
    turning = [place for place in turning if facts.bare[place][1] is not None]
    ways = [place for place in ways if not is_axis(facts.bare[place][0])]
    if facts.kind != "run" or len(turning) != 1 or len(ways) != 1:
        return
    rate, way = facts.numbers[:, turning[0]], facts.numbers[:, ways[0]]
    known = np.isfinite(rate) & np.isfinite(way)
    rate, way = rate[known], way[known]
    if known.sum() < _MIN_ROWS_FOR_ROTATION or not rate.any():
        return
    if _length_per_turn(facts, turning[0], ways[0]) < _SMALLEST_TURN:
        yield Evidence(ways[0], "position", RULED_OUT, "the rotation slides much farther")
    elif _explained(way, np.cumsum(rate)) > _EXPLAINED_BY_ROTATION:
        yield Evidence(ways[0], "position", 0.0, sure=True)
    elif _explained(np.abs(way), np.cumsum(np.abs(rate))) > _EXPLAINED_BY_ROTATION:
        why = "the distance slid whatever the direction; the rotation gives the speed"
        yield Evidence(ways[0], "", RULED_OUT, why)
    else:
        why = "a length that does not grow with the rotation: not the distance slid"
        yield Evidence(ways[0], "", RULED_OUT, why)


def _length_per_turn(facts: Facts, turning: int, way: int) -> float:
    """Return how much a length column changes per turn [m]; infinity if time is not recorded.

    File: a T-11 pin-on-disc tester, whose "Displacement [um]" is the wear.
    """
    clocks = [p for p in facts.places("time") if facts.bare[p][1] is not None]
    if len(clocks) != 1:
        return math.inf
    units = [(clocks[0], "time"), (turning, "rotation_speed"), (way, "position")]
    scales = [unit_conversion(str(facts.bare[p][1]), name)[0] for p, name in units]
    time, rate, length = (k * facts.numbers[:, p] for (p, _), k in zip(units, scales, strict=True))
    turned = np.nansum(np.abs(rate[1:]) * np.diff(time)) / (2 * math.pi)
    return float(np.nansum(np.abs(np.diff(length))) / turned) if turned > 1 else math.inf


def _explained(way: np.ndarray, turns: np.ndarray) -> float:
    """Return the share of a length's variance that the number of turns explains.

    Jumps, as from a restarted counter, are ignored.
    """
    if not np.ptp(turns) > 0 or not np.ptp(way) > 0:
        return 0.0
    steps, by_turns = np.diff(way), np.diff(turns)
    usual = np.abs(steps) < 100 * np.median(np.abs(steps[steps != 0]))
    way, turns = np.cumsum(np.where(usual, steps, 0)), np.cumsum(np.where(usual, by_turns, 0))
    if not np.ptp(turns) > 0 or not np.ptp(way) > 0:
        return 0.0
    return float(np.corrcoef(way, turns)[0, 1] ** 2)


MOTION_RULES: tuple[Rule, ...] = (
    direction_evidence,
    distance_evidence,
    motion_evidence,
    stroke_setting_evidence,
    stage_axis_evidence,
    rotation_evidence,
)
