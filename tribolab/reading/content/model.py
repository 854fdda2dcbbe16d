"""Pieces of a run in one file, and information on the file."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np


class Piece(NamedTuple):
    """One table: arrays in SI by quantity, and the text before it."""

    columns: dict[str, np.ndarray]
    step: int | None = None
    started: dt.datetime | None = None
    before: str = ""


class Content(NamedTuple):
    """Content of one file."""

    path: Path
    sha256: str
    pieces: list[Piece]
    labels: Mapping[str, str]
    not_used: tuple[str, ...]
    left_out: Mapping[str, int] = {}  # rows left out, by reason
    notes: Mapping[str, str] = {}
    symbols: Mapping[str, str] = {}  # SI units of columns used only in formulas
    scales: Mapping[str, tuple[float, float]] = {}  # conversion to SI by column: scale and offset
    foot: str = ""  # text below the table of a file that begins with the table
