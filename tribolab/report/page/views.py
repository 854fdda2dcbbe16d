"""Views of the first screen, e.g. µ against speed or time, ordered to suit the test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.figures.spec import KeyTable
from tribolab.report.page.key_numbers import friction_numbers, roughness_numbers, settled_numbers
from tribolab.report.page_figures.shown import ShownFigure

_TITLES = {
    "curve": "µ vs. speed",
    "static": "Static and kinetic",
    "distance": "µ vs. distance",
    "time": "µ vs. time",
    "cycles": "µ vs. cycles",
    "ramp": "µ vs. speed, ramps",
    "load": "µ vs. load",
    "surfaces": "Surfaces",
}
_MIN_SPEEDS = 2  # fewest speeds for which µ against speed is the first view


class View(NamedTuple):
    """Figures that are shown together, with the key numbers below them."""

    name: str
    title: str
    figures: tuple[ShownFigure, ...]
    numbers: KeyTable | None = None

    @property
    def columns(self) -> int:
        """Number of figures side by side, so that they fill the screen."""
        count = len(self.figures)
        return 1 if count == 1 else 2 if count in (2, 4) else 3 if count <= 9 else 4


def views(document: Mapping[str, Any], live: Sequence[ShownFigure]) -> list[View]:
    """Return the views for which a campaign has figures, the most suitable first.

    Parameters
    ----------
    document
        Content of report.json.
    live
        All figures of the page; those of a view have the section "view-" plus its name.
    """
    figures: dict[str, list[ShownFigure]] = {}
    for figure in live:
        kind, _, name = figure.section.partition("-")
        if kind == "view":
            figures.setdefault(name, []).append(figure)
    friction = friction_numbers(document) if document["curves"] else None
    settled = settled_numbers(document)
    numbers = {"distance": settled, "time": settled, "cycles": settled}
    numbers |= {name: figures[name][0].numbers for name in ("ramp", "static") if name in figures}
    numbers["surfaces"] = roughness_numbers(document) if document["surfaces"] else None
    found = [
        View(name, title, tuple(figures[name]), numbers.get(name, friction))
        for name, title in _TITLES.items()
        if name in figures
    ]
    speeds = max((len(curve["points"]) for curve in document["curves"]), default=0)
    if speeds < _MIN_SPEEDS:  # one point is not a curve
        found.sort(key=lambda view: view.name == "curve")
    return found
