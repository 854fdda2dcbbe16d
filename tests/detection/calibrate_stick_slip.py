"""Fit the coefficients of the waveform's class to traces of the virtual rig, and print them.

    python tests/detection/calibrate_stick_slip.py --traces 6000

Seeds begin at 1 000 000, where no test and no table draws any. The last fifth is not fitted; how
often its classes are right, and how often those called with 90 % are, is printed.
"""

from __future__ import annotations

import argparse

import numpy as np
from scipy import optimize
from slip_traces import in_red_noise, intermittent, plain, quiet, scattered

from tribolab.friction.oscillation.examine import examine_record
from tribolab.friction.oscillation.waveform import CLASSES, WAVEFORM_LIMITS, features
from tribolab.rig.traces import simulate_trace

_FORMS = {"none": 0, "sawtooth": 1, "rounded": 2, "irregular": 1}
_TURNED = {"asymmetry", "skewness"}  # have the other sign in a trace that is turned round
_SEED = 1_000_000
_PENALTY = 0.02


def draw(seed: int) -> tuple[int, list[float]] | None:
    """Class and features of one random trace."""
    rng = np.random.default_rng(seed)
    form, time, values = _of_rig(rng) if rng.uniform() < 0.6 else _tricky(rng)
    found = examine_record(time, values)
    if isinstance(found, str):
        return None
    return _FORMS[form], list(features(found.waveform, found.oscillation).values())


def _of_rig(rng: np.random.Generator) -> tuple[str, np.ndarray, np.ndarray]:
    form = str(rng.choice(list(_FORMS)))
    periods = float(np.exp(rng.uniform(np.log(5), np.log(120))))
    samples = int(np.exp(rng.uniform(np.log(12 * periods), np.log(max(400 * periods, 8000)))))
    strength = 10 ** rng.uniform(np.log10(2.0), 2)
    run = simulate_trace(
        form,
        noise=0.1 / strength,
        red=rng.uniform(0, 0.95),
        red_length=10 ** rng.uniform(-3, -1),
        periods=periods,
        samples=samples,
        scatter=rng.uniform(0.0, 0.22),
        jitter=rng.choice([0.0, 0.02]),
        seed=rng,
    )
    return form, run["time"].values, run["friction_coefficient"].values


def _tricky(rng: np.random.Generator) -> tuple[str, np.ndarray, np.ndarray]:
    form = str(rng.choice(["none", "sawtooth", "rounded"]))
    if form == "none":
        kinds = ("white", "red", "red, 5 s", "1/f", "1/f2", "drift")
        trace = quiet(rng, str(rng.choice(kinds)))
    else:
        make = rng.choice(["plain", "scattered", "intermittent", "red"])
        if make == "plain":
            trace = plain(rng, form)
        elif make == "scattered":
            trace = scattered(rng, rng.uniform(0.15, 0.6), form)
        elif make == "intermittent":
            trace = intermittent(rng, rng.uniform(0.25, 0.8), form)
        else:
            trace = in_red_noise(rng, form)
    return form, np.arange(trace.values.size) / trace.rate, trace.values


def turned(kind: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Classes and features of the same traces turned round: a saw becomes a reversed one."""
    sign = np.array([-1.0 if name in _TURNED else 1.0 for name in WAVEFORM_LIMITS])
    return np.array([0, 3, 2, 1])[kind], x * sign


def fit(kind: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Intercepts (class) and coefficients (feature, class) of least penalised loss."""
    count, size = len(CLASSES), x.shape[1]
    centre, scale = x.mean(axis=0), x.std(axis=0)
    z = np.column_stack([np.ones(len(x)), (x - centre) / scale])

    def loss(flat: np.ndarray) -> tuple[float, np.ndarray]:
        w = flat.reshape(size + 1, count)
        score = z @ w
        score -= score.max(axis=1, keepdims=True)
        p = np.exp(score)
        p /= p.sum(axis=1, keepdims=True)
        value = -np.log(p[np.arange(len(x)), kind] + 1e-12).mean() + _PENALTY * (w[1:] ** 2).mean()
        p[np.arange(len(x)), kind] -= 1
        slope = z.T @ p / len(x)
        slope[1:] += 2 * _PENALTY * w[1:] / w[1:].size
        return value, slope.ravel()

    best = optimize.minimize(loss, np.zeros((size + 1) * count), jac=True, method="L-BFGS-B").x
    w = best.reshape(size + 1, count)
    coefficients = w[1:] / scale[:, None]
    intercept = w[0] - centre @ coefficients
    return intercept - intercept.mean(), coefficients - coefficients.mean(axis=1, keepdims=True)


def main() -> None:
    """Draw, fit, judge, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--traces", type=int, default=6000)
    wanted = parser.parse_args().traces
    drawn = [one for one in (draw(_SEED + k) for k in range(wanted)) if one is not None]
    kind = np.array([one[0] for one in drawn])
    x = np.array([one[1] for one in drawn])
    part = len(kind) * 4 // 5
    both = [
        np.concatenate(pair)
        for pair in zip((kind[:part], x[:part]), turned(kind[:part], x[:part]), strict=True)
    ]
    intercept, coefficients = fit(*both)
    score = intercept + x[part:] @ coefficients
    p = np.exp(score - score.max(axis=1, keepdims=True))
    p /= p.sum(axis=1, keepdims=True)
    right = p.argmax(axis=1) == kind[part:]
    print(f"{len(kind)} traces, {right.size} not fitted: {right.mean():.1%} right")
    for low, high in ((0, 0.6), (0.6, 0.8), (0.8, 0.9), (0.9, 0.99), (0.99, 1.01)):
        chosen = (p.max(axis=1) >= low) & (p.max(axis=1) < high)
        if chosen.any():
            said = p.max(axis=1)[chosen].mean()
            print(f"  said {said:.1%}: right {right[chosen].mean():.1%} of {chosen.sum()}")
    for number, name in enumerate(CLASSES):
        of = kind[part:] == number
        print(f"  {name}: {right[of].mean():.1%} of {of.sum()}")
    print("INTERCEPT = np.array([" + ", ".join(f"{v:.2f}" for v in intercept) + "])")
    print("COEFFICIENTS = {")
    for name, row in zip(WAVEFORM_LIMITS, coefficients, strict=True):
        print(f'    "{name}": np.array([' + ", ".join(f"{v:.2f}" for v in row) + "]),")
    print("}")


if __name__ == "__main__":
    main()
