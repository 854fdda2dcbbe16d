"""Sliding mode of a contact: steady as the model assumes, or unstable due to adhesion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from tribolab.core.html_list import html_list
from tribolab.friction.oscillation.slip_curve import FIXED_FREQUENCY, one_curve
from tribolab.friction.oscillation.waveform import NOT_CLEAR
from tribolab.friction.oscillation.waveform import oscillating as oscillates
from tribolab.regime import evidence
from tribolab.regime.lubrication_regimes import end_of_boundary, measured_regimes, model_regimes
from tribolab.regime.misfit import misfit_numbers
from tribolab.regime.model import (
    LOCAL,
    NO_STICK_SLIP,
    SUSPECTED,
    UNEXPLAINED,
    UNKNOWN,
    Evidence,
    Mode,
)
from tribolab.regime.words import paragraph, suggestions, verdict_text
from tribolab.units.stamping import stamp


@dataclass(frozen=True)
class SlidingMode:
    """Sliding mode of a contact, as a verdict with its evidence.

    Parameters
    ----------
    verdict
        ``"no stick-slip"``, ``"local stick-slip"``, ``"adhesion-controlled macroscopic instability
        suspected"``, ``"stick-slip of unknown origin"`` or ``"not known"``.
    text
        The verdict as one sentence, with the speeds.
    evidence
        Pieces of evidence for or against an adhesion-controlled mode, or neutral.
    decide
        Measurements that would decide.
    paragraph
        Verdict, evidence and decisive measurements as text.
    curve
        Per sliding speed: ``regime`` and ``model_regime`` (text), ``waveform`` and
        ``regularity`` (text), ``drop``, ``dominant_wavelength`` and ``recurrence_distance`` [m],
        measured and computed ``friction_coefficient``.
    numbers
        ``boundary_end_m_s``, ``model_boundary_end_m_s``, ``uniform_friction``,
        ``forced_wetting_low_m_s``, ``forced_wetting_high_m_s``, ``model_misfit`` with
        ``_p_value`` and ``_resolved`` (`misfit_numbers`), ``speeds_in_band`` of
        ``speeds_with_band``; NaN if unknown.
    """

    verdict: str
    text: str
    evidence: tuple[Evidence, ...]
    decide: tuple[str, ...]
    paragraph: str
    curve: xr.Dataset
    numbers: dict[str, float]

    @property
    def entries(self) -> list[tuple[str, str]]:
        """Pieces of evidence with the mode that each supports, and the measurements that decide."""
        pieces = [(piece.side, piece.text) for piece in self.evidence]
        return [*pieces, *(("would decide", text) for text in self.decide)]

    def _repr_html_(self) -> str:
        """Return HTML of the verdict and its evidence."""
        return html_list(self.text, self.entries)


def sliding_mode(
    measured: xr.Dataset,
    model: xr.Dataset | None = None,
    slip: xr.Dataset | None = None,
    known: Mode | None = None,
    *,
    band: xr.Dataset | None = None,
    name: str = "the contact",
) -> SlidingMode:
    """Return the sliding mode: the verdict on control by adhesion, with the evidence on both sides.

    Parameters
    ----------
    measured
        Measured curve, from `measured_stribeck_curve`.
    model
        Model curve of `stribeck_curve` over ``sliding_speed``, with the fitted shear stress; None
        without a model (dry contacts have none).
    slip
        Stick-slip at each speed, from `stick_slip_curve`; None if it was not looked for.
    known
        Further properties of the contact; see `Mode`.
    band
        Uncertainty band of the model, from `model_uncertainty`.
    name
        Name of the contact in the text.

    Returns
    -------
    SlidingMode
        The mode is at most "suspected", because the interface is not observed.

    Notes
    -----
    After [1]_, Secs. 5 to 8. A macroscopic instability is suspected if traces show stick-slip and
    adhesion reaches the macroscopic scale, gamma_eff(1) > 0; with gamma_eff(1) = 0 it is
    impossible, and stick-slip is local. A plateau at speeds far above the model's boundary regime,
    and friction far below mu = sigma_f (A/A0)/p of a uniform slip at the shear stress of rough
    surfaces, are further evidence, but not sufficient: both may be due to an inadequate model.

    References
    ----------
    .. [1] Xu et al. (2026), Adhesion-controlled sliding and the Stribeck curve in hydrophobic soft
       contacts.

    Examples
    --------
    >>> v = np.geomspace(1e-6, 1e-3, 4)
    >>> curve = xr.Dataset(
    ...     {"friction_coefficient": ("sliding_speed", [1.0, 1.0, 1.0, 1.0])}, {"sliding_speed": v}
    ... )
    >>> slip = xr.Dataset(
    ...     {
    ...         "waveform": ("sliding_speed", ["smooth sliding"] * 4),
    ...         "drop": ("sliding_speed", [np.nan] * 4),
    ...     },
    ...     {"sliding_speed": v},
    ... )
    >>> sliding_mode(curve, None, slip, Mode(work_of_adhesion=0.0, fluid=False)).verdict
    'no stick-slip'
    """
    known = known or Mode()
    slip = slip if slip is None else one_curve(slip)
    curve = _curve(measured, model, slip, known.fluid)
    numbers = _numbers(measured, model, curve, known) | _count_in_band(measured, band)
    weighed = tuple(
        each
        for each in (
            evidence.traces(slip),
            evidence.macroscopic_adhesion(known),
            evidence.vanishing_adhesion(known),
            evidence.strength(slip),
            evidence.scaling(slip),
            evidence.repeating(slip),
            evidence.weakening(curve, slip),
            evidence.plateau(numbers, model),
            evidence.misfit(numbers),
            evidence.uniform_slip(numbers, known),
        )
        if each is not None
    )
    verdict = _verdict(slip, known)
    numbers |= evidence.forced_wetting(curve, slip, known) if verdict == SUSPECTED else {}
    text = verdict_text(verdict, numbers, slip, model is not None)
    decide = suggestions(verdict, numbers, known, slip)
    return SlidingMode(
        verdict,
        text,
        weighed,
        decide,
        paragraph(name, text, weighed, decide, numbers),
        curve,
        numbers,
    )


def oscillating_speeds(slip: xr.Dataset | None) -> np.ndarray:
    """Return the speeds [m/s] at which stick-slip is significant."""
    if slip is None or "waveform" not in slip:
        return np.zeros(0)
    return slip["sliding_speed"].values[oscillates(slip["waveform"].values)]


def _verdict(slip: xr.Dataset | None, known: Mode) -> str:
    if slip is None or slip.sizes.get("sliding_speed", 0) == 0:
        return UNKNOWN
    if not oscillating_speeds(slip).size:
        undecided = slip["waveform"].values == NOT_CLEAR
        return UNKNOWN if undecided.mean() > 0.5 else NO_STICK_SLIP
    if known.work_of_adhesion is None or slip.attrs.get("scaling") == FIXED_FREQUENCY:
        return UNEXPLAINED
    return SUSPECTED if known.work_of_adhesion > 0 else LOCAL


def _curve(
    measured: xr.Dataset, model: xr.Dataset | None, slip: xr.Dataset | None, fluid: bool
) -> xr.Dataset:
    speed = measured["sliding_speed"].values
    data = {"friction_coefficient": ("sliding_speed", measured["friction_coefficient"].values)}
    if fluid:
        data["regime"] = "sliding_speed", measured_regimes(measured)
    if model is not None and speed.size:
        log_speed = np.log(model["sliding_speed"].values)
        mu = model["friction_coefficient"].values
        mu = np.interp(np.log(speed), log_speed, mu, np.nan, np.nan)
        data["friction_coefficient_model"] = "sliding_speed", mu
        if "solid_load_share" in model:
            near = np.abs(log_speed[None, :] - np.log(speed)[:, None]).argmin(axis=1)
            data["model_regime"] = "sliding_speed", model_regimes(model)[near]
    if slip is not None and slip.sizes.get("sliding_speed", 0):
        log_speed = np.log(slip["sliding_speed"].values)
        near = np.abs(log_speed[None, :] - np.log(speed)[:, None])
        at, apart = near.argmin(axis=1), near.min(axis=1)
        waveform = slip["waveform"].values[at].astype(object)
        waveform[apart > 0.1] = ""
        data["waveform"] = "sliding_speed", waveform
        if "regularity" in slip:
            regular = slip["regularity"].values[at].astype(object)
            regular[apart > 0.1] = ""
            data["regularity"] = "sliding_speed", regular
        for name in ("drop", "dominant_wavelength", "recurrence_distance", "dominant_frequency"):
            if name in slip:
                values = np.where(apart > 0.1, np.nan, slip[name].values[at])
                data[name] = "sliding_speed", values
    return stamp(xr.Dataset(data, {"sliding_speed": speed}))


def _count_in_band(measured: xr.Dataset, band: xr.Dataset | None) -> dict[str, float]:
    """Return at how many speeds friction is in the model's 95 % band, and how many have a band."""
    if band is None:
        return {"speeds_in_band": float("nan"), "speeds_with_band": float("nan")}
    log_speed = np.log(band["sliding_speed"].values)
    at = np.log(measured["sliding_speed"].values)
    low, high = (
        np.interp(at, log_speed, band[f"friction_coefficient_{end}"].values, np.nan, np.nan)
        for end in ("low", "high")
    )
    mu = measured["friction_coefficient"].values
    error = np.zeros(mu.size)
    if "friction_coefficient_U95" in measured:
        error = np.nan_to_num(measured["friction_coefficient_U95"].values)
    elif "friction_coefficient_sem" in measured:
        error = 2 * np.nan_to_num(measured["friction_coefficient_sem"].values)
    inside = (mu + error >= low) & (mu - error <= high)
    return {
        "speeds_in_band": float(inside.sum()),
        "speeds_with_band": float(np.isfinite(low).sum()),
    }


