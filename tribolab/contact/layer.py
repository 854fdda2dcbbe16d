"""Elastic layer on a rigid base: its compliance, and smooth contacts on it."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_HIGHEST = 24.0  # q d above which a layer and a half-space differ by less than 1e-18
_RIGID_BASE_DISTANCE = 12.0  # range of the tabulated kernels, in thicknesses


class Layer(NamedTuple):
    """Elastic layer bonded to a rigid base."""

    thickness: float
    poisson_ratio: float
    share: float = 1.0  # share in the contact's compliance; below 1 if the other body is elastic


def layer_compliance(x: np.ndarray, poisson_ratio: float) -> np.ndarray:
    """Return the compliance W of a bonded layer relative to a half-space, at x = q d (any shape).

    Notes
    -----
    ``W = [k sinh 2x - 2x] / [k cosh 2x + 2x^2 + 5 - 12 nu + 8 nu^2]``, k = 3 - 4 nu [1]_, with the
    wavenumber q and the thickness d.

    References
    ----------
    .. [1] K. L. Johnson, Contact Mechanics (1985), Sec. 5.8.
    """
    k = 3 - 4 * poisson_ratio
    half = np.exp(-2 * x)  # both parts of the fraction are divided by exp(2x)/2
    top = k * -np.expm1(-4 * x) - 4 * x * half
    rest = 2 * x**2 + 5 - 12 * poisson_ratio + 8 * poisson_ratio**2
    return np.asarray(top / (k * (1 + half**2) + 2 * rest * half))


@functools.lru_cache(maxsize=8)
def _nodes(poisson_ratio: float, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes k = q d, and the weights of a quadrature of (1 - W) over k."""
    t, weight = np.polynomial.legendre.leggauss(24)
    panel = np.linspace(0, _HIGHEST, 25)
    k = (panel[:-1, None] + (1 + t) / 2 * np.diff(panel)[:, None]).ravel()
    weight = (weight / 2 * np.diff(panel)[:, None]).ravel()
    return k, share * weight * (1 - layer_compliance(k, poisson_ratio))


@functools.lru_cache(maxsize=8)
def _line_layer(poisson_ratio: float, share: float) -> tuple[CubicSpline, CubicSpline, float]:
    """Return I(s) = int (1 - W)(1 - cos ks)/k dk, its integral, and the limit of I - share ln s."""
    # imported late: scipy loads slowly
    from scipy.interpolate import CubicSpline

    k, weight = _nodes(poisson_ratio, share)
    s = np.linspace(0, _RIGID_BASE_DISTANCE, 1201)
    values = (1 - np.cos(np.outer(s, k))) @ (weight / k)
    slope = np.sin(np.outer(s[[0, -1]], k)) @ weight
    curve = CubicSpline(s, values, bc_type=((1, slope[0]), (1, slope[1])))
    return curve, curve.antiderivative(), float(values[-1] - share * np.log(_RIGID_BASE_DISTANCE))


def line_layer_kernel(x: np.ndarray, width: np.ndarray, layer: Layer) -> np.ndarray:
    """Return how much a rigid base reduces the displacement by a line load, for E* = 1 (n, n).

    ``(2/pi) int_cell I(|x_i - x'|/d) dx'``, to be added to the logarithmic kernel.
    """
    thickness, share = layer.thickness, layer.share
    _, integral, level = _line_layer(layer.poisson_ratio, share)

    def antiderivative(t: np.ndarray) -> np.ndarray:
        size = np.abs(t) / thickness
        far = np.maximum(size, _RIGID_BASE_DISTANCE)
        beyond = far * (share * (np.log(far) - 1) + level)
        beyond -= _RIGID_BASE_DISTANCE * (share * (np.log(_RIGID_BASE_DISTANCE) - 1) + level)
        return np.sign(t) * thickness * (integral(np.minimum(size, _RIGID_BASE_DISTANCE)) + beyond)

    rise = antiderivative(x + width / 2 - x[:, None]) - antiderivative(x - width / 2 - x[:, None])
    return np.asarray(2 / np.pi * rise)


@functools.lru_cache(maxsize=8)
def _round_layer(poisson_ratio: float, share: float) -> CubicSpline:
    """Return G(s) = int (1 - W) J0(ks) dk, which tends to share/s at large s."""
    # imported late: scipy loads slowly
    from scipy.interpolate import CubicSpline
    from scipy.special import j0

    k, weight = _nodes(poisson_ratio, share)
    s = np.linspace(0, _RIGID_BASE_DISTANCE, 1201)
    far = np.array(-share / _RIGID_BASE_DISTANCE**2)
    return CubicSpline(s, j0(np.outer(s, k)) @ weight, bc_type=((1, 0 * far), (1, far)))


