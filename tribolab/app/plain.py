"""Module for worker processes: its import calls `plain_arrays_only`."""

from tribolab.app.quick import plain_arrays_only

plain_arrays_only()
