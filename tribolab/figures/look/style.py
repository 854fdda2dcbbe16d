"""Common style of all figures: sizes and fonts; and writing of figures into files."""

from __future__ import annotations

import contextlib
import functools
import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import text as mpl_text
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import MathTextParser
from matplotlib.textpath import TextToPath

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType  # missing in the oldest supported matplotlib

SINGLE_MM = 86.0
DOUBLE_MM = 178.0

_RC: dict[RcKeyType, Any] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so all computers draw the same
    "mathtext.fontset": "dejavusans",
    "font.size": 7.5,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "axes.titley": 1.0,  # otherwise matplotlib computes the position from the ticks
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "legend.columnspacing": 1.4,
    "legend.handletextpad": 0.5,
    "legend.borderaxespad": 0.0,
    "axes.linewidth": 0.6,
    "axes.formatter.useoffset": False,
    "axes.unicode_minus": True,
    "axes.edgecolor": "#222222",
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "xtick.minor.size": 1.6,
    "ytick.minor.size": 1.6,
    "lines.linewidth": 0.8,
    "lines.markersize": 4,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "figure.dpi": 100,
    # letters as outlines look the same everywhere and need no font
    "svg.fonttype": "path",
    "svg.hashsalt": "tribolab",
    # TrueType, because journals reject matplotlib's default Type 3 fonts
    "pdf.fonttype": 42,
    "ps.fonttype": 42,
    "path.simplify": True,
}


class PaperFigure(Figure):
    """Matplotlib figure that a notebook displays without the help of pyplot.

    pyplot would keep a list of all figures, which the user would have to close.
    """

    def _ipython_display_(self) -> None:
        # explicit, because pyplot's inline backend would halve the resolution
        from IPython.display import display

        display({"image/png": self._repr_png_()}, raw=True)

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        with paper_style():
            self.savefig(buffer, format="png", dpi=200)
        return buffer.getvalue()


_NUMBERS = "_tribolab_numbers"  # name of the attribute that stores a figure's numbers


def keep(figure: Figure, panel: str, series: str, **columns: np.ndarray) -> None:
    """Store the numbers of a drawn series in the figure, for `figure_data`."""
    vars(figure).setdefault(_NUMBERS, []).append({"panel": panel, "series": series, **columns})


def figure_data(figure: Figure) -> pd.DataFrame:
    """Return a table of the numbers that functions of `tribolab.plot` have drawn in a figure.

    Parameters
    ----------
    figure
        Figure returned by a function of `tribolab.plot`, or drawn in by it.

    Returns
    -------
    pandas.DataFrame
        A row per drawn point: `panel`, `series`, and columns with their unit in the name
        (``sliding_speed_m_s``).

    Examples
    --------
    >>> import xarray as xr
    >>> import tribolab as tl
    >>> curve = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [0.3, 0.4])}, {"sliding_speed": [1e-4, 1e-3]}
    ... )
    >>> figure_data(tl.plot.stribeck(measured=curve))[["sliding_speed_m_s", "friction_coefficient"]]
       sliding_speed_m_s  friction_coefficient
    0             0.0001                   0.3
    1             0.0010                   0.4
    """
    numbers = [pd.DataFrame(columns) for columns in vars(figure).get(_NUMBERS, [])]
    return pd.concat(numbers, ignore_index=True) if numbers else pd.DataFrame()


@contextlib.contextmanager
def paper_style() -> Iterator[None]:
    """Context in which matplotlib draws in the style of this package.

    Examples
    --------
    >>> import matplotlib
    >>> before = matplotlib.rcParams["font.size"]
    >>> with paper_style():
    ...     pass
    >>> matplotlib.rcParams["font.size"] == before
    True
    """
    with mpl.rc_context():
        # matplotlib's defaults first: a user's matplotlibrc must not change the figures
        defaults = {k: v for k, v in mpl.rcParamsDefault.items() if k not in _KEEP}
        mpl.rcParams.update(defaults)
        mpl.rcParams.update(_RC)
        yield


_KEEP = {"backend", "backend_fallback", "interactive", "toolbar", "timezone", "date.epoch"}


def new_figure(width_mm: float, height_mm: float) -> PaperFigure:
    """Return an empty figure of the given size [mm]; call inside `paper_style()`."""
    return PaperFigure(figsize=(width_mm / 25.4, height_mm / 25.4))


def tidy(axes: Axes, letter: str = "") -> None:
    """Write the letter of a panel, e.g. (a), into its upper left corner."""
    if letter:
        axes.annotate(
            f"({letter})",
            (0, 1),
            xytext=(4, -4),
            xycoords="axes fraction",
            textcoords="offset points",
            va="top",
            fontsize=8,
            fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.8},
            zorder=10,
        )


