"""Rough surfaces: form removal, power spectra, self-affine models, roughness parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.surface.extrapolation import extrapolate as extrapolate
    from tribolab.surface.form import fill_dropouts as fill_dropouts, remove_form as remove_form
    from tribolab.surface.spectrum_roughness import spectral_roughness as spectral_roughness
    from tribolab.surface.self_affine import self_affine_psd as self_affine_psd
    from tribolab.surface.spectra.psd import psd_1d as psd_1d, psd_2d as psd_2d
    from tribolab.surface.synthesis import synthesise_map as synthesise_map

__getattr__, __dir__, __all__ = loaded_on_use(__name__, __file__)
