"""A ball on a flat: dry, lubricated by the full theory, and by strips."""

import numpy as np
import pytest
import xarray as xr
from ball_cases import BALL, COARSE, STRESS, TABLE, ball_psd

from tribolab.contact.geometry import PointContact
from tribolab.contact.hertz import (
    hertz_half_width,
    hertz_max_pressure,
    jkr_half_width,
    jkr_smallest_load,
)
from tribolab.contact.point import rough_point_contact
from tribolab.contact.polar import polar_mesh
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.parameters import Interface, Liquid, Solver
from tribolab.lubrication.point import sweep
from tribolab.lubrication.stribeck import stribeck_curve


def fluid(curve):
    return (curve.friction_coefficient - curve.friction_coefficient_solid).values


@pytest.fixture(scope="module")
def rough():
    return stribeck_curve(BALL, ball_psd(), 1.0, 3.0, STRESS, list(TABLE))


def test_hertz_and_jkr_of_a_ball():
    a = hertz_half_width(3.0, BALL)
    assert a == pytest.approx((3 * 3.0 * 9.5e-3 / (4 * 4e6 / 3)) ** (1 / 3))
    assert hertz_max_pressure(3.0, BALL) == pytest.approx(1.5 * 3.0 / (np.pi * a**2))
    pull = jkr_smallest_load(BALL, 0.05)
    assert pull == pytest.approx(-1.5 * np.pi * 0.05 * 9.5e-3)
    assert jkr_half_width(3.0, BALL, 1e-9) == pytest.approx(a, rel=1e-5)
    with pytest.raises(AnalysisError, match="detaches below"):
        jkr_half_width(1.01 * pull, BALL, 0.05)


def test_rings_bend_as_hertz_says():
    mesh = polar_mesh(60, 24, 0.01, 4.0)
    pressure = 4 / np.pi * np.sqrt(np.maximum(1 - mesh.squared, 0))
    film = mesh.squared + mesh.kernel @ pressure
    inside = mesh.squared < 0.9
    assert film[inside] == pytest.approx(2.0, rel=2e-3)
    assert 2 * mesh.area @ pressure == pytest.approx(8 / 3, rel=1e-3)


def test_dry_and_lubricated_starts_from_the_same_contact(rough):
    dry = rough_point_contact("3 N", BALL, ball_psd())
    assert float(dry.friction_per_shear_stress) == pytest.approx(TABLE[0.0][1], rel=1e-3)
    assert float(dry.central_separation) == pytest.approx(TABLE[0.0][2], rel=3e-3)
    assert dry.load_balance == pytest.approx(0, abs=1e-9)
    assert float(rough.friction_per_shear_stress[0]) == pytest.approx(TABLE[0.0][1], rel=1e-3)


def test_a_rough_ball_is_within_half_a_percent_of_other_meshes(rough):
    wet, area, film = np.array(list(TABLE.values())).T
    assert rough.friction_coefficient.values == pytest.approx(wet + STRESS * area, rel=6e-3)
    assert rough.central_separation.values == pytest.approx(film, rel=5e-3)
    assert fluid(rough)[2:] == pytest.approx(wet[2:], rel=0.01)
    slow = dict(sliding_speed=[1e-7, 3.16e-5])
    expected = xr.DataArray(wet + STRESS * area, rough.sliding_speed.coords).sel(slow)
    assert rough.friction_coefficient.sel(slow).values == pytest.approx(expected, rel=2e-3)
    assert rough.method == "rings and sectors"


def test_load_and_flux_are_conserved(rough):
    assert np.abs(rough.load_balance).max() < 1e-8
    assert rough.flux_variation.max() < 1e-8
    assert rough.residual.max() < 1e-8


def test_strips_are_within_their_limit_and_say_so(rough):
    speeds = [v for v in TABLE if v <= 0.1]
    strips = stribeck_curve(BALL, ball_psd(), 1.0, 3.0, STRESS, speeds, Solver(method="strips"))
    ratio = strips.friction_coefficient / rough.friction_coefficient
    thin = ratio.sel(sliding_speed=slice(None, 1e-2))
    assert 0.95 < float(thin.min()) and float(thin.max()) < 1.07
    assert float(ratio[-1]) == pytest.approx(0.92, abs=0.01)
    auto = stribeck_curve(BALL, ball_psd(), 1.0, 3.0, STRESS, [1e-4, 1.0], Solver(method="auto"))
    assert auto.method.startswith("strips up to the limit")
    same = float(strips.friction_coefficient.sel(sliding_speed=1e-4))
    assert float(auto.friction_coefficient[0]) == pytest.approx(same, rel=1e-6)


