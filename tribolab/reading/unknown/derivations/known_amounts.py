"""Known quantities of a run for rules of physics: columns, stated amounts, and answers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.derive import Given, derive
from tribolab.reading.interpret.names import is_stroke_frequency
from tribolab.reading.lexicon.lexicon import key_pattern, mentions, normalise_label, part_pattern
from tribolab.reading.numbers import escaped
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.columns.rotating_parts import angle_of, radius_of, torque_of, turns_of
from tribolab.reading.unknown.derivations.inclined_contact import (
    axial_force_of,
    find_inclined,
    radius_of_ball,
)
from tribolab.reading.unknown.derivations.model import CRANK, SAYS_FRICTION, Known, Source
from tribolab.reading.unknown.derivations.stated_lines import (
    confirmed_value,
    find_gain,
    find_stated_load,
)
from tribolab.reading.unknown.derivations.two_bodies import (
    Pair,
    find_surface_speeds,
    radii_of_surfaces,
    second_is_faster,
    speed_symbol,
)
from tribolab.reading.unknown.header.run_amounts import (
    find_arm,
    find_radius,
    find_ring,
    find_slide_roll_ratio,
    is_at_arm,
    stated_rotation,
)
from tribolab.reading.unknown.header.settings import numeric_settings, text_settings
from tribolab.reading.unknown.header.stroke_settings import (
    Strokes,
    find_strokes,
    strokes_from_answer,
    strokes_of_turns,
)
from tribolab.reading.unknown.header.zero import find_zero, friction_column, zero_in_doubt
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Reason, Understood

_STEADY = 0.05  # largest relative deviation of a controlled rotation speed from its median
_SPEEDS = ("sliding_velocity", "rotation_speed")


class KnownRun(NamedTuple):
    """Known quantities of a run, facts about its rig, and the strokes as stated.

    `zero_in_doubt` is a stated zero that may or may not be subtracted already; `crank` is the text
    about a crank drive.
    """

    given: Known
    facts: frozenset[str]
    values: list[Amount]
    strokes: Strokes | None = None
    zero_in_doubt: Amount | None = None
    crank: Amount | None = None


class _Facts:
    """Collector of known quantities; of several sources for one quantity, the first is kept."""

    def __init__(self, layout: Layout, understood: Understood) -> None:
        self.layout, self.understood = layout, understood
        self.columns = understood.columns
        # columns whose unit the user still has to fill in are included
        self.names = {c.quantity for c in self.columns if c.quantity and (c.used or c.fill_in)}
        self.values = list(numeric_settings(layout))
        self.given: Known = {}

    def add(self, quantity: str, symbol: str, source: Source, number: float | None = None) -> None:
        self.given.setdefault(quantity, Given(quantity, symbol, source, number))

    def add_value(self, quantity: str, value: Amount | None) -> None:
        if value is not None:
            self.add(quantity, value.name, value)

    def add_column(self, quantity: str, symbol: str, column: DraftColumn | None) -> None:
        if column is not None:
            self.add(quantity, symbol, column)


def find_known(layout: Layout, understood: Understood) -> KnownRun:
    """Return the known quantities of a run from its columns, its text and the user's answers."""
    known = _Facts(layout, understood)
    doubt = _add_friction(known)
    _add_columns(known)
    doubt = _add_gains(known) or doubt
    pair = _pair_of(known)
    if pair is None:
        _add_track(known)
    else:
        _add_surfaces(known, pair)
    crank = _crank(layout) if "rotation_speed" in known.given else None
    turned = crank is not None or _turns_a_crank(known)
    facts = {"crank"} if turned and not _has_track(known) else set()
    strokes = _add_strokes(known, crank="crank" in facts)
    _add_speeds(known, pair, crank="crank" in facts)
    _add_load(known)
    return KnownRun(
        known.given, frozenset(facts), known.values, strokes, doubt, crank if facts else None
    )


def _add_friction(known: _Facts) -> Amount | None:
    """Add the measured friction force or torque and its zero; return a zero that is in doubt."""
    layout, said = known.layout, known.understood.zero
    reading, torque = friction_column(known.columns), torque_of(known.columns)
    if reading is not None and is_at_arm(reading):
        known.add("arm_force", "arm_force", reading)
        known.add_value("arm", find_arm(known.values))
        known.names.discard("friction_force")
        return None
    if reading is None and (torque is None or known.names & SAYS_FRICTION):
        return None
    unit = "N m" if reading is None else "N"
    zero = find_zero(layout, known.values, unit, said)
    if reading is None:
        known.add_column("torque" if zero is None else "torque_reading", "torque", torque)
        known.add_value("torque_zero", zero)
        known.add_value("arm", find_arm(known.values))
        return zero_in_doubt(layout, known.values, unit, said)
    if zero is not None:
        known.add("friction_reading", "friction_reading", reading)
        known.add_value("friction_zero", zero)
        known.names.discard("friction_force")
    return zero_in_doubt(layout, known.values, unit, said)


