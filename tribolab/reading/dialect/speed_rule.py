"""Rule of a dialect for the source of the sliding speed."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from tribolab.core.errors import shown
from tribolab.reading.dialect.checked_text import Strict
from tribolab.units.conversion import positive


class Speed(Strict):
    """Source of the sliding speed."""

    source: Literal["column", "position", "rotation", "stroke", "set speed", "none"] = "column"
    radius: str | None = Field(None, description="track radius with unit, for source 'rotation'")
    radius_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the radius"
    )
    stroke: str | None = Field(
        None, description="stroke, end to end, with unit, for source 'stroke'"
    )
    stroke_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the stroke"
    )
    frequency: str | None = Field(None, description="frequency of the cycles, e.g. '5 Hz'")
    frequency_value: str | None = Field(
        None, description="the [[value]], or symbol of a column, with the frequency"
    )
    drive: Literal["crank", "constant speed"] = Field(
        "crank", description="for source 'stroke': sinusoidal or constant velocity"
    )

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if (self.source == "rotation") != bool(self.radius or self.radius_value):
            raise ValueError("source = 'rotation' and radius (or radius_value) belong together")
        of_strokes = [self.stroke or self.stroke_value, self.frequency or self.frequency_value]
        if (self.source == "stroke") != all(of_strokes) or (any(of_strokes) != all(of_strokes)):
            raise ValueError(
                "source = 'stroke', stroke (or stroke_value) and frequency (or frequency_value) "
                "belong together"
            )
        for key, unit in (("radius", "m"), ("stroke", "m"), ("frequency", "Hz")):
            text = getattr(self, key)
            if text and text.strip()[:1].isalpha():
                raise ValueError(
                    f"speed.{key}: '{shown(text)}' is no number with a unit; write {key}_value = "
                    '"(name of the [[value]])", which may have scale = 0.5 for half of it'
                )
            if text:
                positive(text, unit, f"speed.{key}")
        return self

    @property
    def values_named(self) -> dict[str, str]:
        """Names of the values used, by key."""
        keys = ("radius_value", "stroke_value", "frequency_value")
        return {key: value for key in keys if (value := getattr(self, key))}
