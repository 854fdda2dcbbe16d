"""Quality flags: severities combine, nothing unchecked is good, and others can read them."""

import cf_xarray  # noqa: F401 - brings the .cf accessor
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from tribolab.qc.flags import (
    FAIL,
    GOOD,
    MISSING,
    NOT_EVALUATED,
    SUSPECT,
    attach,
    combine,
)
from tribolab.qc.run.checks import check_run
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
from tribolab.units.stamping import stamp

SEVERITIES = [NOT_EVALUATED, GOOD, SUSPECT, FAIL, MISSING]  # from what yields to what prevails
same_length = st.integers(1, 20).flatmap(
    lambda n: st.lists(
        st.lists(st.sampled_from(SEVERITIES), min_size=n, max_size=n), min_size=1, max_size=4
    )
)


@given(same_length)
def test_the_gravest_severity_prevails_in_any_order(rows):
    arrays = [np.array(row, dtype=np.int8) for row in rows]
    expected = [max(column, key=SEVERITIES.index) for column in zip(*rows, strict=True)]
    assert combine(arrays).tolist() == expected
    assert combine(arrays[::-1]).tolist() == expected
    assert combine([combine(arrays), *arrays]).tolist() == expected


def test_combining_changes_no_input():
    first = np.array([GOOD, GOOD], dtype=np.int8)
    combine([first, np.array([FAIL, SUSPECT], dtype=np.int8)])
    assert first.tolist() == [GOOD, GOOD]


def test_what_no_check_looked_at_is_not_good():
    data = stamp(xr.Dataset({"position": ("time", [0.0, 1.0])}, {"time": [0.0, 1.0]}))
    flagged = attach(data, "position", {}, {"spikes": 10})
    assert flagged.position_qc.values.tolist() == [NOT_EVALUATED, NOT_EVALUATED]
    half = attach(data, "position", {"spikes": np.array([NOT_EVALUATED, GOOD])}, {"spikes": 10})
    assert half.position_qc.values.tolist() == [NOT_EVALUATED, GOOD]
    assert "position_qc" not in data and "ancillary_variables" not in data.position.attrs


@pytest.fixture(scope="module")
def flagged():
    """Two seconds at rest, two in motion; a spike, a gap in the values, and a gap in time."""
    rng = np.random.default_rng(4)
    time = np.arange(400) / 100
    time[300:] += 0.5
    force = 5.0 + 0.01 * rng.standard_normal(400)
    force[250], force[20] = 7.0, np.nan
    data = {"friction_force": ("time", force), "sliding_velocity": ("time", np.full(400, 1e-3))}
    return check_run(stamp(xr.Dataset(data, {"time": time}), source="made")).flagged


def test_flags_say_which_check_objected_to_which_sample(flagged):
    severity = flagged.friction_force_qc.values
    tests = flagged.friction_force_qc_tests
    bits = dict(
        zip(tests.attrs["flag_meanings"].split(), tests.attrs["flag_masks"].tolist(), strict=True)
    )
    assert severity[250] == SUSPECT and tests.values[250] == bits["spikes"]
    assert severity[20] == MISSING and tests.values[20] == bits["missing"]
    assert severity[300] == SUSPECT and tests.values[300] == bits["time_gaps"]
    others = np.delete(np.arange(400), [20, 250, 300])
    assert (severity[others] == GOOD).all() and (tests.values[others] == 0).all()


def test_a_gap_in_time_marks_every_signal(flagged):
    assert flagged.sliding_velocity_qc.values[300] == SUSPECT


def test_flags_survive_a_file_and_others_read_them(flagged, tmp_path):
    write_netcdf(flagged, tmp_path / "run.nc")
    own = read_netcdf(tmp_path / "run.nc")
    for name in ("friction_force_qc", "friction_force_qc_tests"):
        assert (own[name].values == flagged[name].values).all()
        assert own[name].dtype == flagged[name].dtype
    with xr.open_dataset(tmp_path / "run.nc", decode_timedelta=False) as other:
        quality = other["friction_force_qc"]
        assert (quality.cf == "suspect").values.nonzero()[0].tolist() == [250, 300]
        assert (quality.cf == "missing").values.nonzero()[0].tolist() == [20]
        decoded = other["friction_force_qc_tests"].cf.flags
        assert decoded["spikes"].values.nonzero()[0].tolist() == [250]
        assert decoded["missing"].values.nonzero()[0].tolist() == [20]
        linked = other.cf.get_associated_variable_names("friction_force")["ancillary_variables"]
        assert sorted(linked) == ["friction_force_qc", "friction_force_qc_tests"]
