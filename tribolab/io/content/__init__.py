"""What raw files hold: tables at each step of the instrument, in SI, and single values."""
