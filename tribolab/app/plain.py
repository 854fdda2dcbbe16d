"""Module that calls `plain_arrays_only` when imported, for worker processes."""

from tribolab.app.quick import plain_arrays_only

plain_arrays_only()
