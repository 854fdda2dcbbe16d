"""What follows of columns and stated values where no column holds it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.draft.columns.turning import radius_of, torque_of
from tribolab.draft.file.layout import Layout
from tribolab.draft.follows.axial import Inclined, axial_force_of, find_inclined, radius_of_ball
from tribolab.draft.follows.bridges import calibrated_forces
from tribolab.draft.follows.candidate_lines import confirmed_value
from tribolab.draft.follows.from_axis import radius_from_axis
from tribolab.draft.follows.gains import stated_gains
from tribolab.draft.follows.model import (
    SAYS_FRICTION,
    SAYS_LOAD,
    DraftedFormula,
    Follows,
    SpeedBy,
    Track,
    and_also,
    of_value,
)
from tribolab.draft.follows.speed import (
    stated_turns,
    surfaces_of,
    with_difference,
    with_speed,
)
from tribolab.draft.follows.sums import loads_that_add
from tribolab.draft.follows.two_bodies import Pair, Radii, radii_of, shaft_of_torque
from tribolab.draft.model import Understood
from tribolab.draft.stated.counts import zero_in_counts
from tribolab.draft.stated.lengths import find_arm, find_radius, find_ring, is_at_arm, slides_on_rim
from tribolab.draft.stated.programme import find_programme
from tribolab.draft.stated.settings import numeric_settings, text_settings
from tribolab.draft.stated.stated_load import find_load, lifted_on_return, stated_number
from tribolab.draft.stated.stated_zero import find_zero, friction_column, zero_in_doubt
from tribolab.draft.stated.stroke_settings import stated_strokes
from tribolab.quantities import unit_conversion
from tribolab.reading.interpret.amounts import Amount
from tribolab.unit_names import WEIGHTS

_SAYS_SPEED = {"sliding_velocity", "position", "set_speed"}
_PRESSED = 0.5  # of the largest load: what is less is no contact
_HELD = 1.1  # times what was set, or as much less: a measured load that is held at it


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
    values = list(numeric_settings(layout))
    if "step" in names:
        values += find_programme(layout)
    told = _Told(layout, understood, names, values, find_inclined(layout))
    if any(gain.quantity == "rotation_speed" for gain in stated_gains(layout, understood.columns)):
        names.add("rotation_speed")
    track = _track_of(told)
    pair = surfaces_of(layout, understood, names)
    radii = radii_of(pair, values, understood.radius) if pair is not None else None
    result = _speed(told, track, pair, radii)
    arm = _of_shaft(layout, pair, radii) if pair is not None and radii is not None else track
    result = _of_torque(result, told, arm)
    result = _of_loads(result, told)
    result = _of_reading(result, told, track)
    result = _of_gains(result, told)
    return _of_stated_load(result, told)


class _Told(NamedTuple):
    """All that is known of a file; `names` grows by what follows."""

    layout: Layout
    understood: Understood
    names: set[str]
    values: list[Amount]
    inclined: Inclined | None

    @property
    def timed(self) -> bool:
        """Whether the rows have times; rows that are counted as seconds have none."""
        known = self.understood.rate_pattern or self.understood.rate
        return "time" in self.names or bool(known)


def _track_of(told: _Told) -> Track:
    layout, understood = told.layout, told.understood
    track = _track(told.values, understood, rim=slides_on_rim(layout))
    if not track.formula:
        away = radius_from_axis(layout, understood.columns, understood.numbers)
        track = Track(away.formula, (), (("stage", away.column),)) if away else track
    if told.inclined is not None and not track.formula:
        track = of_value(radius_of_ball(told.inclined, told.values))
    return track


def _speed(told: _Told, track: Track, pair: Pair | None, radii: Radii | None) -> Follows:
    """Say how fast it slides: as a person said, by two surfaces, or by what is there."""
    names, understood = told.names, told.understood
    if (agreed := confirmed_value(told.values, understood.agreed, "speed")) is not None:
        said = agreed._replace(name="set_speed", unit=agreed.own_unit, to=None, guess="")
        return Follows(values=(said,), speed=SpeedBy("set speed"))
    if understood.speed:
        about = "it was said that it slides so fast all along"
        formula = DraftedFormula("set_speed", f"'{understood.speed}'", about)
        return and_also(Follows(), formula)._replace(speed=SpeedBy("set speed"))
    if pair is not None and (radii is not None or not pair.turns):
        return with_difference(Follows(), names, pair, radii, understood)
    says_speed = _SAYS_SPEED if told.timed else _SAYS_SPEED - {"position"}
    # what is set, and a way of whatever, give way to what turns; what is set to what drives, too
    turned = "rotation_speed" in names and bool(track.formula)
    says_speed = says_speed - ({"set_speed", "position"} if turned else {"set_speed"})
    if pair is not None or names & says_speed:
        turns = stated_turns(told.values) if "sliding_velocity" in names else None
        return Follows() if turns is None else Follows(values=(turns,))
    return with_speed(Follows(), names, told.values, understood, text_settings(told.layout), track)


def _of_torque(result: Follows, told: _Told, arm: Track) -> Follows:
    """Let a torque over its arm be the friction force."""
    torque = torque_of(told.understood.columns)
    if told.names & SAYS_FRICTION or torque is None:
        return result
    arm = arm if arm.formula else of_value(find_arm(told.values))
    if not arm.formula:
        return result
    zero = find_zero(told.layout, told.values, "N m", told.understood.zero)
    about = "a torque and a radius" + (f", and '{zero.text}'" if zero else "")
    net = f"(torque - {zero.name})" if zero else "torque"
    read = torque.zero if zero is None else ""
    formula = DraftedFormula("friction_force", f"{net} / {arm.formula}", about, read)
    used = arm.values if zero is None else (*arm.values, zero)
    symbols = (("torque", torque._replace(zero="")), *arm.symbols)
    result = and_also(result, formula, used, symbols)
    told.names.add("friction_force")
    doubt = zero_in_doubt(told.layout, told.values, "N m", told.understood.zero)
    return result._replace(zero_in_doubt=doubt)


def _of_loads(result: Follows, told: _Told) -> Follows:
    """Let loads that several cells carry add up."""
    loads = loads_that_add(told.understood.columns)
    if len(loads) < 2 or "normal_force" in told.names:
        return result
    symbols = tuple((f"load_{number}", column) for number, column in enumerate(loads, 1))
    together = " + ".join(name for name, _ in symbols)
    told.names.add("normal_force")
    formula = DraftedFormula("normal_force", together, "loads that add up")
    return and_also(result, formula, (), symbols)


def _of_reading(result: Follows, told: _Told, track: Track) -> Follows:
    """Bring a force from its arm to the track, and take a stated zero off it."""
    reading = friction_column(told.understood.columns)
    if reading is None:
        return result
    bare = reading._replace(zero="")
    lever = find_arm(told.values) if is_at_arm(reading) else None
    if lever is not None and track.formula:
        about = f"a force on an arm: '{lever.text}'"
        what = f"arm_force * {lever.name} / {track.formula}"
        formula = DraftedFormula("friction_force", what, about, reading.zero)
        symbols = (("arm_force", bare), *track.symbols)
        return and_also(result, formula, (lever, *track.values), symbols)
    doubt = zero_in_doubt(told.layout, told.values, "N", told.understood.zero)
    result = result._replace(zero_in_doubt=doubt)
    zero = find_zero(told.layout, told.values, "N", told.understood.zero)
    if zero is None:  # what a converter counts was not tared
        numbers = told.understood.numbers[:, reading.place - 1]
        zero = zero_in_counts(told.values, reading, numbers)
    if zero is None:
        return result
    what = f"friction_reading - {zero.name}"
    formula = DraftedFormula("friction_force", what, f"'{zero.text}'")
    return and_also(result, formula, [zero], (("friction_reading", bare),))


def _of_gains(result: Follows, told: _Told) -> Follows:
    """Let volts and counts be what the text says that one of them is worth."""
    columns = told.understood.columns
    gains = stated_gains(told.layout, columns)
    for gain in gains:
        if gain.quantity == "position" and (result.speed is not None or told.names & _SAYS_SPEED):
            continue
        formula = DraftedFormula(gain.quantity, gain.formula, gain.about)
        result = and_also(result, formula, gain.values, ((gain.symbol, gain.column),))
        told.names.add(gain.quantity)
        if gain.quantity == "position" and told.timed:
            result = result._replace(speed=SpeedBy("position"))
    made = {gain.quantity for gain in gains}
    for force in calibrated_forces(told.layout, columns):
        if force.quantity in made:
            continue
        about = f"a signal in volts, and '{force.value.text}'"
        formula = DraftedFormula(force.quantity, force.formula, about)
        result = and_also(result, formula, [force.value], ((force.symbol, force.column),))
        told.names.add(force.quantity)
    return result


def _of_stated_load(result: Follows, told: _Told) -> Follows:
    """Take the load that is said, set, or stated, where nothing measures that on the contacts."""
    names, understood, inclined = told.names, told.understood, told.inclined
    unloaded = bool(names & SAYS_FRICTION) and not names & SAYS_LOAD
    by_angle = inclined is not None and inclined.cosine > 0

    def on_contacts(name: str) -> str:
        return inclined.load(name) if inclined is not None and by_angle else name

    if understood.load and unloaded:
        about = "it was said that the load is so all along"
        return and_also(result, DraftedFormula("normal_force", f"'{understood.load}'", about))
    if "set_normal_force" in names and unloaded:
        about = "nothing measures it: the load that was set"
        return and_also(
            result, DraftedFormula("normal_force", on_contacts("set_normal_force"), about)
        )
    if "position" in names and result.speed is None:
        result = result._replace(values=(*result.values, *stated_strokes(told.values)))
    load = find_load(told.values)
    if (agreed := confirmed_value(told.values, understood.agreed, "load")) is not None:
        unit = WEIGHTS.get(agreed.own_unit or "", agreed.own_unit)
        load = agreed._replace(name="set_normal_force", unit=unit, to=None, guess="")
    axial = axial_force_of(understood.columns)
    # where the instrument gives a coefficient of its own, it knows of the angle
    of_forces = "friction_force" in names and "friction_coefficient" not in names
    if inclined is not None and by_angle and axial is not None and of_forces:
        about = f"the contacts carry more than the axial force: '{inclined.text}'"
        formula = DraftedFormula("normal_force", on_contacts("axial_force"), about)
        return and_also(result, formula, (), (("axial_force", axial),))
    if load is None:
        return result
    if unloaded:
        about = f"nothing measures it: '{load.text}' is taken for all of the run"
        out = "position" in names and lifted_on_return(told.layout)
        about += ", but for ways back, on which it is lifted" if out else ""
        way = "out" if out else ""
        formula = DraftedFormula("normal_force", on_contacts(load.name), about, way=way)
        return and_also(result, formula, [load])
    if not names & {"normal_force", "normal_stress", "set_normal_force"} or _is_held(load, told):
        # under which a coefficient stands, or what the measured one was set to
        return result._replace(values=(*result.values, load))
    return result


def _is_held(load: Amount, told: _Told) -> bool:
    """Whether the one column of the load stays at what the text states: it is its set-point."""
    understood = told.understood
    columns = [c for c in understood.columns if c.used and c.quantity == "normal_force"]
    if len(columns) != 1 or load.source != "preamble" or "set_normal_force" in told.names:
        return False
    scale, _ = unit_conversion(columns[0].read_unit or "N", "normal_force")
    values = np.abs(columns[0].scale * scale * understood.numbers[:, columns[0].place - 1])
    pressed = values[values > _PRESSED * np.nanmax(values, initial=0.0)]
    set_to = stated_number(load) * unit_conversion(load.unit or "N", "normal_force")[0]
    if not pressed.size or not set_to > 0:
        return False
    low, high = np.nanquantile(pressed, (0.05, 0.95)) / set_to
    return bool(low > 1 / _HELD and high < _HELD)


def _track(values: Sequence[Amount], understood: Understood, *, rim: bool) -> Track:
    """Return the radius of the track: what a person said, a column, or what the text states."""
    if understood.radius:
        return Track(f"'{understood.radius}'")
    if (agreed := confirmed_value(values, understood.agreed, "radius")) is not None:
        return of_value(agreed._replace(name="track_radius", to="m", guess=""))
    column = radius_of(understood.columns)
    if column is not None:
        return Track("radius", symbols=(("radius", column),))
    radius = find_radius(values, rim=rim)
    if (radius is None or radius.guess) and not rim and (ring := find_ring(values)) is not None:
        return Track("((inner_radius + outer_radius) / 2)", ring)
    return of_value(radius)


def _of_shaft(layout: Layout, pair: Pair, radii: Radii) -> Track:
    """Return the radius of the body on whose shaft the torque is; none where that is not said."""
    shaft = 0 if radii.alike else shaft_of_torque(layout, pair)
    return Track() if shaft is None else Track(radii.formulas[shaft], radii.values)
