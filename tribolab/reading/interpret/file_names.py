"""Amounts stated in a file name: PTFE_3N_b.csv."""

from __future__ import annotations

import re

from tribolab.reading.interpret.amounts import Amount

_SUFFIX = re.compile(r"\.[A-Za-z]\w{0,4}$")
_FORCE = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>N|mN)(?=_|$)")
# "T11_0.1m-s_10N.csv", "PAO_20N_100mms": a name has no stroke; "100ms" is a time
_SPEED = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>[mu]?m-s|[mu]ms)(?=_|$)")


def amounts_of_name(name: str) -> list[Amount]:
    r"""Return the amounts in a file name: the load.

    Examples
    --------
    >>> [(a.name, a.number) for a in amounts_of_name("PTFE_3N_b.csv")]
    [('set_normal_force', 3.0)]
    """
    force = _force(_SUFFIX.sub("", name), name)
    return [] if force is None else [force]


def speed_of_name(name: str) -> Amount | None:
    """Return the speed in a file name, which need not be how fast it slides.

    >>> speed_of_name("T11_0.1m-s_10N.csv").si("m/s"), speed_of_name("a_100ms.csv")
    (0.1, None)
    """
    match = _SPEED.search(_SUFFIX.sub("", name))
    if match is None:
        return None
    unit = match["unit"].removesuffix("s").removesuffix("-") + "/s"
    pattern = rf"(?:^|_)(\d+(?:\.\d+)?){match['unit']}(?:_|\.|$)"
    return Amount("set_speed", pattern, unit, "m/s", name, "file name", unit)


def _force(stem: str, name: str) -> Amount | None:
    match = _FORCE.search(stem)
    pattern = rf"_(\d+(?:\.\d+)?){match['unit']}(?:_|\.)" if match else ""
    if match is None or not re.search(pattern, name):
        return None
    unit = match["unit"]
    return Amount("set_normal_force", pattern, unit, None, name, "file name", unit)