def _add_columns(known: _Facts) -> None:
    """Add the quantities of columns, and a stated contact area; omit a position without time."""
    timed = "time" in known.names or known.understood.rate_pattern or known.understood.rate
    held = known.names if timed else known.names - {"position"}
    for column in known.columns:
        if column.quantity in held and (column.used or column.fill_in):
            known.add(column.quantity, column.quantity, column)
    area = [
        v
        for v in known.values
        if v.own_unit and converts(v.own_unit, "m2") and key_pattern("contact_area").search(v.key)
    ]
    if len(area) == 1:
        area[0] = area[0]._replace(name="contact_area", unit=area[0].own_unit, to="m2")
        known.add_value("contact_area", area[0])


def _add_gains(known: _Facts) -> Amount | None:
    """Add forces in volts with their stated gain; return a friction zero that is in doubt."""
    doubt = None
    for force in ("friction_force", "normal_force"):
        gain = None if force in known.names else find_gain(known.layout, known.columns, force)
        if gain is not None:
            known.add(f"{force}_signal", f"{force}_signal", gain.column)
            known.add_value(f"{force}_gain", gain.factor)
            if force == "friction_force" and not known.understood.zero:
                doubt = find_zero(known.layout, known.values, "N")
                doubt = doubt or zero_in_doubt(known.layout, known.values, "N")
    return doubt


def _pair_of(known: _Facts) -> Pair | None:
    """Return the speed columns of two surfaces if no column is the sliding speed."""
    pair = find_surface_speeds(known.layout, known.columns, known.understood.numbers)
    used = {column.place for column in known.columns if column.used}
    taken = pair is not None and {column.place for column in pair.columns} & used
    return None if taken or known.names & set(_SPEEDS) else pair


def _add_surfaces(known: _Facts, pair: Pair) -> None:
    """Add the speeds of two surfaces, ordered so that friction and slip have the same sign."""
    said, numbers = known.understood.radius, known.understood.numbers
    values = () if said else radii_of_surfaces(pair, known.values)
    radii = [Given("", f"'{said}'", None)] * 2 if said else [Given("", v.name, v) for v in values]
    radii = radii * 2 if len(radii) == 1 else radii
    friction = torque_of(known.columns) or friction_column(known.columns)
    order = [0, 1]
    if second_is_faster(pair, values, numbers, friction):
        order = [1, 0]
    for place, body in zip(order, ("first", "second"), strict=True):
        name = ("first_surface", "second_surface")[place]
        column, symbol = speed_symbol(pair.columns[place], name)
        symbol = f"(-{symbol})" if pair.opposed and place == 1 else symbol
        known.add(f"{body}_{'rotation' if pair.turns else 'surface'}", symbol, column)
        if radii:
            known.add(f"{body}_radius", radii[place].symbol, radii[place].source)
    if not radii:
        _add_track(known)
        return
    if len({value.number * value.scale for value in values}) < 2:  # one radius
        known.add("track_radius", radii[0].symbol, radii[0].source)


def _add_track(known: _Facts) -> None:
    """Add the radius of the track: an answer, a column, or what the text states."""
    values, understood = known.values, known.understood
    if understood.radius:
        known.add("track_radius", f"'{understood.radius}'", None)
    if (agreed := confirmed_value(values, understood.agreed, "radius")) is not None:
        known.add_value("track_radius", agreed._replace(name="track_radius", to="m", guess=""))
    known.add_column("track_radius", "radius", radius_of(known.columns))
    # block on ring: the track is the rim of the ring
    rim = any(mentions("slides_on_rim", text) for text in known.layout.named_sentences)
    radius, ring = find_radius(values, rim=rim), None if rim else find_ring(values)
    if ring is not None and (radius is None or radius.guess):
        for side in ring:
            known.add(side.name, side.name, side, side.si("m"))
    else:
        known.add_value("track_radius", radius)
    inclined = find_inclined(known.layout)
    if inclined is not None and inclined.sine and not _has_track(known):
        known.add_value("ball_radius", radius_of_ball(values))
        known.add("contact_sine", f"{inclined.sine:.6g}", None)


def _has_track(known: _Facts) -> bool:
    return derive("track_radius", known.given) is not None


def _crank(layout: Layout) -> Amount | None:
    """Return the text about a crank that drives the strokes, as a value for the dialect."""
    drive, sine = key_pattern("drive"), part_pattern("sine")
    said = [t for key, t in text_settings(layout) if drive.search(normalise_label(key))]
    crank = next((text for text in said if sine.search(normalise_label(text))), None)
    return None if crank is None else Amount(CRANK, f"({escaped(crank)})", None, None, crank)


