"""Made-up results for the tests of figures and report, as the analysis builds them."""

import json
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.store.data_files import write_data
from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.store.outcome import Outcome
from tribolab.friction.oscillation.slip_curve import stick_slip_curve
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.records.frames import curve_table, plain_rows, stick_slip_columns
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome, RunOutcome
from tribolab.records.runs.notices import notices_of
from tribolab.records.runs.run_facts import facts_of
from tribolab.records.runs.run_record import RunRecord
from tribolab.records.runs.traces import page_trace, trace_size
from tribolab.records.wording import plain_value
from tribolab.units.stamping import stamp

SPEEDS = (1e-6, 4.64e-5, 1e-2)


def made_run(speeds=SPEEDS, load=31.0, mu=0.8, seed=0, samples=400, stroke=2e-3, rest=2.0):
    """Return run, segments and friction of strokes forward and backward at each speed."""
    rng = np.random.default_rng(seed)
    time, velocity = [], []
    now, rows, left_out = 0.0, [], []

    def add(duration, n, v):
        nonlocal now
        part = now + np.arange(n) * duration / n
        time.append(part)
        velocity.append(np.full(n, v))
        now += duration

    for number, speed in enumerate(speeds):
        for direction in (1, -1):
            left_out.append((now, now + rest, "at rest"))
            add(rest, 20, 0.0)
            length = stroke / speed
            rows.append((now, now + length, speed, direction, number))
            add(length, samples, direction * speed)
    left_out.append((now, now + rest, "at rest"))
    add(rest, 20, 0.0)
    time, velocity = np.concatenate(time), np.concatenate(velocity)
    force = np.sign(velocity) * mu * load + rng.normal(0, 0.02 * load, time.size)
    moved = np.r_[0.0, np.cumsum((velocity[1:] + velocity[:-1]) / 2 * np.diff(time))]
    run = stamp(
        xr.Dataset(
            {
                "friction_force": ("time", force),
                "normal_force": ("time", load + rng.normal(0, 0.05, time.size)),
                "sliding_velocity": ("time", velocity),
                "position": ("time", moved),
            },
            {"time": time},
        ),
        source="made.csv",
        source_sha256="0" * 64,
        tribolab_version="0.1.0",
        history="made for a test",
        instrument="linear_slider",
        columns_not_used="Temp [C]; Aux",
    )
    start, stop, speed, direction, pair = (np.array(c) for c in zip(*rows, strict=True))
    trim = 0.1 * (stop - start)
    segments = stamp(
        xr.Dataset(
            {
                "start": ("segment", start),
                "stop": ("segment", stop),
                "trimmed_start": ("segment", start + trim),
                "trimmed_stop": ("segment", stop - trim),
                "sliding_speed": ("segment", speed),
                "direction": ("segment", direction.astype("int8")),
                "sliding_distance": ("segment", 0.8 * speed * (stop - start)),
                "samples": ("segment", np.full(start.size, int(0.8 * samples))),
            },
            {"segment": np.arange(start.size)},
        ),
        trim=0.1,
        velocity_source="recorded",
    )
    segments["omitted_start"] = ("omitted", np.array([row[0] for row in left_out]))
    segments["omitted_stop"] = ("omitted", np.array([row[1] for row in left_out]))
    segments["omitted_reason"] = ("omitted", np.array([row[2] for row in left_out], dtype=object))
    ratio = force / np.asarray(run["normal_force"])
    mean, std = [], []
    for k in range(start.size):
        inside = (time >= start[k] + trim[k]) & (time <= stop[k] - trim[k])
        mean.append(direction[k] * ratio[inside].mean())
        std.append(ratio[inside].std(ddof=1))
    mean, std = np.array(mean), np.array(std)
    effective = np.full(start.size, 0.5 * samples)
    friction = segments.drop_dims("omitted").assign(
        friction_coefficient=("segment", mean),
        friction_coefficient_std=("segment", std),
        friction_coefficient_sem=("segment", std / np.sqrt(effective)),
        effective_samples=("segment", effective),
        autocorrelation_time=("segment", np.full(start.size, 0.1)),
        trend=("segment", np.full(start.size, 1e-6)),
        trend_change=("segment", np.full(start.size, 1e-4)),
        trend_p_value=("segment", np.full(start.size, 0.4)),
        steady=("segment", np.ones(start.size, "int8")),
        friction_force=("segment", mean * load),
        normal_force=("segment", np.full(start.size, load)),
        friction_force_offset=("segment", np.zeros(start.size)),
        pair=("segment", pair),
        half_loop=("segment", mean * load),
    )
    return run, segments, stamp(friction, offset="half loop")


