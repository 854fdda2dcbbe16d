"""Limits for stick-slip and other oscillations."""

from tribolab.core.limit import Count, Limit

_TABLE = "tests/detection/stick_slip_table.py, seeds below 10 000; reported on seeds from 20 000"

MIN_EVENT_OVER_SWING = Limit(
    0.5, "1", "ratio of the swing of an event to that of the segment's oscillation", _TABLE,
)  # fmt: skip
MIN_EVENT_OVER_NOISE = Limit(
    4.0, "1", "ratio of the swing of an event to the noise of a sample", _TABLE,
)  # fmt: skip
MIN_SAMPLES_OF_RECORD = Count(16, "1", "samples of a segment that is evaluated for stick-slip")
MAX_LINES = Count(6, "1", "spectral lines that are listed for a segment, the strongest first")
MIN_VARIANCE_OF_LINE = Limit(
    0.03, "1", "ratio of the variances of a listed line and of the strongest one", _TABLE,
)  # fmt: skip
MAX_POWER_OF_HARMONIC = Limit(
    1.3, "1", "ratio of the power at a multiple of a frequency to that of a sawtooth's harmonic, "
    "up to which it counts as a harmonic", _TABLE,
)  # fmt: skip
WIDTH_OF_LINE = Limit(0.04, "1", "relative width of a line", _TABLE)
MIN_POWER_IN_LINES = Limit(
    0.7, "1", "share of the power in the surroundings that lies in lines; less is a broad hump",
    _TABLE,
)  # fmt: skip
LINE_BY_CHANCE = Limit(
    1e-3, "1", "chance that noise as strong as the surroundings shows such a line", _TABLE
)
MIN_SPIKE_OVER_NOISE = Limit(
    6.0, "1", "noise levels by which a single sample differs from both neighbours; it is a spike, "
    "not a slip", _TABLE,
)  # fmt: skip
SWING_OVER_NOISE = Limit(
    50.0, "1", "ratio of swing to noise above which samples are not averaged further", _TABLE,
)  # fmt: skip
MIN_WANDER_OVER_SWING = Limit(
    0.15, "1", "ratio of the standard deviation of a slow drift to the swing, above which the "
    "drift may hide drops", _TABLE,
)  # fmt: skip
MIN_PERIODS_TO_REMOVE_DRIFT = Count(
    6, "1", "periods in a record whose slow drift is subtracted", _TABLE
)
PERIODS_PER_DEGREE_OF_DRIFT = Limit(
    3.0, "1", "periods in a record for each degree of the polynomial fitted to its drift", _TABLE
)
MAX_DEGREE_OF_DRIFT = Count(5, "1", "highest degree of the polynomial fitted to a drift", _TABLE)
MAX_SCATTER_WITHOUT_WANDER = Limit(
    0.8, "1", "ratio of the scatter of the periods without the drift to that with it, below "
    "which the drift is subtracted", _TABLE,
)  # fmt: skip
MIN_DROP_IN_STEPS = Limit(1.5, "1", "quantisation steps of the smallest drop", _TABLE)
MIN_FALL_OF_REVERSED_WAVE = Limit(
    0.65, "1", "share of a cycle that falls, above which the rise is the sharper edge", _TABLE
)
MIN_VARIANCE_OF_SLOW_WAVE = Limit(
    0.75, "1", "share of the variance about a straight line that a wave of 2 to 4 periods explains",
    _TABLE,
)  # fmt: skip
MISFIT_OF_SLOW_WAVE = Limit(
    1.2, "1", "ratio of the misfits of a wave and of the best one, up to which the faster of "
    "both is used: a wave also fits at half its frequency", _TABLE,
)  # fmt: skip
MIN_VARIANCE_OF_SLOW_SINE = Limit(
    0.1, "1", "share of the variance of a slow sine that may hide a faster oscillation", _TABLE
)
MAX_MISFIT_OVER_DRIFT = Limit(
    0.4, "1", "ratio of the misfit of a wave of 2 to 4 periods to that of a drift (a polynomial)",
    _TABLE,
)  # fmt: skip
MAX_ABRUPT_FALL = Limit(0.3, "1", "share of a period that an abrupt fall lasts", _TABLE)
HALF_WIDTH_OF_GATHERED_BAND = Limit(
    0.15, "1", "half width of the band in which the power of a line is summed, divided by the "
    "frequency of the line", _TABLE,
)  # fmt: skip
MIN_CYCLES_IN_RECORD = Limit(
    4.0, "1", "cycles in a record; a slower oscillation is not distinct from a slow drift", _TABLE
)
BREADTH_OF_IRREGULAR_WAVE = Limit(
    0.4, "1", "standard deviation of ln frequency in the spectrum of an irregular wave", _TABLE
)
MAX_DISTANCE_FROM_DROPS = Limit(
    0.2, "1", "largest relative difference between the frequency of the drops and the spectral "
    "line that is looked for near it", _TABLE,
)  # fmt: skip
MAX_SCATTER_OF_SURE_PERIODS = Limit(
    0.12, "1", "scatter of periods above which cycles may have been missed or split", _TABLE
)
MAX_DIFFERENCE_OF_PERIODS = Limit(
    0.15, "1", "difference of ln period between drops and spectrum that agree", _TABLE
)
MAX_DIFFERENCE_OF_IRREGULAR_PERIODS = Limit(
    0.6, "1", "the same for irregular periods: the mean over a broad spectrum is not the mean "
    "distance between drops", _TABLE,
)  # fmt: skip
MAX_ERRORS_BETWEEN_PERIODS = Limit(
    3.0, "1", "standard errors between the periods of drops and spectrum that agree"
)
MIN_SWING_OF_SECOND_LINE = Limit(
    0.25, "1", "ratio of the swing of a second line to that of the strongest, above which the "
    "two beat", _TABLE,
)  # fmt: skip
MIN_SHARE_OF_SHARP_LINE = Limit(
    0.7, "1", "share of the faster variance above which a line is sharp, however periods scatter",
    _TABLE,
)  # fmt: skip
MAX_DISTANCE_FROM_MAINS = Limit(
    0.03, "1", "relative difference from a mains frequency within which an oscillation may be hum"
)
MAX_CHANCE_OF_SMOOTH_SLIDING = Limit(
    0.03, "1", "probability of smooth sliding below which an oscillation is present without a "
    "significant line", _TABLE,
)  # fmt: skip
SURE_LINE_BY_CHANCE = Limit(
    1e-6, "1", "chance of a line in noise that contradicts smooth sliding: many bands may show "
    "one", _TABLE,
)  # fmt: skip
MIN_CYCLES_PER_SLOW_WAVE = Limit(
    5.0, "1", "fewest cycles per slow wave of an oscillation that is not a harmonic of the wave",
    _TABLE,
)  # fmt: skip
MIN_PERIODS_FOR_SCATTER = Count(4, "1", "periods whose scatter is meaningful", _TABLE)
MIN_ASYMMETRY = Limit(
    0.15, "1", "difference of the falling share of a cycle from 0.5, above which the wave is not "
    "a sine", _TABLE,
)  # fmt: skip
ASYMMETRY_BY_CHANCE = Limit(
    0.01, "1", "chance of such an asymmetry in the sign test over the cycles", _TABLE
)
MAX_SKEWNESS_OF_SLOPE = Limit(
    -0.5, "1", "skewness of the derivative below which a wave with strong harmonics drops sharply",
    _TABLE,
)  # fmt: skip
MIN_HARMONICS_OF_DROP = Limit(
    0.6, "1", "harmonic content above which such a wave drops sharply", _TABLE
)
MAX_FREQUENCY_OF_RIVAL = Limit(
    0.7, "1", "ratio of the frequency of a slower line to that of the oscillation, if it may be "
    "the period instead", _TABLE,
)  # fmt: skip
MIN_SWING_OF_RIVAL = Limit(
    0.6, "1", "ratio of the swing of a slower line to that of the oscillation, if it may be the "
    "period instead", _TABLE,
)  # fmt: skip
MAX_SCATTER_OF_REGULAR_PERIODS = Limit(
    0.18, "1", "scatter of the periods above which they are irregular", _TABLE
)
MIN_PAUSE = Limit(2.2, "1", "usual periods between two drops that may enclose a pause", _TABLE)
MAX_CHANGE_IN_PAUSE = Limit(
    0.5, "1", "ratio of the change of friction in a pause to that expected for a stick or a wave",
    _TABLE,
)  # fmt: skip
MIN_QUIET_TIME = Limit(
    0.15, "1", "share of the time that is quiet, above which an oscillation is intermittent", _TABLE
)
MIN_TURNS = Limit(
    3.0, "1", "turns; with fewer a slow drift is not distinct from a wave that repeats"
)
MAX_SOLE_ORDER = Count(
    3, "1", "order up to which a wave may stand alone; a scratch or a dent shows higher orders "
    "with lower ones",
)  # fmt: skip
ORDER_BY_CHANCE = Limit(1e-3, "1", "chance that noise shows as much at one of the orders")
MIN_ORDER_OVER_SURROUNDINGS = Limit(
    2.0, "1", "ratio of the amplitude of an order to that of its surroundings",
)  # fmt: skip
MIN_COHERENCE_OF_TURNS = Limit(0.5, "1", "coherence of a wave from piece to piece of the record")
MAX_PHASE_SHIFT_PER_TURN = Limit(
    0.02, "1", "share of a turn by which phase shifts in each turn, if the stated speed is "
    "slightly off",
)  # fmt: skip
MAX_PERIODS_PER_SAMPLE = Limit(
    0.4, "1", "periods in a sample; a faster wave appears at another frequency (aliasing; "
    "Nyquist: 0.5)",
)  # fmt: skip
MAX_PHASE_SHIFT_OF_ALIAS = Limit(
    0.1, "1", "share of a period by which an aliased wave may shift from piece to piece"
)
MIN_DISTANCE_OF_ALIAS = Limit(
    0.03, "1", "cycles per sample between an aliased wave and a constant, or the alternation of "
    "samples",
)  # fmt: skip
MIN_SPEEDS_OF_EXPONENT = Count(3, "1", "speeds in a fit of how frequency changes with speed")
MIN_ERROR_OF_FREQUENCY = Limit(
    0.01, "1", "relative error of a frequency: the speed is not known better"
)
MAX_CHANGE_OF_RESONANCE = Limit(
    0.03, "1", "difference of ln frequency within which a resonance stays at all speeds"
)
MIN_SPEED_RATIO_OF_RESONANCE = Limit(
    2.0, "1", "ratio of the speeds between which the frequency of a resonance is constant",
)  # fmt: skip
MAX_EXCESS_OF_BAND = Limit(
    0.7, "1", "ln of the ratio of a band's power to the model of the background; larger values "
    "are clipped to this, so that lines do not raise the background", _TABLE,
)  # fmt: skip
MIN_SAMPLES_OF_SPECTRUM = Count(
    256, "1", "samples of a segment in which lines of the rig are looked for"
)
MIN_SAMPLING_RATE = Limit(
    130.0, "Hz", "sampling rate that shows mains at 50 and 60 Hz (Nyquist, with a margin)"
)
MIN_FREQUENCY_OF_RIG_LINE = Limit(5.0, "Hz", "frequency above which rigs ring and mains hums")
RIG_LINE_BY_CHANCE = Limit(1e-6, "1", "chance that noise shows a line anywhere in the spectrum")
MAX_MAINS_DEVIATION = Limit(
    0.10, "Hz", "deviation of mains from 50 Hz: the standard range is 50 mHz",
    "twice the standard range of Regulation (EU) 2017/1485, Annex III",
)  # fmt: skip
MAINS_BY_CHANCE = Limit(3e-3, "1", "chance that noise passes for a line of the mains")
MAX_UNEVEN_SPACING = Limit(
    0.1, "1", "rms deviation from even sampling, in intervals, up to which it counts as even",
    _TABLE,
)  # fmt: skip
BANDS_PER_DECADE = Count(
    24, "1", "bands of the spectrum per decade: a tenth wide, as lines of stick-slip are"
)
RISE_BY_CHANCE = Limit(
    1e-2, "1", "chance that a band of a spectrum without a peak exceeds the bands at lower "
    "frequencies by as much", _TABLE,
)  # fmt: skip
MIN_PEAK_OVER_BACKGROUND = Limit(
    1.5, "1", "ratio of the power of a peak to its background: the model of the background is no "
    "better", _TABLE,
)  # fmt: skip
BAND_BY_CHANCE = Limit(
    1e-3, "1", "chance of the significance level that is shown with a spectrum", _TABLE
)
MIN_CLIPPED_STRETCHES = Count(
    3, "1", "number of sequences of three samples at an extreme, above which the signal is "
    "clipped",
)  # fmt: skip
MAX_DOUBT = Limit(
    0.2, "1", "probability of smooth sliding above which no oscillation is claimed", _TABLE
)
MIN_CYCLES_OF_STIFFNESS = Limit(
    8.0, "1", "fewest cycles, with which the mean drop and its distance are known to 5 %",
)  # fmt: skip
ERROR_OF_CREEP = Limit(
    0.05, "1", "error of the creep share: a mean drop is known to some 5 %",
)  # fmt: skip
MIN_RISE_BY_MASS = Limit(
    0.05, "1", "smallest increase of the critical stiffness by the mass that is reported; equal "
    "to the error of the creep share",
)  # fmt: skip
MIN_SLOPE_OVER_STIFFNESS = Limit(
    1.1, "1", "ratio of the slope of the force in a stick to the stated stiffness, above which "
    "they contradict each other: the slope is known to some 3 %",
)  # fmt: skip
