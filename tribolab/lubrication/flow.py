"""Flow between the centres of neighbouring cells, from the film thickness between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.lubrication.factors import FlowFactors
from tribolab.lubrication.parabolas import Between
from tribolab.lubrication.thinning import ThinnedFactors

# Share of the smooth conductance u^3 that is kept below percolation, so that fluid enclosed by
# closed channels has a pressure; its flow is negligible.
_LEAK = 1e-10
# Film thickness divided by h_rms. Below the first value, interpolation between cells is linear,
# because flow changes by decades where channels close; above the second, by a cubic.
_STRAIGHT, _CURVED = 0.3, 0.6


class Flow(NamedTuple):
    """Flow resistance and entrainment at the points of `Between`, and between cell centres.

    Lengths along x in b, gaps in g, pressures in p; a flux is in units of g^3 p/(12 eta b). The
    gradient of the fluid pressure is ``resistance * (entrained - flux)`` at every point: for a flux
    J the pressure rises by ``(drive - J) / conductance`` from centre to centre.
    """

    film: np.ndarray  # film thickness at the points (2, n + 1)
    share: np.ndarray  # weights of the four surrounding cells in the film (2, 4, n + 1)
    resistance: np.ndarray  # 1/(u^3 phi_p) at the points (2, n + 1)
    entrained: np.ndarray  # entrained flux at the points (2, n + 1)
    conductance: np.ndarray  # conductance from centre to centre (n + 1)
    drive: np.ndarray  # mean entrained flux, weighted by the resistance (n + 1)
    resistance_slope: np.ndarray  # derivative by the film (2, n + 1)
    entrained_slope: np.ndarray  # derivative by the film (2, n + 1)


def flow_between(
    between: Between,
    factors: FlowFactors | ThinnedFactors,
    gap: float,
    couette: float,
    film: np.ndarray,
) -> Flow:
    """Return flow resistance and entrainment, integrated between the centres of cells.

    Notes
    -----
    Integrating dp/dx from centre to centre with two Gauss points is of fourth order in the cell
    width; with the mean of the two films instead it would be of second order.
    """
    u, share = _film_between(between, film, factors.rms_roughness / gap)
    phi, phi_slope, entrained, entrained_slope = factors.transport(u * gap)
    phi = phi + _LEAK
    resistance = 1 / (u * u * u * phi)
    entrained = entrained * (couette / gap)
    conductance = 1 / (between.weight * (resistance[0] + resistance[1]))
    weighted = resistance * entrained
    return Flow(
        film=u,
        share=share,
        resistance=resistance,
        entrained=entrained,
        conductance=conductance,
        drive=conductance * between.weight * (weighted[0] + weighted[1]),
        resistance_slope=-resistance * (3 / u + phi_slope * gap / phi),
        entrained_slope=couette * entrained_slope,
    )


def flux_slopes(between: Between, flow: Flow, flux: np.ndarray) -> np.ndarray:
    """Return the derivatives of the flux between centres by the films of four cells (4, n + 1)."""
    steep = flow.resistance * flow.entrained_slope
    steep += (flow.entrained - flux) * flow.resistance_slope
    steep *= between.weight * flow.conductance
    return np.asarray((steep[:, None] * flow.share).sum(axis=0))


def _film_between(
    between: Between, film: np.ndarray, roughness: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the film thickness at the points, and its derivatives by the films of four cells."""
    around = film[between.cell]
    u, share = (between.share * around).sum(axis=1), between.share
    thinner = np.minimum(around[1], around[2])
    if thinner.min() >= _CURVED * roughness:
        return u, share
    span = (_CURVED - _STRAIGHT) * roughness
    part = np.clip((thinner - _STRAIGHT * roughness) / span, 0.0, 1.0)
    line = between.straight[:, 1] * around[1] + between.straight[:, 2] * around[2]
    bent = u - line
    share = between.straight + part * (share - between.straight)
    moving = np.where((part > 0) & (part < 1), bent / span, 0.0)  # part varies with the film
    first = around[1] < around[2]
    share[:, 1] += np.where(first, moving, 0.0)
    share[:, 2] += np.where(first, 0.0, moving)
    return line + part * bent, share
