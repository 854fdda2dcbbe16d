"""Metadata of a raw file as lines of `tribolab info`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.core.errors import shown

if TYPE_CHECKING:
    pass

_PROVENANCE = {"source", "source_sha256", "tribolab_version", "history", "Conventions"}
_PROVENANCE |= {"drafted_layout"}
_MAX_TEXT = 300  # most characters shown of a text from the file
_SHOWN_ABOVE = {"instrument", "pitch_m", "length_m", "x_origin_m"}
_UNIT_END = re.compile(r"_(m_s|m_per_s|s|m|N|Hz|K|Pa|rad|kg)$")
_UNITS = {"m_s": "m/s", "m_per_s": "m/s"}
_WORDS = {
    "speed_from": "sliding speed from",
    "time_origin_s": "first time",
    "time_source": "time from",
}
# usual values of attributes, which are not shown
_USUAL = {"speed_from": ("column", "none"), "time_origin_s": (0.0,), "time_source": ("recorded",)}
_ROUNDING = 1e-6  # points are evenly spaced if they deviate by less than this share of a pitch


def metadata_lines(attrs: Mapping[str, Any], path: str | Path) -> list[str]:
    """Return a line for each attribute of a run or scan that no other line shows."""
    others = {key: value for key, value in attrs.items() if key not in _PROVENANCE | _SHOWN_ABOVE}
    if float(others.get("x_unevenness", 1.0)) < _ROUNDING:
        del others["x_unevenness"]
    if "to_keep_it" in others:  # show a command that works from the current folder
        # imported late for a quick start
        from tribolab.reading.unknown.proposal.questions import how_to_keep

        others["to_keep_it"] = how_to_keep(str(path))
    return [
        f"  {_key_words(key)}: {shown(_value_text(value) + _unit_of(key, value), _MAX_TEXT)}"
        for key, value in others.items()
        if value not in _USUAL.get(key, ())
    ]


def _unit_of(key: str, value: object) -> str:
    """Return the unit at the end of an attribute's key, if the attribute is a number; else "".

    Examples
    --------
    >>> _unit_of("track_radius_m", 0.02), _unit_of("set_speed_m_s", 0.01), _unit_of("step_m", "a")
    (' m', ' m/s', '')
    """
    end = _UNIT_END.search(key)
    known = end is not None and isinstance(value, float)
    return f" {_UNITS.get(end[1], end[1])}" if end is not None and known else ""


def _key_words(key: str) -> str:
    """Return the key of an attribute in words, without the unit.

    Examples
    --------
    >>> _key_words("track_radius_m"), _key_words("speed_from"), _key_words("recorded_at")
    ('track radius', 'sliding speed from', 'recorded at')
    """
    return _WORDS.get(key) or _UNIT_END.sub("", key).replace("_", " ")


def _value_text(value: object) -> str:
    if isinstance(value, Mapping):
        return "; ".join(f"{name} = {text}" for name, text in value.items())
    return f"{value:.9g}" if isinstance(value, float) else str(value)
