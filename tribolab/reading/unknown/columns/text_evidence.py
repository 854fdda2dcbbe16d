"""Evidence on columns in the text of a file: axes of a sensor, and the stated load."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.lexicon.lexicon import UNPARTED, normalise_label, part_pattern, role_of
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.evidence import (
    BOTH_FORCES,
    FRICTION,
    RULED_OUT,
    Evidence,
    Facts,
    Rule,
)
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.header.run_amounts import find_arm, find_load
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Reason
from tribolab.units.quantities import unit_conversion

_AXIS = re.compile(r"(?:f|force|kraft|sila|forza)?(?:[xyz]|[1-3])")  # axes of a force sensor
_WORDS = rf"(?:[^\W\d][^;|,；，]|[{UNPARTED}])[^;|,；，]{{1,60}}"
_KNOWN_SHARE = 0.3  # least share of an explanation that a known word covers
_LETTERS_OF_NAME = 4  # least letters of a name that is searched for in the text
_STATED = 8.0  # log odds of an explicit statement in the text
_BY_LOAD = 3.0  # log odds if a reading is compared with the stated load
_LOADED = 0.4  # of the largest reading; above it, the contact is loaded
_MAX_READINGS = 0.98  # quantile that is taken as the largest reading: few outliers exceed it
_MOTION = ("position", "sliding_velocity", "set_speed")
_MAX_OF_SLED = 5.0  # largest coefficient of friction of a dry sled
_READS_LOAD = (0.75, 1.33)  # ratio of reading to stated load, if the cell measures the load


def legend_evidence(layout: Layout) -> Rule:
    """Return the rule that identifies sensor axes by the text: "Fx = vertical"."""

    def rule(facts: Facts) -> Iterator[Evidence]:
        if facts.kind != "run":
            return
        lines = layout.sentences()
        for place in range(len(facts.columns)):
            about = _explanation(facts.bare[place][0], lines) if _is_axis(facts, place) else ""
            if not about:
                continue
            said = f"the text names it: '{shown(about, 40)}'"
            options = [o.quantity for o in matches(about, "N") if o.score >= _KNOWN_SHARE]
            if options and options[0] in BOTH_FORCES:
                yield Evidence(place, options[0], _STATED, said, proposes=True, sure=True)
                other = BOTH_FORCES[options[0] == BOTH_FORCES[0]]
                yield Evidence(place, other, RULED_OUT, said)
            else:
                yield Evidence(place, "", 0.0, doubt=f"{said}, in words that are not known")

    return rule


def _is_axis(facts: Facts, place: int) -> bool:
    name, unit, _ = facts.bare[place]
    return bool(_AXIS.fullmatch(normalise_label(name))) and unit is not None and converts(unit, "N")


def _explanation(name: str, lines: Sequence[str]) -> str:
    """Return how a line explains a column name: "Fx = vertical", or "vertical force (Fx)"."""
    name = re.escape(name.strip())
    after = re.compile(
        rf"(?<![^\W_]){name}(?![^\W_])\s{{0,3}}[=:：＝–—-]\s{{0,3}}(?P<about>{_WORDS})"
    )
    before = re.compile(rf"(?P<about>[^\W\d][^;|,()]{{2,40}})\(\s*{name}\s*\)")
    for line in lines:
        if match := after.search(line) or before.search(line):
            return match["about"].strip()
    return ""


def stated_load_evidence(layout: Layout) -> Rule:
    """Return the rule that a force is the load if it reads the stated load, else friction."""

    def rule(facts: Facts) -> Iterator[Evidence]:
        cells = _undecided_cells(facts) if facts.kind == "run" else []
        if len(cells) != 1:
            return
        place = cells[0]
        stated = numeric_settings(layout)
        load = find_load(stated)
        if load is None:
            if _is_called_force(facts, place) and any(map(facts.places, _MOTION)):
                why = "it is the only force on what slides; the load is not stated"
                yield Evidence(place, "friction_force", _BY_LOAD, why, proposes=True, sure=True)
            elif _is_load_of_tester(facts, place) and torque_of(facts.columns) is None:
                # "Load" of a testing machine may be the force that pulls
                doubt = "it is the normal force, although no other column is the friction"
                yield Evidence(place, "normal_force", 0.0, doubt=doubt)
            return
        # a sled is pressed by its weight, which no cell measures
        sled = part_pattern("sled").search(normalise_label(load.text)) is not None
        share = _share_of_load(facts, place, load)
        if not 0 < share < (_MAX_OF_SLED if sled else _READS_LOAD[1]):
            return
        presses = share > _READS_LOAD[0] and not sled
        if presses and not facts.is_either_force(place):
            return
        name, other = BOTH_FORCES[presses], BOTH_FORCES[not presses]
        why = f"'{load.text}' is the load"
        doubt = f"it is the friction force: {why}"
        if presses:
            why = doubt = f"it is the normal force: it reads what '{load.text}' says"
        # on a lever arm, the reading is not the friction force
        only = _is_called_force(facts, place) and find_arm(stated) is None
        sure = not presses and (sled or only)
        yield Evidence(
            place, name, _BY_LOAD, why, proposes=True, sure=True, doubt="" if sure else doubt
        )
        yield Evidence(place, other, RULED_OUT)

    return rule


def _undecided_cells(facts: Facts) -> list[int]:
    """Return the indices of force columns that the stated load may identify."""
    places = range(len(facts.columns))
    either = [place for place in places if facts.is_either_force(place)]
    held = {o[0].quantity for p, o in enumerate(facts.options) if o and p not in either}
    if not either and not held & FRICTION:  # "Load" of a testing machine that pulls a sled
        either = facts.places("normal_force")
    if not either and "normal_force" not in held:  # "Force" of a rig with a dead weight
        named = [place for place in places if _is_called_force(facts, place)]
        either = [p for p in named if p in facts.places("friction_force") and not facts.is_named(p)]
        if not either and not held & FRICTION:
            either = [p for p in named if converts(facts.bare[p][1] or "", "N")]
    return either


def _is_called_force(facts: Facts, place: int) -> bool:
    name = normalise_label(facts.bare[place][0])
    return part_pattern("force_name").fullmatch(name) is not None


def _is_load_of_tester(facts: Facts, place: int) -> bool:
    """Whether a column has a testing machine's name of its force, and a travel is recorded."""
    name = normalise_label(facts.bare[place][0])
    return bool(facts.places("position")) and bool(part_pattern("tester_load").fullmatch(name))


