"""What is seen of stick-slip on traces of the virtual rig whose truth is known, and where not.

    python tests/detection/stick_slip_table.py --seeds 20

For each condition: share of traces whose dominant wavelength lies within 5 %, and mean drop within
10 %, of the same stroke's without noise; share whose class is right. Truth is what the part that
is looked at holds, drops of half the nominal one and more. Amplitude is half a drop over the
standard deviation of all noise (half of its variance slow, correlated over 1 % of the stroke). Then
the share of steady traces on which nothing is claimed, and detection against amplitude.

Then tricky traces (`slip_traces`): few periods, scattered ones, reversed saws, trains with quiet
between, two frequencies, red noise, drifts: share whose class is right, is withheld ("not
decided"), is another one, or is overlooked ("smooth sliding"). Seeds begin at 20 000: those below
10 000 were looked at while the analysis was made, those from 1 000 000 on were fitted to.

An irregular wave has no period: its wavelength is that of the mean frequency of its spectrum, and a
drop near the half may count or not. What counts there is whether the mean over the seeds is right.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial

import numpy as np
from scipy import signal
from slip_traces import (
    Tricky,
    few,
    in_red_noise,
    intermittent,
    plain,
    quiet,
    scattered,
    two_lines,
)
from slip_traces import look as seen_in

from tribolab.friction.oscillation.events import turning_points
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.segments.find import find_segments
from tribolab.rig.traces import simulate_trace

CLASS = {
    "none": "smooth sliding",
    "sawtooth": "sawtooth stick-slip",
    "rounded": "sinus-like oscillation",
    "irregular": "sawtooth stick-slip",
}
DROP = 0.2
_SHAPES = {"10 periods": (10, 4000), "25 periods": (25, 4000), "100 periods": (100, 4000)}
_DENSE = {"25 periods, 1e5 samples": (25, 100_000)}


def true_wave(run, segments) -> tuple[float, float]:
    """Wavelength [m] and mean drop of a trace without noise."""
    ends = segments["trimmed_start"].item(), segments["trimmed_stop"].item()
    part = run.sel(time=slice(*ends))
    time, values = part["time"].values, part["friction_coefficient"].values
    turns = turning_points(values, DROP / 2)[1:-1]
    falls = np.diff(values[turns]) < 0
    peaks = turns[:-1][falls]
    if peaks.size < 2:
        return np.nan, np.nan
    speed = run["sliding_velocity"].values[0]
    distance = speed * np.diff(time[peaks]).mean()
    if run.attrs["form"] == "irregular":
        distance = speed / mean_frequency(time, values, speed / distance)
    return distance, -np.diff(values[turns])[falls].mean()


def mean_frequency(time: np.ndarray, values: np.ndarray, start: float) -> float:
    """First over zeroth moment of the spectrum under a lognormal window about itself [Hz]."""
    even = np.linspace(time[0], time[-1], time.size)
    wave = signal.detrend(np.interp(even, time, values)) * np.hanning(time.size)
    frequency = np.fft.rfftfreq(time.size, even[1] - even[0])[2:]
    power = np.abs(np.fft.rfft(wave))[2:] ** 2
    mean = start
    for _ in range(50):
        weight = power * np.exp(-0.5 * (np.log(frequency / mean) / 0.4) ** 2)
        mean = frequency @ weight / weight.sum()
    return mean


def look(form: str, strength: float, seed: int, periods: float, samples: int, red: float = 0.5):
    """Make one trace: is the class right, errors of wavelength and drop, is anything claimed."""
    stroke = {
        "red": red,
        "periods": periods / 0.8,  # a tenth is trimmed off at either end
        "samples": samples,
        "jitter": 0.02,
        "seed": seed,
    }
    run = simulate_trace(form, noise=DROP / 2 / strength, drop=DROP, **stroke)
    segments = find_segments(run)
    found = stick_slip(run, segments).isel(segment=0)
    true = true_wave(simulate_trace(form, noise=0.0, drop=DROP, **stroke), segments)
    wavelength = found["dominant_wavelength"].item() / true[0] - 1
    drop = found["drop"].item() / true[1] - 1
    kind = found["waveform"].item()
    return kind == CLASS[form], wavelength, drop, kind != CLASS["none"]


_FIRST = 20_000
_CLAIMED = {"sawtooth": "sawtooth stick-slip", "rounded": "sinus-like oscillation"}
_CLAIMED |= {"reversed": "reversed sawtooth"}
_REGULAR = {"few": "", "plain": "regular", "scattered": "irregular", "trains": "intermittent"}


def tricky_kinds() -> dict[str, Callable[[np.random.Generator], Tricky]]:
    """Kinds of traces by name; the first word says what regularity they have."""
    kinds = {}
    for form in ("sawtooth", "reversed", "rounded"):
        for count in (2.5, 2.7, 3.0, 3.2, 3.6, 4.0, 4.1, 4.2, 4.6, 5.0, 6.0):
            kinds[f"few, {count:g} periods, {form}"] = partial(few, periods=count, form=form)
        kinds[f"plain, {form}"] = partial(plain, form=form)
        for scatter in (0.3, 0.4, 0.5, 0.6):
            name = f"scattered by {scatter:.0%}, {form}"
            kinds[name] = partial(scattered, scatter=scatter, form=form)
        for share in (0.3, 0.5, 0.7):
            name = f"trains, {share:.0%} of the time, {form}"
            kinds[name] = partial(intermittent, share=share, form=form)
        kinds[f"in red noise, {form}"] = partial(in_red_noise, form=form)
    kinds["two frequencies"] = two_lines
    return kinds


def tell(name: str, traces: list[Tricky]) -> str:
    """One line of the table of tricky traces."""
    rows = [(trace, seen_in(trace)) for trace in traces]
    claimed = [(t, f) for t, f in rows if f["waveform"].item() in _CLAIMED.values()]
    right = [f["waveform"].item() == _CLAIMED[t.form] for t, f in claimed]
    withheld = np.mean([f["waveform"].item() == "not decided" for _, f in rows])
    wanted = _REGULAR.get(name.split(",")[0].split(" ")[0], "")
    alike = [f["regularity"].item() == wanted for _, f in claimed]
    words = f"{name:40s}{np.sum(right) / len(rows):7.0%}{withheld:9.0%}"
    missed = np.mean([f["waveform"].item() == "smooth sliding" for _, f in rows])
    words += f"{(len(claimed) - np.sum(right)) / len(rows):7.0%}{missed:8.0%}"
    words += f"{np.mean(alike):9.0%}" if wanted and claimed else " " * 9
    for column in ("dominant_wavelength", "recurrence_distance"):
        error = np.array([f[column].item() / t.period - 1 for t, f in claimed])
        words += (
            f"{np.mean(np.abs(error) < 0.1):8.0%}{np.nanmedian(error):+7.0%}" if claimed else ""
        )
    share = [f["oscillating_time_share"].item() - t.share for t, f in claimed]
    words += f"{np.median(np.abs(share)):8.0%}" if wanted == "intermittent" and claimed else ""
    if traces[0].lines:
        words += f"  both lines listed in order: {np.mean([_listed(t, f) for t, f in rows]):.0%}"
    return words


def _listed(trace: Tricky, found) -> bool:
    lines = found["line_frequency"].values[: len(trace.lines)]
    return bool(np.all(np.abs(lines / trace.lines - 1) < 0.03))


def print_tricky(seeds: range) -> None:
    """Print what is seen of tricky traces, and what is claimed where nothing oscillates."""
    print(f"{'tricky traces':40s}  right withheld  wrong  missed regular  wavelength by spectrum")
    print(" " * 79 + "and distance between drops: within 10 %, bias; error of the share")
    draws = [np.random.default_rng(_FIRST + s) for s in seeds]
    for name, make in tricky_kinds().items():
        print(tell(name, [make(rng) for rng in draws]), flush=True)
    for kind in ("white", "red", "red, 5 s", "1/f", "1/f2", "drift"):
        seen = [seen_in(quiet(rng, kind))["waveform"].item() for _ in range(5) for rng in draws]
        withheld = np.mean([one == "not decided" for one in seen])
        claimed = 1 - withheld - np.mean([one == "smooth sliding" for one in seen])
        print(f"nothing oscillates, {kind}: {claimed:.1%} claimed, {withheld:.1%} withheld")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--only", choices=("rig", "tricky"), help="one of the two tables")
    options = parser.parse_args()
    seeds = range(options.seeds)
    if options.only != "rig":
        print_tricky(seeds)
    if options.only != "tricky":
        print_rig(seeds)


def print_rig(seeds: range) -> None:
    """Print what is seen of the virtual rig's traces."""
    print(f"{'condition':47s} class   within 5 %   within 10 %   mean errors  ")
    print(f"{'':47s} right   wavelength   drop          wavelength, drop")
    for form in ("sawtooth", "rounded", "irregular"):
        for name, (periods, samples) in (_SHAPES | _DENSE).items():
            for strength in (3.0, 10.0):
                rows = np.array([look(form, strength, s, periods, samples) for s in seeds], float)
                right, wave, drop, _ = rows.T
                seen = f"{np.mean(np.abs(wave) < 0.05):10.0%} {np.mean(np.abs(drop) < 0.1):11.0%}"
                typical = f"{np.nanmean(wave):+12.1%} {np.nanmean(drop):+7.1%}"
                what = f"{form}, {name}, amplitude {strength:g} noise"
                print(f"{what:55s} {right.mean():5.0%} {seen} {typical}")
    quiet = [
        look("none", 3.0, 10_000 + 1000 * k + s, p, n, red)[0]
        for s in seeds
        for k, (p, n) in enumerate(_SHAPES.values())  # the same seed is the same noise
        for red in (0.0, 0.3, 0.6, 0.9)
    ]
    print(f"steady: nothing claimed on {np.mean(quiet):.1%} of {len(quiet)}")
    print("share seen at all, and as its class, against amplitude over noise (25 periods)")
    strengths = (0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
    print(" " * 22 + "".join(f"{s:7g}" for s in strengths))
    for form in ("sawtooth", "rounded", "irregular"):
        rows = np.array([[look(form, x, s, 25, 4000) for s in seeds] for x in strengths], float)
        for words, column in (("at all", 3), ("as its class", 0)):
            shares = rows[:, :, column].mean(axis=1)
            print(f"{form:10s}{words:12s}" + "".join(f"{share:7.0%}" for share in shares))


if __name__ == "__main__":
    main()
