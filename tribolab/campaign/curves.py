"""Measured curves of a campaign, each from repeats of one measurement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from traceback import format_exception
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.campaign.recorded import Recorded
from tribolab.campaign.runs.analysis import AS_FOUND
from tribolab.campaign.runs.loads import level_mask
from tribolab.campaign.runs.stage import RunHandle
from tribolab.campaign.settings.naming.run_names import distinct, safe_name
from tribolab.campaign.store.data_files import digest, write_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.core.attributes import SegmentAttributes
from tribolab.core.errors import TribolabError
from tribolab.core.provenance import sha256_of
from tribolab.core.wording import LOAD_MEASURED, LOAD_STATED, LOAD_VARIES, explain, load_label
from tribolab.friction.points.limits import SPEED_TOLERANCE
from tribolab.reading.dialect.uncertainty import MODEL_INPUTS
from tribolab.records.part_records import CurveRecord, Origin
from tribolab.records.parts import CurveOutcome, Row, RunOutcome
from tribolab.records.wording import plain_value
from tribolab.units.stamping import stamp

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.reading.dialect.uncertainty import Known

    Parts = dict[str | None, xr.Dataset]  # groups of a data file

SLIP = "stick_slip"  # group of stick-slip against speed
TRACTION = "traction"  # group of friction against the slide-roll ratio
_AS_FOUND = "as_found"  # group of the curve without a person's decisions
Condition = tuple[str, str, float | None, str]


class _Levels(NamedTuple):
    """Load levels [N] of a run, and which belong to the curve; empty if it has one load."""

    measured: tuple[float, ...]
    wanted: tuple[bool, ...]

    def of(self, friction: xr.Dataset) -> np.ndarray | slice:
        """Return a mask of the segments that belong to the curve."""
        if not self.measured:
            return slice(None)
        force = friction["normal_force"].values
        return level_mask(force, np.array(self.measured), np.array(self.wanted))


@dataclass(frozen=True)
class CurveTask:
    """Measured curve to be computed, with the data files of its runs.

    `found_files` are those that would be used without decisions; empty if there are none. `levels`
    (and `found_levels`) state the loads of each run that belong to this curve.
    """

    curve: CurveOutcome
    data_files: tuple[str, ...]
    folder: Path
    fingerprint: str = ""
    found_files: tuple[str, ...] = ()
    levels: tuple[_Levels, ...] = ()
    found_levels: tuple[_Levels, ...] = ()
    speed_tolerance: float = SPEED_TOLERANCE.value

    @property
    def name(self) -> str:
        """Name of the curve."""
        return self.curve.name


class Curves(Recorded[CurveTask, CurveRecord, CurveRecord]):
    """Stage that combines the runs of each measured curve.

    Parameters
    ----------
    runs
        Outcomes of the runs; failed and rejected ones are left out.
    store
        Known results, and storage of new ones.
    speed_tolerance
        Largest relative difference of the speeds of one point.
    """

    name = "curves"
    kind = "curve"
    record = CurveRecord

    def __init__(
        self,
        runs: Iterable[RunHandle],
        store: Store,
        speed_tolerance: float = SPEED_TOLERANCE.value,
    ) -> None:
        super().__init__(store)
        self._runs, self._tolerance = runs, speed_tolerance

    def plan(self) -> list[CurveTask]:
        """Group the runs by surface, medium and load."""
        groups: dict[Condition, list[RunHandle]] = {}
        for came in self._runs:
            if came.outcome.in_curves or came.outcome.in_curves_as_found:
                for condition in _conditions(came.outcome):
                    groups.setdefault(condition, []).append(came)
        # a curve whose runs are all rejected is dropped
        groups = {
            key: members
            for key, members in groups.items()
            if any(came.outcome.in_curves for came in members)
        }
        names = distinct(_curve_name(*key) for key in groups)
        return [
            self._task(name, key, members)
            for name, (key, members) in zip(names, groups.items(), strict=True)
        ]

    def _task(self, name: str, condition: Condition, members: Sequence[RunHandle]) -> CurveTask:
        used = [came for came in members if came.outcome.in_curves]
        undecided: list[RunHandle] = []
        if any(came.outcome.quality_as_found for came in members):  # somebody decided
            undecided = [came for came in members if came.outcome.in_curves_as_found]
        surface, medium, load, _ = condition
        outcome = CurveOutcome(
            name=name,
            surface=surface,
            medium=medium,
            normal_force=load,
            load_from=_load_from(came.outcome for came in used),
            data_file=f"data/{name}.nc",
            run_names=tuple(came.outcome.name for came in used),
        )
        levels = tuple(_levels(came.outcome, load) for came in used)
        contents = [came.content for came in used]
        if any(own.measured for own in levels):
            contents += [tuple(map(str, own.measured + own.wanted)) for own in levels]
        if undecided:
            contents += [("as found",), *(came.content for came in undecided)]
        if self._tolerance != SPEED_TOLERANCE.value:
            contents.append((f"{self._tolerance!r}",))
        return CurveTask(
            outcome,
            tuple(came.outcome.data_file for came in used),
            self._store.folder,
            sha256_of(contents),
            tuple(came.outcome.data_file for came in undecided),
            levels,
            tuple(_levels(came.outcome, load) for came in undecided),
            self._tolerance,
        )

    def taken(self, task: CurveTask, record: CurveRecord) -> CurveRecord | None:
        """Reuse a curve with the same name and labels."""
        file = task.curve.data_file
        return record if record.outcome == task.curve and self.linked(task, file, file) else None

    @staticmethod
    def work(task: CurveTask) -> CurveRecord:
        """Combine the runs of one curve."""
        return process_curve(task)

    def failed(self, task: CurveTask, error: BaseException) -> CurveRecord:
        """Return the record of a curve that could not be computed."""
        crash = "" if isinstance(error, TribolabError) else "".join(format_exception(error))
        reason = explain(error)[0]
        return CurveRecord(
            replace(task.curve, data_file="", status="failed", reason=reason, crash=crash)
        )


def process_curve(task: CurveTask) -> CurveRecord:
    """Combine the segments of several runs into a measured curve, write and record it.

    Raises
    ------
    TribolabError
        If the runs give no curve.
    """
    # imported late for a quick start
    from tribolab.friction.coefficient.repeatability import run_levels
    from tribolab.friction.oscillation.slip_curve import NEEDED, stick_slip_curve
    from tribolab.friction.traction import stribeck_part, traction_curves
    from tribolab.reading.netcdf.netcdf import read_groups
    from tribolab.records.frames import curve_table, plain_rows, traction_table
    from tribolab.records.models.budget_rows import budget_rows

    files = [task.folder / name for name in task.data_files]
    parts = [read_groups(file, ("friction", SLIP), only={SLIP: NEEDED}) for file in files]
    parts = [_segments_at_load(part, own) for part, own in zip(parts, task.levels, strict=True)]
    frictions = [part["friction"] for part in parts]
    every = frictions
    frictions, ratio = stribeck_part(frictions, task.speed_tolerance)
    curve, known = _budget_curve(frictions, task.speed_tolerance)
    curve = _with_entrainment_speed(curve, ratio)
    levels: list[float | None] = []
    if len(frictions) > 1:
        curve = stamp(curve.assign(run_level=("run", run_levels(frictions, task.speed_tolerance))))
        levels = plain_value(curve["run_level"].values)
    groups: dict[str, xr.Dataset] = {}
    reason = ""
    try:
        groups[SLIP] = stick_slip_curve([part[SLIP] for part in parts])
    except Exception as error:  # recorded: the curve is kept without it
        reason = explain(error)[0]
    shaped = [friction.attrs.get("config_sha256", "") for friction in frictions]
    curve.attrs |= _labels(task.curve) | {"config_sha256": sha256_of(shaped)}
    points = plain_rows(curve_table(curve))
    traction: tuple[Row, ...] = ()
    if ratio is not None and (measured := traction_curves(every, task.speed_tolerance)).point.size:
        groups[TRACTION] = measured
        traction = plain_rows(traction_table(measured))
    points_found: tuple[Row, ...] = ()
    if (undecided := _curve_as_found(task)) is not None:
        points_found = plain_rows(curve_table(undecided))
        if points_found == points:  # the decision is only a note, for example
            points_found = ()
        else:
            groups[_AS_FOUND] = undecided
    write_data({None: curve} | groups, task.folder / task.curve.data_file)
    return CurveRecord(
        task.curve,
        points,
        tuple(levels),
        digest(curve),
        Origin(str(curve.attrs.get("source", "")), str(curve.attrs.get("source_sha256", ""))),
        reason,
        points_found,
        tuple(budget_rows(curve, known)),
        SegmentAttributes.from_attrs(curve.attrs).uncertainty_says,
        _model_inputs(frictions),
        traction,
        *_temperature(frictions),
        _contact_area(frictions),
    )


def _temperature(frictions: Sequence[xr.Dataset]) -> tuple[float | None, float]:
    """Return mean and spread [K] of the temperature; None and 0 if a run did not record it."""
    known = [f.attrs["temperature_K"] for f in frictions if "temperature_K" in f.attrs]
    if not known or len(known) < len(frictions):
        return None, 0.0
    within = [f.attrs["temperature_spread_K"] for f in frictions]
    return float(np.mean(known)), float(np.hypot(np.std(known), np.mean(within)))


def _contact_area(frictions: Sequence[xr.Dataset]) -> float | None:
    """Return the mean of the measured contact areas [m2]; None if a run has none."""
    known = [f.attrs["contact_area_m2"] for f in frictions if "contact_area_m2" in f.attrs]
    return float(np.mean(known)) if known and len(known) == len(frictions) else None


def _with_entrainment_speed(curve: xr.Dataset, ratio: float | None) -> xr.Dataset:
    """Return a curve with entrainment speeds, if its slide-roll ratio is given."""
    if ratio is None:
        return curve
    rolling = curve["sliding_speed"].values / ratio
    return stamp(curve.assign(rolling_speed=("sliding_speed", rolling)), slide_roll_ratio=ratio)


def _budget_curve(
    frictions: list[xr.Dataset], speed_tolerance: float
) -> tuple[xr.Dataset, Mapping[str, Known]]:
    """Return the curve of the runs with its full uncertainty, and the stated inputs."""
    from tribolab.metrology.budget import uncertainty_budget  # imported late for a quick start

    budget = uncertainty_budget(frictions, speed_tolerance=speed_tolerance)
    return budget.data, budget.known


def _model_inputs(frictions: Sequence[xr.Dataset]) -> dict[str, float]:
    """Return the largest stated uncertainty of each model input among the runs."""
    from tribolab.metrology.budget import known_uncertainties  # imported late for a quick start

    stated = [known_uncertainties(friction) for friction in frictions]
    return {
        name: max(known[name].standard for known in stated if name in known)
        for name in MODEL_INPUTS
        if any(name in known for known in stated)
    }


def _curve_as_found(task: CurveTask) -> xr.Dataset | None:
    """Return the curve without a person's decisions; None if nobody decided."""
    # imported late for a quick start
    from tribolab.friction.traction import stribeck_part
    from tribolab.reading.netcdf.netcdf import read_groups

    if not task.found_files:
        return None
    wanted = ("friction", AS_FOUND)
    parts = [read_groups(task.folder / n, wanted, optional=True) for n in task.found_files]
    undecided = [part.get(wanted[1], part[wanted[0]]) for part in parts]
    pairs = zip(undecided, task.found_levels, strict=True)
    kept = [friction.isel(segment=own.of(friction)) for friction, own in pairs]
    kept, ratio = stribeck_part(kept, task.speed_tolerance)
    return _with_entrainment_speed(_budget_curve(kept, task.speed_tolerance)[0], ratio)


