"""Making of the page's figures in worker processes; unchanged figures are reused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import explain
from tribolab.records.parts import Notice
from tribolab.report.code import code_of_figures
from tribolab.report.page_figures.shown import ShownFigure


class Band(NamedTuple):
    """Uncertainty band of a computed curve: speeds [m/s], lower and upper friction."""

    speed: list[float | None]
    low: list[float | None]
    high: list[float | None]


@dataclass(frozen=True)
class PageRecord:
    """Figures of one subject, and the bands of computed curves by name of the measured curve."""

    figures: tuple[ShownFigure, ...] = ()
    bands: dict[str, Band] = field(default_factory=dict)


@dataclass(frozen=True)
class PageTask:
    """Task to make the figures of one subject; `make` takes the results folder."""

    name: str
    make: Callable[[Path], PageRecord]
    folder: Path
    fingerprint: str


def page_task(
    name: str,
    make: Callable[[Path], PageRecord],
    shaping: object,
    files: Sequence[str],
    store: Store,
) -> PageTask:
    """Return a task, with a checksum of all that affects its figures.

    Parameters
    ----------
    name
        Subject of the figures.
    make
        Picklable function that makes the figures.
    shaping
        Its arguments; their text identifies them.
    files
        Data files that are read, relative to the results folder.
    store
        Store with the identities of these files.
    """
    identities = [store.identity(file) for file in files]
    fingerprint = sha256_of([code_of_figures(), name, repr(shaping), identities])
    return PageTask(name, make, store.folder, fingerprint)


class PageFigures(Recorded[PageTask, PageRecord, Notice]):
    """Tasks that make the interactive figures of the page, one for each subject."""

    name = "page"
    kind = "live"
    record = PageRecord

    @staticmethod
    def work(task: PageTask) -> PageRecord:
        """Return the figures of one subject."""
        return task.make(task.folder)

    def failed(self, task: PageTask, error: BaseException) -> Notice:
        """Return a finding with the reason why figures could not be made."""
        return Notice("error", "", f"figures of {task.name}", explain(error)[0])
