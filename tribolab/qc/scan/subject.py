"""Scans to be checked, with quantities that several checks need."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.surface.character import repeating_wave, self_affinity_objection
from tribolab.surface.form import fill_dropouts, remove_form
from tribolab.surface.level import level_rows
from tribolab.surface.spectra.psd import psd_1d

_MIN_HEIGHTS = 8  # fewest heights of a profile; form and roughness need more


class ScanSubject:
    """Scans of one surface, as rows of heights.

    Parameters
    ----------
    scans
        ``height`` [m] (..., x).
    results
        Datasets of `results.read_tester_results`, if the instrument wrote some.
    """

    def __init__(self, scans: xr.Dataset, results: Sequence[xr.Dataset] = ()) -> None:
        self.scans, self.results = scans, tuple(results)
        self.is_map = "y" in scans.height.dims

    @cached_property
    def rows(self) -> np.ndarray:
        """Heights [m] (row, x)."""
        height = self.scans.height.transpose(..., "x").values
        return np.asarray(height, dtype=float).reshape(-1, height.shape[-1])

    @cached_property
    def x(self) -> np.ndarray:
        """Positions [m]."""
        return self.scans.x.values

    @cached_property
    def pitch(self) -> float:
        """Distance between neighbouring points [m]."""
        return float(self.x[-1] - self.x[0]) / (self.x.size - 1)

    @cached_property
    def names(self) -> list[str]:
        """Name of each row."""
        if "file" in self.scans:
            return [str(name) for name in np.atleast_1d(self.scans["file"].values)]
        if len(self.rows) == 1 and "source" in self.scans.attrs:
            return [str(self.scans.attrs["source"])]
        kind = "row" if self.is_map else "scan"
        return [f"{kind} {number}" for number in range(1, len(self.rows) + 1)]

    def attribute_values(self, key: str) -> list[float]:
        """Return the values of an attribute: one per row, a common one, or none."""
        value = self.scans.attrs.get(key)
        if isinstance(value, str):
            parts = [part.strip() for part in value.split(";")]
            return [float(part) if part else float("nan") for part in parts]
        return [] if value is None else [float(value)]

    def place(self, row: int, first: int, last: int) -> str:
        """Return a text that names a row and an interval of x in it."""
        text = f"{self.names[row]}, x = {self.x[first] * 1e3:.6g} mm"
        return text if last <= first else f"{text} to {self.x[last] * 1e3:.6g} mm"

    def reshape_flags(self, rows: np.ndarray) -> np.ndarray:
        """Return flags (row, x) in the dimensions of the heights."""
        dims = self.scans.height.transpose(..., "x").dims
        array = xr.DataArray(rows.reshape([self.scans.sizes[d] for d in dims]), dims=dims)
        return array.transpose(*self.scans.height.dims).values

    @cached_property
    def usable(self) -> list[int]:
        """Indices of the rows with enough heights for a profile."""
        present = np.isfinite(self.rows).sum(axis=1)
        return np.flatnonzero(present >= _MIN_HEIGHTS).tolist()

    @cached_property
    def profile_names(self) -> list[str]:
        """Labels of the usable rows, in the order of `filled_profiles`, `form` and `spectra`."""
        return [self.names[row] for row in self.usable]

    @cached_property
    def filled_profiles(self) -> list[xr.Dataset]:
        """Profiles of the usable rows, with dropouts filled."""
        x = self.x - self.x[0]
        profiles = [xr.Dataset({"height": ("x", self.rows[n])}, {"x": x}) for n in self.usable]
        return [fill_dropouts(profile) for profile in profiles]

    def profile_of(self, row: int) -> xr.Dataset | None:
        """Return a row without form, with filled heights marked; None with too few heights."""
        _, profiles = self.form
        return profiles[self.usable.index(row)] if row in self.usable else None

    @cached_property
    def form(self) -> tuple[str, list[xr.Dataset]]:
        """Name of the removed form (circle, or tilt if no circle fits), and profiles without it."""
        if "form_removed" in self.scans.attrs:
            return "none", self.filled_profiles
        try:
            return "circle", [remove_form(profile, "circle") for profile in self.filled_profiles]
        except AnalysisError:  # no circle fits: a ramp, a profile of two flats, a chamfer
            return "tilt", [remove_form(profile, "tilt") for profile in self.filled_profiles]

    @cached_property
    def level(self) -> list[int]:
        """Indices, among the usable rows, of the rows without roughness."""
        _, profiles = self.form
        flat = [level_rows(profile.height.values[None])[0] for profile in profiles]
        return np.flatnonzero(flat).tolist()

    @cached_property
    def affinity_objection(self) -> str:
        """Why the surface cannot be self-affine; "" if it can."""
        x = self.x - self.x[0]
        if not self.is_map:
            _, profiles = self.form
            rows = np.stack([profile.height.values for profile in profiles])
            return self_affinity_objection(xr.Dataset({"height": (("scan", "x"), rows)}, {"x": x}))
        scans = self.map_without_form
        return "" if scans is None else self_affinity_objection(scans)

    @cached_property
    def map_without_form(self) -> xr.Dataset | None:
        """Map minus a polynomial of second order; None if it has too few heights."""
        if not np.isfinite(self.rows).any() or min(self.scans.height.shape[-2:]) < _MIN_HEIGHTS:
            return None
        scans = self.scans[["height"]].assign_attrs(self.scans.attrs)
        return scans if "form_removed" in scans.attrs else remove_form(scans, "polynomial")

    @cached_property
    def wave(self) -> tuple[float, float]:
        """Share of a periodic wave in the mean square height, and its wavelength [m]; 0 if none."""
        if self.is_map:
            return 0.0, float("nan")
        _, profiles = self.form
        rows = np.stack([profile.height.values for profile in profiles])
        return repeating_wave(rows, float(self.x[-1] - self.x[0]) / (self.x.size - 1))

    @cached_property
    def spectra(self) -> list[xr.Dataset]:
        """Power spectrum of each profile; empty for maps or too few heights."""
        if self.is_map:
            return []
        _, profiles = self.form
        radius = max(self.attribute_values("tip_radius_m"), default=None)
        spectra = []
        if self.level:
            return []
        for profile in profiles:
            if profile.sizes["x"] < 256:
                return []
            bare = profile.drop_vars(["form_tilt", "form_curvature", "dropout"], errors="ignore")
            spectra.append(psd_1d(bare.expand_dims("scan"), form="none", tip_radius=radius))
        return spectra
