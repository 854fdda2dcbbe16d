"""Linear algebra on one thread, for matrices so small that two threads wait for each other."""

from __future__ import annotations

import functools
import sys
from contextlib import AbstractContextManager

from threadpoolctl import ThreadpoolController

_SECOND = "scipy.linalg"  # brings a library of its own, beside numpy's


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which numpy's and scipy's linear algebra keeps to one thread.

    Examples
    --------
    >>> import numpy as np
    >>> with one_thread():
    ...     np.linalg.solve(2 * np.eye(2), [2, 4]).tolist()
    [1.0, 2.0]
    """
    libraries = _libraries(_SECOND in sys.modules)
    limited: AbstractContextManager[object] = libraries.limit(limits=1, user_api="blas")
    return limited


@functools.cache
def _libraries(second: bool) -> ThreadpoolController:
    """Find the libraries, once as they come: it takes as long as to match two short logs."""
    return ThreadpoolController()
