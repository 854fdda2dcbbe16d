"""What the name of a file states: run07_r12p5mm.txt, PTFE_3N_10mms.csv, stroke8mm_2Hz.csv."""

from __future__ import annotations

import re

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.lexicon.lexicon import alternatives
from tribolab.reading.numbers import decimal

_RADIUS, _DIAMETER = alternatives("radius_in_name"), alternatives("diameter_in_name")
_RADIUS_IN_NAME = re.compile(
    rf"(?:^|(?<=[_\- ]))(?P<key>{alternatives('track_in_name')}?[_-]?"
    rf"(?:{_RADIUS}|r(?=[=\d_-])|(?P<across>{_DIAMETER}|d(?=[=\d_-])))[_=-]?)"
    r"(?P<number>\d{1,3}(?:[.,pP_]\d{1,2}(?=mm|cm|[_\- .]|$))?)[_ ]?(?P<unit>mm|cm)?(?=[_\- .]|$)",
    re.IGNORECASE,
)
_LEAST_RADIUS = 5.0  # mm; what is smaller may be a ball's
_MM = {"mm": 1.0, "cm": 10.0}
_FORCE = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>N|mN)(?=_|$)")
_SPEED = re.compile(r"(?:^|[_\- ])\d+(?:\.\d+)?(?P<unit>[mu]m)(?P<per>p?s|_s|-s| s)(?=[_\- .]|$)")
_STROKE = re.compile(
    rf"(?:^|(?<=[_\- ]))(?P<key>{alternatives('stroke_in_name')}[_=-]?)"
    r"(?P<number>\d+(?:[.,]\d+)?)[_ ]?(?P<unit>mm|cm)(?![^\W_])",
    re.IGNORECASE,
)
_HERTZ = re.compile(r"(?:^|[_\- f])\d+(?:[.,]\d+)?[_ ]?Hz(?![^\W_])")


def amounts_of_name(name: str) -> list[Amount]:
    r"""Return what the name of a file states; a radius without a unit, or a diameter, is a guess.

    Parameters
    ----------
    name
        Of the file, with its ending.

    Examples
    --------
    >>> radius = amounts_of_name("run07_r12p5mm.txt")[0]
    >>> radius.pattern, radius.unit, radius.guess
    ('r(\\d+(?:[.,pP_]\\d+)?)mm', 'mm', '')
    >>> amounts_of_name("disc_rad15.txt")[0].guess
    "'rad15' of the file's name is the radius of the track in mm"
    >>> amounts_of_name("r2_d30mm.txt")[0].guess
    "'d30mm' of the file's name is twice the radius of the track"
    >>> [(a.name, a.number) for a in amounts_of_name("PTFE_3N_10mms.csv")]
    [('set_speed', 10.0), ('set_normal_force', 3.0)]
    >>> amounts_of_name("run2_rep3.txt")
    []
    """
    stem = re.sub(r"\.[A-Za-z]\w{0,4}$", "", name)
    found = [_radius(stem, name), _speed(stem, name), *_strokes(name), _force(stem, name)]
    return [amount for amount in found if amount is not None]


def _stated(name: str, pattern: str, unit: str, file: str, to: str | None, key: str) -> Amount:
    return Amount(name, pattern, unit, to, file, "file name", unit, key=key)


def _radius(stem: str, name: str) -> Amount | None:
    found = [match for match in _RADIUS_IN_NAME.finditer(stem) if match["unit"] or _is_long(match)]
    match = next((match for match in found if match["unit"]), next(iter(found), None))
    if match is None:
        return None
    unit = (match["unit"] or "mm").lower()
    across = match["across"] is not None
    size = _number(match) * _MM[unit]
    if across and size < 2 * _LEAST_RADIUS:
        return None
    what = "twice the radius" if across else "the radius"
    guess = f"'{match[0]}' of the file's name is {what} of the track"
    guess += "" if match["unit"] else " in mm"
    sure = match["unit"] and not across and size >= _LEAST_RADIUS
    pattern = rf"{re.escape(match['key'])}(\d+(?:[.,pP_]\d+)?){match['unit'] or ''}"
    radius = _stated("track_radius", pattern, unit, name, "m", "trackradius")
    return radius._replace(scale=0.5 if across else 1.0, guess="" if sure else guess)


def _is_long(match: re.Match[str]) -> bool:
    """Whether a number without a unit is named as a radius in letters: "r2" may count the runs."""
    return len(match["key"].strip("_=-")) > 1 or _number(match) >= _LEAST_RADIUS


def _number(match: re.Match[str]) -> float:
    return decimal(re.sub("[pP_]", ".", match["number"]))


def _speed(stem: str, name: str) -> Amount | None:
    match = _SPEED.search(stem)
    if match is None:
        return None
    pattern = rf"(?:^|[_\- ])(\d+(?:\.\d+)?){match['unit']}{match['per']}(?:[_\- .])"
    return _stated("set_speed", pattern, f"{match['unit']}/s", name, None, "slidingspeed")


def _strokes(name: str) -> list[Amount]:
    """Return the stroke, and how often it comes: a frequency alone may be that of the samples."""
    stroke, often = _STROKE.search(name), _HERTZ.search(name)
    if stroke is None:
        return []
    unit = stroke["unit"]
    pattern = rf"{re.escape(stroke['key'])}(\d+(?:[.,]\d+)?)[_ ]?{unit}"
    found = [_stated("stroke", pattern, unit, name, "m", "stroke")]
    if often is not None:
        pattern = r"(?:^|[_\- f])(\d+(?:[.,]\d+)?)[_ ]?Hz"
        found.append(_stated("frequency", pattern, "Hz", name, "Hz", "frequency"))
    return found


def _force(stem: str, name: str) -> Amount | None:
    match = _FORCE.search(stem)
    pattern = rf"_(\d+(?:\.\d+)?){match['unit']}(?:_|\.)" if match else ""
    if match is None or not re.search(pattern, name):
        return None
    return _stated("set_normal_force", pattern, match["unit"], name, None, "")
