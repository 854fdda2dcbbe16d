"""Numbers and words in the cells of an unknown table."""

from __future__ import annotations

import io
import warnings
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.csv as arrow_csv

from tribolab.core.errors import ReadError, brief
from tribolab.reading.dialect.delimited.rows import floats_of
from tribolab.reading.raw.missing_marks import LARGEST, take_marks
from tribolab.reading.unknown.layout.text_layout import Layout


class Cells(NamedTuple):
    """Contents of the cells of a table.

    Attributes
    ----------
    numbers
        Of all rows (rows, columns); NaN for what is none.
    text
        For each column one of its words if most of its cells are words, else "".
    missing
        For each column its words for a missing value.
    """

    numbers: np.ndarray
    text: list[str]
    missing: list[list[str]]


def read_cells(layout: Layout) -> Cells:
    """Return the numbers and words of all rows of a table.

    Raises
    ------
    ReadError
        If a quotation mark is left open.
    """
    plain = _plain_numbers(layout)
    if plain is not None:
        return Cells(_measured(plain), [""] * layout.width, [[] for _ in range(layout.width)])
    # late: takes longer to load than a plain table to read
    import pandas as pd

    blank = layout.delimiter == "whitespace"
    try:
        with warnings.catch_warnings():  # the layout counts cells beyond the table's width
            warnings.simplefilter("ignore", pd.errors.ParserWarning)
            frame = pd.read_csv(
                io.StringIO("\n".join(layout.rows())),
                sep=r"\s+" if blank else layout.delimiter,
                header=None,
                names=range(layout.width),
                decimal=layout.decimal,
                index_col=False,
                keep_default_na=False,
                na_values=[""],
                skipinitialspace=True,
                on_bad_lines="skip",
                low_memory=False,
            )
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise ReadError(
            f"{layout.file.path}: the table cannot be read: {brief(error, 100)}; is a quotation "
            "mark left open in it?"
        ) from error
    numbers = np.full(frame.shape, np.nan)
    text = [""] * layout.width
    missing: list[list[str]] = [[] for _ in range(layout.width)]
    understood = np.array([dtype.kind in "fiu" for dtype in frame.dtypes], dtype=bool)
    numbers[:, understood] = frame.loc[:, understood].to_numpy(dtype=float)
    for index in np.flatnonzero(~understood).tolist():
        column = frame[index]
        pointed = column.astype(str).str.replace(",", ".") if layout.decimal == "," else column
        try:
            known = pd.to_numeric(pointed, errors="coerce")
        except OverflowError:  # whole numbers of hundreds of digits
            known = pd.to_numeric(pointed.astype(str), errors="coerce")
        numbers[:, index] = known.to_numpy(dtype=float)
        odd = column[known.isna() & column.notna()].astype(str).str.strip()
        odd = odd[~odd.str.lower().isin(["nan", ""])]
        if len(odd) > 0.5 * column.notna().sum():
            text[index] = odd.iloc[0][:30]
        else:
            missing[index] = odd.unique()[:10].tolist()
    return Cells(_measured(numbers), text, missing)


def _measured(numbers: np.ndarray) -> np.ndarray:
    """Return numbers without no-data values, which the reader omits."""
    numbers[np.abs(numbers) > LARGEST] = np.nan
    for values in numbers.T:
        take_marks([values])
    return numbers


def _plain_numbers(layout: Layout) -> np.ndarray | None:
    """Return the numbers of a table without words; None for another, or one parted by blanks.

    pandas, which takes longer to load than this takes, tells what such a table holds.
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
