"""Arrays that grow while the blocks of a table are read."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from tribolab.arrays.scratch import is_long, let_go, room
from tribolab.reading.dialect.columns import ReadColumn

_MIN_LINES = 5  # lines needed to recognise that every second one is empty


class GrowingColumns:
    """Arrays that grow block by block; numbers are converted to SI when stored.

    `size` is the number of bytes of the table, in `blocks` blocks; `of` that of all tables of the
    run.
    """

    def __init__(self, signals: list[ReadColumn], size: int, of: int, blocks: int):
        self._signals, self._size, self._blocks = signals, size, blocks
        self._parts = max(1.0, of / max(size, 1))  # ratio of the run's size to this table's size
        self._arrays: list[np.ndarray] = []
        self._used = 0

    def take(self, pieces: list[list[np.ndarray]]) -> None:
        """Append the pieces of one block."""
        rows = sum(len(piece) for piece in pieces[0])
        if rows == 0:
            return
        self._make_room(rows)
        for signal, array, chunks in zip(self._signals, self._arrays, pieces, strict=True):
            at = self._used
            for chunk in chunks:
                target = array[at : at + len(chunk)]
                with np.errstate(over="ignore"):  # a damaged number may overflow
                    if signal.scale == 1.0:
                        target[:] = chunk
                    else:
                        _scaled(chunk, signal.scale, target)
                    if signal.offset:
                        target += signal.offset
                at += len(chunk)
        self._used += rows
        let_go()

    def _make_room(self, rows: int) -> None:
        if not self._arrays:
            # allocated memory that is never used costs nothing, so the guess is high
            guess = max(rows, min(rows * (self._blocks + 2), self._size // 2 + 1))
            self._arrays = [self._room(guess) for _ in self._signals]
        if self._used + rows > len(self._arrays[0]):
            for k, array in enumerate(self._arrays):
                self._arrays[k] = self._room(max(2 * len(array), self._used + rows))
                self._arrays[k][: self._used] = array[: self._used]
                let_go()

    def _room(self, rows: int) -> np.ndarray:
        """Return an array of that many rows: in a scratch file for a long run, else from arrow.

        Numpy requests huge pages, which the system first clears if memory is fragmented.
        """
        of = int(rows * self._parts)
        return room(rows, of=of) if is_long(of) else np.frombuffer(pa.allocate_buffer(8 * rows))

    def finished(self) -> dict[str, np.ndarray]:
        """Return arrays by quantity, cut to the rows that were read."""
        arrays = self._arrays or [np.empty(0) for _ in self._signals]
        return {
            s.quantity: array[: self._used] for s, array in zip(self._signals, arrays, strict=True)
        }


def of_one_column(values: np.ndarray) -> np.ndarray:
    """Return the values of a single column without empty lines around it or after each line.

    Examples
    --------
    >>> of_one_column(np.array([np.nan, 1.0, np.nan, 3.0, 4.0, np.nan]))
    array([ 1., nan,  3.,  4.])
    >>> of_one_column(np.array([1.0, np.nan, 2.0, np.nan, 3.0, np.nan, 4.0]))
    array([1., 2., 3., 4.])
    """
    known = np.flatnonzero(np.isfinite(values))
    if not known.size:
        return values
    inner = values[known[0] : known[-1] + 1]
    is_double = inner.size > _MIN_LINES and inner.size == 2 * known.size - 1
    return inner[::2] if is_double and np.isfinite(inner[::2]).all() else inner


def _scaled(numbers: np.ndarray, scale: float, out: np.ndarray) -> None:
    """Multiply so that 49.703 mm is exactly 0.049703 m: division by 1000 rounds only once."""
    inverse = 1.0 / scale
    if abs(inverse) > 1.0 and abs(inverse - round(inverse)) < 1e-12 * abs(inverse):
        np.divide(numbers, float(round(inverse)), out=out)
    else:
        np.multiply(numbers, scale, out=out)
