"""Mixed lubrication of a rough line contact: flow and friction factors, the solver, curves."""
