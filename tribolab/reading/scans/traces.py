"""Several tables of heights in one file: traces of one scan, or versions of one trace."""

from __future__ import annotations

import re
from pathlib import Path

from tribolab.core.errors import ReadError, shown
from tribolab.reading.scans.unit_words import WORD
from tribolab.reading.si_tables.model import Piece

_MAX_TITLES = 5  # most titles named in a message
_NUMBERS = re.compile(r"\d+(?:[.,]\d+)*")
# words in titles of tables that were computed from another table
_VERSIONS = re.compile(
    r"(?i)\b(?:raw|primary|filtered|unfiltered|roughness|waviness|levell?ed|form|residual|"
    r"roh\w*|gefiltert\w*|rauheit\w*|welligkeit\w*|prim[aä]r\w*|brut|filtr\w+|rugosit\w+|"
    r"[pwr][-\s]profil\w*)\b"
)


def traces_of(path: Path, pieces: list[Piece]) -> list[Piece]:
    """Return the tables of a file that are traces of one scan.

    Parameters
    ----------
    path
        The file.
    pieces
        Its tables.

    Returns
    -------
    list
        All tables, if their titles differ only in numbers.

    Raises
    ------
    ReadError
        If the tables may be versions of one trace, such as raw and filtered, whose mean would be
        meaningless.
    """
    if len(pieces) > 1 and not _are_traces(pieces):
        raise ReadError(
            f"{len(pieces)} tables of heights are in the file, which are no traces of one scan "
            f"by what is written above them: {_titles(pieces)}",
            where=path,
            cure="save those that are meant in a file of their own",
        )
    return pieces


def _title(piece: Piece) -> str:
    """Return the last line with letters before a table."""
    lines = [line.strip() for line in piece.before.splitlines() if WORD.search(line)]
    return lines[-1] if lines else ""


def _are_traces(pieces: list[Piece]) -> bool:
    titles = [_title(piece) for piece in pieces]
    if any(_VERSIONS.search(title) for title in titles[1:]) and len(set(titles)) > 1:
        return False
    # the text before the first table may also contain settings and results
    return len({_NUMBERS.sub("", title).strip() for title in titles[1:]}) <= 1


def _titles(pieces: list[Piece]) -> str:
    titles = [f"'{shown(_title(piece) or 'without a title', 40)}'" for piece in pieces]
    more = f" and {len(titles) - _MAX_TITLES} more" if len(titles) > _MAX_TITLES else ""
    return ", ".join(titles[:_MAX_TITLES]) + more
