"""Fourth-order integration over cells of unequal width, by parabolas and cubics."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.contact.line import line_kernel

_SERIES_DISTANCE = 6.0  # cell widths beyond which moments are computed from a series
_GAUSS = 0.5 / np.sqrt(3)  # distance of Gauss points from an interval's centre, in lengths of it
_FINE = 129  # points for the search of the minimum film


class Between(NamedTuple):
    """Two Gauss points between neighbouring cell centres, and in the half cells at both ends.

    The film at the points is a cubic through the four surrounding centres, a parabola through three
    next to the outermost cells, and constant in the outer halves of the outermost cells.
    """

    weight: np.ndarray  # half the distance between the centres, the weight of both points (n + 1)
    share: np.ndarray  # weights of the four surrounding cells for a cubic (2, 4, n + 1)
    straight: np.ndarray  # weights of the four surrounding cells for a straight line (2, 4, n + 1)
    cell: np.ndarray  # indices of the four surrounding cells (4, n + 1)


def between_middles(x: np.ndarray, width: np.ndarray) -> Between:
    """Return the Gauss points between the centres of cells with given widths (n)."""
    n = x.size
    # four cells around each face; cells beyond the ends have weight 0
    cell = np.arange(-2, 2)[:, None] + np.arange(n + 1)
    exists = (cell >= 0) & (cell < n)
    cell = cell.clip(0, n - 1)
    length = np.concatenate([[width[0] / 2], np.diff(x), [width[-1] / 2]])
    centre = np.concatenate([x[:1] - width[0] / 4, (x[1:] + x[:-1]) / 2, x[-1:] + width[-1] / 4])
    at = centre + np.array([[-_GAUSS], [_GAUSS]]) * length
    nodes = x[cell]
    share = np.ones((2, 4, n + 1))
    for i in range(4):
        for j in range(4):
            if i != j:
                both = exists[i] & exists[j]
                apart = np.where(both, nodes[i] - nodes[j], 1.0)
                share[:, i] *= np.where(both, (at - nodes[j]) / apart, 1.0)
    share *= exists
    straight = np.zeros_like(share)
    straight[:, 1] = 0.5 + np.array([[_GAUSS], [-_GAUSS]])
    straight[:, 2] = 1 - straight[:, 1]
    for face, mine in ((0, 2), (n, 1)):  # the outermost half cells have constant values
        share[:, :, face] = straight[:, :, face] = np.arange(4) == mine
    return Between(length / 2, share, straight, cell)


def curved_weights(x: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return weights (n) of the values at cell centres, for integrals over all cells.

    Within a cell, values follow the parabola through its centre and the two neighbouring ones;
    in the outermost cells they are constant.
    """
    weight = width.copy()
    for shift, _, curve in _parabolas(x):
        part = curve * width[1:-1] ** 3 / 24
        weight[1 + shift : x.size - 1 + shift] += part
    return weight


def curved_kernel(x: np.ndarray, width: np.ndarray) -> np.ndarray:
    """Return the displacement at x_i due to unit pressure at x_j (n, n), for E* = 1.

    As `line_kernel`, but the pressure in a cell follows the parabola through the values at its
    centre and the two neighbouring ones; it is constant in the outermost cells.
    """
    kernel = line_kernel(x, width, 1.0)
    first, second = _moments(x, width)
    for shift, slope, curve in _parabolas(x):
        columns = slice(1 + shift, x.size - 1 + shift)
        kernel[:, columns] += first[:, 1:-1] * slope + second[:, 1:-1] * (curve / 2)
    return kernel


def _parabolas(x: np.ndarray) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """Return, for each of three cells, its offset and weights in slope and curvature (n - 2)."""
    before, after = x[1:-1] - x[:-2], x[2:] - x[1:-1]
    both = before + after
    return [
        (-1, -after / (before * both), 2 / (before * both)),
        (0, (after - before) / (before * after), -2 / (before * after)),
        (1, before / (after * both), 2 / (after * both)),
    ]


def _moments(x: np.ndarray, width: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return -(2/pi) int (x' - x_j)^k ln(|x_i - x'|/l) dx' over cell j (n, n), for k = 1 and 2.

    l is that of `line_kernel`. Far from a cell, where the closed form is a difference of large
    numbers, a series is used.
    """
    scale = x[-1] - x[0] + width.mean()
    apart = x - x[:, None]
    near = np.abs(apart) < _SERIES_DISTANCE * width
    safe = np.where(near, 1.0, apart)
    third, fifth, seventh = width**3 / 12, width**5 / 80, width**7 / 448
    first = third / safe + fifth / (3 * safe**3) + seventh / (5 * safe**5)
    second = third * np.log(np.abs(safe) / scale) - fifth / (2 * safe**2) - seventh / (4 * safe**4)
    row, column = np.nonzero(near)
    d, half = apart[row, column], width[column] / 2
    powers = [_antiderivatives(d + half, scale), _antiderivatives(d - half, scale)]
    t0, t1, t2 = (high - low for high, low in zip(*powers, strict=True))
    first[row, column] = t1 - d * t0
    second[row, column] = t2 - 2 * d * t1 + d * d * t0
    return -2 / np.pi * first, -2 / np.pi * second


def _antiderivatives(t: np.ndarray, scale: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the antiderivatives of t^k ln(|t|/l) for k = 0, 1, 2."""
    log = np.log(np.where(t == 0, 1.0, np.abs(t)) / scale)
    return t * (log - 1), t**2 / 2 * (log - 1 / 2), t**3 / 3 * (log - 1 / 3)


def lowest(x: np.ndarray, values: np.ndarray) -> float:
    """Return the minimum of a function given at cell centres, by a quartic through five values."""
    middle = min(max(int(np.argmin(values)), 2), x.size - 3)
    around = slice(middle - 2, middle + 3)
    fine = np.linspace(x[middle - 1], x[middle + 1], _FINE)
    return float(_polynomial(x[around], values[around], fine).min())


def value_at(x: np.ndarray, values: np.ndarray, at: float) -> float:
    """Return a function given at cell centres, interpolated by a cubic at one position."""
    after = min(max(int(np.searchsorted(x, at)), 2), x.size - 2)
    around = slice(after - 2, after + 2)
    return float(_polynomial(x[around], values[around], np.array([at]))[0])


def _polynomial(nodes: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the values of the polynomial through all nodes, by Newton's divided differences."""
    parts = values.astype(float)
    for order in range(1, nodes.size):
        parts[order:] = (parts[order:] - parts[order - 1 : -1]) / (nodes[order:] - nodes[:-order])
    result = np.full(at.shape, parts[-1])
    for node, part in zip(nodes[-2::-1], parts[-2::-1], strict=True):
        result = result * (at - node) + part
    return result
