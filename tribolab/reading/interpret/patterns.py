"""Patterns that people can read, for what stands in a line of text."""

from __future__ import annotations

import re

_SPECIAL = re.compile(r"([.^$*+?{}\[\]\\|()])")


def escaped(text: str) -> str:
    """Return text as a pattern that people can read: blanks stay blanks."""
    return _SPECIAL.sub(r"\\\1", text).replace("\t", r"\t")
