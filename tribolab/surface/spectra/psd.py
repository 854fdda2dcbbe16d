"""Power spectra of measured profiles, and of the isotropic surface from which they come."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.provenance import history_line
from tribolab.surface.character import self_affinity_objection
from tribolab.surface.form import remove_form, removed_order
from tribolab.surface.gaps import bridge_gaps, cut_ends, effective_values, gap_cutoff, gaps_in
from tribolab.surface.level import level_rows, refuse_level
from tribolab.surface.spectra import abel
from tribolab.surface.spectra.annuli import annular_spectrum, bins_of, confidence_band, merge_annuli
from tribolab.surface.spectra.areal import psd_2d_of_map
from tribolab.surface.spectra.binning import log_bins, shape, window
from tribolab.surface.spectra.fourier import binned_power, fast_length
from tribolab.surface.spectra.parts import Transform, profile_gap_effect
from tribolab.surface.spectra.reliability import trusted_band
from tribolab.surface.spectra.smooth_law import fitted_law
from tribolab.units.stamping import stamp

_MIN_POINTS = 64


def psd_1d(
    scans: xr.Dataset,
    *,
    form: str = "auto",
    bins_per_decade: float = 12,
    tip_radius: str | float | None = None,
    flanks: float = 0.5,
    workers: int = 1,
) -> xr.Dataset:
    """Return the 1D power spectrum averaged over profiles, with its 95 % band.

    Parameters
    ----------
    scans
        ``height`` [m] (scan, x) or (x), evenly spaced. Missing heights (NaN) are bridged, and the
        spectrum is corrected for them; missing ends are cut off, and long gaps split a profile.
    form
        Form to remove first, see `remove_form`; ``"auto"`` removes a circle unless form was
        removed before, ``"none"`` only the mean.
    bins_per_decade
        Width of the bins on the logarithmic axis; at small k a bin contains at least four lines.
    tip_radius
        Radius of the stylus [m] or text; by default from the scans' file.
    flanks
        Share of the profile over which the window rises and falls as a Hann window does; 1 is
        the Hann window itself.
    workers
        Threads of the Fourier transform.

    Returns
    -------
    xarray.Dataset
        ``psd_1d`` [m3] with ``psd_1d_low``, ``psd_1d_high`` (95 % band), the number of
        ``independent_values`` and ``trusted`` (1 or 0), over ``wavenumber`` [1/m] with the bins'
        edges ``wavenumber_low`` and ``wavenumber_high``. The attributes give the limits of the
        trusted band and the error of Parseval's relation. If heights are missing, the band
        includes ``gap_error``, the relative standard error due to the gaps.

    Raises
    ------
    AnalysisError
        If the heights are too few, more than half of a scan's are missing, or those of a scan do
        not vary except for rounding.

    Notes
    -----
    Two-sided: ``<h^2> = int_{-inf}^{inf} C_1D dk``, twice the integral over positive k. The window
    has unit mean square. It correlates neighbouring lines: a bin of m lines has about m/1.35
    independent values per scan, and with a full Hann window m/1.94. The default flanks cover half
    of the profile: they suppress leakage as k^-6 like Hann's, and use more of the profile, so that
    h_rms of three scans of 25 mm scatters a fifth less. The mean of a bin is converted to its node
    by the local power law. The band is that of a chi-square variable with two degrees of freedom
    for each independent value [1]_.

    References
    ----------
    .. [1] D. B. Percival, A. T. Walden, Spectral Analysis for Physical Applications, Cambridge
       (1993), doi:10.1017/CBO9780511622762.

    Examples
    --------
    >>> x = 1e-6 * np.arange(4096)
    >>> height = np.random.default_rng(1).standard_normal((3, x.size))
    >>> scans = xr.Dataset({"height": (("scan", "x"), 1e-6 * height)}, {"x": x})
    >>> white = psd_1d(scans, form="none")
    >>> bool(white.attrs["parseval_error"] < 1e-10)
    True
    """
    scans = _prepare_scans(scans, form)
    heights = scans.height.transpose("scan", "x")
    pitch, (number, points) = _pitch(scans), heights.shape
    length = fast_length(points)
    taken = removed_order(scans)
    bins = log_bins(length // 2, taken + 2, bins_per_decade)
    taper, missing = window(points, flanks), gaps_in(scans)
    if missing is not None:
        heights = heights.copy(data=bridge_gaps(heights.values, missing, is_map=False))
    power = binned_power(heights.data, taper, bins, length, workers)
    refuse_level("psd_1d", scans, level_rows(heights.data))
    spacing = 2 * np.pi / (length * pitch)
    mean = power.bins / (bins.counts * number) * pitch / (2 * np.pi * points)
    q = bins.nodes * spacing
    slope = np.gradient(np.log(np.maximum(mean, 1e-300)), np.log(q)) if q.size > 2 else 0 * q
    ratio, independent = shape(bins, np.clip(slope, -6, 1), points / length, flanks)
    counts, effect = number * independent, None
    if missing is not None:
        effect = profile_gap_effect(
            heights.values, missing, Transform(bins, length, taken, flanks, workers)
        )
        mean, counts = mean * np.exp(-effect.shift), effective_values(counts, effect)
    value = mean / ratio
    low, high = confidence_band(value, counts)
    edges = bins.edges * spacing
    data = xr.Dataset(
        {
            "psd_1d": ("wavenumber", value),
            "psd_1d_low": ("wavenumber", low),
            "psd_1d_high": ("wavenumber", high),
            "independent_values": ("wavenumber", counts),
            "mean_square_height": ("wavenumber", 2 * mean * bins.counts * spacing),
        },
        {
            "wavenumber": q,
            "wavenumber_low": ("wavenumber", edges[:-1]),
            "wavenumber_high": ("wavenumber", edges[1:]),
        },
    )
    if effect is not None:
        data["gap_error"] = ("wavenumber", effect.error)
    lost = float("inf") if effect is None else gap_cutoff(q, effect)
    trusted, limits = trusted_band(data, scans, tip_radius, taken + 2, lost)
    data["trusted"] = ("wavenumber", trusted)
    whole = power.heights / (number * points)
    attrs = {
        **_inherited_attributes(scans, f"1D power spectrum of {number} scans"),
        **limits,
        "convention": "two-sided: <h^2> = 2 int_0^inf C_1D dk",
        "scans": number,
        "pitch_m": pitch,
        "window_flanks": flanks,
        "length_m": pitch * (points - 1),
        "mean_square_height_m2": whole,
        "parseval_error": abs(power.lines / power.heights - 1),
    }
    if why := self_affinity_objection(scans):
        attrs["not_self_affine"] = why
    return stamp(data.assign_attrs(attrs))


def psd_2d(
    scans: xr.Dataset,
    *,
    form: str = "auto",
    bins_per_decade: float = 12,
    tip_radius: str | float | None = None,
) -> xr.Dataset:
    """Return the 2D power spectrum of an isotropic surface, with its 95 % band.

    Parameters
    ----------
    scans
        Profiles, a map (y, x), maps (scan, y, x), or a 1D spectrum from `psd_1d`.
    form, bins_per_decade, tip_radius
        As for `psd_1d`; from a map a polynomial of second order is removed.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` [m4] with ``psd_2d_low``, ``psd_2d_high`` (95 % band) and ``origin`` over
        ``wavenumber`` [1/m], with the annuli's edges ``wavenumber_low``, ``wavenumber_high``.
        Only the trusted band of the 1D spectrum is used.

    Raises
    ------
    AnalysisError
        See `psd_1d`; or if the spectrum is insufficient for an inverse Abel transform.

    Notes
    -----
    Persson's convention, ``<h^2> = 2 pi int q C dq``. From profiles: the inverse Abel transform
    of the averaged, binned C_1D (see `spectra.abel.invert`). Below the roll-off profiles
    determine C(q) poorly, since most of their power there comes from shorter, oblique waves:
    annuli are merged until the standard error of each is below 25 %.

    References
    ----------
    .. [1] P. R. Nayak, Some aspects of surface roughness measurement, Wear 26 (1973) 165,
       doi:10.1016/0043-1648(73)90132-X.

    Examples
    --------
    >>> from tribolab.surface.self_affine import SelfAffine
    >>> from tribolab.surface.synthesis import synthesise_profiles
    >>> rough = SelfAffine(hurst=0.8, rolloff=2e4, plateau=1e-21, low=1e3, high=1e9)
    >>> scans = synthesise_profiles(rough, points=8192, pitch=1e-6, profiles=3, rng=1)
    >>> surface = psd_2d(scans.rename(profile="scan"), form="none")
    >>> surface.psd_2d.attrs["units"]
    'm4'
    """
    if isinstance(scans, xr.Dataset) and "height" in scans and "y" in scans.height.dims:
        return psd_2d_of_map(scans, form=form, bins_per_decade=bins_per_decade)
    if not isinstance(scans, xr.Dataset) or "psd_1d" not in scans:
        scans = psd_1d(scans, form=form, bins_per_decade=bins_per_decade, tip_radius=tip_radius)
    profile = scans.isel(wavenumber=scans.trusted.values == 1)
    if profile.wavenumber.size < 4:
        at = scans.attrs
        raise AnalysisError(
            f"{profile.wavenumber.size} wavenumbers can be trusted, four are the least; "
            f"{at['trusted_low_limited_by']} allows those above {at['trusted_low_1_m']:.3g} 1/m, "
            f"{at['trusted_high_limited_by']} those below {at['trusted_high_1_m']:.3g} 1/m: take "
            "longer or finer scans",
            function="psd_2d",
        )
    fitted = fitted_law(
        profile.wavenumber.values,
        profile.psd_1d.values,
        1 / np.sqrt(profile.independent_values.values),
    )
    bins, behind, relative = bins_of(profile, fitted)
    annuli, error = merge_annuli(abel.invert(bins), abel.invert(behind), relative)
    inherited = _inherited_attributes(scans, "2D power spectrum by the inverse Abel transform")
    result = annular_spectrum(annuli, error, fitted)
    return stamp(
        result.assign_attrs({**inherited, **result.attrs, "convention": "<h^2> = 2 pi int q C dq"})
    )


def _prepare_scans(scans: xr.Dataset, form: str) -> xr.Dataset:
    """Return scans without form along one dim ``scan``; raise an error if they are unsuitable."""
    if not isinstance(scans, xr.Dataset):
        raise AnalysisError(
            "one dataset with scans of equal pitch and length is wanted, got a "
            f"{type(scans).__name__}; scans that differ have a spectrum each",
            function="psd_1d",
        )
    if "height" not in scans or "x" not in scans.height.dims:
        raise AnalysisError(
            "scans with 'height' (scan, x) are wanted",
            cure=Cure(notebook="read them with read_scans()"),
            function="psd_1d",
        )
    if "y" in scans.height.dims:
        raise AnalysisError(
            "this is a map (y, x)",
            cure=Cure(
                notebook="psd_2d() takes its spectrum, and a single row of it, e.g. "
                "scans.isel(y=0), is a profile"
            ),
            function="psd_1d",
        )
    others = [d for d in scans.height.dims if d != "x"]
    if len(others) > 1:
        raise AnalysisError(
            f"height has the dimensions {scans.height.dims}; one scan each", function="psd_1d"
        )
    points = scans.sizes["x"]
    if points < _MIN_POINTS:
        raise AnalysisError(
            f"{points} points are too few for a spectrum; {_MIN_POINTS} are the least",
            function="psd_1d",
        )
    if form == "auto":
        form = "none" if "form_removed" in scans.attrs else "circle"
    scans = cut_ends(scans)
    scans = scans if form == "none" else remove_form(scans, form)
    return scans.rename({others[0]: "scan"}) if others else scans.expand_dims("scan")


def _pitch(scans: xr.Dataset) -> float:
    x = scans.x.values
    steps = np.diff(x)
    pitch = float((x[-1] - x[0]) / (x.size - 1))
    if not pitch > 0 or np.abs(steps - pitch).max() > 1e-3 * pitch:
        raise AnalysisError(
            "x must increase in even steps",
            cure=Cure(notebook="read the scans with read_scans(), which evens out rounded steps"),
            function="psd_1d",
        )
    return pitch


def _inherited_attributes(scans: xr.Dataset, action: str) -> dict[str, str | float]:
    kept = {k: v for k, v in scans.attrs.items() if k not in ("convention", "title")}
    history = [scans.attrs["history"]] if scans.attrs.get("history") else []
    return {**kept, "history": "\n".join([*history, history_line(action)])}
