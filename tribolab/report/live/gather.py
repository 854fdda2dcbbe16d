"""All live figures of a campaign: made from its records, and from data files where they changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from functools import partial
from typing import TYPE_CHECKING

from tribolab.campaign.engine.stage import begun
from tribolab.campaign.recorded import done_and_failed
from tribolab.figures.spec import FigureSpec
from tribolab.records.joint_record import JointRecord
from tribolab.records.mode_record import ModeRecord
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import Notice
from tribolab.report.document.models import ModelRow
from tribolab.report.live.compared import comparisons
from tribolab.report.live.curves import FrictionOverSpeed, card_figures, model_figures
from tribolab.report.live.joint import record_of_joint_fits
from tribolab.report.live.models import record_of_models
from tribolab.report.live.points import RunPoint
from tribolab.report.live.record import Band, LiveFigures, LiveTask, Missed, live_task
from tribolab.report.live.shown import ShownFigure, shown_figures
from tribolab.report.live.sliding import Judged, record_of_sliding
from tribolab.report.live.surfaces import record_of_surfaces
from tribolab.report.slowest import slow_segments

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import OpenOutcome


def begun_live_figures(
    outcome: OpenOutcome,
    curves: Sequence[CurveRecord],
    points: Mapping[str, Sequence[RunPoint]],
    along: Sequence[FigureSpec],
    rows: Mapping[str, ModelRow],
    modes: Mapping[str, ModeRecord],
    joints: Sequence[JointRecord],
    executor: Executor | None = None,
) -> Callable[[], tuple[list[ShownFigure], list[Notice]]]:
    """Begin the figures that the page draws, and return what waits for them.

    That gives the figures, and why others could not be made.

    Parameters
    ----------
    outcome
        What the campaign came to.
    curves
        Measured curves that can be shown.
    points
        Friction over speed of each run, by its name.
    along
        Figures of friction from stroke to stroke.
    rows
        Models that are done, by their names.
    modes
        How the curves slide, by the curve's name.
    joints
        Joint fits that are done.
    executor
        Where those that need data files are made; without one it is done here.
    """
    surfaces = tuple(surface.name for surface in outcome.surfaces)
    models = list(rows.values())
    tasks = list(_tasks(outcome, curves, models, modes, joints, surfaces))
    making = begun(LiveFigures(outcome.store, tasks), executor)

    def made() -> tuple[list[ShownFigure], list[Notice]]:
        records, findings = done_and_failed(making())
        bands: dict[str, Band] = {}
        missed: dict[str, Missed] = {}
        for record in records:
            bands |= record.bands
            missed |= record.missed
        by_curve = {row.model.curve: row for row in models}
        known = FrictionOverSpeed(curves, points, by_curve, bands, missed, surfaces)
        figures = [*card_figures(known), *comparisons(known), *along, *model_figures(known)]
        return [
            *shown_figures(figures),
            *(figure for record in records for figure in record.figures),
        ], findings

    return made


def _tasks(
    outcome: OpenOutcome,
    curves: Sequence[CurveRecord],
    models: Sequence[ModelRow],
    modes: Mapping[str, ModeRecord],
    joints: Sequence[JointRecord],
    surfaces: tuple[str, ...],
) -> list[LiveTask]:
    """Plan what is made from data files, of each kind all at once."""
    judged = [
        Judged(curve.outcome, modes[curve.outcome.name], slow_segments(curve.outcome, outcome))
        for curve in curves
        if curve.outcome.name in modes
    ]
    store = outcome.store
    done = [surface for surface in outcome.surfaces if surface.done]
    traced = dict.fromkeys(contact.slow.file for contact in judged if contact.slow)
    return [
        live_task(
            "models",
            partial(record_of_models, models, surfaces),
            ([(row.labels, row.fit, row.sensitivity) for row in models], surfaces),
            [row.model.data_file for row in models],
            store,
        ),
        live_task(
            "joint fits",
            partial(record_of_joint_fits, joints),
            joints,
            [joint.file for joint in joints],
            store,
        ),
        live_task(
            "surfaces",
            partial(record_of_surfaces, done, surfaces),
            ([(surface.name, surface.parts, surface.quality) for surface in done], surfaces),
            [surface.data_file for surface in done],
            store,
        ),
        live_task(
            "sliding",
            partial(record_of_sliding, judged, surfaces),
            (judged, surfaces),
            list(traced),
            store,
        ),
    ]
