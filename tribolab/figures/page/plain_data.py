"""Conversion of a figure's description to plain data (for JSON) that the page's script reads."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tribolab.figures.spec import FigureSpec

_MAX_CARD_LABELS = 8  # largest number of legend entries on a card, as in `assets/picture.js`
_DIGITS = 6  # significant digits, more than a screen can resolve
_NOT_ON_PAGE = frozenset({"columns", "keys", "paper", "column", "across", "name", "pale"})
_NOT_ON_PAGE |= {"thin", "numbers"}


def written_labels(figure: FigureSpec, labels: Collection[str]) -> int:
    """Return the number of legend entries that are shown: 0 if a card would have too many."""
    return 0 if figure.width == "card" and len(labels) > _MAX_CARD_LABELS else len(labels)


def plain_data(value: Any) -> Any:
    """Return a figure's description as dictionaries and lists, with rounded numbers.

    Fields with their default value are omitted.
    """
    if is_dataclass(value) and not isinstance(value, type):
        values = {field.name: getattr(value, field.name) for field in fields(value)}
        usual = {field.name: field.default for field in fields(value)}
        return {
            name: plain_data(item)
            for name, item in values.items()
            if name not in _NOT_ON_PAGE
            and item is not usual[name]
            and not (isinstance(item, str | tuple | list) and not item)
        }
    if isinstance(value, np.ndarray):
        return plain_data(value.tolist())
    if isinstance(value, list | tuple):
        return [_rounded(item) if type(item) is float else plain_data(item) for item in value]
    if isinstance(value, np.generic):
        return plain_data(value.item())
    return _rounded(value) if isinstance(value, float) else value


def _rounded(value: float) -> float | None:
    return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else None
