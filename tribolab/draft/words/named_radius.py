"""The radius of a track that a file's name states: run07_r12p5mm.txt, disc_R12_5.csv, d30mm.txt."""

from __future__ import annotations

import re
from typing import NamedTuple

_IN_NAME = re.compile(
    r"(?:^|(?<=[_\- ]))(?P<key>(?:track|trk|wear|spur|laufbahn)?[_-]?(?:radius|rad|track"
    r"|r(?=[=\d_-])|diam?|d(?=[=\d_-])|ø|半径|直径)"
    r"[_=-]?)(?P<number>\d{1,3}(?:[.,pP_]\d{1,2}(?=mm|cm|[_\- .]|$))?)[_ ]?(?P<unit>mm"
    r"|cm)?(?=[_\- .]|$)",
    re.IGNORECASE,
)
_ACROSS = re.compile(r"d|ø|直径", re.IGNORECASE)
_LEAST = 5.0  # mm; what is smaller may be a ball's
_MM = {"mm": 1.0, "cm": 10.0}


class NamedRadius(NamedTuple):
    """A pattern of the file's name, its unit, how many radii it is, and what of it is a guess."""

    pattern: str
    unit: str
    scale: float
    guess: str


def radius_in_name(name: str) -> NamedRadius | None:
    r"""Return the radius that a file's name states; it is a guess without a unit, or of a diameter.

    Parameters
    ----------
    name
        Of the file, with its ending.

    Examples
    --------
    >>> value = radius_in_name("run07_r12p5mm.txt")
    >>> value.pattern, value.unit, value.guess
    ('r(\\d+(?:[.,pP_]\\d+)?)mm', 'mm', '')
    >>> radius_in_name("disc_rad15.txt").guess
    "'rad15' of the file's name is the radius of the track in mm"
    >>> radius_in_name("r2_d30mm.txt").guess
    "'d30mm' of the file's name is twice the radius of the track"
    >>> radius_in_name("run2_rep3.txt")
    """
    stem = re.sub(r"\.[A-Za-z]\w{0,4}$", "", name)
    found = [match for match in _IN_NAME.finditer(stem) if match["unit"] or _is_long(match)]
    match = next((match for match in found if match["unit"]), next(iter(found), None))
    if match is None:
        return None
    key, unit = match["key"], match["unit"] or "mm"
    across = _ACROSS.match(key.lstrip("_-")) is not None or key.lower().rstrip("_=-").endswith(
        "dia"
    )
    size = float(re.sub("[,pP_]", ".", match["number"])) * _MM[unit.lower()]
    what = "twice the radius" if across else "the radius"
    guess = f"'{match[0]}' of the file's name is {what} of the track"
    guess += "" if match["unit"] else " in mm"
    if across and size < 2 * _LEAST:
        return None
    sure = match["unit"] and not across and size >= _LEAST
    ending = re.escape(match["unit"]) if match["unit"] else ""
    return NamedRadius(
        rf"{re.escape(key)}(\d+(?:[.,pP_]\d+)?){ending}",
        unit.lower(),
        0.5 if across else 1.0,
        "" if sure else guess,
    )


def _is_long(match: re.Match[str]) -> bool:
    """Whether a number without a unit is named as a radius in letters: "r2" may count the runs."""
    word = match["key"].strip("_=-")
    return len(word) > 1 or float(re.sub("[,pP_]", ".", match["number"])) >= _LEAST
