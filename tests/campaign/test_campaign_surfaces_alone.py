"""A campaign of surfaces alone makes the report on roughness, contact and adhesion."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
from campaigns import surfaces_alone
from report_pages import figures_of, page_of
from typer.testing import CliRunner

from tribolab import rig
from tribolab.campaign.settings.load import load_campaign
from tribolab.cli import app
from tribolab.core.errors import ConfigError
from tribolab.surface.self_affine import SelfAffine
from tribolab.surface.synthesis import synthesise_map


def roughness_of(folder):
    """What report.json has of the roughness of the only surface."""
    [surface] = json.loads((folder / "results/report.json").read_text("utf-8"))["surfaces"]
    return surface["roughness"]


@pytest.mark.slow
def test_surfaces_without_runs_have_their_report(tmp_path):
    made = rig.simulate_campaign(tmp_path / "c", seed=3, small=True, surfaces=("Sb-R",))
    campaign = surfaces_alone(made, ("31 N", "91 N"))
    command = ["run", str(campaign), "-j", "1", "-q"]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert "computed for 1 of 1 surface: spectrum, contact, adhesion" in done.output.splitlines()
    results = tmp_path / "c" / "results"
    report = json.loads((results / "report.json").read_text("utf-8"))
    assert report["verdict"]["text"] == "1 scan, 1 of 1 surface usable"
    assert report["verdict"]["status"] == "complete" and report["runs"] == []
    for name in ("contact", "adhesion"):
        table = pd.read_csv(results / "tables" / f"{name}.csv")
        assert set(table["normal_force_N"].dropna()) == {31.0, 91.0}, name
    page = page_of(results)
    assert 'id="surfaces"' in page and 'id="runs-table"' not in page
    again = CliRunner().invoke(app, command)
    assert again.exit_code == 0 and "1 of 1 surface" in again.output


def test_a_campaign_of_nothing_is_told_what_it_may_hold(tmp_path):
    (tmp_path / "campaign.toml").write_text('[campaign]\nname = "empty"\n', "utf-8")
    with pytest.raises(ConfigError, match=r"add \[\[run\]\].* or \[\[surface\]\]"):
        load_campaign(tmp_path / "campaign.toml")


def test_roughness_does_not_wait_for_a_power_law(tmp_path):
    rng = np.random.default_rng(7)
    smooth = np.convolve(rng.standard_normal(8200), np.hanning(201) / 50, "valid")[:8000]
    rows = "\n".join(f"{0.0005 * n:.4f},{z:.5f}" for n, z in enumerate(smooth))
    (tmp_path / "shaft.txt").write_text(f"X [mm],Z [um]\n{rows}\n")
    (tmp_path / "campaign.toml").write_text(
        '[campaign]\nname = "shaft"\nraw = "."\n[[surface]]\nname = "shaft"\nscans = "shaft.txt"\n'
    )
    done = CliRunner().invoke(app, ["run", str(tmp_path / "campaign.toml")])
    assert done.exit_code == 0, done.output
    rough = pd.read_csv(tmp_path / "results" / "tables" / "roughness.csv")
    level = smooth - np.polyval(np.polyfit(np.arange(8000), smooth, 2), np.arange(8000))
    assert roughness_of(tmp_path)["Pq_m"] == pytest.approx(1e-6 * level.std(), rel=2e-3)
    assert rough.hurst_exponent.isna().all()
    said = pd.read_csv(tmp_path / "results" / "tables" / "checks.csv").message
    assert said.str.contains("not extrapolated: C").any()


def test_roughness_does_not_wait_for_a_spectrum_where_no_contact_is_asked_about(tmp_path):
    rng = np.random.default_rng(1)
    heights = 0.5 * rng.standard_normal(1000)
    rows = "\n".join(f"{0.004 * n:.3f}\t{z:.4f}" for n, z in enumerate(heights))
    (tmp_path / "ground.txt").write_text(f"X [mm]\tZ [um]\n{rows}\n")
    alone = (
        '[campaign]\nname = "ground"\nraw = "."\n[[surface]]\nname = "g"\nscans = "ground.txt"\n'
    )
    (tmp_path / "campaign.toml").write_text(alone)
    done = CliRunner().invoke(app, ["run", str(tmp_path / "campaign.toml")])
    assert done.exit_code == 0 and "1 of 1 surface: roughness" in done.output, done.output
    tables = tmp_path / "results" / "tables"
    rough = pd.read_csv(tables / "roughness.csv")
    assert roughness_of(tmp_path)["Pq_m"] == pytest.approx(0.5e-6, rel=0.05)
    assert rough.scans[0] == 1
    assert rough.rms_slope.isna().all()
    said = pd.read_csv(tables / "checks.csv")
    told = said.message.str.contains("no spectrum of the surface, roughness parameters alone: 0 ")
    assert said.status[told].tolist() == ["suspect"]
    assert not (tables / "contact.csv").exists() and not (tables / "adhesion.csv").exists()
    page = page_of(tmp_path / "results")
    assert "roughness parameters alone" in page and "tilt and a faint bend" in page
    # a contact of it cannot be computed: that fails, and is not passed over
    body = 'radius = "10 mm"\nlength = "20 mm"\nyoungs_modulus = "2 MPa"\npoisson_ratio = 0.5\n'
    asked = f"{alone}[contact]\n{body}"
    (tmp_path / "campaign.toml").write_text(asked + '[model]\nnormal_forces = ["30 N"]\n')
    failed = CliRunner().invoke(app, ["run", str(tmp_path / "campaign.toml")])
    assert failed.exit_code != 0 and "wavenumbers can be trusted" in failed.output, failed.output


def test_the_page_shows_profiles_one_above_another_without_their_form(tmp_path):
    rng = np.random.default_rng(3)
    x = np.arange(6000) * 0.5e-3  # mm
    waves = np.convolve(rng.standard_normal(6200), np.hanning(41) / 20, "valid")[:6000]
    waves[3000] += 9.0  # one point that no thinning may lose
    for name, form in (("flat", 0.4 * x), ("round", -((x - 1.5) ** 2) / 2 / 20 * 1e3)):
        rows = "\n".join(f"{a:.4f}\t{z:.4f}" for a, z in zip(x, waves + form, strict=True))
        (tmp_path / f"{name}.txt").write_text(f"X [mm]\tZ [um]\n{rows}\n")
    surfaces = "".join(f'[[surface]]\nname = "{n}"\nscans = "{n}.txt"\n' for n in ("flat", "round"))
    (tmp_path / "campaign.toml").write_text(f'[campaign]\nname = "a"\nraw = "."\n{surfaces}')
    done = CliRunner().invoke(app, ["run", str(tmp_path / "campaign.toml")])
    assert done.exit_code == 0, done.output
    upper, lower = figures_of(tmp_path / "results")["surfaces-profiles"]["series"]
    for one in (upper, lower):
        z = np.array(one["y"], float)
        assert (
            len(z) <= 1200 and one["x"][0] == 0 and one["x"][-1] == pytest.approx(x[-1], rel=1e-3)
        )
        assert np.ptp(z) == pytest.approx(
            np.ptp(waves), rel=0.02
        )  # without the form, with the peak
    assert max(lower["y"]) < min(upper["y"])


def test_the_key_that_the_message_names_leaves_the_measured_slope_alone(tmp_path):
    law = SelfAffine(hurst=0.3, rolloff=2e5, plateau=2e-28, low=5e4, high=4e6)
    rough = 1e6 * synthesise_map(law, points=128, pitch=1e-6, rng=3).height.values
    rows = "\n".join(",".join(f"{z:.9f}" for z in row) for row in rough)
    head = "Pixel Size X: 1 um\nPixel Size Y: 1 um\nZ unit: um\n"
    (tmp_path / "map.txt").write_text(head + rows + "\n")
    text = '[campaign]\nname = "map"\nraw = "."\n[[surface]]\nname = "m"\nscans = "map.txt"\n'

    def analysed(more=""):
        (tmp_path / "campaign.toml").write_text(text + more)
        done = CliRunner().invoke(app, ["run", str(tmp_path / "campaign.toml")])
        assert done.exit_code == 0, done.output
        tables = tmp_path / "results" / "tables"
        messages = pd.read_csv(tables / "checks.csv").message
        [said] = messages[messages.str.contains("multiplies the")].tolist() or [""]
        return pd.read_csv(tables / "roughness.csv").iloc[0], said

    rough, said = analysed()
    factor = float(said.split("slope by ")[1].split(":")[0])
    [key] = [part for part in said.split("set ") if part.startswith("q_high")]
    measured, said = analysed(f"[roughness]\n{key.split(' in ')[0]}\n")
    assert not said
    assert rough.rms_slope > 10 * measured.rms_slope
    assert factor == pytest.approx(rough.rms_slope / measured.rms_slope, rel=0.01)
