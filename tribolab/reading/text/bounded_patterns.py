"""Regular expressions of dialects with a time limit."""

from __future__ import annotations

import functools
import mmap
from collections.abc import Iterator
from typing import Any, AnyStr, Generic

import regex

from tribolab.core.errors import ReadError, shown

MAX_PATTERN = 1000  # characters of a pattern
_SECONDS = 2.0  # time limit per _AMOUNT of text
_AMOUNT = 1 << 22  # characters or bytes


class PatternError(ValueError):
    """Raised if a pattern is not a regular expression."""


class Guarded(Generic[AnyStr]):
    r"""Regular expression of a dialect with a time limit.

    On an unsuitable text, ``(a|aa)+$`` would backtrack practically forever.

    Parameters
    ----------
    pattern
        As for `re`, with ``^`` and ``$`` matching at every line.

    Raises
    ------
    PatternError
        If it is not a regular expression.

    Examples
    --------
    >>> Guarded(r"load (\d+) N").first("at load 31 N")
    '31'
    """

    def __init__(self, pattern: AnyStr) -> None:
        if len(pattern) > MAX_PATTERN:
            raise PatternError(
                f"it has {len(pattern)} letters, and at most {MAX_PATTERN} are taken"
            )
        self.pattern: AnyStr = pattern
        try:
            # for text or bytes, including mapped memory; the stubs cannot express both
            self._compiled: regex.Pattern[Any] = regex.compile(pattern, regex.MULTILINE)
        except (regex.error, RecursionError, OverflowError, MemoryError) as error:
            raise PatternError(str(error)) from error

    @property
    def groups(self) -> int:
        """Number of groups in the expression."""
        return int(self._compiled.groups)

    def search(
        self, text: AnyStr | mmap.mmap, start: int = 0, stop: int | None = None
    ) -> regex.Match[AnyStr] | None:
        """Return the first match in a text, or None.

        Raises
        ------
        ReadError
            If the search exceeds the time limit for the text.
        """
        stop = len(text) if stop is None else stop
        try:
            match: regex.Match[Any] | None = self._compiled.search(
                text, start, stop, timeout=_limit(stop - start)
            )
        except TimeoutError as error:
            raise self._endless() from error
        return match

    def fullmatch(self, text: AnyStr) -> bool:
        """Whether the expression matches the whole text; errors as in `search`."""
        try:
            return self._compiled.fullmatch(text, timeout=_limit(len(text))) is not None
        except TimeoutError as error:
            raise self._endless() from error

    def all(self, text: AnyStr | mmap.mmap, start: int = 0) -> Iterator[regex.Match[AnyStr]]:
        """Yield the matches in a text; errors as in `search`."""
        limit = _limit(len(text) - start)
        try:
            yield from self._compiled.finditer(text, start, timeout=limit)
        except TimeoutError as error:
            raise self._endless() from error

    def first(self, text: AnyStr) -> AnyStr | None:
        """Return group 1 of the first match, without blanks around it."""
        match = self.search(text)
        return match[1].strip() if match and match[1] is not None else None

    def last(self, text: AnyStr) -> AnyStr | None:
        """Return group 1 of the last match, without blanks around it."""
        last = None
        for last in self.all(text):  # noqa: B007 - the last one is wanted
            pass
        return last[1].strip() if last and last[1] is not None else None

    def _endless(self) -> ReadError:
        return ReadError(
            f"the pattern {shown(self.pattern)} of the dialect takes too long on this file; write "
            "it without a repeat inside a repeat, such as (a|aa)+"
        )


@functools.lru_cache(maxsize=256)
def guarded(pattern: str) -> Guarded[str]:
    """Return a regular expression with a time limit; it is compiled only once."""
    return Guarded(pattern)


def _limit(length: int) -> float:
    return _SECONDS * (1 + max(length, 0) / _AMOUNT)
