"""Mixed lubrication of rough line and point contacts: flow factors, solver, curves."""
