"""How often the intervals of a joint fit hold the truth, with everything wrong at once.

Each draw is a campaign of one surface in one liquid at four loads and 13 speeds: the shear stress
rises with speed (n = 0.05) and falls with load, the viscosity is off by 25 % (one standard
deviation), the level of each load by 5 %, neighbouring speeds err together by 2 %, and each point
by its own 2 %. Intervals of 95 % should hold the truth in 93 to 97 % of the draws; the standard
error of such a count is printed, 1.1 % of 400 draws. Beside them: one load alone, and speeds up to
10 um/s alone, of which the fit must say what it does not know; and the seconds that a fit takes
once the curves are computed.

With a second number so many campaigns go through raw files: the virtual rig writes logs and scans
of Sb-S under such laws, the campaign's own pipeline reads them, finds segments, makes curves and
models, and the joint fit takes what the pipeline left: once with the true spectrum in place of the
scanned one, which is the fit's own coverage, and once with the scans and the band of their
spectrum, whose ends are taken wide, so that these intervals hold it more often than they say.

Run from the project's root::

    python tests/coverage/joint_fit_coverage.py [draws] [campaigns] [first seed]
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from scipy import stats

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.contact.geometry import make_contact
from tribolab.fit.joint.load_curve import LoadCurve
from tribolab.fit.joint.loads import fit_loads
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.response import Response, response_of
from tribolab.fit.joint.result import JointFit
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig.files import write_run, write_scans
from tribolab.rig.runs import run_name, simulate_run
from tribolab.rig.scans.profiles import scans
from tribolab.studies import xu2026

SURFACE = "Sb-S"
SPEEDS = np.array(xu2026.SPEEDS)
LOADS = xu2026.system.loads
STRESS, EXPONENT, LOAD_EXPONENT = 0.84e6, 0.05, -0.2
LEVEL, CORRELATED, POINT = 0.05, 0.02, 0.02
VISCOSITY_SPREAD = 0.25
REFERENCE = float(np.exp(np.mean(np.log(LOADS))))  # N


class Truth(NamedTuple):
    """Parameters of one draw, and the friction at each load as a function of speed."""

    values: dict[str, float]
    friction: list[Callable[[np.ndarray], np.ndarray]]


class Law(NamedTuple):
    """Friction with a shear stress that depends on speed and load, and errors that are shared."""

    response: Response
    stress: float
    viscosity: float
    log_speed: np.ndarray
    error: np.ndarray

    def __call__(self, speed: np.ndarray) -> np.ndarray:
        """Friction coefficient at sliding speeds [m/s]."""
        v = np.abs(np.asarray(speed, dtype=float))
        moving = np.maximum(v, 1e-9)
        fluid, _, area, _ = self.response.at(np.log(self.viscosity * moving))
        mu = fluid + self.stress * (moving / 1e-5) ** EXPONENT * area
        return mu * np.exp(np.interp(np.log(moving), self.log_speed, self.error))


def responses() -> list[Response]:
    """Compute the curves of the surface at all loads, over all viscosities that are drawn."""
    speed = np.geomspace(1e-8, 1.0, 81)
    loads = [xu2026.contact.load(force) for force in LOADS]
    curves = stribeck_curve(xu2026.contact, xu2026.psd(SURFACE), 1.4, loads, 0.0, speed)
    return [response_of(curves.isel(load=k)) for k in range(len(LOADS))]


def truth(at: list[Response], rng: np.random.Generator) -> Truth:
    """Draw one campaign."""
    viscosity = xu2026.system.viscosity * np.exp(VISCOSITY_SPREAD * rng.standard_normal())
    log_speed = np.log(np.geomspace(1e-7, 1e-1, 79))
    near = np.exp(-np.abs(np.subtract.outer(log_speed, log_speed)) / 1.15)
    lower = np.linalg.cholesky(near + 1e-10 * np.eye(log_speed.size))
    laws = [
        Law(
            response,
            STRESS * (force / REFERENCE) ** LOAD_EXPONENT,
            viscosity,
            log_speed,
            LEVEL * rng.standard_normal()
            + CORRELATED * lower @ rng.standard_normal(log_speed.size),
        )
        for force, response in zip(LOADS, at, strict=True)
    ]
    values = {
        "shear_stress": STRESS,
        "speed_exponent": EXPONENT,
        "load_exponent": LOAD_EXPONENT,
        "viscosity": float(viscosity),
    }
    return Truth(values, list(laws))


def drawn_curves(
    drawn: Truth, at: list[Response], rng: np.random.Generator, speed: np.ndarray = SPEEDS
) -> list[LoadCurve]:
    """Measure a drawn campaign, each point with its own error."""
    curves = []
    for force, law, response in zip(LOADS, drawn.friction, at, strict=True):
        true = law(speed)
        data = {
            "friction_coefficient": true * (1 + POINT * rng.standard_normal(speed.size)),
            "friction_coefficient_sem": POINT * true,
        }
        measured = xr.Dataset(
            {name: ("sliding_speed", values) for name, values in data.items()},
            {"sliding_speed": speed},
        )
        load = xu2026.contact.load(force)
        curves.append(LoadCurve(f"{force:g} N", "", load, measured, response))
    return curves


def held(fit: JointFit, values: dict[str, float]) -> dict[str, float]:
    """For each parameter whether its interval holds the truth, and its width over the truth's."""
    row: dict[str, float] = {}
    for name, value in values.items():
        marginal = fit.marginal(name)
        row[name] = float(marginal.low <= value <= marginal.high)
        row[f"{name} half"] = (marginal.high - marginal.low) / 2
    return row


