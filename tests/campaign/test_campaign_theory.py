"""What a campaign file may choose of the theory: area, adhesion, dry friction, modulus."""

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest

import tribolab as tl
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.report.results import write_report
from tribolab.rig import Protocol, Rig, simulate_campaign
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.prony import PronySeries
from tribolab.rubber.temperature import WilliamsLandelFerry, modulus_at

SCHEMA = Path(tl.__file__).parents[1] / "raw_data_schema/report.schema.json"
SPEEDS = (1e-5, 1e-4, 4.64e-4, 1e-3, 2.15e-3)
SURFACES = ("Sb-S", "Sb-R")
CHOSEN = """
[model]
uncertainty = "none"
adhesion = true
area = "corrected"
together = ["Sb-S", "Sb-R"]
dry_medium = "dry"
[rubber]
prony_moduli = ["10 MPa", "100 MPa"]
prony_times = ["10 us", "0.1 us"]
temperature = "25 °C"
reference_temperature = "20 °C"
c1 = 6.0
c2 = "200 K"
adhesion = "dry"
"""


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Two surfaces, dry and in glycerol, at one load, with all that may be chosen."""
    folder = tmp_path_factory.mktemp("theory")
    file = simulate_campaign(
        folder / "campaign",
        5,
        surfaces=SURFACES,
        loads=(31.0,),
        n_repeats=1,
        n_scans=1,
        rig=Rig(Protocol(speeds=SPEEDS)),
    )
    file.write_text(file.read_text("utf-8") + CHOSEN, "utf-8")
    made = process(load_campaign(file), folder)
    write_report(made, figures="none")
    return folder


def table(results, name) -> pd.DataFrame:
    return pd.read_csv(results / f"tables/{name}.csv")


def report_of(results):
    return json.loads((results / "report.json").read_text("utf-8"))


def joint_parameters(results) -> pd.DataFrame:
    """Parameters of all joint fits, a row each."""
    return pd.DataFrame(
        [
            row | {"fit": fit["name"], "surface": row["surface"] or fit["surface"]}
            for fit in report_of(results)["joint_fits"]
            for row in fit["parameters"]
        ]
    )


def single_fits(results) -> pd.DataFrame:
    """Shear stress fitted to each curve, a row each."""
    return pd.DataFrame([one["fit"] for one in report_of(results)["models"] if one["fit"]])


@pytest.mark.slow
def test_of_one_load_the_exponent_of_load_is_said_to_be_as_assumed(results):
    fits = joint_parameters(results)
    untold = fits[fits["parameter"] == "load_exponent"]
    assert len(untold) == 4 and set(untold["identified"]) == {"not identified"}
    np.testing.assert_allclose(untold["low"], untold["prior_low"], rtol=1e-6)
    np.testing.assert_allclose(untold["high"], untold["prior_high"], rtol=1e-6)
    assert np.all(untold["value"] == 0)
    page = (results / "report.html").read_text("utf-8")
    said = "exponent of load: not identified; the interval is what was assumed beforehand, 0 ("
    assert page.count(said) == 2  # one for each surface alone


@pytest.mark.slow
def test_surfaces_that_are_stated_to_be_together_share_their_viscosity(results):
    fits = joint_parameters(results).set_index(["fit", "surface", "parameter"]).sort_index()
    both = fits.loc["joint_Sb-S_Sb-R_glycerol"]
    liquid = both.loc["Sb-S and Sb-R", "viscosity"]
    assert liquid["low"] < 1.4 < liquid["high"]
    for surface in SURFACES:
        alone = fits.loc[f"joint_{surface}_glycerol"].loc[surface, "viscosity"]
        assert liquid["high"] - liquid["low"] < alone["high"] - alone["low"]
        assert both.loc[surface, "shear_stress"]["identified"] == "yes"
    report = json.loads((results / "report.json").read_text("utf-8"))
    jsonschema.validate(report, json.loads(SCHEMA.read_text("utf-8")))
    assert [fit["surface"] for fit in report["joint_fits"]] == [*SURFACES, "Sb-S and Sb-R"]


@pytest.mark.slow
def test_dry_friction_is_in_the_fit_with_the_area_that_adhesion_gives_it(results):
    """Of dry points the model is sigma A_dry/F times the ratio of the stresses."""
    fits = joint_parameters(results).set_index(["fit", "parameter"])
    points = read_netcdf(results / "data/joint_Sb-S_glycerol.nc", "points").to_dataframe()
    dry = points[points["curve"] == "31 N dry"]
    assert len(dry) == len(SPEEDS)
    mine = fits.loc["joint_Sb-S_glycerol"]["value"]
    surface = read_netcdf(results / "data/surface_Sb-S.nc", "adhesion_loads").isel(load=0)
    growth = float(surface["area_enhancement"].sel(medium="dry"))
    contact = load_campaign(results / "campaign").contact.whole()
    psd = read_netcdf(results / "data/surface_Sb-S.nc", "psd")
    rest = tl.stribeck_curve(contact, psd, 1.4, 310.0, 0.0, [0.0], area="corrected")
    stress = mine["shear_stress"] * mine["dry_over_wet"]
    stress *= (dry["sliding_speed"] / 1e-5) ** mine["speed_exponent"]
    expected = stress * growth * float(rest["friction_per_shear_stress"][0])
    np.testing.assert_allclose(dry["friction_coefficient_model"], expected, rtol=0.02)


@pytest.mark.slow
def test_the_chosen_theory_of_the_area_is_in_every_table(results):
    contact, adhesive = table(results, "contact"), table(results, "adhesion")
    psd = read_netcdf(results / "data/surface_Sb-S.nc", "psd")
    mine = contact[contact["surface"] == "Sb-S"].iloc[0]
    areas = [
        tl.contact.contact_area_ratio(mine["pressure_Pa"], psd, 2e6, a)
        for a in ("corrected", "persson")
    ]
    assert mine["contact_area_ratio"] == pytest.approx(areas[0], rel=1e-6)
    wet = adhesive[(adhesive["surface"] == "Sb-S") & (adhesive["medium"] == "glycerol")].iloc[0]
    assert wet["contact_area_ratio_no_adhesion"] == pytest.approx(areas[0], rel=1e-3)
    fits = single_fits(results)
    assert set(fits["area"]) == {"corrected"} and set(fits["other_area"]) == {"persson"}
    ratio = fits["shear_stress_Pa"] / fits["shear_stress_other_area_Pa"]
    np.testing.assert_allclose(ratio, areas[1] / areas[0], rtol=0.05)
    compared = [row["model"] for fit in report_of(results)["joint_fits"] for row in fit["models"]]
    assert compared.count("Persson's area") == 3
    page = (results / "report.html").read_text("utf-8")
    assert "corrected for the energy of partial contact" in page


@pytest.mark.slow
def test_the_models_area_is_that_with_adhesion_under_the_liquid(results):
    fits = single_fits(results)
    assert set(fits["adhesion"]) == {"with"} and set(fits["area_enhancement"]) == {1.0}
    curve = read_netcdf(results / "data/model_Sb-S_glycerol_31N.nc", "curve")
    assert curve.attrs["work_of_adhesion_J_m2"] == pytest.approx(51e-3)
    growth = table(results, "adhesion").query("surface == 'Sb-S' and medium == 'glycerol'")
    contact = load_campaign(results / "campaign").contact.whole()
    psd = read_netcdf(results / "data/surface_Sb-S.nc", "psd")
    bare = tl.stribeck_curve(contact, psd, 1.4, 310.0, 0.0, [1e-9], area="corrected")
    ratio = float(curve["friction_per_shear_stress"][0] / bare["friction_per_shear_stress"][0])
    assert ratio == pytest.approx(float(growth["area_enhancement"].iloc[0]), rel=0.05)


@pytest.mark.slow
def test_the_rubber_is_the_series_at_its_temperature_and_heat_is_warned_of(results):
    friction, loads, psd = (
        read_netcdf(results / "data/surface_Sb-R.nc", group) for group in ("rubber", "loads", "psd")
    )
    friction, pressure = friction.isel(load=0), float(loads["pressure"][0])
    series = PronySeries(1.5e6, [1e7, 1e8], [1e-5, 1e-7])
    warm = modulus_at(series, "25 degC", WilliamsLandelFerry(6.0, 200.0, 293.15))
    speed = friction["sliding_speed"].values[::20]
    given = {"work_of_adhesion": 64e-3, "area": "corrected"}
    again = viscoelastic_friction(speed, pressure, psd, warm, 0.5, **given)
    np.testing.assert_allclose(
        friction["friction_coefficient"][::20], again["friction_coefficient"], rtol=1e-6
    )
    said = "Prony series of 2 relaxations, 1.5 MPa at rest, shifted from 20 to 25 °C"
    assert said in (results / "report.html").read_text("utf-8")
    messages = table(results, "checks")["message"]
    assert messages.str.contains("temperature rise in K in the contact spots").any()


def test_a_larger_area_is_adhesive_by_the_same_ratio():
    """Adhesion multiplies the area of any theory, up to complete contact."""
    from contact_cases import reference_psd

    psd, given = reference_psd("Sb-S"), ([4e4, 4e5], reference_psd("Sb-S"), 2e6)
    plain, corrected = (
        tl.contact.adhesion(*given, 51e-3, area=a, nodes=60) for a in ("persson", "corrected")
    )
    free = tl.contact.contact_area_ratio(np.array(given[0]), psd, 2e6, "corrected")
    np.testing.assert_allclose(corrected.contact_area_ratio_no_adhesion, free, rtol=2e-3)
    grown = np.minimum(corrected.contact_area_ratio_no_adhesion * plain.area_enhancement, 1.0)
    np.testing.assert_allclose(corrected.contact_area_ratio, grown, rtol=1e-12)
    assert corrected.area_enhancement[0] == pytest.approx(float(plain.area_enhancement[0]))
    assert np.all(np.diff(corrected.apparent_contact_area_ratio) <= 1e-12)


@pytest.mark.slow
def test_the_range_of_the_work_of_adhesion_is_in_the_models_band():
    from contact_cases import CONTACT, reference_psd

    given = {"viscosity": 1.4, "load": 310.0, "shear_stress": 1e6, "speed": [1e-7, 1e-1]}
    band = tl.fit.model_uncertainty(
        CONTACT,
        reference_psd("Sb-S"),
        work_of_adhesion=51e-3,
        work_of_adhesion_range=(21e-3, 59e-3),
        cells=60,
        **given,
    )
    mine = band.sel(variation="work of adhesion")
    low, high = mine["friction_coefficient_varied"].values[:, 0]
    assert low < float(band["friction_coefficient"][0]) < high
    assert "contact area: with adhesion" in band.attrs["not_varied"]
    fast = mine["friction_coefficient_varied"].values[:, 1]
    assert np.ptp(fast) / fast.mean() < 0.02 < (high - low) / high  # where nothing touches


BASE = """[campaign]
name = "mistakes"
[contact]
youngs_modulus = "1.5 MPa"
poisson_ratio = 0.5
[medium.dry]
work_of_adhesion = "64 mJ/m^2"
[medium.water]
[[surface]]
name = "a"
scans = "*.csv"
"""


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        ('[model]\ntogether = ["a", "b"]', r"no \[\[surface\]\] is called 'b'"),
        ('[model]\ntogether = ["a"]', "two surfaces or more"),
        ('[model]\ndry_medium = "air"', r"there is no \[medium.air\]"),
        ('[model]\ndry_medium = "water"', "wants a work_of_adhesion above zero"),
        ('[rubber]\nadhesion = "oil"', r"there is no \[medium.oil\]"),
        ('[rubber]\nprony_moduli = ["1 MPa"]', "prony_times: 0 for 1"),
        ('[rubber]\ntemperature = "40 °C"', "reference_temperature: wanted for the shift"),
        (
            '[rubber]\ntemperature = "40 °C"\nreference_temperature = "20 °C"\nc1 = 6\nc2 = "9 K"',
            "there is no modulus to shift",
        ),
    ],
)
def test_mistakes_are_told_with_the_key(tmp_path, extra, said):
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw/a.csv").write_text("x")
    file = tmp_path / "campaign.toml"
    file.write_text(f"{BASE}{extra}\n", "utf-8")
    with pytest.raises(ConfigError, match=said) as told:
        load_campaign(file)
    assert re.search(r"line 1[2-9]", str(told.value))
