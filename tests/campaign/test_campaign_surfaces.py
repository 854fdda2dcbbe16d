"""Surfaces of a campaign: spectrum, contact and adhesion beside the runs, and what may be amiss."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest
from campaigns import copied, made_and_taken_over, simulated
from typer.testing import CliRunner

import tribolab
from tribolab import rig
from tribolab.app.run import run_campaign
from tribolab.app.truth.surfaces import compare_surfaces
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.store.catalogue import CATALOGUE
from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.surfaces.plan import PlannedMedium, PlannedSurface, plan_surfaces
from tribolab.campaign.surfaces.stage import Surfaces, SurfaceTask, process_surface
from tribolab.cli import app
from tribolab.contact.adhesive_contact import macroscopic_work_of_adhesion
from tribolab.contact.hertz import hertz_mean_pressure, jkr_half_width
from tribolab.contact.persson import contact_area_ratio
from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.parts import RunOutcome
from tribolab.records.surfaces.surface_rows import ADHESION, CONTACT
from tribolab.report.page.page import write_page
from tribolab.rig.files import scan_file
from tribolab.studies import xu2026
from tribolab.surface.self_affine import SelfAffine, rms_slope
from tribolab.surface.synthesis import synthesise_map, synthesise_profiles

SCHEMA = Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json"
CONTACT_TABLE = {
    "radius": 0.07,
    "length": 0.10,
    "youngs_modulus": 1.5e6,
    "poisson_ratio": 0.5,
}
NOTHING_KNOWN = dict.fromkeys(CONTACT_TABLE)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("surfaces"), repeats=1, scans=True)


@pytest.fixture(scope="module")
def outcome(campaign):
    return run_campaign(campaign, jobs=1, figures="all")


@pytest.fixture(scope="module")
def profiles(tmp_path_factory):
    """Three short scans, one longer than the others."""
    folder = tmp_path_factory.mktemp("profiles")
    for number, length in enumerate((5e-3, 5e-3, 6e-3), start=1):
        scan = rig.scans("Sb-R", 1, seed=number, length=length)
        file = folder / f"sb-r_{number}.csv"
        text = scan_file(scan.x.values, scan.height.values[0]).decode()
        file.write_text(re.sub(r"# length:.*\n", "", text))
    return sorted(folder.glob("*.csv"))


def planned(files, **changes):
    surface = PlannedSurface(
        name="Sb-R",
        data_file="data/surface_Sb-R.nc",
        patterns=(),
        files=tuple(files),
        labels=tuple(f"raw/{file.name}" for file in files),
        instrument=None,
        roughness={},
        contact=dict(CONTACT_TABLE),
        forces=(31.0, 91.0),
        lowest_force=31.0,
        media=(),
        config_sha256="as it is",
    )
    return replace(surface, **changes)


def processed(folder, files, **changes):
    return recorded(folder, files, **changes).outcome


def recorded(folder, files, **changes):
    (folder / "data").mkdir(exist_ok=True)
    return process_surface(SurfaceTask(planned(files, **changes), folder))


def said(outcome, severity):
    return [finding.message for finding in outcome.findings if finding.severity == severity]


# what a campaign with scans gives


@pytest.mark.slow
def test_spectrum_contact_and_adhesion_stand_in_one_file(outcome):
    [surface] = outcome.surfaces
    assert surface.done and surface.data_file == "data/surface_Sb-R.nc"
    assert {"psd_1d", "psd", "roughness", "contact", "loads", "line", "gap"} < set(surface.parts)
    assert {"adhesion", "adhesion_loads", "rubber", "modulus"} < set(surface.parts)
    [scan] = surface.files
    assert scan in {name for name, _, _ in outcome.sources}


@pytest.mark.slow
def test_roughness_and_contact_area_hold_the_truth_between_their_bounds(outcome, campaign):
    found = compare_surfaces(outcome, campaign.parent)
    assert found.quantity.tolist() == ["rms_roughness_m", "rms_slope", "contact_area_ratio"]
    assert (found.within_bounds == 1).all()
    assert (found.relative_difference.abs() < 0.15).all()  # one scan only


@pytest.mark.slow
def test_spectrum_reaches_from_the_hertz_width_to_a_nanometre(outcome):
    psd = read_netcdf(outcome.folder / "data/surface_Sb-R.nc", group="psd")
    width = 2 * xu2026.system.half_width(31.0)
    assert float(psd.wavenumber[0]) == pytest.approx(np.pi / width, rel=1e-12)
    assert float(psd.wavenumber[-1]) == pytest.approx(np.pi / 1e-9, rel=1e-12)


@pytest.mark.slow
def test_tables_say_what_the_functions_give(outcome):
    tables = {
        name: pd.read_csv(outcome.folder / f"tables/{name}.csv")
        for name in ("roughness", "contact", "adhesion")
    }
    psd = read_netcdf(outcome.folder / "data/surface_Sb-R.nc", group="psd")
    [contact] = tables["contact"].to_dict("records")
    pressure = float(hertz_mean_pressure(310.0, xu2026.contact))
    assert contact["pressure_Pa"] == pressure
    assert contact["contact_area_ratio"] == contact_area_ratio(pressure, psd, 2e6)
    assert list(tables["roughness"].columns)[:4] == ["surface", "quality", "scans", "Ra_m"]
    assert tables["roughness"].shape[1] == 22
    assert list(tables["contact"].columns) == ["surface", "quality", *CONTACT]
    assert list(tables["adhesion"].columns) == ["surface", "quality", *ADHESION]
    adhesion = tables["adhesion"].set_index("medium")
    assert list(adhesion.index) == ["glycerol", "dry"]
    assert adhesion.work_of_adhesion_J_m2.tolist() == [0.051, 0.064]
    assert (adhesion.area_enhancement > 1.15).all()
    assert adhesion.contact_area_ratio["dry"] > adhesion.contact_area_ratio["glycerol"]


@pytest.mark.slow
def test_every_value_lies_between_its_bounds(outcome):
    for name in ("roughness", "contact", "adhesion"):
        table = pd.read_csv(outcome.folder / f"tables/{name}.csv")
        for column in table.columns[table.columns.str.contains("_low")]:
            if column.startswith(("wavenumber", "measured")):
                continue
            value, high = column.replace("_low", ""), column.replace("_low", "_high")
            assert (table[column] <= table[value]).all(), column
            assert (table[value] <= table[high]).all(), column
    file, table = outcome.folder / outcome.surfaces[0].data_file, "tables/adhesion.csv"
    loads = read_netcdf(file, group="adhesion_loads")
    growth, low, high = (loads[f"area_enhancement{end}"] for end in ("", "_low", "_high"))
    assert (low <= growth).all() and (growth <= high).all() and (low < high).all()
    curve = read_netcdf(file, group="adhesion")
    low, high = (curve[f"contact_area_ratio_{end}"] for end in ("low", "high"))
    assert (low <= curve.contact_area_ratio).all() and (curve.contact_area_ratio <= high).all()
    for row in pd.read_csv(outcome.folder / table).itertuples():  # the curve's band is the table's
        for found, end in ((low, "low"), (high, "high")):
            at = found.sel(medium=row.medium).interp(pressure=row.pressure_Pa)
            assert float(at) == pytest.approx(getattr(row, f"contact_area_ratio_{end}"), rel=0.01)


@pytest.mark.slow
def test_vanishing_load_among_other_pressures_gives_the_macroscopic_work(tmp_path, profiles):
    medium = PlannedMedium("dry", 0.3, 0.25, 0.35)  # strong enough for a pull-off force
    surface = processed(tmp_path, profiles[:1], media=(medium,))
    found = read_netcdf(tmp_path / surface.data_file, group="adhesion_loads")
    psd = read_netcdf(tmp_path / surface.data_file, group="psd")
    alone = macroscopic_work_of_adhesion(psd, 2e6, 0.3)
    work = float(alone.macroscopic_work_of_adhesion)
    assert float(found.macroscopic_work_of_adhesion[0]) == pytest.approx(work, rel=1e-9, abs=1e-12)
    assert int(found.pull_off[0]) == int(alone.pull_off)
    widths = 2 * jkr_half_width([310.0, 910.0], xu2026.contact, work)
    np.testing.assert_allclose(found.contact_width[0], widths, rtol=1e-9)


@pytest.mark.slow
def test_report_json_fits_its_schema_and_the_page_shows_the_section(outcome, tmp_path):
    report = json.loads((outcome.folder / "report.json").read_text())
    jsonschema.validate(report, json.loads(SCHEMA.read_text()))
    assert [surface["name"] for surface in report["surfaces"]] == ["Sb-R"]
    names = [figure["file"][8:-4] for figure in report["surface_figures"]]
    kinds = ("area", "work", "gaps", "pressure", "viscoelastic")
    assert names == [
        *(f"surfaces_{kind}" for kind in ("profiles", "spectra", "modulus")),
        *(f"contact_{kind}" for kind in kinds),
    ]
    assert all((outcome.folder / f["file"]).is_file() for f in report["surface_figures"])
    page = (outcome.folder / "report.html").read_text()
    assert 'id="surfaces"' in page and "Contact with adhesion" in page
    row = report["surfaces"][0]["roughness"]  # the stand-in's exponent is 1.19
    assert row["hurst_exponent"] - 2 * row["hurst_exponent_standard_error"] > 1
    verdict = page[page.index("<h3>Hurst exponents</h3>") :].partition("</ul>")[0]
    assert "Sb-R" in verdict and "not a self-affine fractal" in verdict
    (tmp_path / "figures").symlink_to(outcome.folder / "figures")
    bare = report | {"surfaces": [], "surface_figures": []}
    page = write_page(bare, tmp_path, lambda: iter(report["runs"]), outcome.store).read_text()
    assert "the campaign file has no <code>[[surface]]</code>" in page


@pytest.mark.slow
def test_nothing_is_done_again_until_something_changes(campaign, outcome, tmp_path):
    mine = copied(campaign, tmp_path)
    again = run_campaign(mine, jobs=1, figures="all")
    assert again.surfaces[0].reused and again.surfaces[0].parts == outcome.surfaces[0].parts
    assert again.sources == outcome.sources

    def known():
        store = Store(tmp_path, again.folder)
        stage = Surfaces(load_campaign(mine), again.runs, store)
        [task] = stage.plan()
        found = stage.known(task, 0)
        store.close()
        return found is not None

    assert known()
    text = mine.read_text()
    mine.write_text(text.replace('"64 mJ/m^2"', '"65 mJ/m^2"'))
    assert not known()
    mine.write_text(text)
    assert known()
    [scan] = load_campaign(mine).raw.glob("profiles/*.csv")
    scan.write_text(scan.read_text().replace(",0.", ",0.1", 1))
    assert not known()


# what is not known, or cannot be used


def test_one_bad_scan_is_left_out_and_named(tmp_path, profiles):
    bad = tmp_path / "sb-r_0.csv"
    bad.write_text("# Surftest profile\nx [mm],z [um]\n0,1\n0.1,what\n")
    surface = processed(tmp_path, [bad, *profiles[:2]])
    assert surface.done
    [message] = said(surface, "fail")
    assert message.startswith("scan raw/sb-r_0.csv is left out: ")
    assert "what" in message and str(tmp_path) not in message
    found = read_netcdf(tmp_path / surface.data_file, group="roughness")
    assert found.sizes["scan"] == 2


@pytest.mark.slow
def test_a_bad_scan_stands_in_the_findings_and_fails_the_command(campaign, outcome, tmp_path):
    mine = copied(campaign, tmp_path)
    (mine.parent / "raw/profiles/sb-r_2.csv").write_text("x [mm],z [um]\n1,2\n")
    done = CliRunner().invoke(app, ["run", str(mine), "-q", "-j", "1"])
    assert done.exit_code == 3
    assert "surface Sb-R: scan raw/profiles/sb-r_2.csv is left out" in done.stderr
    assert "1 of 1 surface: spectrum, contact, adhesion" in done.stdout
    findings = pd.read_csv(mine.parent / "results/tables/checks.csv")
    first = findings.iloc[0]
    assert (first.status, first["check"]) == ("fail", "surface Sb-R")
    assert "sb-r_2.csv" in first.message


def test_a_surface_without_a_usable_scan_fails_alone(tmp_path):
    bad = tmp_path / "empty.csv"
    bad.write_text("")
    surface = processed(tmp_path, [bad])
    assert (surface.status, surface.error) == ("failed", "AnalysisError")
    assert "empty.csv" in surface.reason and surface.findings[0].severity == "fail"


def test_a_scan_of_another_length_is_left_out(tmp_path, profiles):
    surface = processed(tmp_path, profiles, contact=NOTHING_KNOWN)
    assert said(surface, "suspect") == [
        "scan raw/sb-r_3.csv is left out: it differs in pitch or length"
    ]


def test_several_maps_of_a_surface_are_averaged(tmp_path):
    rough = SelfAffine(0.8, rolloff=2e5, plateau=1e-23, low=3e4, high=3e6)
    files = [tmp_path / f"map_{number}.txt" for number in range(4)]
    for number, file in enumerate(files):
        points = 64 if number < 3 else 48
        scan = synthesise_map(rough, points=points, pitch=1e-6, rng=number)
        y, x = np.meshgrid(1e3 * scan.y, 1e3 * scan.x, indexing="ij")
        columns = np.stack([x, y, 1e6 * scan.height.values], axis=-1).reshape(-1, 3)
        np.savetxt(file, columns, fmt="%.6f", delimiter=",")
    outcome = processed(tmp_path, files, instrument="nanovea_map", contact=NOTHING_KNOWN)
    assert outcome.done
    left_out = "scan raw/map_3.txt is left out: it differs in pitch or length"
    assert left_out in said(outcome, "suspect")
    psd = read_netcdf(tmp_path / outcome.data_file, group="psd")
    roughness = read_netcdf(tmp_path / outcome.data_file, group="roughness")
    assert psd.attrs["scans"] == 3
    seen = roughness.attrs["measured_rms_slope"]  # short waves have most of it
    assert seen == pytest.approx(rms_slope(rough), rel=0.15)
    assert roughness.Ra.dims == ("scan", "y")
    assert roughness.Sq.dims == ("scan",) and "Sq" in roughness
    row = recorded(tmp_path, files, instrument="nanovea_map", contact=NOTHING_KNOWN).rows.roughness
    assert row["Sq_m"] == pytest.approx(float(roughness.Sq.mean()))
    assert row["Pq_m"] < row["Sq_m"] and 0.6 * row["Sq_m"] < row["Sa_m"] < row["Sq_m"]


def test_without_scans_the_surface_is_skipped_and_that_is_said(tmp_path):
    surface = processed(tmp_path, [])
    assert surface.status == "skipped" and not surface.done
    assert "no scans are named" in surface.findings[0].message


def test_without_contact_there_is_a_spectrum_only(tmp_path, profiles):
    record = recorded(tmp_path, profiles[:1], contact=NOTHING_KNOWN, lowest_force=None)
    surface, rows = record.outcome, record.rows
    assert surface.parts == ("scans", "psd_1d", "psd", "roughness")
    assert any("youngs_modulus" in message for message in said(surface, "note"))
    assert any("begins where the scans do" in message for message in said(surface, "note"))
    assert rows.contact == rows.adhesion == () and rows.roughness["rms_slope"] > 0.5


def test_what_is_extrapolated_is_in_doubt_where_a_contact_relies_on_it(tmp_path):
    rough = SelfAffine(0.5, rolloff=2e4, plateau=2e-24, low=3e3, high=2e6)
    scan = synthesise_profiles(rough, points=2000, pitch=2e-6, rng=4)
    file = tmp_path / "rough.csv"
    file.write_text(scan_file(scan.x.values, scan.height.values[0]).decode())
    alone = recorded(tmp_path, [file], contact=NOTHING_KNOWN, lowest_force=None).outcome
    asked = recorded(tmp_path, [file]).outcome
    extrapolated = "% of the mean square slope is extrapolated, not measured"
    assert [extrapolated in text for text in said(alone, "note")].count(True) == 1
    assert not any(extrapolated in text for text in said(alone, "suspect"))
    assert any(extrapolated in text for text in said(asked, "suspect"))
    over_pressure = recorded(tmp_path, [file], forces=(), lowest_force=None).outcome
    assert any(extrapolated in text for text in said(over_pressure, "suspect"))


def test_without_loads_contact_is_known_over_pressure_only(tmp_path, profiles):
    medium = PlannedMedium("dry", 0.064, 0.064, 0.064)
    record = recorded(tmp_path, profiles[:1], forces=(), lowest_force=None, media=(medium,))
    surface, rows = record.outcome, record.rows
    assert set(surface.parts) == {
        *("scans", "psd_1d", "psd", "roughness", "contact", "adhesion", "adhesion_loads")
    }
    assert len(rows.contact) == 31 and rows.contact[0]["normal_force_N"] is None
    [row] = rows.adhesion
    assert row["pull_off"] == 0 and row["contact_area_ratio"] is None


def test_a_stiff_body_is_no_rubber_unless_its_modulus_is_given(tmp_path, profiles):
    steel = CONTACT_TABLE | {"youngs_modulus": 2e9}
    surface = processed(tmp_path, profiles[:1], contact=steel)
    assert "rubber" not in surface.parts
    assert any("2e+03 MPa is no rubber" in message for message in said(surface, "note"))
    file = tmp_path / "dma.csv"
    file.write_text("f,E',E''\nHz,MPa,MPa\n1,2000,20\n100,2100,30\n10000,2300,50\n")
    measured = processed(tmp_path, profiles[:1], contact=steel, modulus_file=(file, "raw/dma.csv"))
    rubber = read_netcdf(tmp_path / measured.data_file, group="rubber")
    assert rubber.attrs["modulus"] == "raw/dma.csv"
    assert (rubber.friction_coefficient > 0).all()
    assert not any("stand-in" in message for message in said(measured, "note"))
    assert not any("youngs_modulus" in message for message in said(measured, "note"))
    other = CONTACT_TABLE | {"youngs_modulus": 1.5e6}
    measured = processed(tmp_path, profiles[:1], contact=other, modulus_file=(file, "raw/dma.csv"))
    [message] = [text for text in said(measured, "note") if "youngs_modulus" in text]
    assert "2e+03 MPa at 6.28 rad/s (raw/dma.csv)" in message and "= 1.5 MPa" in message


def test_a_part_that_crashes_costs_only_itself(tmp_path, profiles, monkeypatch):
    def crash(*args, **kwargs):
        raise ZeroDivisionError("no gap")

    monkeypatch.setattr("tribolab.campaign.surfaces.contact.gap_distribution", crash)
    surface = processed(tmp_path, profiles[:1])
    assert surface.done and "gap" not in surface.parts and "line" in surface.parts
    [message] = said(surface, "error")
    assert message.startswith("gap: crashed with ZeroDivisionError") and "no gap" in message


def test_bounds_that_do_not_decide_the_pull_off_are_told(tmp_path, profiles):
    medium = PlannedMedium("dry", 0.064, 0.01, 2.0)
    surface = processed(tmp_path, profiles[:1], media=(medium,))
    assert any("is not decided" in message for message in said(surface, "note"))


def test_damaged_results_are_not_taken_over(tmp_path, profiles):
    surface = planned(profiles[:1], contact=NOTHING_KNOWN)
    file = tmp_path / surface.data_file

    def torn():
        file.write_bytes(file.read_bytes()[:500])
        return surface

    def looked_for(change=None):
        return made_and_taken_over(tmp_path, surface, change)

    first, again = looked_for()
    assert again == replace(first, outcome=replace(first.outcome, reused=True))
    assert looked_for(lambda: replace(surface, config_sha256="another"))[1] is None
    assert looked_for(torn)[1] is None
    assert looked_for(lambda: file.unlink() or surface)[1] is None
    assert looked_for(lambda: (tmp_path / CATALOGUE).write_bytes(b"torn") and surface)[1] is None


# the campaign file


def test_loads_come_from_the_runs_and_media_from_their_tables(campaign):
    runs = [
        RunOutcome(
            name=f"run{number}",
            files=(),
            surface=surface,
            medium="dry",
            normal_force=force,
            status="done",
        )
        for number, (surface, force) in enumerate(
            [("Sb-R", 91.0), ("Sb-R", 31.00001), ("Sb-R", 31.0), ("", 5.0), ("Sb-R", None)]
        )
    ]
    [surface] = plan_surfaces(load_campaign(campaign), runs)
    assert surface.forces == (31.0, 91.0) and surface.lowest_force == 5.0
    assert [medium.name for medium in surface.media] == ["glycerol", "dry"]
    assert surface.media[1].low < surface.media[1].work_of_adhesion < surface.media[1].high


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("poisson_ratio = 0.5", 'modulus_file = "dma.csv"', "there is no file"),
        ('work_of_adhesion = "64 mJ/m^2"', "", "from below to above work_of_adhesion"),
        ('name = "Sb-R"', 'name = "Sb-R"\ninstrument = "surftest"', "surftest_csv"),
    ],
)
def test_mistakes_in_the_campaign_file_are_told(campaign, tmp_path, old, new, said):
    mine = shutil.copytree(campaign.parent, tmp_path / "campaign") / campaign.name
    mine.write_text(mine.read_text().replace(old, new, 1))
    with pytest.raises(ConfigError, match=said):
        load_campaign(mine)


def test_a_circle_that_may_be_waviness_is_told_and_one_of_the_part_is_not(tmp_path):
    """A cylinder of 7 cm rises far above its roughness; a flat part's own waves do not."""
    scan, round_ = rig.scans("Smooth", 1, seed=2, length=5e-3), tmp_path / "round.csv"
    round_.write_bytes(scan_file(scan.x.values, scan.height.values[0]))
    clear = recorded(tmp_path, [round_], contact=NOTHING_KNOWN, lowest_force=None)
    assert not any("circle" in message for message in said(clear.outcome, "note"))
    assert clear.rows.roughness["form_removed"] == "circle"
    assert clear.rows.roughness["form_radius_m"] == pytest.approx(0.07, rel=0.02)
    x = 1e-6 * np.arange(4000)
    rng = np.random.default_rng(8)
    height = 1e-6 * np.cumsum(rng.standard_normal(x.size)) / 25
    flat = tmp_path / "flat.csv"
    rows = np.column_stack([1e3 * x, 1e6 * height])
    np.savetxt(flat, rows, "%.6g", ",", header="x [mm],height [um]", comments="")
    settings = {"contact": NOTHING_KNOWN, "lowest_force": None}
    doubtful = recorded(tmp_path, [flat], **settings)
    (told,) = (text for text in said(doubtful.outcome, "note") if "circle" in text)
    level = recorded(tmp_path, [flat], **settings, roughness={"form": "tilt"}).rows.roughness
    bent = doubtful.rows.roughness
    assert f"{1e6 * level['Pq_m']:.3g} µm after removing only the tilt" in told
    assert level["Pq_m"] > bent["Pq_m"] and 'form = "tilt"' in told
    assert level["form_removed"] == "tilt" and level["form_radius_m"] is None


def test_the_cut_off_of_roughness_can_be_chosen(tmp_path, profiles):
    settings = {"contact": NOTHING_KNOWN, "lowest_force": None}
    rows = {
        cut: recorded(tmp_path, profiles[:1], **settings, roughness=chosen).rows.roughness
        for cut, chosen in ((0.8e-3, {}), (0.25e-3, {"lambda_c": 0.25e-3}))
    }
    for cut, row in rows.items():
        assert row["lambda_c_m"] == cut and 0 < row["Rq_sem_m"] < row["Rq_m"]
    assert rows[0.25e-3]["Rq_m"] < rows[0.8e-3]["Rq_m"] < rows[0.8e-3]["Pq_m"]
