"""Header of LabVIEW's measurement files (.lvm): units, and the meaning of X.

The lines are those of the maker's "Specification for the LabVIEW Measurement File (.lvm)", as files
in the tests of published readers have them: ``Y_Unit_Label`` and ``X_Dimension``, a cell for each
column.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribolab.reading.unknown.layout.text_layout import Layout

_MARK = "LabVIEW Measurement"
_X = "X_Value"
_DIMENSIONS = {"Time": "s", "Frequency": "Hz"}


def units_above(layout: Layout) -> dict[int, str]:
    """Return the units of the columns (from 1) from the lines above the names.

    It is empty for files that are not LabVIEW's.
    """
    heading, said = layout.heading, _said_above(layout)
    if heading is None:
        return {}
    # without an X column the first channel is below the names of the lines
    first = 2 if heading.cells[:1] in ((_X,), ("",)) else 1
    units = {
        place: unit for place, unit in enumerate(said.get("Y_Unit_Label", ()), start=first) if unit
    }
    x_unit = _DIMENSIONS.get(next(iter(said.get("X_Dimension", ())), ""))
    for place, name in enumerate(heading.cells, start=1):
        if name == _X and x_unit:
            units[place] = x_unit
    return units


def interval_above(layout: Layout) -> tuple[str, str] | None:
    """Return a pattern of the sampling interval and its unit, if there is no X column."""
    said = _said_above(layout)
    apart, of = said.get("Delta_X", []), said.get("X_Dimension", ["Time"])
    if not apart or not apart[0] or of[:1] != ["Time"]:
        return None
    return r"^Delta_X\s+([-+\d.,eE]+)", "s"


def _said_above(layout: Layout) -> dict[str, list[str]]:
    """Return the cells of the lines above the names by what each is called."""
    heading = layout.heading
    if heading is None or not layout.lines[0].startswith(_MARK):
        return {}
    said: dict[str, list[str]] = {}
    for line in layout.lines[: heading.names]:
        key, *cells = (cell.strip() for cell in line.split(layout.delimiter))
        said[key] = cells
    return said
