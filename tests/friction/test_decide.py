"""What a person decides on segments holds for their numbers, and touches no others."""

import numpy as np
import pytest
from made_runs import strokes, with_friction

from tribolab.core.errors import AnalysisError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.decisions.bounds import LEFT
from tribolab.friction.decisions.decided_segments import decide
from tribolab.friction.decisions.decision import Decision
from tribolab.friction.decisions.rejected import kept
from tribolab.friction.oscillation.slip_curve import stick_slip_curve
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.segments.find import find_segments
from tribolab.friction.stribeck import measured_stribeck_curve
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf

SAID = {"reason": "slipped off", "author": "A. Person", "date": "2026-11-20"}
MU, BAD = 0.3, 2


@pytest.fixture(scope="module")
def run():
    """Three loops; in the third stroke the slider lost half of its friction."""
    made = strokes((1e-4, 2e-4, 4e-4))
    run = with_friction(made, MU, offset=1.5)
    time = run["time"].values
    lost = (time >= made.start[BAD]) & (time <= made.stop[BAD])
    force = np.where(lost, 0.5, 1.0) * run["friction_force"].values
    return run.assign(friction_force=run["friction_force"].copy(data=force))


@pytest.fixture(scope="module")
def segments(run):
    return find_segments(run)


def within(segments, place, low=0.2, high=0.8):
    """An interval within a segment, by parts of its duration."""
    start, stop = (float(segments[name].values[place]) for name in ("start", "stop"))
    return {"start": start + low * (stop - start), "stop": start + high * (stop - start)}


def test_a_rejected_stroke_spoils_no_other_and_stays_to_be_seen(run, segments):
    before = friction_coefficient(run, segments)
    decided = decide(segments, Decision("reject", **SAID, **within(segments, BAD)))
    after = friction_coefficient(run, decided)
    mu = after["friction_coefficient"].values
    others = np.arange(mu.size) != BAD
    partner = int(np.flatnonzero(before["pair"].values == before["pair"].values[BAD])[-1])
    assert abs(before["friction_coefficient"].values[partner] - MU) > 0.05
    assert np.abs(mu[others] - MU).max() < 0.003
    assert mu[BAD] == before["friction_coefficient"].values[BAD]
    assert after["rejected"].values.tolist() == [0, 0, 1, 0, 0, 0]
    # as if the stroke had never been found
    alone = friction_coefficient(run, segments.isel(segment=np.flatnonzero(others)))
    for name in ("friction_coefficient", "friction_coefficient_sem", "friction_force_offset"):
        assert kept(after)[name].values.tolist() == alone[name].values.tolist(), name
    assert (after["pair"].values.max(), after["pair"].values[BAD]) == (1, -1)


def test_curves_leave_rejected_segments_out(run, segments):
    decided = decide(segments, Decision("reject", **SAID, **within(segments, BAD)))
    friction, slip = friction_coefficient(run, decided), stick_slip(run, decided)
    assert measured_stribeck_curve([friction])["segments"].values.tolist() == [2, 1, 2]
    assert stick_slip_curve([slip])["segments"].values.tolist() == [2, 1, 2]
    nothing = friction_coefficient(run, decide(segments, Decision("reject", **SAID)))
    assert nothing["rejected"].values.all()
    assert measured_stribeck_curve([nothing]).sizes["sliding_speed"] == 0


def test_new_bounds_are_those_of_a_segment_found_there(run, segments):
    new = within(segments, 1, 0.25, 0.75)
    decision = Decision(
        "bounds", **SAID, **within(segments, 1), new_start=new["start"], new_stop=new["stop"]
    )
    decided = decide(segments, decision, run)
    part = {name: decided[name].values[1] for name in ("start", "stop", "trimmed_start")}
    assert (part["start"], part["stop"]) == (new["start"], new["stop"])
    length = new["stop"] - new["start"]
    assert part["trimmed_start"] == pytest.approx(new["start"] + 0.1 * length)
    inside = (run["time"] >= decided["trimmed_start"][1]) & (
        run["time"] <= decided["trimmed_stop"][1]
    )
    assert decided["samples"].values[1] == int(inside.sum())
    assert decided["sliding_distance"].values[1] == pytest.approx(1e-4 * 0.8 * length, rel=0.01)
    assert decided["omitted_reason"].values.tolist().count(LEFT) == 2
    # no moment of the run is lost, or there twice
    covered = sum(
        float((data[f"{kind}stop"] - data[f"{kind}start"]).sum())
        for data, kind in ((decided, ""), (decided, "omitted_"))
    )
    before = sum(
        float((segments[f"{kind}stop"] - segments[f"{kind}start"]).sum())
        for kind in ("", "omitted_")
    )
    assert covered == pytest.approx(before)
    others = np.arange(6) != 1
    for name in ("start", "stop", "samples", "sliding_speed"):
        assert decided[name].values[others].tolist() == segments[name].values[others].tolist()


