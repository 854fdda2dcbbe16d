"""Evidence for and against an adhesion-controlled sliding mode, in sentences with numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tribolab.core.wording import Count, speed_text
from tribolab.friction.oscillation.slip_curve import FIXED_FREQUENCY, STEADY_SLIDING
from tribolab.friction.oscillation.waveform import NOT_CLEAR, oscillating
from tribolab.regime.misfit import is_sufficient
from tribolab.regime.model import AGAINST, FOR, UNTOUCHED, Evidence
from tribolab.regime.words import REVERSED, SAW, SINE, friction_text, percent_text, rig_wave_text

if TYPE_CHECKING:
    from tribolab.regime.model import Mode

_MAX_SPEED_RATIO = 10.0  # above this, the plateau and the boundary regime end at different speeds
_MIN_SLIP_RATIO = 2.0  # least ratio of uniform-slip friction to measured friction
_MIN_DROP_RATIO = 1.5  # least ratio of the drops at different speeds
_MIN_FALL = 0.10  # relative decrease of friction between two speeds, below which it is ignored
_PLATEAU_END = 0.8  # share of the plateau's friction below which the plateau has ended


def _moving(slip: xr.Dataset) -> xr.Dataset:
    return slip.isel(sliding_speed=np.flatnonzero(oscillating(slip["waveform"].values)))


def traces(slip: xr.Dataset | None) -> Evidence | None:
    """Return evidence from the waveform of the friction traces."""
    if slip is None or not slip.sizes.get("sliding_speed", 0):
        return Evidence(UNTOUCHED, "stick-slip was not looked for in the traces", "traces")
    moving = _moving(slip)
    count = moving.sizes["sliding_speed"]
    open_ = int((slip["waveform"].values == NOT_CLEAR).sum())
    if count == 0 and open_:
        text = f"at {open_} of {Count(slip.sizes['sliding_speed']):speed|speeds} it is not decided "
        text += "whether friction oscillates, at the others it does not"
        return Evidence(UNTOUCHED, text, "traces")
    if count == 0:
        text = "no stick-slip is seen at any speed"
        if "oscillation_swing" in slip and np.isfinite(slip["oscillation_swing"]).any():
            worst = float(slip["oscillation_swing"].max())
            text += f"; oscillations of µ above {friction_text(worst)} would have been detected"
        return Evidence(AGAINST, text, "traces")
    speed = moving["sliding_speed"].values
    names, counts = np.unique(moving["waveform"].values.astype(str), return_counts=True)
    kinds = " and ".join(names[np.argsort(-counts)])
    first = int(np.argmin(speed))
    every = Count(slip.sizes["sliding_speed"])
    text = f"the traces oscillate at {count} of {every:speed|speeds} ({kinds})"
    drop = float(moving["drop"].values[first])
    if np.isfinite(drop):  # an oscillation may have no complete cycles
        text += f"; at {speed_text(speed[first])} friction drops by {friction_text(drop)}"
    if np.isfinite(drop):
        text += _drop_distance(moving.isel(sliding_speed=first))
    if SAW in names and SINE not in names:
        text += ", slow rises and abrupt drops"
    elif SINE in names and SAW not in names:
        text += ", rounded rather than abrupt"
    if REVERSED in names:
        text += "; slow falls and sharp rises suggest a sensor with reversed sign: check it"
    return Evidence(FOR, text, "traces")


def _drop_distance(row: xr.Dataset) -> str:
    """Return the distance between drops as text, with the spectral period if it scatters."""
    spectral = 1e6 * float(row["dominant_wavelength"]) if "dominant_wavelength" in row else np.nan
    apart = 1e6 * float(row["recurrence_distance"]) if "recurrence_distance" in row else np.nan
    kind = str(row["regularity"].item()) if "regularity" in row else ""
    if np.isnan(apart) or kind == "regular":
        apart = spectral
    text = f" every {apart:.3g} µm" if np.isfinite(apart) else ""
    if kind == "irregular" and np.isfinite(spectral):
        text += f" in the mean, irregularly (by the spectrum: {spectral:.3g} µm)"
    if kind == "intermittent" and "oscillating_time_share" in row:
        text += f", {percent_text(float(row['oscillating_time_share']))} of the time"
    return text


def macroscopic_adhesion(known: Mode) -> Evidence | None:
    """Return evidence on whether adhesion acts at the macroscopic scale."""
    work, bounds = known.work_of_adhesion, known.work_of_adhesion_range
    if work is None:
        text = "the work of adhesion at magnification 1 is not known: it requires scans, a "
        text += "modulus and the medium's work of adhesion"
        return Evidence(UNTOUCHED, text, "adhesion")
    value = f"γ_eff(1) = {1e3 * work:.2g} mJ/m²"
    span = ""
    if bounds is not None:
        span = f" (between {1e3 * bounds[0]:.2g} and {1e3 * bounds[1]:.2g})"
    if work > 0:
        return Evidence(FOR, f"adhesion reaches the macroscopic scale, {value}{span}", "adhesion")
    text = f"{value}{span}: adhesion cannot cause a macroscopic instability"
    if bounds is not None and bounds[1] > 0:
        text = f"{value}{span}: adhesion probably does not reach the macroscopic scale"
    return Evidence(AGAINST, text, "adhesion")


def vanishing_adhesion(known: Mode) -> Evidence | None:
    """Return evidence if the work of adhesion may be zero within its uncertainty."""
    bounds = known.work_of_adhesion_range
    if not known.work_of_adhesion or bounds is None or bounds[0] > 0:
        return None
    text = "γ_eff(1) may be zero within its bounds; then no such mode is possible"
    return Evidence(AGAINST, text, "adhesion")


def weakening(curve: xr.Dataset, slip: xr.Dataset | None) -> Evidence | None:
    """Return evidence on a decrease of friction with speed, without which a rig cannot stick-slip.

    A spring that pulls a body against friction that falls with speed causes stick-slip of fixed
    wavelength, whatever happens at the interface.
    """
    if slip is None or not slip.sizes.get("sliding_speed", 0):
        return None
    moving = _moving(slip)["sliding_speed"].values
    if moving.size == 0:
        return None
    speed, mu = curve["sliding_speed"].values, curve["friction_coefficient"].values
    part = (speed > 0.9 * moving.min()) & (speed < 1.1 * moving.max())
    if part.sum() < 2:
        return None
    speed, mu = speed[part], mu[part]
    words = f"µ = {friction_text(mu[0])} at {speed_text(speed[0])}"
    words += f", {friction_text(mu[-1])} at {speed_text(speed[-1])}"
    if mu[-1] < (1 - _MIN_FALL) * mu[0]:
        text = f"friction falls with speed where the traces oscillate ({words}): stick-slip caused "
        return Evidence(AGAINST, text + "by the stiffness of the rig would look the same", "curve")
    text = f"friction hardly falls where the traces oscillate ({words}): the stiffness "
    return Evidence(
        FOR, text + ("of the rig alone, which requires a fall, hardly explains it"), "curve"
    )


def strength(slip: xr.Dataset | None) -> Evidence | None:
    """Return evidence on an oscillation that weakens with speed, as in forced wetting."""
    if slip is None or not slip.sizes.get("sliding_speed", 0):
        return None
    moving = _moving(slip)
    moving = moving.isel(sliding_speed=np.flatnonzero(np.isfinite(moving["drop"].values)))
    if moving.sizes["sliding_speed"] < 2:
        return None
    speed, drop = moving["sliding_speed"].values, moving["drop"].values
    slow, fast = float(drop[0]), float(drop[-1])
    words = f"{friction_text(slow)} at {speed_text(speed[0])}"
    words += f", {friction_text(fast)} at {speed_text(speed[-1])}"
    if slow > _MIN_DROP_RATIO * fast:
        quiet = slip["sliding_speed"].values[slip["waveform"].values == STEADY_SLIDING]
        above = quiet[quiet > speed.max()]
        end = f", gone at {speed_text(above.min())}" if above.size else ""
        return Evidence(FOR, f"drops weaken as the speed grows: {words}{end}", "speed")
    return Evidence(UNTOUCHED, f"drops hardly depend on speed: {words}", "speed")


def scaling(slip: xr.Dataset | None) -> Evidence | None:
    """Return evidence if the oscillation is a resonance: its frequency does not depend on speed."""
    if slip is None:
        return None
    if (own := slip.attrs.get("resonance_frequency_Hz")) is not None:
        text = f"an oscillation at {own:.3g} Hz keeps its frequency at all speeds: a resonance of "
        return Evidence(UNTOUCHED, text + "the rig, not counted as stick-slip", "traces")
    if slip.attrs.get("scaling") == FIXED_FREQUENCY:
        text = "the frequency is independent of speed: a resonance, not "
        return Evidence(AGAINST, text + "folds that cross the contact", "traces")
    return None


def repeating(slip: xr.Dataset | None) -> Evidence | None:
    """Return evidence of waves that repeat with each turn of the rig, and were removed."""
    text = rig_wave_text(slip)
    if not text:
        return None
    return Evidence(UNTOUCHED, f"{text}; it was removed and is not counted as stick-slip", "traces")


def plateau(numbers: dict[str, float], model: xr.Dataset | None) -> Evidence | None:
    """Return evidence from the speeds at which plateau and computed boundary regime end."""
    end, computed = numbers["boundary_end_m_s"], numbers["model_boundary_end_m_s"]
    if model is None or np.isnan(end) or "solid_load_share" not in model:
        return None
    lowest = numbers["model_lowest_m_s"]
    if np.isnan(computed):
        computed, words = lowest, f"below {speed_text(lowest)}"
    else:
        words = f"at {speed_text(computed)}"
    text = f"the measured plateau reaches up to {speed_text(end)}"
    text += f"; the model's boundary regime ends {words}"
    if end > _MAX_SPEED_RATIO * computed:
        return Evidence(FOR, text + f", {float(f'{end / computed:.1g}'):g} times slower", "curve")
    return Evidence(AGAINST, text, "curve")


def misfit(numbers: dict[str, float]) -> Evidence | None:
    """Return evidence on whether the mixed-lubrication model describes the curve."""
    off = numbers["model_misfit"]
    if np.isnan(off):
        return None
    band = ""
    if np.isfinite(inside := numbers["speeds_in_band"]):
        band = f"; {inside:.0f} of {numbers['speeds_with_band']:.0f} speeds lie in the model's band"
    chance = numbers["model_misfit_p_value"]
    if np.isfinite(chance):
        band = f" (probability {chance:.2g} that errors alone cause this){band}"
    enough = is_sufficient(numbers)
    if enough is None:
        text = "the errors are too large to tell whether the mixed-lubrication model is sufficient:"
        text += f" it misses the measured curve by {percent_text(off)} of the largest friction"
        return Evidence(UNTOUCHED, f"{text}{band}", "curve")
    if enough:
        text = "the mixed-lubrication model is sufficient: its curve misses the measured one by"
        text += f" {percent_text(off)} of the largest friction{band}"
        return Evidence(AGAINST, text, "curve")
    text = "flow and load sharing alone do not explain the measured curve: the mixed-lubrication"
    text += f" model misses it by {percent_text(off)} of the largest friction{band}"
    return Evidence(FOR, text, "curve")


def uniform_slip(numbers: dict[str, float], known: Mode) -> Evidence | None:
    """Return evidence from the friction that uniform slip would cause at the rough shear stress."""
    uniform, seen = numbers["uniform_friction"], numbers["plateau_friction"]
    stress = known.rough_shear_stress
    if stress is None or not uniform > _MIN_SLIP_RATIO * seen > 0:  # nothing to explain
        return None
    text = (
        f"uniform slip at the rough surfaces' shear stress "
        f"({1e-6 * stress:.2g} MPa) over A/A0 = {known.area_ratio:.2g} would "
        f"need µ = {uniform:.2g}; µ = {friction_text(seen)} is measured"
    )
    if known.youngs_modulus:
        share = numbers["uniform_stress_Pa"] / known.youngs_modulus
        text += f", and such a slip would shear the rubber with {share:.2g} of its Young's modulus"
    return Evidence(FOR, text, "stress")


def forced_wetting(curve: xr.Dataset, slip: xr.Dataset | None, known: Mode) -> dict[str, float]:
    """Return the speeds between which stick-slip or high friction ends: forced wetting starts."""
    if not known.fluid or slip is None:
        return {}
    speed, mu = curve["sliding_speed"].values, curve["friction_coefficient"].values
    last = _moving(slip)["sliding_speed"].values.max()
    fallen = speed[(mu < _PLATEAU_END * np.median(mu[:3])) & (speed > 0)]
    quiet = slip["sliding_speed"].values
    quiet = quiet[(quiet > last) & (slip["waveform"].values == STEADY_SLIDING)]
    ends = [x.min() for x in (fallen, quiet) if x.size]
    if not ends:
        return {}
    high = float(max(max(ends), last))
    return {"forced_wetting_low_m_s": float(min(last, *ends)), "forced_wetting_high_m_s": high}
