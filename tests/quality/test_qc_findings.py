"""Findings and the register: nothing vanishes, every limit has a reason, bits never move."""

import dataclasses
import json

import numpy as np
import pytest
import xarray as xr

from tribolab.core.errors import ConfigError, UnitError
from tribolab.core.limit_page import LIMITS_PAGE, limits_page
from tribolab.qc import catalogue
from tribolab.qc.any_data import check
from tribolab.qc.findings import Findings, exit_code
from tribolab.qc.register import STATUSES, Check, Result
from tribolab.qc.run.checks import RUN_CHECKS, check_run
from tribolab.qc.scan.checks import SCAN_CHECKS
from tribolab.reading.schema_folder import schema_folder
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp

# Frozen: masks in files written long ago are read by these. Add to the end, change nothing.
BITS = {
    "schema": 0,
    "time_order": 1,
    "time_gaps": 2,
    "time_jitter": 3,
    "rate_changes": 4,
    "restarts": 5,
    "missing": 6,
    "stuck": 7,
    "saturation": 8,
    "quantisation": 9,
    "spikes": 10,
    "zero_offset": 11,
    "zero_drift": 12,
    "normal_force_error": 13,
    "normal_force_scatter": 14,
    "velocity_set": 15,
    "velocity_position": 16,
    "clock_shift": 17,
    "hum": 18,
    "resonance": 19,
    "friction_sign": 20,
    "steadiness": 21,
    "distance": 22,
    "sampling": 23,
    "segment_speed": 24,
    "rows_left_out": 25,
    "said_elsewhere": 27,
    "segments": 28,
    "zero_reference": 29,
    "rectified": 30,
}


@pytest.fixture(scope="module")
def run():
    time = np.arange(1000) / 100
    force = 5.0 + 0.05 * np.random.default_rng(0).standard_normal(1000)
    data = {"friction_force": ("time", force), "sliding_velocity": ("time", np.full(1000, 1e-3))}
    return stamp(xr.Dataset(data, {"time": time}), source="made")


def test_bits_are_what_they_always_were():
    assert {name: c.bit for name, c in RUN_CHECKS.items()} == BITS


def test_every_check_asks_and_cures_and_every_limit_has_a_unit_and_a_reason():
    for known in RUN_CHECKS.values():
        assert known.question.endswith("?") and known.cure.endswith(".")
        for name, limit in known.limits.items():
            assert len(limit.reason) > 20, (known.name, name)
            assert to_si(limit.value, limit.unit, name) == limit.value
        if {"suspect", "fail"} <= set(known.limits):
            assert 0 < known.limits["suspect"].value < known.limits["fail"].value


def test_every_check_answers_on_every_run(run):
    nothing = stamp(xr.Dataset({"position": ("time", [0.0])}, {"time": [0.0]}))
    for some in (run, run[["friction_force"]], run[["sliding_velocity"]], nothing):
        found = check_run(some)
        assert {c.name for c, _ in found.results} == set(RUN_CHECKS)
        assert found.count()["error"] == 0
        for _, result in found.results:
            assert result.status in STATUSES and result.message
            if result.status == "skipped":
                assert result.flags is None


def test_one_thing_is_said_in_the_singular():
    check = RUN_CHECKS["schema"]
    found = Findings("a", ((check, Result("pass", "time", "fine")),))
    assert found.summary == "a: pass (1 check passed)"


def test_what_could_not_be_looked_at_is_skipped_and_says_why(run):
    rows = {row["check"]: row for row in check_run(run).rows if row["status"] == "skipped"}
    assert "normal_force was not recorded" in rows["normal_force_error"]["message"]
    assert "one clock" in rows["clock_shift"]["message"]
    assert "spikes" not in rows
    speedless = check_run(run[["friction_force"]]).rows
    assert any(
        row["check"] == "schema" and "the speed is unknown" in row["message"]
        for row in speedless
        if row["status"] == "suspect"
    )


