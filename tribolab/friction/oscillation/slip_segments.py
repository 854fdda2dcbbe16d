"""Stick-slip of each segment: spectrum, events, and class of waveform."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.friction.coefficient.coefficient import friction_signal
from tribolab.friction.coefficient.segment_samples import belong
from tribolab.friction.decisions.rejected import REJECTED
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.critical_stiffness import STIFFNESS, critical_stiffness
from tribolab.friction.oscillation.examine import Examined, examine_record
from tribolab.friction.oscillation.regularity import SLIP_KINDS
from tribolab.friction.oscillation.rig_waves import RigMotion, RigWave, motion_of, rig_wave
from tribolab.friction.oscillation.signals import SegmentSignal, is_clipped, signals
from tribolab.friction.oscillation.slip_table import (
    class_of,
    class_table,
    event_list,
    line_table,
    oscillates,
    ranked,
    ringing,
    slip_columns,
    spectra_table,
)
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR
from tribolab.units.stamping import stamp

# variables that are in N and named "force_..." if a run has forces only
_IN_SIGNAL_UNIT = (
    "drop",
    "drop_std",
    "oscillation_swing",
    "background_noise",
    "sample_noise",
    "hysteresis",
    "mains_amplitude",
    "rig_swing",
    "loading_slope",
    "event_drop",
    "line_swing",
    "psd",
    "psd_background",
    "psd_significant",
    "distance_psd",
)

_OF_SEGMENTS = (
    *("trimmed_start", "trimmed_stop", "sliding_speed", "direction", "sliding_distance"),
    REJECTED,
)

_REVERSED = (
    "friction falls slowly and rises sharply, as stick-slip does if the sign of the sensor is "
    "reversed: look at the sensor's sense, and set `sign = -1` for the friction force in the "
    "dialect "
    "if it is so"
)


@of_runs
def stick_slip(run: xr.Dataset, segments: xr.Dataset) -> xr.Dataset:
    """Return stick-slip of each segment: spectra, events, and class of waveform.

    Parameters
    ----------
    run
        The run, with ``friction_force`` and ``normal_force``, or ``friction_coefficient``, or
        ``friction_force`` alone.
    segments
        From `find_segments` on the same run; the trimmed part of each is analysed.

    Returns
    -------
    xarray.Dataset
        On dim ``segment``, in addition to ``sliding_speed``, ``direction`` and
        ``sliding_distance``: ``waveform`` (text: one of ``waveform.CLASSES``, "not decided" or "not
        evaluated") and ``class_probability`` (segment, waveform_class); ``regularity`` (text:
        "regular", "irregular" or "intermittent") and ``oscillating_time_share``; ``periods`` in the
        segment; ``dominant_frequency`` [Hz] and ``dominant_wavelength`` [m] of the spectrum (with
        ``_sem``; of the drops if these are regular and agree), ``false_alarm_probability``,
        ``peak_prominence``, ``oscillation_swing``, ``oscillation_share``, ``background_noise``,
        ``sample_noise``, ``harmonic_content``; ``events`` (their number), mean and scatter of
        ``drop``, ``stick_duration``, ``slip_duration``, ``recurrence_time`` [s],
        ``recurrence_distance`` [m], ``loading_slope`` [1/m], ``loading_stiffness`` [N/m],
        ``critical_stiffness_low`` and ``_high`` [N/m] (bounds, of regular sawtooth stick-slip, with
        the attribute ``stiffness_N_m`` of the run if there is one; see
        `tribolab.friction.oscillation.critical_stiffness`); ``fall_share``, ``asymmetry_p_value``,
        ``derivative_skewness``, ``period_scatter``, ``drop_scatter``; ``mains_frequency``,
        ``mains_amplitude``, ``rig_swing`` (of waves that repeat with each turn), ``spike_share``;
        ``instrument`` (text: mains, run-out and resonances), ``method``, ``remark`` (text). If the
        class is smooth sliding or not decided, only the columns that describe the noise are
        numbers; ``oscillation_swing`` is then the upper limit of an undetected oscillation. On
        (segment, line), the strongest first: ``line_frequency`` [Hz], ``line_wavelength`` [m],
        ``line_swing``, ``line_false_alarm_probability`` of all oscillations that are significant.
        On (segment, frequency): ``psd``, ``psd_background``, ``psd_significant`` [1/Hz]; on
        (segment, inverse_wavelength): ``distance_psd`` [m]. On dim ``event``: ``event_segment``,
        ``event_time`` [s], ``event_drop``, ``event_stick``, ``event_slip`` [s]. For a run with
        forces only, variables in the signal's unit are named ``force_...``.

    Raises
    ------
    AnalysisError
        If the run has no friction or the segments are another run's.

    Notes
    -----
    Other modules of `tribolab.friction.oscillation`: the spectrum, its background and significance
    (`oscillation`), `events`, the class and its limits (`waveform`). Distance is speed times time,
    S_x(1/lambda) = v S(f) with 1/lambda = f/v: a segment has one speed. Periods are counted from
    the middle of one sharp fall to that of the next (of a reversed sawtooth, of its rises), pauses
    left out. The mean drop of ten cycles at an amplitude three times the noise is known to some 5 %
    (``tests/detection/stick_slip_table.py``). Irregular stick-slip has no period: its dominant
    wavelength is that of the mean frequency of its spectrum (`oscillation.mean_frequency`), or of
    its sharp line, if any; the mean distance between drops is ``recurrence_distance``. Spectrum and
    drops must agree on the period within 15 % or three errors (if periods scatter, within a factor
    of 1.8), and the segment must contain four periods: else the class is "not decided", and the
    remark gives the reason. An oscillation with fewer than four periods is not distinguished from
    slow drift. Lines of the mains, and waves that repeat with each turn of a rig whose rotation is
    known (`tribolab.friction.oscillation.rig_waves`), are removed first and listed in
    ``instrument``; an oscillation that keeps its frequency within 3 % over speeds that differ by a
    factor of two or more is listed as a resonance.

    Examples
    --------
    >>> from tribolab.friction.segments.find import find_segments
    >>> import xarray as xr
    >>> t = np.arange(4000) / 100
    >>> run = xr.Dataset(
    ...     {
    ...         "friction_coefficient": ("time", 0.5 + 0.1 * (t % 1.0)),
    ...         "sliding_velocity": ("time", np.full(4000, 1e-5)),
    ...     },
    ...     {"time": t},
    ... )
    >>> found = stick_slip(run, find_segments(run))
    >>> found.waveform.item(), round(found.dominant_wavelength.item() * 1e6, 2)
    ('sawtooth stick-slip', 10.0)
    """
    belong(run, segments)
    speed = segments["sliding_speed"].values.astype(float)
    force = friction_signal(run) == "friction_force" and "normal_force" not in run
    motion = motion_of(run)
    examined, loads, remarks, waves = [], [], [], []
    for signal, v in zip(signals(run, segments), speed, strict=True):
        values, wave = _without_rig_wave(signal, motion)
        seen = examine_record(signal.time, values, force=force)
        examined.append(seen)
        loads.append(signal.load)
        waves.append(wave)
        remarks.append(_remark(seen, is_clipped(signal.raw), v))
    data = slip_columns(examined, speed, np.array(loads))
    saw = (data["waveform"] == CLASSES[1]) & (data["regularity"] == SLIP_KINDS[0])
    # if unknown, the steepest rise is used
    rig = np.full(saw.size, run.attrs.get(STIFFNESS, np.nan))
    bounds = critical_stiffness(
        data["drop"], data["recurrence_distance"],
        np.where(np.isnan(rig), data["loading_stiffness"], rig),
        1.0 if force else np.array(loads), np.where(saw, data["events"], 0),
    )  # fmt: skip
    data["critical_stiffness_low"], data["critical_stiffness_high"] = bounds
    data["rig_swing"] = np.array([np.nan if wave is None else wave.swing for wave in waves])
    data["instrument"] = _texts(_instrument(examined, speed, waves, motion))
    data["remark"] = _texts(remarks)
    data |= {name: segments[name].values for name in _OF_SEGMENTS if name in segments}
    classes = {"class_probability": (("segment", "waveform_class"), class_table(examined))}
    tables = spectra_table(examined, speed), event_list(examined), line_table(examined, speed)
    # assigned as variables at once: each merge would compare the coordinates again
    further = {name: table.variables[name] for table in tables for name in table.data_vars}
    coords: dict[object, object] = {"segment": segments["segment"].values}
    coords |= {name: table.variables[name] for table in tables for name in table.coords}
    coords |= {"waveform_class": np.array(CLASSES, dtype=object)}
    columns = {name: ("segment", values) for name, values in data.items()}
    result = xr.Dataset(columns | classes | further, coords)
    if force:
        names = {name: f"force_{name}" for name in _IN_SIGNAL_UNIT if name in result}
        result = result.rename(names)
    return stamp(result, **run.attrs)


def _texts(values: list[str]) -> np.ndarray:
    return np.array(values, dtype=object)


def _remark(seen: Examined | str, cut: bool, speed: float) -> str:
    if isinstance(seen, str):
        return seen
    words = ["the signal is cut off at its extremes: drops are lower bounds"] if cut else []
    if not np.isfinite(speed):
        words.append("the sliding speed is not known: start, stop or rest may lie in the segment")
    if seen.verdict.kind == NOT_CLEAR:
        return "; ".join([*words, f"not decided: {seen.verdict.doubt}"])
    words += _form_words(seen, speed)
    second = ranked(seen)[1]
    if class_of(seen) == CLASSES[0] and second[1] > limits.MAX_DOUBT.value:
        words.append(f"{second[0]} is not excluded (probability {second[1]:.2f})")
        if seen.oscillation.share < 0.5:
            words.append("noise and spikes hold more of the fluctuation")
    return "; ".join(words)


def _form_words(examined: Examined, speed: float) -> list[str]:
    """Return remarks on special features of an oscillation that is reported."""
    if not oscillates(examined):
        return []
    words, seen = [], examined.regularity
    if class_of(examined) == CLASSES[3]:
        words.append(_REVERSED)
    if class_of(examined) == CLASSES[2] and examined.oscillation.share < 0.5:
        words.append("noise and spikes hold more of the fluctuation than the oscillation")
    if seen.kind == SLIP_KINDS[2]:
        words.append(f"oscillates {seen.share:.0%} of the time")
    if seen.kind == SLIP_KINDS[1] and speed > 0:
        spectral = 1e6 * speed / examined.verdict.frequency
        apart = 1e6 * speed * float(seen.periods.mean())
        words.append(
            f"periods scatter by {examined.waveform.period_scatter:.0%}: drops are {apart:.3g} µm "
            f"apart in the mean, the spectrum tells a wavelength of {spectral:.3g} µm"
        )
    if len(examined.lines) > 1:
        listed = ", ".join(f"{line.frequency:.4g} Hz" for line in examined.lines)
        words.append(f"{len(examined.lines)} frequencies, the strongest first: {listed}")
    return words


def _without_rig_wave(
    signal: SegmentSignal, motion: RigMotion | None
) -> tuple[np.ndarray, RigWave | None]:
    """Return a segment minus waves that repeat with each turn or stroke of a rig, and the waves."""
    if motion is None:
        return signal.values, None
    good = np.isfinite(signal.values)
    angle = motion.angle(signal.time, signal.part)
    if good.all():
        wave = rig_wave(signal.values, angle)
        return (signal.values if wave is None else signal.values - wave.signal), wave
    wave = rig_wave(signal.values[good], angle[good])
    values = signal.values.copy()
    if wave is not None:
        values[good] -= wave.signal
    return values, wave


def _instrument(
    examined: list[Examined | str],
    speed: np.ndarray,
    waves: list[RigWave | None],
    motion: RigMotion | None,
) -> list[str]:
    """Return texts on oscillations due to the instrument: mains, turns, speed-independent lines."""
    kind = np.array([class_of(e) for e in examined], dtype=object)
    own = np.array([np.nan if isinstance(e, str) else e.oscillation.frequency for e in examined])
    texts = []
    for e, wave, rings in zip(examined, waves, ringing(kind, own, speed), strict=True):
        if isinstance(e, str):
            texts.append("")
            continue
        names = [f"mains at {line.name}" for line in e.oscillation.mains]
        if wave is not None and motion is not None:
            names.append(wave.words(motion.what))
            names += ["faster than half the record's rate, so it shows slower"] * wave.undersampled
        if rings:
            names.append(f"resonance at {e.oscillation.frequency:.4g} Hz")
        texts.append("; ".join(names))
    return texts
