"""What follows from columns and settings where no column holds it: speed, friction, load."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.bridges import calibrated_forces
from tribolab.draft.columns.counts import zero_in_counts
from tribolab.draft.columns.gains import stated_gains
from tribolab.draft.columns.lengths import find_arm, find_radius, on_rim
from tribolab.draft.columns.programme import programme_of
from tribolab.draft.columns.slip import stated_ratio
from tribolab.draft.columns.stated_load import find_load
from tribolab.draft.columns.stated_words import PER_MINUTE
from tribolab.draft.columns.stated_zero import find_zero, reading_of, zero_in_doubt
from tribolab.draft.columns.stroke_settings import as_stated, strokes_of, strokes_of_turns
from tribolab.draft.columns.strokes import STROKE
from tribolab.draft.columns.turning import angle_of, radius_of, torque_of, turns_of
from tribolab.draft.columns.values import DraftValue, find_values, words_said
from tribolab.draft.columns.words import or_term, squeezed
from tribolab.draft.file.header import escaped
from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.model import WHICH_FORCE, DraftColumn, Understood
from tribolab.errors import shown
from tribolab.io.missing import missing_of

_DRIVE = re.compile(
    r"drive|motion|waveform|profile|kinematic|antrieb|bewegung|entrainement|mouvement|movim(?:ento|iento)"
    r"|^moto$|^ruch|hareket|движен|привод|pohyb|pohon|napęd|naped|beweging|aandrijving|forma?(?:de|da|d)onda|formeonde|运动|運動"
)
_SINE = re.compile(
    r"crank|manovell|manivel|biel|armonic|harmoni|krank|korb|vev|veiv|krumtap|kampi|klik|forgatty|кривошип|синус|曲柄|正弦|クランク|sine|sinus|sinoid|kurbel|eccentric|exzenter|manivelle|scotch"
)
_EVEN = re.compile(r"triang|constant|linear|konstant|dreieck")
CRANK = "drive"  # the value that says of a run what turns there
_MODE = re.compile(r"^(?:test|sliding)?mode$|^modus$|^betriebsart$|^modo$|模式$|モード$")
_SPEED_OF_TURNS = or_term(
    r"(?:speed|velocity|rotation|rpm|drehzahl|vitesse|giri|velocidad)$",
    "rotation_speed",
)
# what nothing else may be than how fast it slides or turns
_ITS_SPEED = or_term(
    r"^(?:test|set|nominal|sliding|gleit|linear|surface|crosshead|stage|track|rotary|rotation(?:al)?|spindle|dis[ck])?"
    r"(?:speed|velocity|rpm|geschwindigkeit|drehzahl|rotation)$",
    "sliding_velocity",
    "rotation_speed",
)
_ANOTHER_SPEED = re.compile(
    r"\b(?:max\w*|min(?:imum|imal)\w*|limit\w*|return\w*|approach\w*|feed\w*|rück\w*|retour\w*|idle\w*"
    r"|top)\b",
    re.IGNORECASE,
)
_STEP = re.compile(rf"^{STEP_WORD}\d*n?$")
_SAYS_SPEED = {"sliding_velocity", "position", "set_speed"}
SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}


class DraftedFormula(NamedTuple):
    """A quantity that follows: its name, the formula, and what it rests on."""

    quantity: str
    formula: str
    about: str


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
    values: tuple[DraftValue, ...] = ()
    speed: SpeedBy | None = None
    zero_in_doubt: DraftValue | None = None


def what_follows(layout: Layout, understood: Understood) -> Follows:
    """Find out what follows of a run where no column holds it.

    Parameters
    ----------
    layout, understood
        What was found out about the file.

    Notes
    -----
    Only what is stated with its unit is used: a torque and the radius of the track, or its arm; the
    radius and a rotation or an angle; rolling speed and slide-to-roll ratio; stroke and frequency;
    a load or the mass of a sled, where no column measures the normal force.
    """
    if understood.kind != "run":
        return Follows()
    # with a unit still to be filled in, a column is there all the same
    names = {c.quantity for c in understood.columns if c.quantity and (c.used or c.fill_in)}
    values = find_values(layout)
    if "step" in names:
        values += programme_of(layout)
    track = _track(values, understood, rim=on_rim(layout))
    result = Follows()
    timed = "time" in names or understood.rate_pattern or understood.rate
    # rows that are counted as seconds make no speed of a position
    says_speed = _SAYS_SPEED if timed else _SAYS_SPEED - {"position"}
    # what is set, and a way of whatever, give way to what turns; what is set to what drives, too
    turned = "rotation_speed" in names and bool(track.formula)
    says_speed = says_speed - ({"set_speed", "position"} if turned else {"set_speed"})
    if understood.speed:
        about = "it was said that it slides so fast all along"
        result = _and(result, DraftedFormula("set_speed", f"'{understood.speed}'", about))
        result = result._replace(speed=SpeedBy("set speed"))
    elif not names & says_speed:
        result = _with_speed(result, names, values, understood, words_said(layout), track)
    torque = torque_of(understood.columns)
    if not names & SAYS_FRICTION and torque is not None:
        arm = track if track.formula else _of_value(find_arm(values))
        if arm.formula:
            zero = find_zero(layout, values, "N m", understood.zero)
            about = "a torque and a radius" + (f", and '{zero.text}'" if zero else "")
            net = f"(torque - {zero.name})" if zero else "torque"
            formula = DraftedFormula("friction_force", f"{net} / {arm.formula}", about)
            used = arm.values if zero is None else (*arm.values, zero)
            result = _and(result, formula, used, (("torque", torque), *arm.symbols))
            names.add("friction_force")
            doubt = zero_in_doubt(layout, values, "N m", understood.zero)
            result = result._replace(zero_in_doubt=doubt)
    reading = reading_of(understood.columns)
    zero = None if reading is None else find_zero(layout, values, "N", understood.zero)
    if reading is not None and zero is None:  # what a converter counts was not tared
        zero = zero_in_counts(values, reading, understood.numbers[:, reading.place - 1])
    if reading is not None:
        doubt = zero_in_doubt(layout, values, "N", understood.zero)
        result = result._replace(zero_in_doubt=doubt)
    if reading is not None and zero is not None:
        what = f"friction_reading - {zero.name}"
        formula = DraftedFormula("friction_force", what, f"'{zero.text}'")
        result = _and(result, formula, [zero], (("friction_reading", reading),))
    gains = stated_gains(layout, understood.columns)
    for gain in gains:
        if gain.quantity == "position" and (result.speed is not None or names & _SAYS_SPEED):
            continue
        formula = DraftedFormula(gain.quantity, gain.formula, gain.about)
        result = _and(result, formula, gain.values, ((gain.symbol, gain.column),))
        names.add(gain.quantity)
        if gain.quantity == "position" and timed:
            result = result._replace(speed=SpeedBy("position"))
    made = {gain.quantity for gain in gains}
    for force in calibrated_forces(layout, understood.columns):
        if force.quantity in made:
            continue
        about = f"a signal in volts, and '{force.value.text}'"
        formula = DraftedFormula(force.quantity, force.formula, about)
        result = _and(result, formula, [force.value], ((force.symbol, force.column),))
        names.add(force.quantity)
    if understood.load and names & SAYS_FRICTION and not names & SAYS_LOAD:
        about = "it was said that the load is so all along"
        return _and(result, DraftedFormula("normal_force", f"'{understood.load}'", about))
    if "set_normal_force" in names and names & SAYS_FRICTION and not names & SAYS_LOAD:
        about = "nothing measures it: the load that was set"
        return _and(result, DraftedFormula("normal_force", "set_normal_force", about))
    if "position" in names and result.speed is None:
        result = result._replace(values=(*result.values, *as_stated(values)))
    load = find_load(values)
    if load is not None and names & SAYS_FRICTION and not names & SAYS_LOAD:
        about = f"nothing measures it: '{load.text}' is taken for all of the run"
        result = _and(result, DraftedFormula("normal_force", load.name, about), [load])
    elif load is not None and not names & {"normal_force", "normal_stress", "set_normal_force"}:
        result = result._replace(values=(*result.values, load))  # under which a coefficient stands
    return result


def lacking(understood: Understood, follows: Follows) -> list[str]:
    """Say what a friction coefficient over speed needs, and neither columns nor text hold.

    Parameters
    ----------
    understood, follows
        What was found out about the file.
    """
    # with a unit still to be filled in, or of two meanings, a column is there all the same
    names = {c.quantity for c in understood.columns if c.quantity and (c.used or c.fill_in)}
    names |= {formula.quantity for formula in follows.formulas}
    if any(c.fill_in == WHICH_FORCE.format(shown(c.label)) for c in understood.columns):
        names |= {"friction_force", "normal_force"}  # it is asked which of both
    if follows.speed is not None and follows.speed.source != "none":
        names.add("sliding_velocity")
    if any(value.name == "set_normal_force" for value in follows.values):
        names.add("normal_force")
    if any(value.name == CRANK for value in follows.values):
        names.add("crank")
    if _angle(understood) is not None:
        names.add("rotation_speed")  # the radius makes a position of it
    if torque_of(understood.columns) is not None:
        names.add("torque")
    elif unknown_of(understood.columns):
        names.add("friction_force")  # it is asked whether one of them holds it
    return missing_of(names)


def unknown_of(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns of which nothing is known, but those of what turns.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    turning = (torque_of(columns), angle_of(columns), radius_of(columns))
    places = {column.place for column in turning if column is not None}
    unknown = (c for c in columns if c.note and not c.quantity and c.label)
    return [column for column in unknown if column.place not in places]


class _Track(NamedTuple):
    """A radius as it stands in a formula, and the value or the column that it rests on."""

    formula: str = ""
    values: tuple[DraftValue, ...] = ()
    symbols: tuple[tuple[str, DraftColumn], ...] = ()


def _of_value(value: DraftValue | None) -> _Track:
    return _Track() if value is None else _Track(value.name, (value,))


def _track(values: Sequence[DraftValue], understood: Understood, *, rim: bool) -> _Track:
    """Return the radius of the track: what a person said, a column, or what the text states."""
    if understood.radius:
        return _Track(f"'{understood.radius}'")
    column = radius_of(understood.columns)
    if column is not None:
        return _Track("radius", symbols=(("radius", column),))
    return _of_value(find_radius(values, rim=rim))


def _and(
    before: Follows,
    formula: DraftedFormula,
    values: Sequence[DraftValue] = (),
    symbols: tuple[tuple[str, DraftColumn], ...] = (),
) -> Follows:
    return before._replace(
        formulas=(*before.formulas, formula),
        symbols=tuple(dict.fromkeys((*before.symbols, *symbols))),
        values=tuple(dict.fromkeys((*before.values, *values))),
    )


def _with_speed(
    before: Follows,
    names: set[str],
    values: Sequence[DraftValue],
    understood: Understood,
    words: Sequence[tuple[str, str]],
    track: _Track,
) -> Follows:
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
    if turning and any(value.source == "step" for value in track.values):
        about = "turns and the radius of each step"
        formula = DraftedFormula("sliding_velocity", f"rotation_speed * {track.formula}", about)
        return _and(before, formula, track.values)._replace(speed=SpeedBy("none"))
    if turning and track.values:
        speed = SpeedBy("rotation", (("radius_value", track.formula),))
        return before._replace(speed=speed, values=(*before.values, *track.values))
    if turning and track.symbols:
        formula = DraftedFormula(
            "sliding_velocity", "rotation_speed * radius", "turns and a radius"
        )
        return _and(before, formula, (), track.symbols)._replace(speed=SpeedBy("none"))
    angle = None if turning or not track.formula else _angle(understood)
    if angle is not None:
        formula = DraftedFormula("position", f"angle * {track.formula}", "an angle and a radius")
        symbols = (("angle", angle), *track.symbols)
        return _and(before, formula, track.values, symbols)._replace(speed=SpeedBy("position"))
    if {"rolling_speed", "slide_roll_ratio"} <= names:
        about = "the slide-to-roll ratio is the sliding speed over the mean speed of both surfaces"
        formula = DraftedFormula("sliding_velocity", "slide_roll_ratio * rolling_speed", about)
        return _and(before, formula)._replace(speed=SpeedBy("none"))
    ratio = stated_ratio(values) if "rolling_speed" in names else None
    if ratio is not None:
        about = f"'{ratio.text}' is the sliding speed over the mean speed of both surfaces"
        formula = DraftedFormula("sliding_velocity", f"{ratio.name} * rolling_speed", about)
        return _and(before, formula, (ratio,))._replace(speed=SpeedBy("none"))
    of_strokes = strokes_of(values, understood)
    if of_strokes is None or (of_strokes.symbols and "rotation_speed" in names):
        known = turning or "set_speed" in names
        return before if known else _with_set_speed(before, values, track)
    settings = of_strokes.settings
    said = [text.lower() for key, text in words if _DRIVE.search(squeezed(key))]
    modes = [text.lower() for key, text in words if _MODE.search(squeezed(key))]
    # a constant load is a mode, too, and a stroke may be said to be a sine
    lengths = [text.lower() for key, text in words if STROKE.search(squeezed(key))]
    said += [text for text in (*modes, *lengths) if _SINE.search(text)]
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


def _crank(words: Sequence[tuple[str, str]]) -> DraftValue | None:
    """Return what the text says of a crank that drives strokes, to be kept with the run."""
    said = [text for key, text in words if _DRIVE.search(squeezed(key))]
    told = next((text for text in said if _SINE.search(text.lower())), None)
    if told is None:
        return None
    return DraftValue(CRANK, f"({escaped(told)})", None, None, told)


def _is_rotation(value: DraftValue) -> bool:
    step = value.source == "step" and _STEP.search(value.key) is not None
    named = step or value.source == "programme" or _SPEED_OF_TURNS.search(value.key) is not None
    return named and PER_MINUTE.fullmatch(value.own_unit or "") is not None


def _angle(understood: Understood) -> DraftColumn | None:
    columns = understood.columns
    return angle_of(columns) or turns_of(columns, understood.numbers)


def _with_set_speed(before: Follows, values: Sequence[DraftValue], track: _Track) -> Follows:
    """Let the speed that the text states be that of the run, which is asked about."""
    stated = [value for value in values if value.name == "set_speed"]
    turns = [value for value in values if _is_rotation(value)]
    if not stated and len(turns) == 1 and track.values:
        about = f"'{turns[0].text}' and the radius of the track"
        rate = turns[0]._replace(unit="rpm", to="rad/s", name="rotation")
        formula = DraftedFormula("sliding_velocity", f"rotation * {track.formula}", about)
        guess = f"'{turns[0].text}' is how fast it turns all along"
        speed = _asked_of(SpeedBy("none"), turns[0], guess)
        return _and(before, formula, (rate, *track.values))._replace(speed=speed)
    if len(stated) != 1:
        return before
    guess = f"'{stated[0].text}' is the sliding speed all along"
    speed = _asked_of(SpeedBy("set speed"), stated[0], guess)
    return before._replace(speed=speed, values=(*before.values, stated[0]))


def _asked_of(speed: SpeedBy, value: DraftValue, guess: str) -> SpeedBy:
    """Ask whether a speed of some name holds all along; what each step states holds in it."""
    its = _ITS_SPEED.search(value.key) and not _ANOTHER_SPEED.search(value.text)
    if value.source in ("step", "programme") or its:
        return speed
    return speed._replace(guess=guess, options=("not known",))
