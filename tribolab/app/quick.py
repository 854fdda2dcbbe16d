"""A quick start for commands that are to answer at once."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Iterator

from tribolab.core.untyped import Arguments

_OTHER_ARRAYS = ("dask", "dask.array", "pint", "cupy", "sparse")


def plain_arrays_only() -> None:
    """Let xarray know numpy's arrays only, for the rest of this program.

    When the first dataset is made, xarray loads every package whose arrays it could hold: dask
    and pint take half a second, which is half of what a check of a file may take. A command that
    makes its datasets itself meets no other arrays. Where xarray or one of the packages is loaded
    already, nothing is changed. For a command line; a library must not do this to its callers.
    """
    if any(name in sys.modules for name in ("xarray", *_OTHER_ARRAYS)):
        return
    nothing: Arguments = dict.fromkeys(_OTHER_ARRAYS)  # None: an import of it fails
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
    """Look for no garbage while libraries are imported: all of it stays.

    Their hundred thousand small objects would be gone through again and again, for a tenth of a
    second; afterwards they are left alone, too.
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
