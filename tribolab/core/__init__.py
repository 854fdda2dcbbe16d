"""What every other package needs: errors, limits, provenance, wording."""
