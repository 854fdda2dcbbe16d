"""Removal of form (tilt, circle, polynomial) from scans."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, Cure, nearest, shown
from tribolab.core.provenance import history_line
from tribolab.surface.gaps import bridge_gaps
from tribolab.surface.level import rounding_only
from tribolab.units.stamping import stamp

# polynomial order equivalent to each form, i.e. number of longest waves that it removes
_FORMS = {"mean": 0, "tilt": 1, "circle": 2, "polynomial": None}
_STEPS = 60
_NO_CIRCLE = Cure(
    notebook="check the units of the heights and of x, or take form='polynomial'",
    terminal="check the units of the heights and of x",
    campaign='check the units of the heights and of x, or say form = "polynomial" in [roughness]',
)
_CHUNK = 1 << 20  # heights processed at a time


def fill_dropouts(scans: xr.Dataset) -> xr.Dataset:
    """Return scans with dropouts (NaN) filled by interpolation and marked.

    Parameters
    ----------
    scans
        Profiles, ``height`` [m] (..., x), filled by straight lines; at the ends the nearest height
        is repeated. Maps (..., y, x) are filled from four sides, see
        `tribolab.surface.gaps.bridge_gaps`.

    Returns
    -------
    xarray.Dataset
        The scans without NaN; if there were any, ``dropout`` (1 where a height was filled).
        Attributes ``dropouts`` (their number) and ``dropout_share``.

    Raises
    ------
    AnalysisError
        If a profile or map has fewer than two heights.

    Examples
    --------
    >>> scans = xr.Dataset({"height": ("x", [0.0, np.nan, 2e-6])}, {"x": [0.0, 1e-6, 2e-6]})
    >>> filled = fill_dropouts(scans)
    >>> filled.height.values.tolist(), filled.attrs["dropouts"]
    ([0.0, 1e-06, 2e-06], 1)
    """
    axes = [d for d in ("y", "x") if d in scans.height.dims]
    dims = [str(d) for d in scans.height.dims if d not in axes] + axes
    height = scans.height.transpose(*dims)
    missing = ~np.isfinite(height)
    number = int(missing.sum())
    result = scans.assign_attrs(dropouts=number, dropout_share=number / missing.size)
    if number == 0:
        return result
    present = int((~missing).sum(axes).min())
    if present < 2:
        raise AnalysisError(
            f"a scan has {present} heights that are numbers, two are the least; "
            "leave that scan out",
            function="fill_dropouts",
        )
    values = bridge_gaps(height.values, missing.values, is_map="y" in dims)
    filled = height.copy(data=values)
    return stamp(result.assign(height=filled, dropout=missing.astype("int8")))


def remove_form(scans: xr.Dataset, form: str = "circle", *, degree: int = 2) -> xr.Dataset:
    """Return scans without their form (tilt, circle, polynomial), which is added as variables.

    Parameters
    ----------
    scans
        Profiles: ``height`` [m] (..., x). Maps: ``height`` (..., y, x), from which ``"tilt"``
        removes a plane and ``"polynomial"`` a polynomial of both coordinates.
    form
        ``"mean"``, ``"tilt"``, ``"circle"`` (which includes tilt: a tilted circle is a circle) or
        ``"polynomial"``.
    degree
        Degree of the polynomial.

    Returns
    -------
    xarray.Dataset
        The scans without form (exactly zero where only rounding remains) and the form of each scan:
        ``form_tilt`` [1] and ``form_curvature`` [1/m] at the middle of the scan (positive: hollow).
        Dropouts are unchanged and not used in the fit. Attributes ``form_removed``, ``form_order``,
        ``form_radius_m`` (mean radius, for a circle).

    Raises
    ------
    AnalysisError
        If the form is unknown, or a profile has too few points for it.

    Notes
    -----
    The circle of curvature c through (0, z0) with sin(tilt) = s:
    ``z = z0 + x (2 s + c x) / (sqrt(1 - s^2) + sqrt(1 - (s + c x)^2))``, which is a straight line
    for c = 0 and not a parabola otherwise: 25 mm along a cylinder of 7 cm differ from one by 9 um.
    It is fitted by Gauss-Newton steps with the Jacobian of the parabola, all scans at a time.

    Examples
    --------
    >>> x = np.linspace(-5e-3, 5e-3, 201)
    >>> roller = xr.Dataset({"height": ("x", np.sqrt(0.07**2 - x**2))}, {"x": x})
    >>> flat = remove_form(roller, "circle")
    >>> round(flat.attrs["form_radius_m"], 9), bool(abs(flat.height).max() < 1e-12)
    (0.07, True)
    """
    if form not in _FORMS:
        raise AnalysisError(
            f"there is no form '{shown(form)}'{nearest(form, _FORMS)}", function="remove_form"
        )
    if not 0 <= degree <= 12:
        raise AnalysisError(
            f"a degree from 0 to 12 is wanted, got {degree}", function="remove_form"
        )
    order = _FORMS[form]
    order = degree if order is None else order
    attrs: dict[str, str | float] = {"form_removed": form, "form_order": order}
    if "y" in scans.height.dims:
        if form == "circle":
            raise AnalysisError(
                "a map has no circle",
                function="remove_form",
                cure=Cure(
                    notebook="take 'polynomial', degree=2",
                    campaign='say form = "polynomial" in [roughness]',
                ),
            )
        return stamp(_flatten_map(scans, order), **attrs)
    height = scans.height.transpose(..., "x")
    points = height.sizes["x"]
    if points < order + 2:
        raise AnalysisError(
            f"{points} points are too few to take away a {form} of order {order}",
            function="remove_form",
        )
    x = scans.x.values - scans.x.values.mean()
    scale = max(float(np.abs(x).max()), 1e-300)
    basis = np.polynomial.legendre.legvander(x / scale, order)
    rows = height.values.reshape(-1, points)
    residual = np.empty(rows.shape)
    taken = np.empty((len(rows), 2))
    step = max(1, _CHUNK // points)
    for first in range(0, len(rows), step):
        part = slice(first, first + step)
        fit = _circle if form == "circle" else _polynomial
        left, taken[part] = fit(rows[part], x, scale, basis)
        residual[part] = _remove_rounding(left, rows[part])
    dims, shape = height.dims[:-1], height.shape[:-1]
    result = scans.assign(
        height=height.copy(data=residual.reshape(height.shape)),
        form_tilt=(dims, taken[:, 0].reshape(shape)),
        form_curvature=(dims, taken[:, 1].reshape(shape)),
    )
    if form == "circle":
        curvature = float(np.mean(np.abs(taken[:, 1])))
        attrs["form_radius_m"] = 1 / curvature if curvature > 0 else float("inf")
    attrs["history"] = _extended_history(
        scans, f"removed the {form} (order {order}) from {len(rows)} scans"
    )
    return stamp(result, **attrs)


def removed_order(scans: xr.Dataset) -> int:
    """Return the polynomial order of the removed form; 0 if only the mean was removed."""
    return int(scans.attrs.get("form_order", 0))


def _extended_history(scans: xr.Dataset, action: str) -> str:
    return "\n".join([*filter(None, [scans.attrs.get("history", "")]), history_line(action)])


def _remove_rounding(left: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return heights, set to zero where only rounding errors remain after form removal."""
    level = rounding_only(left, rows)[:, None]
    return np.where(level & np.isfinite(left), 0.0, left) if level.any() else left


