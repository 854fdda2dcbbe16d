"""Rough surfaces: form removal, power spectra, self-affine models, roughness parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribolab.core.public_names import loaded_on_use

if TYPE_CHECKING:
    from tribolab.surface.extrapolation import extrapolate
    from tribolab.surface.form import fill_dropouts, remove_form
    from tribolab.surface.roughness import spectral_roughness
    from tribolab.surface.self_affine import self_affine_psd
    from tribolab.surface.spectra.psd import psd_1d, psd_2d
    from tribolab.surface.synthesis import synthesise_map

__all__ = [
    "extrapolate",
    "fill_dropouts",
    "psd_1d",
    "psd_2d",
    "remove_form",
    "self_affine_psd",
    "spectral_roughness",
    "synthesise_map",
]

__getattr__, __dir__ = loaded_on_use(
    __name__,
    {
        "extrapolate": "extrapolation",
        "fill_dropouts": "form",
        "psd_1d": "spectra.psd",
        "psd_2d": "spectra.psd",
        "remove_form": "form",
        "self_affine_psd": "self_affine",
        "spectral_roughness": "roughness",
        "synthesise_map": "synthesis",
    },
)
