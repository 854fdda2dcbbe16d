"""Any folder of raw files: what is in it, how repeats are grouped, what the options state."""

from __future__ import annotations

import re
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

from tribolab import cli
from tribolab.app.new_campaign import COMMENTED
from tribolab.app.questions.stated import Stated
from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.load import load_and_plan
from tribolab.core.errors import ConfigError


def command(*arguments):
    return CliRunner().invoke(cli.app, [str(each) for each in arguments])


def write_strokes(file, mu=0.4, seed=0):
    """Two strokes both ways at 1 and at 10 mm/s under 5 N."""
    rng = np.random.default_rng(seed)
    file.parent.mkdir(parents=True, exist_ok=True)
    rows = []
    for speed in (1.0, -1.0, 10.0, -10.0) * 2:
        force = 5 * mu * np.sign(speed) + 0.02 * rng.standard_normal(200)
        rows += [(each, speed) for each in force]
    lines = [f"{0.01 * n:.2f},{force:.4f},5.0,{speed}" for n, (force, speed) in enumerate(rows)]
    file.write_text("t [s],Fx [N],Fz [N],v [mm/s]\n" + "\n".join(lines) + "\n")


def write_profile(file, seed):
    rng = np.random.default_rng(seed)
    heights = np.convolve(rng.standard_normal(3000), np.ones(30) / 30, "same")
    rows = "\n".join(f"{0.001 * n:.4f}\t{z:.5f}" for n, z in enumerate(heights))
    file.write_text(f"x [mm]\tz [um]\n{rows}\n")


@pytest.fixture
def folder(tmp_path):
    home = tmp_path / "silicone"
    for repeat in (1, 2):
        write_strokes(home / f"silicone_water_5N_{repeat}.csv", seed=repeat)
        write_profile(home / f"glass_{repeat}.txt", seed=repeat)
    (home / "README.md").write_text("1 2 3\n")
    return home


@pytest.mark.slow
def test_a_folder_of_raw_files_is_analysed_and_its_repeats_are_one_curve(folder, monkeypatch):
    monkeypatch.chdir(folder)
    done = command("run")
    assert done.exit_code == 0, done.output
    said = tomllib.loads((folder / "campaign.toml").read_text("utf-8"))
    assert said["campaign"]["files_named"] == "{surface}_{medium}_{normal_force}_{repeat}"
    assert said["run"] == [{"files": ["*.csv"]}]
    assert said["surface"] == [{"name": "glass", "scans": ["glass_1.txt", "glass_2.txt"]}]
    _, runs = load_and_plan(folder / "campaign.toml")
    assert {(run.surface, run.medium, run.normal_force) for run in runs} == {
        ("silicone", "water", 5.0)
    }
    # the shell's *.* names the campaign file, too
    again = command("run", *sorted(path.name for path in folder.iterdir()))
    assert again.exit_code == 0 and "unchanged since the last analysis" in again.output
    # a repeat that was added is taken
    write_strokes(folder / "silicone_water_5N_3.csv", seed=3)
    assert len(load_and_plan(folder / "campaign.toml")[1]) == 3
    text = (folder / "campaign.toml").read_text("utf-8")
    corrected = text.replace("{surface}_{medium}", "{medium}_{surface}")
    (folder / "campaign.toml").write_text(corrected)
    assert {run.surface for run in load_and_plan(folder / "campaign.toml")[1]} == {"water"}


def test_a_folder_without_raw_files_is_refused(tmp_path):
    done = command("run", tmp_path)
    assert done.exit_code == 2 and "no raw file and no campaign.toml" in done.output


def test_the_options_state_what_a_file_does_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(0)
    torque = 0.06 + 0.001 * rng.standard_normal(300)
    rows = "\n".join(f"{0.1 * n:.1f},{each:.5f},20,60" for n, each in enumerate(torque))
    head = "time [s],Torque [N m],Normal force [N],Rotation speed [rpm]"
    (tmp_path / "disc.csv").write_text(f"{head}\n{rows}\n")
    refused = command("run", "disc.csv")
    assert refused.exit_code == 3 and "State --radius 15mm" in refused.output
    assert command("check", "disc.csv", "--radius", "15mm").exit_code == 0
    done = command("run", "disc.csv", "--radius", "15mm")
    assert done.exit_code == 0 and re.search(r"0\.2\d*", done.output), done.output
    wrong = command("run", "disc.csv", "--radius", "15 N")
    assert wrong.exit_code == 2 and "--radius" in wrong.output


def test_a_rotation_needs_a_radius():
    assert Stated.of(None, "15mm", "60rpm", None).speed == "0.0942478 m/s"
    with pytest.raises(ConfigError, match="State --radius"):
        Stated.of(None, None, "60rpm", None)


def test_the_new_campaign_file_is_valid_with_all_its_comments_removed(folder):
    done = command("new", folder)
    assert done.exit_code == 0, done.output
    text = (folder / "campaign.toml").read_text("utf-8")
    assert load_and_plan(folder / "campaign.toml")
    keys = re.sub(r"(?m)^# (?=\[|\w+ = )", "", COMMENTED)
    told = tomllib.loads(text.removesuffix(COMMENTED) + keys)
    stated = Campaign.model_validate(told, context={"in_file": True})
    assert stated.segments.discard == "50 m" and stated.contact.radius == 0.07
    assert command("new", folder).exit_code == 2


def test_scans_of_one_name_in_two_folders_are_two_surfaces_and_the_file_is_valid(tmp_path):
    for folder in ("new", "worn"):
        (tmp_path / folder).mkdir()
        for scan in (1, 2):
            write_profile(tmp_path / folder / f"disc_{scan}.txt", seed=scan)
    assert command("new", tmp_path).exit_code == 0
    campaign, _ = load_and_plan(tmp_path / "campaign.toml")
    assert [surface.name for surface in campaign.surface] == ["new disc", "worn disc"]


def test_a_campaign_file_stands_for_its_raw_files_in_a_check(folder):
    assert command("new", folder).exit_code == 0
    for named in (folder / "campaign.toml", folder):
        done = command("check", named, "-j", "1")
        assert done.exit_code == 0 and "4 checked" in done.output, done.output


@pytest.mark.parametrize("mark", "_- ")
def test_repeats_are_grouped_whatever_mark_separates_the_labels(tmp_path, mark):
    for repeat in (1, 2):
        name = mark.join(("gel", "water", "5N", str(repeat)))
        write_strokes(tmp_path / f"{name}.csv", seed=repeat)
    assert command("new", tmp_path).exit_code == 0
    _, runs = load_and_plan(tmp_path / "campaign.toml")
    assert {(run.surface, run.medium, run.normal_force) for run in runs} == {("gel", "water", 5.0)}