def quick(draws: int, first: int) -> bool:
    """Print the coverage over drawn campaigns; return whether it is what it should be."""
    at = responses()
    priors = JointPriors(viscosity_spread=VISCOSITY_SPREAD)
    rows, alone, seconds = [], [], 0.0
    unsaid = 0
    slow = SPEEDS[SPEEDS < 1.1e-5]
    for seed in range(first, first + draws):
        rng = np.random.default_rng([seed, 17])
        drawn = truth(at, rng)
        curves = drawn_curves(drawn, at, rng)
        began = time.process_time()
        fit = fit_loads(curves, xu2026.system.viscosity, priors)
        seconds += time.process_time() - began
        rows.append(held(fit, drawn.values))
        if seed < first + min(draws, 40):
            single = fit_loads(curves[:1], xu2026.system.viscosity, priors)
            alone.append(
                held(
                    single,
                    {
                        "shear_stress": STRESS * (LOADS[0] / REFERENCE) ** LOAD_EXPONENT,
                        "speed_exponent": EXPONENT,
                        "viscosity": drawn.values["viscosity"],
                    },
                )
            )
            low = fit_loads(drawn_curves(drawn, at, rng, slow), xu2026.system.viscosity, priors)
            unsaid += single.marginal("load_exponent").identified != "not identified"
            unsaid += low.marginal("viscosity").identified != "not identified"
    table = pd.DataFrame(rows)
    fine = told("all loads", table, list(drawn.values))
    told("one load alone", pd.DataFrame(alone), ["shear_stress", "speed_exponent", "viscosity"])
    print(f"  one load, or low speeds alone: {unsaid} of {2 * len(alone)} not said to be unknown")
    print(f"  {seconds / draws:.3f} s of CPU a fit, cross-validation over the loads included")
    return fine and not unsaid


def told(what: str, table: pd.DataFrame, names: list[str]) -> bool:
    """Print coverages; return whether all lie in 93 to 97 %.

    Of fewer than 100 draws one more or less is a per cent or more: then they may be off by as much
    as happens to one in twenty such counts.
    """
    fine = True
    for name in names:
        count, size = int(table[name].sum()), len(table)
        low, high = 0.93 * size, 0.97 * size
        if size < _FEW:
            low, high = stats.binom.ppf([0.025, 0.975], size, [0.93, 0.97])
        inside = low <= count <= high
        error = 100 * np.sqrt(0.95 * 0.05 / size)
        fine &= bool(inside)
        print(
            f"  {what}: {name:15} {count} of {size} intervals hold the truth "
            f"({100 * count / size:.1f} ± {error:.1f} %), "
            f"half width {table[f'{name} half'].mean():.3g}"
            f"{'' if inside else '  MISSED'}",
            flush=True,
        )
    return fine


