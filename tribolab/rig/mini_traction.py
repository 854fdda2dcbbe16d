"""Simulated mini traction machine, in which a ball rolls and slides on a disc."""

from __future__ import annotations

import functools
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from tribolab.rig.files import write_scans
from tribolab.rig.scans.profiles import scans
from tribolab.studies import xu2026

_ABSOLUTE_ZERO = -273.15
_HEADER = (
    "Step Time (s)\tTraction Coeff (-)\t\tStep Time (s)\tLube RTD Temp (degC)\tBall Load (N)\t"
    "ECR (%)\tRolling Speed (mm/s)\tSliding Speed (mm/s)\tSRR (%)\tTraction Force (N)\t"
    "Traction Coeff (-)"
)
_RANGE = (1e-6, 0.08)  # range of viscosity × entrainment speed [N/m] that is computed
_SECONDS = 10.0  # time between two rows of the file [s]


@dataclass(frozen=True)
class MiniTraction:
    """Steel ball on a rubber disc in a liquid: true values, and measuring errors of the machine.

    Parameters
    ----------
    surface
        Rough surface of the ball, from `studies.xu2026`.
    radius, youngs_modulus, normal_force
        Radius of the ball [m], modulus of the disc [Pa], and load [N].
    viscosity, shear_stress
        Viscosity of the liquid [Pa s] at the first temperature, and shear stress in the real
        contact area [Pa].
    slide_roll, speeds
        Slide-roll ratio and entrainment speeds [m/s] of the step that measures a Stribeck curve.
    traction_speed, traction_ratios
        Entrainment speed [m/s] and slide-roll ratios of the step that measures a traction curve;
        no ratios, no step.
    temperature
        Temperature of the liquid [K] at the beginning and at the end.
    temperature_coefficient
        Relative decrease of the viscosity per kelvin [1/K].
    noise, level
        Relative standard deviation [1] of single values, and of a factor common to a whole run.

    Examples
    --------
    >>> import numpy as np
    >>> machine = MiniTraction()
    >>> slow, fast = machine.friction(np.array([1e-3, 0.3]), 0.5, machine.viscosity)
    >>> bool(slow > fast)
    True
    """

    surface: str = "Sb-S"
    radius: float = 9.525e-3
    youngs_modulus: float = 1.5e6
    normal_force: float = 3.0
    viscosity: float = 0.05
    shear_stress: float = 0.3e6
    slide_roll: float = 0.5
    speeds: tuple[float, ...] = tuple(np.geomspace(3e-4, 1.0, 16).tolist())
    traction_speed: float = 0.05
    traction_ratios: tuple[float, ...] = (0.1, 0.25, 0.5, 1.0, 1.5)
    temperature: tuple[float, float] = (293.15, 293.15)
    temperature_coefficient: float = 0.086
    noise: float = 0.02
    level: float = 0.03

    def friction(self, speed: np.ndarray, slide_roll: float, viscosity: float) -> np.ndarray:
        """Return the true friction coefficients at entrainment speeds [m/s].

        They are computed by the reduced theory of a ball, which fits also use.
        """
        stated = (self.surface, self.radius, self.youngs_modulus, self.normal_force)
        known = _parts(*stated, slide_roll)
        place = np.log(np.asarray(speed) * viscosity)
        fluid, solid = (np.exp(np.interp(place, known[0], part)) for part in known[1:])
        return fluid + self.shear_stress * solid


