"""All checks on the scans of one surface, with a table of findings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import of_runs
from tribolab.core.errors import AnalysisError, ConfigError, Cure, nearest, shown
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.qc import signals
from tribolab.qc.findings import Findings
from tribolab.qc.flags import FAIL, SUSPECT, attach
from tribolab.qc.register import (
    SWITCHED_OFF,
    Check,
    Result,
    resolve_limits,
    results_of_checks,
)
from tribolab.qc.scan import profiles
from tribolab.qc.scan.artefact_checks import ARTEFACT_CHECKS
from tribolab.qc.scan.artefacts import longest_run
from tribolab.qc.scan.instrument import INSTRUMENT_CHECKS
from tribolab.qc.scan.subject import ScanSubject
from tribolab.surface.level import level_map


@of_runs
def check_scans(
    scans: xr.Dataset,
    *,
    limits: Mapping[str, Mapping[str, str | float]] | None = None,
    skip: Sequence[str] = (),
    results: xr.Dataset | Sequence[xr.Dataset] | None = None,
) -> Findings:
    """Return the findings of all checks on scans: errors, their place, effect and remedy.

    Parameters
    ----------
    scans
        ``height`` [m] (scan, x) from `scan_files.read_scans`, a single profile or a map
        (y, x). A list of such datasets gives a list.
    limits
        ``{check: {limit: value}}`` over the defaults; SI numbers or text with a unit.
    skip
        Names of checks to leave out; they appear as skipped.
    results
        The instrument's own results from `results.read_tester_results`.

    Returns
    -------
    Findings
        ``.table`` shows one row for each check and variable, ``.status`` the worst,
        ``.flagged`` the scans with ``height_qc`` and ``height_qc_tests``.

    Raises
    ------
    AnalysisError
        If the dataset holds no scan.
    ConfigError
        If a check or a limit is unknown; the message names the nearest.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> height = 1e-7 * rng.standard_normal(4096).cumsum()
    >>> height[1000:] += 2e-5
    >>> scans = xr.Dataset({"height": ("x", height)}, {"x": 1e-6 * np.arange(4096)})
    >>> check_scans(scans).table.query("check == 'steps'").message.item()
    'the height jumps 1 time, scan 1, x = 1 mm'
    """
    for name in skip:
        if name not in SCAN_CHECKS:
            raise ConfigError(
                f"[qc] skip: no check is called '{shown(name)}'{nearest(name, SCAN_CHECKS)}"
            )
    if "height" not in scans or "x" not in scans.height.dims or scans.sizes["x"] < 2:
        raise AnalysisError(
            "scans with 'height' (scan, x) are wanted",
            cure=Cure(notebook="read them with read_scans()"),
            function="check_scans",
        )
    resolved = resolve_limits(SCAN_CHECKS, limits or {})
    given = [results] if isinstance(results, xr.Dataset) else list(results or ())
    subject = ScanSubject(scans, given)
    answers = results_of_checks(SCAN_CHECKS, subject, resolved, dict.fromkeys(skip, SWITCHED_OFF))
    listed = tuple((SCAN_CHECKS[name], result) for name, rows in answers.items() for result in rows)
    flags = {
        check.name: subject.reshape_flags(result.flags)
        for check, result in listed
        if result.flags is not None
    }
    bits = {check.name: check.bit for check in SCAN_CHECKS.values()}
    flagged = attach(scans, "height", flags, bits)
    return Findings(str(scans.attrs.get("source", "scans")), listed, flagged, resolved)


def _flag_result(
    subject: ScanSubject, flags: np.ndarray, text: str, fail_share: float
) -> list[Result]:
    """Return a result from flags (row, x): number of points, place and severity."""
    bad = np.isin(flags, (SUSPECT, FAIL))
    count = int(bad.sum())
    share = count / flags.size
    if not count:
        return [Result("pass", "height", "nothing found", 0.0, flags=flags)]
    grave = share > fail_share
    if grave:
        flags = np.where(bad, FAIL, flags).astype(np.int8)
    row = int(np.argmax(bad.any(axis=1)))
    at = np.flatnonzero(bad[row])
    where = subject.place(row, int(at[0]), int(at[-1]))
    others = int(bad.any(axis=1).sum()) - 1
    message = (
        text.format(count=Count(count))
        + f", {where}"
        + (f" and in {others} more" if others else "")
    )
    status = "fail" if grave else "suspect"
    return [Result(status, "height", message, share, "1", where, count, flags)]


def _dropouts(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    missing = ~np.isfinite(subject.rows)
    flags = signals.missing(np.where(missing, np.nan, 0.0))
    cropped = str(subject.scans.attrs.get("cropped", ""))
    if not missing.any():
        text = cropped or "nothing missing"
        return [Result("pass", "height", text, 0.0, flags=flags, noted=bool(cropped))]
    ends = np.zeros_like(missing) if subject.is_map else profiles.end_points(missing)
    inside = missing & ~ends
    count, share = int(missing.sum()), float(inside.mean())
    row = int(np.argmax([longest_run(m) for m in inside]))
    if not inside[row].any():
        row = int(np.argmax(ends.any(axis=1)))
        at = np.flatnonzero(ends[row])
        where = subject.place(row, int(at[0]), int(at[-1]))
        text = f"{Count(count):height is|heights are} missing at the ends, which are left out"
        left_out = float(ends.mean(axis=1).max())
        status = "suspect" if left_out > limits["stretch"] else "pass"
        if left_out > limits["fail"]:
            status = "fail"
        cure = "Let the scan begin and end on the surface."
        return [
            Result(status, "height", text, left_out, "1", where, count, flags, True, cure),
        ]
    longest = longest_run(inside[row])
    at = np.flatnonzero(inside[row])
    where = subject.place(row, int(at[0]), int(at[-1]))
    span = longest * subject.pitch
    text = (
        f"{Count(count):height is|heights are} missing ({missing.mean():.2%}), at most {longest} "
        f"in a row ({span * 1e6:.4g} um), {where}"
    )
    text += f"; {cropped}" if cropped else ""
    whole = float(subject.x[-1] - subject.x[0])
    # a map is also known in the rows next to a gap, a profile is not
    far = not subject.is_map and span > limits["stretch"] * whole
    status = "pass"
    if share > limits["suspect"] or longest > limits["in_a_row"] or far:
        status = "suspect"
    if _most_missing(subject) > limits["fail"]:
        status = "fail"
    elif far and (cost := profiles.cost_of_gaps(subject.profile_of(row))):
        text += f"; it leaves {cost}"
    return [Result(status, "height", text, share, "1", where, count, flags, noted=True)]


def _most_missing(subject: ScanSubject) -> float:
    """Return the largest share of missing heights among the maps or profiles."""
    missing = ~np.isfinite(subject.rows)
    return float(missing.mean() if subject.is_map else missing.mean(axis=1).max())


def _steps(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    flags = np.stack([profiles.steps(row, limits["factor"]) for row in subject.rows])
    return _flag_result(subject, flags, "the height jumps {count:time|times}", limits["fail"])


def _clipping(subject: ScanSubject, limits: Mapping[str, float]) -> list[Result]:
    fewest, share = int(limits["points"]), limits["noisy"]
    noisy = 1.0 if subject.is_map else share
    flags = np.stack([profiles.flag_clipping(row, fewest, noisy) for row in subject.rows])
    text = "{count:point is|points are} clipped at the end of the range"
    return _flag_result(subject, flags, text, limits["fail"])


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


_PROFILE_CHECKS = (
    Check(
        "dropouts",
        1,
        "Are heights missing?",
        "Gaps are interpolated, and the bands include the resulting error. Clean or "
        "coat the surface.",
        {
            "suspect": Limit(1e-3, "1", "single interpolated points do not change the spectrum"),
            "in_a_row": Limit(8.0, "1", "a longer gap removes waves of its length"),
            "fail": Limit(0.5, "1", "with less than half a scan, nothing is computed"),
            "stretch": Limit(
                0.05, "1", "a gap of this fraction of the length causes errors of some per cent"
            ),
        },
        _dropouts,
    ),
    Check(
        "steps",
        2,
        "Are there jumps in height between neighbouring points?",
        "Look for a slipping specimen, an edge or a scratch, and cut the scan there.",
        {
            "factor": Limit(12.0, "1", "slopes of ground and blasted surfaces reach 7"),
            "fail": Limit(1e-3, "1", "one jump may be an edge; one in a thousand points is not"),
        },
        _steps,
    ),
    Check(
        "clipping",
        3,
        "Does the profile reach the end of the gauge's range?",
        "Level the specimen or choose a larger range, and scan again.",
        {
            "points": Limit(8.0, "1", "by chance, a stylus has equal heights at some points"),
            "noisy": Limit(0.01, "1", "fewer points at the limit, scattered by noise, are summits"),
            "fail": Limit(0.01, "1", "clipping of 1 % changes Rq and the spectrum"),
        },
        _clipping,
    ),
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

_REPEAT_CHECKS = (
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

SCAN_CHECKS: dict[str, Check[ScanSubject]] = {
    check.name: check
    for check in (*_PROFILE_CHECKS, *ARTEFACT_CHECKS, *INSTRUMENT_CHECKS, *_REPEAT_CHECKS)
}