def _turns_a_crank(known: _Facts) -> bool:
    """Whether a column is named after a crank, and the rotation speed is known."""
    sine, turning = part_pattern("sine"), "rotation_speed" in known.given
    return turning and any(sine.search(normalise_label(c.label)) for c in known.columns)


def _add_strokes(known: _Facts, *, crank: bool) -> Strokes | None:
    """Add the length and frequency of strokes if both are known; return them as stated."""
    understood = known.understood
    turning = known.given.get("rotation_speed")
    if crank:
        column = turning.source if turning is not None else None
        often = column if isinstance(column, DraftColumn) else None
        strokes = strokes_of_turns(known.values, often) if often is not None else None
    else:
        strokes = find_strokes(known.values, understood)
        if understood.strokes is not None:
            strokes = strokes_from_answer(known.values, understood.strokes) or strokes
        if strokes is not None and strokes.symbols and turning is not None:
            strokes = None
    if strokes is not None:
        known.add("stroke", "stroke", None)
        known.add("frequency", "frequency", None)
    for column in known.columns:
        name, unit = split_name(column.label)
        if not column.used and is_stroke_frequency(name, column.file_unit or unit):
            known.add("frequency", "frequency", column)
    return strokes


def is_steady(understood: Understood) -> bool:
    """Whether the rotation speed is constant, so that a single sliding speed applies to all rows.

    File: a T-11 pin-on-disc tester, 191 rpm and "0.1m-s" in its name.
    """
    turns = [c for c in understood.columns if c.used and c.quantity == "rotation_speed"]
    if len(turns) != 1:
        return False
    rates = np.abs(understood.numbers[:, turns[0].place - 1])
    usual = float(np.nanmedian(rates)) if np.isfinite(rates).any() else 0.0
    return usual > 0 and bool((np.abs(rates / usual - 1) < _STEADY).all())


def _add_speeds(known: _Facts, pair: Pair | None, *, crank: bool) -> None:
    """Add an angle, a stated slide-roll ratio, and a set-point of sliding or rotation speed."""
    turning = derive("rotation_speed", known.given) is not None
    if not turning:
        angle = angle_of(known.columns) or turns_of(known.columns, known.understood.numbers)
        known.add_column("angle", "angle", angle)
    if "rolling_speed" in known.given:
        known.add_value("slide_roll_ratio", find_slide_roll_ratio(known.values))
    steady = turning and not crank and not _has_track(known) and is_steady(known.understood)
    if (turning and not steady) or pair is not None or "set_speed" in known.given:
        return
    stated = [value for value in known.values if value.name == "set_speed"]
    if len(stated) == 1:
        known.add_value("set_speed", stated[0])
    elif not stated and not turning:
        known.add_value("set_rotation", stated_rotation(known.values))


def _add_load(known: _Facts) -> None:
    """Add the load: a sum of load cells, an axial force, or a load that was set or stated."""
    weights = [c for c in known.columns if not c.used and not c.quantity and _is_weight(c)]
    if len(weights) == 1:
        known.add("mass", "mass", weights[0]._replace(unit=bare_name(weights[0])[1]))
    loads = loads_that_add(known.columns)
    if len(loads) in (2, 3):
        for number, column in enumerate(loads, 1):
            known.add(f"load_{number}", f"load_{number}", column)
    if known.understood.load:
        known.given["set_normal_force"] = Given(
            "set_normal_force", f"'{known.understood.load}'", None
        )
        return
    stated = find_stated_load(known.values, known.understood)
    inclined = find_inclined(known.layout)
    if inclined is not None and inclined.cosine > 0 and "friction_coefficient" not in known.names:
        # an instrument that records its own coefficient allows for the angle
        known.add("contact_cosine", f"{inclined.cosine:.6g}", None)
        if (axial := axial_force_of(known.columns)) is not None:
            known.given.pop("normal_force", None)
            known.add("axial_force", "axial_force", axial)
        elif (of_column := known.given.pop("set_normal_force", None)) is not None:
            known.given["axial_force"] = of_column._replace(quantity="axial_force")
        else:
            known.add_value("axial_force", stated)
        return
    known.add_value("set_normal_force", stated)


def _is_weight(column: DraftColumn) -> bool:
    name, unit, _ = bare_name(column)
    return (
        converts(unit or "", "kg") and key_pattern("load").search(normalise_label(name)) is not None
    )


def loads_that_add(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the load columns whose sum is the normal force, with units for a formula."""
    return [
        c._replace(unit=unit if say else None)
        for c in columns
        if not c.used and c.reason is Reason.ADDS
        for _, unit, say in [bare_name(c)]
    ]