@pytest.mark.parametrize("known", ["recorded", "position", "step"])
def test_bounds_that_are_the_old_ones_change_nothing_whatever_tells_the_speed(run, known):
    time, velocity = run["time"].values, run["sliding_velocity"].values
    moved = np.r_[0.0, np.cumsum(velocity[1:] * np.diff(time))]
    bare = run.drop_vars("sliding_velocity").assign(position=("time", moved))
    if known == "recorded":
        bare = run.assign(position=("time", moved))
    elif known == "step":
        bare = bare.assign(step=("time", np.repeat([1.0, 2.0], [1600, time.size - 1600])))
        bare = bare.drop_vars("position")
    track = None if known == "step" else (0.1e-3, 0.5e-3)
    found = find_segments(bare, position_range=track)
    start, stop = (float(found[name].values[1]) for name in ("start", "stop"))
    same = Decision("bounds", **SAID, start=start, stop=stop, new_start=start, new_stop=stop)
    decided = decide(found, same, bare)
    assert found.attrs["velocity_source"] == known
    for name in found.variables:
        np.testing.assert_array_equal(decided[name].values, found[name].values, err_msg=name)


def test_a_decision_holds_when_its_segment_moves_or_gets_another_number(run, segments):
    decision = Decision("reject", **SAID, **within(segments, BAD, -0.3, 0.9))
    later = find_segments(run.isel(time=run["time"].values > segments["stop"].values[0]))
    assert decide(segments, decision)["rejected"].values.tolist() == [0, 0, 1, 0, 0, 0]
    assert decide(later, decision)["rejected"].values.tolist() == [0, 1, 0, 0, 0]


def test_all_that_was_decided_is_told_and_survives_a_file(run, segments, tmp_path):
    where = within(segments, BAD)
    squeaks = Decision("note", "squeaks", "B", "2026-11-21", **where)
    humid = Decision("note", "humid day", "B", "2026-11-21")
    decided = decide(segments, [Decision("reject", **SAID, **where), squeaks, humid])
    text = "rejected by A. Person: slipped off; noted by B: squeaks"
    assert decided["decision"].values.tolist() == ["", "", text, "", "", ""]
    first, _, second = decided.attrs["decisions"]
    assert first["segments"] == [BAD + 1] and second["segments"] == [1, 2, 3, 4, 5, 6]
    assert (first["start_s"], first["date"], second["start_s"]) == (
        where["start"], "2026-11-20", None,
    )  # fmt: skip
    assert read_netcdf(write_netcdf(decided, tmp_path / "segments.nc")).identical(decided)
    assert decide(segments, []) is segments


def test_a_decision_that_finds_no_segment_or_contradicts_another_says_so(run, segments):
    inside = within(segments, BAD)
    reject, accept = (Decision(action, **SAID, **inside) for action in ("reject", "accept"))
    rest = Decision(
        "reject", **SAID, start=segments["stop"].values[0], stop=segments["start"].values[1]
    )
    with pytest.raises(AnalysisError, match=r"finds no segment.*the nearest: 1 \("):
        decide(segments, rest)
    with pytest.raises(AnalysisError, match="contradict each other; take one out"):
        decide(segments, [reject, accept])
    with pytest.raises(AnalysisError, match="contradict"):
        decide(segments, [Decision("reject", **SAID), accept])
    # a run may be accepted without one of its segments
    assert decide(segments, [Decision("accept", **SAID), reject])["rejected"].values.sum() == 1
    friction = friction_coefficient(run, segments)
    with pytest.raises(AnalysisError, match="depends on it; decide on the segments"):
        decide(friction, reject)
    without = friction_coefficient(run, segments, "none")
    assert decide(without, reject)["rejected"].values.tolist() == [0, 0, 1, 0, 0, 0]


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [
        (0.0, 1e6, "outside the run"),
        (-1.0, 0.5, "reach into segment 2"),
        (1.2, 1.4, "lie outside the segment"),
        (0.5, 0.5001, "leave no samples"),
    ],
)
def test_new_bounds_that_cannot_be_are_refused(run, segments, low, high, said):
    new = within(segments, BAD, low, high)
    decision = Decision(
        "bounds", **SAID, **within(segments, BAD), new_start=new["start"], new_stop=new["stop"]
    )
    with pytest.raises(AnalysisError, match=said):
        decide(segments, decision, run)
    with pytest.raises(AnalysisError, match="needs the run"):
        decide(segments, decision)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"action": "rejct"}, "did you mean 'reject'"),
        ({"start": "1 s"}, "both its ends"),
        ({"start": "2 s", "stop": "1 s"}, "ends at 1 s"),
        ({"new_start": "2 s"}, "only 'bounds' has new bounds"),
        ({"action": "bounds", "start": 1.0, "stop": 2.0}, "a new beginning or end"),
        ({"date": "20.11.2026"}, "year, month and day"),
        ({"author": " "}, "must state its author"),
        ({"start": float("nan"), "stop": 2.0}, "is no time"),
    ],
)
def test_what_is_no_decision_is_refused(wrong, said):
    with pytest.raises(AnalysisError, match=said):
        Decision(**({"action": "reject"} | SAID | wrong))
