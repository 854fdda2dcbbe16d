"""Faster imports, for commands that should answer immediately."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Iterator

from tribolab.core.untyped import Arguments

_OTHER_ARRAYS = ("dask", "dask.array", "pint", "cupy", "sparse")


def plain_arrays_only() -> None:
    """Restrict xarray to numpy arrays for the rest of this program.

    For the first dataset, xarray loads every package whose arrays it supports: dask and pint take
    0.5 s, half of the time to check a file. A command that creates its datasets itself needs no
    other arrays. If xarray or one of the packages is already loaded, nothing is changed. For the
    command line only; a library must not do this to its callers.
    """
    if any(name in sys.modules for name in ("xarray", *_OTHER_ARRAYS)):
        return
    nothing: Arguments = dict.fromkeys(_OTHER_ARRAYS)  # None makes an import fail
    sys.modules.update(nothing)
    try:
        # imported late: xarray loads slowly
        import xarray as xr

        xr.Dataset({"value": ("x", [0.0])}, {"x": [0.0]}).value.to_numpy()
    finally:
        for name in _OTHER_ARRAYS:
            del sys.modules[name]


@contextlib.contextmanager
def importing() -> Iterator[None]:
    """Disable garbage collection during imports, because it would free nothing.

    Scanning their hundred thousand small objects repeatedly takes 0.1 s; afterwards they are
    excluded from collection.
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
