"""Layout of a figure for publication: size, panels, legend and title."""

from __future__ import annotations

from typing import NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.figures.labels import plain
from tribolab.figures.look.style import DOUBLE_MM, SINGLE_MM, new_figure, tidy
from tribolab.figures.spec import FigureSpec

_RIGHT, _BOTTOM, _PANEL = 3.0, 10.5, 50.0  # right and lower margin, height of a panel [mm]
_SHARED_GAP, _OWN_GAP = 3.0, 13.0  # gap between panels that share an abscissa, or do not [mm]
_ROW = 5.2  # height of a row of an axis with names [mm]
_LETTER = 1.38  # mean width of a 7 pt character [mm]
_LEGEND_ROW, _TITLE_ROW = 3.8, 4.5  # height of a legend row and of a title [mm]
_LINE_LENGTH = 7.5  # length of a legend entry without its text [mm]
_NAMES = 42.0  # widest left margin for an axis with names [mm]


class Sheet(NamedTuple):
    """Matplotlib figure with its panels; size and left margin in mm; `rows` of the legend."""

    figure: Figure
    panels: list[Axes]
    width: float = SINGLE_MM
    height: float = 0.0
    left: float = 0.0
    shared: bool = False
    title: str = ""
    rows: int = 0


def new_sheet(spec: FigureSpec, title: str = "", width: float = 0.0) -> Sheet:
    """Return a matplotlib figure with empty panels as a description requires."""
    width = width or (DOUBLE_MM if spec.width == "whole" or spec.across > 1 else SINGLE_MM)
    count, across = len(spec.panels), min(spec.across, len(spec.panels))
    shared = count > 1 and len({panel.x for panel in spec.panels}) == 1
    left = _left(spec)
    down = -(-count // across)
    heights = [_height(spec, row * across) for row in range(down)]
    above = 4.0 * any(panel.title for panel in spec.panels)
    gap = (_SHARED_GAP if shared else _OWN_GAP) + above
    rows = _legend_rows(spec, width - left - _RIGHT)
    top = 3.0 + rows * _LEGEND_ROW + (_TITLE_ROW if title else 0) + above
    height = sum(heights) + gap * (down - 1) + top + _BOTTOM
    figure = new_figure(width, height)
    each = (width - _RIGHT) / across
    panels, edge = [], height - top
    for row, tall in enumerate(heights):
        edge -= tall
        for column in range(min(across, count - row * across)):
            box = (column * each + left, edge, each - left - (across > 1) * 1.0, tall)
            panels.append(
                figure.add_axes((box[0] / width, box[1] / height, box[2] / width, box[3] / height))
            )
        edge -= gap
    return Sheet(figure, panels, width, height, left, shared, title, rows)


def _height(spec: FigureSpec, number: int) -> float:
    """Return the height of a panel [mm]; an ordinate with names needs a row for each."""
    names = {y for s in spec.series if s.panel == number for y in s.y if isinstance(y, str)}
    if names:
        lines = sum(1 + (len(name) > 25) for name in names)
        return max(12.0, _ROW * lines * spec.panels[number].height)
    return _PANEL * spec.panels[number].height


def _left(spec: FigureSpec) -> float:
    names = [y for series in spec.series for y in series.y if isinstance(y, str)]
    if names:
        return min(_NAMES, max(len(name) for name in names) * _LETTER + 4.0)
    return 16.0


def entries(spec: FigureSpec) -> list[str]:
    """Return the legend entries in order; empty if there is only one."""
    words = [s.label for s in spec.series] + [m.text for m in spec.marks]
    words = list(dict.fromkeys([*words, *(key.label for key in spec.keys)]))
    return [word for word in words if word] if len([w for w in words if w]) > 1 else []


def _columns(words: list[str], width: float) -> int:
    longest = max(map(len, words)) * _LETTER + _LINE_LENGTH
    return max(1, min(len(words), int(width / longest)))


def _legend_rows(spec: FigureSpec, width: float) -> int:
    words = entries(spec)
    return -(-len(words) // _columns(words, width)) if words else 0


def finish(spec: FigureSpec, sheet: Sheet) -> None:
    """Add panel letters, titles and the legend to a drawn figure."""
    for number, (axes, panel) in enumerate(zip(sheet.panels, spec.panels, strict=True)):
        if panel.title:
            axes.set_title(plain(panel.title, 48), fontsize=7, loc="left", pad=3)
        elif len(sheet.panels) > 1:
            tidy(axes, "abcdefghijkl"[number % 12])
        if sheet.shared and number + max(spec.across, 1) < len(sheet.panels):
            axes.tick_params(labelbottom=False)
    if sheet.shared:
        sheet.figure.align_ylabels(sheet.panels)
    words = entries(spec)
    if words:
        named: dict[str, Artist] = {}
        for axes in sheet.panels:
            for handle, text in zip(*axes.get_legend_handles_labels(), strict=True):
                named.setdefault(text, handle)
        top = 1 - (1.0 + (_TITLE_ROW if sheet.title else 0)) / sheet.height
        sheet.panels[0].legend(
            list(named.values()), list(named), loc="upper left",
            ncols=_columns(words, sheet.width - sheet.left - _RIGHT),
            bbox_to_anchor=(sheet.left / sheet.width, top),
            bbox_transform=sheet.figure.transFigure,
        )  # fmt: skip
    if sheet.title:
        sheet.figure.text(
            sheet.left / sheet.width, 1 - 1.3 / sheet.height, plain(sheet.title), va="top",
            fontsize=8,
        )  # fmt: skip
