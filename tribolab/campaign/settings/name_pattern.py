"""Labels in the names of raw files, e.g. operator, mount and day."""

from __future__ import annotations

import re

import regex

_FIELD = re.compile(r"\{([^{}]*)\}|(\*)")
_MARKS = "_- "  # characters that separate labels
_SECONDS = 0.5
_MAX_STARS = 6


class NamePattern:
    """A pattern with named gaps, e.g. ``*_{mount}_{operator}_*``.

    Parameters
    ----------
    text
        ``{label}`` matches up to the mark that separates labels (``_``, ``-`` or a space), the
        first one also beyond it; ``*`` matches anything, all else itself.

    Raises
    ------
    ValueError
        If it names no label, or one twice.

    Examples
    --------
    >>> NamePattern("*_{mount}_{operator}").labels("sb-r_dry_m2_ann")
    {'mount': 'm2', 'operator': 'ann'}
    >>> NamePattern("*_{mount}_{operator}").labels("other")
    {}
    >>> NamePattern("{surface}-{repeat}").labels("sb_r-2")
    {'surface': 'sb_r', 'repeat': '2'}
    """

    def __init__(self, text: str) -> None:
        names = [name for name, star in _FIELD.findall(text) if not star]
        if not names:
            raise ValueError("no label is named; write e.g. '*_{mount}_*'")
        for name in names:
            if not name.isidentifier():
                raise ValueError(
                    f"'{name}' is no label; write a word of letters and digits in {{}}"
                )
            if names.count(name) > 1:
                raise ValueError(f"'{name}' stands there twice")
        if text.count("*") > _MAX_STARS:
            raise ValueError(f"more than {_MAX_STARS} * are too many")
        parts, end = [], 0
        mark = next((each for each in _MARKS if f"}}{each}{{" in text), _MARKS[0])
        first, other = ".+", f"[^{re.escape(mark)}]+"
        for gap in _FIELD.finditer(text):
            parts.append(re.escape(text[end : gap.start()]))
            label = first if gap[1] == names[0] else other
            parts.append(".*" if gap[2] else f"(?P<{gap[1]}>{label})")
            end = gap.end()
        self._compiled = regex.compile("".join([*parts, re.escape(text[end:])]))

    def labels(self, name: str) -> dict[str, str]:
        """Return the labels of a name; none if the pattern does not fit."""
        try:
            match = self._compiled.fullmatch(name, timeout=_SECONDS)
        except TimeoutError:
            return {}
        return dict(match.groupdict()) if match else {}