_DRAWN = re.compile(r' d="([^"]*)"')
_DECIMALS = re.compile(r"-?\d+\.\d{3,}")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_POLYLINE = re.compile(r"[MLz\d\s.+-]*")


def _rounded(match: re.Match[str]) -> str:
    return f"{float(match[0]):.2f}".rstrip("0").rstrip(".")


def _shorten_path(match: re.Match[str]) -> str:
    """Return an SVG path with two decimals, and without the letters L that SVG does not need."""
    path = " ".join(_DECIMALS.sub(_rounded, match[1]).split())
    if _POLYLINE.fullmatch(path):  # after M, SVG reads pairs of numbers as lines without L
        path = path.replace(" L ", " ")
    return f' d="{path}"'


_PLACE = re.compile(r' [xy]="[^"]*"|translate\([^)]*\)')  # positions, but not scales
_GROUP_ID = re.compile(r'<g id="[^"]*"')
_SYMBOL = re.compile(r'<path id="([^"]+)"[^>]*? style="([^"]*)"')
_USE = re.compile(r'<use xlink:href="#([^"]+)"([^>]*?) style="([^"]*)"/>')
_BARE_GROUP = re.compile(r"<g>\n(<use[^>]*/>)\n</g>")


def _shorten_svg(text: str) -> str:
    """Return a shorter SVG: fewer decimals, and no indents, ids or repeated styles."""
    text = _DRAWN.sub(_shorten_path, _COMMENT.sub("", text))
    text = _PLACE.sub(lambda match: _DECIMALS.sub(_rounded, match[0]), text)
    styles = dict(_SYMBOL.findall(text))

    def use(match: re.Match[str]) -> str:
        name, place, own = match.groups()
        return match[0] if styles.get(name) != own else f'<use xlink:href="#{name}"{place}/>'

    text = re.sub(r"\n\s*", "\n", _GROUP_ID.sub("<g", _USE.sub(use, text)))
    for _ in range(2):  # remove groups around a single symbol
        text = _BARE_GROUP.sub(r"\1", text)
    return text


class _CachedTexts(TextToPath):
    """Matplotlib's converter of text to outlines, with one cache for all figures."""

    _formulas = MathTextParser("path")

    def __init__(self) -> None:
        super().__init__()
        self.mathtext_parser = self._formulas

    def get_text_width_height_descent(
        self, s: str, prop: FontProperties, ismath: bool | Literal["TeX"]
    ) -> tuple[float, float, float]:
        return _measured(s, prop.copy(), ismath)


@functools.lru_cache(4096)
def _measured(
    text: str, font: FontProperties, formula: bool | Literal["TeX"]
) -> tuple[float, float, float]:
    return TextToPath.get_text_width_height_descent(_CachedTexts(), text, font, formula)


@contextlib.contextmanager
def _share_text_cache() -> Iterator[None]:
    """Context in which matplotlib measures each text and formula only once."""
    own = vars(mpl_text)["TextToPath"]
    vars(mpl_text)["TextToPath"] = _CachedTexts
    try:
        yield
    finally:
        vars(mpl_text)["TextToPath"] = own


def svg(figure: Figure) -> str:
    """Return a figure as SVG; equal data give equal text, because it has no date or random ids.

    Coordinates are rounded to 0.01 pt (4 um on paper), which halves the size of a trace.

    Examples
    --------
    >>> import xarray as xr
    >>> import tribolab as tl
    >>> curve = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [0.3, 0.4])}, {"sliding_speed": [1e-4, 1e-3]}
    ... )
    >>> svg(tl.plot.stribeck(measured=curve)).strip().endswith("</svg>")
    True
    """
    buffer = io.StringIO()
    with paper_style(), _share_text_cache():
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "tribolab"})
    return _shorten_svg(buffer.getvalue())


def save(figure: Figure, path: str | Path) -> Path:
    """Write a figure into a file; the suffix determines the format, e.g. .svg, .pdf or .png.

    Parameters
    ----------
    figure
        Figure returned by a function of `tribolab.plot`.
    path
        The file; its folder must exist.

    Examples
    --------
    >>> import tempfile
    >>> import xarray as xr
    >>> import tribolab as tl
    >>> curve = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [0.3, 0.4])}, {"sliding_speed": [1e-4, 1e-3]}
    ... )
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(tl.plot.stribeck(measured=curve), Path(folder) / "curve.svg").name
    'curve.svg'
    """
    path = Path(path)
    if path.suffix.lower() == ".svg":
        path.write_text(svg(figure), encoding="utf-8")
    else:
        with paper_style():
            figure.savefig(path, dpi=300)
    return path
