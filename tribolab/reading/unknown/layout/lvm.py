"""Header of LabVIEW's measurement files (.lvm): units, and the meaning of X.

The lines ``Y_Unit_Label`` and ``X_Dimension`` have a cell for each column. They are described in
"Specification for the LabVIEW Measurement File (.lvm)", and occur in test files of public readers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribolab.reading.unknown.layout.text_layout import Layout

_MARK = "LabVIEW Measurement"
_X = "X_Value"
_DIMENSIONS = {"Time": "s", "Frequency": "Hz"}


def units_above(layout: Layout) -> dict[int, str]:
    """Return the units that lines above the column names state, by column number from 1.

    The result is empty for files that are not LabVIEW's.
    """
    heading, said = layout.heading, _header_cells(layout)
    if heading is None:
        return {}
    # without an X column, the first channel is below the names of the header lines
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
    """Return a pattern that finds the stated sampling interval, and its unit; else None."""
    said = _header_cells(layout)
    apart, of = said.get("Delta_X", []), said.get("X_Dimension", ["Time"])
    if not apart or not apart[0] or of[:1] != ["Time"]:
        return None
    return r"^Delta_X\s+([-+\d.,eE]+)", "s"


def _header_cells(layout: Layout) -> dict[str, list[str]]:
    """Return the cells of each line above the column names, by the first cell of the line."""
    heading = layout.heading
    if heading is None or not layout.lines[0].startswith(_MARK):
        return {}
    said: dict[str, list[str]] = {}
    for line in layout.lines[: heading.names]:
        key, *cells = (cell.strip() for cell in line.split(layout.delimiter))
        said[key] = cells
    return said
