"""Comparison of the periods from drops and from the spectrum, and class of the oscillation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.components import Component
from tribolab.friction.oscillation.few_periods import SlowWave
from tribolab.friction.oscillation.oscillation import Oscillation
from tribolab.friction.oscillation.regularity import SLIP_KINDS, Regularity, scatter
from tribolab.friction.oscillation.waveform import (
    CLASSES,
    NOT_CLEAR,
    WaveformFeatures,
    most_probable,
)

# start of the remark on a spectrum and drops that differ in period
AT_ODDS = "the spectrum tells a period"


class PeriodVerdict(NamedTuple):
    """Verdict on the periods of a record.

    Parameters
    ----------
    kind
        One of `CLASSES`, or "not decided".
    frequency, frequency_error
        From the drops if these are regular, else from the spectrum [Hz].
    periods
        Number of periods in the record.
    doubt
        Reason why no class is assigned; else empty.
    """

    kind: str
    frequency: float
    frequency_error: float
    periods: float
    doubt: str = ""


def at_odds(oscillation: Oscillation, seen: Regularity) -> bool:
    """Return whether the periods from spectrum and drops differ by more than their errors."""
    periods = seen.periods
    if not periods.size:
        return False
    spread = scatter(periods)
    if spread > limits.MAX_SCATTER_OF_REGULAR_PERIODS.value or not np.isfinite(spread):
        reach = (
            limits.MAX_DIFFERENCE_OF_IRREGULAR_PERIODS.value
            if periods.size > 2
            else limits.MAX_DIFFERENCE_OF_PERIODS.value
        )
        frequency = oscillation.mean_frequency if periods.size > 2 else oscillation.frequency
        error = 0.0
    else:
        reach, frequency = limits.MAX_DIFFERENCE_OF_PERIODS.value, oscillation.frequency
        error = np.hypot(
            spread / np.sqrt(periods.size),
            oscillation.frequency_error / max(oscillation.frequency, 1e-300),
        )
    return bool(
        abs(np.log(frequency * periods.mean()))
        > max(reach, limits.MAX_ERRORS_BETWEEN_PERIODS.value * error)
    )


def period_verdict(
    probability: np.ndarray,
    oscillation: Oscillation,
    seen: Regularity,
    slow: SlowWave | None,
    lines: tuple[Component, ...],
    duration: float,
    form: WaveformFeatures,
) -> PeriodVerdict:
    """Return class and period of an oscillation, if its drops and its spectrum agree.

    Parameters
    ----------
    probability
        Probability of each of `CLASSES`.
    oscillation, seen
        Results of the spectrum, and of the drops.
    slow
        The single slow wave that explains nearly all of the fluctuation, if any.
    lines
        All significant oscillations.
    duration
        Duration of the record [s].
    form
        Waveform of the cycles.
    """
    kind = most_probable(probability)
    periods = seen.periods
    frequency, error = oscillation.frequency, oscillation.frequency_error
    # regular drops give the period better than the spectrum, if the two agree
    odd, significant = (
        at_odds(oscillation, seen),
        oscillation.false_alarm < limits.BAND_BY_CHANCE.value,
    )
    # two frequencies that beat make periods scatter, although both are lines in the spectrum
    several = (
        len(lines) > 1 and lines[1].swing > limits.MIN_SWING_OF_SECOND_LINE.value * lines[0].swing
    )
    irregular = seen.kind == SLIP_KINDS[1] and not several
    sharp = significant and oscillation.share > limits.MIN_SHARE_OF_SHARP_LINE.value
    if irregular and not sharp:  # no clear line in the spectrum
        frequency, error = oscillation.mean_frequency, oscillation.mean_frequency_error
    elif (
        periods.size > 1 and scatter(periods) < limits.MAX_SCATTER_OF_SURE_PERIODS.value and not odd
    ):
        frequency = 1 / float(periods.mean())
        error = frequency * scatter(periods) / np.sqrt(periods.size)
    own = 1 / float(periods.mean()) if irregular else frequency
    count = own * duration
    unclaimed = kind in (CLASSES[0], NOT_CLEAR)
    # if a faster wave has many periods, a slow one below it is drift
    few = slow is not None and count < limits.MIN_CYCLES_PER_SLOW_WAVE.value * slow.periods
    if slow is not None and (
        unclaimed
        or (few and abs(np.log(slow.periods / count)) > limits.MAX_DIFFERENCE_OF_PERIODS.value)
    ):
        return _undecided(
            f"a slow wave of some {slow.periods:.1f} periods, {_TOO_FEW_PERIODS}", slow.periods
        )
    repeats = seen.periods.size > 0 and not odd and seen.kind != SLIP_KINDS[2]
    if (
        kind != CLASSES[0]
        and not (significant or repeats)
        and probability[0] > limits.MAX_CHANCE_OF_SMOOTH_SLIDING.value
    ):
        kind = CLASSES[0]  # neither a line nor repeating drops
    if kind == CLASSES[0] and lines and lines[0].false_alarm < limits.SURE_LINE_BY_CHANCE.value:
        return _undecided(
            f"no drops repeat, but the spectrum has a line at {lines[0].frequency:.4g} Hz"
        )
    if kind == CLASSES[0]:
        return PeriodVerdict(kind, np.nan, np.nan, np.nan)
    if kind == NOT_CLEAR:
        likely = CLASSES[int(np.argmax(probability))]
        return _undecided(f"{likely} is more probable, but smooth sliding not improbable")
    hum = [
        m.name
        for m in oscillation.mains
        if abs(oscillation.frequency / m.frequency - 1) < limits.MAX_DISTANCE_FROM_MAINS.value
    ]
    if hum:
        return _undecided(f"the strongest line stands where the mains hums ({hum[0]})")
    if odd and not several:
        return _undecided(
            f"{AT_ODDS} of {1 / frequency:.3g} s, the drops are {periods.mean():.3g} s apart"
        )
    if kind == CLASSES[2] and (mixed := _mixed(oscillation, lines, form)):
        return _undecided(mixed)
    if count < limits.MIN_CYCLES_IN_RECORD.value:
        # slow drift also has a "period"; it counts only if a single wave explains nearly everything
        known = count if slow is not None else np.nan
        return _undecided(f"only {count:.1f} periods, {_TOO_FEW_PERIODS}", known)
    if (
        not seen.kind
        and significant
        and count >= 2 * limits.MIN_CYCLES_IN_RECORD.value
        and not periods.size
    ):
        # the line is significant, but noise hides the drops
        return PeriodVerdict(kind, frequency, error, count)
    if not seen.kind or (irregular and periods.size < limits.MIN_PERIODS_FOR_SCATTER.value):
        return _undecided("too few drops repeat to tell the period")
    # if the oscillation comes in trains, these also make lines
    trains = seen.kind == SLIP_KINDS[2]
    strongest = lines[0].frequency if several and not trains else frequency
    if abs(np.log(frequency / strongest)) > limits.MAX_DIFFERENCE_OF_PERIODS.value:
        return _undecided(
            f"the drops repeat at {frequency:.4g} Hz, but the oscillation at {strongest:.4g} Hz is "
            "larger: which of them is stick-slip is open"
        )
    return PeriodVerdict(kind, frequency, error, count)


def _mixed(oscillation: Oscillation, lines: tuple[Component, ...], form: WaveformFeatures) -> str:
    """Return the reason why an oscillation is not a single sine; "" if it may be.

    A sine on a larger sawtooth rounds it off, and its line may be the stronger: half of the swing
    of a sawtooth is in its first harmonic.
    """
    uneven = (
        form.asymmetry_p_value < limits.ASYMMETRY_BY_CHANCE.value
        and abs(0.5 - form.fall_share) > limits.MIN_ASYMMETRY.value
    )
    sharp = (
        form.derivative_skewness < limits.MAX_SKEWNESS_OF_SLOPE.value
        and oscillation.harmonic_content > limits.MIN_HARMONICS_OF_DROP.value
    )
    if uneven or sharp:
        return (
            f"like a sine, but friction falls in {form.fall_share:.0%} of each cycle: stick-slip "
            "with another oscillation on it is as likely"
        )
    slower = [
        line
        for line in lines
        if line.frequency < limits.MAX_FREQUENCY_OF_RIVAL.value * oscillation.frequency
        and line.swing > limits.MIN_SWING_OF_RIVAL.value * oscillation.swing
    ]
    if slower:
        return (
            f"a slower oscillation at {slower[0].frequency:.4g} Hz is as large as that at "
            f"{oscillation.frequency:.4g} Hz: which of them is stick-slip is open"
        )
    return ""


_TOO_FEW_PERIODS = "too few to separate an oscillation from slow drift: slide further at this speed"


def _undecided(why: str, periods: float = np.nan) -> PeriodVerdict:
    return PeriodVerdict(NOT_CLEAR, np.nan, np.nan, periods, why)
