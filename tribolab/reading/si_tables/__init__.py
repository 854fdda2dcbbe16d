"""Tables and single values of a raw file, in SI units, at each step of the instrument."""
