"""Rows of one surface: roughness, contact at the loads, and adhesion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tribolab.figures.labels import column
from tribolab.records.part_records import SurfaceRows
from tribolab.records.parts import Row
from tribolab.records.wording import plain_value, validity_of

if TYPE_CHECKING:
    import xarray as xr


_BAND = ("", "_low", "_high")
_ISO = ("Ra", "Rq", "Rz", "Rsk", "Rku", "Rdq")


ROUGHNESS = [
    "scans",
    *("Ra_m", "Rq_m", "Rz_m", "Rsk", "Rku", "Rdq"),
    *("Pq_m", "Sq_m", "Sa_m"),
    *(column(f"{name}_sem") for name in _ISO),
    *(column(f"{name}_gap_error") for name in _ISO),
    *(f"rms_roughness{end}_m" for end in _BAND),
    *(f"rms_slope{end}" for end in _BAND),
    *("measured_rms_roughness_m", "measured_rms_slope"),
    *("hurst_exponent", "hurst_exponent_standard_error", "rolloff_wavenumber_1_m"),
    *("wavenumber_low_1_m", "measured_low_1_m", "measured_high_1_m", "wavenumber_high_1_m"),
    *("form_removed", "form_radius_m", "tip_radius_m", "lambda_c_m"),
    *("evaluation_length_m", "sampling_lengths"),
]


CONTACT = [
    *("normal_force_N", "load_N_m", "pressure_Pa", "hertz_max_pressure_Pa", "hertz_width_m"),
    *(f"contact_area_ratio{end}" for end in _BAND),
    *("separation_m", "rough_max_pressure_Pa", "rough_contact_width_m"),
    *("rough_central_separation_m", "viscoelastic_friction_1_um_s", "viscoelastic_friction_1_mm_s"),
]


ADHESION = [
    "medium",
    *(f"work_of_adhesion{end}_J_m2" for end in _BAND),
    *(f"macroscopic_work_of_adhesion{end}_J_m2" for end in _BAND),
    "pull_off",
    *("normal_force_N", "load_N_m", "pressure_Pa", "contact_area_ratio_no_adhesion"),
    *(f"contact_area_ratio{end}" for end in _BAND),
    *(f"area_enhancement{end}" for end in _BAND),
    *("hertz_width_m", "jkr_width_m"),
]


def surface_rows(name: str, groups: Mapping[str, xr.Dataset], quality: str) -> SurfaceRows:
    """Return the rows of a surface from the groups of its data file.

    Parameters
    ----------
    name
        Name of the surface.
    groups
        ``roughness``; if present: ``psd``, ``contact``, ``loads``, ``line``, ``rubber``,
        ``adhesion_loads``.
    quality
        Worst status of the checks on its scans.
    """
    return SurfaceRows(
        name,
        plain_value(_roughness(groups["roughness"], groups.get("psd"))),
        tuple(plain_value(_contact(groups))),
        tuple(plain_value(_adhesion(groups))),
        str(groups["rubber"].attrs["modulus"]) if "rubber" in groups else "",
        quality,
        validity_of(groups.values()),
        str(groups["contact"].attrs["area"]) if "contact" in groups else "",
    )


def _roughness(moments: xr.Dataset, psd: xr.Dataset | None) -> Row:
    rough = dict.fromkeys(ROUGHNESS)
    for name in _ISO:
        rough[column(name)] = float(moments[name].mean())
        rough[column(f"{name}_sem")] = _error_over_scans(moments, name)
        if (error := f"{name}_gap_error") in moments:
            rough[column(error)] = _error_of_mean(moments[error])
    for name in ("Pq", "Sq", "Sa"):
        rough[column(name)] = float(moments[name].mean()) if name in moments else None
    for name in ("rms_roughness", "rms_slope"):
        for end in _BAND:
            if name + end in moments:
                rough[column(name + end)] = float(moments[name + end])
    attrs = ({} if psd is None else psd.attrs) | moments.attrs
    rough |= {key: attrs[key] for key in ROUGHNESS if key in attrs}
    if psd is None:
        return rough
    q = psd.wavenumber.values
    rough |= {"wavenumber_low_1_m": q[0], "wavenumber_high_1_m": q[-1]}
    return rough


def _error_over_scans(moments: xr.Dataset, name: str) -> float | None:
    """Return the standard error of a mean over scans; for one scan, from its parts."""
    values = moments[name]
    scans = values.mean("y") if "y" in values.dims else values
    if scans.size > 1:
        return float(scans.std(ddof=1)) / np.sqrt(scans.size)
    return float(moments[f"{name}_sem"].mean()) if f"{name}_sem" in moments else None


def _error_of_mean(error: xr.DataArray) -> float:
    """Return the standard error of a mean over scans; rows of a map are correlated."""
    scans = error.mean("y") if "y" in error.dims else error
    return float(np.sqrt((scans**2).sum()) / scans.size)


def _contact(groups: Mapping[str, xr.Dataset]) -> list[Row]:
    """Return rows of contact results, per load or else per pressure."""
    if "contact" not in groups:
        return []
    if "loads" not in groups:
        return [dict.fromkeys(CONTACT) | row for row in _rows(groups["contact"], "pressure")]
    renamed = {"max_pressure_Pa": "hertz_max_pressure_Pa", "contact_width_m": "hertz_width_m"}
    result = [
        dict.fromkeys(CONTACT) | {renamed.get(key, key): value for key, value in row.items()}
        for row in _rows(groups["loads"], "load")
    ]
    if "line" in groups:
        for row, line in zip(result, _rows(groups["line"], "load"), strict=True):
            for key in ("max_pressure_Pa", "contact_width_m", "central_separation_m"):
                row[f"rough_{key}"] = line[key]
    if "rubber" in groups:
        speed = groups["rubber"].sliding_speed.values
        for end, at in (("1_um_s", 1e-6), ("1_mm_s", 1e-3)):
            mu = groups["rubber"].friction_coefficient.values[:, np.argmin(abs(speed / at - 1))]
            for row, value in zip(result, mu, strict=True):
                row[f"viscoelastic_friction_{end}"] = float(value)
    return result


def _adhesion(groups: Mapping[str, xr.Dataset]) -> list[Row]:
    if "adhesion_loads" not in groups:
        return []
    adhesion, result = groups["adhesion_loads"], []
    widths = groups["loads"].contact_width.values if "loads" in groups else []
    for medium in adhesion.medium.values.tolist():
        mine = adhesion.sel(medium=medium)
        whole = {"medium": medium} | {
            column(str(name)): mine[name].item() for name in mine.data_vars if not mine[name].dims
        }
        rows = _rows(mine.drop_vars("magnification"), "load") or [{}]
        for number, row in enumerate(rows):
            width = {"jkr_width_m": row.pop("contact_width_m", None)}
            if len(widths):
                width["hertz_width_m"] = float(widths[number])
            result.append(dict.fromkeys(ADHESION) | whole | row | width)
    return result


def _rows(data: xr.Dataset, dim: str) -> list[Row]:
    """Return rows of the variables over one dimension, with names of the tables' columns."""
    names = [str(name) for name in data.variables if data[name].dims == (dim,)]
    values = {column(name): data[name].values.tolist() for name in names}
    return [dict(zip(values, row, strict=True)) for row in zip(*values.values(), strict=True)]
