"""Checks on the form, roughness and spectrum of a scan, and on the agreement of repeats."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.limit import Limit
from tribolab.qc.register import Check, Result
from tribolab.qc.scan import profiles
from tribolab.qc.scan.subject import ScanSubject
from tribolab.surface.level import level_map


def _form(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    kind, flat = subject.form
    results = []
    if not flat:
        return [Result("skipped", "height", "there are too few heights")]
    if kind == "none":
        text = "the form was removed earlier"
        results.append(Result("skipped", "tilt", text))
    else:
        tilts = np.abs([float(profile.form_tilt) for profile in flat])
        steepest, angle = int(np.argmax(tilts)), float(np.arctan(tilts.max()))
        status = "fail" if angle > limits["fail"] else "pass"
        status = "suspect" if limits["tilt"] < angle <= limits["fail"] else status
        where = subject.profile_names[steepest]
        text = f"the tilt is {np.degrees(angle):.3g} deg in the middle of {where}"
        results.append(Result(status, "tilt", text, angle, "rad"))
    share = []
    for row, profile in zip(subject.filled_profiles, flat, strict=True):
        whole, rest = float(np.ptp(row.height.values)), float(np.ptp(profile.height.values))
        share.append(1.0 - min(rest / whole, 1.0) if whole > 0 else 0.0)
    text = f"form ({kind}) uses {max(share):.2%} of the range"
    return [*results, Result("pass", "height", text, max(share))]


def _level(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    if not subject.usable:
        return [Result("skipped", "height", "there are too few heights")]
    if subject.is_map and not level_map(subject.rows):
        return [Result("pass", "height", "the heights vary")]  # a single row may be level
    level = subject.level
    if not level:
        return [Result("pass", "height", "the heights vary")]
    names = [subject.profile_names[number] for number in level]
    others = f" and in {len(names) - 1} more" if len(names) > 1 else ""
    text = (
        f"the heights vary by rounding alone in {names[0]}{others}: they are equal, or on a "
        "perfect line or circle, and there is no roughness"
    )
    return [Result("fail", "height", text, len(level) / len(subject.usable), "1", names[0])]


def _tip(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    radius = max(subject.attribute_values("tip_radius_m"), default=None)
    if radius is None:
        return [Result("skipped", "height", "the file does not state the tip radius")]
    if not subject.spectra:
        return [Result("skipped", "height", "no spectrum can be computed from this scan")]
    lost, reach = [], []
    for spectrum in subject.spectra:
        q, power = spectrum.wavenumber.values, spectrum.psd_1d.values
        width = (spectrum.wavenumber_high - spectrum.wavenumber_low).values
        top = float(spectrum.wavenumber_high[-1])
        cut = top
        if spectrum.attrs["trusted_high_limited_by"] == "stylus tip":
            cut = float(spectrum.attrs["trusted_high_1_m"])
        slopes = q**2 * power * width
        lost.append(float(slopes[q > cut].sum() / slopes.sum()))
        reach.append(2e6 * np.pi / cut)
    worst = int(np.argmax(lost))
    value = lost[worst]
    if value == 0.0:
        text = f"the tip of {radius * 1e6:.3g} um resolves all wavelengths that the pitch resolves"
        return [Result("pass", "height", text, 0.0)]
    status = "pass"
    if value > limits["suspect"]:
        status = "fail" if value > limits["fail"] else "suspect"
    text = (
        f"the tip of {radius * 1e6:.3g} um does not follow waves shorter than {reach[worst]:.3g} "
        f"um; {value:.0%} of the mean square slope lies there"
    )
    text += f", {subject.profile_names[worst]}" if len(subject.spectra) > 1 else ""
    return [Result(status, "height", text, value)]


def _repeats(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    spectra = subject.spectra
    if subject.is_map or len(subject.rows) < 2 or len(spectra) < 2:
        return [Result("skipped", "height", "one scan: nothing to compare it with")]
    every = np.stack([np.log(spectrum.psd_1d.values) for spectrum in spectra])
    counts = spectra[0].independent_values.values
    logs, weights = profiles.pool_bands(every, counts, limits["values"])
    if not weights.size:
        return [Result("skipped", "height", "the scans are too short to be compared")]
    odd, factor = profiles.odd_one_out(logs, weights, limits["factor"], limits["sigma"])
    if odd < 0:
        text = f"{len(spectra)} scans agree within a factor {factor:.3g} at all wavenumbers"
        return [Result("pass", "height", text, factor)]
    status = "fail" if factor > limits["fail"] else "suspect"
    text = (
        f"{subject.profile_names[odd]} has a spectrum that differs from the others by up to a "
        f"factor {factor:.3g}"
    )
    if len(spectra) == 2:
        text = f"the spectra of the two scans differ by up to a factor {factor:.3g}"
    return [Result(status, "height", text, factor, "1", subject.profile_names[odd])]


def _self_affine(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    if not subject.usable or subject.level:
        return [Result("skipped", "height", "there is no roughness to look at")]
    if (why := subject.affinity_objection) == "":
        share, length = subject.wave
        if share < limits["told"]:
            return [Result("pass", "height", "no periodic wave or lay is visible", 0.0)]
        text = (
            f"a wave of {1e6 * length:.3g} um repeats along the profile, with {100 * share:.2g} % "
        )
        text += "of the mean square height: marks of a feed, chatter or vibration; in the "
        text += "spectrum for contact mechanics it is spread over neighbouring wavelengths"
        return [Result("pass", "height", text, share, noted=True)]
    return [Result("suspect", "height", why, 1.0)]


ROUGHNESS_CHECKS = (
    Check(
        "form",
        4,
        "How much of the range do tilt and form use?",
        "Level the specimen, then choose a smaller range.",
        {
            "tilt": Limit(0.0873, "rad", "5 deg: lengths along the surface are 0.4 % longer"),
            "fail": Limit(0.349, "rad", "20 deg: the flank of the stylus may touch"),
        },
        _form,
    ),
    Check(
        "tip",
        5,
        "Is the tip sharp enough for this surface?",
        "Use a sharper tip, or use the spectrum only up to the stated wavenumber.",
        {
            "suspect": Limit(0.5, "1", "half of the mean square slope is unreliable"),
            "fail": Limit(0.95, "1", "the remaining 5 % does not represent the surface's slopes"),
        },
        _tip,
    ),
    Check(
        "level",
        10,
        "Do the heights vary?",
        "Check that the export contains the heights with enough digits, or leave the scan out.",
        {},
        _level,
    ),
    Check(
        "self_affine",
        11,
        "Can the spectrum be extrapolated to shorter waves with a self-affine law?",
        "Use only the measured part of the spectrum: contact and adhesion computed from "
        "the extrapolated part do not represent this surface.",
        {
            "told": Limit(
                0.003,
                "1",
                "a wave with a smaller share of the mean square height changes no result",
            )
        },
        _self_affine,
    ),
)

REPEAT_CHECKS = (
    Check(
        "repeats",
        8,
        "Do the scans of one surface agree with each other?",
        "Check the named scan: a different surface or filter, dirt, or a lifted stylus.",
        {
            "values": Limit(20.0, "1", "fewer independent values scatter by a quarter or more"),
            "sigma": Limit(6.0, "1", "exceeded by chance once in a billion bands"),
            "factor": Limit(2.0, "1", "spots of one surface differ by less in C, and by 1.4 in Rq"),
            "fail": Limit(4.0, "1", "a factor of 4 in C means twice the roughness"),
        },
        _repeats,
    ),
)
