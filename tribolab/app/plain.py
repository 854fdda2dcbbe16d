"""Import this first in a process that creates all its datasets itself: `plain_arrays_only`."""

from tribolab.app.quick import plain_arrays_only

plain_arrays_only()
