"""What users do without meaning to, a room for each kind; see `hostile.base`."""

from hostile import bombs, loss, names, parsing, tables, words  # noqa: F401 - they register their cases
from hostile.base import CASES

__all__ = ["CASES"]
