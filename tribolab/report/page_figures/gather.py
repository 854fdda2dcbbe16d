"""Figures that need the data files of a campaign: collected by subject, made by workers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.campaign.engine.stage import begun
from tribolab.campaign.recorded import done_and_failed
from tribolab.campaign.store.new_catalogue import Store
from tribolab.figures.spec import FigureSpec
from tribolab.records.models.joint_record import JointRecord
from tribolab.records.models.mode_record import ModeRecord
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import Notice
from tribolab.report.document.models import ModelRow
from tribolab.report.page_figures.joint import joint_specs
from tribolab.report.page_figures.models import bands_of_models, model_specs
from tribolab.report.page_figures.ramps import MAX_RUNS, has_ramps, ramp_specs
from tribolab.report.page_figures.record import Band, PageFigures, PageRecord, page_task
from tribolab.report.page_figures.shown import shown_figures
from tribolab.report.page_figures.sliding import sliding_specs
from tribolab.report.page_figures.surfaces import surface_specs
from tribolab.report.page_figures.waveforms import Judged
from tribolab.report.slowest import slow_segments

if TYPE_CHECKING:
    from tribolab.campaign.store.outcome import OpenOutcome

Make = Callable[[Path], Sequence[FigureSpec]]
Bands = Callable[[Path], dict[str, Band]]


def begun_page_figures(
    subjects: Sequence[Subject], store: Store, executor: Executor | None = None
) -> Callable[[], tuple[list[PageRecord], list[Notice]]]:
    """Start to make the figures of the page; return a function that waits for them.

    Parameters
    ----------
    subjects
        From `figure_subjects`.
    store
        Store with records and checksums.
    executor
        Executor; without one the figures are made in this process.
    """
    tasks = [
        page_task(
            subject.name,
            partial(_page_record, subject.make, subject.bands),
            subject.shaping,
            subject.files,
            store,
        )
        for subject in subjects
    ]
    making = begun(PageFigures(store, tasks), executor)
    return lambda: done_and_failed(making())


def _page_record(make: Make, bands: Bands | None, folder: Path) -> PageRecord:
    shown = shown_figures(make(folder))
    return PageRecord(shown, bands(folder) if bands is not None else {})


class Subject(NamedTuple):
    """Figures of one subject: function that describes them, its arguments, files that it reads."""

    name: str
    make: Make
    shaping: object
    files: Sequence[str]
    bands: Bands | None = None


def figure_subjects(
    outcome: OpenOutcome,
    curves: Sequence[CurveRecord],
    models: Sequence[ModelRow],
    modes: Mapping[str, ModeRecord],
    joints: Sequence[JointRecord],
) -> list[Subject]:
    """Return the subjects for figures: ramps, models, joint fits, surfaces, stick-slip.

    Parameters
    ----------
    outcome
        The campaign's results.
    curves
        Measured curves that can be shown.
    models
        Models with results.
    modes
        Sliding modes by name of the curve.
    joints
        Joint fits with results.
    """
    surfaces = tuple(surface.name for surface in outcome.surfaces)
    judged = [
        Judged(curve.outcome, modes[curve.outcome.name], slow_segments(curve.outcome, outcome))
        for curve in curves
        if curve.outcome.name in modes
    ]
    done = [surface for surface in outcome.surfaces if surface.done]
    traced = dict.fromkeys(contact.slow.file for contact in judged if contact.slow)
    ramps = [run for run in outcome.runs if has_ramps(run)][:MAX_RUNS]
    alone = not outcome.runs  # without runs, surfaces are the first view of the page
    return [
        Subject("ramps", partial(ramp_specs, ramps), ramps, [run.data_file for run in ramps]),
        Subject(
            "models",
            partial(model_specs, models, surfaces),
            ([(row.labels, row.fit, row.sensitivity) for row in models], surfaces),
            [row.model.data_file for row in models],
            partial(bands_of_models, models),
        ),
        Subject(
            "joint fits",
            partial(joint_specs, joints, surfaces),
            (joints, surfaces),
            [joint.file for joint in joints],
        ),
        Subject(
            "surfaces",
            partial(surface_specs, done, surfaces, alone),
            ([(surface.name, surface.parts, surface.quality) for surface in done], surfaces, alone),
            [surface.data_file for surface in done],
        ),
        Subject(
            "sliding", partial(sliding_specs, judged, surfaces), (judged, surfaces), list(traced)
        ),
    ]
