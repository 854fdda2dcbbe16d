"""Analysis of one run: reading, segments, decisions, friction, stick-slip, checks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribolab.arrays.scratch import let_go
from tribolab.campaign.runs.reading import Earlier, earlier_signals, note_reading
from tribolab.campaign.runs.zeros import attributes
from tribolab.campaign.settings.plan import PlannedRun
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ConfigError
from tribolab.units.stamping import stamp

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.qc.findings import Findings

# Attributes of a run in a data file: worst status of its checks, and their results.
QUALITY, _FINDINGS = "quality", "findings"
_LOADS = {"normal_force", "normal_stress", "friction_coefficient"}  # any of them gives the load
AS_FOUND = "friction_as_found"  # group of a data file: friction without a person's decisions


class Analysed(NamedTuple):
    """Results of a run.

    Parameters
    ----------
    signals
        The run with the flags and findings of its checks (time).
    segments, friction, slip
        Its results (segment).
    quality
        Worst status of its checks, or a person's decision.
    friction_as_found, quality_as_found
        The same without a person's decisions; None and "" if nobody decided.
    whole
        Friction of all segments, also of those left out by `discard` and `steady`; else None.
    """

    signals: xr.Dataset
    segments: xr.Dataset
    friction: xr.Dataset
    slip: xr.Dataset
    quality: str
    friction_as_found: xr.Dataset | None = None
    quality_as_found: str = ""
    whole: xr.Dataset | None = None

    @property
    def groups(self) -> dict[str | None, xr.Dataset]:
        """Groups of the data file."""
        groups: dict[str | None, xr.Dataset] = {"run": self.signals, "segments": self.segments}
        groups |= {"friction": self.friction, "stick_slip": self.slip}
        if self.friction_as_found is not None:
            groups[AS_FOUND] = self.friction_as_found
        return groups


def analyse_run(run: PlannedRun, earlier: Earlier | None = None) -> Analysed:
    """Read a run, find segments and friction, apply decisions, and check it.

    Parameters
    ----------
    run
        The planned run.
    earlier
        Earlier results with its signals, to avoid reading its raw files.

    Raises
    ------
    TribolabError
        If it cannot be read or analysed, or a decision finds no segment.
    """
    # imported late for a quick start
    from tribolab.friction.decisions.decided_segments import decide, remove_decisions
    from tribolab.friction.segments.find import find_segments
    from tribolab.friction.temperature import sliding_area, sliding_temperature

    read = earlier and earlier_signals(earlier)
    read = _read(run) if read is None else read
    signals = _add_set_points(run, read)
    let_go()
    options = dict(run.segments)
    discard, steady = options.pop("discard", None), options.pop("steady", None)
    found = find_segments(signals, **options)
    segments, _ = _steady_part(run, signals, found, discard, steady)
    before: tuple[xr.Dataset | None, str] = (None, "")
    if any(decision.moves_numbers for decision in run.decisions):
        friction, _, judged = _evaluate(run, signals, segments)
        before = friction, judged.status
    segments = decide(found, run.decisions, signals)
    segments, whole = _steady_part(run, signals, segments, discard, steady)
    friction, slip, judged = _evaluate(run, signals, segments)
    friction.attrs.update(sliding_temperature(signals, segments))
    friction.attrs.update(sliding_area(signals, segments))
    if run.decisions and before[0] is None:  # the numbers are the same
        before = remove_decisions(friction), judged.status_as_found
    signals = judged.marked
    signals.attrs.update({QUALITY: judged.status, _FINDINGS: judged.rows})
    analysed = Analysed(signals, segments, friction, slip, judged.status, *before, whole)
    for data in analysed.groups.values():
        data.attrs.update(run_labels(run), config_sha256=run.config_sha256)
    note_reading(run, read, signals)
    return analysed


def _steady_part(
    run: PlannedRun,
    signals: xr.Dataset,
    segments: xr.Dataset,
    discard: str | None,
    steady: str | None,
) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Return the segments to use, and the friction of all segments if some may be left out."""
    if discard is None and steady is None:
        return segments, None
    # imported late for a quick start
    from tribolab.friction.coefficient.coefficient import friction_coefficient
    from tribolab.friction.running_in.steady_part import discard_start, steady_segments

    whole = friction_coefficient(signals, segments, **run.friction)
    if discard is not None:
        segments = discard_start(segments, discard)
    if steady is not None:
        segments = steady_segments(signals, segments, whole)
    return segments, whole


