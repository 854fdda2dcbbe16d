"""How fast it slides, where no column holds it: turns, strokes, two surfaces, or what is set."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.columns.turning import angle_of, torque_of, turns_of
from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.follows.model import CRANK, DraftedFormula, Follows, SpeedBy, Track, and_also
from tribolab.draft.follows.two_bodies import Pair, Radii, along_friction, as_symbol, pair_of
from tribolab.draft.model import DraftColumn, Understood
from tribolab.draft.stated.slip import find_slide_roll_ratio
from tribolab.draft.stated.stated_zero import friction_column
from tribolab.draft.stated.stroke_settings import (
    find_strokes,
    strokes_from_answer,
    strokes_of_turns,
)
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import is_per_minute
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label

_DRIVE = re.compile(
    r"drive|motion|waveform|profile|kinematic|antrieb|bewegung|entrainement|mouvement|movim(?:ento|iento)"
    r"|^moto$|bev[aæ]e?gelse|roerelse|rorelse|^liike|mozgas|^ruch|hareket|движен|привод|pohyb|pohon|napęd|naped|beweging|aandrijving|forma?(?:de|da|d)onda|formeonde|运动|運動"
)
_SINE = re.compile(
    r"crank|manovell|manivel|biel|armonic|harmoni|krank|korb|vev|veiv|krumtap|kampi|klik|forgatty|кривошип|синус|曲柄|正弦|クランク|sine|sinus|sinoid|senoid|seno\b|sinuzo|szinusz|sinimuot|kurbel|eccentric|exzenter|manivelle|scotch"
)
_EVEN = re.compile(r"triang|constant|linear|konstant|dreieck")
_MODE = re.compile(r"^(?:test|sliding)?mode$|^modus$|^betriebsart$|^modo$|模式$|モード$")
_SPEED_OF_TURNS = key_pattern("rotation_speed")
# what nothing else may be than how fast it slides or turns
_ITS_SPEED = key_pattern("own_speed")
_ANOTHER_SPEED = re.compile(
    r"\b(?:max\w*|min(?:imum|imal)\w*|limit\w*|return\w*|approach\w*|feed\w*|rück\w*|retour\w*|idle\w*"
    r"|top)\b",
    re.IGNORECASE,
)
_STEP = re.compile(rf"^{STEP_WORD}\d*n?$")
_SURFACES = ("first_surface", "second_surface")  # symbols of their speeds


def with_speed(
    before: Follows,
    names: set[str],
    values: Sequence[Amount],
    understood: Understood,
    words: Sequence[tuple[str, str]],
    track: Track,
) -> Follows:
    """Add how fast it slides, where no column says so.

    Parameters
    ----------
    before
        What follows so far.
    names
        Quantities that columns hold.
    values, words
        What the text above the table states.
    understood
        The columns.
    track
        The radius of the track.
    """
    turning = "rotation_speed" in names
    crank = _crank(words) if turning and not track.formula else None
    if crank is not None:  # what turns drives strokes
        often = next(c for c in understood.columns if c.quantity == "rotation_speed")
        strokes = strokes_of_turns(values, often)
        if strokes is None:
            return before._replace(values=(*before.values, crank))
        speed = SpeedBy("stroke", (*strokes.settings, ("drive", "crank")), strokes.guess)
        return before._replace(
            speed=speed,
            values=(*before.values, *strokes.values),
            symbols=(*before.symbols, *strokes.symbols),
        )
    if turning and understood.radius:
        return before._replace(speed=SpeedBy("rotation", (("radius", understood.radius),)))
    of_steps = any(value.source in ("step", "programme") for value in track.values)
    if turning and (of_steps or len(track.values) > 1):
        about = (
            "turns and the radius of each step" if of_steps else "turns and a ring's mean radius"
        )
        formula = DraftedFormula("sliding_velocity", f"rotation_speed * {track.formula}", about)
        return and_also(before, formula, track.values)._replace(speed=SpeedBy("none"))
    if turning and track.values:
        speed = SpeedBy("rotation", (("radius_value", track.formula),))
        return before._replace(speed=speed, values=(*before.values, *track.values))
    if turning and track.symbols:
        formula = DraftedFormula(
            "sliding_velocity", f"rotation_speed * {track.formula}", "turns and a radius"
        )
        return and_also(before, formula, (), track.symbols)._replace(speed=SpeedBy("none"))
    angle = None if turning or not track.formula else angle_in(understood)
    if angle is not None:
        formula = DraftedFormula("position", f"angle * {track.formula}", "an angle and a radius")
        symbols = (("angle", angle), *track.symbols)
        return and_also(before, formula, track.values, symbols)._replace(speed=SpeedBy("position"))
    if {"rolling_speed", "slide_roll_ratio"} <= names:
        about = "the slide-to-roll ratio is the sliding speed over the mean speed of both surfaces"
        formula = DraftedFormula("sliding_velocity", "slide_roll_ratio * rolling_speed", about)
        return and_also(before, formula)._replace(speed=SpeedBy("none"))
    ratio = find_slide_roll_ratio(values) if "rolling_speed" in names else None
    if ratio is not None:
        about = f"'{ratio.text}' is the sliding speed over the mean speed of both surfaces"
        formula = DraftedFormula("sliding_velocity", f"{ratio.name} * rolling_speed", about)
        return and_also(before, formula, (ratio,))._replace(speed=SpeedBy("none"))
    of_strokes = find_strokes(values, understood)
    if understood.strokes is not None:
        of_strokes = strokes_from_answer(values, understood.strokes) or of_strokes
    if of_strokes is None or (of_strokes.symbols and "rotation_speed" in names):
        known = turning or "set_speed" in names
        return before if known else _with_set_speed(before, values, track)
    settings = of_strokes.settings
    said = [text.lower() for key, text in words if _DRIVE.search(normalise_label(key))]
    modes = [text.lower() for key, text in words if _MODE.search(normalise_label(key))]
    # a constant load is a mode, too, and a stroke may be said to be a sine
    lengths = [
        text.lower() for key, text in words if key_pattern("stroke").search(normalise_label(key))
    ]
    said += [text for text in (*modes, *lengths) if _SINE.search(text)]
    said += [value.text.lower() for value in of_strokes.values if value.source == "file name"]
    drive, guess = understood.drive or "crank", ""
    options: tuple[str, ...] = ()
    if not understood.drive and any(_EVEN.search(text) for text in said):
        drive = "constant speed"
    elif not understood.drive and not any(_SINE.search(text) for text in said):
        guess, options = "a crank drives it: the speed is a sine", ("constant speed",)
    if of_strokes.guess:
        guess = f"{guess}; {of_strokes.guess}" if guess else of_strokes.guess
    speed = SpeedBy("stroke", (*settings, ("drive", drive)), guess, options)
    return before._replace(
        speed=speed,
        values=(*before.values, *of_strokes.values),
        symbols=(*before.symbols, *of_strokes.symbols),
    )


def surfaces_of(layout: Layout, understood: Understood, names: set[str]) -> Pair | None:
    """Return the speeds of two surfaces, where no column holds how fast they slide."""
    pair = pair_of(layout, understood.columns, understood.numbers)
    held = {column.place for column in understood.columns if column.used}
    taken = names & {"sliding_velocity", "rotation_speed"}
    return None if pair is None or taken or pair.places & held else pair


def with_difference(
    before: Follows,
    names: set[str],
    pair: Pair,
    radii: Radii | None,
    understood: Understood,
) -> Follows:
    """Let two surfaces slide at the difference of their speeds, and roll at the mean."""
    columns = [as_symbol(column) for column in pair.columns]
    symbols = tuple((name, column) for name, (column, _) in zip(_SURFACES, columns, strict=True))
    speeds = [
        f"{factor}{name} * {radius}" if pair.turns and radii is not None else name
        for name, (_, factor), radius in zip(
            _SURFACES, columns, radii.formulas if radii is not None else ("", ""), strict=True
        )
    ]
    less, more = ("+", "-") if pair.opposed else ("-", "+")
    friction = torque_of(understood.columns) or friction_column(understood.columns)
    if not along_friction(pair, radii, understood.numbers, friction):
        speeds = speeds[::-1]
    about = "two surfaces slide at the difference of their speeds"
    values = radii.values if radii is not None else ()
    sliding = DraftedFormula("sliding_velocity", f"{speeds[0]} {less} {speeds[1]}", about)
    result = and_also(before, sliding, values, symbols)._replace(speed=SpeedBy("none"))
    if "rolling_speed" in names:
        return result
    rolling = f"({speeds[0]} {more} {speeds[1]}) / 2"
    return and_also(result, DraftedFormula("rolling_speed", rolling, "their mean speed"))


def _crank(words: Sequence[tuple[str, str]]) -> Amount | None:
    """Return what the text says of a crank that drives strokes, to be kept with the run."""
    said = [text for key, text in words if _DRIVE.search(normalise_label(key))]
    told = next((text for text in said if _SINE.search(text.lower())), None)
    if told is None:
        return None
    return Amount(CRANK, f"({escaped(told)})", None, None, told)


def _is_rotation(value: Amount) -> bool:
    step = value.source == "step" and _STEP.search(value.key) is not None
    named = step or value.source == "programme" or _SPEED_OF_TURNS.search(value.key) is not None
    return named and is_per_minute(value.own_unit or "")


def stated_turns(values: Sequence[Amount]) -> Amount | None:
    """Return the one rotation speed that the text states, as a value of the dialect."""
    turns = [value for value in values if _is_rotation(value)]
    return turns[0]._replace(unit="rpm", to="rad/s", name="rotation") if len(turns) == 1 else None


def angle_in(understood: Understood) -> DraftColumn | None:
    """Return the column that holds an angle, or counts turns and parts of them."""
    columns = understood.columns
    return angle_of(columns) or turns_of(columns, understood.numbers)


def _with_set_speed(before: Follows, values: Sequence[Amount], track: Track) -> Follows:
    """Let the speed that the text states be that of the run, which is asked about."""
    stated = [value for value in values if value.name == "set_speed"]
    rate = stated_turns(values)
    if not stated and rate is not None and track.values:
        about = f"'{rate.text}' and the radius of the track"
        formula = DraftedFormula("sliding_velocity", f"{rate.name} * {track.formula}", about)
        guess = f"'{rate.text}' is how fast it turns all along"
        speed = _asked_of(SpeedBy("none"), rate, guess)
        return and_also(before, formula, (rate, *track.values))._replace(speed=speed)
    if len(stated) != 1:
        return before
    guess = f"'{stated[0].text}' is the sliding speed all along"
    speed = _asked_of(SpeedBy("set speed"), stated[0], guess)
    return before._replace(speed=speed, values=(*before.values, stated[0]))


def _asked_of(speed: SpeedBy, value: Amount, guess: str) -> SpeedBy:
    """Ask whether a speed of some name holds all along; what each step states holds in it."""
    its = _ITS_SPEED.search(value.key) and not _ANOTHER_SPEED.search(value.text)
    if value.source in ("step", "programme") or its:
        return speed
    return speed._replace(guess=guess, options=("not known",))
