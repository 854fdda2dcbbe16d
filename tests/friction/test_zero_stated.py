"""What a campaign or a dialect says of the zero, and what runs of a campaign lend."""

import numpy as np
import pytest
from dialects import dialect_of
from zero_cases import BOTH, SPEED, off, programme

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.reading.run_files import read

DIALECT = dialect_of(
    "one_rig", time="t", sliding_velocity="v", friction_force="F", normal_force="N"
)


def write_campaign(folder, runs, entry=""):
    (folder / "raw").mkdir(parents=True, exist_ok=True)
    (folder / "one_rig.toml").write_text(DIALECT, "utf-8")
    for name, run in runs.items():
        columns = [run["time"], run["sliding_velocity"], run["friction_force"], run["normal_force"]]
        rows = np.column_stack([column.values for column in columns])
        header = "t [s],v [m/s],F [N],N [N]"
        np.savetxt(folder / "raw" / name, rows, "%.9g", ",", header=header, comments="")
    text = '[campaign]\nname = "zeros"\n[[run]]\nfiles = "*.csv"\ninstrument = "one_rig.toml"\n'
    (folder / "campaign.toml").write_text(text + entry, "utf-8")
    return load_campaign(folder / "campaign.toml")


@pytest.mark.slow
def test_runs_of_a_campaign_lend_their_zeros_to_one_that_has_none(tmp_path):
    runs = {
        f"{i}.csv": programme(BOTH, zero=lambda u, f=f: f + 0 * u, loaded_rests=True, seed=i)
        for i, f in enumerate((1.9, 2.0, 2.15))
    }
    stops = [SPEED, None, SPEED]
    runs["one_way.csv"] = programme(stops, zero=lambda u: 2.05 + 0 * u, loaded_rests=True, seed=9)
    campaign = write_campaign(tmp_path, runs)
    outcome = process(campaign, tmp_path / "first")
    lent = {run.name: run for run in outcome.runs}["one_way"]
    friction = read_netcdf(tmp_path / "first" / lent.data_file, group="friction")
    assert friction.attrs["offset"] == "other runs"
    assert set(friction["zero_from"].values) == {"zeros of 3 other runs on this instrument"}
    assert (np.abs(off(friction)) < 3).all()
    # taken over as it is, and done again once a lender is gone
    again = process(campaign, tmp_path / "second", previous=tmp_path / "first")
    assert all(run.reused for run in again.runs)
    (tmp_path / "raw" / "2.csv").unlink()
    left = process(campaign, tmp_path / "third", previous=tmp_path / "second")
    done = [run.name for run in left.runs if not run.reused and not run.kept]
    assert done == ["one_way"]  # and the result of the file that is gone is kept, but lends nothing
    friction = read_netcdf(tmp_path / "third" / lent.data_file, group="friction")
    assert set(friction["zero_from"].values) == {"zeros of 2 other runs on this instrument"}


@pytest.mark.parametrize("layout", ["the same", "another"])
def test_of_drafted_files_only_those_of_one_layout_lend_a_zero(tmp_path, layout):
    """Two programs' files are two rigs' where nobody says otherwise."""
    runs = {f"{i}.csv": programme(BOTH, loaded_rests=True, seed=i) for i in range(2)}
    runs["one_way.csv"] = programme([SPEED, None, SPEED], loaded_rests=True, seed=9)
    write_campaign(tmp_path, runs)
    for file in (tmp_path / "raw").iterdir():
        ours = "time [s];speed [m/s];Fx [N];Fz [N]"
        theirs = "Zeit [s];Geschwindigkeit [m/s];Reibkraft [N];Normalkraft [N]"
        other = layout == "another" and file.name == "one_way.csv"
        rows = file.read_text("utf-8").splitlines()[1:]
        text = "\n".join([theirs if other else ours, *(row.replace(",", ";") for row in rows)])
        file.write_text(text, "utf-8")
    text = (tmp_path / "campaign.toml").read_text("utf-8")
    text = text.replace('instrument = "one_rig.toml"\n', "")
    (tmp_path / "campaign.toml").write_text(text, "utf-8")
    outcome = process(load_campaign(tmp_path / "campaign.toml"), tmp_path / "results")
    [run] = [run for run in outcome.runs if run.name == "one_way"]
    friction = read_netcdf(tmp_path / "results" / run.data_file, group="friction")
    lent = str(friction.attrs["offset"]) == "other runs"
    assert lent == (layout == "the same")
    assert (run.quality == "suspect") == (not lent)


@pytest.mark.filterwarnings("ignore:.*in the instrument's file:FutureWarning")
@pytest.mark.parametrize("entry", ["", 'zero_uncertainty = "1 N"\n', "rectified = true\n"])
def test_what_the_campaign_file_states_of_the_zero_reaches_the_result(tmp_path, entry):
    run = programme([SPEED, None, SPEED], zero=lambda u: 0.5 + 0 * u, loaded_rests=True)
    outcome = process(write_campaign(tmp_path, {"one.csv": run}, entry), tmp_path / "new")
    friction = read_netcdf(tmp_path / "new" / outcome.runs[0].data_file, group="friction")
    stated = "zero_uncertainty" in entry
    assert (friction.attrs["offset"] == "stated") == stated
    assert friction["zero_from"].values[0].startswith("recorded without sign") == (
        "rectified" in entry
    )
    assert (outcome.runs[0].quality == "pass") == stated


def test_the_dialect_states_zero_and_sign_of_friction_only(tmp_path):
    run = programme([SPEED] * 2, zero=lambda u: 0.5 + 0 * u, loaded_rests=True)
    write_campaign(tmp_path, {"one.csv": run})
    stated = DIALECT.replace(
        'name = "F"', 'name = "F"\nzero_uncertainty = "500 mN"\nrectified = false'
    )
    (tmp_path / "one_rig.toml").write_text(stated, "utf-8")
    found = read(tmp_path / "raw" / "one.csv", tmp_path / "one_rig.toml")
    assert found.attrs["friction_force_zero_uncertainty_N"] == 0.5
    assert found.attrs["friction_force_rectified"] is False
    wrong = DIALECT.replace('name = "N"', 'name = "N"\nzero_uncertainty = "1 N"')
    (tmp_path / "one_rig.toml").write_text(wrong, "utf-8")
    with pytest.raises(ConfigError, match="zero_uncertainty is for friction_force"):
        read(tmp_path / "raw" / "one.csv", tmp_path / "one_rig.toml")