def _segments_at_load(part: Parts, own: _Levels) -> Parts:
    """Return the segments of a run measured under a curve's load."""
    segments = own.of(part["friction"])
    return {name: data.isel(segment=segments) for name, data in part.items()}


def _load_from(runs: Iterable[RunOutcome]) -> str:
    """Return the source of the load of a curve; stated if it is stated for at least one run."""
    known = {LOAD_MEASURED if _measured_levels(run) else run.load_from for run in runs}
    return next((s for s in (LOAD_STATED, LOAD_MEASURED, LOAD_VARIES) if s in known), "")


def _measured_levels(run: RunOutcome) -> bool:
    return bool(run.load_levels) and run.load_from == LOAD_VARIES


def _conditions(run: RunOutcome) -> list[Condition]:
    """Return the conditions (surface, medium, load) of a run, one for each of its loads."""
    alone = "" if run.surface or run.medium else run.name
    loads = dict.fromkeys(run.load_levels or (run.normal_force,))
    return [(run.surface, run.medium, load_label(load), alone) for load in loads]


def _levels(run: RunOutcome, load: float | None) -> _Levels:
    wanted = tuple(load_label(level) == load for level in run.load_levels)
    return _Levels(run.measured_levels, wanted)


def _labels(curve: CurveOutcome) -> dict[str, str]:
    labels = {"curve_name": curve.name, "runs": "; ".join(curve.run_names)}
    return labels | {key: v for key in ("surface", "medium") if (v := getattr(curve, key))}


def _curve_name(surface: str, medium: str, load: float | None, alone: str) -> str:
    parts = [surface, medium, "" if load is None else f"{load:g}N", alone]
    return f"curve_{safe_name('_'.join(part for part in parts if part))}"
