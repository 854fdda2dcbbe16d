"""Functions that put a fault into the logs of a run; `tribolab.rig.faults` lists the faults.

Every function takes a run and a random generator, draws how strong the fault is, and returns the
force log, the motion log, and the facts on the fault. The run itself does not change.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import ConfigError
from tribolab.core.untyped import Json
from tribolab.core.wording import Count
from tribolab.rig.simulated import SimulatedRun

StrikeFacts = Json
Struck = tuple[xr.Dataset, xr.Dataset, StrikeFacts]
_UNLOADED = 0.05  # share of the largest normal force below which the contact is unloaded
_FAST = 130.0  # lowest sampling rate [Hz] that resolves mains hum and resonance


def _typical(run: SimulatedRun) -> float:
    """Return the mean magnitude of the friction force within the segments [N]."""
    mean = float(np.abs(run.segments["friction_coefficient"]).mean())
    return mean * float(run.facts["normal_force_N"])


def _force(run: SimulatedRun, values: np.ndarray, facts: StrikeFacts) -> Struck:
    """Return the logs of a run with another friction force, and the facts."""
    return run.force_log.assign(friction_force=("time", values)), run.motion_log, facts


def _normal(run: SimulatedRun, values: np.ndarray, facts: StrikeFacts) -> Struck:
    """Return the logs of a run with another normal force, and the facts."""
    return run.force_log.assign(normal_force=("time", values)), run.motion_log, facts


def _replace_times(run: SimulatedRun, time: np.ndarray, facts: StrikeFacts) -> Struck:
    """Return the logs of a run with other times of the force log, and the facts."""
    return run.force_log.assign_coords(time=time), run.motion_log, facts


def _keep_rows(run: SimulatedRun, keep: np.ndarray, facts: StrikeFacts) -> Struck:
    """Return the logs of a run with only some rows of the force log, and the facts."""
    return run.force_log.isel(time=keep), run.motion_log, facts


def _rows(run: SimulatedRun, stroke: int) -> slice:
    """Return the rows of the force log that belong to a segment."""
    row = run.segments.iloc[stroke]
    first, last = np.searchsorted(run.force_log.time.values, [row.start_s, row.stop_s])
    return slice(int(first), int(last))


def _interval(run: SimulatedRun) -> np.ndarray:
    """Return the sampling interval after each row [s]; NaN after the last."""
    return np.diff(run.force_log.time.values, append=np.nan)


def load_sign(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Reverse the sign of the normal force that a zeroed cell records.

    Its readings at rest are then on both sides of zero. If all readings were negative, the reader
    would refuse the file before any check.
    """
    values = run.force_log.normal_force.values
    size = np.abs(values)
    zero = float(np.median(values[size < _UNLOADED * size.max()]))
    return _normal(run, zero - values, {"zero_N": zero})


