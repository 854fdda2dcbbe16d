"""What follows from columns and settings where no column holds it: speed, friction, load."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.turning import (
    angle_of,
    radius_of,
    torque_of,
    turns_of,
    unscaled_torque_of,
)
from tribolab.draft.file.header import escaped
from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.follows.axial import axial_force_of, find_inclined, radius_of_ball
from tribolab.draft.follows.bridges import calibrated_forces, in_volts
from tribolab.draft.follows.from_axis import radius_from_axis
from tribolab.draft.follows.gains import stated_gains
from tribolab.draft.follows.sums import loads_that_add
from tribolab.draft.follows.two_bodies import (
    Pair,
    Radii,
    along_friction,
    as_symbol,
    has_turning_surfaces,
    pair_of,
    radii_of,
    shaft_of_torque,
)
from tribolab.draft.model import NO_NUMBERS, WHICH_FORCE, DraftColumn, Understood
from tribolab.draft.stated.counts import zero_in_counts
from tribolab.draft.stated.lengths import find_arm, find_radius, is_at_arm, on_rim
from tribolab.draft.stated.programme import programme_of
from tribolab.draft.stated.slip import stated_ratio
from tribolab.draft.stated.stated_load import find_load, lifted_on_return
from tribolab.draft.stated.stated_zero import find_zero, reading_of, zero_in_doubt
from tribolab.draft.stated.stroke_settings import as_stated, strokes_of, strokes_of_turns
from tribolab.draft.stated.values import DraftValue, find_values, words_said
from tribolab.draft.words.stated_words import PER_MINUTE
from tribolab.draft.words.strokes import STROKE, is_frequency
from tribolab.draft.words.words import or_term, squeezed
from tribolab.errors import shown
from tribolab.io.dialects.cells import split_name
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
_SURFACES = ("first_surface", "second_surface")  # symbols of their speeds
SAYS_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
SAYS_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}


class DraftedFormula(NamedTuple):
    """A quantity that follows: its name, the formula, what it rests on, where its zero is read.

    With `way` it is so on the way out alone: nothing presses on the way back.
    """

    quantity: str
    formula: str
    about: str
    zero: str = ""
    way: str = ""


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
    if not track.formula:
        away = radius_from_axis(layout, understood.columns, understood.numbers)
        track = _Track(away.formula, (), (("stage", away.column),)) if away else track
    inclined = find_inclined(layout)
    by_angle = inclined is not None and inclined.cosine > 0
    if inclined is not None and not track.formula:
        track = _of_value(radius_of_ball(inclined, values))
    result = Follows()
    timed = "time" in names or understood.rate_pattern or understood.rate
    # rows that are counted as seconds make no speed of a position
    says_speed = _SAYS_SPEED if timed else _SAYS_SPEED - {"position"}
    # what is set, and a way of whatever, give way to what turns; what is set to what drives, too
    turned = "rotation_speed" in names and bool(track.formula)
    says_speed = says_speed - ({"set_speed", "position"} if turned else {"set_speed"})
    pair = _surfaces(layout, understood, names)
    radii = radii_of(pair, values, understood.radius) if pair is not None else None
    if understood.speed:
        about = "it was said that it slides so fast all along"
        result = _and(result, DraftedFormula("set_speed", f"'{understood.speed}'", about))
        result = result._replace(speed=SpeedBy("set speed"))
    elif pair is not None and (radii is not None or not pair.turns):
        result = _with_difference(result, names, pair, radii, understood)
    elif pair is None and not names & says_speed:
        result = _with_speed(result, names, values, understood, words_said(layout), track)
    torque = torque_of(understood.columns)
    if not names & SAYS_FRICTION and torque is not None:
        arm = _of_shaft(layout, pair, radii) if pair is not None and radii is not None else track
        arm = arm if arm.formula else _of_value(find_arm(values))
        if arm.formula:
            zero = find_zero(layout, values, "N m", understood.zero)
            about = "a torque and a radius" + (f", and '{zero.text}'" if zero else "")
            net = f"(torque - {zero.name})" if zero else "torque"
            read = torque.zero if zero is None else ""
            formula = DraftedFormula("friction_force", f"{net} / {arm.formula}", about, read)
            torque = torque._replace(zero="")
            used = arm.values if zero is None else (*arm.values, zero)
            result = _and(result, formula, used, (("torque", torque), *arm.symbols))
            names.add("friction_force")
            doubt = zero_in_doubt(layout, values, "N m", understood.zero)
            result = result._replace(zero_in_doubt=doubt)
    loads = loads_that_add(understood.columns)
    if len(loads) > 1 and "normal_force" not in names:
        symbols = tuple((f"load_{number}", column) for number, column in enumerate(loads, 1))
        together = " + ".join(name for name, _ in symbols)
        about = "loads that add up"
        result = _and(result, DraftedFormula("normal_force", together, about), (), symbols)
        names.add("normal_force")
    reading = reading_of(understood.columns)
    lever = find_arm(values) if reading is not None and is_at_arm(reading) else None
    if reading is not None and lever is not None and track.formula:
        about = f"a force on an arm: '{lever.text}'"
        what = f"arm_force * {lever.name} / {track.formula}"
        symbols = (("arm_force", reading._replace(zero="")), *track.symbols)
        formula = DraftedFormula("friction_force", what, about, reading.zero)
        result = _and(result, formula, (lever, *track.values), symbols)
        reading = None
    zero = None if reading is None else find_zero(layout, values, "N", understood.zero)
    if reading is not None and zero is None:  # what a converter counts was not tared
        zero = zero_in_counts(values, reading, understood.numbers[:, reading.place - 1])
    if reading is not None:
        doubt = zero_in_doubt(layout, values, "N", understood.zero)
        result = result._replace(zero_in_doubt=doubt)
    if reading is not None and zero is not None:
        what = f"friction_reading - {zero.name}"
        formula = DraftedFormula("friction_force", what, f"'{zero.text}'")
        result = _and(result, formula, [zero], (("friction_reading", reading._replace(zero="")),))
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
        pressed = "set_normal_force"
        pressed = inclined.load(pressed) if inclined is not None and inclined.cosine else pressed
        return _and(result, DraftedFormula("normal_force", pressed, about))
    if "position" in names and result.speed is None:
        result = result._replace(values=(*result.values, *as_stated(values)))
    load = find_load(values)
    axial = axial_force_of(understood.columns)
    if inclined is not None and by_angle and axial is not None and _of_forces(names):
        about = f"the contacts carry more than the axial force: '{inclined.text}'"
        formula = DraftedFormula("normal_force", inclined.load("axial_force"), about)
        result = _and(result, formula, (), (("axial_force", axial),))
    elif load is not None and names & SAYS_FRICTION and not names & SAYS_LOAD:
        about = f"nothing measures it: '{load.text}' is taken for all of the run"
        pressed = inclined.load(load.name) if inclined is not None and by_angle else load.name
        out = "position" in names and lifted_on_return(layout)
        about += ", but for ways back, on which it is lifted" if out else ""
        formula = DraftedFormula("normal_force", pressed, about, way="out" if out else "")
        result = _and(result, formula, [load])
    elif load is not None and not names & {"normal_force", "normal_stress", "set_normal_force"}:
        result = result._replace(values=(*result.values, load))  # under which a coefficient stands
    return result


def _of_forces(names: set[str]) -> bool:
    """Whether a friction coefficient is that of two forces, and not the instrument's own."""
    return "friction_force" in names and "friction_coefficient" not in names


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
    if _angle(understood) is not None or has_turning_surfaces(understood.columns):
        names.add("rotation_speed")  # the radius makes a position, or a speed, of it
    reading = reading_of(understood.columns)
    made = any(formula.quantity == "friction_force" for formula in follows.formulas)
    if reading is not None and is_at_arm(reading) and not made:
        names.remove("friction_force")  # without the radius an arm's force is none of the contact
        names.add("torque")
    elif torque_of(understood.columns) is not None:
        names.add("torque")
    elif (torque := unscaled_torque_of(understood.columns)) is not None and not (
        names & SAYS_FRICTION
    ):
        names.add("friction_force")
        worth = (
            f"what one number of the torque '{shown(torque.label, 30)}' is, for the friction: unit "
            'and scale of its [[column]] with symbol = "torque" in a dialect'
        )
        return [worth, *missing_of(names)]
    elif unknown_of(understood.columns):
        names.add("friction_force")  # it is asked whether one of them holds it
    if any(is_frequency(*_named(c)) for c in understood.columns if not c.used):
        names.add("stroke_frequency")
    lacks = missing_of(names)
    friction = {"friction_force", "friction_coefficient", "shear_stress"}
    known = {c.quantity for c in understood.columns if c.used or c.fill_in}
    known |= {formula.quantity for formula in follows.formulas}
    volts = None if known & friction else in_volts(understood.columns, "friction_force")
    if volts is not None:
        what = f"what a volt of '{shown(volts.label, 30)}' is worth (such as 8.2 N/V), for the "
        lacks.insert(0, f"{what}friction: 'tribolab dialect' asks for it in a terminal")
    return lacks


