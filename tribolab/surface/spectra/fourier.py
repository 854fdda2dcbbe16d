"""Fourier power of windowed heights, computed in chunks and with a fast length."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.surface.spectra.binning import Bins

_CHUNK_BYTES = 1 << 21  # bytes per chunk: a chunk and its transform fit into the processor's cache


class Power(NamedTuple):
    """Power in each bin, summed over the scans, and both sides of Parseval's relation."""

    bins: np.ndarray
    lines: float
    heights: float


def fast_length(points: int) -> int:
    """Return the smallest multiple of 16, at least `points`, with no prime factor above 5.

    Lengths with few factors of two (50 625 = 15^4) take half as long again per point as those
    with many.

    >>> fast_length(50_001)
    51200
    """
    best = 16 * 2 ** max(0, int(np.ceil(np.log2(max(points, 1) / 16))))
    for threes in range(20):
        for fives in range(14):
            odd = 3**threes * 5**fives
            if 16 * odd >= best:
                break
            twos = max(0, int(np.ceil(np.log2(points / (16 * odd)))))
            best = min(best, 16 * odd * 2**twos)
    return best


def binned_power(
    height: np.ndarray, window: np.ndarray, bins: Bins, length: int, workers: int = 1
) -> Power:
    """Return ``|H_k|^2`` summed over the Fourier lines of each bin and over all scans.

    Parameters
    ----------
    height
        Heights [m] (scan, x), with zero mean; an array, or an object whose slices are arrays.
    window
        Window (x).
    bins
        Bins of the lines 1 ... length // 2.
    length
        Length of the transform; the heights are padded with zeros.
    workers
        Threads of the transform.

    Notes
    -----
    Scans are processed in chunks, so that memory does not grow with their number. Real and
    imaginary parts are squared in place and summed as neighbours.
    """
    # imported late: scipy loads slowly
    import scipy.fft

    scans, points = height.shape
    chunk = max(1, min(scans, _CHUNK_BYTES // (8 * length)))
    work = np.zeros((chunk, length))
    last = 2 * (length // 2)  # index of the real part of the Nyquist line
    total, lines, heights = np.zeros(bins.starts.size), 0.0, 0.0
    for first in range(0, scans, chunk):
        part = np.asarray(height[first : first + chunk], dtype=float)
        tapered = work[: len(part)]
        np.multiply(part, window, out=tapered[:, :points])
        flat = tapered.ravel()
        heights += float(flat @ flat)
        squares = scipy.fft.rfft(tapered, axis=-1, workers=workers).view(float)
        np.multiply(squares, squares, out=squares)
        lines += float(squares[:, :2].sum()) - float(squares[:, last:].sum())
        total += np.add.reduceat(squares, 2 * bins.starts, axis=-1).sum(0)
        # every line but the last counts twice, for its mirror image
    lines += 2 * float(total.sum())
    return Power(total, lines / length, heights)
