"""Faults of real rigs that can be added to simulated runs, each with the check that finds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from tribolab.arrays.broadcasting import of_lists
from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.rig import strikes
from tribolab.rig.simulated import SimulatedRun


@dataclass(frozen=True)
class Fault:
    """Fault in the logs of a run, and the check that must find it.

    Attributes
    ----------
    name
        As in ``tribolab.rig.simulate_campaign(folder, faults=[NAME])``.
    what
        Effect, in a sentence.
    severity
        Expected status of the check: "suspect" or "fail"; "unreadable" if the file cannot be read.
    check
        Name of the check on runs that should find it.
    strike
        Function ``strike(run, rng)`` that returns force log, motion log, and facts on the fault.
    surface, medium
        Surface and medium to which the fault is limited; "" for any.

    Examples
    --------
    >>> fault = FAULTS["slow_logger"]
    >>> fault.check, fault.suits("Smooth", "dry"), fault.suits("Sb-R", "dry")
    ('sampling', True, False)
    """

    name: str
    what: str
    severity: str
    check: str
    strike: Callable[[SimulatedRun, np.random.Generator], strikes.Struck]
    surface: str = ""
    medium: str = ""

    def suits(self, surface: str, medium: str) -> bool:
        """Whether the fault can occur on a given surface in a given medium."""
        return self.surface in ("", surface) and self.medium in ("", medium)


@of_lists("run", paired="faults")
def inject(
    run: SimulatedRun, faults: str | Iterable[str], rng: int | np.random.Generator = 0
) -> SimulatedRun:
    """Return a run with faults in its logs; ``facts["faults"]`` lists them.

    Parameters
    ----------
    run
        A simulated run, not changed. A list of runs gives a list.
    faults
        Names of faults, in the order of application; for a list of runs, a list for each run.
    rng
        Seed or generator.

    Raises
    ------
    ConfigError
        If a fault is unknown, or cannot occur in this run.

    Examples
    --------
    >>> from tribolab.rig.parameters import Protocol, Rig
    >>> from tribolab.rig.runs import simulate_run
    >>> run = simulate_run(rig=Rig(Protocol(speeds=(1e-4,))))
    >>> inject(run, "frozen").facts["faults"][0]["check"]
    'stuck'
    """
    rng = np.random.default_rng(rng)
    for name in [faults] * bool(faults) if isinstance(faults, str) else faults:
        fault = known_fault(name)
        surface, medium = str(run.facts["surface"]), str(run.facts["medium"])
        if not fault.suits(surface, medium):
            raise ConfigError(
                f"fault '{name}' happens on {fault.surface} {fault.medium} only, "
                f"not on {surface} {medium}"
            )
        force_log, motion_log, facts = fault.strike(run, rng)
        entry = {"name": name, "what": fault.what, "severity": fault.severity}
        listed = [*run.facts.get("faults", []), {**entry, "check": fault.check, **facts}]
        run = replace(
            run, force_log=force_log, motion_log=motion_log, facts={**run.facts, "faults": listed}
        )
    return run


def known_fault(name: str) -> Fault:
    """Return the fault with a given name; raise if there is none."""
    if name not in FAULTS:
        raise ConfigError(f"the rig has no fault '{shown(name)}'{nearest(name, FAULTS, most=None)}")
    return FAULTS[name]


_ALL = (
    Fault("load_sign", "The normal force is wired backwards.", "fail", "schema", strikes.load_sign),
    Fault(
        "time_back",
        "A time server sets the force logger's clock back in the middle of the run.",
        "unreadable",
        "time_order",
        strikes.time_back,
    ),
    Fault(
        "gaps",
        "The logger loses three stretches of seconds.",
        "suspect",
        "time_gaps",
        strikes.lose_stretches,
    ),
    Fault(
        "jitter",
        "A busy computer stamps the samples anywhere within their intervals.",
        "suspect",
        "time_jitter",
        strikes.jitter,
    ),
    Fault(
        "rate_switch",
        "The logger changes its rate in the middle of a segment.",
        "suspect",
        "rate_changes",
        strikes.rate_switch,
    ),
    Fault(
        "restart",
        "The logger restarts in the same file, its clock at zero.",
        "unreadable",
        "restarts",
        strikes.restart,
    ),
    Fault(
        "dropouts",
        "Single samples of the force have no value.",
        "suspect",
        "missing",
        strikes.dropouts,
    ),
    Fault("frozen", "The force repeats one value for a while.", "fail", "stuck", strikes.frozen),
    Fault(
        "saturation",
        "The amplifier's range ends below the largest friction.",
        "fail",
        "saturation",
        strikes.saturate,
    ),
    Fault(
        "coarse",
        "The converter resolves 9 bits of its range.",
        "suspect",
        "quantisation",
        strikes.coarse_digits,
    ),
    Fault(
        "spikes",
        "A switch nearby puts spikes on the force.",
        "suspect",
        "spikes",
        strikes.add_spikes,
    ),
    Fault(
        "zero_offset",
        "The force cell was not zeroed: it reads as much as the friction when nothing slides.",
        "suspect",
        "zero_offset",
        strikes.zero_offset,
    ),
    Fault(
        "zero_drift",
        "The amplifier warms up during the run.",
        "suspect",
        "zero_drift",
        strikes.zero_drift,
    ),
    Fault(
        "load_error",
        "The load cell's calibration is wrong by some percent.",
        "suspect",
        "normal_force_error",
        strikes.load_error,
    ),
    Fault(
        "load_hunting",
        "The load control hunts around its set-point.",
        "suspect",
        "normal_force_scatter",
        strikes.load_hunting,
    ),
    Fault(
        "slow_table",
        "The table does not reach its set speed.",
        "suspect",
        "velocity_set",
        strikes.slow_table,
    ),
    Fault(
        "encoder_scale",
        "The position has a wrong scale.",
        "suspect",
        "velocity_position",
        strikes.encoder_scale,
    ),
    Fault(
        "wrong_motion",
        "The motion log is that of a run with the speeds in falling order.",
        "fail",
        "clock_shift",
        strikes.wrong_motion,
    ),
    Fault("hum", "A ground loop: 50 Hz on the force.", "suspect", "hum", strikes.hum),
    Fault(
        "resonance",
        "The rig rings at its own frequency.",
        "suspect",
        "resonance",
        strikes.resonance,
    ),
    Fault("sign", "The friction force is wired backwards.", "fail", "friction_sign", strikes.sign),
    Fault(
        "run_in", "Friction changes along every stroke.", "suspect", "steadiness", strikes.run_in
    ),
    Fault(
        "long_wave",
        "Friction waves with a period hardly shorter than the stroke.",
        "suspect",
        "distance",
        strikes.long_wave,
    ),
    Fault(
        "slow_logger",
        "The force logger is too slow for the stick-slip.",
        "suspect",
        "sampling",
        strikes.slow_logger,
        surface="Smooth",
        medium="dry",
    ),
    Fault(
        "ramps",
        "The motor never holds its speed: it rises along every stroke.",
        "suspect",
        "segments",
        strikes.ramps,
    ),
    Fault(
        "one_way",
        "One loaded stroke is all that was logged: nothing tells the zero of the force.",
        "suspect",
        "zero_reference",
        strikes.one_way,
    ),
    Fault(
        "rectifier",
        "The amplifier hands on the magnitude of the friction force.",
        "suspect",
        "rectified",
        strikes.rectifier,
    ),
)
FAULTS: dict[str, Fault] = {fault.name: fault for fault in _ALL}
