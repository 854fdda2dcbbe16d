"""A signal as a line of block characters, to be seen in any terminal."""

from __future__ import annotations

import numpy as np

BARS = "▁▂▃▄▅▆▇█"
PLAIN = "_.-:=+*#"  # for terminals that know no other letters


def sparks(values: np.ndarray, width: int = 60, blocks: str = BARS) -> str:
    """Return a signal as one line of blocks: the height of each is the mean of its part.

    Parameters
    ----------
    values
        The signal.
    width
        Number of blocks; fewer for fewer samples.
    blocks
        The blocks, the lowest first.

    Examples
    --------
    >>> sparks(np.array([0.0, 1.0, 2.0, np.nan, 7.0])), sparks(np.ones(3))
    ('▁▂▃ █', '▄▄▄')
    """
    parts = np.array_split(values, min(width, len(values)) or 1)
    means = np.array(
        [np.mean(part[np.isfinite(part)]) if np.isfinite(part).any() else np.nan for part in parts]
    )
    known = means[np.isfinite(means)]
    if not known.size:
        return " " * len(means)
    low, span = known.min(), np.ptp(known)
    levels = (means - low) / span * (len(blocks) - 1) if span else 0.0 * means + 3
    return "".join(" " if np.isnan(level) else blocks[int(round(level))] for level in levels)
