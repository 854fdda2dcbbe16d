"""Base class of the tables of a campaign file."""

from __future__ import annotations

from pydantic import ConfigDict

from tribolab.reading.dialect.checked_text import NoSwitches


class Table(NoSwitches):
    """Immutable table of the campaign file, in which unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)
