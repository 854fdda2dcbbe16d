"""The files that instruments of other labs would have written of a run whose truth is known."""

from layouts import (
    clocks_and_text,  # noqa: F401
    formats,  # noqa: F401
    makers,  # noqa: F401
    where_speed,  # noqa: F401
)
from layouts.kinds import KINDS, LayoutKind, WrittenRun, write_kind

__all__ = ["KINDS", "LayoutKind", "WrittenRun", "write_kind"]
