"""A campaign over measured files of real instruments, of which hardly anything is known."""

import pytest

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.reading.netcdf.netcdf import read_netcdf

TEXT = """
[campaign]
name = "what lies about in laboratories"
raw = "{raw}"

[[run]]
files = "actuator_friction_CC0/*.csv"
[run.segments]
position_range = ["5 mm", "32 mm"]

[[run]]
files = "rock_velstep_MIT/*.txt"

[[run]]
files = "stickslip_paper_CeCILL-B/*.mat"

[[run]]
files = "cetr_umt2_MIT/*.csv"
cycles = true
"""


# half loop [N], speeds forward and backward [m/s], as computed independently
ACTUATOR = {
    "Circle_1bar": (5.631, 10.12e-3, 12.26e-3),
    "Kidney_2bar": (12.541, 12.72e-3, 15.01e-3),
    "O-ring257_1bar": (7.002, 13.48e-3, 15.01e-3),
}


@pytest.mark.slow
def test_every_instrument_gets_as_far_as_its_files_allow(shared_data, tmp_path):
    campaign = tmp_path / "campaign.toml"
    campaign.write_text(TEXT.format(raw=shared_data.as_posix()), encoding="utf-8")
    outcome = process(load_campaign(campaign), tmp_path / "new")
    done = {run.name: run for run in outcome.runs if run.done}
    assert {"Circle_1bar", "Kidney_2bar", "O-ring257_1bar", "k168Nm_v1100"} <= set(done)
    for name, (newtons, forward, backward) in ACTUATOR.items():
        friction = read_netcdf(tmp_path / "new" / done[name].data_file, group="friction")
        assert float(friction.half_loop.mean()) == pytest.approx(newtons, rel=0.01)
        for direction, speed in ((1, forward), (-1, backward)):
            found = friction.sliding_speed[friction.direction == direction]
            assert float(found.mean()) == pytest.approx(speed, rel=0.02)
    rock = read_netcdf(
        tmp_path / "new" / done["velstep4_BRAVA_expb819_basalt"].data_file, group="friction"
    )
    assert rock.friction_coefficient.values == pytest.approx([0.60758, 0.60796], rel=1e-3)
    assert done["k168Nm_v1100"].segments == 1
