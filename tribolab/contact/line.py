"""Dry contact of a rough cylinder at rest on a flat: pressure and separation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg import lu_factor, lu_solve

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_half_width, hertz_pressure
from tribolab.contact.layer import line_layer_kernel
from tribolab.contact.limits import line_limits
from tribolab.contact.persson import contact_area_ratio
from tribolab.contact.separation import Separation, separation_table
from tribolab.core.errors import AnalysisError, Cure
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp

# Xu et al. (2026) do not define the contact width: this pressure, relative to the maximum,
# reproduces both widths that they print.
WIDTH_LEVEL = 1e-3
_STEPS = 100
_CONVERGED = 1e-10  # change in the last step, relative to the maximum pressure
_FLAT = 1e-6  # ratio of mean separation to h_rms, below which contact is complete


@over_dims(psd=("wavenumber",))
def rough_line_contact(
    load: str | float,
    contact: LineContact,
    psd: xr.Dataset,
    gamma: float = 0.45,
    points: int = 401,
    area: AreaTheory = "persson",
) -> xr.Dataset:
    """Return the pressure and mean separation across a dry, rough line contact at rest.

    Parameters
    ----------
    load
        F_N/L [N/m], above zero.
    contact
        Geometry and elasticity.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    gamma
        Elastic-energy reduction factor [1] of the mean separation.
    points
        Cells across the domain; odd, so that one is in the middle.
    area
        Theory of the contact area, see `contact_area_ratio`.

    Returns
    -------
    xarray.Dataset
        Over ``x`` [m]: ``pressure`` [Pa], ``separation`` [m], ``contact_area_ratio`` [1]; and the
        scalars ``max_pressure`` [Pa], ``central_separation`` [m] and ``contact_width`` [m], the
        distance between the points where pressure is 1e-3 of its maximum (a definition inferred
        from the widths in [1]_). Attributes: ``residual`` (of p - p(u),
        in units of the maximum pressure), ``load_balance`` (relative) and ``steps``.

    Raises
    ------
    AnalysisError
        If the load is not positive, the surface has no roughness or is flattened (use
        `hertz_pressure`), there are fewer than 21 points, or the iteration does not converge.

    Notes ----- Eqs. (9) and (10) of [1]_ with p = p_cont(u): ``u = c + x^2/(2R) + K p``. The kernel
    is integrated exactly over each cell, with lengths in units of the domain's width; the constant
    c includes the choice of that unit. The energy ``p K p / 2 + int_u^inf p_cont du`` is convex in
    (u, c), so Newton's method with a line search on its directional derivative converges to the
    unique solution.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q = np.array([423.0, 9e4, 3e9])
    >>> psd = xr.Dataset(
    ...     {"psd_2d": ("wavenumber", [1.63e-22, 1.63e-22, 4e-42])}, coords={"wavenumber": q}
    ... )
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> rough = rough_line_contact("310 N/m", contact, psd)
    >>> f"{1e-6 * rough.max_pressure:.4f} MPa"
    '0.0527 MPa'
    """
    force = positive(load, "N/m", "load")
    if points < 21 or points % 2 == 0:
        raise AnalysisError(f"points: an odd number of at least 21 is wanted; got {points}")
    table = separation_table(psd, contact.effective_modulus, gamma)
    x, pressure, separation, steps, residual = solve_line(force, contact, table, points)
    width = contact_width(x, pressure)
    profile = xr.Dataset(
        {
            "pressure": ("x", pressure),
            "separation": ("x", separation),
            "contact_area_ratio": (
                "x",
                contact_area_ratio(pressure, psd, contact.effective_modulus, area),
            ),
            "max_pressure": pressure.max(),
            "central_separation": separation[points // 2],
            "contact_width": width,
        },
        coords={"x": x, "load": force},
    )
    balance = pressure.sum() * (x[1] - x[0]) / force - 1
    return stamp(
        profile,
        **line_limits("rough_line_contact", contact, force, psd, table),
        residual=residual,
        load_balance=float(balance),
        steps=steps,
        area=area,
        contact_width_definition=f"pressure above {WIDTH_LEVEL:g} of its maximum (inferred)",
    )


class LineProfile(NamedTuple):
    """Pressure and mean separation in the cells of a dry line contact, with convergence data."""

    x: np.ndarray  # centres of the cells [m] (n)
    pressure: np.ndarray  # [Pa] (n)
    separation: np.ndarray  # mean separation [m] (n)
    steps: int
    residual: float  # largest error of p = p(u), in units of the maximum pressure


def solve_line(force: float, contact: LineContact, table: Separation, points: int) -> LineProfile:
    """Return pressure and separation of a dry line contact at a load [N/m], from its table p(u)."""
    x = _cells(force, contact, table.decay_length, points)
    width = np.full(points, x[1] - x[0])
    kernel = line_kernel(x, width, contact.effective_modulus)
    layer = contact.layer(1.0)
    if layer is not None:
        kernel += line_layer_kernel(x, width, layer) / contact.effective_modulus
    hertz = hertz_pressure(x, force, contact)
    gap = x**2 / (2 * contact.radius)
    return LineProfile(x, *solve_dry(gap, width, hertz, force, table, kernel))


def line_kernel(x: np.ndarray, width: np.ndarray, effective_modulus: float) -> np.ndarray:
    """Return the displacement [m/Pa] at x_i by unit pressure in cell j, the log kernel of Eq. (9).

    Parameters
    ----------
    x, width
        Centres and widths of the cells [m] (n).
    effective_modulus
        E* [Pa].

    Returns
    -------
    numpy.ndarray
        ``-(2/(pi E*)) int_cell ln(|x_i - x'| / l) dx'`` (n, n), l being the width of the domain, so
        that all elements are positive; another l only shifts the constant of Eq. (9).
    """
    scale = x[-1] - x[0] + width.mean()

    def antiderivative(t: np.ndarray) -> np.ndarray:
        safe = np.where(t == 0, 1.0, np.abs(t))
        return t * (np.log(safe / scale) - 1)

    left, right = x - width / 2, x + width / 2
    rise = antiderivative(right - x[:, None]) - antiderivative(left - x[:, None])
    return -2 / (np.pi * effective_modulus) * rise


def contact_width(x: np.ndarray, pressure: np.ndarray, level: float = WIDTH_LEVEL) -> float:
    """Return the width [m] between the outermost points at `level` times the maximum pressure.

    ln p is interpolated linearly between cells.
    """
    with np.errstate(divide="ignore"):
        logs = np.log(pressure / (level * pressure.max()))
    inside = np.flatnonzero(logs >= 0)
    first, last = inside[0], inside[-1]
    if first == 0 or last == x.size - 1:
        raise AnalysisError(
            f"contact_width: pressure is above {level:g} of its maximum at the edge of the domain"
        )
    ends = []
    for i, j in ((first, first - 1), (last, last + 1)):
        part = 0.5 if np.isinf(logs[j]) else logs[i] / (logs[i] - logs[j])
        ends.append(x[i] + part * (x[j] - x[i]))
    return float(ends[1] - ends[0])


def _cells(force: float, contact: LineContact, decay_length: float, points: int) -> np.ndarray:
    """Return the centres of equal cells, up to where the pressure is 1e-12 of its maximum.

    Outside the Hertz contact u increases faster than (x^2 - a^2)/2R, and p falls as exp(-u/u0), so
    that x^2 = a^2 + 2 R u0 ln(1e12) is sufficient.
    """
    a2 = hertz_half_width(force, contact) ** 2
    end = np.sqrt(max(a2 + 2 * contact.radius * decay_length * np.log(1e12), 1.44 * a2))
    cell = 2 * end / points
    return cell * (np.arange(points) - points // 2)


def solve_dry(
    gap: np.ndarray,
    weight: np.ndarray,
    hertz: np.ndarray,
    force: float,
    table: Separation,
    kernel: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, int, float]:
    """Return pressure, separation, steps and residual of p = p_cont(c + gap + K p) at a load.

    Parameters
    ----------
    gap, weight, hertz
        Gap of the undeformed bodies [m], areas (lengths for a line), and starting pressure [Pa],
        all over the cells.
    """
    p = hertz
    if table.separation(float(p.max())) < _FLAT * table.rms_roughness:
        raise AnalysisError(
            f"load: at {force:g} the roughness is pressed flat, u is below {_FLAT:g} h_rms at "
            f"the Hertz pressure of {p.max():.4g} Pa",
            cure=Cure(notebook="use hertz_pressure"),
        )
    p = p * (force / (p @ weight))
    shape = gap + kernel @ p
    c = table.separation(float(p.max()) / 2) - shape.min()
    for step in range(1, _STEPS + 1):
        target, slope = table.pressure_and_slope(c + shape)
        factor = lu_factor(np.eye(p.size) - slope[:, None] * kernel)
        both = lu_solve(factor, np.stack([target - p, slope], axis=1))
        # Newton's step dc of c: the load of a + b dc in the cells equals the missing load
        dc = ((force - weight @ p) - weight @ both[:, 0]) / (weight @ both[:, 1])
        dp = both[:, 0] + both[:, 1] * dc
        t = _line_search(p, c + shape, dp, dc + kernel @ dp, weight, table)
        p, c = p + t * dp, c + t * dc
        shape = gap + kernel @ p
        if np.max(np.abs(dp)) < _CONVERGED * p.max():
            u = c + shape
            carried = table.pressure(u)
            return carried, u, step, float(np.max(np.abs(p - carried)) / carried.max())
    raise AnalysisError(
        f"no convergence in {_STEPS} steps at a load of {force:g}; "
        f"the last changed the pressure by {np.max(np.abs(dp)) / p.max():.1e} of its maximum",
        function="rough_line_contact",
    )


def _line_search(
    p: np.ndarray,
    u: np.ndarray,
    dp: np.ndarray,
    du: np.ndarray,
    weight: np.ndarray,
    table: Separation,
) -> float:
    """Return the length, at most 1, of the Newton step that brings the energy nearest its minimum.

    The energy's derivative along the step is ``sum (p - p_cont(u)) du``; it is negative at the
    start and increases monotonically, so a few secant steps within a bracket find its zero.
    """
    falling = du < 0
    limit = 0.99 * np.min(-u[falling] / du[falling]) if falling.any() else np.inf

    def derivative(t: float) -> float:
        return float((p + t * dp - table.pressure_and_slope(u + t * du)[0]) * du @ weight)

    start, t = derivative(0.0), min(1.0, limit)
    low, low_value = 0.0, start
    value = derivative(t)
    if value <= 0.1 * abs(start):
        return t
    high, high_value = t, value
    for _ in range(40):
        t = low - low_value * (high - low) / (high_value - low_value)
        t = min(max(t, low + 0.1 * (high - low)), high - 0.1 * (high - low))
        value = derivative(t)
        if abs(value) <= 0.1 * abs(start):
            break
        if value > 0:
            high, high_value = t, value
        else:
            low, low_value = t, value
    return t
