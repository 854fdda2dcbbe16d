"""Errors shown to users: what is wrong, where, and how to correct it."""

from __future__ import annotations

import copyreg
import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

AUDIENCES = ("notebook", "terminal", "campaign")


@dataclass(frozen=True)
class Cure:
    """How to correct an error, worded for each audience; "" if there is no advice.

    Parameters
    ----------
    notebook
        Advice for Python: names of functions and arguments.
    terminal
        Advice for the command line: names of commands and options.
    campaign
        Advice for a campaign file: names of its keys; also used in the report.
    """

    notebook: str = ""
    terminal: str = ""
    campaign: str = ""

    def message_for(self, audience: str) -> str:
        """Return the advice for one audience."""
        return str(getattr(self, audience))


class TribolabError(Exception):
    """Base class of all errors that tribolab raises intentionally.

    It contains the parts of a message; `message_for("terminal")` words it for an audience. Its text
    is worded for a notebook. Control characters for terminals are removed.

    Parameters
    ----------
    what
        The problem, or another error, to which `where` is added.
    where
        The file, key or quantity.
    function
        The Python function or argument that raised it, shown in notebooks only.
    cure
        How to fix it: the same words for everyone, or a `Cure`.

    Examples
    --------
    >>> import tribolab as tl
    >>> try:
    ...     tl.read("nothing.csv")
    ... except tl.TribolabError as error:
    ...     print(error)
    nothing.csv: there is no such file
    >>> cure = Cure(notebook="say instrument=", terminal="say --instrument")
    >>> error = ReadError("two instruments fit", where="a.csv", cure=cure)
    >>> print(error)
    a.csv: two instruments fit; say instrument=
    >>> error.message_for("terminal"), error.message_for("campaign")
    ('a.csv: two instruments fit; say --instrument', 'a.csv: two instruments fit')
    """

    def __init__(
        self,
        what: str | TribolabError = "",
        *,
        where: object = "",
        function: str = "",
        cure: str | Cure = "",
    ) -> None:
        super().__init__(what)
        self.what = what
        self.where = str(where)
        self.function = function
        self.cure = cure

    def message_for(self, audience: str) -> str:
        """Return the message worded for a "notebook", the "terminal" or a "campaign"."""
        what = (
            self.what.message_for(audience)
            if isinstance(self.what, TribolabError)
            else str(self.what)
        )
        first = self.function if audience == "notebook" else ""
        cure = self.cure.message_for(audience) if isinstance(self.cure, Cure) else self.cure
        message = ": ".join(part for part in (first, self.where, what) if part)
        return harmless("; ".join(part for part in (message, cure) if part))

    def __str__(self) -> str:
        """Return the message worded for a notebook."""
        return self.message_for("notebook")

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what pickle needs to restore the error."""
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]


class ReadError(TribolabError):
    """Error: a raw file could not be interpreted."""


class LacksError(ReadError):
    """Error: a raw file lacks data that the description of the instrument requires."""


class NoNumbersError(ReadError):
    """Error: a text file contains no table of numbers."""


class UnitError(TribolabError):
    """Error: a quantity has no unit, an unknown unit, or one of the wrong dimension."""


class ConfigError(TribolabError):
    """Error: a campaign file or an option is wrong."""


class AnalysisError(TribolabError):
    """Error: the data were read, but do not allow the requested analysis."""


class OutputError(TribolabError):
    """Error: results could not be written."""


def message_for(error: BaseException, audience: str) -> str:
    """Return the message of any error for one audience, shortened if it is another library's.

    >>> message_for(ReadError("empty", where="a.csv"), "terminal")
    'a.csv: empty'
    """
    return error.message_for(audience) if isinstance(error, TribolabError) else brief(error)


def harmless(text: str) -> str:
    r"""Return a text without control characters, except line ends.

    >>> harmless("\x1b[31mred\tline\nnext")
    '?[31mred line\nnext'
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else " " if c.isspace() else "?" for c in text)


def brief(error: BaseException, most: int = 300) -> str:
    r"""Return the message of another library's error, shortened to one line.

    >>> brief(ValueError("bad tag\n in \x00 the file"))
    'bad tag in the file'
    """
    if isinstance(error, MemoryError):
        return "it claims to hold more than the memory does"
    text = "".join(c if c.isprintable() else " " for c in str(error)[: 10 * most])
    text = " ".join(text.split()) or type(error).__name__
    return text if len(text) <= most else f"{text[:most]} ..."


def shown(value: object, most: int = 80) -> str:
    r"""Return a value as a short text for messages, without control characters.

    >>> shown("\x1b[31mred\n"), shown("x" * 1000, 5)
    ('?[31mred?', 'xxxxx ...')
    """
    text = value if isinstance(value, str) else repr(value)
    text = text[: most + 1].replace("\t", " ")
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= most else f"{text[:most]} ..."


_MAX_LETTERS = 60  # longest word compared; names in damaged files can have any length


_LISTED = 20


def nearest(word: str, known: Iterable[str], most: int | None = _LISTED) -> str:
    """Return a hint with the known words most similar to `word`, for the end of an error message.

    If none is near, it lists the known words: at most `most`, None for all.

    >>> nearest("viscosty", ["viscosity", "radius"])
    "; did you mean 'viscosity'?"
    >>> len(nearest("Time", ["[" * 100_000]))  # of a damaged file
    76
    >>> nearest("x", ["left", "right", "up"], most=2)
    '; known are left, right and 1 more'
    """
    known = [name if len(name) <= _MAX_LETTERS else f"{name[:_MAX_LETTERS]} ..." for name in known]
    close = difflib.get_close_matches(word, known, n=3, cutoff=0.6)
    if close:
        return "; did you mean " + " or ".join(repr(c) for c in close) + "?"
    if not known:
        return ""
    listed = sorted(known)[:most]
    more = f" and {len(known) - len(listed)} more" if len(listed) < len(known) else ""
    return f"; known are {', '.join(listed)}{more}"
