"""How much of the gap is solved at a speed, and the drag of the liquid beyond its ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import hyp2f1

from tribolab.lubrication.mixed import Problem, Solution

_INLET, _OUTLET = 60.0, 5.0  # ends of the domain, in reaches of the film
_CLASS = 100.0  # films within this factor share a mesh
SHORTEST = 1.5  # half-widths from the middle to where the liquid may begin


class Layout(NamedTuple):
    """All but the cells that the mesh of a speed hangs on, as `graded_mesh` takes it."""

    edge: float
    inlet: float
    outlet: float
    size: float


def layout(film: float, decay: float, domain: float, inlet_length: float) -> Layout:
    """Choose the mesh for the film of one speed alone, whatever other speeds are asked for.

    Parameters
    ----------
    film
        Expected film thickness over the gap g = b^2/(2R).
    decay
        Length over which the contact pressure decays with the film, over g.
    domain
        Length of the domain over the default.
    inlet_length
        Where the liquid begins, in units of b; infinite if it is everywhere.

    Notes
    -----
    A film h reaches as far as it widens the contact, b sqrt(1 + h/g). The domain goes 60 of these
    before the middle and 5 behind, for the thickest film of a class: films of one class, a factor
    of 100, share a mesh, so that a curve takes few of them. Beyond, `outside_drag` goes on.
    """
    lowest = _CLASS ** np.floor(np.log(max(film, 1e-30)) / np.log(_CLASS))
    reach = np.sqrt(1 + max(lowest * _CLASS, 1.0)) * domain
    size = float(np.sqrt(max(lowest, 1.0)))
    # outside a Hertz contact the gap grows as 1.9 g (x/a - 1)^1.5
    edge = (max(decay, lowest) / 1.9) ** (2 / 3)
    open_end = np.isinf(inlet_length)
    return Layout(
        _rounded(np.clip(edge, 3e-4, 0.5)),
        _rounded(_INLET * reach) if open_end else float(inlet_length),
        _rounded(_OUTLET * reach),
        size,
    )


def outside_drag(problem: Problem, solution: Solution) -> tuple[float, float]:
    """Couette and pressure part of the drag beyond the domain's ends, in units of g p.

    Notes
    -----
    There u = k + x^2, k being constant to the logarithm of the bodies' bending, and the pressure
    falls to 0 far away. With I_n = int_X^inf dx/u^n the inlet adds eta v I_1 by shear and
    eta v (3 I_1 - 3 u* I_2) by the gradient dp/dx = 6 eta v (u - u*)/u^3. In the cavity behind,
    liquid covers u*/u of the flat: eta v u* I_2. The load that the inlet's tail carries,
    4 eta v R^2/X^2, is left out: in the default domain it is under 2e-4 of the whole.
    """
    mesh, film, fields = problem.mesh, solution.state.film, solution.fields
    start, end = mesh.x[0] - mesh.width[0] / 2, mesh.x[-1] + mesh.width[-1] / 2
    full = fields.flux[0] / solution.couette  # u*
    couette = pressure = 0.0
    if np.isinf(problem.inlet_length):
        before = film[0] - mesh.x[0] ** 2
        first, second = (_tail(n, -start, before) for n in (1, 2))
        couette, pressure = first, 3 * (first - full * second)
    if fields.front < film.size:
        couette += full * _tail(2, end, film[-1] - mesh.x[-1] ** 2)
    unit = solution.couette / 6  # eta v b/g^2 in units of p
    return unit * couette, unit * pressure


def _tail(power: int, start: float, constant: float) -> float:
    """int_X^inf dx/(k + x^2)^n: X^(1-2n)/(2n-1) 2F1(n, n - 1/2; n + 1/2; -k/X^2)."""
    n = power
    series = hyp2f1(n, n - 0.5, n + 0.5, -constant / start**2)
    return float(start ** (1 - 2 * n) / (2 * n - 1) * series)


def _rounded(value: float) -> float:
    """Two digits, so that neighbouring loads share a mesh."""
    return float(f"{value:.2g}")
