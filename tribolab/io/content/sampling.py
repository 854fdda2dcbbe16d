"""The distance of samples [s] where no column holds time: a rate or an interval that is stated."""

from __future__ import annotations

import re

from tribolab.errors import ReadError, shown
from tribolab.io.content.model import Content, Piece
from tribolab.io.content.steps import last_match
from tribolab.io.dialects.model import Dialect
from tribolab.io.dialects.time_rule import sampling_interval

_THOUSANDS = re.compile(r"[1-9]\d{0,2}(?:[ \u00a0\u202f',]\d{3})+")  # "1 000"
_COMMA = re.compile(r"\d+,\d+(?:[eE][-+]?\d+)?")


def stated_interval(content: Content, dialect: Dialect, piece: Piece) -> float:
    """Return the time [s] from a sample to the next; a second where nothing is stated.

    Parameters
    ----------
    content
        The file: in the text before its table the rate or the interval may stand.
    dialect
        Says which of both, or where.
    piece
        One of its tables: what stands before it goes before what the file says.

    Raises
    ------
    ReadError
        If it does not stand there, or is no rate and no interval.
    """
    rule = dialect.time
    if rule.rate:
        return sampling_interval(rule.rate, "time.rate")
    if not rule.rate_pattern:
        return 1.0
    number = last_match(rule.rate_pattern, piece.before)
    if number is None:
        number = last_match(rule.rate_pattern, content.pieces[0].before)
    if number is None:
        raise ReadError(
            f"{content.path}: no sample rate matches '{shown(rule.rate_pattern)}' "
            f"(instrument '{dialect.name}', time.rate_pattern)"
        )
    if _THOUSANDS.fullmatch(number) and not (dialect.text.decimal == "," and "," in number):
        number = re.sub(r"\D", "", number)
    elif dialect.text.decimal == "," or _COMMA.fullmatch(number):
        number = number.replace(",", ".")
    return sampling_interval(f"{number} {rule.rate_unit}", str(content.path))
