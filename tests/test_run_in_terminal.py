"""What `tribolab run` prints of a few runs: friction at each speed, and what changed along them."""

import numpy as np
from typer.testing import CliRunner

from tribolab import cli


def run_campaign(folder, force):
    (folder / "raw").mkdir()
    speed = np.repeat([2.0, 5.0, 20.0], 300)
    rows = "\n".join(
        f"{n / 50:.2f},{v:.1f},{f:.4f},20"
        for n, (v, f) in enumerate(zip(speed, force, strict=True))
    )
    head = "Time [s],Speed [mm/s],Friction force [N],Normal force [N]\n"
    (folder / "raw" / "disc.csv").write_text(head + rows + "\n")
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
    assert any(line.startswith("friction at each speed: ") for line in printed)
