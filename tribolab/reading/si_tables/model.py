"""Content of one raw file: its tables, and information on the file."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np


class Piece(NamedTuple):
    """One table of a raw file: arrays in SI units by quantity, and the text before the table."""

    columns: dict[str, np.ndarray]
    step: int | None = None
    started: dt.datetime | None = None
    before: str = ""


class Content(NamedTuple):
    """Content of one raw file; `pieces` are its tables."""

    path: Path
    sha256: str
    pieces: list[Piece]
    labels: Mapping[str, str]
    not_used: tuple[str, ...]
    left_out: Mapping[str, int] = {}  # number of rows left out, by reason
    notes: Mapping[str, str] = {}
    symbols: Mapping[str, str] = {}  # SI units of columns that are used only in formulas
    scales: Mapping[str, tuple[float, float]] = {}  # conversion to SI by column: scale and offset
    foot: str = ""  # text below the table, if the file begins with the table
