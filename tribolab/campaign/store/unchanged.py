"""Whether anything has changed since the results were made: told without doing any work."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from tribolab.campaign.settings.files import (
    flow_curve_files,
    instrument_of,
    label_of,
    modulus_files,
    scans_of,
    sha256_of_dialect,
)
from tribolab.campaign.settings.plan import PlannedRun
from tribolab.campaign.settings.review import REVIEW_FILE, lost_decisions
from tribolab.campaign.store.catalogue import CATALOGUE, Catalogue, Identity
from tribolab.campaign.store.ledger import Ledger
from tribolab.campaign.store.outcome import OpenOutcome, Outcome
from tribolab.core.provenance import sha256_of, sha256_of_file
from tribolab.records.parts import (
    CurveOutcome,
    ModelOutcome,
    PartOutcome,
    RunOutcome,
    Source,
    SurfaceOutcome,
)

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign

AnyOutcome = TypeVar("AnyOutcome", RunOutcome, SurfaceOutcome, ModelOutcome)
_FACT = "made from"
_SOURCES = "sources"
# Errors that the files themselves give: with the same files they would come again.
_LASTING = ("ReadError", "AnalysisError", "UnitError", "ConfigError")


def note(outcome: OpenOutcome, runs: Sequence[PlannedRun], options: Mapping[str, object]) -> None:
    """Write down what results are made from, so that `unchanged` finds it.

    Parameters
    ----------
    outcome
        What was made; nothing is written down of what may turn out otherwise next time.
    runs
        As they were planned.
    options
        Of the report.
    """
    parts: tuple[PartOutcome, ...] = (*outcome.runs, *outcome.surfaces, *outcome.models)
    lasting = all(part.status != "failed" or part.error in _LASTING for part in parts)
    readable = all(checksum for _, checksum, _ in outcome.sources)
    if lasting and readable and not outcome.kept and not any(c.crash for c in outcome.curves):
        outcome.store.say(_FACT, fingerprint(outcome.campaign, runs, options))
        outcome.store.say(_SOURCES, json.dumps(outcome.sources))


def fingerprint(
    campaign: Campaign, runs: Sequence[PlannedRun], options: Mapping[str, object]
) -> str:
    """Return the checksum of all that results are made from, but of the raw files' content."""
    # late: looks the installed package up
    from tribolab.version import __version__

    review = campaign.file.parent / REVIEW_FILE
    surfaces = [
        [label_of(campaign, path) for path in scans_of(campaign, s)] for s in campaign.surface
    ]
    dialects = [s.instrument and _dialect(campaign, s.instrument) for s in campaign.surface]
    return sha256_of(
        {
            "tribolab_version": __version__,
            "campaign": sha256_of_file(campaign.file),
            "review": sha256_of_file(review) if review.is_file() else "",
            "runs": [[run.name, run.config_sha256, *run.labels] for run in runs],
            "surfaces": surfaces,
            "dialects": dialects,
            "options": dict(options),
        }
    )


def unchanged(
    campaign: Campaign,
    runs: Sequence[PlannedRun],
    place: Path,
    options: Mapping[str, object],
    *,
    verify: bool = False,
    intact: frozenset[str] | None = None,
) -> Outcome | None:
    """Return what the results came to if nothing that they are made from has changed.

    Parameters
    ----------
    campaign, runs
        From `load_and_plan`.
    place
        Folder of the results.
    options
        Of the report.
    verify
        Whether every file is read to tell; by default those only whose size, time or inode is not
        what it was.
    intact
        Which files of the results are as they were written, if that is known.
    """
    ledger = Ledger.read(place)
    intact = ledger.intact(whole=verify) if intact is None else intact
    if not ledger.sound or CATALOGUE not in intact or ledger.damaged(intact):
        return None
    catalogue = Catalogue.of(place)
    made = catalogue.fact(_FACT)
    if not made or made != fingerprint(campaign, runs, options):
        return None
    sources: list[Source] = [(str(n), str(c), int(b)) for n, c, b in _listed(catalogue)]
    files = _inputs(campaign, runs)
    known = {} if verify else catalogue.files()
    if not _are_same(files, known, {n: c for n, c, _ in sources}):
        return None
    return Outcome(
        campaign=campaign,
        folder=place,
        store=catalogue,
        runs=_as_before(catalogue.outcomes("run", RunOutcome)),
        curves=tuple(catalogue.outcomes("curve", CurveOutcome)),
        sources=tuple(sources),
        surfaces=_as_before(catalogue.outcomes("surface", SurfaceOutcome)),
        models=_as_before(catalogue.outcomes("model", ModelOutcome)),
        foreign=tuple(ledger.foreign(intact)),
        lost_decisions=lost_decisions(campaign.file, [run.name for run in runs]),
    )


def _listed(catalogue: Catalogue) -> list[list[str]]:
    listed: list[list[str]] = json.loads(catalogue.fact(_SOURCES) or "[]")
    return listed


def _as_before(parts: Sequence[AnyOutcome]) -> tuple[AnyOutcome, ...]:
    return tuple(replace(part, reused=part.status == "done") for part in parts)


def _dialect(campaign: Campaign, instrument: str) -> str:
    return sha256_of_dialect(instrument_of(campaign, instrument))


def _inputs(campaign: Campaign, runs: Sequence[PlannedRun]) -> list[tuple[Path, str]]:
    """Return every file that is read, and its label."""
    files = [pair for run in runs for pair in zip(run.files, run.labels, strict=True)]
    others = [scan for surface in campaign.surface for scan in scans_of(campaign, surface)]
    others += [*modulus_files(campaign), *flow_curve_files(campaign)]
    return files + [(file, label_of(campaign, file)) for file in others]


def _are_same(
    files: Sequence[tuple[Path, str]], known: Mapping[str, Identity], sums: Mapping[str, str]
) -> bool:
    """Whether files are those that were read, the ones known by identity without reading them."""
    try:
        for file, label in files:
            identity = known.get(str(file))
            same = identity is not None and identity.is_of(file.stat())
            if not same and sums.get(label) != sha256_of_file(file):
                return False
    except OSError:
        return False
    return True
