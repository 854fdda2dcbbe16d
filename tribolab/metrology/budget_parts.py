"""Combination of uncertainties: root sum of squares, Welch-Satterthwaite formula, U95."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special

from tribolab.reading.dialect.uncertainty import Known
from tribolab.units.stamping import stamp

NOISE, BETWEEN = "noise and known zero of the run", "between runs"
_NOT_STATED = "calibration not stated: statistical only"
_RECTANGULAR = ("half-width", "step")
# The scatter of few repeats can be small by chance. Below _SMALL_DOF degrees of freedom its share x
# in the Welch-Satterthwaite sum is increased to 1 - (1 - x)^(1 + _CHANCE/nu^2): the coverage of U95
# for two runs plus a calibration is then 93.4 to 96.4 % for any ratio of both (87 to 95 % without),
# for three runs 95 to 95.8 %. For two runs, no such rule is accurate to 1 %.
_SMALL_DOF, _CHANCE = 4.0, 10.0
_DOMINANT = 0.7  # share of the variance above which one rectangular part sets the shape


class ScatterPart(NamedTuple):
    """Scatter of the data as a contribution to the uncertainty, one entry for each value.

    Parameters
    ----------
    u, dof
        Standard uncertainty without Student's factor, and its degrees of freedom.
    name
        Origin of the scatter: `NOISE` or `BETWEEN`.
    """

    u: np.ndarray
    dof: np.ndarray
    name: str | np.ndarray


def effective_dof(parts: np.ndarray, dof: np.ndarray, observed: int = 0) -> np.ndarray:
    """Return the effective degrees of freedom of a combined uncertainty (Welch-Satterthwaite).

    Parameters
    ----------
    parts
        Contributions, in one unit (part, ...).
    dof
        Their degrees of freedom (part, ...).
    observed
        Number of the first parts that are observed scatter. With less than four degrees of
        freedom their weight is increased, because they may be small by chance.

    Notes
    -----
    ``1/sum(x_i/nu_i)`` with ``x_i = (u_i/u)^4`` and u^2 the sum of the u_i^2 (JCGM 100:2008, Eq.
    (G.2b)). For observed scatter of few degrees of freedom x_i is replaced by ``1 - (1 - x_i)^(1 +
    10/nu_i^2)``, chosen for equal coverage at every ratio of scatter to other parts.

    Examples
    --------
    >>> effective_dof(np.array([3.0, 4.0]), np.array([4.0, np.inf])).round(1).item()
    30.9
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = np.sum(parts**2, axis=0)
        share = np.minimum(parts**4 / variance**2, 1.0)
        few = np.broadcast_to(dof, parts.shape) < _SMALL_DOF
        few[observed:] = False
        grown = 1 - (1 - share) ** (1 + _CHANCE / np.maximum(dof, 1.0) ** 2)
        nu = 1 / np.sum(np.where(few, grown, share) / dof, axis=0)
    return np.where(variance > 0, nu, np.inf)[()]


def coverage_factor(dof: np.ndarray | float) -> np.ndarray:
    """Return the coverage factor for 95 %: Student's t for given degrees of freedom.

    Examples
    --------
    >>> coverage_factor(np.array([4.0, np.inf])).round(3)
    array([2.776, 1.96 ])
    """
    few = np.minimum(np.asarray(dof, float), 1e9)
    return np.where(np.isfinite(few), special.stdtrit(np.maximum(few, 1.0), 0.975), np.nan)


def combine_parts(
    data: xr.Dataset,
    dim: str,
    scatter: list[ScatterPart],
    parts: Mapping[str, np.ndarray],
    known: Mapping[str, Known],
    unstated: Sequence[str] = (),
) -> xr.Dataset:
    """Return values with their combined uncertainty, degrees of freedom, U95 and contributions.

    Parameters
    ----------
    data
        Dataset of the values.
    dim
        Dim along which there are values.
    scatter
        Scatter of the data.
    parts
        Signed contribution of each input [1] (dim); NaN where it could not be computed.
    known
        Stated uncertainties of the inputs.
    unstated
        Instruments without stated uncertainties, if others have them.

    Returns
    -------
    xarray.Dataset
        `data` with ``friction_coefficient_u``, ``_dof``, ``_U95`` (dim) and ``uncertainty_part``,
        ``uncertainty_part_dof`` (part, dim). Attributes: ``uncertainty_says``: what
        the uncertainty omits or overstates, in words.
    """
    size = data.sizes[dim]
    names = [str(s.name) for s in scatter] + list(parts)
    shape = len(names), size
    values = np.array([s.u for s in scatter] + list(parts.values()), float).reshape(shape)
    freedom = [np.broadcast_to(s.dof, size) for s in scatter]
    stated = [known[name].dof if name in known else np.inf for name in parts]
    freedom += [np.full(size, dof) for dof in stated]
    dof = np.array(freedom, float).reshape(shape)
    # inputs that cannot be evaluated are omitted; if the scatter is unknown, so is the total
    inputs = zip(parts, values[len(scatter) :], strict=True)
    missing = [name for name, row in inputs if size and np.isnan(row).all()]
    counted = np.where([[n in missing] for n in names], 0.0, values)
    u = np.sqrt(np.sum(counted**2, axis=0))
    nu = effective_dof(counted, dof, len(scatter))
    result = data.drop_vars(["uncertainty_part", "uncertainty_part_dof"], errors="ignore")
    result = result.assign(
        friction_coefficient_u=(dim, u),
        friction_coefficient_dof=(dim, np.where(np.isfinite(u), nu, np.nan)),
        friction_coefficient_U95=(dim, coverage_factor(nu) * u),
        uncertainty_part=(("part", dim), counted),
        uncertainty_part_dof=(("part", dim), dof),
        part=("part", np.array(names, dtype=str)),
    )
    return stamp(result, uncertainty_says=_limitations(known, names, counted, missing, unstated))


def _limitations(
    known: Mapping[str, Known],
    names: list[str],
    parts: np.ndarray,
    missing: list[str],
    unstated: Sequence[str],
) -> str:
    """Return a text on what an uncertainty omits or overstates."""
    texts = [] if any(name in known for name in names) else [_NOT_STATED]
    texts += [
        f"calibration of {name or 'an instrument without a name'} not stated" for name in unstated
    ]
    if missing:
        left = ", ".join(part_words(name) for name in missing)
        texts.append(f"not counted, because no normal force was recorded: {left}")
    with np.errstate(divide="ignore", invalid="ignore"):
        share = parts**2 / np.sum(parts**2, axis=0)
    for name, row in zip(names, share, strict=True):
        stated = known[name].distribution if name in known else ""
        if stated in _RECTANGULAR and row.size and np.nanmedian(row) > _DOMINANT:
            texts.append(f"too wide, because one rectangular part dominates: {part_words(name)}")
    return "; ".join(texts)


def part_name(part: str) -> str:
    """Return the name of a contribution without its instrument.

    Examples
    --------
    >>> part_name("friction_gain, linear_slider"), part_name("tilt")
    ('friction_gain', 'tilt')
    """
    return part.partition(", ")[0]


def part_words(name: str) -> str:
    """Return a contribution to the uncertainty in words.

    Examples
    --------
    >>> part_words("cross_talk_friction_from_normal"), part_words("noise and known zero of the run")
    ('cross-talk friction from normal', 'noise and known zero of the run')
    """
    of, comma, whose = name.partition(", ")
    return of.replace("cross_talk", "cross-talk").replace("_", " ") + comma + whose
