"""What `tribolab run` prints of a few runs: friction at each speed, and what changed along them."""

import tomllib

import numpy as np
import pandas as pd
import pytest
from report_pages import figures_of
from typer.testing import CliRunner

from tribolab import cli


def write_run(file, force):
    file.parent.mkdir(exist_ok=True)
    speed = np.repeat([2.0, 5.0, 20.0], 300)
    rows = "\n".join(
        f"{n / 50:.2f},{v:.1f},{f:.4f},20"
        for n, (v, f) in enumerate(zip(speed, force, strict=True))
    )
    head = "Time [s],Speed [mm/s],Friction force [N],Normal force [N]\n"
    file.write_text(head + rows + "\n")


def run_campaign(folder, force):
    write_run(folder / "raw" / "disc.csv", force)
    toml = '[campaign]\nname = "disc"\n[[run]]\nfiles = "*.csv"\nzero_uncertainty = "0 N"\n'
    (folder / "campaign.toml").write_text(toml)
    done = CliRunner().invoke(cli.app, ["run", str(folder / "campaign.toml")])
    assert done.exit_code == 0, done.output
    return done.output


def test_friction_at_each_speed_of_a_few_is_printed(tmp_path):
    rng = np.random.default_rng(4)
    force = np.repeat([6.0, 5.0, 4.0], 300) + 0.05 * rng.standard_normal(900)
    printed = run_campaign(tmp_path, force).splitlines()
    head = next(n for n, line in enumerate(printed) if line.startswith("speed (mm/s)"))
    rows = [line.split() for line in printed[head + 1 : head + 4]]
    assert [row[0] for row in rows] == ["2", "5", "20"]
    np.testing.assert_allclose([float(row[1]) for row in rows], [0.3, 0.25, 0.2], atol=1e-3)
    assert all(float(row[2]) < 0.002 and row[4] == "1" for row in rows)
    assert any(line.startswith("tables: ") for line in printed)


def write_profile(file):
    rng, k = np.random.default_rng(5), np.arange(1, 2001)
    waves = (k > 8) / k**1.3 * np.exp(2j * np.pi * rng.random(k.size))  # self-affine, H = 0.8
    heights = 300 * np.fft.irfft(np.append(0, waves))
    rows = "\n".join(f"{z:.4f}" for z in heights)
    file.write_text(f"Spacing: 0.5 um\nUnit of heights: um\n{rows}\n")


@pytest.mark.slow
def test_raw_files_need_no_campaign_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    force = np.repeat([6.0, 5.0, 4.0], 300) + 0.05 * np.random.default_rng(6).standard_normal(900)
    write_run(tmp_path / "raw" / "disc 7.csv", force)
    write_profile(tmp_path / "raw" / "roller.txt")
    before = {path: path.read_bytes() for path in (tmp_path / "raw").iterdir()}
    files = ["raw/disc 7.csv", "raw/roller.txt"]
    done = CliRunner().invoke(cli.app, ["run", *files])
    assert done.exit_code == 0, done.output
    assert "campaign.toml was written" in done.output and "Rq ± U95 (" in done.output
    assert any(line.split()[:1] == ["20"] and "0.200" in line for line in done.output.splitlines())
    said = tomllib.loads((tmp_path / "campaign.toml").read_text("utf-8"))
    assert said["campaign"]["raw"] == "raw" and said["run"] == [{"files": ["disc 7.csv"]}]
    assert said["surface"] == [{"name": "roller", "scans": "roller.txt"}]
    again = CliRunner().invoke(cli.app, ["run", *files])
    assert (
        "was written"
    ) not in again.output and "1 unchanged since the last analysis" in again.output
    assert {path: path.read_bytes() for path in (tmp_path / "raw").iterdir()} == before
    # what else is said of a file that the campaign file names is not passed over
    other = CliRunner().invoke(cli.app, ["run", files[0]])
    assert other.exit_code == 2, other.output
    assert "already exists" in other.output and "tribolab run campaign.toml" in other.output
    assert tomllib.loads((tmp_path / "campaign.toml").read_text("utf-8")) == said
    # another file has a campaign file and results of its own
    write_run(tmp_path / "raw" / "disc 8.csv", force)
    for _ in range(2):
        beside = CliRunner().invoke(cli.app, ["run", "raw/disc 8.csv"])
        assert beside.exit_code == 0, beside.output
    assert "results_disc_8/report.html" in beside.output
    own = tomllib.loads((tmp_path / "campaign_disc_8.toml").read_text("utf-8"))
    assert own["run"] == [{"files": ["disc 8.csv"]}]
    assert tomllib.loads((tmp_path / "campaign.toml").read_text("utf-8")) == said


