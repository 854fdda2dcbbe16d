"""Units of length in a file name, for files without units: `plate3_xy-mm_z-um.asc`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from tribolab.core.errors import Cure
from tribolab.units.spellings import MICRO, unit_of_length

_UNIT_IN_NAME = re.compile(
    r"(?i)(?<![^\W_])(?P<what>xyz|xy|x|y|z|heights?|h(?:ö|oe)hen?)[-_ =]?(?:in[-_ ])?"
    rf"(?P<unit>[npu{MICRO}]m|mm|cm|microns?|(?<=in[-_ ])m)(?![^\W_])"
)


class NamedUnits(NamedTuple):
    """Units of positions and heights in a file name; None if not stated."""

    x: str | None
    height: str | None


def units_in_name(path: Path) -> NamedUnits:
    """Return the units of positions and heights in a file name; None if missing or ambiguous.

    >>> units_in_name(Path("plate3_xy-mm_z-um.asc")), units_in_name(Path("scan_x_mm.txt"))
    (NamedUnits(x='mm', height='um'), NamedUnits(x='mm', height=None))
    """
    along, up = set(), set()
    for match in _UNIT_IN_NAME.finditer(path.stem):
        what, unit = match["what"].lower(), unit_of_length(match["unit"])
        if "x" in what or "y" in what:
            along.add(unit)
        if "z" in what or what.startswith("h"):
            up.add(unit)
    one = [units.pop() if len(units) == 1 else None for units in (along, up)]
    return NamedUnits(*one)


def unit_remedy(path: Path, *, along: bool, up: bool) -> Cure:
    """Return instructions for stating missing units of positions, heights, or both."""
    arguments = {"x_unit": "mm"} if along else {}
    arguments |= {"height_unit": "um"} if up else {}
    stated = " and ".join(f"{name}='{unit}'" for name, unit in arguments.items())
    name = f"{path.stem}{'_xy-mm' if along else ''}{'_z-um' if up else ''}{path.suffix}"
    rename = f"put it into the file's name: '{name}'"
    return Cure(notebook=f"say {stated}, or {rename}", terminal=rename, campaign=rename)
