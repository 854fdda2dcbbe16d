"""Simulation of one run on the virtual rig: force log, motion log and their true values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, is_dataclass

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_lists
from tribolab.core.untyped import Json
from tribolab.rig.calibration import Calibration
from tribolab.rig.faults import inject
from tribolab.rig.laws import StickSlip, friction_law, stick_slip
from tribolab.rig.parameters import Rig
from tribolab.rig.schedule import make_schedule
from tribolab.rig.sensors import (
    TRUE,
    Errors,
    draw_errors,
    motion_clock,
    read_forces,
    read_motion,
    sample_times,
)
from tribolab.rig.signals import make_signals
from tribolab.rig.simulated import SimulatedRun
from tribolab.studies import xu2026
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp


def run_name(surface: str, medium: str, normal_force: float, number: int) -> str:
    """Return the name of a run, with which its files begin.

    >>> run_name("Sb-R", "glycerol", 31.0, 1)
    'sb-r_glycerol_31N_01'
    """
    return f"{surface.lower()}_{medium}_{normal_force:g}N_{number:02d}"


@of_lists("surface", "medium", "normal_force", "number", "seed", paired="faults")
def simulate_run(
    surface: str = "Sb-S",
    medium: str = "glycerol",
    normal_force: str | float = 31.0,
    number: int = 1,
    *,
    seed: int | np.random.Generator = 0,
    rig: Rig | None = None,
    law: Callable[[np.ndarray], np.ndarray] | None = None,
    slip: StickSlip | None = None,
    faults: str | Sequence[str] = (),
    calibration: Calibration = TRUE,
) -> SimulatedRun:
    """Return a simulated run on the linear slider, or one for each of several conditions.

    Lists of surfaces, media, loads, numbers and seeds are combined element by element and give a
    list of runs; a list of faults then has one entry for each run.

    Parameters
    ----------
    surface, medium
        ``"Smooth"``, ``"Sb-S"``, ``"Sb-R"``; ``"glycerol"`` or ``"dry"``.
    normal_force
        Normal force [N], or text with a unit.
    number
        Number of the repeat; it affects only the name.
    seed
        Seed or generator; the same seed gives the same run.
    rig
        Protocol and sensors; default `Rig`.
    law
        Function from speeds [m/s] to µ; by default `friction_law` of surface, medium and load.
    slip
        Stick-slip; by default `stick_slip` of surface and medium.
    faults
        Names of faults in the logs (`tribolab.rig.faults.FAULTS`); they do not change the true
        signals.
    calibration
        Errors of the force cell in addition to its random zeros; by default none.

    Returns
    -------
    SimulatedRun
        Both logs, the noise-free signals, and the truth of each segment.

    Raises
    ------
    AnalysisError
        If surface or medium is not known.
    ConfigError
        If a fault is unknown, or cannot occur in this run.
    UnitError
        If the load's text has no unit of force.

    Examples
    --------
    >>> from tribolab.rig.parameters import Protocol
    >>> run = simulate_run("Sb-R", "dry", "31 N", rig=Rig(Protocol(speeds=(1e-4,))))
    >>> run.name, len(run.segments)
    ('sb-r_dry_31N_01', 2)
    """
    rig = rig or Rig()
    force = to_si(normal_force, "N", name="normal_force")
    surface = xu2026.surface(surface).name
    law = law or friction_law(surface, medium, force)
    slip = slip or stick_slip(surface, medium)
    rng = np.random.default_rng(seed)

    factor = float(1 + rig.scatter.repeat * rng.standard_normal())
    errors = draw_errors(rig.force_cell, rig.encoder, rig.clocks, rng)
    schedule = make_schedule(rig.protocol)
    signals = make_signals(schedule, rig.protocol, rig.scatter, law, slip, force, factor, rng)

    time, interval = sample_times(schedule, rig.loggers.force_rate, rig.loggers, rng)
    friction, normal = read_forces(
        signals, time, interval, rig.force_cell, errors, rng, calibration
    )
    # the motion logger starts later and stops earlier, as if operated by hand
    begin, end = rng.uniform(2.2, 4.0), schedule.end - rng.uniform(0.5, 2.5)
    moved, _ = sample_times(schedule, rig.loggers.motion_rate, rig.loggers, rng, begin, end)
    position, velocity, set_speed = read_motion(signals, moved, rig.encoder, errors, rng)

    name = run_name(surface, medium, force, number)
    true_normal, true_friction = signals.force_normal(time), signals.friction(time)
    true_position, true_velocity = schedule.motion(time)
    facts = {
        "surface": surface,
        "medium": medium,
        "normal_force_N": force,
        "repeat_factor": factor,
        "law": _law_parameters(law),
        "stick_slip": _law_parameters(slip),
        **({} if calibration == TRUE else {"calibration": asdict(calibration)}),
        **_clock_facts(errors, float(moved[0]), float(moved[-1])),
    }
    run = SimulatedRun(
        name,
        _log(time, friction_force=friction, normal_force=normal),
        _log(
            motion_clock(moved, errors),
            position=position,
            sliding_velocity=velocity,
            set_speed=set_speed,
        ),
        _log(
            time,
            friction_coefficient=true_friction,
            friction_force=true_friction * true_normal,
            normal_force=true_normal,
            position=true_position,
            sliding_velocity=true_velocity,
        ),
        signals.truth,
        facts,
    )
    if not faults:
        return run

    return inject(run, faults, rng)


def _log(time: np.ndarray, **signals: np.ndarray) -> xr.Dataset:
    data = {name: ("time", values) for name, values in signals.items()}
    return stamp(xr.Dataset(data, {"time": time}))


def _law_parameters(thing: object) -> Json:
    """Return the parameters of a friction law or stick-slip, for the truth of a run."""
    values = asdict(thing) if is_dataclass(thing) and not isinstance(thing, type) else {}
    # curves are omitted
    values = {k: v for k, v in values.items() if not isinstance(v, tuple)}
    finite = {k: v if isinstance(v, str) or np.isfinite(v) else None for k, v in values.items()}
    return {"kind": getattr(thing, "__name__", type(thing).__name__), **finite}


def _clock_facts(errors: Errors, begin: float, end: float) -> dict[str, float]:
    """Return the random errors of a run (offsets, velocity noise, clocks) as plain data."""
    middle = motion_clock(np.array([begin, end]), errors).mean()
    return {
        "friction_force_offset_N": errors.friction_force_offset,
        "normal_force_offset_N": errors.normal_force_offset,
        "velocity_noise": errors.velocity_noise,
        "clock_shift_s": errors.clock_shift,
        "clock_rate": errors.clock_rate,
        "clock_shift_at_middle_s": float(errors.clock_shift + errors.clock_rate * middle),
    }
