"""Section [speed] of a drafted dialect, from the rule that gives the sliding speed."""

from __future__ import annotations

import re

import numpy as np

from tribolab.arrays.reversals import reversals
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.derive import Derivation, derive
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, part_pattern
from tribolab.reading.runs.stroke_speed import DENSEST
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.derivations.known_amounts import KnownRun, is_steady
from tribolab.reading.unknown.derivations.model import DraftedFormula, Follows, Source, SpeedBy
from tribolab.reading.unknown.derivations.stated_lines import confirmed_value
from tribolab.reading.unknown.header.run_amounts import stated_rotation
from tribolab.reading.unknown.header.settings import text_settings
from tribolab.reading.unknown.header.stroke_settings import Strokes
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Understood
from tribolab.units.conversion import conversion
from tribolab.units.quantities import unit_conversion

_ANOTHER_SPEED = re.compile(
    r"\b(?:max\w*|min(?:imum|imal)\w*|limit\w*|return\w*|approach\w*|feed\w*|rück\w*|retour\w*|idle\w*"
    r"|top)\b",
    re.IGNORECASE,
)


def add_speed(result: Follows, layout: Layout, understood: Understood, known: KnownRun) -> Follows:
    """Add the sliding speed to the derived quantities, unless a column contains it."""
    agreed = confirmed_value(known.values, understood.agreed, "speed")
    if agreed is not None:
        said = agreed._replace(name="set_speed", unit=agreed.own_unit, to=None, guess="")
        return result.with_values(said)._replace(speed=SpeedBy("set speed"))
    if understood.speed:
        about = "it was said that it slides so fast all along"
        formula = DraftedFormula("set_speed", f"'{understood.speed}'", about)
        speed = SpeedBy("set speed")
        return result._replace(formulas=(*result.formulas, formula), speed=speed)
    sliding = derive("sliding_velocity", known.given, known.facts)
    if sliding is None:
        return result.with_values(known.crank)
    if sliding.rule is None:
        return result.with_values(stated_rotation(known.values))
    if sliding.rule.speed == "position":
        return _by_position(result, sliding, understood, known)
    if sliding.rule.speed == "rotation":
        return _by_rotation(result, sliding)
    if sliding.rule.speed == "set speed":
        return _by_set_speed(result, sliding, steady=is_steady(understood))
    if sliding.rule.speed == "stroke" and known.strokes is not None:
        return _by_strokes(result, known.strokes, layout, understood, sliding)
    result = result.add_derivation(sliding)._replace(speed=SpeedBy("none"))
    rotation = known.given.get("set_rotation")
    if sliding.is_doubtful and rotation is not None and isinstance(rotation.source, Amount):
        about = "is how fast it turns all along"
        result = result._replace(speed=_asked(SpeedBy("none"), rotation.source, about))
    rolling = derive("rolling_speed", known.given, known.facts)
    if rolling is not None and rolling.rule is not None:
        result = result.add_derivation(rolling, "their mean speed")
    return result


def _by_position(
    result: Follows, sliding: Derivation[Source], understood: Understood, known: KnownRun
) -> Follows:
    """Compute the speed from the position; keep a stated speed of strokes for comparison.

    File: "x-velocity [mm/s]: 100" above strokes of 35 mm/s (liampond/EgbertsTribometer).
    """
    (position,) = sliding.needs
    if position.rule is None:
        column = position.given.source if position.given is not None else None
        stated = [v for v in known.values if v.name == "set_speed"]
        alone = len(stated) == 1 and not _ANOTHER_SPEED.search(stated[0].text)
        if not alone or not isinstance(column, DraftColumn):
            return result
        way = understood.numbers[:, column.place - 1]
        kept = stated[0]._replace(name="stated_speed", to="m/s", unit=stated[0].own_unit)
        return result.with_values(kept) if reversals(way - np.nanmean(way)) else result
    return result.add_derivation(position)._replace(speed=SpeedBy("position"))


