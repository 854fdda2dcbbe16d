"""Variations of a spectrum, one at a time: its band, its ends and its extrapolated part."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError
from tribolab.fit import limits
from tribolab.fit.variation import Base, Changed, Skipped, Variation
from tribolab.surface.extrapolation import AS_MEASURED, TO_LARGE, TO_SMALL
from tribolab.surface.moments import band, spectrum_arrays

_ATOM_LENGTH = 0.3e-9  # size of an atom [m]
_CUTOFF_RATIO = 10.0  # factor by which the largest wavenumber is reduced
_PLATEAU_FACTOR = 2.0  # factor by which an extrapolated plateau is raised
_NO_TAIL = (
    "no part of the spectrum is marked as extrapolated to large wavenumbers (variable 'origin'); "
    "give measured_to"
)


def spectrum_band(base: Base) -> Variation | Skipped:
    """Shift the measured spectrum to both limits of its band, and the extrapolated part with it."""
    psd = base.spectrum
    if "psd_2d_low" not in psd or "psd_2d_high" not in psd:
        return Skipped("spectrum band", "the spectrum has no psd_2d_low and psd_2d_high")
    q, c = spectrum_arrays(psd)
    seen = np.flatnonzero((_origin(psd) == AS_MEASURED) & (c > 0))
    if seen.size == 0:
        return Skipped("spectrum band", "no part of the spectrum is marked as measured")
    ends: list[Changed] = []
    spread = []
    for name in ("psd_2d_low", "psd_2d_high"):
        ratio = psd[name].values[seen] / c[seen]
        if not np.all(np.isfinite(ratio) & (ratio > 0)):
            return Skipped("spectrum band", f"'{name}' is not above zero everywhere")
        spread.append(ratio)
        along = np.exp(np.interp(np.log(q), np.log(q[seen]), np.log(ratio)))
        ends.append({"psd": _spectrum(q, c * along)})
    if np.all(spread[0] == 1) and np.all(spread[1] == 1):
        return Skipped("spectrum band", "the band has no width")
    middle = [float(np.exp(np.mean(np.log(ratio)))) for ratio in spread]
    return Variation(
        "spectrum band",
        "its 95 % band, every wavenumber at the same end: scans of one surface err together",
        (f"C x {middle[0]:.2f} in the mean", f"C x {middle[1]:.2f} in the mean"),
        (ends[0], ends[1]),
    )


def long_waves(base: Base) -> Variation | Skipped:
    """Remove the extrapolation to small wavenumbers, or increase it."""
    psd, name = base.spectrum, "spectrum at long waves"
    q, c = spectrum_arrays(psd)
    guessed = _origin(psd) == TO_SMALL
    if not guessed.any() or guessed.all():
        return Skipped(name, "no part of the spectrum was extrapolated to small wavenumbers")
    first = q[~guessed][0]
    reason, more = "a plateau is assumed there; without it, and twice as high", _PLATEAU_FACTOR
    texts = ["no roughness below", f"{_PLATEAU_FACTOR:g} C"]
    if str(psd.attrs.get("rolloff", "")).startswith("not reached"):
        # the spectrum still rises at its lowest wavenumber: the power law may continue
        hurst = float(psd.attrs["hurst_exponent"])
        more = (q[guessed] / first) ** (-2 * (1 + hurst))
        reason = "a plateau is assumed there; without it, and with the power law in its place"
        texts[1] = "power law"
    raised = c.copy()
    raised[guessed] *= more
    return Variation(
        name,
        reason,
        (f"{texts[0]} {first:.3g} 1/m", f"{texts[1]} below {first:.3g} 1/m"),
        ({"psd": band(psd[["psd_2d"]], first, q[-1])}, {"psd": _spectrum(q, raised)}),
    )


def hurst_exponent(base: Base) -> Variation | Skipped:
    """Tilt the extrapolation to large wavenumbers about the largest measured wavenumber."""
    psd = base.spectrum
    q, c = spectrum_arrays(psd)
    last = _measured_to(base)
    if last is None:
        return Skipped("Hurst exponent", _NO_TAIL)
    fitted = float(psd.attrs.get("hurst_exponent_standard_error", 0.0))
    error = max(limits.MIN_ERROR_OF_HURST.value, NORMAL * fitted)
    hurst = psd.attrs.get("hurst_exponent", _local_exponent(q, c))
    tilt = np.maximum(q / last, 1.0)
    low, high = (_spectrum(q, c * tilt ** (-2 * d)) for d in (-error, error))
    return Variation(
        "Hurst exponent",
        f"of the part above {last:.3g} 1/m; at least {limits.MIN_ERROR_OF_HURST.value:g}, as a "
        "spectrum need not be one power law over the decades that were not measured, or 1.96 "
        "standard errors of the fit",
        (f"H = {hurst - error:.3g}", f"H = {hurst + error:.3g}"),
        ({"psd": low}, {"psd": high}),
    )


def short_waves(base: Base) -> Variation | Skipped:
    """End the spectrum at longer waves, or extend it to the size of an atom."""
    psd, name = base.spectrum, "spectrum at short waves"
    q, c = spectrum_arrays(psd)
    last = _measured_to(base)
    if last is None:
        return Skipped(name, _NO_TAIL)
    cut = max(last, q[-1] / _CUTOFF_RATIO)
    atom = np.pi / _ATOM_LENGTH
    longer: Changed | None = None
    if q[-1] < atom and np.all(c[-2:] > 0):
        beyond = np.geomspace(q[-1], atom, 11)[1:]
        tail = c[-1] * (beyond / q[-1]) ** (-2 * (1 + _local_exponent(q, c)))
        longer = {"psd": _spectrum(np.append(q, beyond), np.append(c, tail))}
    shorter: Changed | None = {"psd": band(psd[["psd_2d"]], q[0], cut)} if cut < q[-1] else None
    return Variation(
        name,
        "where the shortest waves that matter are is a convention: ten times longer, and an atom",
        (f"q1 = {cut:.3g} 1/m" if shorter else "", f"q1 = {atom:.3g} 1/m" if longer else ""),
        (shorter, longer),
    )


def _origin(psd: xr.Dataset) -> np.ndarray:
    if "origin" in psd:
        return psd["origin"].values
    return np.full(psd.sizes["wavenumber"], AS_MEASURED)


def _measured_to(base: Base) -> float | None:
    """Return the largest measured wavenumber if the spectrum extends beyond it; else None."""
    q, _ = spectrum_arrays(base.spectrum)
    if base.measured_to is not None:
        if not q[0] < base.measured_to < q[-1]:
            raise AnalysisError(
                f"{base.measured_to:.4g} 1/m lies outside the spectrum, which reaches "
                f"from {q[0]:.4g} to {q[-1]:.4g} 1/m",
                function="measured_to",
            )
        return base.measured_to
    guessed = _origin(base.spectrum) == TO_LARGE
    return float(q[~guessed][-1]) if guessed.any() and not guessed.all() else None


def _local_exponent(q: np.ndarray, c: np.ndarray) -> float:
    """Return the Hurst exponent of the last power law of a spectrum; NaN if it has none."""
    rough = np.flatnonzero(c)[-2:]
    if rough.size < 2:
        return np.nan
    q, c = q[rough], c[rough]
    return float(-np.log(c[-1] / c[-2]) / np.log(q[-1] / q[-2]) / 2 - 1)


def _spectrum(q: np.ndarray, c: np.ndarray) -> xr.Dataset:
    return xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
