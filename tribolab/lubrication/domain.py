"""Scales and mesh of a line contact at one speed, and the drag outside the solved domain."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import hyp2f1

from tribolab.contact.geometry import Contact, LineContact
from tribolab.contact.hertz import hertz_half_width
from tribolab.contact.separation import Separation
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.line_solver import Problem, Solution
from tribolab.lubrication.mesh import graded_mesh
from tribolab.lubrication.parameters import Liquid

_INLET, _OUTLET = 60.0, 5.0  # ends of the domain, in units of the reach (see `layout`)
_CLASS_RATIO = 100.0  # films whose thicknesses differ by less than this factor share a mesh
_FINE_EDGE, _EXTRA_CELLS = 5e-3, 0.3  # edge width below which cells are added; share per decade
SHORTEST = 1.5  # least distance from the middle to the start of the liquid, in half-widths


class MeshLayout(NamedTuple):
    """Parameters of `graded_mesh` for one speed, except the number of cells."""

    edge: float
    inlet: float
    outlet: float
    size: float


def layout(
    film: float, decay: float, domain: float, inlet_length: float, flooded: bool = False
) -> MeshLayout:
    """Return the mesh parameters for a film thickness, independently of other speeds.

    Parameters
    ----------
    film
        Expected film thickness, divided by the gap scale g = b^2/(2R).
    decay
        Length over which the contact pressure decays with the film, divided by g.
    domain
        Length of the domain relative to the default.
    inlet_length
        Distance at which the liquid begins, in units of b; infinite if it is everywhere.
    flooded
        Whether there is also liquid at the outlet.

    Notes
    -----
    The reach of a film h is the width of the contact including the film, b sqrt(1 + h/g). The
    domain extends 60 reaches to the inlet and 5 to the outlet (60 if flooded), for the thickest
    film of a class: films within a factor of 100 share a mesh, so that a curve needs few meshes.
    The drag outside the domain is that of `outside_drag`.
    """
    lowest = _CLASS_RATIO ** np.floor(np.log(max(film, 1e-30)) / np.log(_CLASS_RATIO))
    reach = np.sqrt(1 + max(lowest * _CLASS_RATIO, 1.0)) * domain
    size = float(np.sqrt(max(lowest, 1.0)))
    # outside a Hertz contact the gap increases as 1.9 g (x/a - 1)^1.5
    edge = (max(decay, lowest) / 1.9) ** (2 / 3)
    open_end = np.isinf(inlet_length)
    return MeshLayout(
        _rounded(np.clip(edge, 3e-4, 0.5)),
        _rounded(_INLET * reach) if open_end else float(inlet_length),
        _rounded((_INLET if flooded else _OUTLET) * reach),
        size,
    )


def film_estimate(contact: LineContact, viscosity: float, load: float, speed: float) -> float:
    """Return the film thickness [m] of smooth surfaces: the larger of the soft and rigid limit.

    Notes
    -----
    ``3.1 R (eta U/(E' R))^0.6 (F/(L E' R))^-0.2`` and ``4.9 eta U R L/F`` with U = v/2, E' = 2 E*.
    """
    radius, stiff = contact.radius, 2 * contact.effective_modulus
    entrained = viscosity * speed / 2
    soft = (entrained / (stiff * radius)) ** 0.6 * (load / (stiff * radius)) ** -0.2
    return max(3.1 * radius * soft, 4.9 * entrained * radius / load)


def thinned_film(contact: LineContact, liquid: Liquid, load: float, speed: float) -> float:
    """Return the film thickness [m] of smooth surfaces, with shear thinning in the film."""
    film = film_estimate(contact, liquid.viscosity, load, speed)
    if liquid.thinning is None or not speed:
        return film
    for _ in range(30):  # h ~ eta^0.6 and eta ~ h^(1 - n), so the iteration converges
        thin = float(liquid.thinning.pressure_flow(np.array(speed / film)))
        film = film_estimate(contact, liquid.viscosity * thin, load, speed)
    return film


def half_width(contact: Contact, separation: Separation | None, load: float) -> float:
    """Return the half-width b [m] of the contact: that of Hertz, increased by roughness."""
    decay = separation.decay_length if separation else 0.0
    return float(np.sqrt(hertz_half_width(load, contact) ** 2 + 4 * contact.radius * decay))


def lubrication_problem(
    contact: LineContact,
    separation: Separation | None,
    factors: FlowFactors,
    load: float,
    film: float,
    cells: int,
    domain: float,
    liquid: Liquid | None = None,
) -> Problem:
    """Return scales and mesh of a line contact at one load and speed.

    Parameters
    ----------
    contact, separation, factors
        Geometry, contact law (None if smooth) and flow factors.
    load
        F_N/L [N/m].
    film
        `film_estimate` [m] at the speed; 0 at rest.
    cells
        Cells of the mesh; increased if the roughness is small compared with the gap.
    domain
        Length of the domain relative to the default, see `layout`.
    liquid
        Extent, outlet and thinning of the liquid; default: everywhere, vented and Newtonian.

    Raises
    ------
    AnalysisError
        If the liquid begins too close to the contact.
    """
    b = half_width(contact, separation, load)
    decay = separation.decay_length if separation else 0.0
    gap = b**2 / (2 * contact.radius)
    extent = liquid.extent if liquid else None
    inlet_length = np.inf if extent is None else extent
    if not inlet_length > SHORTEST * b:
        raise AnalysisError(
            f"inlet_length: the liquid must begin more than {SHORTEST:g} half-widths before the "
            f"contact's middle, {SHORTEST * b:.3g} m here; got {inlet_length:.3g} m"
        )
    begins = inlet_length / b
    cells = _cell_count(cells, decay / gap)
    lowest = liquid.lowest_pressure if liquid else 0.0
    if liquid and liquid.thinning:  # 60 half-widths suffice; drag beyond is neglected
        domain /= np.sqrt(2)
    spans = layout(film / gap, decay / gap, domain, begins, lowest < 0)
    mesh = graded_mesh(cells, *spans, contact.layer(b))
    pressure = contact.effective_modulus * gap / b
    return Problem(
        mesh, factors, separation, load / (pressure * b), b, gap, pressure, begins,
        lowest / pressure, liquid.thinning if liquid else None,
        liquid.viscosity if liquid else 1.0,
    )  # fmt: skip


def outside_drag(problem: Problem, solution: Solution) -> tuple[float, float]:
    """Return the shear and pressure parts of the drag outside the solved domain, in units of g p.

    Notes
    -----
    In front of the domain, and behind it if flooded, u = k + x^2, with k constant except for the
    logarithm of the elastic displacement, and the pressure falls to 0 far away. With I_n =
    int_X^inf dx/u^n the inlet contributes eta v I_1 by shear and eta v (3 I_1 - 3 u* I_2) by the
    gradient dp/dx = 6 eta v (u - u*)/u^3, u* = 2 J/v. In the outlet cavity, where roughness is
    small compared with the gap, liquid covers u*/u of the flat: eta v u* I_2. The load carried by
    the inlet's tail, 4 eta v R^2/X^2, is neglected: in the default domain it is below 2e-4 of the
    total. For a shear-thinning liquid, whose viscosity increases outwards, the drag outside is
    neglected.
    """
    mesh, film, fields = problem.mesh, solution.state.film, solution.fields
    if problem.thinning:
        return 0.0, 0.0
    start, end = mesh.x[0] - mesh.width[0] / 2, mesh.x[-1] + mesh.width[-1] / 2
    full = fields.flux[0] / solution.couette  # film thickness at maximum pressure, u* = 2 J/v
    couette = pressure = 0.0
    ends = [(-start, film[0] - mesh.x[0] ** 2)] if np.isinf(problem.inlet_length) else []
    if problem.cavity < 0:
        ends.append((end, film[-1] - mesh.x[-1] ** 2))
    for distance, constant in ends:
        first, second = (_tail(n, distance, constant) for n in (1, 2))
        couette, pressure = couette + first, pressure + 3 * (first - full * second)
    if problem.cavity == 0 and fields.front < film.size:
        couette += full * _tail(2, end, film[-1] - mesh.x[-1] ** 2)
    unit = solution.couette / 6  # eta v b/g^2 in units of p
    return unit * couette, unit * pressure


def _tail(power: int, start: float, constant: float) -> float:
    """Return int_X^inf dx/(k + x^2)^n = X^(1-2n)/(2n-1) 2F1(n, n - 1/2; n + 1/2; -k/X^2)."""
    n = power
    series = hyp2f1(n, n - 0.5, n + 0.5, -constant / start**2)
    return float(start ** (1 - 2 * n) / (2 * n - 1) * series)


def _cell_count(cells: int, decay: float) -> int:
    """Return the number of cells that resolves a narrow contact edge as well as usual."""
    if not decay:
        return cells
    edge = (decay / 1.9) ** (2 / 3)
    return round(cells * (1 + _EXTRA_CELLS * max(np.log10(_FINE_EDGE / edge), 0.0)))


def _rounded(value: float) -> float:
    """Return a value rounded to two digits, so that similar loads share one mesh."""
    return float(f"{value:.2g}")
