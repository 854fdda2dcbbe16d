"""The measured curves of a campaign: repeats of a measurement taken together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from traceback import format_exception
from typing import TYPE_CHECKING, Any

from tribolab.campaign.data_files import NETCDF, digest, write_data
from tribolab.campaign.engine import Stage
from tribolab.campaign.plan import distinct, safe_name
from tribolab.campaign.runs import RunCame
from tribolab.campaign.store import Store
from tribolab.errors import TribolabError
from tribolab.provenance import sha256_of
from tribolab.records.part_records import CurveRecord, Origin
from tribolab.records.parts import CurveOutcome
from tribolab.stamping import stamp
from tribolab.words import explain

if TYPE_CHECKING:
    import xarray as xr

KIND = "curve"
SLIP = "stick_slip"  # group of the stick-slip over speed


@dataclass(frozen=True)
class CurveTask:
    """Data files of the runs that make one measured curve."""

    curve: CurveOutcome
    data_files: tuple[str, ...]
    folder: Path
    fingerprint: str = ""


class Curves(Stage[CurveTask, CurveRecord, CurveRecord]):
    """The stage of the measured curves.

    Parameters
    ----------
    runs
        What the runs came to; those that failed, or their checks, are left out.
    store
        What is known, and where it is written down.
    """

    name = KIND + "s"

    def __init__(self, runs: Iterable[RunCame], store: Store) -> None:
        self._runs = runs
        self._store = store

    def plan(self) -> list[CurveTask]:
        """Put together what is stated to be the same: surface, medium and load."""
        groups: dict[tuple[str, str, float | None, str], list[RunCame]] = {}
        for came in self._runs:
            run = came.outcome
            if run.done and run.segments and run.quality not in ("fail", "error"):
                # only what is stated to be the same is taken together
                alone = "" if run.surface or run.medium else run.name
                load = run.normal_force and float(f"{run.normal_force:.4g}")
                groups.setdefault((run.surface, run.medium, load, alone), []).append(came)
        names = distinct(_curve_name(*key) for key in groups)
        return [
            CurveTask(
                CurveOutcome(
                    name=name,
                    surface=surface,
                    medium=medium,
                    normal_force=load,
                    data_file=f"data/{name}.nc",
                    run_names=tuple(came.outcome.name for came in members),
                ),
                tuple(came.outcome.data_file for came in members),
                self._store.folder,
                sha256_of([came.content for came in members]),
            )
            for name, ((surface, medium, load, _), members) in zip(
                names, groups.items(), strict=True
            )
        ]

    def known(self, task: CurveTask, place: int) -> CurveRecord | None:
        """Take over a curve whose runs are the same."""
        name = task.curve.name
        entry = self._store.before.get(KIND, name, CurveRecord)
        if entry is None or entry.fingerprint != task.fingerprint:
            return None
        if entry.record.outcome != task.curve:
            return None
        if not self._store.link(KIND, name, task.curve.data_file, task.curve.data_file):
            return None
        self._store.put(KIND, name, place, task.fingerprint, entry.record)
        return entry.record

    @staticmethod
    def work(task: CurveTask) -> CurveRecord:
        """Combine the runs of one curve."""
        return process_curve(task)

    def failed(self, task: CurveTask, error: BaseException) -> CurveRecord:
        """Return the record of a curve that could not be made."""
        crash = "" if isinstance(error, TribolabError) else "".join(format_exception(error))
        reason = explain(error)[0]
        return CurveRecord(
            replace(task.curve, data_file="", status="failed", reason=reason, crash=crash)
        )

    def keep(self, task: CurveTask, place: int, record: CurveRecord) -> CurveRecord:
        """Write down what came of a curve."""
        mark = task.fingerprint if record.outcome.done else ""
        self._store.put(KIND, task.curve.name, place, mark, record)
        return record


def process_curve(task: CurveTask) -> CurveRecord:
    """Combine the segments of several runs into a measured curve, write and record it.

    Raises
    ------
    TribolabError
        If the runs make no curve.
    """
    from tribolab.friction.coefficient.repeatability import run_levels
    from tribolab.friction.oscillation.slip_curve import stick_slip_curve
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.io.netcdf import read_groups
    from tribolab.records.frames import curve_table
    from tribolab.records.wording import plain_value

    with NETCDF:
        parts = [read_groups(task.folder / n, ("friction", SLIP)) for n in task.data_files]
    frictions = [part["friction"] for part in parts]
    curve = measured_stribeck_curve(frictions)
    levels: list[float | None] = []
    if len(frictions) > 1:
        curve = stamp(curve.assign(run_level=("run", run_levels(frictions))))
        levels = plain_value(curve["run_level"].values)
    groups: dict[str, xr.Dataset] = {}
    reason = ""
    try:
        groups[SLIP] = stick_slip_curve([part[SLIP] for part in parts])
    except Exception as error:  # recorded: the curve stands without it
        reason = explain(error)[0]
    shaped = [friction.attrs.get("config_sha256", "") for friction in frictions]
    curve.attrs |= _labels(task.curve) | {"config_sha256": sha256_of(shaped)}
    write_data({None: curve} | groups, task.folder / task.curve.data_file)
    return CurveRecord(
        task.curve,
        tuple(plain_value(curve_table(curve).to_dict("records"))),
        tuple(levels),
        digest(curve),
        Origin(str(curve.attrs.get("source", "")), str(curve.attrs.get("source_sha256", ""))),
        reason,
    )


def _labels(curve: CurveOutcome) -> dict[str, Any]:
    labels = {"curve_name": curve.name, "runs": "; ".join(curve.run_names)}
    return labels | {key: v for key in ("surface", "medium") if (v := getattr(curve, key))}


def _curve_name(surface: str, medium: str, load: float | None, alone: str) -> str:
    parts = [surface, medium, "" if load is None else f"{load:g}N", alone]
    return f"curve_{safe_name('_'.join(part for part in parts if part))}"
