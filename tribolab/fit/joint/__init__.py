"""Joint fit to the friction curves at all loads: shear stress, its exponents, and viscosity."""
