"""Tools that every other package needs: errors, limits, provenance, wording."""
