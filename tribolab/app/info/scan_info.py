"""Output of `tribolab info` on a scan: its roughness, and the settings stated in its file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tribolab.core.errors import AnalysisError
from tribolab.core.wording import many

if TYPE_CHECKING:
    import xarray as xr

_LARGEST_MAP = 20_000_000  # most points of a map whose areal roughness is computed here
_LARGEST = 2_000_000  # most points of a scan whose profile roughness is computed here
_OTHER_FORM = 0.02  # roughness with only the tilt removed is shown if it differs by more than this


def stated_lines(attrs: Mapping[str, Any]) -> list[str]:
    """Return a line with the settings of the instrument that the file states; empty if none."""
    stated = [
        f"{name} {scale * float(attrs[key]):.6g}{unit}"
        for key, name, scale, unit in (
            ("tip_radius_m", "tip radius", 1e6, " um"),
            ("stated_length_m", "length", 1e3, " mm"),
            ("stated_pitch_m", "one point every", 1e6, " um"),
            ("stated_points", "points", 1.0, ""),
        )
        if isinstance(attrs.get(key), float)
    ]
    return [f"  stated  {', '.join(stated)}"] if stated else []


def areal_lines(scan: xr.Dataset) -> list[str]:
    """Return a line on the areal roughness Sq and Sa of a map; empty if it cannot be computed."""
    # imported late for a quick start
    from tribolab.surface.areal_roughness import areal_roughness
    from tribolab.surface.form import remove_form

    if scan["height"].size > _LARGEST_MAP:
        return []
    try:
        bent, level = (areal_roughness(remove_form(scan, form)) for form in ("polynomial", "tilt"))
    except AnalysisError:  # reported by a check of the scan
        return []
    sq, sa, level_sq = (1e6 * float(value.mean()) for value in (bent.Sq, bent.Sa, level.Sq))
    tilt_text = ""
    if sq > 0 and abs(level_sq / sq - 1) > _OTHER_FORM:
        tilt_text = (
            f"; with only the tilt removed: Sq {level_sq:.3g} um, "
            f'Sa {1e6 * float(level.Sa.mean()):.3g} um (form = "tilt" in [roughness])'
        )
    return [
        f"  Sq      {sq:.3g} um, Sa {sa:.3g} um: polynomial of degree 2 removed, no cut-off, over "
        f"the whole map (ISO 25178){tilt_text}"
    ]


def roughness_lines(scan: xr.Dataset) -> list[str]:
    """Return lines on the profile roughness of a scan, with the standard cut-off and without."""
    # imported late for a quick start
    import numpy as np

    from tribolab.records.surfaces.roughness_words import hardly_bends, roughness_u95
    from tribolab.records.wording import error_text
    from tribolab.surface.form import remove_form
    from tribolab.surface.roughness import STANDARD_CUTOFF, primary_roughness, roughness_parameters

    if scan["height"].size > _LARGEST:
        return []
    try:
        flat = remove_form(scan, "polynomial" if scan.sizes.get("y", 1) > 1 else "circle")
        iso = roughness_parameters(flat)
        tilted = remove_form(scan, "tilt")
        level = 1e6 * float(primary_roughness(tilted).mean())
    except AnalysisError:  # reported by a check of the scan
        return []
    sizes = {name: f"{1e6 * float(iso[name].mean()):.3g} um" for name in ("Rq", "Ra")}
    all_waves = 1e6 * float(primary_roughness(flat).mean())
    cut = iso.attrs.get("lambda_c_m")
    by = " by the instrument" if iso.attrs["filtered_by"] == "instrument" else ""
    filtered = f"waves longer than {1e3 * cut:.3g} mm filtered out{by}" if cut else "no cut-off"
    if cut and not by and cut < STANDARD_CUTOFF:
        filtered += (
            f" (a fifth of the scan, because it is shorter than {5e3 * STANDARD_CUTOFF:.3g} mm)"
        )
    for name in sizes:
        if (error := f"{name}_sem") in iso:
            value, sem = (1e6 * float(iso[each].mean()) for each in (name, error))
            row = {f"{name}_sem_m": sem, "sampling_lengths": iso.attrs["sampling_lengths"]}
            sizes[name] = f"{error_text(value, roughness_u95(row, name))} um"
    radius = flat.attrs.get("form_radius_m", math.inf)
    is_map = scan.sizes.get("y", 1) > 1
    form = "polynomial of degree 2" if is_map else "form"
    if math.isfinite(radius):
        length = float(np.ptp(scan["x"].values))
        bent = not hardly_bends(radius, length, 1e-6 * all_waves)
        form = (
            f"circle of R = {radius:.3g} m"
            if bent
            else f"tilt and a faint bend (R = {radius:.3g} m)"
        )
    rows = ", along its rows" if is_map else ""
    count = iso.attrs.get("sampling_lengths")
    lengths = "sampling lengths" if count is None else many(int(count), "sampling length")
    tilt_text = ""
    if abs(level / all_waves - 1) > _OTHER_FORM:
        tilt_text = (
            f"; with only the tilt removed: Pq {level:.3g} um, "
            f'Pa {_mean_deviation(tilted):.3g} um (form = "tilt" in [roughness])'
        )
    return [
        f"  Rq      {sizes['Rq']}, Ra {sizes['Ra']}: {form} removed, {filtered}; means over "
        f"{lengths}{rows} (ISO 4287)",
        f"  Pq      {all_waves:.3g} um, Pa {_mean_deviation(flat):.3g} um: {form} removed, no "
        f"cut-off{rows}{tilt_text}",
    ]


def _mean_deviation(flat: xr.Dataset) -> float:
    """Return Pa [um]: mean absolute deviation of the heights, averaged over all profiles."""
    # imported late for a quick start
    import numpy as np

    profile = flat["height"] - flat["height"].mean("x")
    return 1e6 * float(np.abs(profile).mean())
