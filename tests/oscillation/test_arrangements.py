"""Numbers that do not stand below a line of names: read, kept in a dialect, and never in part."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft

RNG = np.random.default_rng(12)
FORCE = 1.2 + 0.02 * RNG.normal(size=400)


def both_ways(path):
    """Return a run as drafted on the fly, and as read by the dialect that was kept."""
    kept = save_draft(draft_dialect(path), path.with_suffix(".toml"))
    return tl.read(path), tl.read(path, instrument=kept)


def test_units_in_capitals_below_the_names_are_units(tmp_path):
    rows = [f"{n / 50:8.3f} {f:8.3f} {20:8.3f} {5:8.3f}" for n, f in enumerate(FORCE)]
    head = "    TIME     FRIC     LOAD    SPEED\n     [S]      [N]      [N]   [MM/S]\n"
    (tmp_path / "a.txt").write_text(head + "\n".join(rows) + "\n")
    for run in both_ways(tmp_path / "a.txt"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 3))
        assert float(run.sliding_velocity[0]) == pytest.approx(5e-3)


@pytest.mark.parametrize("place", [0, 1, 250])
def test_a_delimiter_too_many_behind_a_row_ends_no_table(tmp_path, place):
    rows = [f"{n / 10:.1f}\t{force:.4f}\t20.0\t5.0" for n, force in enumerate(FORCE)]
    rows[place] += "\t"
    head = "Time\tFriction force\tNormal force\tSpeed\n[s]\t[N]\t[N]\t[mm/s]\n"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    for run in both_ways(tmp_path / "a.lvm"):
        np.testing.assert_allclose(run.friction_force, np.round(FORCE, 4))


def test_a_cell_too_many_in_a_row_is_an_error(tmp_path):
    rows = [f"{n / 10:.1f}\t{force:.4f}\t20.0\t5.0" for n, force in enumerate(FORCE)]
    head = "Time\tFriction force\tNormal force\tSpeed\n[s]\t[N]\t[N]\t[mm/s]\n"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    kept = save_draft(draft_dialect(tmp_path / "a.lvm"), tmp_path / "a.toml")
    rows[250] += "\t7"
    (tmp_path / "a.lvm").write_text(head + "\n".join(rows) + "\n")
    with pytest.raises(ReadError, match="line 253 has 5 cells where 4 are expected"):
        tl.read(tmp_path / "a.lvm", instrument=kept)


def test_samples_that_move_the_mean_are_no_matter_of_peaks(tmp_path):
    force = FORCE.copy()
    force[[50, 130, 290]] = -40.0, -41.0, -43.0
    rows = [f"{n / 10:.1f},{f:.4f},20,5" for n, f in enumerate(force)]
    head = "Time [s],Friction force [N],Normal force [N],Speed [mm/s]\n"
    (tmp_path / "a.csv").write_text(head + "\n".join(rows) + "\n")
    found = next(
        row
        for row in tl.check(tl.read(tmp_path / "a.csv")).rows
        if row["check"] == "spikes" and row["variable"] == "friction_force"
    )
    assert found["status"] == "suspect"
    assert "they change the mean magnitude by 26.6%" in found["message"]
    assert "`missing` under [text]" in found["cure"]
