"""How often the band of C(q) holds the truth, in the lowest annuli and in all.

Surfaces of known spectrum, a plateau below q_r and a power law of Hurst exponent H above: three
profiles of 16 mm each, with nothing but the mean, a tilt or a tilted cylinder to take away, and
maps. For each case: C below q_r/3 over the truth (mean, median), the share of its 95 % bands that
hold the truth, and the same share above q_r/3.

Run with ``PYTHONPATH=. python tests/coverage/lowest_annulus.py [draws] [first seed]``; 200 draws
take some two minutes.
"""

from __future__ import annotations

import sys

import numpy as np
import xarray as xr

from tribolab.surface import self_affine
from tribolab.surface.self_affine import SelfAffine
from tribolab.surface.spectra.psd import psd_1d, psd_2d
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

POINTS, PITCH, SCANS = 8001, 2e-6, 3
FORMS = ("none", "tilt", "circle")


def drawn_profiles(spectrum: SelfAffine, rng: np.random.Generator, form: str) -> xr.Dataset:
    """Profiles cut out of longer ones, so that they are not periodic, with form on them."""
    longer = synthesise_profiles(spectrum, points=4 * POINTS, pitch=PITCH, profiles=SCANS, rng=rng)
    height = longer.height.values[:, :POINTS]
    x = PITCH * (np.arange(POINTS) - (POINTS - 1) / 2)
    if form != "none":
        height = height + rng.uniform(-0.01, 0.01, (SCANS, 1)) * x
    if form == "circle":
        height = height + np.sqrt(0.07**2 - (x + rng.uniform(-1e-3, 1e-3, (SCANS, 1))) ** 2)
    return xr.Dataset({"height": (("scan", "x"), height)}, {"x": x - x[0]})


def drawn_map(spectrum: SelfAffine, rng: np.random.Generator, form: str) -> xr.Dataset:
    """A map cut out of a larger one, with form on it."""
    part = synthesise_map(spectrum, points=384, pitch=4e-6, rng=rng).isel(
        x=slice(192), y=slice(192)
    )
    x, y = part.x - part.x.mean(), part.y - part.y.mean()
    tilt = rng.uniform(-0.01, 0.01, 2) * (form != "none")
    cylinder = np.sqrt(0.07**2 - x**2) * (form == "polynomial")
    return part.assign(height=part.height + tilt[0] * x + tilt[1] * y + cylinder)


def held(found: xr.Dataset, spectrum: SelfAffine) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """C over the truth, whether the band holds it, and whether q is below q_r/3."""
    q = found.wavenumber.values
    truth = self_affine.psd_2d(spectrum, q)
    inside = (found.psd_2d_low.values <= truth) & (truth <= found.psd_2d_high.values)
    return found.psd_2d.values / truth, inside, q < spectrum.rolloff / 3


def case(spectrum: SelfAffine, form: str, draws: int, first: int, maps: bool = False) -> np.ndarray:
    """Collect all draws of one case: ratio, held, low (three rows)."""
    parts = []
    for seed in range(first, first + draws):
        rng = np.random.default_rng([seed, int(spectrum.rolloff), int(10 * spectrum.hurst)])
        if maps:
            found = psd_2d(drawn_map(spectrum, rng, form), form=form)
            found = found.isel(wavenumber=found.wavenumber.values < 3e5)
        else:
            found = psd_2d(psd_1d(drawn_profiles(spectrum, rng, form), form=form))
        parts.append(held(found, spectrum))
    return np.concatenate(parts, axis=1)


def main(draws: int = 200, first: int = 0) -> None:
    """Go through the cases."""
    every = []
    cases = [
        (hurst, rolloff, form, False)
        for hurst in (0.5, 0.8, 1.1)
        for rolloff in (1e4, 3e4, 9e4)
        for form in FORMS
    ] + [(hurst, 1.5e5, form, True) for hurst in (0.5, 1.1) for form in ("none", "polynomial")]
    for hurst, rolloff, form, maps in cases:
        spectrum = SelfAffine(hurst, rolloff, 1e-21, 300.0, 1e8)
        ratio, inside, low = case(spectrum, form, draws // 4 if maps else draws, first, maps)
        low = low > 0
        if not maps:
            every.append((ratio[low], inside[low], inside[~low]))
        print(
            f"{'map' if maps else 'profiles':8} H {hurst} q_r {rolloff:.0e} 1/m, {form:10}: below "
            f"q_r/3 C over truth {ratio[low].mean():.3f} (median {np.median(ratio[low]):.3f}), "
            f"held {100 * inside[low].mean():.1f} %; above, held {100 * inside[~low].mean():.1f} %",
            flush=True,
        )
    ratio, low, high = (np.concatenate(parts) for parts in zip(*every, strict=True))
    print(
        f"all profiles: C over truth {ratio.mean():.3f}, held {100 * low.mean():.1f} % below q_r/3 "
        f"and {100 * high.mean():.1f} % above"
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