def test_a_check_that_crashes_is_a_finding_and_exit_code_3(run):
    def crash(subject, limits):
        raise ZeroDivisionError("division by zero")

    broken = dataclasses.replace(RUN_CHECKS["hum"], examine=crash)
    found = check_run(run, checks={**RUN_CHECKS, "hum": broken})
    row = found.rows[0]
    assert (row["check"], row["status"]) == ("hum", "error")
    assert "ZeroDivisionError: division by zero" in row["message"]
    assert found.status == "error"
    assert exit_code({found.status}) == exit_code({found.status}, "never") == 3
    assert {c.name for c, _ in found.results} == set(RUN_CHECKS)


def test_exit_codes_follow_the_level_that_is_asked_for():
    for fail_on, codes in {"suspect": (0, 1, 1), "fail": (0, 0, 1), "never": (0, 0, 0)}.items():
        found = tuple(exit_code({"pass", status}, fail_on) for status in STATUSES[1:4])
        assert found == codes
    with pytest.raises(ConfigError, match="did you mean 'suspect'"):
        exit_code({"pass"}, "suspekt")


def test_a_misspelt_check_or_limit_names_the_nearest(run):
    with pytest.raises(ConfigError, match="did you mean 'spikes'"):
        check_run(run, limits={"spike": {"noise": 3}})
    with pytest.raises(ConfigError, match="did you mean 'noise'"):
        check_run(run, limits={"spikes": {"nois": 3}})
    with pytest.raises(ConfigError, match="did you mean 'saturation'"):
        check_run(run, skip=["saturatoin"])
    with pytest.raises(UnitError, match="normal_force"):
        check_run(run, normal_force="31 m")


def test_limits_can_be_set_and_are_told(run):
    spiked = run.copy(deep=True)
    spiked.friction_force[500] += 0.3  # some six standard deviations
    strict = check_run(spiked, limits={"spikes": {"noise": 3.0}})
    loose = check_run(spiked, limits={"spikes": {"noise": "1000 percent"}})
    assert ["pass", "suspect"] == [
        next(row["status"] for row in found.rows if row["check"] == "spikes")
        for found in (loose, strict)
    ]
    told = next(row for row in strict.rows if row["check"] == "spikes")["limits"]
    assert told == {"noise": 3.0, "fail": 0.01, "mean": 0.005}


def test_a_skipped_check_is_listed_and_the_short_name_does_the_same(run):
    found = check(run, skip=["spikes"])
    assert [row["status"] for row in found.rows if row["check"] == "spikes"] == ["skipped"]
    assert check(run).rows == check_run(run).rows


def test_rows_are_graver_first_and_fit_for_json(run):
    spiked = run.copy(deep=True)
    spiked.friction_force[500] += 5
    spiked.friction_force[100:400] = np.nan
    found = check_run(spiked)
    order = [STATUSES.index(row["status"]) for row in found.rows]
    assert order == sorted(order, reverse=True) and found.status == "fail"
    assert json.loads(json.dumps(found.rows, allow_nan=False)) == found.rows
    assert list(found.table.columns)[:3] == ["name", "check", "status"]
    assert len(found.table) == len(found.rows)


def test_the_checked_run_stays_as_it_was(run):
    before = run.copy(deep=True)
    check_run(run)
    xr.testing.assert_identical(run, before)


def test_a_check_of_ones_own_can_be_added(run):
    own = Check("mine", 30, "Mine?", "Mend it.", {}, lambda s, _: [Result("suspect", "", "no")])
    found = check_run(run, checks={"mine": own})
    assert found.status == "suspect" and found.rows[0]["cure"] == "Mend it."


def test_the_page_of_all_checks_and_limits_is_made_from_the_code():
    page = (schema_folder() / catalogue.CHECKS_PAGE).read_text(encoding="utf-8")
    assert page == catalogue.catalogue()
    for known in (*RUN_CHECKS.values(), *SCAN_CHECKS.values()):
        assert f"### {known.name}\n" in page


def test_the_page_of_all_limits_is_made_from_the_code():
    page = (schema_folder() / LIMITS_PAGE).read_text(encoding="utf-8")
    assert page == limits_page()