def record_run(store, place, outcome, run, segments, friction):
    """Write the data file of a run, and all that a worker records of it."""
    slip = stick_slip(run, segments)
    groups = {"run": run, "segments": segments, "friction": friction, "stick_slip": slip}
    write_data(groups, store.folder / outcome.data_file)
    record = RunRecord(
        outcome,
        (("raw/made.csv", "ab" * 32, 9),),
        facts=facts_of(run, segments, friction, slip),
        notices=tuple(notices_of(outcome.name, run, segments, friction)),
        slip=plain_rows(stick_slip_columns(slip)),
    )
    trace = page_trace(run, segments, friction, *trace_size(5))
    store.put("run", outcome.name, place, "", record, trace)
    return slip


def with_run(outcome, index, parts, **changes):
    """Return an outcome in which a run has other signals and results, and `changes` in its own."""
    run = replace(outcome.runs[index], **changes)
    record_run(outcome.store, index, run, *parts)
    runs = [run if place == index else other for place, other in enumerate(outcome.runs)]
    return replace(outcome, runs=tuple(runs))


def without_curves(outcome):
    """Return an outcome without measured curves."""
    outcome.store.order("curve", [])
    return replace(outcome, curves=())


def record_curve(store, place, outcome, curve, slips):
    """Write the data file of a measured curve, and all that a worker records of it."""
    groups = {None: curve, "stick_slip": stick_slip_curve(slips)}
    write_data(groups, store.folder / outcome.data_file)
    points = plain_value(curve_table(curve).to_dict("records"))
    store.put("curve", outcome.name, place, "", CurveRecord(outcome, tuple(points)))


def made_curve(speeds=SPEEDS, mu=0.8, surface="Sb-R", medium="glycerol", load=31.0):
    """Return a measured curve."""
    speeds = np.array(speeds, float)
    mean = mu * (1 - 0.15 * np.log10(speeds / speeds[0] + 1e-300))
    curve = xr.Dataset(
        {
            "friction_coefficient": ("sliding_speed", mean),
            "friction_coefficient_std": ("sliding_speed", 0.05 * mean),
            "friction_coefficient_sem": ("sliding_speed", 0.01 * mean),
            "friction_coefficient_U95": ("sliding_speed", 0.02 * mean),
            "friction_coefficient_within": ("sliding_speed", 0.05 * mean),
            "friction_coefficient_between": ("sliding_speed", 0.02 * mean),
            "runs": ("sliding_speed", np.full(speeds.size, 3)),
            "segments": ("sliding_speed", np.full(speeds.size, 6)),
        },
        {"sliding_speed": speeds},
    )
    return stamp(curve, surface=surface, medium=medium, normal_force_N=load)


CAMPAIGN = """[campaign]
name = {name}

[[run]]
files = "*.csv"
"""


def made_outcome(
    folder, runs, name="A made campaign", failed=(), speeds=SPEEDS, samples=400, note=None
):
    """Write data files and records of made runs and return their outcome.

    `runs` has (name, surface, medium, load, mu) of each run, `failed` (name, reason).
    """
    campaign_file = folder / "campaign.toml"
    (folder / "raw").mkdir(parents=True)
    (folder / "raw" / "made.csv").write_text("t,F\n0,1\n")
    campaign_file.write_text(CAMPAIGN.format(name=json.dumps(name)), encoding="utf-8")
    results = folder / "results"
    (results / "data").mkdir(parents=True)
    store = Store(results)
    outcomes, groups = [], {}
    for number, (run_name, surface, medium, load, mu) in enumerate(runs):
        parts = made_run(speeds, load or 31.0, mu, seed=number, samples=samples)
        outcome = RunOutcome(
            name=run_name,
            files=("raw/made.csv",),
            surface=surface,
            medium=medium,
            normal_force=load,
            status="done",
            data_file=f"data/run{number}.nc",
            seconds=0.5,
            segments=parts[1].sizes["segment"],
        )
        slip = record_run(store, number, outcome, *parts)
        outcomes.append(outcome)
        groups.setdefault((surface, medium, load), []).append((run_name, mu, slip))
    for run_name, reason in failed:
        outcome = RunOutcome(
            name=run_name,
            files=("raw/bad.csv",),
            surface="",
            medium="",
            normal_force=None,
            status="failed",
            reason=reason,
            error="ReadError",
        )
        store.put("run", run_name, len(outcomes), "", RunRecord(outcome, (("raw/bad.csv", "", 0),)))
        outcomes.append(outcome)
    curves = []
    for number, ((surface, medium, load), members) in enumerate(groups.items()):
        names = tuple(member for member, _, _ in members)
        outcome = CurveOutcome(
            f"curve{number}", surface, medium, load, f"data/curve{number}.nc", names
        )
        curve = made_curve(speeds, members[0][1], surface, medium, load or float("nan"))
        record_curve(store, number, outcome, curve, [slip for _, _, slip in members])
        curves.append(outcome)
    campaign = Campaign(campaign={"name": name, "note": note}, run=[{"files": "*.csv"}])
    campaign.set_file(campaign_file)
    return Outcome(
        campaign=campaign,
        folder=results,
        store=store,
        runs=tuple(outcomes),
        curves=tuple(curves),
        sources=(("raw/made.csv", "ab" * 32, 9), ("raw/bad.csv", "", 0)),
    )
