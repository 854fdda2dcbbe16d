"""Limits of the theory: silent on sound contacts, said beyond one limit, refused beyond two."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from contact_cases import CONTACT, SURFACES, reference_psd, self_affine

from tribolab.contact.adhesive_contact import adhesion, macroscopic_work_of_adhesion
from tribolab.contact.gap import gap_distribution
from tribolab.contact.geometry import LineContact
from tribolab.contact.hertz import hertz_half_width, jkr_half_width
from tribolab.contact.limits import line_limits
from tribolab.contact.line import rough_line_contact
from tribolab.contact.persson import contact_area_ratio, mean_separation
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import LIMITS, examine
from tribolab.fit.model_error import model_uncertainty
from tribolab.lubrication.factors import flow_factors, smooth_factors
from tribolab.lubrication.film import film_profile
from tribolab.lubrication.stribeck import stribeck_curve
from tribolab.records.parts import limit_findings
from tribolab.records.wording import validity_of
from tribolab.report.page.templating import environment
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.modulus import PDMS_STAND_IN, TabulatedModulus
from tribolab.studies import xu2026
from tribolab.surface.moments import rms_slope

SOFT = replace(CONTACT, radius=7e-3, youngs_modulus=0.1e6)
PRESSURE = xr.DataArray([2e4, 4e4], dims="place")


def table(low, high):
    """A modulus table cut out of the stand-in."""
    omega = np.geomspace(low, high, 200)
    value = PDMS_STAND_IN(omega)
    return TabulatedModulus(omega, value.real, value.imag)


def test_pressures_beyond_the_table_come_back_until_they_are_refused():
    """The second limit is where p(u) ends as a number: twice as far the separation is 0."""
    table, limit = separation_table(reference_psd("Sb-S"), 2e6), LIMITS["pressure"]
    ends = table.table_pressure[-1] * np.array([limit.suspect, limit.refuse])
    np.testing.assert_allclose(table.pressure(table.separation(ends)), ends, rtol=1e-4)
    assert table.separation(2 * ends[1]) == 0


def test_flow_factors_say_where_slopes_are_too_steep_for_thin_film_flow():
    psd = reference_psd("Sb-S")
    for slope, word in ((0.5, "pass"), (2.0, "suspect")):
        steep = psd.assign(psd_2d=psd.psd_2d * (slope / rms_slope(psd)) ** 2)
        found = flow_factors(steep).dataset([1e-6])
        assert found.attrs["validity"] == word
        assert ("rms slope" in found.attrs["validity_reasons"]) == (word == "suspect")
    assert smooth_factors().dataset([1e-6]).attrs["validity"] == "pass"


def test_the_band_says_which_variation_alone_leaves_the_theory():
    given = {"viscosity": 1.4, "load": 100.0, "shear_stress": 0.0, "speed": [1e-3], "cells": 60}
    body = LineContact("7 mm", "10 cm", "0.17 MPa", 0.5)
    inside = model_uncertainty(body, None, **given)
    assert inside.attrs["validity"] == "pass"
    soft = model_uncertainty(
        body, None, youngs_modulus_range=("0.08 MPa", "0.3 MPa"), **given
    ).attrs
    assert soft["validity"] == "suspect"
    assert soft["validity_reasons"].startswith("varied Young's modulus (0.08 MPa): half-width")


@pytest.mark.slow
@pytest.mark.parametrize("name", SURFACES)
def test_the_reference_contacts_are_inside_every_limit(name):
    psd, speeds = reference_psd(name), [1e-6, 1e-4, 1e-2]
    loads = [CONTACT.load(force) for force in (xu2026.system.loads[0], xu2026.system.loads[-1])]
    results = [
        stribeck_curve(CONTACT, psd, 1.4, loads, "1 MPa", speeds, cells=100),
        film_profile(CONTACT, psd, 1.4, loads[0], 1e-2, cells=100),
        rough_line_contact(loads[0], CONTACT, psd),
        adhesion([0.0, 4e4], psd, "2 MPa", "64 mJ/m^2", nodes=60),
        macroscopic_work_of_adhesion(psd, "2 MPa", "64 mJ/m^2", nodes=60),
        gap_distribution(4e4, psd, "2 MPa"),
        viscoelastic_friction([1e-6, 1e-3], 4e4, psd, PDMS_STAND_IN),
        contact_area_ratio(PRESSURE, psd, 2e6),
        mean_separation(PRESSURE, psd, 2e6),
    ]
    assert [one.attrs["validity"] for one in results] == ["pass"] * len(results)
    assert validity_of(results) == ""
    assert limit_findings({"curve": results[0]}) == []


@pytest.mark.parametrize("name", LIMITS)
def test_each_limit_has_three_answers(name):
    limit = LIMITS[name]
    assert examine("it", **{name: 0.99 * limit.suspect}) == {
        "validity": "pass",
        "validity_reasons": "",
    }
    said = examine("it", "here", **{name: [np.nan, 0.0, 1.01 * limit.suspect]})
    assert said["validity"] == "suspect"
    for words in (limit.what, " here, above", limit.because, limit.cure):
        assert words in said["validity_reasons"]
    if np.isinf(limit.refuse):  # however far beyond, it is a warning
        assert examine("it", **{name: 1e6 * limit.suspect})["validity"] == "suspect"
        return
    with pytest.raises(AnalysisError, match="^it: .* far above .*: .*; "):
        examine("it", **{name: 1.01 * limit.refuse})


def test_a_wide_contact_is_said_and_one_wider_than_its_cylinder_refused():
    curve = stribeck_curve(SOFT, None, 1.4, 310.0, 0.0, [1e-3], cells=100)
    assert "half-width of the contact over the radius R is 0.65 at 310 N/m" in validity_of([curve])
    (finding,) = limit_findings({"curve": curve})
    assert finding.severity == "suspect" and finding.message.startswith("curve: half-width")
    for compute in (hertz_half_width, lambda load, body: jkr_half_width(load, body, 0.05)):
        assert compute(310.0, SOFT) < SOFT.radius
        with pytest.raises(AnalysisError, match="half-width of the contact"):
            compute(1000.0, SOFT)


def test_hard_bodies_are_said_to_thicken_a_liquid():
    """Steel in oil at 0.9 GPa would get a film of soft lubrication, and not a word."""
    for modulus, load, hard in ((20e6, 3e3, False), (210e9, 1e5, True)):
        body = LineContact("10 mm", "10 mm", modulus, 0.3)
        said = line_limits("curve", body, load, speed=[1e-3], film=[1e-6])
        assert ("an oil's viscosity" in said["validity_reasons"]) is hard
        assert line_limits("dry", body, load)["validity"] == "pass"


def test_a_thick_film_is_said_with_the_speed_from_which_on():
    narrow = replace(CONTACT, radius=1e-3)
    curve = stribeck_curve(narrow, None, 1.4, 100.0, 0.0, [1e-3, 0.1, 0.5], cells=100)
    thick = curve.minimum_separation.values / narrow.radius > 0.01
    assert thick.tolist() == [False, False, True]
    assert "(above the limit from 0.5 m/s on)" in validity_of([curve])
    with pytest.raises(AnalysisError, match="film thickness"):
        line_limits("curve", narrow, 1.0, speed=[1.0], film=[6e-4])


def test_steep_surfaces_are_said_and_steeper_ones_refused():
    for slope, word in ((0.9, "pass"), (1.2, "suspect")):
        psd = self_affine(0.8, slope)
        for one in (
            contact_area_ratio(PRESSURE, psd, 2e6),
            mean_separation(PRESSURE, psd, 2e6),
            adhesion(4e4, psd, 2e6, 0.05, nodes=60),
            gap_distribution(4e4, psd, 2e6),
            rough_line_contact(310.0, CONTACT, psd),
        ):
            assert one.attrs["validity"] == word
    with pytest.raises(AnalysisError, match="rms slope of the surface is 6"):
        contact_area_ratio(4e4, self_affine(0.8, 6.0), 2e6)


def test_more_binding_than_smooth_surfaces_have_is_said():
    soft = adhesion([0.0, 1e3], self_affine(0.8, 0.9), "20 kPa", "50 mJ/m^2", nodes=60)
    most = float(soft.effective_work_of_adhesion[:, 0].max()) / 0.05
    assert most > 1
    assert f"gamma_eff at magnification 1 over the work of adhesion is {most:.3g}" in validity_of(
        [soft]
    )


def test_pressure_beyond_the_table_of_separations_is_said():
    psd = self_affine(0.8, 0.05)
    separation = separation_table(psd, CONTACT.effective_modulus)
    last = separation.table_pressure[-1]
    load = 310.0 * (1.2 * last / 52.9e3) ** 2
    said = line_limits("curve", replace(CONTACT, radius=0.07), load, psd, separation)
    assert "contact pressure over the largest in the table of p(u) is 1.2" in str(said)


def test_frequencies_outside_the_table_are_said_at_either_end():
    """A table that ends too soon makes friction several times too small, and the result says so."""
    psd, speeds = reference_psd("Sb-R"), np.geomspace(1e-5, 1e-2, 7)
    whole = viscoelastic_friction(speeds, 4e4, psd, table(1e-8, 1e12))
    assert whole.attrs["validity"] == "pass"
    exact = viscoelastic_friction(speeds, 4e4, psd, PDMS_STAND_IN)
    np.testing.assert_allclose(whole.friction_coefficient, exact.friction_coefficient, rtol=0.01)
    for ends in ((1e-8, 1e2), (1e6, 1e12)):
        short = viscoelastic_friction(speeds, 4e4, psd, table(*ends))
        off = np.abs(short.friction_coefficient / exact.friction_coefficient - 1)
        assert off.max() > 0.2
        assert "outside the modulus table" in validity_of([short])
        assert f"the table holds {ends[0]:.3g} to {ends[1]:.3g} rad/s" in validity_of([short])
    with pytest.raises(AnalysisError, match="outside the modulus table"):
        viscoelastic_friction([1.0], 4e4, psd, table(1e-8, 1e-6))


@pytest.mark.parametrize(("reasons", "shown"), [("", False), ("too steep: a; b", True)])
def test_the_page_marks_what_is_beyond_the_limits(reasons, shown, tmp_path):
    text = '{% from "cells.html.j2" import limits, named with context %}{{ named(row) }}'
    row = {"name": "Sb-R", "quality": "pass", "validity": reasons}
    cell = environment(tmp_path).from_string(text).render(row=row)
    assert ('class="chip suspect"' in cell) == shown
    assert (f'title="{reasons}"' in cell) == shown
