"""What users do without meaning to, a room for each kind; see `hostile.base`."""

from hostile import (  # noqa: F401 - they register their cases
    bombs,
    loss,
    names,
    outside,
    parsing,
    stored,
    tables,
    words,
)
from hostile.base import CASES

__all__ = ["CASES"]
