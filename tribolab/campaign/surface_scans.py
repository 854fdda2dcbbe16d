"""Scans of one surface, those that can be used, and its power spectrum."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tribolab.campaign.outcome import Finding
from tribolab.errors import AnalysisError, TribolabError

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.surface_plan import PlannedSurface

# shares of the mean square slope that come from extrapolation, from which on that is said
_NOTED, _SUSPECT = 0.5, 0.8


def usable_scans(surface: PlannedSurface) -> tuple[xr.Dataset, list[Finding]]:
    """Read the scans; those that cannot be read, or do not go with the others, are left out.

    Returns
    -------
    tuple
        The scans, without dropouts and stacked, and a finding for each file that is not in them.

    Raises
    ------
    AnalysisError
        If no scan is left.
    """
    from tribolab.io.scans import read_scans
    from tribolab.surface.form import fill_dropouts

    findings, shapes = [], {}
    for path, label in zip(surface.files, surface.labels, strict=True):
        try:
            [scan] = read_scans([path], surface.instrument, stack=False)
            fill_dropouts(scan)
        except TribolabError as error:
            reason = _without_folder(str(error), path)
            findings.append(Finding("fail", f"scan {label} is left out: {reason}"))
            continue
        extent = tuple(f"{float(np.ptp(scan[dim].values)):.4g}" for dim in scan.height.dims)
        shapes[path] = (tuple(scan.sizes.items()), extent)
    if not shapes:
        raise AnalysisError("; ".join(f.message for f in findings) or "it has no scans")
    usual = Counter(shapes.values()).most_common(1)[0][0]
    alike = [path for path, shape in shapes.items() if shape == usual]
    for path, label in zip(surface.files, surface.labels, strict=True):
        if path in shapes and path not in alike:
            why = "it differs in pitch or length"
            findings.append(Finding("suspect", f"scan {label} is left out: {why}"))
    scans = fill_dropouts(read_scans(alike, surface.instrument))
    if filled := scans.attrs["dropouts"]:
        share = 100 * scans.attrs["dropout_share"]
        findings.append(
            Finding("note", f"{filled} dropouts were filled ({share:.2g} % of heights)")
        )
    return scans, findings


def _without_folder(message: str, path: Path) -> str:
    return message.replace(f"{path}: ", "").replace(str(path), path.name)


def spectra(
    surface: PlannedSurface, scans: xr.Dataset, q_low: float | None
) -> tuple[dict[str, xr.Dataset], list[Finding]]:
    """Remove form, compute the spectra, extrapolate them and take roughness from both.

    Parameters
    ----------
    surface, scans
        From `usable_scans`.
    q_low
        Smallest wavenumber of the contact [1/m], if it is known.

    Returns
    -------
    tuple
        ``psd_1d`` (of profiles), ``psd`` (extrapolated) and ``roughness``, and the findings.
    """
    from tribolab.surface.extrapolation import extrapolate
    from tribolab.surface.form import remove_form
    from tribolab.surface.moments import band, rms_roughness, rms_slope
    from tribolab.surface.psd import psd_1d, psd_2d
    from tribolab.surface.roughness import roughness_parameters, spectral_roughness

    options, groups, findings = dict(surface.roughness), {}, []
    form = options.get("form", "auto")
    is_map = "y" in scans.height.dims
    if form == "auto":
        form = "polynomial" if is_map else "circle"
    flat = scans if form == "none" else remove_form(scans, form)
    tip = options.get("tip_radius")
    if is_map:
        measured = psd_2d(flat)
    else:
        groups["psd_1d"] = psd_1d(flat, form="none" if form == "none" else "auto", tip_radius=tip)
        measured = psd_2d(groups["psd_1d"])
    limits = {key: options[key] for key in ("q_high", "fit_decade") if key in options}
    psd = extrapolate(measured, q_low=options.get("q_low", q_low), **limits)
    whole = spectral_roughness(psd).isel(wavenumber=-1, drop=True)
    seen = psd.wavenumber.values[psd.origin.values == 0]
    part = band(psd, float(seen[0]), float(seen[-1]))
    share = (rms_slope(part) / float(whole.rms_slope)) ** 2
    groups["psd"] = psd
    groups["roughness"] = roughness_parameters(flat).merge(whole, combine_attrs="drop_conflicts")
    groups["roughness"].attrs |= {
        "measured_rms_roughness_m": rms_roughness(part),
        "measured_rms_slope": rms_slope(part),
        "measured_low_1_m": float(seen[0]),
        "measured_high_1_m": float(seen[-1]),
        "form_removed": form,
    } | {k: v for k, v in flat.attrs.items() if k == "form_radius_m"}
    if psd.attrs["rolloff"].startswith("not reached"):
        findings.append(Finding("note", f"roll-off {psd.attrs['rolloff']}"))
    if share < 1 - _NOTED:
        text = f"{100 * (1 - share):.0f} % of the mean square slope is extrapolated, not measured"
        findings.append(Finding("suspect" if share < 1 - _SUSPECT else "note", text))
    return groups, findings
