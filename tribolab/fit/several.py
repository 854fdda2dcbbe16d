"""Shear stresses of several surfaces, media or loads, fitted in one call."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from tribolab.arrays.conditions import ConditionLabels, Conditions, labels_along, labels_text
from tribolab.contact.geometry import Contact
from tribolab.core.errors import AnalysisError, Cure, shown
from tribolab.fit.fit_settings import SETTINGS, FitSettings
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.fit.shear_stress_fit import ShearStressFit

if TYPE_CHECKING:
    from collections.abc import Hashable

    import pandas as pd

    from tribolab.core.untyped import Arguments

_OWN = ("sliding_speed", "segment", "wavenumber", "x", "point")  # dims of one curve or spectrum


class ShearStressFits(Conditions[ShearStressFit]):
    """Fitted shear stresses, a `ShearStressFit` for each condition."""

    def to_dataset(self) -> xr.Dataset:
        """Return all numbers of `ShearStressFit.to_dataframe` for each condition, with units."""
        tables = np.empty(self.results.shape, dtype=object)
        about: dict[str, tuple[str, str]] = {}
        for index in np.ndindex(self.results.shape):
            fit: ShearStressFit | None = self.results[index].item()
            table = None if fit is None else fit.to_dataframe()
            tables[index] = {} if table is None else table["value"].to_dict()
            if table is not None:
                rows = zip(table.index, table["unit"], table["meaning"], strict=True)
                about |= {name: (unit, meaning) for name, unit, meaning in rows}
        numbers = {
            name: (
                self.results.dims,
                np.vectorize(lambda row, name=name: float(row.get(name, np.nan)))(tables),
                {"units": unit, "long_name": meaning},
            )
            for name, (unit, meaning) in about.items()
        }
        return xr.Dataset(numbers, self.results.coords)

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each measured condition."""
        table = self.to_dataset().to_dataframe()
        return table.dropna(how="all", subset=["shear_stress"])

    @property
    def curve(self) -> xr.Dataset:
        """The computed curves of all conditions (condition dims, sliding_speed)."""
        parts = [
            fit.curve.reset_coords().expand_dims({d: [v] for d, v in labels.items()})
            for labels, fit in self
        ]
        merged = xr.merge(parts, join="outer", compat="no_conflicts", combine_attrs="drop")
        order = {dim: self.results[dim] for dim in self.results.dims if dim in self.results.coords}
        return merged.reindex(order)

    def _repr_html_(self) -> str:
        """Return HTML with shear stress, error and fit of each condition; other numbers folded."""
        rows = "".join(
            f"<tr><th>{labels_text(labels)}</th><td>{1e-6 * fit.shear_stress:.3g} MPa</td>"
            f"<td>{1e-6 * fit.total_error:.2g} MPa</td><td>{fit.chi_square:.3g} of "
            f"{fit.degrees_of_freedom}</td><td>{fit.chi_square_p_value:.2g}</td></tr>"
            for labels, fit in self
        )
        table = self.to_dataframe().to_html(float_format=lambda number: f"{number:.4g}")
        return (
            "<table><thead><tr><th></th><th>shear stress</th><th>standard error</th>"
            "<th>chi-square of "
            f"degrees of freedom</th><th>probability</th></tr></thead><tbody>{rows}</tbody></table>"
            f"<details><summary>all numbers in SI</summary>{table}</details>"
        )


