"""Results of a simulated campaign beside what the rig was given."""
