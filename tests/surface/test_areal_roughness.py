"""Sq and Sa of maps (ISO 25178): of all heights, without form."""

import numpy as np
import pytest
import xarray as xr

from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import AnalysisError
from tribolab.surface.areal_roughness import areal_roughness
from tribolab.surface.form import fill_dropouts, remove_form

RNG = np.random.default_rng(4)
HEIGHT = 1e-6 * RNG.standard_normal((60, 80))
AXES = {"y": 1e-6 * np.arange(60), "x": 1e-6 * np.arange(80)}


def mapped(height):
    return xr.Dataset({"height": (("y", "x"), height)}, AXES)


def test_missing_heights_do_not_count_whether_filled_or_not():
    holed = np.where(RNG.random(HEIGHT.shape) < 0.1, np.nan, HEIGHT)
    present = holed[np.isfinite(holed)]
    for scan in (mapped(holed), fill_dropouts(mapped(holed))):
        said = areal_roughness(scan)
        assert float(said.Sq) == pytest.approx(present.std())
        assert float(said.Sa) == pytest.approx(np.abs(present - present.mean()).mean())


def test_each_of_several_maps_has_its_own():
    both = xr.concat([mapped(HEIGHT), mapped(3 * HEIGHT)], "scan")
    said = areal_roughness(both)
    assert said.Sq.dims == ("scan",)
    assert float(said.Sq[1] / said.Sq[0]) == pytest.approx(3)


def test_profiles_have_none():
    with pytest.raises(AnalysisError, match="profiles have no areal roughness"):
        areal_roughness(xr.Dataset({"height": ("x", [1.0, 2.0])}))
    with pytest.raises(AnalysisError, match="a map has no height"):
        areal_roughness(mapped(np.full(HEIGHT.shape, np.nan)))


def test_info_of_a_map_tells_both_and_what_the_tilt_alone_leaves(tmp_path):
    x, y = np.meshgrid(np.linspace(-1, 1, 80), np.linspace(-1, 1, 60))
    for bow, told in ((0.0, False), (3e-6, True)):
        height = HEIGHT + 5e-6 * x + bow * (x**2 + y**2)
        path = tmp_path / "map.txt"
        rows = "\n".join("\t".join(f"{1e6 * z:.6f}" for z in row) for row in height)
        path.write_text(f"Pixel size: 1 um\nHeight unit: um\n{rows}\n")
        (said,) = (line for line in file_lines(path) if line.startswith("  Sq"))
        of_all = areal_roughness(remove_form(mapped(height), "polynomial"))
        assert f"{1e6 * float(of_all.Sq):.3g} um, Sa {1e6 * float(of_all.Sa):.3g} um" in said
        assert "polynomial of degree 2 removed" in said and "ISO 25178" in said
        assert ("with only the tilt removed: Sq" in said) == told
