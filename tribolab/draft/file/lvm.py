"""What stands above the names in LabVIEW's measurement files (.lvm): units, and what X is.

The lines are those of the maker's "Specification for the LabVIEW Measurement File (.lvm)", as files
in the tests of published readers have them: ``Y_Unit_Label`` and ``X_Dimension``, a cell for each
column.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribolab.draft.file.layout import Layout

_MARK = "LabVIEW Measurement"
_X = "X_Value"
_DIMENSIONS = {"Time": "s", "Frequency": "Hz"}


def units_above(layout: Layout) -> dict[int, str]:
    """Return the units of the columns (from 1) that lines above the names say.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.

    Returns
    -------
    dict
        Empty for files that are not LabVIEW's.
    """
    heading = layout.heading
    if heading is None or not layout.lines[0].startswith(_MARK):
        return {}
    said: dict[str, list[str]] = {}
    for line in layout.lines[: heading.names]:
        key, *cells = (cell.strip() for cell in line.split(layout.delimiter))
        said[key] = cells
    units = {
        place: unit for place, unit in enumerate(said.get("Y_Unit_Label", ()), start=2) if unit
    }
    x_unit = _DIMENSIONS.get(next(iter(said.get("X_Dimension", ())), ""))
    for place, name in enumerate(heading.cells, start=1):
        if name == _X and x_unit:
            units[place] = x_unit
    return units
