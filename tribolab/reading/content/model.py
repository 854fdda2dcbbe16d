"""Pieces of a run as they lie in one file, and what is said of the file beside them."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np


class Piece(NamedTuple):
    """One table: arrays in SI by quantity, and what the text before it says."""

    columns: dict[str, np.ndarray]
    step: int | None = None
    started: dt.datetime | None = None
    before: str = ""


class Content(NamedTuple):
    """What one file holds."""

    path: Path
    sha256: str
    pieces: list[Piece]
    labels: Mapping[str, str]
    not_used: tuple[str, ...]
    left_out: Mapping[str, int] = {}  # rows that were not taken over, by reason
    notes: Mapping[str, str] = {}
    symbols: Mapping[str, str] = {}  # SI units of columns that only formulas use
    scales: Mapping[str, tuple[float, float]] = {}  # what made SI of a column: scale and offset
    foot: str = ""  # the text below the table, of a file that begins with it
