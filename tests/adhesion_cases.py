"""What the adhesion tests share: another way to the same fixed point, and a random walk."""

import numpy as np
import xarray as xr
from scipy.special import ndtr

from tribolab.contact.adhesion_balance import Interface
from tribolab.contact.first_passage import Diffusion


def survival(start, boundary, time) -> np.ndarray:
    """Probability that a diffusion has not yet reached a boundary (k, n) or (n) below it."""
    diffusion = Diffusion.over(time)
    origin = np.atleast_1d(np.asarray(start, dtype=float))
    height = np.atleast_2d(np.asarray(boundary, dtype=float))
    levels = ((height[:, 1:] + height[:, :-1]) / 2).T
    levels = np.ascontiguousarray(np.broadcast_to(levels, (levels.shape[0], origin.size)))
    losses = np.zeros_like(levels)
    for step in range(levels.shape[0]):
        losses[step] = diffusion.lost(step, levels[step], origin, levels, losses)
    result = np.ones((origin.size, diffusion.time.size))
    result[:, 1:] -= np.cumsum(losses, axis=0).T
    return result[0] if np.ndim(start) == 0 and np.ndim(boundary) == 1 else result


def flat_then_power(hurst=0.9, rolloff=1e5, slope=0.3, low=1e3, high=1e9) -> xr.Dataset:
    """Plateau and power law with a given rms slope."""
    q = np.array([low, rolloff, high])
    c = np.maximum(q / rolloff, 1.0) ** (-2 * (1 + hurst))
    fine = np.union1d(np.geomspace(low, high, 100_001), q)
    shape = np.exp(np.interp(np.log(fine), np.log(q), np.log(c)))
    total = 2 * np.pi * np.trapezoid(fine**4 * shape, np.log(fine))
    return xr.Dataset({"psd_2d": ("wavenumber", slope**2 / total * c)}, {"wavenumber": q})


def relaxed(surface: Interface, pressure, work: float, start: str, steps: int = 300):
    """Eq. (11) by turns with P(q), relaxed by one half, from dry contact or from full contact.

    The textbook way: gamma_eff from P on all nodes, P from gamma_eff by first passage, until both
    stay. Returns P(q) (k, n) and the last change of gamma_eff relative to gamma_0 (k).
    """
    pressure = np.atleast_1d(pressure)
    area = surface.without_adhesion(pressure)
    if start == "full":
        area = np.ones_like(area)

    def binding(area):
        stored = surface.reduced(area)
        parts = surface.elastic * (stored[:, 1:] + stored[:, :-1]) / 2
        energy = np.zeros_like(area)
        energy[:, :-1] = np.cumsum(parts[:, ::-1], axis=1)[:, ::-1]
        return np.maximum(work * surface.area_gain * area[:, -1:] - energy, 0.0) / area

    gamma = binding(area)
    for _ in range(steps):
        boundary = -surface.c_a * np.sqrt(gamma * surface.modulus * surface.wavenumber)
        area = survival(pressure, boundary, surface.diffusion.time)
        new = binding(area)
        change = np.abs(new - gamma).max(axis=1) / work
        gamma = (gamma + new) / 2
        if change.max() < 1e-10:
            break
    return area, change


def random_walk(start, boundary, time, walks, seed):
    """Survival at the last time by Monte Carlo, with its standard error.

    Between two nodes the boundary is a straight line and the path a Brownian bridge, which crosses
    with the probability exp(-2 d0 d1/dt): so no crossing between nodes is missed.
    """
    random = np.random.default_rng(seed)
    height = np.full(walks, float(start))
    alive = np.ones(walks)
    for i, dt in enumerate(np.diff(time)):
        above = height - boundary[i]
        height = height + np.sqrt(dt) * random.standard_normal(walks)
        now = np.maximum(height - boundary[i + 1], 0.0)
        alive *= -np.expm1(-2 * np.maximum(above, 0.0) * now / dt)
    return alive.mean(), alive.std() / np.sqrt(walks)


def above_receding_line(start, speed, time):
    """Bachelier and Levy: survival above the boundary -speed * t, in closed form."""
    time = np.asarray(time, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(time)
        kept = ndtr((start + speed * time) / root)
        lost = np.exp(-2 * speed * start) * ndtr((speed * time - start) / root)
    return np.where(time == 0, 1.0, kept - lost)
