"""Usable scans of one surface, and its power spectrum."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribolab.campaign.surfaces.contact import contact_of
from tribolab.core.errors import AnalysisError, TribolabError
from tribolab.core.wording import number
from tribolab.qc.register import STATUSES
from tribolab.qc.scan.sets import check_scan_set
from tribolab.reading.scan_files import read_traces
from tribolab.reading.scans.read_scan import stacked
from tribolab.records.parts import Finding, Row
from tribolab.records.surfaces.roughness_words import FORM
from tribolab.surface.areal_roughness import areal_roughness
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.form import fill_dropouts, remove_form
from tribolab.surface.limits import MAX_EXTRAPOLATED_SLOPE, MIN_SHARE_OF_HEIGHT
from tribolab.surface.moments import band, rms_roughness, rms_slope
from tribolab.surface.roughness import primary_roughness, roughness_parameters
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.spectrum_roughness import spectral_roughness

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.campaign.surfaces.plan import PlannedSurface
    from tribolab.core.untyped import Json
    from tribolab.qc.findings import FindingRow, Findings

_FAILED = ("fail", "error")
# extrapolated fractions of the mean square slope that give a note, or a suspect finding
_NOTED, _SUSPECT = 0.5, 0.8
# a circle may be waviness if its removal reduces Pq by a factor between these
_CIRCLE_COUNTS, _CIRCLE_CLEAR = 1.02, 2.0


class CheckedScans(NamedTuple):
    """Usable scans, with the checks of all scans.

    Parameters
    ----------
    scans
        Usable scans, stacked, with dropouts filled.
    raw
        The same with their dropouts and quality flags.
    findings
        Findings on unusable files, and objections of the checks.
    quality
        Worst status of the checks on the scans used.
    checks
        A row for each scan and check.
    """

    scans: xr.Dataset
    raw: xr.Dataset
    findings: list[Finding]
    quality: str
    checks: list[Row]


def usable_scans(surface: PlannedSurface) -> CheckedScans:
    """Read and check the scans, without unusable ones and those that do not fit the others.

    Scans that fail their checks are left out unless all fail; then all are used and the quality
    is "fail".

    Raises
    ------
    AnalysisError
        If no scan is left.
    """
    scans, findings, label = _read(surface)
    if not scans:
        raise AnalysisError("; ".join(f.message for f in findings) or "it has no scans")
    checked = dict(zip(scans, check_scan_set(list(scans.values()), **surface.quality), strict=True))
    for path, found in checked.items():
        findings += _objections(label[path], found)
    shapes = {path: _shape(scan) for path, scan in scans.items()}
    sound = [path for path in scans if checked[path].status not in _FAILED] or list(scans)
    usual = Counter(shapes[path] for path in sound).most_common(1)[0][0]
    alike = [path for path in sound if shapes[path] == usual]
    for path in scans:
        if path in alike:
            continue
        why, severity = "it differs in pitch or length", "suspect"
        if path not in sound:  # the failure itself is already a finding
            why, severity = "its checks failed", "note"
        findings.append(Finding(severity, f"scan {label[path]} is left out: {why}"))
    quality = max((checked[path].status for path in alike), key=STATUSES.index)
    if quality in _FAILED:
        text = "no scan passed its checks, so all that follows from them is marked"
        findings.append(Finding("note", text))
    together = stacked(alike, [scans[path] for path in alike])
    filled = fill_dropouts(together)
    if number := filled.attrs["dropouts"]:
        share = 100 * filled.attrs["dropout_share"]
        text = f"{number} dropouts were filled ({share:.2g} % of heights)"
        findings.append(Finding("note", text))
    checks = [_as_row(label[path], row) for path, found in checked.items() for row in found.rows]
    flagged = [checked[path].marked for path in alike]
    return CheckedScans(filled, _add_flags(together, flagged), findings, quality, checks)


def _as_row(scan: str, row: FindingRow) -> Row:
    return {
        "scan": scan,
        "check": row["check"],
        "status": row["status"],
        "variable": row["variable"],
        "message": row["message"],
        "where": row["where"],
        "value": row["value"],
        "unit": row["unit"],
    }


def _read(
    surface: PlannedSurface,
) -> tuple[dict[Path, xr.Dataset], list[Finding], dict[Path, str]]:
    """Return the readable scans, a finding for each unreadable file, and the scan labels."""
    scans: dict[Path, xr.Dataset] = {}
    findings: list[Finding] = []
    called: dict[Path, str] = {}
    for path, label in zip(surface.files, surface.labels, strict=True):
        try:
            traces = read_traces(path, surface.instrument)
            for scan in traces.values():
                fill_dropouts(scan)
        except TribolabError as error:
            reason = _without_folder(error.message_for("campaign"), path)
            findings.append(Finding("fail", f"scan {label} is left out: {reason}"))
            continue
        for trace, scan in traces.items():
            if "tip_radius" in surface.roughness and "tip_radius_m" not in scan.attrs:
                scan = scan.assign_attrs(tip_radius_m=surface.roughness["tip_radius"])
            scans[trace] = scan
            called[trace] = label + trace.name.removeprefix(path.name)
    return scans, findings, called


def _shape(scan: xr.Dataset) -> tuple[Any, ...]:
    """Return the number of points and extent along each direction."""
    extent = tuple(f"{float(np.ptp(scan[dim].values)):.4g}" for dim in scan.height.dims)
    return tuple(scan.sizes.items()), extent


def _about(label: str, message: str) -> str:
    """Return a message that begins with the label of the scan instead of its file name."""
    name = label.rpartition("/")[2]
    end = message.removeprefix(name)
    return f"scan {label}{end}" if end != message else f"scan {label}: {message}"


def _objections(label: str, found: Findings) -> list[Finding]:
    return [
        Finding(
            "note" if row["status"] == "pass" else row["status"],
            f"{_about(label, row['message'])}. {row['cure']}".strip(". ") + ".",
            row["check"],
        )
        for row in found.rows
        if row["status"] in ("suspect", *_FAILED) or row["noted"]
    ]


def _add_flags(scans: xr.Dataset, flagged: list[xr.Dataset]) -> xr.Dataset:
    """Add the flags of each scan to the heights of all."""
    height = scans.height.assign_attrs(ancillary_variables="height_qc height_qc_tests")
    variables: dict[str, object] = {"height": height}
    for name in ("height_qc", "height_qc_tests"):
        parts = [scan[name].values for scan in flagged]
        values = np.stack(parts) if "scan" in scans.dims else parts[0]
        variables[name] = (height.dims, values, flagged[0][name].attrs)
    return scans.assign(variables)


def _without_folder(message: str, path: Path) -> str:
    return message.replace(f"{path}: ", "").replace(str(path), path.name)


def spectra_of_scans(
    surface: PlannedSurface, scans: xr.Dataset, q_low: float | None
) -> tuple[dict[str, xr.Dataset], list[Finding]]:
    """Remove the form from scans; compute roughness and the extrapolated spectrum.

    Parameters
    ----------
    surface, scans
        From `usable_scans`.
    q_low
        Smallest wavenumber of the contact [1/m], if known.

    Returns
    -------
    tuple
        ``psd_1d`` (of profiles), ``psd`` (extrapolated) and ``roughness``, and the findings. If no
        contact is computed, roughness does not require a spectrum.
    """
    options, groups, findings = dict(surface.roughness), {}, []
    form = options.get("form", "auto")
    is_map = "y" in scans.height.dims
    if form == "auto":
        form = "polynomial" if is_map else "circle"
    flat = scans if form == "none" else remove_form(scans, form)
    if form == "circle" and (doubt := _doubtful_circle(scans, flat)):
        findings.append(Finding("note", doubt, FORM))
    cut = options.get("lambda_c", "auto")
    iso = roughness_parameters(flat, lambda_c=cut).assign(Pq=primary_roughness(flat))
    if is_map:
        iso = iso.merge(areal_roughness(flat), combine_attrs="override")
    removed = {"form_removed": form}
    removed |= {k: v for k, v in flat.attrs.items() if k == "form_radius_m"}
    tip = options.get("tip_radius")
    # by contact theory
    asked = q_low is not None or "q_low" in options or contact_of(surface) is not None
    try:
        if is_map:
            measured = psd_2d(flat)
        else:
            by = "none" if form == "none" else "auto"
            groups["psd_1d"] = psd_1d(flat, form=by, tip_radius=tip)
            measured = psd_2d(groups["psd_1d"])
        psd, doubts = _extrapolate(measured, options, q_low)
    except AnalysisError as error:
        if asked:
            raise
        text = f"no spectrum of the surface, roughness parameters alone: {error.what}"
        groups["roughness"] = iso.assign_attrs(scans=flat.sizes.get("scan", 1), **removed)
        return groups, [*findings, Finding("suspect", text)]
    findings += doubts
    whole = spectral_roughness(psd).isel(wavenumber=-1, drop=True)
    seen = psd.wavenumber.values[psd.origin.values == 0]
    part = band(psd, float(seen[0]), float(seen[-1]))
    share = (rms_slope(part) / float(whole.rms_slope)) ** 2
    groups["psd"] = psd
    groups["roughness"] = iso.merge(whole, combine_attrs="drop_conflicts")
    groups["roughness"].attrs |= {
        "measured_rms_roughness_m": rms_roughness(part),
        "measured_rms_slope": rms_slope(part),
        "measured_low_1_m": float(seen[0]),
        "measured_high_1_m": float(seen[-1]),
    } | removed
    if psd.attrs["rolloff"].startswith("not reached"):
        findings.append(Finding("note", f"roll-off {psd.attrs['rolloff']}"))
    findings += _missing_waves(iso, rms_roughness(part), seen)
    if share < 1 - _NOTED:
        findings.append(_extrapolated_slope(share, rms_slope(part), float(seen[-1]), asked))
    hurst, unsure = (psd.attrs[f"hurst_exponent{end}"] for end in ("", "_standard_error"))
    if hurst - 1.96 * unsure > 1 and psd.wavenumber.values[-1] > seen[-1]:
        text = (
            f"the spectrum falls with a Hurst exponent of {hurst:.3g} ± {1.96 * unsure:.1g} (U95); "
            "above 1 a surface is smoother than a self-affine one, or a tip or filter took its "
            "short waves"
        )
        findings.append(Finding("note", text))
    return groups, findings


def _missing_waves(iso: xr.Dataset, in_band: float, seen: np.ndarray) -> list[Finding]:
    """Return a finding on waves missing from the rms height of the spectrum."""
    name, what = ("Sq", "map") if "Sq" in iso else ("Pq", "profile")
    whole = float(iso[name].mean())
    if in_band >= MIN_SHARE_OF_HEIGHT.value * whole:
        return []
    text = (
        f"measured_rms_roughness {number(1e6 * in_band)} um holds the waves of "
        f"{number(2e6 * np.pi / seen[-1])} to {number(2e6 * np.pi / seen[0])} um alone; the whole "
        f"{what} without its form has {name} = {number(1e6 * whole)} um, most of the rest in "
        f"longer waves. Take {name} for the height, and longer scans for the spectrum"
    )
    return [Finding("note", text)]


def _extrapolated_slope(share: float, slope: float, last: float, asked: bool) -> Finding:
    """Return a finding on the increase of slope due to extrapolation."""
    whole = slope / np.sqrt(share)
    text = (
        f"the extrapolation multiplies the measured rms slope by {number(whole / slope)}: it is "
        f"{number(slope)} down to the shortest measured wave ({number(2e6 * np.pi / last)} um) and "
        f"{number(whole)} with shorter ones, {100 * (1 - share):.0f} % of the mean square slope is "
        "extrapolated, not measured; contact and adhesion follow from it. To use the measured "
        'waves alone, set q_high = "measured" in [roughness]'
    )
    relied_on = (asked and share < 1 - _SUSPECT) or whole > MAX_EXTRAPOLATED_SLOPE.value
    return Finding("suspect" if relied_on else "note", text)


def _extrapolate(
    measured: xr.Dataset, options: Json, q_low: float | None
) -> tuple[xr.Dataset, list[Finding]]:
    """Extrapolate a spectrum; if no power law fits, keep the measured part only."""
    limits = {key: options[key] for key in ("q_high", "fit_decade") if key in options}
    low = options.get("q_low", q_low)
    first, last = (float(end) for end in measured.wavenumber.values[[0, -1]])
    if limits.get("q_high") == "measured":
        limits["q_high"] = last
    if low is not None and low >= last:
        raise AnalysisError(
            f"the scans measure waves of {number(2e6 * np.pi / last)} to "
            f"{number(2e6 * np.pi / first)} um, and the contact asks for those below "
            f"{number(2e6 * np.pi / low)} um alone: none of them was measured; take finer scans",
            function="extrapolate",
        )
    try:
        return extrapolate(measured, q_low=low, **limits), []
    except AnalysisError as error:
        if limits or not (measured.psd_2d > 0).any():
            raise
        text = (
            f"not extrapolated: {error.what}. Slope and contact are those of the measured waves "
            f"alone, down to {number(2e6 * np.pi / last)} um (q_high, fit_decade in [roughness])"
        )
        return extrapolate(measured, q_low=low, q_high=last), [Finding("suspect", text)]


def _doubtful_circle(scans: xr.Dataset, flat: xr.Dataset) -> str:
    """Return a doubt if the removed circle may be waviness; "" if it is clearly form or small."""
    with_it, without = (
        float(primary_roughness(each).mean()) for each in (remove_form(scans, "tilt"), flat)
    )
    if not _CIRCLE_COUNTS < with_it / without < _CIRCLE_CLEAR:
        return ""
    radius = flat.attrs["form_radius_m"]
    return (
        f"a circle of R = {number(radius)} m was removed; it may be part shape or part of the "
        f"waviness. The unfiltered Pq is {number(1e6 * without)} µm after removing the circle, "
        f"{number(1e6 * with_it)} µm after removing only the tilt "
        '(form = "tilt" in [roughness], for a flat part)'
    )
