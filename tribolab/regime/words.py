"""Text of the verdict on the sliding mode, composed from the evidence."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tribolab.core.wording import Count, speed_text
from tribolab.friction.oscillation.waveform import CLASSES, NOT_CLEAR, oscillating
from tribolab.regime.misfit import SUFFICIENT, is_sufficient
from tribolab.regime.model import LOCAL, SUSPECTED, UNEXPLAINED

if TYPE_CHECKING:
    from tribolab.regime.model import Evidence, Mode

_STEADY, SAW, SINE, REVERSED = CLASSES
_MAX_WAVELENGTH = 0.5e-3  # m; longer waves may be turns of a track or the pitch of a screw
# a wavelength is constant if it varies by less than 1.15 while speeds differ by 1.5 or more
_MIN_SPEED_RATIO, _MAX_LENGTH_RATIO = 1.5, 1.15


def friction_text(value: float) -> str:
    """Return a friction coefficient, or its change, as text with two digits."""
    return f"{value:.2g}"


def percent_text(share: float) -> str:
    """Return a share as text in percent."""
    return f"{100 * share:.2g} %"


def rig_wave_text(slip: xr.Dataset | None) -> str:
    """Return a text on waves that repeat with each turn of the rig; "" without any."""
    if slip is None or "rig_wave" not in slip:
        return ""
    kinds = slip["rig_wave"].values.astype(str)
    seen = kinds != ""
    if not seen.any():
        return ""
    names, counts = np.unique(kinds[seen], return_counts=True)
    what = str(names[np.argmax(counts)]).replace("run-out: ", "run-out of the disc: friction ")
    text = f"{what} at {seen.sum()} of {Count(kinds.size):speed|speeds}"
    swing = slip["rig_swing"].values if "rig_swing" in slip else np.full(kinds.size, np.nan)
    if np.isfinite(swing).any():  # if only forces were measured, the unit differs
        text += f", by up to {friction_text(float(np.nanmax(swing)))}"
    return text


def verdict_text(
    verdict: str, numbers: dict[str, float], slip: xr.Dataset | None, modelled: bool
) -> str:
    """Return the verdict as a sentence."""
    text = _verdict_text(verdict, numbers, slip, modelled)
    return f"{text}; {wave}" if (wave := rig_wave_text(slip)) else text


def _verdict_text(
    verdict: str, numbers: dict[str, float], slip: xr.Dataset | None, modelled: bool
) -> str:
    speeds = np.zeros(0)
    if slip is not None and "waveform" in slip:
        speeds = slip["sliding_speed"].values[oscillating(slip["waveform"].values)]
    where = ""
    if speeds.size == 1:
        where = f" at {speed_text(speeds[0])}"
    elif speeds.size:
        where = f" from {speed_text(speeds.min())} to {speed_text(speeds.max())}"
    if verdict == "no stick-slip":
        off = numbers["model_misfit"]
        steady = "steady sliding, no stick-slip at any speed"
        if slip is not None and (count := int((slip["waveform"].values == NOT_CLEAR).sum())):
            steady = f"steady sliding where it is decided; {count} of "
            steady += f"{Count(slip.sizes['sliding_speed']):speed|speeds} not decided"
        if not modelled or np.isnan(off):
            return steady
        enough = is_sufficient(numbers)
        if enough is None:
            return (
                f"{steady}; the errors are too large to tell whether mixed lubrication explains it"
            )
        if enough:
            within = f"to within {percent_text(SUFFICIENT)} of the peak friction"
            return f"{steady}; mixed lubrication explains it {within}"
        return (
            f"{steady}; mixed lubrication alone does not explain it, and the traces suggest no "
            "other cause"
        )
    low, high = numbers["forced_wetting_low_m_s"], numbers["forced_wetting_high_m_s"]
    end = ""
    if np.isfinite(high):
        end = (
            "; forced wetting (liquid entrainment) is expected to start between "
            f"{speed_text(low)} and {speed_text(high)}"
        )
    if verdict == "not known":
        looked = slip is not None and slip.sizes.get("sliding_speed", 0)
        what = "most traces are inconclusive" if looked else "no trace was evaluated"
        return f"not known: {what}"
    head = f"stick-slip{where}, {verdict}" if verdict == SUSPECTED else f"{verdict}{where}"
    return f"{head}{end}"


def suggestions(
    verdict: str, numbers: dict[str, float], known: Mode, slip: xr.Dataset | None
) -> tuple[str, ...]:
    """Return the measurements that would decide the sliding mode."""
    length = _fixed_wavelength(slip)
    compare: tuple[str, ...] = ()
    if verdict in (SUSPECTED, LOCAL, UNEXPLAINED) and length > _MAX_WAVELENGTH:
        compare = (
            f"compare the wavelength, {1e3 * length:.3g} mm at every speed, with the "
            "circumference of the track (2 π times its radius), the pitch of the drive's screw and "
            "the spacing of its teeth or rollers: if it equals one of these or an integer "
            "fraction of it, the rig causes it and it is not stick-slip",
        )
    return (*compare, *_measurements(verdict, known, slip))


def _fixed_wavelength(slip: xr.Dataset | None) -> float:
    """Return the wavelength [m] common to traces at several speeds; NaN if they differ."""
    if slip is None or "dominant_wavelength" not in slip:
        return np.nan
    moving = oscillating(slip["waveform"].values)
    length, speed = slip["dominant_wavelength"].values[moving], slip["sliding_speed"].values[moving]
    good = np.isfinite(length)
    length, speed = length[good], speed[good]
    if (
        length.size < 2
        or speed.max() < _MIN_SPEED_RATIO * speed.min()
        or length.max() > _MAX_LENGTH_RATIO * length.min()
    ):
        return np.nan
    return float(np.median(length))


def _measurements(verdict: str, known: Mode, slip: xr.Dataset | None) -> tuple[str, ...]:
    if verdict == SUSPECTED:
        advice = [
            "observe the contact through a transparent body: moving detachment folds confirm the "
            "instability, their absence refutes it",
            "measure the pull-off force: it must be finite if γ_eff(1) > 0",
        ]
        if known.fluid:
            advice.append(
                "change the viscosity: the onset of forced wetting shifts with viscosity times "
                "speed, an instability of the rig does not"
            )
        else:
            advice.append(
                "change the stiffness of the rig: the wavelength of stick-slip caused by the rig "
                "changes, that of folds in the contact does not"
            )
        return tuple(advice)
    if verdict == UNEXPLAINED:
        if known.work_of_adhesion is not None:
            return (
                (
                    "change the stiffness or mass of the rig: the frequency of its own vibration "
                    "changes"
                ),
            )
        return (
            "state the inputs of γ_eff(1): scans of the surface, the rubber's modulus, the "
            "medium's work of adhesion",
        )
    if verdict == "local stick-slip":
        return (
            "change the stiffness of the rig: stick-slip caused by the rig changes",
            "measure the pull-off force: it must be zero if γ_eff(1) = 0",
        )
    if verdict == "not known":
        if slip is not None and slip.sizes.get("sliding_speed", 0):
            return (
                (
                    "slide further at each speed: a few periods cannot be distinguished from slow "
                    "drift"
                ),
            )
        return ("record the friction force itself, not only its mean",)
    if known.work_of_adhesion is not None and known.work_of_adhesion > 0:
        return ("slide more slowly: adhesion would allow an instability at lower speeds",)
    return ()


def paragraph(
    name: str,
    text: str,
    evidence: Sequence[Evidence],
    decide: Sequence[str],
    numbers: dict[str, float],
) -> str:
    """Return the verdict, its evidence and decisive measurements as a short paragraph."""
    parts = [f"{name[:1].upper()}{name[1:]}: {text}."]
    for side, opening in (
        ("for", "For an adhesion-controlled mode:"),
        ("against", "Against it:"),
        ("neutral", "Neutral:"),
    ):
        mine = [each.text for each in evidence if each.side == side]
        if mine:
            parts.append(f"{opening} {'; '.join(mine)}.")
    if decide:
        parts.append(f"Deciding measurements: {'; '.join(decide)}.")
    return " ".join(parts)
