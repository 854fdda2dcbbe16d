"""What the demo's kind of scans alone tell of a surface, against the truth they were made from.

Run with ``PYTHONPATH=. python tests/detection/scans_against_truth.py [seeds]``; 50 seeds take
about half a minute. For each seed and surface: three scans of 25 mm with curvature, tip, noise and
resolution of the virtual rig; form removal, spectra, extrapolation to 1 nm, contact area at the
lowest load. Printed are the share of bins of C_1D and C(q) whose 95 % band holds the truth, the
deviations of roughness, slope and contact area, and how often the truth lies in their bands.
"""

from __future__ import annotations

import sys

import numpy as np
import xarray as xr

from tribolab.contact.persson import contact_area_ratio
from tribolab.rig import scans as rig_scans
from tribolab.studies import xu2026
from tribolab.surface import self_affine
from tribolab.surface.extrapolation import extrapolate
from tribolab.surface.moments import rms_roughness, rms_slope
from tribolab.surface.spectra.psd import psd_1d, psd_2d

LIMITS = {"h_rms": 0.05, "slope": 0.10, "A/A0": 0.10}


def quantities(psd: xr.Dataset) -> dict[str, float]:
    """Roughness, slope and contact area at the lowest load."""
    pressure = xu2026.system.nominal_pressure(xu2026.system.loads[0])
    area = contact_area_ratio(pressure, psd, xu2026.system.effective_modulus)
    return {"h_rms": rms_roughness(psd), "slope": rms_slope(psd), "A/A0": float(area)}


def covered(found: xr.Dataset, name: str, truth: np.ndarray) -> np.ndarray:
    """Say of each bin whether its band holds the truth."""
    return ((found[f"{name}_low"] <= truth) & (truth <= found[f"{name}_high"])).values


def one_surface(name: str, seeds: int) -> tuple[np.ndarray, np.ndarray]:
    """Print what came out for one surface; return which bins were covered, of C_1D and of C."""
    spectrum, truth = xu2026.surface(name).spectrum, quantities(xu2026.psd(name))
    lines, areas = [], []
    errors, held = ({key: [] for key in LIMITS} for _ in range(2))
    for seed in range(1, seeds + 1):
        profile = psd_1d(rig_scans(name, seed=seed))
        trusted = profile.isel(wavenumber=profile.trusted.values == 1)
        lines.append(
            covered(trusted, "psd_1d", self_affine.psd_1d(spectrum, trusted.wavenumber.values))
        )
        surface = psd_2d(profile)
        areas.append(
            covered(surface, "psd_2d", self_affine.psd_2d(spectrum, surface.wavenumber.values))
        )
        wide = extrapolate(surface, q_low=spectrum.low)
        value, *ends = (
            quantities(wide.assign(psd_2d=wide[f"psd_2d{end}"])) for end in ("", "_low", "_high")
        )
        for key in LIMITS:
            errors[key].append(value[key] / truth[key] - 1)
            held[key].append(min(e[key] for e in ends) <= truth[key] <= max(e[key] for e in ends))
    one, two = np.concatenate(lines), np.concatenate(areas)
    print(
        f"{name}: bins covered {one.mean():.3f} of C_1D ({one.size}), {two.mean():.3f} of C(q)",
        end="",
    )
    print(f" ({two.size})")
    for key, limit in LIMITS.items():
        error = np.array(errors[key])
        rms, largest = 100 * np.sqrt((error**2).mean()), 100 * np.abs(error).max()
        print(
            f"  {key:6} mean {100 * error.mean():+5.1f} %, rms {rms:4.1f} %,"
            f" largest {largest:4.1f} %;"
            f" within {100 * limit:.0f} % in {(np.abs(error) <= limit).sum()} of {seeds};"
            f" truth in the band in {sum(held[key])}"
        )
    return one, two


def main(seeds: int = 50) -> None:
    """Go through the surfaces."""
    parts = [one_surface(name, seeds) for name in xu2026.surfaces]
    one, two = (np.concatenate(part) for part in zip(*parts, strict=True))
    print(f"all: {one.mean():.3f} of C_1D, {two.mean():.3f} of C(q); wanted 0.90 to 0.99")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
