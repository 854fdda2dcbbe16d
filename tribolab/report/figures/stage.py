"""The figures of a report: drawn by workers, taken over where what they show is the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Protocol, TypeVar

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.catalogue import Store
from tribolab.provenance import sha256_of
from tribolab.records.part_records import FigureRecord
from tribolab.records.parts import Notice
from tribolab.report.code import code_of_figures
from tribolab.report.figures.files import DRAWING, Drawn, save_figure
from tribolab.words import explain


@dataclass(frozen=True)
class FigureTask:
    """A figure to draw.

    Parameters
    ----------
    section
        Key of report.json under which its record stands.
    file
        Path of the picture relative to the results folder.
    title
        What it shows.
    draw
        The results folder in; the figure, its caption, what it says in words, and its kind out,
        or None where there is nothing to show. A function of a module, with what it wants to know,
        that it may travel.
    pdf
        Whether to write it as PDF, too.
    """

    section: str
    file: str
    title: str
    draw: Callable[[Path], Drawn | None]
    folder: Path = Path()
    pdf: bool = False
    fingerprint: str = ""

    @property
    def name(self) -> str:
        """Of its record: that of the picture."""
        return self.file


class Planned(Protocol):
    """What knows a figure before it is drawn: its kinds of figures do, each in its own way."""

    @property
    def file(self) -> str:
        """Path of the picture relative to the results folder."""

    @property
    def title(self) -> str:
        """What it shows."""

    @property
    def files(self) -> tuple[str, ...]:
        """Data files that it reads."""


Unfigured = Notice | None  # why there is no figure, or that there is nothing to show
What = TypeVar("What", bound=Planned)


class Figures(Recorded[FigureTask, FigureRecord, Unfigured]):
    """The stage of the figures."""

    name = "figures"
    kind = "figure"
    record = FigureRecord

    def taken(self, task: FigureTask, record: FigureRecord) -> FigureRecord | None:
        """Take over the picture, its numbers, and its PDF if that is wanted."""
        beside = [record.data] if record.data else []
        beside += [str(Path(record.file).with_suffix(".pdf"))] if task.pdf else []
        there = self.linked(task, record.file, record.file)
        return record if there and all(map(self._store.link_beside, beside)) else None

    def order(self, tasks: Sequence[tuple[int, FigureTask]]) -> list[tuple[int, FigureTask]]:
        """Return what takes longest first: traces and spectra of the sliding."""
        return sorted(tasks, key=lambda pair: pair[1].section != "sliding_figures")

    @staticmethod
    def work(task: FigureTask) -> FigureRecord | None:
        """Draw one figure into the results."""
        return draw_figure(task)

    def failed(self, task: FigureTask, error: BaseException) -> Notice:
        """Return why a figure could not be drawn."""
        return Notice("error", "", f"figure {task.title}", explain(error)[0])


def draw_figure(task: FigureTask) -> FigureRecord | None:
    """Draw one figure, and write it with the numbers that it shows."""
    with DRAWING:
        drawn = task.draw(task.folder)
        if drawn is None:
            return None
        return save_figure(drawn, task.folder, task.file, pdf=task.pdf)


def planned(
    section: str,
    figures: Sequence[What],
    draw: Callable[[What, Path], Drawn | None],
    store: Store,
    *,
    pdf: bool = False,
) -> list[FigureTask]:
    """Make tasks of what is to be drawn."""
    tasks = []
    for what in figures:
        identities = [store.identity(file) for file in what.files]
        shaping = [code_of_figures(), draw.__qualname__, repr(what), identities]
        tasks.append(
            FigureTask(
                section=section,
                file=what.file,
                title=what.title,
                draw=partial(draw, what),
                folder=store.folder,
                pdf=pdf,
                fingerprint=sha256_of(shaping),
            )
        )
    return tasks
