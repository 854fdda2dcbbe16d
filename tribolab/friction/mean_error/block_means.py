"""Error of a mean from the scatter of block means: a check on the other estimates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.friction import limits

_BLOCK_LENGTHS = 25


def error_from_blocks(
    signal: xr.DataArray | np.ndarray, lengths: Sequence[int] | np.ndarray | None = None
) -> xr.Dataset:
    """Return the standard error of a signal's mean, from the scatter of its block means.

    Parameters
    ----------
    signal
        Values in equal steps (one dim), any unit.
    lengths
        Lengths of the blocks [samples]; by default some 25 from 1 to a twelfth of the record.

    Returns
    -------
    xarray.Dataset
        On dim ``block_length`` [samples]: ``standard_error`` [unit of the signal], its own standard
        error ``standard_error_std`` and the number of ``blocks``. Once a block is longer than the
        correlation time, the standard error no longer depends on the length.

    Raises
    ------
    AnalysisError
        If the record is shorter than two blocks of each length.

    Notes
    -----
    The error is the standard deviation of n block means over sqrt(n), known within 1/sqrt(2 (n -
    1)) [1]_.

    References
    ----------
    .. [1] Flyvbjerg and Petersen (1989), Error estimates on averages of correlated data,
       J. Chem. Phys. 91, 461. doi:10.1063/1.457480

    Examples
    --------
    >>> noise = np.random.default_rng(0).standard_normal(10_000)
    >>> blocks = error_from_blocks(noise, [1, 100])
    >>> blocks.standard_error.values.round(3), blocks.blocks.values
    (array([0.01 , 0.011]), array([10000,   100]))
    """
    values = np.asarray(signal, dtype=float)
    if values.ndim != 1:
        raise AnalysisError(f"blocks are cut from a signal over one dim; this has {values.ndim}")
    if lengths is None:
        longest = max(values.size // limits.MIN_BLOCKS.value, 1)
        lengths = np.unique(np.geomspace(1, longest, _BLOCK_LENGTHS).astype(int))
    size = np.asarray(lengths, dtype=int)
    count = values.size // np.maximum(size, 1)
    if size.size == 0 or size.min() < 1 or count.min() < 2:
        raise AnalysisError(
            f"blocks of 1 to {values.size // 2} samples can be cut from {values.size} samples, "
            f"so that there are two"
        )
    means = [
        values[: length * n].reshape(n, length).mean(axis=1)
        for length, n in zip(size, count, strict=True)
    ]
    error = np.array([each.std(ddof=1) for each in means]) / np.sqrt(count)
    unit = {"units": str(getattr(signal, "attrs", {}).get("units", "1"))}
    about = unit | {"long_name": "standard error of the mean"}
    own = unit | {"long_name": "standard error of that"}
    return xr.Dataset(
        {
            "standard_error": ("block_length", error, about),
            "standard_error_std": ("block_length", error / np.sqrt(2 * (count - 1)), own),
            "blocks": ("block_length", count, {"units": "1", "long_name": "number of blocks"}),
        },
        {"block_length": ("block_length", size, {"units": "1", "long_name": "samples in a block"})},
    )
