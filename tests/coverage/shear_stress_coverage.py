"""How often the interval of a fitted shear stress holds the truth, over many seeds of the rig.

Nothing is taken shorter: each seed simulates a campaign on disk (Sb-S and Sb-R at four loads in
glycerol and one dry, two repeats, three scans), and the campaign's own pipeline reads the files,
finds segments, makes curves and spectra, computes the models and fits. Each of the eight fits is
made a second time with the true spectrum. What an uncertain spectrum does to sigma_f is computed
for the first seed and taken for the others, whose scans are as many and as long.

Before that, quick: many curves of 13 speeds with points that scatter by their stated errors, the
errors of neighbouring speeds independent or correlated by 0.8 (and 0.5), for both surfaces at two
loads, as many draws as asked for. Intervals should hold the truth in 93 to 97 %.

Run from the project's root::

    python tests/coverage/shear_stress_coverage.py [seeds] [first seed] [draws]

With 0 seeds only the quick part is run.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from scipy import stats

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.fit.spectrum_error import shear_stress_shift
from tribolab.lubrication.stribeck import stribeck_curve, with_shear_stress
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig import simulate_campaign
from tribolab.studies import xu2026

SURFACES = ("Sb-S", "Sb-R")


def drawn_curves(draws: int, seed: int) -> None:
    """Print how often the interval of a curve holds the truth, by the correlation of its errors."""
    speed = np.array(xu2026.SPEEDS)
    apart = np.abs(np.subtract.outer(np.arange(speed.size), np.arange(speed.size)))
    for correlation in (0.0, 0.5, 0.8):
        held, independent = [], []
        lower = np.linalg.cholesky(correlation**apart)
        rng = np.random.default_rng(seed)
        for name in SURFACES:
            for force in (31.0, 211.0):
                stress = dict(xu2026.surface(name).shear_stress)[force]
                given = (xu2026.contact, xu2026.psd(name), 1.4, xu2026.contact.load(force))
                bare = stribeck_curve(*given, 0.0, speed)
                true = with_shear_stress(bare, stress).friction_coefficient.values
                for noise in rng.standard_normal((draws, speed.size)):
                    error = 0.02 * true
                    data = {
                        "friction_coefficient": true + error * (lower @ noise),
                        "friction_coefficient_sem": error,
                    }
                    measured = xr.Dataset(
                        {key: ("sliding_speed", value) for key, value in data.items()},
                        {"sliding_speed": speed},
                    )
                    fit = fit_shear_stress(measured, *given, curve=bare)
                    held.append(abs(fit.shear_stress - stress) < fit.half_interval)
                    half = stats.t.ppf(0.975, fit.degrees_of_freedom) * fit.shear_stress_error
                    half *= max(1.0, fit.birge_ratio)
                    independent.append(abs(fit.shear_stress - stress) < half)
        print(
            f"  neighbouring errors correlated by {correlation}: {np.sum(held)} of {len(held)} "
            f"intervals hold the truth ({100 * np.mean(held):.1f} %; were the errors taken as "
            f"independent, {100 * np.mean(independent):.1f} %)",
            flush=True,
        )


def one_campaign(seed: int, shift: dict[str, tuple[float, float]]) -> list[dict[str, float | str]]:
    """Fits of one simulated campaign beside the truth; `shift` is filled by the first."""
    rows = []
    with tempfile.TemporaryDirectory() as place:
        file = simulate_campaign(Path(place) / "rig", seed=seed, surfaces=SURFACES)
        folder = Path(place) / "results"
        folder.mkdir()
        if shift:
            with file.open("a", encoding="utf-8") as text:
                text.write('\n[model]\nuncertainty = "none"\n')
        outcome = process(load_campaign(file), folder)
        for model in outcome.models:
            if "uncertainty" in model.parts:
                spread = read_netcdf(folder / model.data_file, "uncertainty")
                shift[model.surface] = shear_stress_shift(spread)
        for model in outcome.models:
            root, fit = (read_netcdf(folder / model.data_file, group) for group in (None, "fit"))
            curve = read_netcdf(folder / f"data/{model.curve}.nc")
            mine = fit_shear_stress(
                curve,
                xu2026.contact,
                xu2026.psd(model.surface),
                xu2026.system.viscosity,
                xu2026.contact.load(model.normal_force),
                common_error=root.attrs["repeatability"] / np.sqrt(2),
                common_freedom=root.attrs["freedom"],
            )
            true = dict(xu2026.surface(model.surface).shear_stress)[model.normal_force]
            scanned = fit.attrs["shear_stress_Pa"]
            half = fit.attrs["shear_stress_statistical_half_interval_Pa"]
            low, high = shift[model.surface]
            low, high = np.hypot(half, low * scanned), np.hypot(half, high * scanned)
            rows.append(
                {
                    "seed": seed,
                    "surface": model.surface,
                    "load": model.normal_force,
                    "off_true_spectrum": mine.shear_stress / true - 1,
                    "correlation": mine.residual_correlation,
                    "pull_true_spectrum": (mine.shear_stress - true) / mine.half_interval,
                    "half_interval": mine.half_interval / true,
                    "off_scans": scanned / true - 1,
                    "pull_scans_statistical": (scanned - true) / half,
                    "pull_scans": (scanned - true) / (low if scanned > true else high),
                }
            )
    return rows


def report(table: pd.DataFrame) -> None:
    """Print what share of the intervals holds the truth, and how far the fits lie off."""
    held = {name: (table[name].abs() <= 1) for name in table if name.startswith("pull")}
    for name, inside in held.items():
        seeds = inside.groupby(table["seed"]).sum()
        print(
            f"  {name:24} {inside.sum()} of {inside.size} intervals hold the truth "
            f"({100 * inside.mean():.1f} %); at least 7 of 8 in {(seeds >= 7).sum()} of "
            f"{seeds.size} seeds, fewest {seeds.min()}"
        )
    for name in ("off_true_spectrum", "off_scans"):
        off = table[name]
        print(
            f"  {name:24} mean {100 * off.mean():+.2f} %, standard deviation "
            f"{100 * off.std():.2f} %, largest {100 * off.abs().max():.2f} %"
        )
    print(
        f"  half a 95 % interval with the true spectrum: {100 * table.half_interval.mean():.2f} %"
    )


if __name__ == "__main__":
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    drawn_curves(int(sys.argv[3]) if len(sys.argv) > 3 else 250, first)
    rows: list[dict[str, float | str]] = []
    shift: dict[str, tuple[float, float]] = {}
    for seed in range(first, first + seeds):
        began = time.monotonic()
        rows += one_campaign(seed, shift)
        mine = pd.DataFrame(rows).query("seed == @seed")
        print(f"seed {seed}, {time.monotonic() - began:.0f} s", flush=True)
        print(mine.drop(columns="seed").round(4).to_string(index=False), flush=True)
    if rows:
        report(pd.DataFrame(rows))
