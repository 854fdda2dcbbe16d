"""Numbers of a table in which nothing but numbers stands, read without pandas."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from tribolab.draft.file.layout import Layout
from tribolab.io.dialects.text_rows import floats_of


def plain_numbers(layout: Layout) -> np.ndarray | None:
    """Return the numbers of all rows (rows, columns); None where anything else stands.

    Of a table that blanks part it is None, too: pandas, which takes longer to load than this, tells
    what stands there.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    if layout.numbers is not None:
        return layout.numbers.copy()
    if layout.delimiter == "whitespace" or len(layout.delimiter) != 1:
        return None
    names = [str(place) for place in range(layout.width)]
    text = "\n".join(layout.rows()).encode()
    if not text or layout.width < 2:
        return None
    try:
        table = arrow_csv.read_csv(
            pa.BufferReader(text),
            read_options=arrow_csv.ReadOptions(column_names=names, use_threads=False),
            parse_options=arrow_csv.ParseOptions(delimiter=layout.delimiter),
            convert_options=arrow_csv.ConvertOptions(
                column_types=dict.fromkeys(names, pa.float64()),
                null_values=[""],
                decimal_point=layout.decimal,
            ),
        )
    except pa.ArrowInvalid:
        return None
    columns = [np.concatenate([floats_of(part) for part in table[name].chunks]) for name in names]
    return np.column_stack(columns)
