"""Roughness parameters of profiles (ISO 21920, ISO 4287) and of spectra."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.provenance import history_line
from tribolab.surface.filters import gaussian_filter
from tribolab.surface.gaps import bridge_gaps, cut_ends, gap_effect, gaps_in
from tribolab.surface.level import level_rows, refuse_level, rounding_only
from tribolab.surface.spectra.tails import long_holes, tails
from tribolab.units.conversion import positive, to_si
from tribolab.units.stamping import stamp

STANDARD_CUTOFF = 0.8e-3  # m, default cut-off for most surfaces (ISO 21920-3)
# usual number of sampling lengths; the cut-off of a shorter profile is its length divided by this
_LENGTHS = 5
_MIN_LENGTHS = 3  # fewest sampling lengths that give the standard error of their mean


def roughness_parameters(
    scans: xr.Dataset,
    *,
    lambda_c: str | float | None = "auto",
    lambda_s: str | float | None = "auto",
    sampling_lengths: bool = True,
) -> xr.Dataset:
    """Return Ra, Rq, Rz, Rsk, Rku and Rdq of profiles after the standard Gaussian filter.

    Parameters
    ----------
    scans
        ``height`` [m] (..., x) without form. Missing heights (NaN) are bridged, and the results
        are corrected for them; missing ends of profiles are cut off.
    lambda_c
        Long-wave cut-off [m] or text; None keeps long waves. ``"auto"``: None for a
        profile that the instrument filtered (attribute ``lambda_c_m``), else the standard 0.8 mm,
        or a fifth of a shorter profile.
    lambda_s
        Short-wave cut-off; None or ``"auto"`` keeps short waves.
    sampling_lengths
        True: Ra, Rq, Rsk, Rku are means over whole sampling lengths of one lambda_c (ISO 4287,
        as in most instruments); False: they are computed over the whole evaluation length
        (ISO 21920). Without lambda_c there are no sampling lengths.

    Returns
    -------
    xarray.Dataset
        ``Ra``, ``Rq``, ``Rz`` [m], ``Rsk``, ``Rku``, ``Rdq`` [1], with the dims of the heights
        except x. The attributes give the cut-offs and the length evaluated. With three sampling
        lengths or more, ``Ra_sem`` and so on are the standard errors of the means over these.
        If heights are missing, ``Ra_gap_error`` and so on are the standard errors due to the
        gaps.

    Raises
    ------
    AnalysisError
        If the heights do not vary except for rounding, if more than half of a scan's are missing,
        or if the profile is shorter than two cut-offs.

    Notes
    -----
    The roughness profile is heights minus their Gaussian mean line. Half a cut-off at each end,
    affected by the filter, is left out. Heights are relative to the mean line, or without lambda_c
    to their mean. Rz is the mean over sampling lengths of the height from the deepest valley to the
    highest peak. Rdq uses the seven-point formula of ISO 4287. If a hole covers more than half of a
    sampling length, Rsk and Rku use the measured heights of the other lengths.

    References
    ----------
    .. [1] ISO 21920-2:2021; ISO 4287:1997; ISO 16610-21:2011.

    Examples
    --------
    >>> x = 0.5e-6 * np.arange(20_000)
    >>> wave = xr.Dataset({"height": ("x", 1e-6 * np.sin(2 * np.pi * x / 1e-4))}, {"x": x})
    >>> found = roughness_parameters(wave, lambda_c=None)
    >>> round(float(found.Rq) * 1e6, 4), round(float(found.Ra) * 1e6, 4)
    (0.7071, 0.6366)
    """
    scans = cut_ends(scans)
    x = scans.x.values
    pitch, points = float((x[-1] - x[0]) / (x.size - 1)), x.size
    cut, filtered = _long_cutoff(lambda_c, scans, pitch * points)
    fine = None if lambda_s in ("auto", None) else to_si(lambda_s, "m", "lambda_s")
    given = scans.height.transpose(..., "y", "x") if "y" in scans.dims else scans.height
    given = given.transpose(..., "x")
    missing = gaps_in(xr.Dataset({**scans.data_vars, "height": given}, attrs=scans.attrs))
    is_map = "y" in given.dims
    if missing is not None:
        given = given.copy(data=bridge_gaps(given.values, missing, is_map=is_map))
    evaluation = _Evaluation(pitch, cut, filtered, fine, sampling_lengths)
    values, by_length = evaluation.parameters(scans.assign(height=given))
    dims = given.dims[:-1]
    data = xr.Dataset({name: (dims, value) for name, value in values.items()})
    if missing is not None:
        data = _correct_gaps(data, scans.assign(height=given), missing, evaluation)
    if not is_map:  # the rows of a map are correlated, so they give no standard error
        data = data.assign(
            {f"{name}_sem": (dims, error) for name, error in _errors(by_length).items()}
        )
    applied = {"lambda_c_m": cut, "lambda_s_m": fine}
    length, lengths = evaluation.lengths(points)
    return stamp(
        data,
        **{k: v for k, v in applied.items() if v is not None},
        filtered_by="instrument" if filtered else "tribolab" if cut or fine else "nothing",
        evaluation_length_m=length,
        sampling_lengths=lengths,
        history=history_line("roughness parameters"),
    )


def primary_roughness(scans: xr.Dataset) -> xr.DataArray:
    """Return Pq, the rms height of each profile over all wavelengths.

    Parameters
    ----------
    scans
        ``height`` [m] (..., x) without form; missing heights are left out.

    Returns
    -------
    xarray.DataArray
        Pq [m] of the profile without form, with the dims of the heights except x. Rq leaves out
        waves longer than the cut-off and is smaller.

    References
    ----------
    .. [1] ISO 21920-2:2021 (primary profile).

    Examples
    --------
    >>> wave = xr.Dataset({"height": ("x", [1e-6, -1e-6, 1e-6, -1e-6])}, {"x": np.arange(4.0)})
    >>> float(primary_roughness(wave))
    1e-06
    """
    return stamp(scans.height.std("x").rename("Pq").to_dataset())["Pq"]


class _Evaluation(NamedTuple):
    """Settings of a roughness evaluation: pitch, cut-offs [m], and filters already applied."""

    pitch: float
    cut: float | None
    filtered: bool
    fine: float | None
    sampling: bool

    @property
    def edge(self) -> int:
        """Number of points lost at each end to the end effects of the filter."""
        return int(round(0.5 * self.cut / self.pitch)) if self.cut and not self.filtered else 0

    def lengths(self, points: int) -> tuple[float, int]:
        """Return the evaluation length [m] of `points` points, and its sampling-length count."""
        length = (points - 2 * self.edge) * self.pitch
        return length, 5 if self.cut is None else max(1, int(round(length / self.cut - 0.25)))

    def parts(self, rows: np.ndarray) -> np.ndarray:
        """Return rows (..., x) divided into sampling lengths (..., sampling length, x)."""
        _, lengths = self.lengths(rows.shape[-1] + 2 * self.edge)
        size = rows.shape[-1] // lengths
        return rows[..., : lengths * size].reshape(*rows.shape[:-1], lengths, size)

    def profile(self, scans: xr.Dataset) -> np.ndarray:
        """Return the roughness profile [m] (..., x) over the evaluation length."""
        pitch, cut, points = self.pitch, self.cut, scans.sizes["x"]
        profile = scans if self.fine is None else gaussian_filter(scans, self.fine)
        height = profile.height.transpose(..., "x")
        if cut is not None and not self.filtered:
            if points - 2 * self.edge < cut / pitch:
                raise AnalysisError(
                    f"{pitch * points:.3g} m are shorter than two cut-offs "
                    f"lambda_c = {cut:.3g} m; give a smaller lambda_c",
                    function="roughness_parameters",
                )
            rough = height - gaussian_filter(profile, cut).height
            height = rough.isel(x=slice(self.edge, points - self.edge))
        return np.asarray(height.values)

    def parameters(self, scans: xr.Dataset) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Return the parameters of profiles without gaps, overall and per sampling length."""
        pitch, cut, points = self.pitch, self.cut, scans.sizes["x"]
        rows = self.profile(scans)
        parts = self.parts(rows)
        deviation = parts if self.sampling and cut is not None else rows[..., None, :]
        if cut is None:  # without a filter, the reference line is at the mean height
            deviation = deviation - deviation.mean(-1, keepdims=True)
        slope = _slope(rows, pitch)
        given = scans.height.transpose(..., "x").values.reshape(-1, points)
        level = level_rows(given) | rounding_only(deviation.reshape(len(given), -1), given)
        refuse_level("roughness_parameters", scans, level)
        square = np.mean(deviation**2, -1)
        if not (square > 0).all():
            raise AnalysisError(
                "a whole sampling length is level, its skewness is not defined",
                cure=Cure(
                    notebook="cut the scan, or take sampling_lengths=False", campaign="cut the scan"
                ),
                function="roughness_parameters",
            )
        by_length = {
            "Ra": np.abs(deviation).mean(-1),
            "Rq": np.sqrt(square),
            "Rz": np.ptp(parts, axis=-1),
            "Rsk": np.mean(deviation**3, -1) / square**1.5,
            "Rku": np.mean(deviation**4, -1) / square**2,
        }
        values = {name: of.mean(-1) for name, of in by_length.items()}
        return values | {"Rdq": np.sqrt(np.mean(slope**2, -1))}, by_length


