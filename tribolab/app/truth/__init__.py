"""Comparison of a simulated campaign's results with the inputs of the virtual rig."""