def test_a_campaign_file_goes_with_nothing_else(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_run(tmp_path / "disc.csv", np.repeat([6.0, 5.0, 4.0], 300))
    (tmp_path / "own.toml").write_text('[campaign]\nname = "own"\n')
    done = CliRunner().invoke(cli.app, ["run", "disc.csv", "own.toml"])
    assert done.exit_code == 2 and "own.toml: it is not a raw file" in done.output, done.output
    done = CliRunner().invoke(cli.app, ["run", "disc.csv", "gone.csv"])
    assert done.exit_code == 2 and "gone.csv: there is no such file" in done.output, done.output
    assert not (tmp_path / "campaign.toml").exists()


def test_info_says_what_to_do_next(tmp_path):
    write_run(tmp_path / "disc 7.csv", np.repeat([6.0, 5.0, 4.0], 300))
    done = CliRunner().invoke(cli.app, ["info", str(tmp_path / "disc 7.csv")])
    assert f"tribolab run '{tmp_path / 'disc 7.csv'}'" in done.output


@pytest.mark.slow
@pytest.mark.parametrize("load", ["Normal force (N)", "Set load (N)"])
@pytest.mark.parametrize("points", [True, False])
def test_a_recorded_coefficient_under_two_loads_makes_two_curves(
    tmp_path, monkeypatch, load, points
):
    monkeypatch.chdir(tmp_path)
    rng, each = np.random.default_rng(8), 1 if points else 200
    speeds = np.repeat(np.tile(np.geomspace(1, 100, 15).round(2), 2), each)
    loads = np.repeat([3.0, 6.0], 15 * each)
    mu = (0.4 - 0.05 * (loads > 5)) * (1 - 0.1 * np.log10(speeds))
    mu = mu + 0.002 * rng.standard_normal(mu.size)
    rows = [f"{v},{m:.5f},{w}" for v, m, w in zip(speeds, mu, loads, strict=True)]
    head = f"Speed (mm/s),Friction coefficient,{load}"
    if not points:
        head, rows = f"Time (s),{head}", [f"{n / 10},{row}" for n, row in enumerate(rows)]
    rows = [head, *rows]
    (tmp_path / "cell.csv").write_text("\n".join(rows) + "\n")
    done = CliRunner().invoke(cli.app, ["run", "cell.csv"])
    assert done.exit_code == 0, done.output
    table = pd.read_csv(tmp_path / "results" / "tables" / "stribeck.csv")
    found = table.groupby("nominal_normal_force_N").friction_coefficient.mean()
    assert found.index.tolist() == [3.0, 6.0]
    mean = 1 - 0.1 * np.log10(speeds).mean()
    np.testing.assert_allclose(found.values, [0.4 * mean, 0.35 * mean], rtol=0.01)


@pytest.mark.parametrize("pattern", ["**/*.csv", "*/*.csv"])
def test_results_lie_where_no_pattern_of_raw_files_reaches(tmp_path, pattern):
    write_run(tmp_path / "disc.csv", np.repeat([6.0, 5.0, 4.0], 300))
    write_run(tmp_path / "more" / "disc.csv", np.repeat([6.0, 5.0, 4.0], 300))
    toml = f'[campaign]\nname = "disc"\nraw = "."\n[[run]]\nfiles = "{pattern}"\n'
    (tmp_path / "campaign.toml").write_text(toml)
    done = CliRunner().invoke(cli.app, ["run", str(tmp_path / "campaign.toml")])
    assert "same folder as the raw files" in done.output
    assert not (tmp_path / "results").exists()


@pytest.mark.slow
def test_a_drafted_description_is_named_where_the_raw_file_is(tmp_path, monkeypatch):
    """What a try without it left behind is no hindrance; what a person completed is."""
    monkeypatch.chdir(tmp_path)
    force = np.repeat([6.0, 5.0, 4.0], 300) + 0.05 * np.random.default_rng(6).standard_normal(900)
    write_run(tmp_path / "odd.csv", force)
    text = (tmp_path / "odd.csv").read_text()
    (tmp_path / "odd.csv").write_text(text.replace("Friction force [N]", "K17"))
    refused = CliRunner().invoke(cli.app, ["run", "odd.csv"])
    assert refused.exit_code == 3 and "tribolab info odd.csv --write" in refused.output
    assert "no segment" not in refused.output  # nothing was read in which one could be
    asked = CliRunner().invoke(cli.app, ["dialect", "odd.csv", "--ask"], input="3\nN\n")
    assert "next:  tribolab run odd.csv --instrument odd.toml" in asked.output.replace(
        f"{tmp_path}/", ""
    )
    done = CliRunner().invoke(cli.app, ["run", "odd.csv", "--instrument", "odd.toml"])
    assert done.exit_code == 0, done.output
    assert any(line.split()[:1] == ["20"] and "0.200" in line for line in done.output.splitlines())
    said = tomllib.loads((tmp_path / "campaign.toml").read_text("utf-8"))
    assert said["run"] == [{"files": ["odd.csv"], "instrument": "odd.toml"}]
    own = (tmp_path / "campaign.toml").read_text("utf-8") + 'normal_force = "20 N"\n'
    (tmp_path / "campaign.toml").write_text(own)
    other = CliRunner().invoke(cli.app, ["run", "odd.csv", "--instrument", "odd.toml"])
    assert other.exit_code == 2 and (tmp_path / "campaign.toml").read_text("utf-8") == own
    wrong = CliRunner().invoke(cli.app, ["run", "campaign.toml", "--instrument", "odd.toml"])
    assert wrong.exit_code == 2 and "--instrument is for raw files" in wrong.output


def test_a_file_that_cannot_be_read_leaves_nothing_that_hinders_the_next(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "odd.txt").write_text("pitch = 0.5 um\n" + "1.5\n2.5\n" * 30)
    write_run(tmp_path / "raw" / "disc.csv", np.repeat([6.0, 5.0, 4.0], 300))
    refused = CliRunner().invoke(cli.app, ["run", "odd.txt"])
    assert refused.exit_code == 3 and "was written" not in refused.output
    assert "it is the height in um" in refused.output
    assert "tribolab info odd.txt --write" in refused.output and "[[surface]]" not in refused.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["odd.txt", "raw"]
    done = CliRunner().invoke(cli.app, ["run", "raw/disc.csv"])
    assert done.exit_code == 0 and "campaign.toml was written" in done.output
    # results that stand there already are another's: they stay, and so does what is said of them
    (tmp_path / "campaign.toml").unlink()
    again = CliRunner().invoke(cli.app, ["run", "odd.txt"])
    assert again.exit_code == 3 and (tmp_path / "results" / "report.html").is_file()
    other = CliRunner().invoke(cli.app, ["run", "raw/disc.csv"])
    assert other.exit_code == 0 and "campaign_disc.toml was written" in other.output


def test_of_strokes_it_is_said_which_part_counts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    time = np.arange(0, 20, 0.005)
    force = 3 * np.tanh(40 * np.cos(2 * np.pi * time))
    force += 0.02 * np.random.default_rng(2).standard_normal(time.size)
    rows = "\n".join(f"{t:.3f},{f:.4f}" for t, f in zip(time, force, strict=True))
    head = "Stroke: 10 mm\nFrequency: 1 Hz\nDrive: crank\nLoad: 10 N\n"
    (tmp_path / "pin.csv").write_text(f"{head}Time [s],Friction force [N]\n{rows}\n")
    done = CliRunner().invoke(cli.app, ["run", "pin.csv"])
    assert done.exit_code == 0, done.output
    assert "pin: left out: the ends of" in done.output
    assert not (tmp_path / "results" / "tables" / "roughness.csv").exists()
    along, *_ = figures_of(tmp_path / "results")["along-time"]["series"]
    friction = pd.read_csv(tmp_path / "results" / "tables" / "friction.csv")
    assert len(friction) > 30 and len(along["x"]) >= len(friction) // 2 - 1  # strokes or cycles
    assert np.mean(along["y"]) == pytest.approx(friction.friction_coefficient.mean(), rel=0.01)
    assert friction.start_s.min() <= min(along["x"]) < max(along["x"]) <= 20.0
