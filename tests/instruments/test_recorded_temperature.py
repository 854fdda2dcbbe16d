"""The viscosity at the temperature that the runs recorded, and liquids that thin or heat."""

import json

import numpy as np
import pytest
import xarray as xr

from tribolab.campaign.models.analysis import _heating
from tribolab.campaign.models.plan import plan_models
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.settings.media import LiquidStated, Recorded, medium_viscosity
from tribolab.contact.geometry import LineContact, PointContact
from tribolab.core.errors import ConfigError
from tribolab.records.part_records import CurveRecord
from tribolab.records.parts import CurveOutcome

KELVIN = 293.15


def campaign_with(folder, medium, curve="rate [1/s],Viscosity [Pa s]\n"):
    (folder / "raw").mkdir(exist_ok=True)
    (folder / "raw/a.csv").write_text("")
    (folder / "raw/xanthan.csv").write_text("Shear rate [1/s]\tViscosity [mPa s]\n" + curve)
    file = folder / "campaign.toml"
    file.write_text(
        '[campaign]\nname = "a"\n[contact]\ngeometry = "ball"\nradius = "9.5 mm"\n'
        'youngs_modulus = "1 MPa"\npoisson_ratio = 0.5\n'
        f'[medium.liquid]\n{medium}\n[[run]]\nfiles = "a.csv"\nmedium = "liquid"\n',
        "utf-8",
    )
    return load_campaign(file)


def planned(campaign, kelvin=None, spread=0.0):
    outcome = CurveOutcome("curve_liquid", "", "liquid", 3.0, "data/c.nc", ("a",))
    record = CurveRecord(outcome, temperature_K=kelvin, temperature_spread_K=spread)
    (model,) = plan_models(campaign, [record], [])
    return model


@pytest.mark.parametrize("warmer", [-0.5, 0.5])
def test_glycerol_falls_by_a_twelfth_with_each_kelvin(warmer):
    room = 296.15
    liquid = LiquidStated("glycerol", 1.3, (1.2, 1.4), room, 0.01)
    at_home, away = (medium_viscosity(liquid, {}, Recorded(room + d, 0.0)) for d in (0.0, warmer))
    assert at_home.value == 1.3 and at_home.bounds == (1.2, 1.4)
    assert np.log(away.value / 1.3) == pytest.approx(-0.086 * warmer, rel=0.02)
    assert away.bounds[0] / away.value == pytest.approx(1.2 / 1.3)


def test_a_model_takes_the_viscosity_at_the_recorded_temperature(tmp_path):
    medium = 'viscosity = "0.1 Pa s"\ntemperature = "20 °C"\nviscosity_per_kelvin = "3 %/K"'
    campaign = campaign_with(tmp_path, medium)
    assert planned(campaign).viscosity == 0.1
    warm = planned(campaign, KELVIN + 10, 1.0)
    assert warm.viscosity == pytest.approx(0.1 * np.exp(-0.3))
    assert warm.abscissa_error == pytest.approx(0.03)  # a kelvin along the curve
    assert warm.tempered
    bare = campaign_with(tmp_path, 'viscosity = "0.1 Pa s"')
    assert planned(bare, KELVIN + 10).viscosity == 0.1 and not bare.tempered("liquid")


def test_a_flow_curve_makes_a_thinning_liquid(tmp_path):
    campaign = campaign_with(tmp_path, 'flow_curve = "xanthan.csv"', "0.1\t900\n10\t80\n1e3\t5\n")
    model = planned(campaign)
    assert model.viscosity == pytest.approx(0.9)
    rates, relative = model.flow_curve
    assert rates == pytest.approx((0.1, 10, 1000))
    assert relative == pytest.approx((1, 80 / 900, 5 / 900))
    json.dumps(model.flow_curve)  # it is in the fingerprint


@pytest.mark.parametrize(
    ("medium", "curve", "words"),
    [
        ('flow_curve = "xanthan.csv"\nviscosity = "1 Pa s"', "1\t2\n2\t1\n", "state one of them"),
        ('flow_curve = "xanthan.csv"', "1\t2\n1\t2\n", "one shear rate only"),
        ('flow_curve = "gone.csv"', "", "gone.csv"),
    ],
    ids=["both", "one rate", "no file"],
)
def test_what_is_wrong_with_a_flow_curve_is_said(tmp_path, medium, curve, words):
    with pytest.raises(ConfigError) as error:
        campaign_with(tmp_path, medium, curve)
    assert "medium.liquid.flow_curve" in str(error.value) and words in str(error.value)


@pytest.mark.parametrize(
    ("contact", "load"),
    [
        (PointContact("9.5 mm", "1 MPa", 0.5), 3.0),
        (LineContact("7 cm", "10 cm", "1.5 MPa", 0.5), 310.0),
    ],
    ids=["ball", "cylinder"],
)
def test_viscous_heating_is_reported_above_two_kelvin(contact, load):
    speeds = [1e-3, 10.0]
    curve = xr.Dataset(
        {"friction_coefficient": ("sliding_speed", [0.05, 0.5])}, {"sliding_speed": speeds}
    )
    assert _heating(contact, load, curve, 1e-3) == []
    (finding,) = _heating(contact, load, curve, 10.0)
    assert finding.severity == "suspect" and "viscous heating" in finding.message
    assert "10 m/s" in finding.message
