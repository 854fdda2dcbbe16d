"""A campaign whose contact is a ball, on a layer, with the outlet stated."""

import re

import numpy as np
import pytest

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig import Protocol, Rig, simulate_campaign


@pytest.mark.slow
def test_a_campaign_with_a_ball_has_its_contact_and_model(tmp_path):
    rig = Rig(Protocol(speeds=(1e-5, 1e-4, 4.64e-4)))
    file = simulate_campaign(
        tmp_path / "c", 5, small=True, surfaces=("Sb-S",), n_scans=1, rig=rig, loads=[3.0]
    )
    text = file.read_text("utf-8")
    text = re.sub(r'\n\[\[run\]\]\nfiles = "[^"]*_dry_.*?(?=\n\[|\Z)', "", text, flags=re.S)
    text = re.sub(r"(?m)^(radius|length) = .*\n", "", text)
    text = text.replace("[contact]\n", '[contact]\ngeometry = "ball"\nradius = "40 mm"\n')
    text += '\n[model]\noutlet = "flooded"\nuncertainty = "none"\npoints = 9\nslowest = "1 um/s"\n'
    text += 'fastest = "1 mm/s"\njoint = false\n'
    file.write_text(text, "utf-8")
    campaign = load_campaign(file)
    ball = campaign.contact.whole()
    assert ball is not None and ball.is_round
    made = process(campaign, tmp_path)
    (model,) = made.models
    assert model.done, model
    curve = read_netcdf(tmp_path / model.data_file, "curve")
    assert curve.method.startswith("strips") and curve.outlet == "flooded"
    assert curve["load"].attrs["units"] == "N"
    lines = read_netcdf(tmp_path / made.surfaces[0].data_file, "line")
    width = 2 * (3 * 3.0 * 0.04 / (4 * ball.effective_modulus)) ** (1 / 3)
    assert 0.9 * width < float(lines.contact_width[0]) < 1.6 * width
    assert np.isfinite(curve.friction_coefficient.values).all()


def test_a_ball_needs_no_length_and_a_layer_is_passed_on():
    from tribolab.campaign.settings.measured import Contact

    known = {"radius": "9.5 mm", "youngs_modulus": "1 MPa", "poisson_ratio": 0.5}
    ball = Contact.model_validate({**known, "geometry": "ball", "thickness": "3 mm"})
    assert ball.whole().thickness == 3e-3
    assert Contact.model_validate(known).whole() is None  # a line wants its length
