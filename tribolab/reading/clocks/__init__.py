"""One clock for a run, or two that are matched."""
