"""Colours, markers and line styles, the same in all figures and on the page."""

from __future__ import annotations

from collections.abc import Iterable

from tribolab.core.wording import is_dry
from tribolab.figures.spec import Style

# Palette of Okabe and Ito, distinguishable with any common colour deficiency (Color Universal
# Design, 2008). `assets/drawing.js` and `still.css` contain it too, with dark variants.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#6B6B6B", "#000000")
MARKERS = ("o", "s", "D", "^", "v", "p", "h", "*")  # one per colour, or one per load
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, GREY, BLACK = range(8)
# colours of the reference study: Smooth green, Sb-S blue, Sb-R red
_REFERENCE = {"smooth": GREEN, "sb-s": BLUE, "sb-r": VERMILLION}
_ORDER = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
_DARKEST, _LIGHTEST = -0.35, 0.45  # share of black (negative) or white in the shades of loads


def surface_colours(surfaces: Iterable[str]) -> dict[str, int]:
    """Return the index in the palette for each surface, in order of first appearance.

    The surfaces of the reference study keep the colours of the paper.

    Examples
    --------
    >>> surface_colours(["steel", "brass"]), surface_colours(["Sb-R", "steel"])
    ({'steel': 0, 'brass': 1}, {'Sb-R': 1, 'steel': 0})
    """
    names = list(dict.fromkeys(surfaces))
    # "Sb-R (complete contact)" has the colour of Sb-R
    bare = {name: name.partition(" (")[0].strip().lower() for name in names}
    fixed = {name: _REFERENCE[bare[name]] for name in names if bare[name] in _REFERENCE}
    free = [place for place in _ORDER if place not in fixed.values()] or list(_ORDER)
    others = [name for name in names if name not in fixed]
    chosen = {name: free[k % len(free)] for k, name in enumerate(others)}
    return {name: fixed.get(name, chosen.get(name, 0)) for name in names}


def shade_of(rank: int, count: int) -> float:
    """Return the shade of a load by its rank (from 0): dark (< 0) if low, light (> 0) if high.

    Examples
    --------
    >>> shade_of(0, 1), shade_of(0, 3), shade_of(2, 3)
    (0.0, -0.35, 0.45)
    """
    if count < 2:
        return 0.0
    return round(_DARKEST + (_LIGHTEST - _DARKEST) * rank / (count - 1), 3)


def medium_styles(media: Iterable[str]) -> dict[str, Style]:
    """Return a line style for each medium; dry contacts are dashed or dotted.

    Examples
    --------
    >>> medium_styles(["water", "oil", "dry"])
    {'water': 'line', 'oil': 'dashdot', 'dry': 'dashed'}
    """
    chosen: dict[str, Style] = {}
    styles: dict[bool, tuple[Style, ...]] = {
        True: ("dashed",),
        False: ("line", "dashdot", "longdash"),
    }
    for name in dict.fromkeys(media):
        own = styles[is_dry(name)]
        chosen[name] = own[sum(is_dry(name) == is_dry(other) for other in chosen) % len(own)]
    return chosen
