"""Heights that a distance sensor took on its way, by the clock or by an encoder: no run."""

import numpy as np
import pytest

from tribolab.app.file_info import file_lines
from tribolab.errors import ReadError
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.passes import find_passes
from tribolab.reading.unknown_run import holds_run

N = 400
Z = np.round(np.sin(np.arange(N) / 7.0) + 0.3 * np.sin(np.arange(N) / 2.0), 3)  # um


def written(tmp_path, text, name="line.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def rows(*columns, mark=","):
    return "\n".join(mark.join(cells) for cells in zip(*columns, strict=True)) + "\n"


TIME = [f"{n / 1000:.3f}" for n in range(N)]
BY_CLOCK = {
    "two heads, one on a reference": (
        "Displacement sensor LK\nRemark,feed speed 2.5 mm/s constant\nNo.,Time [s],OUT1 [mm],"
        "OUT2 [mm],Judge\n"
        + rows(
            map(str, range(N)),
            TIME,
            [f"{z / 1000 + 0.36:+.6f}" for z in Z],
            [f"{1.0031 + 1e-4 * (n % 2):+.4f}" for n in range(N)],
            ["GO"] * N,
        )
    ),
    "volts of a confocal head": (
        "Konfokaler Sensor, 400 µm/V\nVorschub: 2,5 mm/s\n"
        "Zeit [s];Ausgang [V];Temp [°C]\n"
        + rows(TIME, [f"{z / 400 + 1:.7f}" for z in Z], ["21.3", "21.4"] * (N // 2), mark=";")
        .replace(".", ",")
    ),
    "counts of a stylus": (
        "; Профилограф\n; Скорость перемещения: 2,5 мм/с\n; цена единицы АЦП 1 нм\n"
        "№ отсчёта\tвремя, с\tкод АЦП\n"
        + rows(
            map(str, range(N)), TIME, [str(round(1000 * z) + 7000) for z in Z], mark="\t"
        ).replace(".", ",")
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", BY_CLOCK)
def test_a_clock_and_the_speed_of_the_sensor_make_a_profile(tmp_path, kind):
    path = written(tmp_path, BY_CLOCK[kind])
    scan = read_scans(path)
    assert scan.attrs["pitch_m"] == pytest.approx(2.5e-6)
    np.testing.assert_allclose(scan.height[0] - scan.height[0, 0], 1e-6 * (Z - Z[0]), atol=2e-9)
    assert not holds_run(path)
    assert any("profile of 400 points" in line for line in file_lines(path))


def test_the_speed_is_the_one_thing_that_is_missed(tmp_path):
    text = BY_CLOCK["counts of a stylus"].replace("; Скорость перемещения: 2,5 мм/с\n", "")
    with pytest.raises(ReadError, match="Missing: the traverse speed.*every 1 ms") as said:
        read_scans(written(tmp_path, text))
    assert "friction" not in str(said.value)


def test_two_heads_that_both_move_are_asked_for(tmp_path):
    text = "Laser sensor\nScan speed: 1 mm/s\nTime [s],A [um],B [um]\n"
    text += rows(TIME, map(str, Z), map(str, Z[::-1]))
    with pytest.raises(ReadError, match="'A \\[um\\]'.*it is the height.*column 3"):
        read_scans(written(tmp_path, text))


def test_wear_over_time_is_no_profile(tmp_path):
    text = "Profile of wear\nTime [s],Wear [um],Friction force [N]\n"
    path = written(tmp_path, text + rows(TIME, map(str, Z), map(str, Z)))
    assert holds_run(path)


def to_and_fro():
    """Rests, a pass there, a rest, a pass back, with an encoder that jitters at rest."""
    there = np.arange(4 * N)
    rest = np.tile([0, 1], 300)
    return np.concatenate([rest, there, 4 * N - 1 - rest, there[::-1], rest])


def test_passes_of_an_encoder_are_traces_in_which_rests_do_not_weigh(tmp_path):
    count = to_and_fro()
    height = 1.1 * np.sin(count / 11.0)  # um
    volts = [f"{z / 30 + 2:.6f}" for z in height]
    volts[1000] = volts[1001] = "0.000000"
    text = (
        "% confocal sensor, analogue output: 30 um/V (0 V = signal lost)\n"
        "% glass scale: 1 count = 0.5 um\n% time [s];encoder [counts];output [V];intensity [%]\n"
    )
    time = [f"{n / 1000:.3f}" for n in range(count.size)]
    path = written(
        tmp_path, text + rows(time, map(str, count), volts, ["47.1"] * count.size, mark=";")
    )
    scan = read_scans(path)
    assert scan.sizes["scan"] == 2 and scan.attrs["pitch_m"] == pytest.approx(0.5e-6)
    assert scan.attrs["length_m"] == pytest.approx(0.5e-6 * (4 * N - 1))
    wave = 1.1e-6 * np.sin(np.arange(4 * N) / 11.0)
    np.testing.assert_allclose(scan.height[1] - scan.height[1, 0], wave, atol=2e-9)
    assert scan.attrs["resampled"].startswith("2 passes over one line")
    assert int(np.isnan(scan.height).sum()) in (0, 2)


def test_a_sensors_map_with_x_y_and_z_is_a_map(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(8), np.arange(6)))
    places = [[f"{2.0 * n:.1f}" for n in axis] for axis in (x, y)]
    text = "# confocal sensor\nx (um),y (um),z (um)\n"
    path = written(tmp_path, text + rows(*places, [f"{np.sin(n):.4f}" for n in x + 3 * y]))
    scan = read_scans(path)
    assert dict(scan.sizes) == {"y": 6, "x": 8}
    np.testing.assert_allclose(scan.height[2], 1e-6 * np.sin(np.arange(8) + 6), atol=1e-10)


def test_a_way_that_jumps_back_is_no_pass():
    x = np.tile(np.arange(100.0), 2)
    assert find_passes(x, x) is None
    assert find_passes(np.arange(100.0), np.arange(100.0)) is None
