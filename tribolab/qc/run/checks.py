"""All checks on a run, with a table of findings and flags on its samples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Never

import numpy as np
import xarray as xr

from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.friction.decisions.rejected import kept, rejected
from tribolab.qc.findings import Findings
from tribolab.qc.flags import GOOD, NOT_EVALUATED, attach_all, combine, uniform
from tribolab.qc.manual import BIT, MANUAL, apply_decisions
from tribolab.qc.register import SWITCHED_OFF, Check, Result, resolve_limits, results_of_checks
from tribolab.qc.run.reading import READING_CHECKS
from tribolab.qc.run.rig import RIG_CHECKS
from tribolab.qc.run.schema import SCHEMA_CHECKS
from tribolab.qc.run.signal_checks import SIGNAL_CHECKS
from tribolab.qc.run.sliding import SLIDING_CHECKS
from tribolab.qc.run.subject import RunSubject
from tribolab.qc.run.time_checks import TIME_CHECKS
from tribolab.qc.run.zero import ZERO_CHECKS
from tribolab.units.conversion import to_si

RUN_CHECKS: dict[str, Check[RunSubject]] = {
    check.name: check
    for check in (
        *(*SCHEMA_CHECKS, *TIME_CHECKS, *SIGNAL_CHECKS),
        *(*RIG_CHECKS, *SLIDING_CHECKS, *READING_CHECKS, *ZERO_CHECKS),
    )
}

_SEGMENTS = "segments"
# checks that also apply to rows that are results instead of samples
_OF_POINTS = {"schema", "rows_left_out", "said_elsewhere", "zero_reference", "friction_sign"}
_OF_POINTS |= {"normal_force_error", "segments", "missing"}
_NO_SAMPLES = "its rows are results, not samples"
_NOTHING_EXAMINED = "every check was skipped, so the quality of this run is unknown"
_EXAMINE = "See the reason for each; perhaps the signals have other names."


def check_run(
    run: xr.Dataset,
    segments: xr.Dataset | None = None,
    friction: xr.Dataset | None = None,
    slip: xr.Dataset | None = None,
    *,
    limits: Mapping[str, Mapping[str, str | float]] | None = None,
    skip: Sequence[str] = (),
    normal_force: str | float | None = None,
    contact_width: str | float | None = None,
    checks: Mapping[str, Check[RunSubject]] = RUN_CHECKS,
) -> Findings:
    """Return the findings of all checks on a run: errors, their place, effect and remedy.

    Parameters
    ----------
    run
        The run dataset (dim ``time``).
    segments, friction, slip
        Results of `find_segments`, `friction_coefficient` and `stick_slip`; computed if not
        given. Segments that a person rejected (`decide`) are not examined.
    limits
        ``{check: {limit: value}}`` over the defaults; SI numbers or text with a unit.
    skip
        Names of checks to leave out; they appear as skipped.
    normal_force
        Set-point of the normal force [N], if the file does not contain it.
    contact_width
        Width of the contact [m], if known.
    checks
        The checks to run, by name.

    Returns
    -------
    Findings
        ``.table`` shows one row for each check and variable, ``.status`` the worst status,
        ``.flagged`` the run with ``<name>_qc`` and ``<name>_qc_tests`` on its signals.

    Raises
    ------
    ConfigError
        If a check or a limit is unknown; the message names the nearest.

    Examples
    --------
    >>> import numpy as np
    >>> rng = np.random.default_rng(0)
    >>> force = 1.0 + 0.01 * rng.standard_normal(2000)
    >>> force[700] = 9.0
    >>> run = xr.Dataset({"friction_force": ("time", force)}, {"time": np.arange(2000) / 100})
    >>> found = check_run(run.assign(sliding_velocity=("time", np.full(2000, 1e-3))))
    >>> found.table.query("check == 'spikes'").message.item()
    '1 sample is an isolated outlier, t = 7 s (sample 700)'
    """
    for name in skip:
        if name not in checks:
            raise ConfigError(
                f"[qc] skip: no check is called '{shown(name)}'{nearest(name, checks)}"
            )
    resolved = resolve_limits(checks, limits or {})
    unknown = float("nan")
    subject = RunSubject(
        run,
        *_drop_rejected(segments, friction, slip),
        set_normal_force=unknown
        if normal_force is None
        else to_si(normal_force, "N", name="normal_force"),
        contact_width=unknown
        if contact_width is None
        else to_si(contact_width, "m", name="contact_width"),
    )
    unfit = [name for name in checks if subject.is_points and name not in _OF_POINTS]
    left = dict.fromkeys(unfit, _NO_SAMPLES)
    left |= dict.fromkeys(skip, SWITCHED_OFF)
    answers = _flag_unexamined(results_of_checks(checks, subject, resolved, left))
    results = tuple((checks[name], result) for name, rows in answers.items() for result in rows)
    bits = {check.name: check.bit for check in checks.values()} | {MANUAL: BIT}
    # errors of the time affect all signals; a correct time does not make a signal correct
    of_time = [(check, _objections(flags)) for check, flags in _flags_on(results, "time")]

    def flags() -> Iterator[tuple[str, dict[str, np.ndarray]]]:
        for variable in subject.signals:
            by_check: dict[str, list[np.ndarray]] = {}
            for check, values in (*_flags_on(results, variable), *of_time):
                by_check.setdefault(check.name, []).append(values)
            yield variable, {name: combine(own) for name, own in by_check.items()}

    flagged = attach_all(run, flags(), bits)
    findings = Findings(str(run.attrs.get("source", "run")), results, flagged, resolved)
    return findings if segments is None else apply_decisions(findings, segments)


def _drop_rejected(
    segments: xr.Dataset | None, friction: xr.Dataset | None, slip: xr.Dataset | None
) -> list[xr.Dataset | None]:
    """Return results without the rejected segments, unless all segments are rejected."""
    parts = [segments, friction, slip]
    if segments is None or rejected(segments).all():
        return parts
    return [part if part is None else kept(part) for part in parts]


def _flags_on(
    results: tuple[tuple[Check[Never], Result], ...], variable: str
) -> list[tuple[Check[Never], np.ndarray]]:
    return [(c, r.flags) for c, r in results if r.flags is not None and r.variable == variable]


def _objections(flags: np.ndarray) -> np.ndarray:
    """Return flags with "good" replaced by "not evaluated", so that only objections remain."""
    good = flags == GOOD
    if good.all():
        return uniform(flags.shape, NOT_EVALUATED)
    return np.where(good, np.int8(NOT_EVALUATED), flags)


def _flag_unexamined(results: dict[str, list[Result]]) -> dict[str, list[Result]]:
    """Return the results, with an objection if every check except "segments" was skipped."""
    others = [result for name, rows in results.items() if name != _SEGMENTS for result in rows]
    own = results.get(_SEGMENTS, [])
    if any(r.status != "skipped" for r in others) or any(r.status == "suspect" for r in own):
        return results
    return results | {_SEGMENTS: [Result("suspect", "", _NOTHING_EXAMINED, cure=_EXAMINE)]}