def _named(column: DraftColumn) -> tuple[str, str | None]:
    name, unit = split_name(column.label)
    return name, column.file_unit or unit


def unknown_of(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns of which nothing is known, but those of what turns.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    turning = (
        torque_of(columns),
        angle_of(columns),
        radius_of(columns),
        unscaled_torque_of(columns),
    )
    places = {column.place for column in turning if column is not None}
    noted = (c for c in columns if c.note and not c.note.startswith(NO_NUMBERS))
    unknown = (c for c in noted if not c.quantity and c.label)
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
    if turning and any(value.source in ("step", "programme") for value in track.values):
        about = "turns and the radius of each step"
        formula = DraftedFormula("sliding_velocity", f"rotation_speed * {track.formula}", about)
        return _and(before, formula, track.values)._replace(speed=SpeedBy("none"))
    if turning and track.values:
        speed = SpeedBy("rotation", (("radius_value", track.formula),))
        return before._replace(speed=speed, values=(*before.values, *track.values))
    if turning and track.symbols:
        formula = DraftedFormula(
            "sliding_velocity", f"rotation_speed * {track.formula}", "turns and a radius"
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


def _surfaces(layout: Layout, understood: Understood, names: set[str]) -> Pair | None:
    """Return the speeds of two surfaces, where no column holds how fast they slide."""
    pair = pair_of(layout, understood.columns, understood.numbers)
    held = {column.place for column in understood.columns if column.used}
    taken = names & {"sliding_velocity", "rotation_speed"}
    return None if pair is None or taken or pair.places & held else pair


def _with_difference(
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
    friction = torque_of(understood.columns) or reading_of(understood.columns)
    if not along_friction(pair, radii, understood.numbers, friction):
        speeds = speeds[::-1]
    about = "two surfaces slide at the difference of their speeds"
    values = radii.values if radii is not None else ()
    sliding = DraftedFormula("sliding_velocity", f"{speeds[0]} {less} {speeds[1]}", about)
    result = _and(before, sliding, values, symbols)._replace(speed=SpeedBy("none"))
    if "rolling_speed" in names:
        return result
    rolling = f"({speeds[0]} {more} {speeds[1]}) / 2"
    return _and(result, DraftedFormula("rolling_speed", rolling, "their mean speed"))


def _of_shaft(layout: Layout, pair: Pair, radii: Radii) -> _Track:
    """Return the radius of the body on whose shaft the torque is; none where that is not said."""
    shaft = 0 if radii.alike else shaft_of_torque(layout, pair)
    return _Track() if shaft is None else _Track(radii.formulas[shaft], radii.values)


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
