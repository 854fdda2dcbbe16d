"""Typed records of the attributes of datasets; a default value means "not stated"."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, Self


@dataclass(frozen=True)
class Attributes:
    """Base of records of dataset attributes."""

    @classmethod
    def from_attrs(cls, attrs: Mapping[Any, Any]) -> Self:
        """Return the record filled from the attributes of a dataset.

        >>> RunAttributes.from_attrs({"rows_are": "points", "source": "a.csv"}).rows_are
        'points'
        """
        found = {}
        for each in fields(cls):
            value, default = attrs.get(each.name), each.default
            kind: Any = type(default) if default is not MISSING else each.default_factory
            if value is not None and (kind is not dict or isinstance(value, Mapping)):
                found[each.name] = kind(value)
        return cls(**found)


@dataclass(frozen=True)
class RunAttributes(Attributes):
    """Attributes of a run: how it was read, its clocks and its checks."""

    instrument: str = ""
    recorded_at: str = ""
    history: str = ""
    quality: str = ""
    findings: list[Any] = field(default_factory=list)
    columns_used: dict[str, str] = field(default_factory=dict)
    columns_not_used: str = ""
    left_out: str = ""
    rows_are: str = ""
    rows_not_covered: int = 0
    derived: dict[str, str] = field(default_factory=dict)
    zeros_read: dict[str, str] = field(default_factory=dict)
    zeros_stated: dict[str, str] = field(default_factory=dict)
    uncertainty: dict[str, Any] = field(default_factory=dict)
    set_speed_m_s: float = math.nan
    speed_from: str = ""
    strokes_unlike_s: float = 0.0
    time_source: str = ""
    clock_joined: str = ""
    clock_shift_source: str = ""
    clock_shift_uncertainty_s: float = math.nan
    clock_shift_refused: str = ""
    companion_missing: str = ""


@dataclass(frozen=True)
class SegmentAttributes(Attributes):
    """Attributes of a dataset of segments and their friction."""

    velocity_source: str = ""
    speed_from: str = ""
    rows_are: str = ""
    stroke_middle: float = math.nan
    standstill_s: float = 0.0
    trim: float = math.nan
    offset: str = ""
    zero_doubts: list[Any] = field(default_factory=list)
    middle_of_loop: str = ""
    uncertainty_says: str = ""