def fit_shear_stresses(
    measured: xr.Dataset,
    contact: Contact,
    psd: xr.Dataset,
    viscosity: str | float | xr.DataArray,
    load: str | float | xr.DataArray,
    **options: Any,
) -> ShearStressFits:
    """Fit the shear stress of each surface, medium or load.

    Parameters
    ----------
    measured
        Measured curves over ``sliding_speed`` and further dims, from `measured_stribeck_curve` with
        labels, or `tribolab.read_results` of a folder (``.curves()``).
    contact
        As for `fit_shear_stress`.
    psd, viscosity, load, **options
        As for `fit_shear_stress`, and the fields of `FitSettings`. An argument that differs between
        conditions has their dim: e.g. spectra the dim ``surface``, or loads [N/m] the dim
        ``normal_force``.

    Returns
    -------
    ShearStressFits

    Raises
    ------
    AnalysisError
        If a fit is not possible, with the condition.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.lubrication.stribeck import stribeck_curve
    >>> q, c = np.array([423.0, 9e4, 3e9]), np.array([1.63e-22, 1.63e-22, 4e-42])
    >>> psd = xr.Dataset({"psd_2d": (("surface", "wavenumber"), [c, 9 * c])},
    ...                  {"wavenumber": q, "surface": ["fine", "coarse"]})
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> speed = np.geomspace(1e-6, 1e-2, 5)
    >>> measured = stribeck_curve(contact, psd, 1.4, 310.0, "0.84 MPa", speed, cells=60)
    >>> fits = fit_shear_stresses(measured, contact, psd, "1.4 Pa s", "310 N/m", cells=60)
    >>> fits.to_dataset().shear_stress.round(-3).to_series().to_dict()
    {'fine': 840000.0, 'coarse': 840000.0}
    """
    given: Arguments = {"measured": measured, "psd": psd, "viscosity": viscosity, "load": load}
    given |= options
    coords = _further_dims(given)
    if not coords:
        raise AnalysisError(
            "measured: there is one curve, and no further dim",
            function="fit_shear_stresses",
            cure=Cure(notebook="fit it with fit_shear_stress"),
        )

    def fitted(labels: ConditionLabels) -> ShearStressFit | None:
        mine = {name: _select_condition(value, labels) for name, value in given.items()}
        if not bool(np.isfinite(mine["measured"]["friction_coefficient"]).any()):
            return None
        if fields := {name: mine.pop(name) for name in SETTINGS if name in mine}:
            mine["settings"] = replace(mine.get("settings") or FitSettings(), **fields)
        try:
            return fit_shear_stress(contact=contact, **mine)
        except AnalysisError as error:
            raise AnalysisError(f"{labels_text(labels)}: {error}") from error

    return ShearStressFits.of(coords, fitted)


def _further_dims(given: Mapping[str, object]) -> dict[Hashable, Any]:
    """Return the dims and labels that distinguish conditions, first those of the curves."""
    coords: dict[Hashable, Any] = {}
    for value in given.values():
        holder = _main_variable(value)
        for dim in getattr(holder, "dims", ()):
            if dim not in _OWN and dim not in coords:
                coords[dim] = labels_along(holder, dim)
    return coords


def _main_variable(value: Any) -> Any:
    """Return the friction or the spectrum in a dataset; other arguments are returned unchanged."""
    for name in ("friction_coefficient", "psd_2d"):
        if name in getattr(value, "data_vars", ()):
            return value[name]
    return value


def _select_condition(value: Any, labels: Mapping[Hashable, Any]) -> Any:
    """Return the part of an argument that belongs to one condition."""
    mine = {dim: label for dim, label in labels.items() if dim in getattr(value, "dims", ())}
    for dim, label in mine.items():
        try:
            value = value.sel({dim: label}, drop=True)
        except KeyError:
            raise AnalysisError(
                f"there are measured curves of {shown(str(dim))} '{shown(str(label))}', and "
                "another argument has none",
                function="fit_shear_stresses",
            ) from None
    if isinstance(value, xr.DataArray) and not value.dims:
        return value.item()
    if isinstance(value, xr.Dataset) and "psd_2d" in value:
        return value.dropna("wavenumber", how="all", subset=["psd_2d"])
    if isinstance(value, xr.Dataset) and "friction_coefficient" in value and mine:
        over = value["friction_coefficient"].dims[0]
        return value.dropna(over, how="all", subset=["friction_coefficient"])
    return value
