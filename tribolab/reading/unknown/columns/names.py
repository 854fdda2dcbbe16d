"""Kind of a table (run, scan or neither) and quantities of its columns, from the column names."""

from __future__ import annotations

import itertools
import os
import re

import numpy as np

from tribolab.reading.interpret.names import Match, is_date, matches
from tribolab.reading.interpret.physics import Proof
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.cells import counted_from
from tribolab.reading.unknown.columns.decide import SIGNALS, decide
from tribolab.reading.unknown.columns.evidence import RULES, Facts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.columns.motion_evidence import MOTION_RULES
from tribolab.reading.unknown.columns.proven import restrict_to_proofs
from tribolab.reading.unknown.columns.text_evidence import (
    legend_evidence,
    mean_coefficient_evidence,
    stated_load_evidence,
)
from tribolab.reading.unknown.columns.unit_and_sign import Bare
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn, Kind

# quantities of a run: "Distance (m), COF, Wear depth (um)" is no profile, although wear is a height
_OF_RUN = {"time", "friction_force", "friction_coefficient", "normal_force", "sliding_velocity"}
_RISES = 0.9  # least share of rising steps of a clock, which may restart
_FIRST_WORD = re.compile(r"[\W_]+")
_TAG_AHEAD = re.compile(r"[^\W_]+[_.:]")
_MAX_OPEN = 20  # columns with unknown names and known units that are compared
_BY_UNIT = 0.6  # score of an unknown name whose unit shows the quantity


def has_meaning(columns: list[DraftColumn]) -> bool:
    """Whether any name or unit in the header is known, unlike 'Channel 1, Channel 2'."""
    bare = [bare_name(column)[:2] for column in columns if column.label]
    return any(unit is not None or matches(name, unit) for name, unit in bare)


def decide_by_name(
    layout: Layout,
    columns: list[DraftColumn],
    numbers: np.ndarray,
    proofs: dict[int, Proof],
    *,
    placed: bool = False,
) -> tuple[Kind, list[DraftColumn]]:
    """Return the kind of a table, and its columns with the quantities that their names mean."""
    general = (*RULES, *MOTION_RULES)
    bare = _without_tag([bare_name(column) for column in columns])
    run = [matches(name, unit) for name, unit, _ in bare]
    scan = [matches(name, unit, scan=True) for name, unit, _ in bare]
    run = restrict_to_proofs(_timed(bare, run, numbers), proofs, numbers)
    best = {options[0].quantity for options in run if options}
    profile = {options[0].quantity for options in scan if options}
    if not best & _OF_RUN and ({"x", "height"} <= profile or (placed and "height" in profile)):
        return "scan", decide(Facts(columns, bare, scan, numbers, "scan"), general)
    kind: Kind = "run" if best & ({"time"} | SIGNALS) else "table"
    rules = (
        *general,
        legend_evidence(layout),
        stated_load_evidence(layout),
        mean_coefficient_evidence(layout),
    )
    return kind, decide(Facts(columns, bare, run, numbers, kind), rules)


def _without_tag(bare: list[Bare]) -> list[Bare]:
    """Remove a prefix or suffix that names share, if this makes some of them known.

    Files: loggers of the LML braking tribometer, "Fnlj(N)", "Ftlj(N)" and "lj1_C(Nm)", "lj1_F(N)"
    (LaboratoireMecaniqueLille/Braking_Tribometer_Processing).
    """
    open_ = [p for p, (name, unit, _) in enumerate(bare) if unit and not matches(name, unit)]
    for one, other in itertools.combinations(open_[:_MAX_OPEN], 2):
        names = bare[one][0], bare[other][0]
        ahead = _TAG_AHEAD.match(os.path.commonprefix(names))
        tag = ahead[0] if ahead else ""
        behind = "" if tag else os.path.commonprefix([name[::-1] for name in names])[::-1]
        left = {
            p: bare[p][0][len(tag) : len(bare[p][0]) - len(behind)]
            for p in open_
            if (tag or behind) and bare[p][0].startswith(tag) and bare[p][0].endswith(behind)
        }
        known = [p for p in left if left[p] and matches(left[p], bare[p][1])]
        if len(behind) != 1 and {one, other} & {*known} and (tag or {one, other} <= {*known}):
            return [(left[p], *said[1:]) if p in known else said for p, said in enumerate(bare)]
    return bare


def _timed(bare: list[Bare], run: list[list[Match]], numbers: np.ndarray) -> list[list[Match]]:
    """Take a rising column in a unit of time as the time if no name means time.

    The names of several clocks in one table begin with t: "t_force (s)", "t_motor (s)".
    """
    if any(options and options[0].quantity == "time" for options in run):
        return run
    for place, (name, unit, _) in enumerate(bare):
        dated = is_date(name) and not run[place]
        if dated and counted_from(numbers[:, place], unit, dated=True):
            named = [Match("time", 1.0, None)]
            return [named if index == place else options for index, options in enumerate(run)]
    rising = [
        place
        for place, (_, unit, _) in enumerate(bare)
        if len(numbers) > 1 and unit is not None and not run[place] and converts(unit, "s")
        if (np.diff(numbers[:, place]) >= 0).mean() > _RISES
    ]
    clocks = {p for p in rising if _FIRST_WORD.split(bare[p][0].lower())[0] == "t"}
    if not clocks and len(rising) != 1:
        return run
    taken = [Match("time", 1.0 if clocks else _BY_UNIT, None)]
    return [taken if p in (clocks or rising) else options for p, options in enumerate(run)]
