"""Two surfaces that both move: a ball and a disc, two rollers; they slide at the difference."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label, role_of
from tribolab.turns import reciprocal
from tribolab.unit_names import plain_unit

_LONGEST = 200  # characters of a line that are looked at
_SURFACE = "the speed of one of two surfaces"
_SPEEDS = ("rotation_speed", "sliding_velocity")
# what the one of two bodies is called, and the other
_BODIES = tuple(
    (re.compile(one), re.compile(other))
    for one, other in (
        (
            "upper|top|ober|oben|sup[eé]rieur|superior|верхн|g[oó]rn|horn[íi]|[üu]st|上",
            "lower|bottom|unter|unten|inf[eé]rieur|inferior|нижн|doln|alt|下",
        ),
        (
            "dis[ck]|scheibe|kotouc|schijf|skiva|skive|levy|korong|disque|disco|disk|диск|tarcz|盘|ディスク",
            "ball|kugel|bille|bola|sfera|шар|kul|球|ボール|roller|rolle|galet|rullo|ролик|pin|barrel",
        ),
        ("ring|anneau|anello|anillo|кольц|环", "roller|rolle|galet|rullo|rodillo|ролик"),
        (
            "driving|driver|treibend|menant|moteur|conductor|motric|ведущ|主动|駆動",
            "driven|getrieben|men[ée]e?|conducid|condott|ведом|从动|従動|被動",
        ),
        ("left|links|gauche|sinistr|izquierd|лев|左", "right|rechts|droite?|destr|derech|прав|右"),
        (
            "specimen|sample|probe|[ée]chantillon|prov[ií]no|试样",
            "counter|gegen|antagonist|contre|对磨|陪试",
        ),
    )
)
# so little tells bodies apart only where the text speaks of two
_NUMBERED = ((re.compile("1$"), re.compile("2$")),)
_TWIN = re.compile(
    r"twin|two[\s-]?(?:dis[ck]|roller)|roller[\s-]?(?:on|against)[\s-]?(?:roller|dis[ck])|2[\s-]?dis[ck]|disc[\s-]?on[\s-]?disc"
    r"|zwei[\s-]?scheiben|zwei[\s-]?rollen|bi[\s-]?disque|deux (?:galets|disques)"
    r"|bi[\s-]?disco|dos discos|due (?:rulli|dischi)"
    r"|двухроликов|ролик[\s-]+ролик|双盘|双辊|滚动接触|二円筒|2円筒|ローラ|amsler"
    r"|dvou(?:kotou[čc]|disk)\w*|dwurolk\w*|dwutarcz\w*|twee[\s-]?schijv\w*|tv[åa][\s-]?skiv\w*"
    r"|k[ée]tkorong\w*|çift disk|iki disk|rolling contact|w[äa]lz",
    re.IGNORECASE,
)
_TORQUE = re.compile(r"torque|moment|couple|coppia|koppel|扭矩|转矩|力矩|トルク|момент|moment[io]?")


class Pair(NamedTuple):
    """The columns of how fast both surfaces go, as linear speeds or as turns, and their names."""

    columns: tuple[DraftColumn, DraftColumn]
    turns: bool
    opposed: bool
    bodies: tuple[re.Pattern[str], re.Pattern[str]]

    @property
    def places(self) -> set[int]:
        """Numbers of both columns."""
        return {column.place for column in self.columns}


class Radii(NamedTuple):
    """Of both bodies: in formulas, and the values that they rest on."""

    formulas: tuple[str, str]
    values: tuple[Amount, ...]

    @property
    def alike(self) -> bool:
        """Whether both are as large."""
        return len({value.number * value.scale for value in self.values}) < 2


def pair_of(layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray) -> Pair | None:
    """Return the two columns of how fast two surfaces go, where their names are those of bodies.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    known = [(column, _speed_of(column)) for column in columns]
    for quantity in _SPEEDS:
        mine = [column for column, held in known if held == quantity]
        twin = len(mine) == 2 and any(_TWIN.search(t[:_LONGEST]) for t in _texts(layout))
        for bodies in (*_BODIES, *(_NUMBERED if twin else ())):
            pairs = [(a, b) for a in mine for b in mine if a is not b and _is(bodies, a, b)]
            if len(pairs) == 1:
                first, second = (numbers[:, c.place - 1] for c in pairs[0])
                opposed = bool(np.nanmedian(np.sign(first * second)) < 0)
                return Pair(pairs[0], quantity == "rotation_speed", opposed, bodies)
    return None


def _texts(layout: Layout) -> tuple[str, ...]:
    return (layout.file.path.stem, *layout.text_above())


