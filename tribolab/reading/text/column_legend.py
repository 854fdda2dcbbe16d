"""Names of columns that the text above a table explains: "FT   tangential force, N"."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.reading.raw.unit_endings import is_unit
from tribolab.reading.text.cells import split_name

_LONGEST = 400  # characters of a line that are looked at
_MOST_LINES = 200  # above a table
_MOST_COLUMNS = 100
_BEHIND = r"(?:\s{2,}|\t\s*|\s*(?:[:=]|->|=>)\s*|\s+[-–—]\s+|\s*[\])]\s*)"
_SAYS = re.compile(r"[^\W\d_]")
# where a unit stands, the surest first: in brackets, behind a comma or "in", behind a stroke
_UNIT_SAID = (
    re.compile(r"[\[(]\s*(?P<unit>[^\[\]()]{1,16})\s*[\])]"),
    re.compile(
        r"(?:[,;|]|\s(?:in|en|unit:?|einheit:?))\s+(?P<unit>[^\s,;()\[\]]{1,16})(?=$|[\s,;.(\[])"
    ),
    re.compile(r"\s/\s(?P<unit>[^\s,;()\[\]]{1,10})$"),
    re.compile(r"\s(?P<unit>[^\s,;()\[\]/]{1,6}/[^\s,;()\[\]/]{1,4})$"),
    re.compile(r"(?<=\w)/(?P<unit>[^\s,;()\[\]/]{1,8})$"),
)
# what follows the thing itself: "friction force of the guide", "load on the pin (calibrated)"
_FURTHER = re.compile(
    r"[,;(\[|]|\. |\.$| [-–—] |\s(?:of|on|at|from) (?:the|a)\s|\s(?:in|en|unit:?|einheit:?)\s"
    r"|\s(?:der|des|vom|im|am|du|della|del|dello|na|van)\s",
    re.IGNORECASE,
)


def explained(lines: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return names of columns as the text above explains them, with their units in brackets.

    Parameters
    ----------
    lines
        Those above the names.
    names
        As they stand above the numbers.

    Returns
    -------
    list of str
        As they were where less than two are explained.

    Examples
    --------
    >>> explained(["  t   time, s (200 per second)", "  FT  tangential force, N"], ["t", "FT", "q"])
    ['time [s]', 'tangential force [N]', 'q']
    >>> explained(["# FT friction force of the pin, FN normal force"], ["t", "FT", "FN"])
    ['t', 'friction force', 'normal force']
    """
    bare = [split_name(name)[0] for name in names]
    wanted = {name for name in bare if name}
    if not wanted or len(names) > _MOST_COLUMNS:
        return list(names)
    told: dict[str, str] = {}
    for line in lines[-_MOST_LINES:]:
        for name, text in _of_line(line[:_LONGEST], wanted):
            told.setdefault(name, text)
    # one word without a unit is a setting: "Speed: constant"
    known = {name: label for name, text in told.items() if " " in (label := _label(text))}
    if len(known) < 2 or len(set(known.values())) < len(known):
        return list(names)
    result = []
    for name, plain in zip(names, bare, strict=True):
        unit = split_name(name)[1]
        label = known.get(plain, name)
        if plain in known and unit is not None:
            label = f"{split_name(label)[0]} [{unit}]"
        result.append(label)
    return result


def _of_line(line: str, wanted: set[str]) -> list[tuple[str, str]]:
    """Return names and what a line says behind each: one name, or several one after the other."""
    start = re.match(r"[^\w#]*(?:#+\s*(?=\S))?|", line)
    begin = start.end() if start else 0
    rest = line[begin:]
    for name in sorted(wanted, key=len, reverse=True):
        for text in (rest, line.strip()):  # a column may be called "#"
            if text.startswith(name) and (m := re.match(_BEHIND, text[len(name) :])):
                said = text[len(name) + m.end() :]
                if not any(_place(said, other) for other in wanted - {name} if len(other) > 1):
                    return [(name, said)] if _is_text(said) else []
    places = sorted((p[0], name) for name in wanted if (p := _place(rest, name)))
    if len(places) < 2 or places[0][0] > 0:
        return []
    ends = [place for place, _ in places[1:]] + [len(rest)]
    parts = [
        (name, rest[place + len(name) : end].strip(" :=,;.\t-"))
        for (place, name), end in zip(places, ends, strict=True)
    ]
    return parts if all(_is_text(text) for _, text in parts) else []


def _place(text: str, name: str) -> tuple[int] | None:
    found = re.search(rf"(?<![\w.]){re.escape(name)}(?![\w])", text)
    return (found.start(),) if found else None


def _is_text(text: str) -> bool:
    """Whether something is said of a column, and no setting: "time in s", but not "20 N"."""
    return bool(_SAYS.match(text.lstrip("\"'([")))


def _label(text: str) -> str:
    """Return what a column is, with its unit in brackets.

    >>> _label("bath temperature, degC"), _label("load on the pin (N)"), _label("sample number")
    ('bath temperature [degC]', 'load [N]', 'sample number')
    """
    further = _FURTHER.search(text)
    what = (text[: further.start()] if further else text).strip(" .:\"'")
    for pattern in _UNIT_SAID:
        for said in pattern.finditer(text):
            unit = said["unit"].rstrip(".")
            if is_unit(unit):
                return f"{text[: min(said.start(), len(what))].strip() or what} [{unit}]"
    return what
