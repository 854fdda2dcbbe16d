"""Stage of the runs of a campaign: each is read, analysed, checked and recorded by a worker."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, Self

import xarray as xr

from tribolab.arrays.scratch import tidy_up
from tribolab.campaign.engine.stage import Stage
from tribolab.campaign.runs.analysis import QUALITY, analyse_run, run_labels
from tribolab.campaign.runs.loads import load_of, round_load
from tribolab.campaign.runs.reading import Earlier, mark_of
from tribolab.campaign.runs.sources import source_of, sources_of_run
from tribolab.campaign.runs.zeros import zero_of
from tribolab.campaign.settings.plan import PlannedRun
from tribolab.campaign.store.catalogue import Entry, fingerprint_of
from tribolab.campaign.store.data_files import write_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.errors import AnalysisError, OutputError, message_for
from tribolab.core.provenance import made
from tribolab.core.untyped import Json
from tribolab.core.wording import LOAD_STATED, explain
from tribolab.friction.decisions.rejected import rejected
from tribolab.records.parts import Notice, PageTrace, Row, RunOutcome, RunZero, Source
from tribolab.records.runs.run_record import RunFacts, RunRecord
from tribolab.records.runs.traces import page_trace, trace_size
from tribolab.records.verdict import is_ramp

_KIND = "run"


@dataclass(frozen=True)
class RunTask:
    """Run to process, the folder for its data file, and the size of its traces.

    `points` of each signal are shown on opening; the finer trace for zooming may have `fine_size`
    characters. `earlier` results may contain its signals.
    """

    run: PlannedRun
    folder: Path
    points: int = 2000
    fine_size: int = 0
    earlier: Earlier | None = None

    @property
    def data_file(self) -> str:
        """Path of the data file relative to the results folder."""
        return f"data/{self.run.name}.nc"


class RunAnswer(NamedTuple):
    """Result of a worker, without signals, which would be too large to send."""

    record: RunRecord
    trace: PageTrace | None = None


class RunHandle(NamedTuple):
    """Outcome of a run for the later stages of a campaign."""

    outcome: RunOutcome
    sources: tuple[Source, ...]
    zero: RunZero | None = None
    fingerprint: str = ""

    @property
    def content(self) -> tuple[str, ...]:
        """Checksum of all that affects the results of the run."""
        lent = "" if self.zero is None else str(self.zero.lent)
        return self.fingerprint, lent, *(checksum for _, checksum, _ in self.sources)


class Runs(Stage[RunTask, RunAnswer, RunHandle]):
    """Stage that reads, analyses and checks each run.

    Parameters
    ----------
    runs
        The planned runs.
    store
        Known results, and storage of new ones.
    """

    name = _KIND + "s"

    def __init__(self, runs: Sequence[PlannedRun], store: Store) -> None:
        self._runs = runs
        self._lent: dict[str, PlannedRun] | None = None
        self._store = store
        self._began = time.time_ns()

    def again(self, runs: Sequence[PlannedRun]) -> Self:
        """Repeat these runs with settings other than those of their fingerprints."""
        self._lent = {run.name: run for run in runs}
        return self

    def plan(self) -> list[RunTask]:
        """Return the tasks; the size of the traces depends on their number."""
        points, fine_size = trace_size(len(self._runs))
        runs = self._runs if self._lent is None else self._lent.values()
        return [RunTask(run, self._store.folder, points, fine_size) for run in runs]

    def known(self, task: RunTask, place: int) -> RunHandle | None:
        """Reuse a run with the same settings, version and files (by their checksums)."""
        if self._lent is not None:
            return None
        run = task.run
        mark = fingerprint_of(run.config_sha256)
        record = self._store.same(_KIND, run.name, mark, RunRecord)
        if record is None or not record.outcome.done:
            return None
        sources = self._unchanged(run, record)
        if sources is None:
            return None
        outcome = replace(
            record.outcome,
            files=run.labels,
            surface=run.surface,
            medium=run.medium,
            data_file=task.data_file,
            reused=True,
            kept="",
        )
        taken = replace(record, outcome=outcome, sources=sources)
        if not self._store.take(_KIND, run.name, place, mark, taken, record.outcome.data_file):
            return None
        return RunHandle(outcome, sources, record.zero, mark)

    def prepared(self, task: RunTask) -> RunTask:
        """Add the earlier data file with the signals, if the raw files are unchanged."""
        run = task.run
        entry = self._store.before.get(_KIND, run.name, RunRecord)
        if entry is None or not entry.record.outcome.done:
            return task
        file = self._store.intact(_KIND, entry.name, entry.record.outcome.data_file)
        sources = self._unchanged(run, entry.record)
        if file is None or sources is None:
            return task
        return replace(task, earlier=Earlier(file, mark_of(run, sources)))

    def _unchanged(self, run: PlannedRun, record: RunRecord) -> tuple[Source, ...] | None:
        """Return the raw files of a run if they match its record; else None."""
        sources = self._store.sources(zip(run.files, run.labels, strict=True))
        same = sorted(s[1] for s in sources) == sorted(s[1] for s in record.sources)
        return sources if same else None

    @staticmethod
    def work(task: RunTask) -> RunAnswer:
        """Process one run."""
        answer = process_run(task)
        tidy_up()
        return answer

    def failed(self, task: RunTask, error: BaseException) -> RunAnswer:
        """Return the record of a run whose worker died."""
        return RunAnswer(RunRecord(failed_run(task.run, *explain(error)), ()))

    def keep(self, task: RunTask, place: int, record: RunAnswer) -> RunHandle:
        """Store the record of a run."""
        run = record.record
        if run.outcome.done and not (task.folder / run.outcome.data_file).is_file():
            raise OutputError(
                f"{run.outcome.data_file}: written by a worker, but not to be seen in "
                f"{task.folder}; do the workers share this folder?"
            )
        mark = fingerprint_of(task.run.config_sha256)
        if self._lent is not None:  # keep its position
            place = next(k for k, run in enumerate(self._runs) if run.name == task.run.name)
        self._store.put(_KIND, task.run.name, place, mark, run, record.trace)
        self._store.note_sources(zip(task.run.files, run.sources, strict=False), self._began)
        return RunHandle(run.outcome, run.sources, run.zero, mark)


def keep_earlier(
    store: Store, entry: Entry[RunRecord], outcome: RunOutcome, place: int
) -> RunHandle | None:
    """Store an earlier result in place of a run whose files cannot be read.

    Returns None if its data file was changed.
    """
    record = replace(entry.record, outcome=outcome)
    data_file = entry.record.outcome.data_file
    if not store.take(_KIND, entry.name, place, entry.fingerprint, record, data_file):
        return None
    return RunHandle(outcome, record.sources, record.zero, entry.fingerprint)


def process_run(task: RunTask) -> RunAnswer:
    """Read and analyse a run, then write and record its results.

    Errors of the run are recorded.

    Raises
    ------
    OutputError
        If the results cannot be written.
    """
    # imported late for a quick start
    from tribolab.campaign.runs.running_in import running_in_of
    from tribolab.records.frames import plain_rows, stick_slip_columns
    from tribolab.records.runs.decision_rows import unapplied_decisions
    from tribolab.records.runs.notices import notices_of
    from tribolab.records.runs.run_facts import facts_of
    from tribolab.records.runs.starts import starts_after_rests

    began = time.monotonic()
    run = task.run
    try:
        analysed = analyse_run(run, task.earlier)
        signals, segments, friction, slip = (
            analysed.signals,
            analysed.segments,
            analysed.friction,
            analysed.slip,
        )
        root: dict[str | None, xr.Dataset] = {None: _root(run, signals.attrs)}
        write_data(root | analysed.groups, task.folder / task.data_file)
        facts = facts_of(signals, segments, friction, slip, analysed.friction_as_found)
        facts = _add_dead_weight_gain(facts, run, signals)
        running_in, course = running_in_of(
            signals, friction if analysed.whole is None else analysed.whole
        )
        starts = _starts(signals, segments, friction)
        if starts_after_rests(starts):  # each start has its own transient: the run does not run in
            running_in = ()
        facts = replace(facts, running_in=running_in)
        results = facts.decisions, slip, running_in
        notices = notices_of(run.name, signals, segments, friction, *results)
        trace, why = _trace(task, signals, segments, friction)
        rows = plain_rows(stick_slip_columns(slip))
    except OutputError:
        raise
    except Exception as error:  # recorded: one bad file must not stop the others
        reason, name = explain(error)
        outcome = failed_run(run, reason, name, time.monotonic() - began)
        sources = tuple(map(source_of, run.files, run.labels))
        facts = RunFacts(decisions=unapplied_decisions(run.decisions))
        return RunAnswer(RunRecord(outcome, sources, facts=facts))
    load = load_of(run.normal_force, signals, friction)
    outcome = RunOutcome(
        name=run.name,
        files=run.labels,
        surface=run.surface,
        medium=run.medium,
        normal_force=load.normal_force,
        load_from=load.load_from,
        measured_load=load.measured_load,
        measured_levels=load.levels,
        load_levels=tuple(map(round_load, load.levels)),
        status="done",
        data_file=task.data_file,
        seconds=time.monotonic() - began,
        segments=segments.sizes["segment"],
        quality=analysed.quality,
        segments_rejected=int(rejected(segments).sum()),
        quality_as_found=analysed.quality_as_found,
        ramp=_is_ramp(facts, segments.sizes["segment"]),
    )
    zero = zero_of(friction.attrs, signals.attrs, run.instrument)
    sources = sources_of_run(run, signals.attrs)
    record = RunRecord(outcome, sources, zero, facts, (*notices, *why), rows, starts, course)
    return RunAnswer(record, trace)


def _is_ramp(facts: RunFacts, segments: int) -> bool:
    """Whether the speed increases or decreases during most of a run."""
    omitted = [vars(part) for part in facts.omitted]
    found = {"segments_found": segments, "omitted": omitted, "duration_s": facts.duration_s}
    return is_ramp(found)


def _add_dead_weight_gain(facts: RunFacts, run: PlannedRun, signals: xr.Dataset) -> RunFacts:
    """Add the gain from a dead weight that is placed or removed in the record."""
    from tribolab.metrology.dead_weight import dead_weight_gain  # imported late for a quick start

    if run.dead_weight is None:
        return facts
    try:
        weighed = dead_weight_gain(signals, run.dead_weight)
    except AnalysisError:  # it is applied all the time, and the load of the strokes gives the gain
        return facts
    return replace(facts, dead_weight_gain=weighed.gain, dead_weight_gain_sem=weighed.error)


def _starts(signals: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset) -> tuple[Row, ...]:
    """Return the rows of static friction; empty without a coefficient."""
    # imported late for a quick start
    from tribolab.friction.coefficient.static import static_friction
    from tribolab.records.frames import plain_rows, static_friction_columns

    if "friction_coefficient" not in friction:
        return ()
    return plain_rows(static_friction_columns(static_friction(signals, segments, friction)))


def failed_run(run: PlannedRun, reason: str, error: str, seconds: float = 0.0) -> RunOutcome:
    """Return the outcome of a run without results; the reason names files by their labels."""
    for file, label in zip(run.files, run.labels, strict=True):
        reason = reason.replace(str(file), label)
    if len(run.labels) == 1:
        reason = reason.removeprefix(f"{run.labels[0]}: ")
    return RunOutcome(
        name=run.name,
        files=run.labels,
        surface=run.surface,
        medium=run.medium,
        normal_force=run.normal_force,
        load_from="" if run.normal_force is None else LOAD_STATED,
        status="failed",
        reason=reason,
        error=error,
        seconds=seconds,
    )


def _trace(
    task: RunTask, run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset
) -> tuple[PageTrace | None, list[Notice]]:
    try:
        return page_trace(run, segments, friction, task.points, task.fine_size), []
    except AnalysisError as error:  # recorded: the run's numbers are kept without it
        text = f"no trace to show: {message_for(error, 'campaign')}"
        return None, [Notice("error", task.run.name, "trace", text)]


def _root(run: PlannedRun, attrs: Json) -> xr.Dataset:
    """Return the attributes of the whole file, for users who open it without a group."""
    origin = made(
        f"friction of {run.name}",
        source=attrs["source"],
        source_sha256=attrs["source_sha256"],
        config_sha256=run.config_sha256,
    )
    return xr.Dataset(attrs=run_labels(run) | origin | {QUALITY: attrs[QUALITY]})
