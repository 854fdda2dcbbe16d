"""Mesh of rings and sectors for a round contact, with its elastic displacement."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from tribolab.contact.layer import Layer, round_layer_kernel

_CHORDS = 4  # number of chords that replace the arc of a cell
# Density of rings: at the contact's edge, inside it, and far away (equal steps of ln r)
_EDGE, _INSIDE, _FAR = 2.5, 6.0, 2.0


class PolarMesh(NamedTuple):
    """Rings and equal sectors in the half plane y > 0, in units of the contact radius.

    The index of a cell is ring * sectors + sector; the flow is towards +x, angle 0.
    """

    faces: np.ndarray  # boundaries of the rings (rings + 1)
    radius: np.ndarray  # middle radius of each ring (rings)
    sectors: int
    area: np.ndarray  # area of each cell (rings * sectors)
    x: np.ndarray  # x at the centres of the cells (rings * sectors)
    squared: np.ndarray  # r^2 at the centres (rings * sectors)
    kernel: np.ndarray  # displacement of a cell by unit pressure in another, E* = 1 (cells, cells)
    rings: np.ndarray  # displacement of rings by unit pressure in a ring (rings, rings)


@functools.lru_cache(maxsize=6)
def polar_mesh(
    rings: int, sectors: int, edge: float, end: float, size: float = 1.0, layer: Layer | None = None
) -> PolarMesh:
    """Return rings refined at the edge of the contact, and their elastic displacements.

    Parameters
    ----------
    rings, sectors
        Number of rings, and of sectors of the half plane.
    edge
        Length over which the film rises at the contact's edge, in contact radii.
    end
        Radius at which the liquid ends.
    size
        Radius of the resolved region: more than 1 for a thick film.
    layer
        An elastic layer on a rigid base, its thickness in contact radii.
    """
    at = np.unique(np.concatenate([
        np.linspace(0, 3, 3001),
        1 + edge * np.sinh(np.linspace(-np.arcsinh(1 / edge), np.arcsinh(2 / edge), 3001)),
        np.geomspace(0.1, max(end / size, 4.0), 1001),
    ]))  # fmt: skip
    at = at[(at >= 0) & (at <= end / size)]
    density = _EDGE / (np.abs(at - 1) + edge) + _INSIDE / (1 + at**4) + _FAR / (at + 0.3)
    count = np.append(0, np.cumsum(np.diff(at) * (density[1:] + density[:-1]) / 2))
    count, kept = np.unique(count, return_index=True)  # rounding may make samples coincide
    faces = size * PchipInterpolator(count, at[kept])(np.linspace(0, count[-1], rings + 1))
    faces[[0, -1]] = 0.0, end
    radius = (faces[1:] + faces[:-1]) / 2
    angle = np.pi / sectors
    around = kernel_around(radius, faces, sectors, layer)
    j, m = np.arange(sectors)[:, None], np.arange(sectors)
    # add the displacement by the mirror image of a sector in the other half plane
    folded = (
        around[:, :, np.abs(j - m)] + around[:, :, np.minimum(j + m + 1, 2 * sectors - j - m - 1)]
    )
    kernel = folded.transpose(0, 2, 1, 3).reshape(rings * sectors, -1)
    cosine = np.cos(angle * (np.arange(sectors) + 0.5))
    mesh = PolarMesh(
        faces, radius, sectors,
        np.repeat(angle * np.diff(faces**2) / 2, sectors),
        (radius[:, None] * cosine).ravel(),
        np.repeat(radius**2, sectors),
        np.ascontiguousarray(kernel),
        folded[:, :, 0].sum(axis=-1),
    )  # fmt: skip
    for part in (mesh.kernel, mesh.rings, mesh.area):
        part.flags.writeable = False
    return mesh


def kernel_around(
    radius: np.ndarray, faces: np.ndarray, sectors: int, layer: Layer | None = None
) -> np.ndarray:
    """Return the displacement at (radius, 0) by unit pressure in each cell around, for E* = 1.

    Returns
    -------
    numpy.ndarray
        (ring of the point, ring of the cell, sectors between them, 0 ... `sectors`)

    Notes
    -----
    The potential of a polygon is ``sum_edges d [asinh(s2/|d|) - asinh(s1/|d|)]``, d being the
    distance from the point to the edge's line and s the position along it. An arc is approximated
    by `_CHORDS` chords; a factor corrects their area.
    """
    delta = np.pi / sectors / _CHORDS
    r, rho = radius[:, None, None], faces[:, None]
    middle = delta * (np.arange(-_CHORDS // 2, (sectors + 1) * _CHORDS - _CHORDS // 2) + 0.5)
    half = rho * np.sin(delta / 2)
    along = r * np.sin(middle)
    chord = _edge(rho * np.cos(delta / 2) - r * np.cos(middle), along - half, along + half)
    arcs = chord.reshape(*chord.shape[:2], sectors + 1, _CHORDS).sum(axis=-1)
    side = np.pi / sectors * (np.arange(sectors + 2) - 0.5)
    foot = r * np.cos(side)
    radial = _edge(r * np.sin(side), foot - rho[1:], foot - rho[:-1])
    potential = np.diff(arcs, axis=1) + np.diff(radial, axis=2)
    kernel = potential * delta / np.sin(delta) / np.pi
    if layer is not None:
        kernel = kernel - round_layer_kernel(radius, faces, sectors, layer)
    return kernel


def _edge(distance: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.abs(distance)
        part = distance * (np.arcsinh(end / size) - np.arcsinh(start / size))
    return np.where(size < 1e-14, 0.0, part)