def run_labels(run: PlannedRun) -> dict[str, str]:
    """Return the labels that every dataset of a run gets as attributes."""
    return {"run_name": run.name} | {
        key: value
        for key in ("surface", "medium", "mount", "specimen")
        if (value := getattr(run, key))
    }


def _evaluate(
    run: PlannedRun, signals: xr.Dataset, segments: xr.Dataset
) -> tuple[xr.Dataset, xr.Dataset, Findings]:
    # imported late for a quick start
    from tribolab.friction.coefficient.coefficient import friction_coefficient
    from tribolab.friction.oscillation.slip_segments import stick_slip
    from tribolab.friction.zero.of_run import StatedZeroError
    from tribolab.metrology.budget import known_uncertainties, segment_uncertainty
    from tribolab.qc.run.checks import check_run

    let_go()
    try:
        friction = friction_coefficient(_add_uncertainties(run, signals), segments, **run.friction)
    except StatedZeroError as error:  # an error of the campaign file, not of the raw file
        raise ConfigError(error.what, where=run.zero_uncertainty_at) from error
    if "friction_coefficient" in friction:
        friction = segment_uncertainty(friction, known_uncertainties(friction))
    let_go()
    friction.attrs.update(attributes(friction, run.friction.get("other_zeros", ())))
    slip = stick_slip(signals, segments)
    let_go()
    return friction, slip, check_run(signals, segments, friction, slip, **run.quality)


def _add_uncertainties(run: PlannedRun, signals: xr.Dataset) -> xr.Dataset:
    """Return the signals with stated uncertainties; the campaign file overrides instruments."""
    stated = RunAttributes.from_attrs(signals.attrs).uncertainty | run.uncertainty
    return signals.assign_attrs(uncertainty=stated) if stated else signals


def _read(run: PlannedRun) -> xr.Dataset:
    # imported late for a quick start
    from tribolab.friction.inertia import without_inertia
    from tribolab.reading.unknown_run import read_run

    files = list(run.files)
    read = read_run(
        files if len(files) > 1 else files[0],
        run.instrument,
        clock_shift=run.clock_shift,
        zero=run.zero,
        moving_mass=run.moving_mass,
    )
    return without_inertia(read)  # if no mass is stated, the data may show one


def _add_set_points(run: PlannedRun, read: xr.Dataset) -> xr.Dataset:
    """Return the signals with the set-points of the campaign file."""
    signals = read.copy()
    if run.clock_shift is not None and "clock_shift_source" not in signals.attrs:
        missing = RunAttributes.from_attrs(signals.attrs).companion_missing
        raise ConfigError(
            f"{signals.attrs['source']}: there is no second log"
            f"{missing and f' ({missing})'} whose clock could be shifted; "
            "leave clock_shift out of its [[run]]"
        )
    if run.normal_force is not None:
        signals.attrs["set_normal_force_N"] = run.normal_force
    if run.stiffness is not None:
        # imported late for a quick start
        from tribolab.friction.oscillation.critical_stiffness import STIFFNESS

        signals.attrs[STIFFNESS] = run.stiffness
    if run.contact_area is not None:
        signals.attrs["contact_area_m2"] = run.contact_area
    if run.sliding_speed is not None:
        signals.attrs |= _stated_speed(signals, run.sliding_speed)
    return _add_stated_load(signals)


def _add_stated_load(signals: xr.Dataset) -> xr.Dataset:
    """Return the signals with the stated load, if friction but no load was recorded."""
    load = signals.get("set_normal_force", signals.attrs.get("set_normal_force_N"))
    if load is None or "friction_force" not in signals or _LOADS & set(signals.variables):
        return signals
    derived = RunAttributes.from_attrs(signals.attrs).derived | {"normal_force": "stated"}
    stated = np.broadcast_to(load, signals.sizes["time"]).astype(float)
    return stamp(signals.assign(normal_force=("time", stated)).assign_attrs(derived=derived))


def _stated_speed(signals: xr.Dataset, speed: float) -> dict[str, str | float]:
    """Return the attributes for a stated speed; raise if the file states another one."""
    own = signals.attrs.get("set_speed_m_s", speed)
    if "set_speed" in signals or not math.isclose(own, speed, rel_tol=1e-6):
        raise ConfigError(
            f"{signals.attrs['source']}: the file states its set speed; remove sliding_speed from "
            "its [[run]]"
        )
    return {"set_speed_m_s": speed, "set_speed_source": "campaign file"}
