"""Whether liquids collapse on one curve of viscosity times speed, and what that test can see."""

import numpy as np
import pytest
import xarray as xr
from contact_cases import reference_psd

import tribolab as tl
from tribolab.contact.geometry import LineContact, PointContact
from tribolab.contact.rolling import rolling_friction
from tribolab.core.errors import AnalysisError
from tribolab.figures.subjects.master import master_curve
from tribolab.fit.master_curve import collapse_test
from tribolab.surface.moments import rms_roughness

VISCOSITIES = [0.02, 0.2, 1.4]
SPEEDS = np.geomspace(1e-6, 1e-1, 13)


def simulated(seed, exponent):
    """Three liquids with 3 % noise, levels off by 5 % and viscosities by 10 %."""
    rng = np.random.default_rng(seed)
    curves = []
    for eta in VISCOSITIES:
        true = eta * np.exp(0.1 * rng.normal()) * SPEEDS
        solid = 0.15 / (1 + (true / 3e-5) ** 0.7) * (SPEEDS / 1e-4) ** exponent
        mu = (solid + 0.1 * true**0.45) * np.exp(0.05 * rng.normal() + 0.03 * rng.normal(size=13))
        data = {"friction_coefficient": mu, "friction_coefficient_sem": 0.03 * mu}
        parts = {name: ("sliding_speed", value) for name, value in data.items()}
        curves.append(xr.Dataset(parts, {"sliding_speed": SPEEDS}))
    return curves


def test_one_curve_is_seldom_rejected_and_a_stress_over_speed_mostly_seen():
    p = {n: [collapse_test(simulated(s, n), VISCOSITIES).p_value for s in range(60)]
         for n in (0.0, 0.1)}  # fmt: skip
    assert np.mean(np.array(p[0.0]) < 0.05) <= 0.12
    assert np.mean(np.array(p[0.1]) < 0.05) >= 0.8


def test_too_few_points_are_refused():
    curves = [one.isel(sliding_speed=slice(0, 4)) for one in simulated(1, 0.0)]
    with pytest.raises(AnalysisError, match="points are wanted"):
        collapse_test(curves, VISCOSITIES)


def test_the_figure_has_every_liquid_the_common_curve_and_the_regimes():
    curves = simulated(1, 0.0)
    collapse = collapse_test(curves, VISCOSITIES)
    figure = tl.plot.master_curve(curves, VISCOSITIES, names=["a", "b", "c"], collapse=collapse)
    labels = tl.plot.figure_data(figure).series.unique().tolist()
    assert labels[:3] == ["a", "b", "c"] and labels[3].startswith("one curve")


def test_the_regime_map_has_the_film_ratio_and_where_it_is_1_and_3():
    contact, psd = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5), reference_psd("Sb-S")
    curve = tl.stribeck_curve(contact, psd, 1.4, 310.0, 1e6, np.geomspace(1e-8, 0.1, 20))
    height = rms_roughness(psd)
    spec = master_curve.spec([curve], [1.4], model=curve, rms_roughness=height)
    assert len(spec.panels) == 2
    (film,) = [one for one in spec.series if one.panel == 1]
    np.testing.assert_allclose(film.y, curve.central_separation / height)
    places = [mark.value for mark in spec.marks if mark.side == "x"]
    at_marks = np.interp(np.log(places), np.log(film.x), np.log(film.y))
    np.testing.assert_allclose(np.exp(at_marks), [1.0, 3.0], rtol=1e-9)


def test_rolling_loses_what_greenwood_says():
    ball = PointContact("9.5 mm", "1 MPa", 0.5, counter_modulus="1 MPa")
    one, both = rolling_friction(3.0, ball, 0.2), rolling_friction(3.0, ball, 0.2, 0.2)
    assert both == pytest.approx(2 * one)
    line = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    assert rolling_friction(310.0, line, 0.3) == pytest.approx(
        0.3 * 2 * 3.7168e-3 / (3 * np.pi * 0.07), rel=1e-4
    )
