"""Imported first by a process that makes all of its datasets itself: `plain_arrays_only`."""

from tribolab.app.quick import plain_arrays_only

plain_arrays_only()
