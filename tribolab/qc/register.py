"""Definition of checks, their results and their limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np

from tribolab.arrays.chunks import one_by_one, samples_where
from tribolab.core.errors import ConfigError, nearest, shown
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.qc.flags import FAIL, SUSPECT, is_uniform
from tribolab.units.conversion import to_si

# from harmless to severe; a summary states the worst
STATUSES = ("pass", "skipped", "suspect", "fail", "error")
OBJECTIONS = ("suspect", "fail", "error")

Subject = TypeVar("Subject", contravariant=True)  # what a check examines: a run or scans


class Skip(Exception):  # noqa: N818 - not an error: the check does not apply
    """Raised by a check that does not apply to the data; the text is the reason."""


@dataclass(frozen=True)
class Result:
    """Result of one check on one variable.

    `noted` marks a "pass" or "skipped" to be shown: a small effect, or one that could not be
    tested. `cure` replaces that of the check if the latter would mislead. `settled` is "accepted"
    or "rejected" if a person decided on the objection, and `settled_by` the person: it then no
    longer counts.
    """

    status: str
    variable: str
    message: str
    value: float = float("nan")
    unit: str = "1"
    where: str = ""
    count: int = 0
    flags: np.ndarray | None = field(default=None, repr=False, compare=False)
    noted: bool = False
    cure: str = ""
    settled: str = ""
    settled_by: str = ""

    @property
    def decision(self) -> str:
        """User's decision on the objection, as text; "" without one."""
        words = {
            "accepted": "accepted by {} in spite of",
            "rejected": "within a part that {} rejected",
        }
        return words[self.settled].format(self.settled_by) if self.settled else ""


@dataclass(frozen=True)
class Check(Generic[Subject]):
    """A check: name, bit in the flags, question, remedy, and limits.

    Attributes
    ----------
    name
        Name in ``campaign.toml`` and in every table.
    bit
        Bit number in ``<variable>_qc_tests``; never reused for another check.
    question
        Question that the check answers.
    cure
        Remedy for an objection.
    limits
        Limits by name, each with a unit and a reason.
    examine
        ``examine(subject, limits) -> list of Result``.
    """

    name: str
    bit: int
    question: str
    cure: str
    limits: Mapping[str, Limit]
    examine: Callable[[Subject, Mapping[str, float]], list[Result]] = field(repr=False)


def resolve_limits(
    checks: Mapping[str, Check[Subject]], settings: Mapping[str, Mapping[str, str | float]]
) -> dict[str, dict[str, float]]:
    """Return the limits of each check: defaults, replaced by those that the user sets.

    Parameters
    ----------
    checks
        Known checks by name.
    settings
        ``{check: {limit: value}}``; values are SI numbers or text with a unit.

    Raises
    ------
    ConfigError
        If a check or a limit is unknown (the message names the nearest), or a limit is negative.
    UnitError
        If a value's unit does not fit.
    """
    resolved = {n: {k: limit.value for k, limit in c.limits.items()} for n, c in checks.items()}
    for name, values in settings.items():
        if name not in checks:
            raise ConfigError(f"[qc]: no check is called '{shown(name)}'{nearest(name, checks)}")
        for key, value in values.items():
            if key not in checks[name].limits:
                known = checks[name].limits
                raise ConfigError(
                    f"[qc.limits.{name}]: no limit is called '{shown(key)}'{nearest(key, known)}"
                )
            unit = checks[name].limits[key].unit
            resolved[name][key] = limit = to_si(value, unit, name=f"[qc.limits.{name}] {key}")
            if not limit >= 0:
                raise ConfigError(
                    f"[qc.limits.{name}] {key}: {value} is no limit: it must not be negative"
                )
    return resolved


SWITCHED_OFF = "switched off in the settings"


def results_of_checks(
    checks: Mapping[str, Check[Subject]],
    subject: Subject,
    limits: Mapping[str, Mapping[str, float]],
    skip: Mapping[str, str],
) -> dict[str, list[Result]]:
    """Return the results of all checks; a crash becomes a result with status "error".

    Parameters
    ----------
    checks, subject, limits
        Checks to run, the run or scans to examine, and the limits.
    skip
        Reasons to skip checks, by their names.

    Returns
    -------
    dict
        The results by name of the check, at least one for each check.
    """
    results: dict[str, list[Result]] = {}
    for name, check in one_by_one(checks.items()):
        if name in skip:
            results[name] = [Result("skipped", "", skip[name])]
            continue
        try:
            results[name] = check.examine(subject, limits[name]) or [
                Result("skipped", "", "the data contain none of its signals")
            ]
        except Skip as why:
            results[name] = [Result("skipped", "", str(why))]
        except Exception as crash:  # a crash becomes a result with status "error" (exit code 3)
            text = f"the check itself crashed: {type(crash).__name__}: {crash}"
            results[name] = [Result("error", "", text)]
    return results


def sample_result(
    variable: str,
    flags: np.ndarray,
    time: np.ndarray,
    message: str,
    *,
    fail_share: float = float("inf"),
    value: float = float("nan"),
) -> Result:
    """Return a result from the flags of samples: their number, place and severity.

    Parameters
    ----------
    variable
        The variable that was checked.
    flags
        Severities (time).
    time
        Sample times [s].
    message
        Text with ``{count}`` and ``{where}`` to fill in; ``{count:gap|gaps}`` adds the matching
        noun.
    fail_share
        Share of the samples above which suspect becomes fail.
    value
        The number [1] that the check measured, if it is more informative than the share.
    """
    # arrays made by `uniform` need not be searched
    sound = is_uniform(flags) and not _objects(flags[:1]).any()
    bad = np.zeros(0, int) if sound else samples_where(_objects, flags)
    if bad.size == 0:
        return Result("pass", variable, "nothing found", value, "1", flags=flags)
    grave = bool((flags[bad] == FAIL).any()) or bad.size > fail_share * flags.size
    if grave:
        flags = flags.copy()
        flags[bad] = FAIL
    first, last = int(bad[0]), int(bad[-1])
    where = f"t = {time[first]:.6g} s (sample {first})"
    if last > first:
        where += f" to t = {time[last]:.6g} s (sample {last})"
    text = message.format(count=Count(bad.size), where=where)
    share = bad.size / flags.size
    number = share if np.isnan(value) else value
    status = "fail" if grave else "suspect"
    return Result(status, variable, text, number, "1", where, int(bad.size), flags)


def _objects(flags: np.ndarray) -> np.ndarray:
    return (flags == SUSPECT) | (flags == FAIL)
