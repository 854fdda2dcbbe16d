"""Amounts stated in a file name: PTFE_3N_b.csv."""

from __future__ import annotations

import re

from tribolab.reading.interpret.amounts import Amount

_FORCE = re.compile(r"(?:^|_)\d+(?:\.\d+)?(?P<unit>N|mN)(?=_|$)")


def amounts_of_name(name: str) -> list[Amount]:
    r"""Return the amounts in a file name: the load.

    Parameters
    ----------
    name
        File name with its suffix.

    Examples
    --------
    >>> [(a.name, a.number) for a in amounts_of_name("PTFE_3N_b.csv")]
    [('set_normal_force', 3.0)]
    """
    force = _force(re.sub(r"\.[A-Za-z]\w{0,4}$", "", name), name)
    return [] if force is None else [force]


def _force(stem: str, name: str) -> Amount | None:
    match = _FORCE.search(stem)
    pattern = rf"_(\d+(?:\.\d+)?){match['unit']}(?:_|\.)" if match else ""
    if match is None or not re.search(pattern, name):
        return None
    unit = match["unit"]
    return Amount("set_normal_force", pattern, unit, None, name, "file name", unit)
