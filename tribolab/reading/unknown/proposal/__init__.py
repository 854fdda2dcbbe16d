"""The proposed dialect: shown, asked about, written."""