def _numbers(
    measured: xr.Dataset, model: xr.Dataset | None, curve: xr.Dataset, known: Mode
) -> dict[str, float]:
    speed, mu = measured["sliding_speed"].values, measured["friction_coefficient"].values
    nan = float("nan")
    numbers = {
        "plateau_friction": float(np.median(mu[:3])) if mu.size else nan,
        "boundary_end_m_s": nan,
        "model_boundary_end_m_s": nan,
        "model_lowest_m_s": nan,
        "model_misfit": nan,
        "model_misfit_p_value": nan,
        "model_misfit_resolved": nan,
        "uniform_friction": nan,
        "uniform_stress_Pa": nan,
        "forced_wetting_low_m_s": nan,
        "forced_wetting_high_m_s": nan,
    }
    if "regime" in curve:
        numbers["boundary_end_m_s"] = end_of_boundary(speed, curve["regime"].values)
    if model is not None:
        model_speed = model["sliding_speed"].values
        numbers["model_lowest_m_s"] = float(model_speed.min())
        if "solid_load_share" in model:
            numbers["model_boundary_end_m_s"] = end_of_boundary(model_speed, model_regimes(model))
        off = curve["friction_coefficient_model"].values - mu
        numbers |= misfit_numbers(measured, model, off)
    stress, area, pressure = known.rough_shear_stress, known.area_ratio, known.pressure
    if stress is not None and area is not None and pressure is not None:
        numbers["uniform_stress_Pa"] = stress * area
        numbers["uniform_friction"] = stress * area / pressure
    return numbers