def _by_rotation(result: Follows, sliding: Derivation[Source]) -> Follows:
    """Compute the speed from rotation and track radius; with a radius per step, by a formula."""
    track = next(need for need in sliding.needs if need.quantity == "track_radius")
    radius = track.given
    if radius is not None and radius.source is None:
        return result._replace(speed=SpeedBy("rotation", (("radius", radius.symbol.strip("'")),)))
    if radius is not None and isinstance(radius.source, Amount):
        if radius.source.source != "step":
            speed = SpeedBy("rotation", (("radius_value", radius.symbol),))
            return result.with_values(radius.source)._replace(speed=speed)
    return result.add_derivation(sliding)._replace(speed=SpeedBy("none"))


def _by_set_speed(result: Follows, sliding: Derivation[Source], *, steady: bool) -> Follows:
    """Take the stated speed as that of the run; ask the user unless rotation is `steady`."""
    (stated,) = (leaf.source for leaf in sliding.leaves)
    if not isinstance(stated, Amount):
        return result
    speed = SpeedBy("set speed")
    if not steady or _ANOTHER_SPEED.search(stated.text):
        speed = _asked(speed, stated, "is the sliding speed all along")
    return result.with_values(stated)._replace(speed=speed)


def _asked(speed: SpeedBy, value: Amount, about: str) -> SpeedBy:
    """Add the question whether a stated speed applies to the whole run, unless that is clear."""
    its = key_pattern("own_speed").search(value.key) and not _ANOTHER_SPEED.search(value.text)
    if value.source == "step" or its:
        return speed
    text = value.text
    if value.source == "file name" and (match := re.search(value.pattern, text)):
        text = match[0].strip("_.")
    return speed._replace(guess=f"'{text}' {about}", options=("not known",))


def _by_strokes(
    result: Follows,
    strokes: Strokes,
    layout: Layout,
    understood: Understood,
    sliding: Derivation[Source],
) -> Follows:
    """Compute the speed from strokes; ask whether a crank drives them if the text does not say."""
    result = result.with_values(*strokes.values).with_symbols(*strokes.symbols)
    if sliding.rule is not None and sliding.rule.condition == "crank":
        settings = (*strokes.settings, ("drive", "crank"))
        return result._replace(speed=SpeedBy("stroke", settings, strokes.guess))
    drive, guesses = understood.drive, [strokes.guess] if strokes.guess else []
    options: tuple[str, ...] = ()
    said = _drive_texts(layout, strokes)
    if not drive and any(part_pattern("even_speed").search(text) for text in said):
        drive = "constant speed"
    elif not drive and _rows_are_means(understood, strokes):
        drive = "constant speed"
    elif not drive and not any(part_pattern("sine").search(text) for text in said):
        guesses.insert(0, "a crank drives it: the speed is a sine")
        options = ("constant speed",)
    settings = (*strokes.settings, ("drive", drive or "crank"))
    return result._replace(speed=SpeedBy("stroke", settings, "; ".join(guesses), options))


def _rows_are_means(understood: Understood, strokes: Strokes) -> bool:
    """Whether rows are too sparse to resolve strokes, so that each shows a mean over strokes.

    File: Phoenix TE 77 (Compend 2000), a row of means every few seconds.
    """
    clock = next((c for c in understood.columns if c.used and c.quantity == "time"), None)
    if clock is None or len(understood.numbers) < 2:
        return False
    scale = unit_conversion(clock.read_unit or "s", "time")[0]
    interval = scale * np.nanmedian(np.diff(understood.numbers[:, clock.place - 1]))
    often = [value.si("Hz") for value in strokes.values if value.is_in("Hz")]
    for symbol, column in strokes.symbols:
        unit = column.file_unit or column.unit
        if symbol == "stroke_frequency" and unit is not None and converts(unit, "Hz"):
            values = understood.numbers[:, column.place - 1] * conversion(unit, "Hz")[0]
            often.append(float(np.nanmedian(values)))
    return len(often) == 1 and interval * often[0] > 1 / DENSEST


def _drive_texts(layout: Layout, strokes: Strokes) -> list[str]:
    """Return the normalised texts that state how the strokes are driven."""
    said = []
    for key, text in text_settings(layout):
        name, words = normalise_label(key), normalise_label(text)
        if key_pattern("drive").search(name):
            said.append(words)
        # of a mode or stroke only a sine counts: "constant load" is a mode, too
        elif key_pattern("mode").search(name) or key_pattern("stroke").search(name):
            said += [words] if part_pattern("sine").search(words) else []
    return said + [normalise_label(v.text) for v in strokes.values if v.source == "file name"]
