"""What takes one surface, medium, speed or run takes several, and says the same of each."""

import numpy as np
import pytest
import scipy.signal
import xarray as xr

import tribolab as tl
from tribolab.core.errors import AnalysisError
from tribolab.studies import xu2026

NAMES = ["Sb-S", "Sb-R"]
PSDS = xu2026.psd(NAMES, points=201)
MODULUS = 2e6


def each(function):
    return [function(PSDS.sel(surface=name)) for name in NAMES]


def test_spectra_of_several_surfaces_are_those_of_each():
    for name in NAMES:
        both = PSDS.sel(surface=name), xu2026.psd(name, points=1201)
        several, alone = (tl.surface.spectral_roughness(psd).isel(wavenumber=-1) for psd in both)
        for quantity in ("rms_roughness", "rms_slope"):
            assert several[quantity].item() == pytest.approx(alone[quantity].item(), rel=1e-9)


@pytest.mark.parametrize(
    "function",
    [
        lambda psd: tl.contact.contact_area_ratio("42 kPa", psd, MODULUS),
        lambda psd: tl.contact.mean_separation(
            xr.DataArray([1e4, 1e5], dims="pressure"), psd, MODULUS
        ),
        lambda psd: tl.contact.adhesion("42 kPa", psd, MODULUS, 0.05, nodes=60).contact_area_ratio,
        lambda psd: tl.contact.macroscopic_work_of_adhesion(psd, MODULUS, 0.05, nodes=60).pull_off,
        lambda psd: tl.surface.spectral_roughness(psd).rms_slope,
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
    found = tl.contact.adhesion(4.2e4, PSDS, MODULUS, works, nodes=60)
    assert found.contact_area_ratio.dims == ("surface", "medium")
    alone = tl.contact.adhesion(4.2e4, PSDS.sel(surface="Sb-R"), MODULUS, 0.051, nodes=60)
    one = found.sel(surface="Sb-R", medium="wet")
    assert one.contact_area_ratio.item() == alone.contact_area_ratio.item()
    assert set(tl.plot.figure_data(tl.plot.effective_work(found)).series) == {
        f"{name}, {medium}" for name in NAMES for medium in ("dry", "wet")
    }
    steep = xr.concat([PSDS.sel(surface="Sb-S"), 4 * PSDS.sel(surface="Sb-R")], "surface")
    doubted = tl.contact.contact_area_ratio(xr.DataArray([4.2e4], dims="pressure"), steep, MODULUS)
    assert doubted.attrs["validity"] == "suspect" and doubted.attrs["validity_reasons"]


def test_spectra_on_wavenumbers_of_their_own_stand_in_one_dataset():
    alone = [xu2026.psd(name, points=101) for name in NAMES]
    index = xr.DataArray(NAMES, dims="surface", name="surface")
    joined = xr.concat(alone, index, join="outer", data_vars="all", combine_attrs="drop_conflicts")
    assert joined.psd_2d.isnull().any()
    areas = tl.contact.contact_area_ratio(4.2e4, joined, MODULUS)
    assert areas.values.tolist() == [
        tl.contact.contact_area_ratio(4.2e4, one, MODULUS) for one in alone
    ]
    drawn = tl.plot.figure_data(tl.plot.spectra(joined))
    assert len(drawn) == sum(one.wavenumber.size for one in alone)


def test_arrays_that_do_not_name_their_dim_are_refused_where_there_are_further_ones():
    with pytest.raises(
        AnalysisError, match="mean_separation: .* arrays must name theirs; give .*DataArray"
    ):
        tl.contact.mean_separation(np.array([1e4, 1e5]), PSDS, MODULUS)


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


def test_several_trims_are_a_dim_of_segments_and_coefficients():
    run = tl.rig.simulate_trace("none", noise=0.05, samples=600, speed=1e-5)
    trims = xr.DataArray([0.0, 0.2, 0.4], dims="trim")
    several = tl.friction_coefficient(run, tl.find_segments(run, trims))
    assert several.friction_coefficient.dims == ("trim", "segment")
    for place, trim in enumerate(trims.values):
        alone = tl.friction_coefficient(run, tl.find_segments(run, float(trim)))
        for name in ("friction_coefficient", "friction_coefficient_sem", "samples"):
            np.testing.assert_array_equal(several[name].isel(trim=place), alone[name])


def test_lists_of_conditions_make_the_runs_of_each():
    short = tl.rig.Rig(tl.rig.Protocol(speeds=(1e-3,)))
    made = tl.rig.simulate_run("Sb-R", ["dry", "glycerol"], seed=[4, 5], rig=short)
    alone = tl.rig.simulate_run("Sb-R", "glycerol", seed=5, rig=short)
    assert [run.name for run in made] == ["sb-r_dry_31N_01", "sb-r_glycerol_31N_01"]
    assert made[1].force_log.identical(alone.force_log)
    struck = tl.rig.inject(made, ["", ["spikes", "frozen"]], rng=3)
    told = [[fault["name"] for fault in run.facts.get("faults", [])] for run in struck]
    assert told == [[], ["spikes", "frozen"]]
    # for one run, names are struck one after the other, as ever
    assert len(tl.rig.inject(made[0], ["spikes", "frozen"], rng=3).facts["faults"]) == 2
    with pytest.raises(AnalysisError, match="2 for medium, 3 for seed"):
        tl.rig.simulate_run("Sb-R", ["dry", "glycerol"], seed=[1, 2, 3], rig=short)


def test_objections_to_several_runs_stand_in_one_table_by_their_labels():
    clean = tl.rig.simulate_trace("none", noise=0.02, samples=800, speed=1e-5)
    frozen = clean.friction_coefficient.copy()
    frozen[200:600] = frozen[200]
    both = [clean, clean.assign(friction_coefficient=frozen)]
    findings = tl.check(both)
    table = tl.qc.objections(findings, rig=["new", "old"])
    own = findings[1].table
    assert (
        table[table.rig == "old"].check.tolist()
        == own[own.status.isin(["suspect", "fail"])].check.tolist()
    )
    assert "stuck" in set(table[table.rig == "old"].check) - set(table[table.rig == "new"].check)
    with pytest.raises(AnalysisError, match="1 labels are given for 2"):
        tl.qc.objections(findings, rig=["new"])


def test_the_error_from_blocks_of_noise_with_memory_is_that_of_the_closed_form():
    rho, n = 0.9, 400_000  # AR(1): variance of the mean is s2 / n (1 + rho) / (1 - rho)
    noise = np.random.default_rng(8).standard_normal(n)
    signal = scipy.signal.lfilter([np.sqrt(1 - rho**2)], [1, -rho], noise)
    blocks = tl.friction.error_from_blocks(signal, [1, 1000])
    exact = np.sqrt([1 / n, (1 + rho) / (1 - rho) / n])
    off = (blocks.standard_error - exact) / blocks.standard_error_std
    assert abs(off.isel(block_length=1)) < 3
    assert blocks.standard_error[0] == pytest.approx(exact[0], rel=0.02)
    with pytest.raises(AnalysisError, match="1 to 200000 samples"):
        tl.friction.error_from_blocks(signal, [n])


def test_modes_of_several_surfaces_are_those_of_each():
    speed = np.geomspace(1e-6, 1e-2, 5)
    curve = xr.Dataset(
        {"friction_coefficient": (("surface", "sliding_speed"), [[1.0] * 5, [1, 1, 1, 1, np.nan]])},
        {"surface": NAMES, "sliding_speed": speed},
    )
    kinds = np.array([["smooth sliding"] * 5, ["sawtooth stick-slip"] * 4 + [""]], object)
    slip = xr.Dataset({"waveform": (("surface", "sliding_speed"), kinds)}, curve.coords)
    slip["drop"] = curve.friction_coefficient.where(kinds == "sawtooth stick-slip")
    adhesion = xr.Dataset(
        {
            "macroscopic_work_of_adhesion": ("surface", [0.0, 4e-3]),
            "macroscopic_work_of_adhesion_low": ("surface", [0.0, 1e-3]),
            "macroscopic_work_of_adhesion_high": ("surface", [0.0, 8e-3]),
            "contact_area_ratio": ("surface", [0.1, 0.9]),
        },
        {"surface": NAMES},
    )
    known = tl.regime.Mode(pressure=4.2e4, fluid=False)
    modes = tl.regime.sliding_modes(curve, None, slip, known, adhesion=adhesion)
    assert [labels["surface"] for labels, _ in modes] == NAMES
    assert [mode.verdict for _, mode in modes] == [
        "no stick-slip",
        "adhesion-controlled macroscopic instability suspected",
    ]
    mine = tl.regime.Mode(
        pressure=4.2e4,
        fluid=False,
        work_of_adhesion=4e-3,
        work_of_adhesion_range=(1e-3, 8e-3),
        area_ratio=0.9,
    )
    part = [data.isel(surface=1, sliding_speed=slice(4), drop=True) for data in (curve, slip)]
    alone = tl.regime.sliding_mode(part[0], None, part[1], mine, name=NAMES[1])
    assert modes.sel(surface=NAMES[1]).paragraph == alone.paragraph
    assert alone.text in modes._repr_html_() and alone.text in repr(modes)
    assert set(modes.to_dataframe().surface) == set(NAMES)
    with pytest.raises(AnalysisError, match="no further dim"):
        tl.regime.sliding_modes(part[0])


def test_stick_slip_of_several_runs_is_drawn_by_its_labels():
    runs = tl.rig.simulate_trace(["sawtooth", "rounded"], samples=1000, speed=1e-5, seed=[1, 2])
    slips = tl.stick_slip(runs, tl.find_segments(runs))
    for draw in (tl.plot.slip_events, tl.plot.slip_spectra):
        data = tl.plot.figure_data(draw(slips, medium=["dry", "wet"]))
        assert {"dry", "wet"} <= {*data.panel, *data.series}
    alone = tl.plot.figure_data(tl.plot.slip_events({"dry": slips[0]}))
    several = tl.plot.figure_data(tl.plot.slip_events(slips, medium=["dry", "wet"]))
    mine = several[several.series == "dry"].reset_index(drop=True)
    drawn = [table.drop(columns=["panel", "series"]) for table in (mine, alone)]
    np.testing.assert_array_equal(*drawn)
    with pytest.raises(AnalysisError, match="one label for each of 2 results"):
        tl.plot.slip_events(slips, medium=["dry"])