def time_back(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Set the clock of the force logger back by some seconds during the run."""
    time = run.force_log.time.values.copy()
    row, step = int(rng.uniform(0.2, 0.8) * time.size), float(rng.uniform(1, 4))
    time[row:] -= step
    return _replace_times(run, time, {"row": row, "step_s": step})


def restart(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Restart the clock of the force logger at zero during the run."""
    time = run.force_log.time.values.copy()
    row = int(rng.uniform(0.2, 0.8) * time.size)
    time[row:] -= time[row]
    return _replace_times(run, time, {"row": row})


def lose_stretches(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Remove three intervals from the force log."""
    time = run.force_log.time.values
    starts = np.sort(rng.uniform(0.2, 0.7, 3)) * time[-1]
    lengths = rng.uniform(1.5, 4.0, 3)
    keep = np.ones(time.size, dtype=bool)
    for start, length in zip(starts, lengths, strict=True):
        keep &= (time < start) | (time > start + length)
    return _keep_rows(run, keep, {"start_s": starts.tolist(), "length_s": lengths.tolist()})


def jitter(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Shift each time stamp at random within its sampling interval."""
    time = run.force_log.time.values
    step = np.diff(time)
    shorter = np.minimum(np.append(step, step[-1]), np.insert(step, 0, step[0]))
    moved = np.round(time + 0.45 * shorter * rng.uniform(-1, 1, time.size), 5)
    moved[0] = 0.0
    return _replace_times(run, np.maximum.accumulate(moved), {"largest_part_of_interval": 0.45})


def rate_switch(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Lower the sampling rate in the second half of one segment."""
    stroke, factor = int(rng.integers(len(run.segments))), int(rng.integers(3, 6))
    rows = _rows(run, stroke)
    keep = np.ones(run.force_log.sizes["time"], dtype=bool)
    middle = (rows.start + rows.stop) // 2
    keep[middle : rows.stop] = np.arange(rows.stop - middle) % factor == 0
    return _keep_rows(run, keep, {"segment": stroke, "factor": factor})


def dropouts(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Remove single values of the friction force."""
    values = run.force_log.friction_force.values.copy()
    share = float(rng.uniform(0.01, 0.04))
    values[rng.random(values.size) < share] = np.nan
    return _force(run, values, {"share": share})


def frozen(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Hold the friction force at one value for some time."""
    values = run.force_log.friction_force.values.copy()
    length = int(rng.uniform(0.02, 0.05) * values.size)
    row = int(rng.uniform(0.1, 0.8) * values.size)
    values[row : row + length] = values[row]
    return _force(run, values, {"row": row, "samples": length})


def saturate(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Clip the friction force at both ends of the measuring range."""
    highest = float(np.abs(run.noise_free.friction_force.values).max())
    limit = float(rng.uniform(0.6, 0.8)) * highest
    values = np.clip(run.force_log.friction_force.values, -limit, limit)
    return _force(run, values, {"limit_N": limit})


def coarse_digits(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Round the friction force to a resolution of 9 bits."""
    step = 1000 / 2**9
    values = np.round(run.force_log.friction_force.values / step) * step
    return _force(run, values, {"step_N": step})


def add_spikes(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add spikes (single outliers) to the friction force."""
    values = run.force_log.friction_force.values.copy()
    rows = np.sort(rng.choice(np.arange(10, values.size - 10, 10), int(rng.integers(4, 13))))
    height = np.maximum(rng.uniform(0.2, 0.6, rows.size) * _typical(run), 2.0)
    values[rows] += height * rng.choice([-1, 1], rows.size)
    return _force(run, values, {"rows": rows.tolist(), "height_N": height.tolist()})


def zero_offset(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add a constant to the friction force."""
    # exceeds the offset of the cell itself, which may have the opposite sign
    offset = float(rng.choice([-1, 1]) * (rng.uniform(0.8, 1.5) * _typical(run) + 4.0))
    return _force(run, run.force_log.friction_force.values + offset, {"offset_N": offset})


def zero_drift(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add a linear drift to the friction force."""
    time = run.force_log.time.values
    drift = float(rng.choice([-1, 1]) * (rng.uniform(0.2, 0.4) * _typical(run) + 0.6))
    values = run.force_log.friction_force.values + drift * time / time[-1]
    return _force(run, values, {"drift_N": drift})


def load_error(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Multiply the normal force by a factor."""
    factor = float(rng.choice([-1, 1]) * rng.uniform(0.06, 0.10) + 1)
    return _normal(run, factor * run.force_log.normal_force.values, {"factor": factor})


def load_hunting(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add an oscillation to the normal force and, in proportion, to the friction force."""
    time = run.force_log.time.values
    part, frequency = float(rng.uniform(0.06, 0.12)), float(rng.uniform(0.5, 2.0))
    wave = part * np.sin(2 * np.pi * frequency * time)
    log = run.force_log.assign(
        normal_force=run.force_log.normal_force + wave * run.noise_free.normal_force.values,
        friction_force=run.force_log.friction_force + wave * run.noise_free.friction_force.values,
    )
    return log, run.motion_log, {"part": part, "frequency_Hz": frequency}


def slow_table(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Make the set speed higher than the actual speed of the table."""
    factor = float(rng.uniform(0.88, 0.95))
    motion = run.motion_log.assign(set_speed=run.motion_log.set_speed / factor)
    return run.force_log, motion, {"factor": factor}


def encoder_scale(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Multiply the position by a factor."""
    factor = float(rng.choice([-1, 1]) * rng.uniform(0.05, 0.12) + 1)
    motion = run.motion_log.assign(position=run.motion_log.position * factor)
    return run.force_log, motion, {"factor": factor}


def wrong_motion(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Reverse the order of the motion log in time."""
    motion = run.motion_log
    time = motion.time.values
    turned = motion.isel(time=slice(None, None, -1)).assign_coords(
        time=np.round(time[0] + time[-1] - time[::-1], 5)
    )
    return run.force_log, turned.assign(sliding_velocity=-turned.sliding_velocity), {}


def _wave(run: SimulatedRun, amplitude: float, frequency: float, phase: float) -> np.ndarray:
    """Return a sine wave as a logger records it, averaged over its sampling interval."""
    seen = np.nan_to_num(np.sinc(frequency * _interval(run)))
    time = run.force_log.time.values
    return amplitude * seen * np.sin(2 * np.pi * frequency * time + phase)


def hum(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add 50 Hz mains hum to the friction force, as far as the logger resolves it."""
    _fast_speeds(run, "hum", 1)
    amplitude = float(rng.uniform(0.06, 0.25)) * _typical(run)
    values = run.force_log.friction_force.values
    values = values + _wave(run, amplitude, 50.0, float(rng.uniform(0, 2 * np.pi)))
    return _force(run, values, {"amplitude_N": amplitude})


def resonance(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add an oscillation of the friction force whose frequency does not depend on speed."""
    _fast_speeds(run, "resonance", 2)
    amplitude = float(rng.uniform(0.06, 0.25)) * _typical(run)
    frequency = float(rng.uniform(15, 40))
    values = run.force_log.friction_force.values
    values = values + _wave(run, amplitude, frequency, float(rng.uniform(0, 2 * np.pi)))
    return _force(run, values, {"amplitude_N": amplitude, "frequency_Hz": frequency})


def _fast_speeds(run: SimulatedRun, name: str, wanted: int) -> None:
    """Raise unless enough speeds are sampled fast enough for the check to see an oscillation."""
    interval = _interval(run)
    speeds = []
    for stroke, speed in enumerate(run.segments["sliding_speed_m_s"]):
        rows = _rows(run, stroke)
        if rows.stop - rows.start > 320 and np.median(interval[rows]) < 1 / _FAST:
            speeds.append(float(speed))
    if not speeds or (wanted > 1 and max(speeds) < 2 * min(speeds)):
        raise ConfigError(
            f"fault '{name}' does not show in this run: its log is faster than {_FAST:g} Hz at "
            f"{Count(len(set(speeds))):speed|speeds}, {wanted} are wanted (with "
            "--small there is one)"
        )


def sign(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Reverse the sign of the friction force."""
    return _force(run, -run.force_log.friction_force.values, {})


def _progress(run: SimulatedRun) -> np.ndarray:
    """Return for each row the share (0 to 1) of its segment that has passed; else NaN."""
    time = run.force_log.time.values
    result = np.full(time.size, np.nan)
    for stroke in range(len(run.segments)):
        rows, row = _rows(run, stroke), run.segments.iloc[stroke]
        result[rows] = (time[rows] - row.start_s) / (row.stop_s - row.start_s)
    return result


def run_in(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Change the friction force linearly along each segment, as in running-in."""
    part = float(rng.choice([-1, 1]) * rng.uniform(0.2, 0.4))
    change = part * np.nan_to_num(_progress(run) - 0.5) * run.noise_free.friction_force.values
    return _force(run, run.force_log.friction_force.values + change, {"change": part})


def long_wave(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Add to the friction force a wave with three to four periods along each segment."""
    part, periods = float(rng.uniform(0.12, 0.25)), float(rng.uniform(3.2, 4.2))
    phase = float(rng.uniform(0, 2 * np.pi))
    wave = np.nan_to_num(np.sin(2 * np.pi * periods * _progress(run) + phase))
    change = part * wave * run.noise_free.friction_force.values
    facts = {"part": part, "periods": periods}
    return _force(run, run.force_log.friction_force.values + change, facts)


def slow_logger(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Remove rows of the force log, so that stick-slip has only 3 to 5 samples per period."""
    strong = 0.12 * float(run.segments["friction_coefficient"].mean())
    slip = run.segments[run.segments["stick_slip_drop"] > strong]
    if slip.empty:
        raise ConfigError("fault 'slow_logger' needs a speed at which there is strong stick-slip")
    interval = _interval(run)
    period = (slip["stick_slip_wavelength_m"] / slip["sliding_speed_m_s"]).to_numpy(dtype=float)
    per_period = [
        float(p / np.median(interval[_rows(run, stroke)]))
        for stroke, p in zip(slip.index.to_numpy(dtype=int), period, strict=True)
    ]
    wanted = float(rng.uniform(3.0, 5.0))  # samples per period of the fastest stick-slip
    every = max(2, round(min(per_period) / wanted))
    keep = np.arange(interval.size) % every == 0
    return _keep_rows(run, keep, {"every": every, "samples_per_period": min(per_period) / every})


def rectifier(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Replace the friction force by its magnitude after zeroing, as a rectifier does."""
    values = run.force_log.friction_force.values
    load = np.abs(run.force_log.normal_force.values)
    rest = load < _UNLOADED * load.max()
    zero = float(np.median(values[rest]))
    return _force(run, np.abs(values - zero), {"zero_N": zero})


def one_way(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Keep a single loaded stroke, so that the zero of the friction force cannot be found."""
    row = run.segments.iloc[int(rng.integers(len(run.segments)))]
    first, last = float(row.start_s) - 1.0, float(row.stop_s) + 1.0
    shift = float(run.facts["clock_shift_at_middle_s"])

    def cut(log: xr.Dataset, later: float) -> xr.Dataset:
        time = log.time.values + later
        return log.isel(time=(time >= first) & (time <= last))

    facts = {"start_s": first, "stop_s": last}
    return cut(run.force_log, 0.0), cut(run.motion_log, shift), facts


def ramps(run: SimulatedRun, rng: np.random.Generator) -> Struck:
    """Increase the speed within each stroke from a fifth of its mean to almost twice the mean."""
    low = float(rng.uniform(0.1, 0.3))
    motion, shift = run.motion_log, float(run.facts["clock_shift_s"])
    time, velocity = motion.time.values + shift, motion.sliding_velocity.values.copy()
    segments = run.segments[["start_s", "stop_s"]].to_numpy(dtype=float)
    for start, stop in segments:
        inside = (time >= start) & (time <= stop)
        share = (time[inside] - start) / (stop - start)
        velocity[inside] *= low + 2 * (1 - low) * share
    return run.force_log, motion.assign(sliding_velocity=("time", velocity)), {"lowest": low}
