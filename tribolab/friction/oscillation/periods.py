"""Whether drops and spectrum agree on a period, and what may be claimed if they do not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.friction.oscillation.components import Component
from tribolab.friction.oscillation.few_periods import SlowWave
from tribolab.friction.oscillation.oscillation import CYCLES, Oscillation
from tribolab.friction.oscillation.regularity import (
    IRREGULAR,
    SLIP_KINDS,
    Regularity,
    scatter,
)
from tribolab.friction.oscillation.spectrum.survey import CHANCE
from tribolab.friction.oscillation.waveform import (
    CLASSES,
    NOT_CLEAR,
    WaveformFeatures,
    most_probable,
)

AT_ODDS = "the spectrum tells a period"  # begins the remark that drops tell another one
ALIKE = 0.12  # a scatter of periods above which cycles may have been missed or split
_AGREE = 0.15  # drops and spectrum agree on the period to this
_LOOSE = 0.6  # natural log; the mean over a broad spectrum is not the mean distance between drops
_ERRORS = 3.0
_STRONG = 0.25  # of the strongest line's swing, that makes another one beat with it
_SHARP = 0.7  # part of the faster variance, above which a line is sharp however periods scatter
_MAINS = 0.03  # relative; an oscillation so near to a line of the mains is not told from it
_UNLIKELY = 0.03  # probability of smooth sliding, below which something is there
_SURE_LINE = 1e-6  # chance of a line in noise: many bands may show one
_FASTER = 5.0  # than a slow wave: no harmonic of it
_FEWEST = 4  # periods that tell how they scatter
_SKEW = 0.15  # of a cycle, by which its fall is shorter or longer than half, of no sine ...
_SURE_SKEW = 0.01  # ... where the sign test over the cycles is as sure
_SHARPER, _HARMONICS = -0.5, 0.6  # skewness of the derivative with such harmonics: it drops
_SLOWER, _ALIKE_SWING = 0.7, 0.6  # of frequency and swing: a slower line that counts as much


class PeriodVerdict(NamedTuple):
    """What is claimed of a record.

    Parameters
    ----------
    kind
        One of `CLASSES`, or "not decided".
    frequency, frequency_error
        By the drops where they are alike, by the spectrum else [Hz].
    periods
        In the record.
    doubt
        Why nothing is claimed; empty where something is.
    """

    kind: str
    frequency: float
    frequency_error: float
    periods: float
    doubt: str = ""


def at_odds(oscillation: Oscillation, seen: Regularity) -> bool:
    """Whether spectrum and drops tell different periods, beyond their errors."""
    periods = seen.periods
    if not periods.size:
        return False
    spread = scatter(periods)
    if spread > IRREGULAR or not np.isfinite(spread):
        reach = _LOOSE if periods.size > 2 else _AGREE
        frequency = oscillation.mean_frequency if periods.size > 2 else oscillation.frequency
        error = 0.0
    else:
        reach, frequency = _AGREE, oscillation.frequency
        error = np.hypot(
            spread / np.sqrt(periods.size),
            oscillation.frequency_error / max(oscillation.frequency, 1e-300),
        )
    return bool(abs(np.log(frequency * periods.mean())) > max(reach, _ERRORS * error))


def period_verdict(
    probability: np.ndarray,
    oscillation: Oscillation,
    seen: Regularity,
    slow: SlowWave | None,
    lines: tuple[Component, ...],
    duration: float,
    form: WaveformFeatures,
) -> PeriodVerdict:
    """Say what is claimed, by the class's probabilities and where drops and spectrum agree.

    Parameters
    ----------
    probability
        Of each of `CLASSES`.
    oscillation, seen
        What the spectrum says, and the drops.
    slow
        The one slow wave that nearly all of the fluctuation is, if there is one.
    lines
        All significant oscillations.
    duration
        Of the record [s].
    form
        Of the cycles.
    """
    kind = most_probable(probability)
    periods = seen.periods
    frequency, error = oscillation.frequency, oscillation.frequency_error
    # drops tell the period better than the spectrum, where periods are alike and the two agree
    odd, significant = at_odds(oscillation, seen), oscillation.false_alarm < CHANCE
    # where two frequencies beat, periods scatter, and yet there are lines
    several = len(lines) > 1 and lines[1].swing > _STRONG * lines[0].swing
    irregular = seen.kind == SLIP_KINDS[1] and not several
    sharp = significant and oscillation.share > _SHARP
    if irregular and not sharp:  # no line in the spectrum to speak of
        frequency, error = oscillation.mean_frequency, oscillation.mean_frequency_error
    elif periods.size > 1 and scatter(periods) < ALIKE and not odd:
        frequency = 1 / float(periods.mean())
        error = frequency * scatter(periods) / np.sqrt(periods.size)
    own = 1 / float(periods.mean()) if irregular else frequency
    count = own * duration
    unclaimed = kind in (CLASSES[0], NOT_CLEAR)
    # beside many periods of a wave, a slow one is the wander that they ride on
    few = slow is not None and count < _FASTER * slow.periods
    if slow is not None and (unclaimed or (few and abs(np.log(slow.periods / count)) > _AGREE)):
        return _withheld(f"a slow wave of some {slow.periods:.1f} periods, {_FEW}", slow.periods)
    repeats = seen.periods.size > 0 and not odd and seen.kind != SLIP_KINDS[2]
    if kind != CLASSES[0] and not (significant or repeats) and probability[0] > _UNLIKELY:
        kind = CLASSES[0]  # neither a line nor drops that go on repeating
    if kind == CLASSES[0] and lines and lines[0].false_alarm < _SURE_LINE:
        return _withheld(
            f"no drops repeat, but the spectrum has a line at {lines[0].frequency:.4g} Hz"
        )
    if kind == CLASSES[0]:
        return PeriodVerdict(kind, np.nan, np.nan, np.nan)
    if kind == NOT_CLEAR:
        likely = CLASSES[int(np.argmax(probability))]
        return _withheld(f"{likely} is more probable, but smooth sliding not improbable")
    hum = [
        m.name for m in oscillation.mains if abs(oscillation.frequency / m.frequency - 1) < _MAINS
    ]
    if hum:
        return _withheld(f"the strongest line stands where the mains hums ({hum[0]})")
    if odd and not several:
        return _withheld(
            f"{AT_ODDS} of {1 / frequency:.3g} s, the drops are {periods.mean():.3g} s apart"
        )
    if kind == CLASSES[2] and (mixed := _mixed(oscillation, lines, form)):
        return _withheld(mixed)
    if count < CYCLES:
        # a wander has a "period" as well; it counts where one wave is nearly all there is
        known = count if slow is not None else np.nan
        return _withheld(f"only {count:.1f} periods, {_FEW}", known)
    if not seen.kind and significant and count >= 2 * CYCLES and not periods.size:
        return PeriodVerdict(kind, frequency, error, count)  # noise hides the drops of a line
    if not seen.kind or (irregular and periods.size < _FEWEST):
        return _withheld("too few drops repeat to tell the period")
    trains = seen.kind == SLIP_KINDS[2]  # they have lines of their own
    strongest = lines[0].frequency if several and not trains else frequency
    if abs(np.log(frequency / strongest)) > _AGREE:
        return _withheld(
            f"the drops repeat at {frequency:.4g} Hz, but the oscillation at {strongest:.4g} Hz is "
            "larger: which of them is stick-slip is open"
        )
    return PeriodVerdict(kind, frequency, error, count)


def _mixed(oscillation: Oscillation, lines: tuple[Component, ...], form: WaveformFeatures) -> str:
    """Say why an oscillation is no sine, or not the only one of its size; "" if it may be.

    A sine on a larger sawtooth rounds it off, and its line may be the stronger: half of the swing
    of a sawtooth is in its first harmonic.
    """
    uneven = form.asymmetry_p_value < _SURE_SKEW and abs(0.5 - form.fall_share) > _SKEW
    sharp = form.derivative_skewness < _SHARPER and oscillation.harmonic_content > _HARMONICS
    if uneven or sharp:
        return (
            f"like a sine, but friction falls in {form.fall_share:.0%} of each cycle: stick-slip "
            "with another oscillation on it is as likely"
        )
    slower = [
        line
        for line in lines
        if line.frequency < _SLOWER * oscillation.frequency
        and line.swing > _ALIKE_SWING * oscillation.swing
    ]
    if slower:
        return (
            f"a slower oscillation at {slower[0].frequency:.4g} Hz is as large as that at "
            f"{oscillation.frequency:.4g} Hz: which of them is stick-slip is open"
        )
    return ""


_FEW = "too few to separate an oscillation from slow drift: slide further at this speed"


def _withheld(why: str, periods: float = np.nan) -> PeriodVerdict:
    return PeriodVerdict(NOT_CLEAR, np.nan, np.nan, periods, why)