def _least_squares(rows: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Return least-squares coefficients of a polynomial basis (row, term), ignoring NaN."""
    if np.isfinite(rows).all():
        # the normal equations of Legendre polynomials are well conditioned
        return np.linalg.solve(basis.T @ basis, (rows @ basis).T).T
    present = np.isfinite(rows)
    if present.sum(1).min() < basis.shape[1] + 1:
        raise AnalysisError(
            f"a profile has {present.sum(1).min()} heights that are numbers, too few "
            "for the form; leave that scan out",
            function="remove_form",
        )
    weight = present.astype(float)
    normal = np.einsum("rx,xi,xj->rij", weight, basis, basis, optimize=True)
    right = np.where(present, rows, 0.0) @ basis
    return np.linalg.solve(normal, right[..., None])[..., 0]


def _polynomial(
    rows: np.ndarray, x: np.ndarray, scale: float, basis: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    fitted = _least_squares(rows, basis)
    derivative = np.polynomial.legendre.legder
    terms = fitted.T
    tilt = np.polynomial.legendre.legval(0.0, derivative(terms)) / scale
    bend = np.polynomial.legendre.legval(0.0, derivative(terms, 2)) / scale**2
    both = [np.broadcast_to(tilt, len(rows)), np.broadcast_to(bend, len(rows))]
    return rows - fitted @ basis.T, np.stack(both, axis=-1)


def _circle(
    rows: np.ndarray, x: np.ndarray, scale: float, basis: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    # coefficients of Legendre polynomials for z0 + s x + c x^2 / 2
    to_circle = np.array([[1, 0, -0.5], [0, 1 / scale, 0], [0, 0, 3 / scale**2]])
    known = _least_squares(rows, basis) @ to_circle.T
    known[:, 1] /= np.hypot(1, known[:, 1])
    for _ in range(_STEPS):
        offset, sine, curvature = known.T[..., None]
        end = sine + curvature * x
        if np.abs(end).max() >= 1:
            raise AnalysisError(
                "no circle fits; its radius would be smaller than half the scan",
                function="remove_form",
                cure=_NO_CIRCLE,
            )
        arc = x * (2 * sine + curvature * x) / (np.sqrt(1 - sine**2) + np.sqrt(1 - end**2))
        residual = rows - offset - arc
        step = _least_squares(residual, basis) @ to_circle.T
        known = known + step
        if (np.abs(step) @ [1, scale, scale**2] <= 1e-11 * scale).all():
            break
    else:
        raise AnalysisError(
            "the fit of a circle does not settle; its radius is hardly larger than "
            "the scan is long",
            function="remove_form",
            cure=_NO_CIRCLE,
        )
    tilt = known[:, 1] / np.sqrt(1 - known[:, 1] ** 2)
    return residual, np.stack([tilt, known[:, 2]], axis=-1)


def _flatten_map(scans: xr.Dataset, order: int) -> xr.Dataset:
    height = scans.height.transpose(..., "y", "x")
    vander = np.polynomial.legendre.legvander
    along_x, along_y = (
        vander((c - c.mean()) / max(np.ptp(c) / 2, 1e-300), order)
        for c in (scans.x.values, scans.y.values)
    )
    maps = height.values.reshape(-1, *height.shape[-2:])
    flat = np.empty(maps.shape)
    for heights, left in zip(maps, flat, strict=True):
        np.matmul(along_y, _map_coefficients(heights, along_y, along_x) @ along_x.T, out=left)
        np.subtract(heights, left, out=left)
        if rounding_only(left.reshape(1, -1), heights.reshape(1, -1))[0]:
            left[np.isfinite(left)] = 0.0
    which = "the map" if len(maps) == 1 else f"{len(maps)} maps"
    history = _extended_history(scans, f"removed a polynomial of order {order} from {which}")
    result = scans.assign(height=height.copy(data=flat.reshape(height.shape)))
    return result.assign_attrs(history=history)


def _map_coefficients(heights: np.ndarray, along_y: np.ndarray, along_x: np.ndarray) -> np.ndarray:
    """Return the Legendre coefficients (y term, x term) of a map, fitted up to a total degree.

    The sums over a map of products of polynomials are sums over y of sums over x, so that no basis
    as large as the map is needed; missing heights (NaN) have no weight.
    """
    terms = along_x.shape[1]
    i, j = np.nonzero(np.add.outer(np.arange(terms), np.arange(terms)) < terms)
    present = np.isfinite(heights)
    if present.all():
        over_y, over_x = along_y.T @ along_y, along_x.T @ along_x
        normal = over_y[np.ix_(i, i)] * over_x[np.ix_(j, j)]
    else:
        if (number := int(present.sum())) < i.size + 1:
            raise AnalysisError(
                f"a map has {number} heights that are numbers, too few for the form; leave that "
                "map out",
                function="remove_form",
            )
        pairs_y, pairs_x = (
            (v[:, :, None] * v[:, None, :]).reshape(len(v), -1) for v in (along_y, along_x)
        )
        sums = (pairs_y.T @ (present.astype(float) @ pairs_x)).reshape((terms,) * 4)
        normal = sums[i[:, None], i, j[:, None], j]
        heights = np.where(present, heights, 0.0)
    coefficients = np.zeros((terms, terms))
    coefficients[i, j] = np.linalg.solve(normal, (along_y.T @ (heights @ along_x))[i, j])
    return coefficients
