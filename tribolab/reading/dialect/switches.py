"""Base class that refuses true and false for numbers or text, which Python accepts as 1 and 0."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel, ValidationInfo, field_validator


class NoSwitches(BaseModel):
    """Model in which only switches may be true or false.

    Examples
    --------
    >>> class Rule(NoSwitches):
    ...     share: float = 1.0
    ...     optional: bool = False
    >>> Rule(share=0.5, optional=True)
    Rule(share=0.5, optional=True)
    """

    @field_validator("*", mode="before")
    @classmethod
    def _no_switch(cls, value: Any, info: ValidationInfo) -> Any:
        held = value if isinstance(value, list | tuple) else [value]
        switches = [item for item in held if isinstance(item, bool)]
        if switches and not _takes_switch(cls.model_fields[str(info.field_name)].annotation):
            told = str(switches[0]).lower()
            raise ValueError(f"{told} stands where a number or a text belongs")
        return value


def _takes_switch(annotation: Any) -> bool:
    return annotation is bool or any(_takes_switch(part) for part in get_args(annotation))
