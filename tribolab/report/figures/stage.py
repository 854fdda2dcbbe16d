"""Drawing of the figure files in worker processes; unchanged figures are reused."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import explain, force_text
from tribolab.figures.spec import FigureSpec, Series, legend, safe
from tribolab.figures.subjects.surfaces import shaded_loads
from tribolab.records.part_records import FigureRecord
from tribolab.records.parts import Notice
from tribolab.report import tables
from tribolab.report.code import code_of_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# held while drawing, because matplotlib's fonts are not thread-safe
DRAWING = threading.Lock()
SECTIONS = ("figures", "surface_figures", "model_figures", "sliding_figures")
_MAX_LABELS = 12  # most labels in the legend of one figure
_KEYS = {"surfaces": 1, "contact": 1, "model": 2, "sliding": 3}  # page section: index in SECTIONS


@dataclass(frozen=True)
class DrawnFigures:
    """Figure files of one subject, e.g. a surface and medium, in the results folder."""

    figures: tuple[FigureRecord, ...]


@dataclass(frozen=True)
class FigureTask:
    """Task to draw the figures of one subject; `make` describes them and can be pickled."""

    name: str
    make: Callable[[Path], Sequence[FigureSpec]]
    folder: Path
    fingerprint: str
    pdf: bool = False


class Figures(Recorded[FigureTask, DrawnFigures, Notice]):
    """Tasks that draw the figure files, one for each subject."""

    name = "figures"
    kind = "figure"
    record = DrawnFigures

    def taken(self, task: FigureTask, record: DrawnFigures) -> DrawnFigures | None:
        """Return the record if all files can be reused: figures, tables, and PDFs if wanted."""
        files = [name for one in record.figures for name in (one.file, one.data) if name]
        files += [_pdf(one.file) for one in record.figures if task.pdf]
        return record if all(map(self._store.link_file, files)) else None

    @staticmethod
    def work(task: FigureTask) -> DrawnFigures:
        """Draw the figures of one subject into the results folder."""
        specs = [one for spec in task.make(task.folder) if spec.series for one in on_paper(spec)]
        return DrawnFigures(tuple(draw_figure(spec, task.folder, pdf=task.pdf) for spec in specs))

    def failed(self, task: FigureTask, error: BaseException) -> Notice:
        """Return a finding with the reason why figures could not be drawn."""
        return Notice("error", "", f"figures of {task.name}", explain(error)[0])


def figure_task(
    name: str,
    make: Callable[[Path], Sequence[FigureSpec]],
    shaping: object,
    files: Sequence[str],
    store: Store,
    *,
    pdf: bool = False,
) -> FigureTask:
    """Return a drawing task, with a checksum of all that affects its figures.

    Parameters
    ----------
    name
        Name of the subject.
    make
        Picklable function that returns the figures' descriptions.
    shaping
        Arguments of that function; their text identifies them.
    files
        Data files that are read, relative to the results folder.
    store
        Store with their checksums.
    pdf
        Whether to write figures also as PDF.
    """
    identities = [store.identity(file) for file in files]
    mark = sha256_of([code_of_figures(), name, repr(shaping), identities])
    return FigureTask(name, make, store.folder, mark, pdf)


def described_tasks(
    specs: Sequence[FigureSpec], store: Store, *, pdf: bool = False
) -> list[FigureTask]:
    """Return a task for each figure that is already described."""
    return [figure_task(spec.id, partial(_given, spec), spec, (), store, pdf=pdf) for spec in specs]


def _given(spec: FigureSpec, folder: Path) -> list[FigureSpec]:
    return [spec]


def draw_figure(spec: FigureSpec, folder: Path, *, pdf: bool = False) -> FigureRecord:
    """Draw a described figure into files: SVG and a table of its numbers; return its record.

    Parameters
    ----------
    spec
        Description of the figure.
    folder
        The results folder.
    pdf
        Whether to write it also as PDF.
    """
    # imported late: matplotlib is needed only to draw files
    from tribolab.figures.look.drawing import draw

    file = f"figures/{file_name(spec)}.svg"
    with DRAWING:
        data = write_figure(draw(spec), folder, file, pdf=pdf)
    caption = f"{spec.title}. {spec.note}".strip()
    return FigureRecord(file, data, caption, spec.alt or spec.title, spec.section)


def write_figure(figure: Figure, folder: Path, file: str, *, pdf: bool = False) -> str:
    """Write a figure as SVG and a table of its numbers; return the file of the table or "".

    Parameters
    ----------
    figure
        From one of the functions of `tribolab.plot`.
    folder
        The results folder.
    file
        Path of the SVG relative to this folder; the table has the same name with ``.csv``.
    pdf
        Whether to write it also as PDF.
    """
    # imported late: matplotlib is needed only to draw files
    from tribolab import plot

    plot.save(figure, folder / file)
    if pdf:
        plot.save(figure, folder / _pdf(file))
    numbers = plot.figure_data(figure)
    if not len(numbers):
        return ""
    data = Path(file).with_suffix(".csv").as_posix()
    # nine digits exceed the resolution of any figure
    tables.write_csv(numbers, folder / data, digits=9)
    return data


def file_name(spec: FigureSpec) -> str:
    """Return the name of a figure's files without suffix, e.g. with surface and medium.

    Examples
    --------
    >>> file_name(FigureSpec(id="card-1", section="view-curve", title="Sb-R, glycerol"))
    'stribeck_sb-r_glycerol'
    """
    if spec.section == "view-curve":
        return f"stribeck_{safe(spec.title)}"
    return spec.id.replace("-", "_", 1)


def on_paper(spec: FigureSpec) -> list[FigureSpec]:
    """Return a figure for publication with all loads, labelled and shaded; the page shows one.

    If the legend would be too long, return one figure for each load.
    """
    loads = sorted({one.load for one in spec.series if one.load is not None})
    if not spec.one_load or len(loads) < 2:
        return [spec]
    ranks = {load: rank for rank, load in enumerate(loads)}
    alone = len({one.surface for one in spec.series}) == 1

    def named(one: Series) -> Series:
        if one.load is None:
            return one
        marker = ranks[one.load] if alone else one.marker
        return replace(one, label=f"{one.label}, {force_text(one.load)}", marker=marker)

    whole = replace(spec, series=shaded_loads([named(one) for one in spec.series]))
    if len(legend(whole.series)) <= _MAX_LABELS:
        return [whole]
    return [
        replace(
            spec,
            id=f"{spec.id}_{safe(force_text(load)).replace('_', '')}",
            title=f"{spec.title}, {force_text(load)}",
            series=tuple(one for one in spec.series if one.load in (None, load)),
        )
        for load in loads
    ]


def key_of(record: FigureRecord) -> str:
    """Return the key of report.json under which a figure is listed."""
    return SECTIONS[_KEYS.get(record.kind, 0)]


def _pdf(file: str) -> str:
    return str(Path(file).with_suffix(".pdf"))