@pytest.mark.parametrize(("speed", "load"), [(2e-9, 1.2e-3), (2e-7, 1.2e-3), (2e-6, 1.2e-2)])
def test_a_smooth_soft_ball_has_the_film_of_other_meshes(speed, load):
    """Hc = 3.03 U^0.590 W^-0.121, U = eta u/(E' R), W = F/(E' R^2)."""
    ball = PointContact(1.0, 0.75, 0.5)  # E* = 1, E' = 2
    curve = stribeck_curve(ball, None, 1.0, 2 * load, 0.0, [4 * speed])
    expected = 3.03 * speed**0.590 * load**-0.121
    assert float(curve.central_separation[0]) == pytest.approx(expected, rel=0.01)


def test_a_rigid_ball_has_brewes_film(monkeypatch):
    """h0/R = 142.0 (eta u R/F)^2 of a wide liquid."""
    ball = PointContact(1.0, "6 MPa", 0.5)
    monkeypatch.setattr(sweep, "_SECTORS", 12)
    # what a liquid carries beyond X falls as 1/X: 15 % of the film is missing if it ends at R
    curve = stribeck_curve(
        ball, None, Liquid(1.0, extent=40.0), 1.0, 0.0, [5.3e-3], Solver(cells=240)
    )
    film = 142.0 * 2.65e-3**2
    assert float(curve.minimum_separation[0]) == pytest.approx(film, rel=0.02)


def test_far_liquid_and_a_flooded_outlet_drag_more(rough):
    psd, speeds = ball_psd(), [0.01, 0.1]
    far = stribeck_curve(BALL, psd, Liquid(1.0, extent="27 mm"), 3.0, STRESS, speeds)
    vented = rough.sel(sliding_speed=speeds)
    assert fluid(far) / fluid(vented) == pytest.approx([1.03, 1.09], abs=0.02)
    speeds = [1e-5, 1e-3, 0.01, 0.1, 1.0]
    flooded = stribeck_curve(BALL, psd, Liquid(1.0, outlet="flooded"), 3.0, STRESS, speeds)
    vented = rough.sel(sliding_speed=speeds)
    more = fluid(flooded) / fluid(vented)
    assert np.all((more[:2] > 1.02) & (more[:2] < 1.05))
    assert more[2:] == pytest.approx([1.11, 1.23, 1.39], abs=0.01)
    whole = flooded.friction_coefficient.values / vented.friction_coefficient.values
    assert whole[0] == pytest.approx(1.01, abs=0.005)
    assert max(abs(flooded[name]).max() for name in ("load_balance", "flux_variation")) < 1e-8


def test_a_flooded_ball_holds_tension():
    wet = Liquid(1.0, outlet="flooded")
    profile = film_profile(BALL, ball_psd(), wet, 3.0, 0.01, solver=COARSE)
    assert -5e4 < float(profile.fluid_pressure.min()) < -1e4


def test_both_bodies_move():
    """Half the difference of both signs of SRR is shear and solid; phi_s moves the area."""
    psd, speed = ball_psd(), 0.5e-3
    sliding = stribeck_curve(BALL, psd, 1.0, 3.0, STRESS, [2 * speed], COARSE)
    full, half = (
        stribeck_curve(BALL, psd, 1.0, 3.0, Interface(STRESS, slide_roll=srr), [speed], COARSE)
        for srr in (2.0, 0.5)
    )
    shear = sliding.friction_coefficient - sliding.friction_coefficient_pressure
    assert float(full.friction_coefficient[0]) == pytest.approx(float(shear[0]), rel=1e-9)
    change = half.friction_per_shear_stress.values / full.friction_per_shear_stress.values
    assert 0.88 < change[0] < 0.99 or 1.01 < change[0] < 1.1
    assert half.friction_coefficient.dims == ("entrainment_speed",)


def test_a_liquid_must_reach_beyond_the_contact():
    with pytest.raises(AnalysisError, match="inlet_length"):
        stribeck_curve(BALL, None, Liquid(1.0, extent="3 mm"), 3.0, 0.0, [0.01])
