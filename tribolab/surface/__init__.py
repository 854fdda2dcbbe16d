"""Rough surfaces: form removal, power spectra, self-affine models, roughness parameters."""
