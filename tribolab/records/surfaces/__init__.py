"""What a surface leaves: its scans, its roughness, and the words for them."""