@functools.lru_cache(maxsize=64)
def _parts(
    surface: str, radius: float, youngs_modulus: float, normal_force: float, slide_roll: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ln(viscosity × speed), and ln of fluid friction and of µ per shear stress [1/Pa]."""
    # imported late for a quick start
    from tribolab.contact.geometry import PointContact
    from tribolab.lubrication.parameters import Interface, Solver
    from tribolab.lubrication.stribeck import stribeck_curve

    at = np.geomspace(*_RANGE, 33)
    curve = stribeck_curve(
        PointContact(radius, youngs_modulus, 0.5),
        xu2026.psd(surface),
        1.0,
        normal_force,
        Interface(0.0, slide_roll=slide_roll),
        at,
        Solver(method="strips"),
    )
    parts = [curve[f"friction_{name}"].values for name in ("coefficient", "per_shear_stress")]
    fluid, solid = (np.log(np.maximum(part, 1e-30)) for part in parts)
    return np.log(at), fluid, solid


def mini_traction_text(machine: MiniTraction, seed: int = 0) -> str:
    """Return the text of the file of one run, as the program of the machine writes it.

    Examples
    --------
    >>> machine = MiniTraction(speeds=(0.01, 0.1), traction_ratios=())
    >>> mini_traction_text(machine).splitlines()[0]
    'MTM311 Test Data File'
    """
    random = np.random.default_rng([seed, 311])
    level = np.exp(machine.level * random.standard_normal())
    steps = [("STRIBECK", [(speed, machine.slide_roll) for speed in machine.speeds])]
    if machine.traction_ratios:
        ratios = [(machine.traction_speed, ratio) for ratio in machine.traction_ratios]
        steps.append(("TRACTION", ratios))
    total = sum(len(rows) for _, rows in steps)
    temperatures = iter(np.linspace(*machine.temperature, total).tolist())
    lines = ["MTM311 Test Data File", "Profile description:\tsimulated", "Lubricant name:\t"]
    lines += ["", f"Number of steps in profile:\t{len(steps)}"]
    lines += ["Test started at 01/06/2026 09:00:00", ""]
    for number, (kind, rows) in enumerate(steps, start=1):
        lines.append(f"Step {number} started at 01/06/2026 {8 + number:02d}:10:00")
        lines += [f"Step type\t{kind}\tStep description\tsimulated", _HEADER]
        for row, (speed, ratio) in enumerate(rows, start=1):
            kelvin = next(temperatures)
            fall = machine.temperature_coefficient * (kelvin - machine.temperature[0])
            viscosity = machine.viscosity * np.exp(-fall)
            mu = float(machine.friction(np.array(speed), ratio, viscosity))
            mu *= level * np.exp(machine.noise * random.standard_normal())
            cells = [f"{row * _SECONDS:.0f}", f"{mu:.5f}", "", f"{row * _SECONDS:.0f}"]
            cells += [f"{kelvin + _ABSOLUTE_ZERO:.2f}", f"{machine.normal_force:.3f}", "0"]
            cells += [f"{1e3 * speed:.5g}", f"{1e3 * speed * ratio:.5g}", f"{100 * ratio:.3f}"]
            lines.append("\t".join([*cells, f"{mu * machine.normal_force:.6g}", f"{mu:.6g}"]))
        lines.append("")
    return "\n".join(lines)


def simulate_mini_traction(
    folder: str | Path, seed: int = 0, *, machine: MiniTraction | None = None, repeats: int = 2
) -> Path:
    """Write a simulated campaign on a mini traction machine: runs, scans, campaign.toml, truth.

    Parameters
    ----------
    folder
        Target folder, created if missing.
    seed
        Seed of noise and roughness.
    machine
        The machine and its errors; by default `MiniTraction()`.
    repeats
        Number of runs.

    Returns
    -------
    pathlib.Path
        The campaign file.

    Examples
    --------
    >>> import tempfile
    >>> machine = MiniTraction(speeds=(0.01, 0.1), traction_ratios=())
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     simulate_mini_traction(folder, machine=machine).name
    'campaign.toml'
    """
    machine = machine or MiniTraction()
    folder = Path(folder)
    raw = folder / "raw"
    raw.mkdir(parents=True, exist_ok=True)
    for number in range(1, repeats + 1):
        text = mini_traction_text(machine, 1000 * seed + number)
        (raw / f"oil_{number:02d}.txt").write_text(text, encoding="utf-8", newline="\r\n")
    write_scans(scans(machine.surface, 3, seed=seed), raw / "profiles")
    (folder / "truth.json").write_text(json.dumps(asdict(machine), indent=1) + "\n", "utf-8")
    file = folder / "campaign.toml"
    file.write_text(
        "# Simulated by the virtual rig of tribolab; the truth lies in truth.json.\n"
        '[campaign]\nname = "Ball on disc in oil (virtual mini traction machine)"\n'
        f'[contact]\ngeometry = "ball"\nradius = "{1e3 * machine.radius:g} mm"\n'
        f'youngs_modulus = "{machine.youngs_modulus / 1e6:g} MPa"\npoisson_ratio = 0.5\n'
        f'[medium.oil]\nviscosity = "{machine.viscosity:g} Pa s"\n'
        f'[[surface]]\nname = "{machine.surface}"\nscans = "profiles/*.csv"\n'
        f'[[run]]\nfiles = "oil_*.txt"\nsurface = "{machine.surface}"\nmedium = "oil"\n'
        f'normal_force = "{machine.normal_force:g} N"\n',
        "utf-8",
    )
    return file
