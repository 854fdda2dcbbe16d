"""Windows of Fourier transforms, and logarithmic bins of their lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Bins:
    """Logarithmic bins of the lines of a Fourier transform.

    Parameters
    ----------
    starts
        First line of each bin, which extends to the first line of the next bin (bin,).
    stop
        The line after the last bin.
    """

    starts: np.ndarray
    stop: int

    @property
    def counts(self) -> np.ndarray:
        """Number of Fourier lines in each bin."""
        return np.diff(np.append(self.starts, self.stop))

    @property
    def edges(self) -> np.ndarray:
        """Edges of the bins in units of Fourier lines, half way between two lines."""
        return np.append(self.starts, self.stop) - 0.5

    @property
    def nodes(self) -> np.ndarray:
        """Wavenumber of each bin in units of Fourier lines: the geometric mean of its lines."""
        logs = np.log(np.arange(self.starts[0], self.stop))
        return np.exp(np.add.reduceat(logs, self.starts - self.starts[0]) / self.counts)


def log_bins(lines: int, lowest: int, per_decade: float, at_least: int = 4) -> Bins:
    """Return bins of equal width in ln(k) for the Fourier lines 1 to `lines`.

    Parameters
    ----------
    lines
        Number of the last line.
    lowest
        First reliable line; the lines below form one separate bin.
    per_decade
        Bins per decade if there are enough lines.
    at_least
        Smallest number of lines in a bin above `lowest`.
    """
    starts, ratio = ([1] if lowest > 1 else []), 10 ** (1 / per_decade)
    line = lowest
    while line <= lines:
        starts.append(line)
        line = max(line + at_least, int(np.ceil(line * ratio)))
    if len(starts) > 2 and lines + 1 - starts[-1] < 0.5 * (line - starts[-1]):
        starts.pop()
    return Bins(np.array(starts), lines + 1)


def window(points: int, flanks: float = 1.0) -> np.ndarray:
    """Return a window of unit mean square with ends that rise and fall like a Hann window.

    Parameters
    ----------
    points
        Number of points; the window is zero half a step beyond the ends.
    flanks
        Share of the length in the two flanks; 1 is the Hann window itself.
    """
    ends = np.minimum((np.arange(points) + 0.5) / points, 0.5)
    ends = np.minimum(np.minimum(ends, ends[::-1]) / flanks, 0.5)
    taper = np.sin(np.pi * ends) ** 2
    return taper / np.sqrt(np.mean(taper**2))


def correlation(shift: float, flanks: float = 1.0) -> float:
    """Return the squared correlation of two Fourier lines that are `shift` lines apart.

    Notes
    -----
    For Gaussian heights the power of two lines correlates as ``|W(shift) / W(0)|^2``, with W the
    transform of the squared window: for Hann 4/9 and 1/36 one and two lines apart.

    Examples
    --------
    >>> [round(correlation(d) * 36, 6) for d in (1, 2, 3)]
    [16.0, 1.0, 0.0]
    """
    points = 4096
    t = (np.arange(points) + 0.5) / points - 0.5
    return float(np.mean(window(points, flanks) ** 2 * np.cos(2 * np.pi * shift * t)) ** 2)


def shape(
    bins: Bins, slope: np.ndarray, spacing: float, flanks: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return bin mean / node value for a power law, and the number of independent values (bin).

    Parameters
    ----------
    bins
        The bins.
    slope
        ``d ln C_1D / d ln k`` of the spectrum in each bin (bin,).
    spacing
        Distance of two lines, relative to that without zero padding.
    flanks
        Flanks of the window, see `window`.

    Returns
    -------
    tuple of numpy.ndarray
        Ratio of the mean of ``k^slope`` over the bin to its value at the node, and the effective
        number of independent values (bin,).

    Notes
    -----
    ``1/N = sum_jl p_j p_l rho_(j-l)^2 / (sum_j p_j)^2`` with the power p of each line.
    """
    k = np.arange(bins.starts[0], bins.stop)
    here = bins.starts - bins.starts[0]
    owner = np.repeat(np.arange(here.size), bins.counts)
    power = (k / bins.nodes[owner]) ** slope[owner]
    correlated = power**2
    for lag in range(1, 5):
        same = owner[lag:] == owner[:-lag]
        pairs = np.where(same, power[lag:] * power[:-lag], 0.0)
        correlated[lag:] += 2 * correlation(lag * spacing, flanks) * pairs
    total = np.add.reduceat(power, here)
    return total / bins.counts, total**2 / np.add.reduceat(correlated, here)