def _is(bodies: tuple[re.Pattern[str], re.Pattern[str]], a: DraftColumn, b: DraftColumn) -> bool:
    names = [normalise_label(bare_name(column)[0]) for column in (a, b)]
    own = [pattern.search(name) for pattern, name in zip(bodies, names, strict=True)]
    other = [pattern.search(name) for pattern, name in zip(bodies[::-1], names, strict=True)]
    return all(own) and not any(other)


def _speed_of(column: DraftColumn) -> str:
    """Return which speed a column's name and unit are of; "" if none, or one that was set."""
    name, unit, _ = bare_name(column)
    if not column.label or role_of(name) in ("set", "extreme"):
        return ""
    unit = column.unit or unit
    options = [match.quantity for match in matches(name, unit)]
    if unit is None or (options and not set(options) & set(_SPEEDS)):
        return ""
    return next(
        (held for held, si in zip(_SPEEDS, ("Hz", "m/s"), strict=True) if converts(unit, si)), ""
    )


def without_surfaces(columns: Sequence[DraftColumn], pair: Pair | None) -> list[DraftColumn]:
    """Let neither surface's speed be that of the sliding.

    Parameters
    ----------
    columns
        The columns as they are understood.
    pair
        From `pair_of`.
    """
    places = pair.places if pair is not None else set()
    return [
        c._replace(quantity=None, used=False, guessed=(), options=(), fill_in="", note=_SURFACE)
        if c.place in places
        else c
        for c in columns
    ]


def has_turning_surfaces(columns: Sequence[DraftColumn]) -> bool:
    """Whether two surfaces turn, each at a speed of its own.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    return any(c.note == _SURFACE and not c.used and _speed_of(c) == _SPEEDS[0] for c in columns)


def radii_of(pair: Pair, values: Sequence[Amount], said: str) -> Radii | None:
    """Return the radii of two bodies that the text states; of one size where it says but one.

    Parameters
    ----------
    pair
        From `pair_of`.
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    said
        The radius that a person said, if any.
    """
    if said:
        return Radii((f"'{said}'", f"'{said}'"), ())
    sizes = [v._replace(to="m") for v in values if v.unit and converts(v.unit, "m")]
    sizes = [
        v._replace(scale=0.5) if v.means("diameter") else v
        for v in sizes
        if v.means("diameter", "track_radius")
    ]
    told = [
        [v for v in sizes if own.search(v.key) and not other.search(v.key)]
        for own, other in (pair.bodies, pair.bodies[::-1])
    ]
    if all(len(of_body) == 1 for of_body in told):
        one, two = told[0][0]._replace(name="radius_1"), told[1][0]._replace(name="radius_2")
        return Radii((one.name, two.name), (one, two))
    if len(sizes) == 1 and not any(told):
        only = sizes[0]._replace(name="radius_1")
        return Radii((only.name, only.name), (only,))
    return None


def along_friction(
    pair: Pair, radii: Radii | None, numbers: np.ndarray, friction: DraftColumn | None
) -> bool:
    """Whether friction is positive where the first surface is the faster one, as it mostly is.

    Parameters
    ----------
    pair, radii
        From `pair_of` and `radii_of`.
    numbers
        The numbers of all columns (rows, columns) as written.
    friction
        The column of a force or a torque.
    """
    if friction is None:
        return True
    first, second = (np.abs(numbers[:, column.place - 1]) for column in pair.columns)
    sizes = [value.number * value.scale for value in radii.values] if radii is not None else []
    one, other = sizes if len(sizes) == 2 else (1.0, 1.0)
    signal = numbers[:, friction.place - 1]
    return not np.nansum((one * first - other * second) * (signal - np.nanmedian(signal[:1]))) < 0


def as_symbol(column: DraftColumn) -> tuple[DraftColumn, str]:
    """Return a column of a speed as it stands in a formula, and what makes it an angular one.

    Turns count cycles; a formula wants radians.
    """
    _, unit, say = bare_name(column)
    told = reciprocal(plain_unit(unit or ""))
    factor = "" if told is None or told.counts == "radians" else "2 * pi * "
    return column._replace(unit=unit if say else None, used=True), factor


def shaft_of_torque(layout: Layout, pair: Pair) -> int | None:
    """Return on which body's shaft (0, 1) the torque is measured, if a line says so.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    pair
        From `pair_of`.
    """
    clauses = [
        normalise_label(clause)
        for line in layout.text_above()
        for clause in re.split(r"[,;.，；。:：]", line[:_LONGEST])
    ]
    told = {
        index
        for clause in clauses
        if _TORQUE.search(clause)
        for index, (own, other) in enumerate((pair.bodies, pair.bodies[::-1]))
        if own.search(clause) and not other.search(clause)
    }
    return told.pop() if len(told) == 1 else None
