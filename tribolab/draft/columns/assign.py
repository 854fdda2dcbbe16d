"""Which column holds which quantity, where several names may mean it or one may mean several."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.draft.columns.fill_in import FORCES, Bare, filled_in
from tribolab.draft.columns.meant import ACROSS, meant
from tribolab.draft.columns.turning import torque_of
from tribolab.draft.model import UNKNOWN_NAME, WHICH_FORCE, DraftColumn, Kind
from tribolab.errors import shown
from tribolab.quantities import QUANTITIES, quantity, unit_conversion
from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_count
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import Role, normalise_label, role_of

SIGNALS = {
    "friction_force",
    "normal_force",
    "friction_coefficient",
    "sliding_velocity",
    "position",
    "shear_stress",
    "film_thickness",
}
_DECIDING = FORCES | {"sliding_velocity", "rotation_speed"}
# of two columns for a quantity the measured one counts, and what was set or worked out gives way
_WEIGHT: dict[Role, float] = {"": 1.0, "measured": 1.1, "derived": 0.6, "set": 0.5, "extreme": 0.4}
_TORQUE = "a torque: with the radius at which it acts it is a force"
_NEAR = 0.05  # scores of names that suit a quantity about as well
_STILL = 0.9  # of the score: a load that never moves is the one that was meant to be
_EITHER = ("friction_force", "normal_force")  # what a load cell may measure
_CROSSTALK = 5.0  # times: the force along the motion is so much larger than one across it
_APART = 0.01  # relative difference of two columns that do not hold the same


class _Proposal(NamedTuple):
    """A column for a quantity; of several the one of the highest rank is taken."""

    rank: tuple[float, bool, int]
    place: int
    option: Match


def assigned(
    columns: list[DraftColumn],
    bare: list[Bare],
    matched: list[list[Match]],
    numbers: np.ndarray,
    kind: Kind,
) -> list[DraftColumn]:
    """Give each quantity to the column whose name fits best.

    Parameters
    ----------
    columns, bare
        The columns, and their names without units.
    matched
        For each the quantities that its name may stand for, the likeliest first.
    numbers
        Their numbers (rows, columns) as written.
    kind
        What the file is.
    """
    matched = meant(columns, bare, matched, numbers)
    has_units = any(unit is not None for _, unit, _ in bare)
    filled = (np.isfinite(numbers) & (numbers != 0)).any(axis=0)
    proposals: dict[str, list[_Proposal]] = {}
    for index, options in enumerate(matched):
        option = _preferred(options, bare[index][1], numbers[:, index], has_units)
        if option:
            # of names used twice the later counts: exporters repeat first what was plotted
            weight = _WEIGHT[role_of(bare[index][0])] if kind == "run" else 1.0
            if option.quantity in FORCES and np.ptp(numbers[:, index]) == 0:
                weight *= _STILL
            rank = (option.score * weight, bool(filled[index]), index)
            proposals.setdefault(option.quantity, []).append(_Proposal(rank, index, option))
    _give_way(proposals, matched)
    _take_the_other(proposals, matched, torque_of(columns) is not None)
    for name in _DECIDING & set(proposals):
        proposals[name] = _contested(proposals[name], numbers, bare)
    result = list(columns)
    for index, column in enumerate(columns):
        if not column.label:
            continue
        unit = bare[index][1]
        if unit is not None and not matched[index]:
            same = [q for q in SIGNALS if _told_by(unit, quantity(q).unit)]
            hint = f"its unit fits {' or '.join(sorted(same))}" if same else ""
            hint = _TORQUE if not same and converts(unit, "N m") else hint
            result[index] = column._replace(note=hint or UNKNOWN_NAME)
        elif not matched[index]:
            result[index] = column._replace(note=UNKNOWN_NAME)
    for rivals in proposals.values():
        alike = _alike(rivals)
        for rival in rivals:
            place = rival.place
            if rival in alike and _is_spare(rivals):
                result[place] = _spare(columns, bare[place], rival, numbers[:, place], kind, rivals)
            elif rival is not max(rivals):
                name, best = rival.option.quantity, max(rivals).place + 1
                note = f"also looks like {name}; column {best} is used"
                result[place] = columns[place]._replace(quantity=name, note=note)
            else:
                column = filled_in(
                    columns[place],
                    bare[place],
                    rival.option,
                    numbers[:, place],
                    kind,
                    several=len(alike) > 1,
                )
                column = _with_options(column, rival, rivals, matched[place])
                result[place] = _asked_which(column, rival, matched[place])
    return result


def _asked_which(column: DraftColumn, rival: _Proposal, matched: list[Match]) -> DraftColumn:
    """Do not use a column of which nothing says which of both forces it holds."""
    equal = {option.quantity for option in matched if option.score >= rival.option.score - _NEAR}
    if rival.option.score >= KNOWN_WORD or not set(_EITHER) <= equal or column.fill_in:
        return column
    return column._replace(used=False, fill_in=WHICH_FORCE.format(shown(column.label)))


def _alike(rivals: list[_Proposal]) -> list[_Proposal]:
    """Return those of several columns whose names suit a quantity about as well as the best."""
    return [rival for rival in rivals if rival.rank[0] > max(rivals).rank[0] - _NEAR]


def _contested(rivals: list[_Proposal], numbers: np.ndarray, bare: list[Bare]) -> list[_Proposal]:
    """Let a column that is surely named for a quantity, but says otherwise, rival the best."""
    best = max(rivals)
    if role_of(bare[best.place][0]) == "measured":
        return rivals

    def size(rival: _Proposal) -> float:
        unit, si_unit = bare[rival.place][1], quantity(rival.option.quantity).unit
        unit = None if unit is not None and is_count(unit) else unit
        scale = unit_conversion(rival.option.unit or unit or si_unit, rival.option.quantity)[0]
        values = np.abs(numbers[:, rival.place])
        moving = values[np.isfinite(values) & (values > 0)]
        return float(scale * np.median(moving)) if moving.size else 0.0

    def is_rival(rival: _Proposal) -> bool:
        plain = not role_of(bare[rival.place][0])
        here = rival is not best and plain and rival.option.score >= KNOWN_WORD
        # across the motion a sensor shows some cross-talk: the larger force is along it
        across = normalise_label(bare[rival.place][0]) in ACROSS and size(rival) < size(best)
        return here and not across and size(rival) > 0 and _apart(size(rival), size(best))

    if not size(best):
        return rivals

    def larger(rival: _Proposal, top: float) -> float:
        along = rival.option.quantity == "friction_force" and size(rival) > _CROSSTALK * size(best)
        return top + 0.6 * _NEAR if along else top

    top = best.rank[0] - 0.5 * _NEAR
    return [
        rival._replace(rank=(max(larger(rival, top), rival.rank[0]), *rival.rank[1:]))
        if is_rival(rival)
        else rival
        for rival in rivals
    ]


def _apart(one_size: float, other_size: float) -> bool:
    return abs(one_size / other_size - 1) > _APART


def _is_spare(rivals: list[_Proposal]) -> bool:
    """Whether just one of the columns for a force is filled; in another file it may be another."""
    alike = _alike(rivals)
    filled = sum(rival.rank[1] for rival in alike)
    return len(alike) > 1 and filled == 1 and rivals[0].option.quantity in FORCES


def _spare(
    columns: list[DraftColumn],
    bare: Bare,
    rival: _Proposal,
    values: np.ndarray,
    kind: Kind,
    rivals: list[_Proposal],
) -> DraftColumn:
    """Fill in one of several columns for a force: the first that is filled will be taken."""
    column = filled_in(columns[rival.place], bare, rival.option, values, kind, several=False)
    best = max(rivals).place
    note = "" if rival.place == best else f"nothing but zeros here; column {best + 1} is filled"
    return column._replace(optional=True, note=note)


def _with_options(
    column: DraftColumn, rival: _Proposal, rivals: list[_Proposal], matched: list[Match]
) -> DraftColumn:
    """Add what a column may hold instead, and which other column may hold this."""
    options = column.options
    if len(_alike(rivals)) > 1:
        others = sorted(r.place for r in rivals if r is not rival)
        options = (*options, *(f"column {place + 1}" for place in others))
    if rival.option.score < KNOWN_WORD:
        others_named = (o.quantity for o in matched if o.quantity != rival.option.quantity)
        options = (*options, *others_named, "not used")
    return column._replace(options=options)


def _give_way(proposals: dict[str, list[_Proposal]], matched: list[list[Match]]) -> None:
    """Let a vague name mean what nothing else is called, where a better one has its quantity."""
    for rivals in list(proposals.values()):
        best = max(rivals)
        for rival in [r for r in rivals if r is not best and r.option.score < KNOWN_WORD]:
            others = [o for o in matched[rival.place] if o.score >= rival.option.score - 0.05]
            free = [o for o in others if o.quantity not in proposals]
            if free and best.option.score >= KNOWN_WORD:
                rivals.remove(rival)
                proposals[free[0].quantity] = [rival._replace(option=free[0])]


def _take_the_other(
    proposals: dict[str, list[_Proposal]], matched: list[list[Match]], torque: bool
) -> None:
    """Let a name of either force be no guess where the other force is surely named."""
    for name, other in (_EITHER, _EITHER[::-1]):
        rivals = proposals.get(name, [])
        if len(rivals) != 1 or rivals[0].option.score >= KNOWN_WORD:
            continue
        meant = {option.quantity for option in matched[rivals[0].place]}
        if not set(_EITHER) <= meant:
            continue
        sure = any(rival.option.score >= KNOWN_WORD for rival in proposals.get(other, []))
        if name == "friction_force" and torque and not proposals.get(other):
            proposals[other] = proposals.pop(name)
            name, sure = other, True
        if sure:
            option = rivals[0].option._replace(quantity=name, score=KNOWN_WORD)
            proposals[name] = [rivals[0]._replace(option=option)]


def _told_by(unit: str, si_unit: str) -> bool:
    """Whether a unit tells something of the quantity: a number without a unit may be anything."""
    return si_unit != "1" and converts(unit, si_unit)


def _preferred(
    options: list[Match], unit: str | None, values: np.ndarray, has_units: bool
) -> Match | None:
    """Of several quantities that a name may stand for, the one that suits unit and numbers."""
    if not options or unit is not None:
        return options[0] if options else None
    top = [option for option in options if option.score > options[0].score - 0.05]
    if len(top) > 1:
        ratio = next((o for o in top if QUANTITIES[o.quantity].unit == "1"), None)
        sizes = np.abs(values[np.isfinite(values)])
        if ratio and (has_units or (sizes.size and np.median(sizes) < 2)):
            return ratio
        steps = np.diff(values)
        if top[0].quantity == "time" and not (steps >= 0).all():
            return top[1]
    return options[0]
