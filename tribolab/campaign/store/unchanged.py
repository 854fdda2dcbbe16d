"""Quick check whether anything has changed since the results were made."""

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
# errors caused by the files themselves: with the same files they would recur
_LASTING = ("ReadError", "AnalysisError", "UnitError", "ConfigError")


def note(outcome: OpenOutcome, runs: Sequence[PlannedRun], options: Mapping[str, object]) -> None:
    """Store the fingerprint of the inputs, so that `unchanged` finds it.

    Parameters
    ----------
    outcome
        Outcome to be stored; nothing is stored if a repetition might give another outcome.
    runs
        The planned runs.
    options
        Options of the report.
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
    """Return the checksum of all inputs of the results except the content of raw files."""
    # imported late: looks up the installed package
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
    """Return the earlier outcome if no input of the results has changed; else None.

    Parameters
    ----------
    campaign, runs
        From `load_and_plan`.
    place
        Results folder.
    options
        Options of the report.
    verify
        Whether to read every file; by default only those whose size, modification time or inode
        changed.
    intact
        Unchanged files of the results, if known.
    """
    ledger = Ledger.read(place)
    intact = ledger.intact(whole=verify) if intact is None else intact
    if not ledger.sound or CATALOGUE not in intact or ledger.damaged(intact):
        return None
    catalogue = Catalogue.of(place)
    made = catalogue.fact(_FACT)
    if not made or made != fingerprint(campaign, runs, options):
        return None
    sources: list[Source] = [(str(n), str(c), int(b)) for n, c, b in _stored_sources(catalogue)]
    files = _inputs(campaign, runs)
    known = {} if verify else catalogue.files()
    if not _are_same(files, known, {n: c for n, c, _ in sources}):
        return None
    return Outcome(
        campaign=campaign,
        folder=place,
        store=catalogue,
        runs=_mark_reused(catalogue.outcomes("run", RunOutcome)),
        curves=tuple(catalogue.outcomes("curve", CurveOutcome)),
        sources=tuple(sources),
        surfaces=_mark_reused(catalogue.outcomes("surface", SurfaceOutcome)),
        models=_mark_reused(catalogue.outcomes("model", ModelOutcome)),
        foreign=tuple(ledger.foreign(intact)),
        lost_decisions=lost_decisions(campaign.file, [run.name for run in runs]),
    )


def _stored_sources(catalogue: Catalogue) -> list[list[str]]:
    listed: list[list[str]] = json.loads(catalogue.fact(_SOURCES) or "[]")
    return listed


def _mark_reused(parts: Sequence[AnyOutcome]) -> tuple[AnyOutcome, ...]:
    return tuple(replace(part, reused=part.status == "done") for part in parts)


def _dialect(campaign: Campaign, instrument: str) -> str:
    return sha256_of_dialect(instrument_of(campaign, instrument))


def _inputs(campaign: Campaign, runs: Sequence[PlannedRun]) -> list[tuple[Path, str]]:
    """Return every input file and its label."""
    files = [pair for run in runs for pair in zip(run.files, run.labels, strict=True)]
    others = [scan for surface in campaign.surface for scan in scans_of(campaign, surface)]
    others += [*modulus_files(campaign), *flow_curve_files(campaign)]
    return files + [(file, label_of(campaign, file)) for file in others]


def _are_same(
    files: Sequence[tuple[Path, str]], known: Mapping[str, Identity], sums: Mapping[str, str]
) -> bool:
    """Whether input files are unchanged; files with the same identity are not read."""
    try:
        for file, label in files:
            identity = known.get(str(file))
            same = identity is not None and identity.is_of(file.stat())
            if not same and sums.get(label) != sha256_of_file(file):
                return False
    except OSError:
        return False
    return True
