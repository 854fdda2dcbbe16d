"""Records of live figures, and the stage that makes them if their data changed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.catalogue import Store
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import explain
from tribolab.records.parts import Notice
from tribolab.report.code import code_of_figures
from tribolab.report.page_figures.shown import ShownFigure


class Band(NamedTuple):
    """Speeds [m/s], and lower and upper bound of a model's friction."""

    speed: list[float | None]
    low: list[float | None]
    high: list[float | None]


@dataclass(frozen=True)
class PageRecord:
    """Figures made from data files, and model bands by name of the curve."""

    figures: tuple[ShownFigure, ...] = ()
    bands: dict[str, Band] = field(default_factory=dict)


@dataclass(frozen=True)
class PageTask:
    """Figures of one kind to make; `make` takes the results folder and can be pickled."""

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
    """Return a task with the checksum of everything that affects its figures.

    Parameters
    ----------
    name
        Kind of figures.
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
    """Stage of the figures that the page draws."""

    name = "page"
    kind = "live"
    record = PageRecord

    @staticmethod
    def work(task: PageTask) -> PageRecord:
        """Make figures of one kind."""
        return task.make(task.folder)

    def failed(self, task: PageTask, error: BaseException) -> Notice:
        """Return the reason why figures could not be made."""
        return Notice("error", "", f"figures of {task.name}", explain(error)[0])