def through_files(campaigns: int, first: int) -> bool:
    """Print the coverage over campaigns that go through raw files."""
    at = responses()
    exact, scanned = [], []
    for seed in range(first, first + campaigns):
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as place:
            rng = np.random.default_rng([seed, 17])
            drawn = truth(at, rng)
            fits = fits_of_campaign(written(Path(place), drawn, seed), Path(place) / "results", at)
        exact.append(held(fits[0], drawn.values))
        scanned.append(held(fits[1], drawn.values))
        print(f"seed {seed}, {time.monotonic() - began:.0f} s; truth {drawn.values}", flush=True)
        print(fits[1].table().iloc[:, 1:5].to_string(), flush=True)
    names = list(drawn.values)
    fine = told("raw files, true spectrum", pd.DataFrame(exact), names)
    # the band of a spectrum is wide on purpose: these intervals may hold more often
    table = pd.DataFrame(scanned)
    told("raw files, scans", table, names)
    return fine and bool((table[names].mean() >= 0.85).all())


def written(folder: Path, drawn: Truth, seed: int) -> Path:
    """Write raw logs and scans of a drawn campaign, and its campaign file."""
    for room in ("raw/friction", "raw/profiles"):
        (folder / room).mkdir(parents=True)
    rng = np.random.default_rng([seed, 18])
    parts = [_CAMPAIGN]
    for force, law in zip(LOADS, drawn.friction, strict=True):
        for number in (1, 2):
            run = simulate_run(SURFACE, "glycerol", force, number, seed=rng, law=law)
            write_run(run, folder / "raw/friction")
        stem = run_name(SURFACE, "glycerol", force, 1).removesuffix("01")
        parts.append(
            f'[[run]]\nfiles = "friction/{stem}*.csv"\nsurface = "{SURFACE}"\n'
            f'medium = "glycerol"\nnormal_force = "{force:g} N"\ninstrument = "linear_slider"\n'
        )
    write_scans(scans(SURFACE, 3, seed=rng), folder / "raw/profiles")
    file = folder / "campaign.toml"
    file.write_text("\n".join(parts), encoding="utf-8")
    return file


def fits_of_campaign(file: Path, folder: Path, at: list[Response]) -> tuple[JointFit, JointFit]:
    """Process a campaign; fit all its loads together with the true spectrum, and with its scans."""
    folder.mkdir()
    outcome = process(load_campaign(file), folder)
    contact = make_contact(**load_campaign(file).contact.bodies())
    exact, scanned, band = [], [], None
    for model, true in zip(outcome.models, at, strict=True):
        path = folder / model.data_file
        if "uncertainty" in model.parts:
            band = read_netcdf(path, "uncertainty")
        computed = xr.concat(
            [read_netcdf(path, group)[list(_COLUMNS)] for group in ("curve", "fit")],
            "sliding_speed",
            combine_attrs="override",
        ).sortby("sliding_speed")
        computed.attrs["viscosity_Pa_s"] = xu2026.system.viscosity
        measured = read_netcdf(folder / f"data/{model.curve}.nc")
        name, load = f"{model.normal_force:g} N", contact.load(model.normal_force)
        exact.append(LoadCurve(name, "", load, measured, true))
        scanned.append(LoadCurve(name, "", load, measured, response_of(computed)))
    assert band is not None  # a campaign computes it at one load by itself
    priors, viscosity = JointPriors(viscosity_spread=VISCOSITY_SPREAD), xu2026.system.viscosity
    return (
        fit_loads(exact, viscosity, priors),
        fit_loads(scanned, viscosity, priors, spectrum_error={"": band}),
    )


_FEW = 100
_COLUMNS = (
    "friction_coefficient_couette",
    "friction_coefficient_pressure",
    "friction_per_shear_stress",
)
_CAMPAIGN = f"""[campaign]
name = "one surface, everything wrong"
raw = "raw"
[contact]
radius = "{xu2026.system.radius} m"
length = "{xu2026.system.length} m"
youngs_modulus = "{xu2026.system.youngs_modulus} Pa"
poisson_ratio = {xu2026.system.poisson_ratio}
[medium.glycerol]
viscosity = "{xu2026.system.viscosity} Pa s"
[segments]
trim = 0.10
[[surface]]
name = "{SURFACE}"
scans = "profiles/{SURFACE.lower()}_*.csv"
"""


if __name__ == "__main__":
    draws = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    campaigns = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    fine = [quick(draws, first)] if draws else []
    fine += [through_files(campaigns, first)] if campaigns else []
    print("coverage is as it should be" if all(fine) else "MISSED")
    sys.exit(not all(fine))
