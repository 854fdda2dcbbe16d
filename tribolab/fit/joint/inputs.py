"""Input of a joint fit: measured curves by surface and load, each with its computed response."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tribolab.contact.geometry import Contact
from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError, Cure, shown
from tribolab.core.untyped import Arguments
from tribolab.core.wording import number
from tribolab.fit.joint.load_curve import LoadCurve
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.response import Response, constant_response, response_of
from tribolab.lubrication.parameters import parameters_of
from tribolab.lubrication.solved_curve import solve_curve
from tribolab.units.stamping import labelled

# computed curves extend beyond the measured speeds by this number of deviations of ln eta
_SPREADS_BEYOND_SPEEDS = 4.0
_SPEEDS_PER_DECADE = 8
_OWN = ("sliding_speed", "run")


@dataclass(frozen=True)
class DryFriction:
    """Friction measured without the liquid, as prior information on the shear stress.

    Parameters
    ----------
    measured
        Dry curves, in the same form as those in the liquid and at some of their loads.
    area_ratio
        Ratio [1] of the real contact area dry to that in the liquid, both with adhesion; one value
        for each load, or for all.
    area_ratio_range
        Range of that ratio, some 95 % coverage, from the range of the works of adhesion; by default
        the ratio is exact.

    Notes
    -----
    The liquid changes adhesion and the interface. The shear stress may therefore differ by a
    factor, ``dry_over_wet`` of `JointPriors`.

    Examples
    --------
    >>> friction = {"friction_coefficient": ("sliding_speed", [0.5])}
    >>> curve = xr.Dataset(friction, {"sliding_speed": [1e-5]})
    >>> round(DryFriction(curve, 1.2, (1.0, 1.4)).area_ratio_error, 3)
    0.086
    """

    measured: xr.Dataset
    area_ratio: float | xr.DataArray
    area_ratio_range: tuple[float, float] | None = None

    @property
    def area_ratio_error(self) -> float:
        """Standard error of ln(area_ratio) from its range; 0 if the ratio is exact.

        Raises
        ------
        AnalysisError
            If the range does not ascend from above zero.
        """
        if self.area_ratio_range is None:
            return 0.0
        low, high = self.area_ratio_range
        if not 0 < low <= high < np.inf:
            raise AnalysisError(
                f"area_ratio_range: two finite numbers above zero, the lesser first, are wanted; "
                f"got {low:g} and {high:g}"
            )
        return float(np.log(high / low) / (2 * NORMAL))


def loads_of(measured: xr.Dataset, load: str | float | xr.DataArray) -> xr.DataArray:
    """Return the loads [N/m] of the measured curves along their load dim, if they have one."""
    given = measured.get("friction_coefficient")
    if given is None or "sliding_speed" not in given.dims:
        raise AnalysisError(
            "a 'friction_coefficient' over 'sliding_speed' and the loads is wanted",
            where="measured",
            cure=Cure(notebook="tl.measured_stribeck_curve with labels makes such curves"),
        )
    dims = [dim for dim in given.dims if dim not in (*_OWN, "surface")]
    if len(dims) > 1:
        raise AnalysisError(
            f"measured: the curves are over {' and '.join(map(repr, dims))}; one of them may be "
            "the load, choose one value of the other",
        )
    loads = labelled(load, "load")
    if loads.ndim == 1 and dims and loads.dims != (dims[0],) and loads.size == given.sizes[dims[0]]:
        loads = xr.DataArray(loads.values, dims=dims, coords={dims[0]: measured[dims[0]]})
    if set(loads.dims) != set(dims):
        raise AnalysisError(
            f"load: the measured curves are over {dims[0] if dims else 'no load'}, and a load in "
            "N/m is wanted for each of them"
        )
    if not bool(((loads > 0) & np.isfinite(loads)).all()):
        raise AnalysisError("load: positive, finite values in N/m are wanted")
    if dims and dims[0] in measured.coords:
        try:
            loads = loads.sel({dims[0]: measured[dims[0]]})
        except KeyError:
            raise AnalysisError(
                f"load: not every {shown(str(dims[0]))} that was measured has one"
            ) from None
    return loads


def surfaces_of(measured: xr.Dataset, psd: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield the name and spectrum of each surface; the name is "" if there is only one."""
    if "surface" not in measured["friction_coefficient"].dims:
        yield "", psd
        return
    for surface in measured["surface"].values.tolist():
        if psd is not None and "surface" in psd.dims:
            if surface not in psd["surface"].values:
                raise AnalysisError(f"psd: there is no spectrum of {shown(surface)}")
            spectrum = psd.sel(surface=surface)
            yield surface, spectrum.dropna("wavenumber", how="all", subset=["psd_2d"])
        else:
            yield surface, psd