def _errors(by_length: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return standard errors of the means over sampling lengths, if there are enough of them."""
    return {
        name: of.std(-1, ddof=1) / np.sqrt(of.shape[-1])
        for name, of in by_length.items()
        if of.shape[-1] >= _MIN_LENGTHS
    }


def _correct_gaps(
    data: xr.Dataset, scans: xr.Dataset, missing: np.ndarray, evaluation: _Evaluation
) -> xr.Dataset:
    """Return parameters corrected for gaps, and their remaining errors (``Ra_gap_error``)."""
    shape = scans.height.shape
    is_map = "y" in scans.height.dims
    grid = shape[-2:] if is_map else shape[-1:]
    # the effect of gaps on Rsk and on means over sampling lengths is additive, not a factor
    added = {"Rsk", "Rku"} if evaluation.sampling and evaluation.cut else {"Rsk"}
    factors = np.array([not is_map and name not in added for name in data])

    def parameters(height: np.ndarray) -> np.ndarray:
        same = scans.assign(height=scans.height.copy(data=height.reshape(shape)))
        values = np.stack(list(evaluation.parameters(same)[0].values()))
        values[factors] = np.log(values[factors])
        return values.reshape(len(values), -1, *grid[:-1])

    effect = gap_effect(
        scans.height.values.reshape(-1, *grid),
        missing.reshape(-1, *grid),
        parameters,
        is_map=is_map,
        own=factors,
    )
    rows = data["Ra"].shape
    for number, name in enumerate(list(data)):
        shift, error = effect.shift[number].reshape(rows), effect.error[number].reshape(rows)
        if name == "Rz":  # gaps seldom hide the highest peak, but then Rz changes a lot
            error = np.full_like(error, error.max())
        if factors[number]:
            data[name] = data[name] * np.exp(-shift)
            error = error * data[name].values
        else:
            data[name] = data[name] - shift
        data[f"{name}_gap_error"] = (data["Ra"].dims, error)
    if not is_map and evaluation.sampling and evaluation.cut:
        data = _correct_tails(data, scans, missing, evaluation)
    return data


def _correct_tails(
    data: xr.Dataset, scans: xr.Dataset, missing: np.ndarray, evaluation: _Evaluation
) -> xr.Dataset:
    """Return parameters with Rsk and Rku from measured heights only, if a gap is long."""
    rows = evaluation.profile(scans)
    edge, points = evaluation.edge, missing.shape[-1]
    parts = evaluation.parts(rows.reshape(-1, rows.shape[-1]))
    gaps = evaluation.parts(missing[..., edge : points - edge].reshape(-1, rows.shape[-1]))
    holed = long_holes(gaps).reshape(data["Ra"].shape)
    if not holed.any():
        return data
    for name, (value, error) in tails(parts, gaps).items():
        known = holed & np.isfinite(value).reshape(holed.shape)
        for column, new in ((name, value), (f"{name}_gap_error", error)):
            data[column] = data[column].where(~known, new.reshape(holed.shape))
    return data


def _long_cutoff(
    lambda_c: str | float | None, scans: xr.Dataset, length: float
) -> tuple[float | None, bool]:
    """Return the long-wave cut-off [m], and whether the instrument has already applied it."""
    if lambda_c is None:
        return None, False
    if lambda_c != "auto":
        return positive(lambda_c, "m", "lambda_c"), False
    if "lambda_c_m" in scans.attrs:
        return float(scans.attrs["lambda_c_m"]), True
    return min(STANDARD_CUTOFF, length / _LENGTHS), False


def _slope(rows: np.ndarray, pitch: float) -> np.ndarray:
    """Return local slopes of profiles by the seven-point formula of ISO 4287 (4.4.1)."""
    if rows.shape[-1] < 7:
        raise AnalysisError("seven points are the least", function="roughness_parameters")
    ahead = 45 * rows[..., 4:-2] - 9 * rows[..., 5:-1] + rows[..., 6:]
    behind = 45 * rows[..., 2:-4] - 9 * rows[..., 1:-5] + rows[..., :-6]
    return (ahead - behind) / (60 * pitch)