def round_layer_kernel(
    radius: np.ndarray, faces: np.ndarray, sectors: int, layer: Layer
) -> np.ndarray:
    """Return how much a rigid base reduces the displacement of `kernel_around`, for E* = 1."""
    thickness = layer.thickness
    curve = _round_layer(layer.poisson_ratio, layer.share)
    t, weight = np.polynomial.legendre.leggauss(3)
    step = np.diff(faces)
    rho = (faces[:-1] + faces[1:])[:, None] / 2 + step[:, None] / 2 * t
    angle = np.pi / sectors * np.arange(sectors + 1)
    total = np.zeros((radius.size, step.size, sectors + 1))
    for part, half in zip(t, weight, strict=True):
        at = np.cos(angle + np.pi / sectors / 2 * part)
        for i in range(t.size):
            ring = rho[:, i, None]
            apart = radius[:, None, None] ** 2 + ring**2 - 2 * radius[:, None, None] * ring * at
            s = np.sqrt(np.maximum(apart, 0)) / thickness
            value = np.where(
                s < _RIGID_BASE_DISTANCE,
                curve(np.minimum(s, _RIGID_BASE_DISTANCE)),
                layer.share / np.maximum(s, _RIGID_BASE_DISTANCE),
            )
            area = weight[i] * step[:, None] / 2 * ring * np.pi / sectors / 2
            total += half * area * value
    return total / (np.pi * thickness)


def line_layer_load(half_width: float, layer: Layer, order: int = 24) -> tuple[float, float]:
    """Return the load and maximum pressure of a smooth line contact on a layer, for R = E* = 1.

    Notes
    -----
    The pressure is ``sum b_n T_2n(t)/sqrt(1 - t^2)`` with sum b_n = 0, for which the logarithmic
    kernel is integrated exactly; the layer's smooth contribution is summed on Chebyshev nodes.
    """
    curve, _, level = _line_layer(layer.poisson_ratio, layer.share)
    many = 4 * order
    node = np.cos(np.pi * (np.arange(many) + 0.5) / many)
    t = np.cos(np.pi * (np.arange(order) + 0.5) / (2 * order))  # half of the nodes, by symmetry
    n = 2 * np.arange(order)
    basis = np.cos(n * np.arccos(node)[:, None])
    log = np.append(np.log(2), 1 / n[1:]) * np.cos(n * np.arccos(t)[:, None])
    s = half_width / layer.thickness * np.abs(t[:, None] - node)
    far = np.maximum(s, _RIGID_BASE_DISTANCE)
    base = np.where(
        s < _RIGID_BASE_DISTANCE,
        curve(np.minimum(s, _RIGID_BASE_DISTANCE)),
        layer.share * np.log(far) + level,
    )
    matrix = np.zeros((order + 1, order + 1))
    matrix[:order, :order] = 2 * half_width * (log + base @ basis / many)
    matrix[:order, order] = 1.0
    matrix[order, :order] = 1.0
    lack = np.append(-(half_width**2) * t**2 / 2, 0.0)
    b = np.linalg.solve(matrix, lack)[:order]
    # pressure in the middle of the contact: sum b_n (T_2n - 1)/sqrt(1 - t^2) at t = 0
    return float(np.pi * half_width * b[0]), float(b @ (-1.0) ** np.arange(order))


def round_layer_load(radius: float, layer: Layer, order: int = 48) -> tuple[float, float]:
    """Return the load and maximum pressure of a smooth round contact on a layer, for R = E* = 1.

    Notes
    -----
    With ``p(r) = -int_r^a phi'(t)/sqrt(t^2 - r^2) dt`` the equation for the layer is
    ``phi(t) - int_0^a k(t, s) phi(s) ds = (delta - t^2)/pi``, phi(a) = 0,
    ``k = (2/pi) int (1 - W(qd)) cos qt cos qs dq``, and the load is 2 pi int phi dt.
    """
    k, weight = _nodes(layer.poisson_ratio, layer.share)
    node, share = np.polynomial.legendre.leggauss(order)
    t = radius * np.append((1 + node) / 2, 1.0)
    share = np.append(radius / 2 * share, 0.0)
    waves = np.cos(np.outer(t, k / layer.thickness))
    matrix = np.eye(order + 1) - (2 / np.pi / layer.thickness) * (waves * weight) @ waves.T * share
    one, square = np.linalg.solve(matrix, np.stack([np.ones(order + 1), t**2], axis=1)).T / np.pi
    depth = square[-1] / one[-1]
    phi = depth * one - square
    # phi is even in t: p(0) = -int phi'/t dt, from a polynomial in t^2 through phi
    poly = np.polynomial.Chebyshev.fit(t**2, phi, 16)
    inner = t[:-1]
    steep = 2 * poly.deriv()(inner**2)  # phi'(t)/t
    return float(2 * np.pi * share @ phi), float(-share[:-1] @ steep)


def layer_contact(
    load: float, layer: Layer, round_contact: bool, widest: float
) -> tuple[float, float]:
    """Return the half-width and maximum pressure of a smooth contact on a layer, for R = E* = 1.

    Parameters
    ----------
    load
        Load over R^2 E* (round) or R E* (line).
    layer
        Layer, with its thickness over R.
    round_contact
        Whether the contact is round; else a line.
    widest
        Half-width on a half-space, over R.
    """
    # imported late: scipy loads slowly
    from scipy.optimize import brentq

    of = round_layer_load if round_contact else line_layer_load
    order = int(np.clip(8 * widest / layer.thickness, 24, 120))

    def lacking(log_a: float) -> float:
        return float(np.log(of(float(np.exp(log_a)), layer, order)[0] / load))

    low, high = np.log(widest / 20), np.log(widest * (1 + 1e-9))
    half_width = float(np.exp(brentq(lacking, low, high, xtol=1e-12)))
    return half_width, of(half_width, layer, order)[1]
