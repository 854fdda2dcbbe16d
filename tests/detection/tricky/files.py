"""How other labs write a table, and the dialect that a sensible user writes for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Column:
    """A column of a file: values in the file's unit, under a name; `quantity` "" is not used."""

    quantity: str
    name: str
    unit: str
    values: np.ndarray
    form: str = ".7g"
    sign: int = 1


def table(
    columns: Sequence[Column],
    *,
    preamble: Sequence[str] = (),
    delimiter: str = ",",
    decimal: str = ".",
    header: bool = True,
    units: str = "brackets",
) -> str:
    """Text of a table with its preamble."""
    lines = list(preamble)
    if header:
        names = [c.name for c in columns]
        if units == "brackets":
            names = [f"{c.name} [{c.unit}]" if c.unit else c.name for c in columns]
        lines.append(delimiter.join(names))
        if units == "row":
            lines.append(delimiter.join(c.unit for c in columns))
    text = [[format(v, c.form) for v in c.values.tolist()] for c in columns]
    if decimal == ",":
        text = [[cell.replace(".", ",") for cell in cells] for cells in text]
    lines += [delimiter.join(row) for row in zip(*text, strict=True)]
    return "\n".join(lines) + "\n"


def dialect(
    name: str,
    columns: Sequence[Column],
    *,
    delimiter: str = ",",
    decimal: str = ".",
    preamble: Sequence[str] = (),
    units: str = "brackets",
    time: str = "",
    speed: str = "",
    more: str = "",
) -> str:
    """TOML of the dialect for `table` with the same arguments."""
    mark = {"\t": "\\t"}.get(delimiter, delimiter)
    lines = [
        f'name = "{name}"',
        f'title = "{name}"',
        "[text]",
        f'delimiter = "{mark}"',
        f'decimal = "{decimal}"',
        "[header]",
        f"line = {len(preamble) + 1}",
        f'units = "{units}"',
    ]
    if time:
        lines += ["[time]", time]
    if speed:
        lines += ["[speed]", speed]
    for column in columns:
        if column.quantity:
            lines += ["[[column]]", f'quantity = "{column.quantity}"', f'name = "{column.name}"']
            if column.sign != 1:
                lines.append(f"sign = {column.sign}")
    return "\n".join([*lines, more]) + "\n"
