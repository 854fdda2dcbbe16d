"""The joint fit: closed forms, a sampler's answer, truths back, and what it says it cannot know."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from contact_cases import CONTACT, reference_psd
from scipy import special, stats

import tribolab as tl
from tribolab.core.errors import AnalysisError
from tribolab.fit.joint.comparison import compared
from tribolab.fit.joint.load_curve import LoadCurve, points_of
from tribolab.fit.joint.loads import fit_loads
from tribolab.fit.joint.model import Curve, JointModel, Points, parameters_of, shared_by_points
from tribolab.fit.joint.posterior import posterior_of
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.response import constant_response, response_of

PSD = reference_psd("Sb-S")
LOADS = np.array([310.0, 910.0, 2110.0])  # N/m
SPEEDS = np.geomspace(1e-6, 1e-2, 13)
ETA, STRESS, N, M = 1.7, 0.84e6, 0.05, -0.2
REFERENCE = np.exp(np.log(LOADS).mean())
PRIORS = JointPriors()


@pytest.fixture(scope="module")
def curves():
    """What is computed at a viscosity of 1.4 Pa s, which is not the true one."""
    speed = np.concatenate([[0.0], np.geomspace(1e-8, 1e-1, 57)])
    return tl.stribeck_curve(CONTACT, PSD, 1.4, LOADS, 0.0, speed, cells=60)


def friction(curves, load, speed=SPEEDS, eta=ETA, n=N, m=M, stress=STRESS):
    """Friction by the model that is fitted, without error."""
    fluid, _, area, _ = response_of(curves.sel(load=load)).at(np.log(eta * speed))
    return fluid + stress * (speed / 1e-5) ** n * (load / REFERENCE) ** m * area


def measured(mu, error=0.01, speed=SPEEDS):
    mu = np.asarray(mu)
    dims = ("run", "sliding_speed")[-mu.ndim :]
    data = {"friction_coefficient": (dims, mu), "friction_coefficient_sem": (dims, error * mu)}
    return xr.Dataset(data, {"sliding_speed": speed})


def load_curves(curves, rng=None, speed=SPEEDS, loads=LOADS, level=0.0, **truth):
    rng = rng or np.random.default_rng(0)
    parts = []
    for load in loads:
        mu = friction(curves, load, speed, **truth)
        mu = mu * np.exp(level * rng.standard_normal() + 0.01 * rng.standard_normal(speed.size))
        response = response_of(curves.sel(load=load))
        parts.append(LoadCurve(f"{load:g} N/m", "", load, measured(mu, speed=speed), response))
    return parts


def test_one_computed_curve_serves_every_viscosity(curves):
    at = tl.stribeck_curve(CONTACT, PSD, 2.3, 910.0, 0.0, SPEEDS, cells=60)
    fluid, _, area, _ = response_of(curves.sel(load=910.0)).at(np.log(2.3 * SPEEDS))
    whole = tl.lubrication.with_shear_stress(at, STRESS).friction_coefficient
    np.testing.assert_allclose(fluid + STRESS * area, whole, rtol=3e-3)
    assert not np.allclose(whole, friction(curves, 910.0, eta=1.4, n=0, m=0), rtol=0.02)


def test_the_derivatives_are_those_of_the_model(curves):
    parts = load_curves(curves)
    dry = LoadCurve("dry", "", 310.0, measured(np.full(13, 0.5)), constant_response(1e-6), dry=True)
    points = points_of([*parts, dry]).points
    every = [Curve(part.response, 0, np.log(part.load / REFERENCE)) for part in parts]
    every.append(Curve(dry.response, 0, 0.3, dry=True))
    model = JointModel(points, every, parameters_of(1, 1.4, PRIORS, [0.3]), REFERENCE)
    theta = np.array([13.5, 0.03, -0.1, 0.4, 0.2])
    _, slopes = model.predicted(theta)
    for k, step in enumerate(1e-5 * np.eye(5)):
        above, below = (model.predicted(theta + sign * step)[0] for sign in (1, -1))
        np.testing.assert_allclose(slopes[:, k], (above - below) / 2e-5, atol=1e-6)


def test_many_states_at_once_are_each_of_them_alone(curves):
    """Also beyond the computed speeds, where each response goes on in its own way."""
    parts = load_curves(curves, loads=LOADS[:2])
    dry = LoadCurve("dry", "", 310.0, measured(np.full(13, 0.5)), constant_response(1e-6), dry=True)
    points = points_of([*parts, dry]).points
    every = [Curve(part.response, 0, np.log(part.load / REFERENCE)) for part in parts]
    every.append(Curve(dry.response, 0, 0.3, dry=True))
    model = JointModel(points, every, parameters_of(1, 1.4, PRIORS, [0.3]), REFERENCE)
    rng = np.random.default_rng(5)
    states = np.array([13.5, 0.03, -0.1, 0.4, 0.2]) + rng.normal(0, [1, 0.1, 0.3, 9, 1], (2, 4, 5))
    value, slopes = model.predicted(states)
    for place in np.ndindex(2, 4):
        theta = states[place]
        alone, alone_slopes = model.predicted(theta)
        np.testing.assert_allclose(value[place], alone, rtol=1e-13)
        np.testing.assert_allclose(slopes[place], alone_slopes, rtol=1e-13)
        stress = theta[0] + theta[1] * (points.log_speed - np.log(1e-5))
        for number, curve in enumerate(every):
            mine = points.curve == number
            fluid, _, area, _ = curve.response.at(points.log_speed[mine] + theta[3])
            solid = np.exp(stress[mine] + theta[2] * curve.log_load + curve.dry * theta[4]) * area
            np.testing.assert_allclose(alone[mine], np.log(fluid + solid), rtol=1e-12)


def linear_model(rng):
    """Dry curves only: ln mu is linear in the parameters, all of which stay as they are said."""
    log_speed = np.tile(np.log(SPEEDS), 3)
    number = np.repeat(np.arange(3), SPEEDS.size)
    loads = np.array([-0.9, 0.1, 0.8])
    every = [Curve(constant_response(2e-6), 0, load, dry=True) for load in loads]
    where = parameters_of(1, 1.4, PRIORS, [0.3])
    columns = [np.ones(39), log_speed - np.log(1e-5), loads[number], 0 * log_speed, np.ones(39)]
    design = np.stack(columns, axis=1)
    y = np.log(2e-6) + design @ where.mean + 0.1 * rng.standard_normal(39)
    points = Points(log_speed, y, np.full(39, 0.05), number, number)
    return JointModel(points, every, where, REFERENCE), design, np.log(2e-6)


def test_of_a_linear_model_posterior_and_evidence_are_the_closed_forms():
    """Mean, covariance and evidence of Gaussian regression with correlated errors."""
    model, design, offset = linear_model(np.random.default_rng(3))
    posterior = posterior_of(model, PRIORS, model.parameters.mean + 0.5)
    where, points = model.parameters, model.points
    shared = shared_by_points(points, points, PRIORS.correlation_length)
    prior = np.diag(where.spread**2)
    chances = []
    for k, (tau, kappa) in enumerate(zip(posterior.level, posterior.correlated, strict=True)):
        noise = 0.05**2 * np.eye(39) + tau**2 * shared.level + kappa**2 * shared.near
        whole = noise + design @ prior @ design.T
        expected = offset + design @ where.mean
        gain = prior @ design.T @ np.linalg.inv(whole)
        off = points.log_friction - expected
        np.testing.assert_allclose(posterior.mean[k], where.mean + gain @ off, atol=1e-6)
        np.testing.assert_allclose(
            posterior.covariance[k], prior - gain @ design @ prior, atol=1e-9
        )
        chances.append(stats.multivariate_normal(expected, whole).logpdf(points.log_friction))
    chances = np.array(chances)
    for size, scale in (
        (posterior.level, PRIORS.level),
        (posterior.correlated, PRIORS.correlated),
    ):
        tried, place = np.unique(size, return_inverse=True)
        edges = np.r_[0, (tried[1:] + tried[:-1]) / 2, np.inf]
        chances += np.log(np.diff(stats.rayleigh(scale=scale).cdf(edges)))[place]
    assert posterior.log_evidence == pytest.approx(special.logsumexp(chances), abs=1e-6)
    np.testing.assert_allclose(posterior.weight, special.softmax(chances), atol=1e-6)


@pytest.mark.slow
def test_the_mixture_is_what_a_sampler_finds(curves):
    """Metropolis steps through the parameters and both sizes of shared errors."""
    rng = np.random.default_rng(11)
    parts = load_curves(curves, rng, level=0.05, loads=LOADS[:2])
    points = points_of(parts).points
    every = [Curve(part.response, 0, np.log(part.load / REFERENCE)) for part in parts]
    model = JointModel(points, every, parameters_of(1, 1.4, PRIORS), REFERENCE)
    posterior = posterior_of(model, PRIORS, model.parameters.mean)
    shared = shared_by_points(points, points, PRIORS.correlation_length)
    where, alone = model.parameters, np.diag(points.error**2)

    def log_density(state):
        tau, kappa = np.exp(state[4:])
        residual = points.log_friction - model.predicted(state[:4])[0]
        whole = alone + tau**2 * shared.level + kappa**2 * shared.near
        lower = np.linalg.cholesky(whole)
        white = np.linalg.solve(lower, residual)
        off = (state[:4] - where.mean) / where.spread
        spread = np.array([tau / PRIORS.level, kappa / PRIORS.correlated])
        square = white @ white + off @ off + spread @ spread
        return -0.5 * square - np.log(np.diag(lower)).sum() + 2 * state[4:].sum()

    scale = 0.8 * np.eye(6)
    scale[:4, :4] = 0.9 * np.linalg.cholesky(posterior.spread)
    state = np.concatenate([posterior.centre, np.log([0.05, 0.01])])
    now, states = log_density(state), []
    for step, level in zip(rng.standard_normal((9000, 6)), np.log(rng.random(9000)), strict=True):
        trial = state + scale @ step
        if (then := log_density(trial)) - now > level:
            state, now = trial, then
        states.append(state)
    chain = np.array(states[1000:])[:, :4]
    deviation = chain.std(axis=0)
    assert np.all(np.abs(chain.mean(axis=0) - posterior.centre) < 0.25 * deviation)
    np.testing.assert_allclose(np.sqrt(np.diag(posterior.spread)), deviation, rtol=0.2)
    for probability in (0.025, 0.975):
        ends = np.quantile(chain, probability, axis=0)
        assert np.all(np.abs(ends - posterior.quantile(probability)) < 0.5 * deviation)


@pytest.fixture(scope="module")
def fit(curves):
    return fit_loads(load_curves(curves), 1.4)


def test_the_truth_comes_back(fit):
    for name, true in (("shear_stress", STRESS), ("speed_exponent", N), ("load_exponent", M)):
        assert fit.marginal(name).low < true < fit.marginal(name).high
        assert fit.marginal(name).identified == "yes"
    assert fit.marginal("viscosity").value == pytest.approx(ETA, rel=0.02)
    assert fit.reference_load == pytest.approx(REFERENCE)
    assert fit.described and fit.words == []


def test_the_band_holds_the_curve_and_shared_residuals_are_part_of_all(fit, curves):
    for load in LOADS:
        drawn = fit.curves.sel(curve=f"{load:g} N/m")
        true = friction(curves, load, drawn.sliding_speed.values)
        inside = (drawn.friction_coefficient_low <= true) & (
            true <= drawn.friction_coefficient_high
        )
        assert inside.mean() > 0.8
    points = fit.points
    assert points.sizes["point"] == 39
    np.testing.assert_allclose(
        points.relative_residual,
        np.log(points.friction_coefficient / points.friction_coefficient_model),
    )
    assert float(abs(points.shared_residual).max()) < float(abs(points.relative_residual).max())


def test_of_one_load_the_exponent_of_load_is_what_was_assumed(curves, fit):
    single = fit_loads(load_curves(curves, loads=LOADS[:1]), 1.4)
    untold = single.marginal("load_exponent")
    assert (untold.low, untold.high) == pytest.approx((untold.prior_low, untold.prior_high))
    assert untold.identified == "not identified"
    assert any("exponent of load: not identified" in said for said in single.words)
    assert single.left_out == {}
    widths = [f.marginal("speed_exponent").high - f.marginal("speed_exponent").low
              for f in (single, fit)]  # fmt: skip
    assert widths[0] > 1.3 * widths[1]


def test_low_speeds_alone_tell_nothing_of_the_viscosity(curves):
    slow = SPEEDS[SPEEDS < 3e-6]
    untold = fit_loads(load_curves(curves, speed=slow), 1.4)
    viscosity = untold.marginal("viscosity")
    assert viscosity.identified == "not identified"
    assert viscosity.value == pytest.approx(1.4, rel=0.15)
    assert viscosity.high / viscosity.low > 0.8 * viscosity.prior_high / viscosity.prior_low
    assert "viscosity: not identified" in untold._repr_html_()


def test_a_level_for_each_run_is_told_from_points(curves):
    mu = friction(curves, 910.0)
    runs = mu * np.array([0.85, 1.0, 1.15])[:, None]
    part = LoadCurve("a", "", 910.0, measured(runs), response_of(curves.sel(load=910.0)))
    apart = fit_loads([part], 1.4)
    assert apart.marginal("level").low > 0.05
    assert sorted(set(apart.points.run_number.values.tolist())) == [0, 1, 2]
    shared = apart.points.shared_residual.groupby(apart.points.run_number).mean().values
    np.testing.assert_allclose(np.diff(shared), np.diff(np.log([0.85, 1.0, 1.15])), rtol=0.1)


def test_a_viscosity_far_from_what_was_stated_is_told(curves):
    parts = load_curves(curves, eta=4.2)
    assert any("check what was stated" in said for said in fit_loads(parts, 1.4).words)


def test_what_the_model_does_not_describe_is_said(curves):
    odd = [
        part._replace(measured=part.measured * (1 + 0.8 * np.sin(np.log(SPEEDS))[None, :].ravel()))
        for part in load_curves(curves)
    ]
    odd = [
        part._replace(measured=measured(part.measured.friction_coefficient.values)) for part in odd
    ]
    bent = fit_loads(odd, 1.4)
    assert not bent.described
    assert any("does not describe" in said for said in bent.words)


def test_a_search_that_creeps_far_from_the_answer_does_not_end_the_fit(curves, monkeypatch):
    far = np.exp(-2.5 * np.tanh(2 * np.log(SPEEDS / 1e-4)))
    bent = [
        part._replace(measured=measured(part.measured.friction_coefficient.values * far))
        for part in load_curves(curves)
    ]
    whole = fit_loads(bent, 1.4).marginal("shear_stress").value
    monkeypatch.setattr("tribolab.fit.joint.modes._MAX_STEPS", 8)
    assert fit_loads(bent, 1.4).marginal("shear_stress").value == pytest.approx(whole, rel=1e-3)
    monkeypatch.setattr("tribolab.fit.joint.modes._MAX_STEPS", 3)
    with pytest.raises(AnalysisError, match="not found"):
        fit_loads(bent, 1.4)


def test_dry_friction_tells_of_the_exponent_where_the_wet_curve_has_none(curves):
    fast = SPEEDS[SPEEDS > 3e-4]
    wet = load_curves(curves, speed=fast)
    area, ratio = response_of(curves.sel(load=310.0)).rest, 1.6
    mu = 1.25 * STRESS * (SPEEDS / 1e-5) ** N * (310.0 / REFERENCE) ** M * area * ratio
    dry = LoadCurve("dry", "", 310.0, measured(mu), constant_response(area * ratio), dry=True)
    without, both = fit_loads(wet, 1.4), fit_loads([*wet, dry], 1.4, area_ratio_error=0.1)
    stress = both.marginal("dry_over_wet")
    assert stress.low < 1.25 < stress.high
    assert stress.prior_high == pytest.approx(np.exp(1.959964 * np.hypot(0.3, 0.1)))
    width = [f.marginal("speed_exponent").high - f.marginal("speed_exponent").low
             for f in (without, both)]  # fmt: skip
    assert width[1] < 0.7 * width[0]


def band_that_is_a_shear_stress(curves, fit, name, count=9):
    """A variation of 3 % of the shear stress to both sides, and one that nothing asks for."""
    theta = {"eta": fit.marginal("viscosity").value, "n": fit.marginals[1].value,
             "m": fit.marginals[2].value, "stress": fit.marginals[0].value}  # fmt: skip
    speed = np.geomspace(1e-6, 1e-2, count)
    middle = friction(curves, 310.0, speed, **theta)
    ends = [friction(curves, 310.0, speed, **theta | {"stress": f * theta["stress"]})
            for f in (0.97, 1.03)]  # fmt: skip
    return xr.Dataset(
        {
            "friction_coefficient": ("sliding_speed", middle),
            "friction_coefficient_varied": (
                ("variation", "range_end", "sliding_speed"),
                np.array([ends, np.multiply(ends, 5)]),
            ),
        },
        {"sliding_speed": speed, "variation": [name, "rough body"]},
        {"load_N_m": 310.0},
    )


@pytest.mark.parametrize("name", ["Hurst exponent", "load"])
def test_a_band_of_the_model_that_is_a_shear_stress_widens_the_shear_stress_alone(curves, name):
    parts = load_curves(curves)
    usual = fit_loads(parts, 1.4)
    band = band_that_is_a_shear_stress(curves, usual, name)
    wider = fit_loads(parts, 1.4, spectrum_error={"": band})

    def deviation(fit, name):
        marginal = fit.marginal(name)
        ends = np.array([marginal.low, marginal.high])
        ends = np.log(ends) if name in ("shear_stress", "viscosity") else ends
        return np.diff(ends)[0] / (2 * 1.959964)

    before, after = (deviation(f, "shear_stress") for f in (usual, wider))
    assert np.sqrt(after**2 - before**2) == pytest.approx(0.03 / 1.959964, rel=0.05)
    for name in ("speed_exponent", "load_exponent", "viscosity"):
        assert deviation(wider, name) == pytest.approx(deviation(usual, name), rel=0.03)
    common = fit_loads(parts, 1.4, common_error=0.03 / 1.959964)
    assert deviation(common, "shear_stress") == pytest.approx(after, rel=0.02)


def test_a_band_of_two_speeds_between_those_of_slow_sliding_tells_as_much_as_a_dense_one(curves):
    parts = load_curves(curves, speed=SPEEDS[SPEEDS < 8e-6])
    usual = fit_loads(parts, 1.4)
    widths = []
    for count in (9, 81):
        band = band_that_is_a_shear_stress(curves, usual, "load", count)
        marginal = fit_loads(parts, 1.4, spectrum_error={"": band}).marginal("shear_stress")
        widths.append(np.log(marginal.high / marginal.low))
    alone = usual.marginal("shear_stress")
    assert widths[0] == pytest.approx(widths[1], rel=0.02)
    assert widths[0] == pytest.approx(np.hypot(np.log(alone.high / alone.low), 0.06), rel=0.01)
    assert widths[0] > 1.01 * np.log(alone.high / alone.low)


def test_a_gain_that_all_loads_share_moves_all_friction_and_is_in_the_intervals(curves):
    parts, stated = load_curves(curves), []
    for part in parts:
        mu = part.measured.friction_coefficient.values
        rows = np.array([0.02 * mu, 0.5 * mu])
        stated.append(part._replace(measured=part.measured.assign_coords(
            part=["friction_gain", "between runs"]
        ).assign(uncertainty_part=(("part", "sliding_speed"), rows))))  # fmt: skip
    usual, wider = fit_loads(parts, 1.4), fit_loads(stated, 1.4)
    # what scatters from point to point is in the points' own errors already
    gained = [
        part._replace(measured=part.measured.assign(
            friction_coefficient=1.02 * part.measured.friction_coefficient,
            friction_coefficient_sem=1.02 * part.measured.friction_coefficient_sem,
        ))
        for part in parts
    ]  # fmt: skip
    moved = fit_loads(gained, 1.4)
    a, b, c = (fit.marginal("shear_stress") for fit in (usual, wider, moved))
    widths = [np.log(m.high / m.low) / (2 * 1.959964) for m in (a, b)]
    shift = np.log(c.value / a.value)
    assert 0.001 < shift < 0.02  # most of it is taken for an error of the levels
    assert np.sqrt(widths[1] ** 2 - widths[0] ** 2) == pytest.approx(shift, rel=0.3)


def test_a_speed_that_all_loads_share_moves_the_viscosity_the_other_way(curves):
    """A clock that runs 3 % fast: eta v is known, and eta only as well as v."""
    parts = load_curves(curves)
    faster = [
        part._replace(measured=part.measured.assign_coords(
            sliding_speed=1.03 * part.measured.sliding_speed
        ))
        for part in parts
    ]  # fmt: skip
    usual, wider, moved = (
        fit_loads(parts, 1.4),
        fit_loads(parts, 1.4, speed_error=np.log(1.03)),
        fit_loads(faster, 1.4),
    )
    a, b, c = (fit.marginal("viscosity") for fit in (usual, wider, moved))
    widths = [np.log(m.high / m.low) / (2 * 1.959964) for m in (a, b)]
    shift = np.log(c.value / a.value)
    assert -0.03 < shift < -0.02
    assert np.sqrt(widths[1] ** 2 - widths[0] ** 2) == pytest.approx(-shift, rel=0.1)


def test_spectra_err_by_surface_and_the_load_on_all_surfaces_together(curves):
    parts = [part._replace(surface=s) for s in ("fine", "rough") for part in load_curves(curves)]
    one = fit_loads(load_curves(curves), 1.4)
    correlated = {}
    for name in ("Hurst exponent", "load"):
        band = band_that_is_a_shear_stress(curves, one, name)
        both = fit_loads(parts, 1.4, spectrum_error={"fine": band, "rough": band})
        correlated[name] = both.correlation[0, 1]
    alone = fit_loads(parts, 1.4).correlation[0, 1]
    assert correlated["Hurst exponent"] < alone + 0.01
    assert correlated["load"] > correlated["Hurst exponent"] + 0.02


def test_two_surfaces_share_their_liquid(curves):
    rough = load_curves(curves, np.random.default_rng(1), loads=LOADS[:2], stress=2 * STRESS)
    parts = [part._replace(surface="fine") for part in load_curves(curves, loads=LOADS[:1])]
    parts += [part._replace(surface="rough", name=f"rough {part.name}") for part in rough]
    both = fit_loads(parts, 1.4)
    for surface, true in (("fine", 1.0), ("rough", 2.0)):
        marginal = both.marginal("shear_stress", surface)
        here = true * STRESS * (both.reference_load / REFERENCE) ** M
        assert marginal.low < here < marginal.high
    assert both.table().loc["viscosity"].ndim == 1
    assert both.correlations().shape == (7, 7)
    assert both.marginal("load_exponent", "fine").identified == "not identified"


def test_models_are_told_apart_where_the_data_tell(curves):
    fixed = replace(PRIORS, speed_exponent=0.0, load_exponent=0.0)
    for n, m, wanted in (
        (N, M, "the data contradict constant"),
        (0.0, 0.0, "constant is enough"),
    ):
        parts = load_curves(curves, n=n, m=m, loads=LOADS)
        told = compared(
            {"power law": fit_loads(parts, 1.4), "constant": fit_loads(parts, 1.4, fixed)}
        )
        assert told.models[1].words == wanted
        held = told.fits["constant"].marginal("speed_exponent")
        assert (held.value, held.identified) == (0.0, "held fixed")
    again = compared({"a": told.fits["constant"], "b": told.fits["constant"]})
    assert again.models[1].words == "the data do not tell b from a"


def test_the_evidence_of_left_out_loads_is_that_of_their_points_given_the_rest(curves):
    """Chain rule: ln p(all) = ln p(one load) + ln p(the other | it)."""
    parts = load_curves(curves, loads=LOADS[:2])
    both, first = fit_loads(parts, 1.4), fit_loads(parts[:1], 1.4)
    # F0 of one load alone is another, so the prior of m is moved; held at 0 it is the same
    fixed = replace(PRIORS, load_exponent=0.0)
    both, first = (fit_loads(given, 1.4, fixed) for given in (parts, parts[:1]))
    assert both.left_out[parts[1].name] == pytest.approx(
        both.log_evidence - first.log_evidence, abs=1e-4
    )


def test_datasets_over_load_and_surface_are_taken_apart(curves):
    loads = xr.DataArray(LOADS, {"normal_force": LOADS / 10})
    rows = [measured(friction(curves, load)) for load in LOADS]
    table = xr.concat(rows, loads.normal_force)
    given = (table, CONTACT, PSD, "1.4 Pa s")
    whole = tl.fit.fit_shear_stress_jointly(*given, loads, curves=curves)
    assert whole.curves.curve.values.tolist() == ["31 N", "91 N", "211 N"]
    assert whole.marginal("viscosity").value == pytest.approx(ETA, rel=0.01)
    again = tl.fit.fit_shear_stress_jointly(
        table.expand_dims(surface=["fine"]), *given[1:], loads, curves=curves
    )
    assert again.marginal("shear_stress").value == whole.marginal("shear_stress").value
    adhesive = tl.fit.fit_shear_stress_jointly(
        *given, loads, curves=curves, area_enhancement=1.25 + 0 * loads
    )
    assert adhesive.marginal("shear_stress").value == pytest.approx(
        whole.marginal("shear_stress").value / 1.25, rel=0.01
    )
    with pytest.raises(AnalysisError, match="choose one value"):
        tl.fit.fit_shear_stress_jointly(table.expand_dims(medium=["oil"]), *given[1:], loads)
    with pytest.raises(AnalysisError, match="a load in N/m is wanted for each"):
        tl.fit.fit_shear_stress_jointly(*given, "310 N/m")


def test_points_that_cannot_be_taken_are_counted_and_unknown_errors_refused(curves):
    mu = friction(curves, 310.0)
    mu[3] = -0.01
    part = LoadCurve("a", "", 310.0, measured(mu), response_of(curves.sel(load=310.0)))
    fit = fit_loads([part], 1.4)
    assert fit.skipped == 1 and any("1 point with" in said for said in fit.words)
    bare = part._replace(measured=part.measured[["friction_coefficient"]])
    with pytest.raises(AnalysisError, match="no point has an error"):
        fit_loads([bare], 1.4)
    with pytest.raises(AnalysisError, match="speed_exponent must be finite"):
        JointPriors(speed_exponent=-1.0)


def test_an_error_that_is_small_by_chance_is_drawn_to_the_others(curves):
    data = measured(friction(curves, 310.0), 0.02)
    data["friction_coefficient_sem"][4] *= 1e-3
    data["runs"] = "sliding_speed", np.full(13, 2)
    data["run_level"] = "run", [0.99, 1.01]  # what is over runs makes no runs of the points
    points = points_of([LoadCurve("a", "", 310.0, data, constant_response(1.0))]).points
    assert points.error.size == 13
    error = points.error
    assert 0.7 < error[4] / error[5] < 1.0
