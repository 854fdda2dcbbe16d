"""Cells across the contact, refined where film and pressure are steep, with their elasticity."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.linalg import inv

from tribolab.contact.layer import Layer, line_layer_kernel
from tribolab.lubrication.parabolas import Between, between_middles, curved_kernel, curved_weights

# Positions of dense cells: the film forms at the inlet, and is thinnest in the narrow
# constriction at the outlet.
_ENDS = ((-1, 2.5, 2.0), (1, 2.5, 1.0))  # position, weight, and width in units of the edge


class Mesh(NamedTuple):
    """Cells in units of the contact half-width b; the flat slides to +x, the inlet is at x < 0."""

    x: np.ndarray  # centres of the cells (n)
    width: np.ndarray  # widths of the cells (n)
    weight: np.ndarray  # weights of values at the centres, for integrals over all cells (n)
    between: Between  # Gauss points between centres, at which the flow is computed
    kernel: np.ndarray  # displacement by unit pressure in a cell, for E* = 1 (n, n)
    elastic: np.ndarray  # K, the inverse of the kernel, with the column -K 1 appended (n, n + 1)
    push: np.ndarray  # load by a unit of each column, weight @ elastic (n + 1)


@functools.lru_cache(maxsize=16)
def graded_mesh(
    cells: int,
    edge: float,
    inlet: float,
    outlet: float,
    size: float = 1.0,
    layer: Layer | None = None,
) -> Mesh:
    """Return a mesh whose cells are densest at x = -size and x = size.

    Parameters
    ----------
    cells
        Number of cells.
    edge
        Length over which the film rises at the contact's edge, in units of size b. Cells are finest
        there: with 160 cells, they are a sixth to a third of it at the outlet, twice that at the
        inlet.
    inlet, outlet
        Ends of the domain: -inlet, outlet, in units of b.
    size
        Half-width of the resolved region, in units of b: more than 1 for a thick film.
    layer
        An elastic layer on a rigid base, its thickness in units of b.

    Notes
    -----
    The inverse is cached for the last few meshes: it depends only on the cells, because lengths are
    in units of b and the length scale of the kernel is included in the constant of Eq. (9).
    """
    # positions at which the density of cells is computed: equal steps of asinh((x -+ 1)/edge)
    inlet, outlet = inlet / size, outlet / size
    reach = np.arcsinh((max(inlet, outlet) + 1) / edge)
    near = edge * np.sinh(np.linspace(-reach, reach, 4001))
    at = np.unique(np.concatenate([near - 1, near + 1, [-inlet, outlet]]))
    at = at[(at >= -inlet) & (at <= outlet)]
    density = 5 / (1 + at**4) + sum(w / np.hypot(at - end, r * edge) for end, w, r in _ENDS)
    count = np.append(0, np.cumsum(np.diff(at) * (density[1:] + density[:-1]) / 2))
    count, kept = np.unique(count, return_index=True)  # rounding may make samples coincide
    at = at[kept]
    faces = PchipInterpolator(count, at)(np.linspace(0, count[-1], cells + 1))
    faces[[0, -1]] = -inlet, outlet
    faces *= size
    x, width = (faces[1:] + faces[:-1]) / 2, np.diff(faces)
    weight, kernel = curved_weights(x, width), curved_kernel(x, width)
    if layer is not None:
        kernel += line_layer_kernel(x, width, layer)
    stiffness = inv(kernel)
    elastic = np.column_stack([stiffness, -stiffness.sum(axis=1)])
    between = between_middles(x, width)
    mesh = Mesh(x, width, weight, between, kernel, elastic, weight @ elastic)
    for part in (*mesh[:3], *between, *mesh[4:]):
        part.flags.writeable = False
    return mesh
