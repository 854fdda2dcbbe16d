"""Linear algebra on a single thread, which is faster for small matrices."""

from __future__ import annotations

import functools
import sys
from contextlib import AbstractContextManager

from threadpoolctl import ThreadpoolController

_SECOND = "scipy.linalg"  # scipy has its own linear algebra library, besides that of numpy


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which the linear algebra of numpy and scipy uses one thread.

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
    """Return the linear algebra libraries; cached, because the search is slow."""
    return ThreadpoolController()