def computed_curves(
    psd: xr.Dataset,
    loads: xr.DataArray,
    measured: xr.Dataset,
    contact: Contact,
    viscosity: float,
    priors: JointPriors,
    model: Arguments,
) -> xr.Dataset:
    """Compute the curves of a surface at all loads, for all plausible viscosities and speeds."""
    speed = measured["sliding_speed"].values
    speed = speed[np.isfinite(speed) & (speed > 0)]
    if not speed.size:
        raise AnalysisError("measured: no sliding speed is above zero")
    beyond = _SPREADS_BEYOND_SPEEDS * priors.viscosity_spread + 0.3
    low, high = np.log(speed.min()) - beyond, np.log(speed.max()) + beyond
    count = int(np.ceil(_SPEEDS_PER_DECADE * (high - low) / np.log(10))) + 1
    grid = np.concatenate([[0.0], np.exp(np.linspace(low, high, count))])
    force = loads.values if loads.ndim else float(loads)
    options = {name: value for name, value in model.items() if name != "friction_factors"}
    if contact.is_round:
        options = {"method": "auto", **options}
    moving = grid if psd is not None else grid[1:]
    curve = solve_curve(contact, psd, force, moving, parameters_of(viscosity, 0.0, **options)).curve
    curve.attrs["friction_factors"] = "no" if model.get("friction_factors") is False else "yes"
    return curve.rename(load=loads.dims[0]).assign_coords(loads.coords) if loads.ndim else curve


def curves_of_surface(
    surface: str,
    measured: xr.Dataset,
    loads: xr.DataArray,
    computed: xr.Dataset,
    area_enhancement: float | xr.DataArray,
    dry: DryFriction | None,
) -> Iterator[LoadCurve]:
    """Yield the measured curves of a surface at each load, dry ones last."""
    for index in range(loads.size):
        at = loads.isel({dim: index for dim in loads.dims})
        response = _response(computed, at, loads)
        response = response.enlarged(_ratio_at(area_enhancement, surface, at))
        name = _curve_name(surface, at, loads)
        load = float(at)
        wet = _select_measured(measured, surface, at)
        if wet is not None:
            yield LoadCurve(name, surface, load, wet, response)
        without = None if dry is None else _select_measured(dry.measured, surface, at)
        if dry is not None and without is not None:
            area = constant_response(response.rest * _ratio_at(dry.area_ratio, surface, at))
            yield LoadCurve(f"{name} dry", surface, load, without, area, dry=True)


def _response(computed: xr.Dataset, at: xr.DataArray, loads: xr.DataArray) -> Response:
    curve = computed
    for dim in loads.dims:
        if dim in computed.coords and dim in computed.dims:
            curve = computed.sel({dim: at[dim]}, drop=True)
        elif "load" in computed.dims:
            curve = computed.sel(load=float(at), method="nearest", drop=True)
        else:
            raise AnalysisError(f"curves: they are not over {shown(str(dim))}, nor over the load")
    return response_of(curve, friction_factors=computed.attrs.get("friction_factors") != "no")


def _select_measured(measured: xr.Dataset, surface: str, at: xr.DataArray) -> xr.Dataset | None:
    """Return the measured curves of a surface at a load; None if there are none."""
    labels: Arguments = {str(dim): at[dim].item() for dim in at.coords if dim in measured.dims}
    if surface and "surface" in measured.dims:
        labels["surface"] = surface
    for dim, label in labels.items():
        if label not in measured[dim].values:
            return None
    mine = measured.sel(labels, drop=True)
    return mine if bool(np.isfinite(mine["friction_coefficient"]).any()) else None


def _ratio_at(given: float | xr.DataArray, surface: str, at: xr.DataArray) -> float:
    """Return the ratio of contact areas at a surface and load; an error unless it is positive."""
    if isinstance(given, xr.DataArray):
        for dim in at.coords:
            if dim in given.dims:
                given = given.sel({dim: at[dim].item()}, drop=True)
        if surface and "surface" in given.dims:
            given = given.sel(surface=surface, drop=True)
    value = float(given)
    if not 0 < value < np.inf:
        raise AnalysisError(f"a ratio of areas must be finite and above zero; got {value:g}")
    return value


def _curve_name(surface: str, at: xr.DataArray, loads: xr.DataArray) -> str:
    """Return the name of a curve: its load, preceded by the surface if there are several."""
    dim = loads.dims[0] if loads.dims else ""
    text = f"{number(float(at))} N/m"
    if dim == "normal_force":
        text = f"{number(float(at[dim]))} N"
    return f"{surface} at {text}" if surface else text
