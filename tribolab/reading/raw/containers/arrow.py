"""Reading of Parquet and Feather files: one table, with metadata as settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.containers.groups import plain, settings_of
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable
from tribolab.reading.raw.opening import isolated, report_damage

_OF_LIBRARIES = (b"pandas", b"ARROW:schema", b"PANDAS_ATTRS")


@isolated("pyarrow", "pyarrow.parquet", "pyarrow.feather")
def read_arrow(path: Path) -> RawFile:
    """Read a Parquet or a Feather file.

    Raises
    ------
    ReadError
        If the file is damaged.
    """
    # imported late: pyarrow loads slowly
    import pyarrow as pa
    from pyarrow import feather
    from pyarrow import parquet as pq

    with path.open("rb") as file:
        form = "parquet" if file.read(4) == b"PAR1" else "feather"
    with report_damage(path, f"{form} file"):
        read = pq.read_table if form == "parquet" else feather.read_table
        table = read(path, use_threads=False, memory_map=False)
    columns = []
    for place, name in enumerate(table.column_names):
        values = table.column(place)
        if pa.types.is_dictionary(values.type):  # categorical data
            values = values.cast(values.type.value_type)
        if pa.types.is_decimal(values.type):
            values = values.cast(pa.float64())
        with report_damage(path, f"{form} file"):
            numbers = values.to_numpy()
        # other types (text, lists, structures) cannot be columns
        numbers = numbers if numbers.dtype.kind in "fiubMm" else np.empty(0, "U1")
        columns.append(RawColumn(name, _unit_of(table.schema.field(place)), numbers, path=name))
    metadata = dict(table.schema.metadata or {})
    kept = {str(plain(key)): value for key, value in metadata.items() if key not in _OF_LIBRARIES}
    settings = [setting for key, value in kept.items() for setting in settings_of(key, value)]
    return RawFile(path, form, (RawTable("", tuple(columns)),), tuple(settings))


def _unit_of(field: Any) -> str | None:
    """Return the unit in a column's metadata."""
    metadata = {str(plain(k)).lower(): str(plain(v)) for k, v in (field.metadata or {}).items()}
    return next((metadata[key] for key in keys_of("unit") if metadata.get(key, "").strip()), None)
