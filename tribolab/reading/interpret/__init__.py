"""From columns and settings to what they mean: evidence, rules of physics, one decision."""
