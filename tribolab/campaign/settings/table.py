"""What the tables of a campaign file have in common."""

from __future__ import annotations

from pydantic import ConfigDict

from tribolab.reading.dialect.checked_text import NoSwitches


class Table(NoSwitches):
    """A table of the campaign file: keys that are not known are errors, nothing can be changed."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)
