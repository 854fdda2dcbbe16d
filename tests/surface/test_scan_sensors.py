"""Heights that a distance sensor took on its way, by the clock or by an encoder: no run."""

import numpy as np

from tribolab.reading.scan_files import read_scans
from tribolab.reading.unknown_run import is_run_file

N = 400
Z = np.round(np.sin(np.arange(N) / 7.0) + 0.3 * np.sin(np.arange(N) / 2.0), 3)  # um


def written(tmp_path, text, name="line.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def rows(*columns, mark=","):
    return "\n".join(mark.join(cells) for cells in zip(*columns, strict=True)) + "\n"


TIME = [f"{n / 1000:.3f}" for n in range(N)]


def test_wear_over_time_is_no_profile(tmp_path):
    text = "Profile of wear\nTime [s],Wear [um],Friction force [N]\n"
    path = written(tmp_path, text + rows(TIME, map(str, Z), map(str, Z)))
    assert is_run_file(path)


def test_a_sensors_map_with_x_y_and_z_is_a_map(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(8), np.arange(6)))
    places = [[f"{2.0 * n:.1f}" for n in axis] for axis in (x, y)]
    text = "# confocal sensor\nx (um),y (um),z (um)\n"
    path = written(tmp_path, text + rows(*places, [f"{np.sin(n):.4f}" for n in x + 3 * y]))
    scan = read_scans(path)
    assert dict(scan.sizes) == {"y": 6, "x": 8}
    np.testing.assert_allclose(scan.height[2], 1e-6 * np.sin(np.arange(8) + 6), atol=1e-10)