def _share_of_load(facts: Facts, place: int, load: Amount) -> float:
    """Return the median reading of a cell under load, divided by the stated load."""
    stated = load.value * unit_conversion(load.unit or "N", "normal_force")[0]
    values = facts.numbers[:, place]
    read = np.abs(values[np.isfinite(values)])
    read = read * unit_conversion(facts.bare[place][1] or "N", "normal_force")[0]
    most = float(np.quantile(read, _MAX_READINGS)) if read.size else 0.0
    return float(np.median(read[read > _LOADED * most])) / stated if most > 0 else 0.0


def mean_coefficient_evidence(layout: Layout) -> Rule:
    """Return the rule that ignores the instrument's own coefficient if the forces are known."""

    def rule(facts: Facts) -> Iterator[Evidence]:
        if facts.kind != "run" or not facts.places("friction_force"):
            return
        for place in facts.places("friction_coefficient"):
            if role_of(facts.columns[place].label) not in ("derived", "extreme"):
                continue
            if facts.places("normal_force") or find_load(numeric_settings(layout)) is not None:
                why = "worked out by the instrument; the forces give it"
                yield Evidence(place, "", RULED_OUT, why)

    return rule


def unused_force_columns(
    layout: Layout, columns: Sequence[DraftColumn], used: Collection[int]
) -> list[str]:
    """Return sentences on unused force columns that the text above the table mentions.

    Such a force may have to be subtracted from the friction, or added to it.
    """
    lines = layout.sentences()
    said = []
    for column in columns:
        name, unit, _ = bare_name(column)
        short = normalise_label(name)
        if column.used or column.place in used or len(short) < _LETTERS_OF_NAME:
            continue
        if unit is None or not converts(unit, "N") or column.reason is Reason.TEXT:
            continue
        line = next((line for line in lines if short in normalise_label(line)), "")
        if line:
            what = f"column {column.place} '{shown(name, 20)}' is not used, of which the text says "
            said.append(f"{what}'{shown(line, 60)}'")
    return said
