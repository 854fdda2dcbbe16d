"""How well a friction coefficient repeats, over speed."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tribolab.errors import AnalysisError
from tribolab.figures.labels import plain
from tribolab.figures.look.frame import speed_axis
from tribolab.figures.look.guests import one_panel
from tribolab.figures.look.style import (
    BLACK,
    BLUE,
    condition_style,
    keep,
)


def precision(table: pd.DataFrame, *, title: str = "", ax: Axes | None = None) -> Figure:
    """Draw the standard deviations within and between mounts, days ... over speed.

    Parameters
    ----------
    table
        As in `tribolab.across.repeatability.Repeatability`: ``sliding_speed_m_s``, ``mean``,
        ``repeatability_std``, ``between_..._std`` and ``reproducibility_std``; a row without a
        speed is left out.
    title
        Text above.
    ax
        Axes to draw in; without them a figure is made.

    Returns
    -------
    matplotlib.figure.Figure
        All of them relative to the mean, in per cent.

    Raises
    ------
    AnalysisError
        If there is no speed.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> table = pd.DataFrame({
    ...     "sliding_speed_m_s": [1e-4], "mean": [0.5], "repeatability_std": [0.01],
    ...     "between_mount_std": [0.02], "reproducibility_std": [0.0224],
    ... })
    >>> figure_data(precision(table)).relative_standard_deviation.round(4).tolist()
    [0.02, 0.04, 0.0448]
    """
    rows = table[np.isfinite(table["sliding_speed_m_s"])]
    if rows.empty:
        raise AnalysisError("there is nothing to draw: no speed has a standard deviation")
    columns = [c for c in map(str, rows) if c.endswith("_std")]
    with one_panel(ax, title) as (figure, axes):
        speed = rows["sliding_speed_m_s"].to_numpy(dtype=float)
        between = (condition_style(k).colour for k in range(1, len(columns) + 1))
        for name in columns:
            words = name.removesuffix("_std").replace("_", " ")
            look = _LOOKS.get(words) or (next(between), "s--")
            text = {"repeatability": "within", "reproducibility": "all together"}.get(words, words)
            value = rows[name].to_numpy(dtype=float) / rows["mean"].abs().to_numpy(dtype=float)
            axes.plot(speed, 100 * value, look[1], color=look[0], markersize=3.5, label=plain(text))
            keep(
                figure, "precision", words, sliding_speed_m_s=speed,
                relative_standard_deviation=value,
            )  # fmt: skip
        speed_axis(axes)
        axes.set_ylim(0.0, 1.15 * axes.dataLim.y1 or 1.0)
        axes.set_ylabel("standard deviation (% of the mean)")
    return figure


_LOOKS = {"repeatability": (BLUE, "o-"), "reproducibility": (BLACK, "^:")}
