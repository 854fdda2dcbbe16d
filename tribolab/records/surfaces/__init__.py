"""Records of surfaces: scans and roughness, with their wording."""
