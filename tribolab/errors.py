"""The errors a user can meet: each says what is wrong, where, and how to mend it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class TribolabError(Exception):
    """Base of every error that tribolab raises on purpose.

    Examples
    --------
    >>> import tribolab as tl
    >>> try:
    ...     tl.read("nothing.csv")
    ... except tl.TribolabError as error:
    ...     print(error)
    nothing.csv: there is no such file
    """


class ReadError(TribolabError):
    """A raw file could not be understood."""


class UnitError(TribolabError):
    """A quantity has no unit, an unknown unit, or one of the wrong dimension."""


class ConfigError(TribolabError):
    """A campaign file or an option is wrong."""


class AnalysisError(TribolabError):
    """The data were read, but the question asked of them has no answer."""


class OutputError(TribolabError):
    """Results could not be written."""


def brief(error: BaseException, most: int = 300) -> str:
    r"""Say in one short line of text what another library's error says, whatever it holds.

    >>> brief(ValueError("bad tag\n in \x00 the file"))
    'bad tag in the file'
    """
    if isinstance(error, MemoryError):
        return "it claims to hold more than the memory does"
    text = "".join(c if c.isprintable() else " " for c in str(error)[: 10 * most])
    text = " ".join(text.split()) or type(error).__name__
    return text if len(text) <= most else f"{text[:most]} ..."


def shown(value: object, most: int = 80) -> str:
    r"""Return a value as a message may show it: short, and without what steers a terminal.

    >>> shown("\x1b[31mred\n"), shown("x" * 1000, 5)
    ('?[31mred?', 'xxxxx ...')
    """
    text = value if isinstance(value, str) else repr(value)
    text = "".join(c if c.isprintable() else "?" for c in text[: most + 1])
    return text if len(text) <= most else f"{text[:most]} ..."


_MOST = 60  # letters of a word; what a damaged file calls a name may have any length


_LISTED = 20


def nearest(word: str, known: Iterable[str], most: int | None = _LISTED) -> str:
    """Return a hint naming the known words nearest to `word`, ready to end an error message.

    Without any that is near, it names those known: at most `most`, None for all.

    >>> nearest("viscosty", ["viscosity", "radius"])
    "; did you mean 'viscosity'?"
    >>> len(nearest("Time", ["[" * 100_000]))  # of a damaged file
    76
    >>> nearest("x", ["left", "right", "up"], most=2)
    '; known are left, right and 1 more'
    """
    known = [one if len(one) <= _MOST else f"{one[:_MOST]} ..." for one in known]
    close = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    if close:
        return "; did you mean " + " or ".join(repr(c) for c in close) + "?"
    if not known:
        return ""
    listed = sorted(known)[:most]
    more = f" and {len(known) - len(listed)} more" if len(listed) < len(known) else ""
    return f"; known are {', '.join(listed)}{more}"
