"""Joint fit of all loads of a surface: shear stress and viscosity from friction curves."""
