"""What takes one surface, medium, speed or run takes several, and says the same of each."""

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.errors import AnalysisError
from tribolab.studies import xu2026

NAMES = ["Sb-S", "Sb-R"]
PSDS = xu2026.psd(NAMES, points=201)
MODULUS = 2e6


def each(function):
    return [function(PSDS.sel(surface=name)) for name in NAMES]


def test_spectra_of_several_surfaces_are_those_of_each():
    for name in NAMES:
        both = PSDS.sel(surface=name), xu2026.psd(name, points=1201)
        several, alone = (tl.spectral_roughness(psd).isel(wavenumber=-1) for psd in both)
        for quantity in ("rms_roughness", "rms_slope"):
            assert several[quantity].item() == pytest.approx(alone[quantity].item(), rel=1e-9)


@pytest.mark.parametrize(
    "function",
    [
        lambda psd: tl.contact_area_ratio("42 kPa", psd, MODULUS),
        lambda psd: tl.mean_separation(xr.DataArray([1e4, 1e5], dims="pressure"), psd, MODULUS),
        lambda psd: tl.adhesion("42 kPa", psd, MODULUS, 0.05, nodes=60).contact_area_ratio,
        lambda psd: tl.macroscopic_work_of_adhesion(psd, MODULUS, 0.05, nodes=60).pull_off,
        lambda psd: tl.spectral_roughness(psd).rms_slope,
        lambda psd: (
            tl.stribeck_curve(
                xu2026.contact, psd, 1.4, 310.0, "1 MPa", [1e-5, 1e-3], cells=60
            ).friction_coefficient
        ),
    ],
    ids=["area", "separation", "adhesion", "pull-off", "roughness", "curve"],
)
def test_a_further_dim_of_the_spectrum_is_a_dim_of_the_result(function):
    several = function(PSDS)
    assert several.surface.values.tolist() == NAMES
    for name, alone in zip(NAMES, each(function), strict=True):
        np.testing.assert_array_equal(several.sel(surface=name), alone)


def test_media_and_surfaces_give_both_dims_and_a_doubt_about_one_is_kept():
    works = xr.DataArray([0.064, 0.051], {"medium": ["dry", "wet"]}, "medium")
    found = tl.adhesion(4.2e4, PSDS, MODULUS, works, nodes=60)
    assert found.contact_area_ratio.dims == ("surface", "medium")
    alone = tl.adhesion(4.2e4, PSDS.sel(surface="Sb-R"), MODULUS, 0.051, nodes=60)
    one = found.sel(surface="Sb-R", medium="wet")
    assert one.contact_area_ratio.item() == alone.contact_area_ratio.item()
    assert set(tl.plot.figure_data(tl.plot.effective_work(found)).series) == {
        f"{name}, {medium}" for name in NAMES for medium in ("dry", "wet")
    }
    steep = xr.concat([PSDS.sel(surface="Sb-S"), 4 * PSDS.sel(surface="Sb-R")], "surface")
    doubted = tl.contact_area_ratio(xr.DataArray([4.2e4], dims="pressure"), steep, MODULUS)
    assert doubted.attrs["validity"] == "suspect" and doubted.attrs["validity_reasons"]


def test_spectra_on_wavenumbers_of_their_own_stand_in_one_dataset():
    alone = [xu2026.psd(name, points=101) for name in NAMES]
    index = xr.DataArray(NAMES, dims="surface", name="surface")
    joined = xr.concat(alone, index, join="outer", data_vars="all", combine_attrs="drop_conflicts")
    assert joined.psd_2d.isnull().any()
    areas = tl.contact_area_ratio(4.2e4, joined, MODULUS)
    assert areas.values.tolist() == [tl.contact_area_ratio(4.2e4, one, MODULUS) for one in alone]
    drawn = tl.plot.figure_data(tl.plot.spectra(joined))
    assert len(drawn) == sum(one.wavenumber.size for one in alone)


def test_arrays_that_do_not_name_their_dim_are_refused_where_there_are_further_ones():
    with pytest.raises(
        AnalysisError, match="mean_separation: .* arrays must name theirs; give .*DataArray"
    ):
        tl.mean_separation(np.array([1e4, 1e5]), PSDS, MODULUS)


def test_a_list_of_runs_is_analysed_run_by_run():
    runs = [
        tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5, seed=seed) for seed in (1, 2)
    ]
    segments = tl.find_segments(runs, trim="20 %")
    slips = tl.stick_slip(runs, segments)
    for run, found, slip in zip(runs, segments, slips, strict=True):
        assert found.attrs["trim"] == 0.2
        assert found.identical(tl.find_segments(run, trim=0.2))
        assert slip["drop"].equals(tl.stick_slip(run, found)["drop"])
    with pytest.raises(AnalysisError, match="2 runs are given, and 1 datasets as 'segments'"):
        tl.stick_slip(runs, segments[:1])
