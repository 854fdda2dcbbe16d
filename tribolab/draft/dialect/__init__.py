"""The dialect that is drafted: shown, asked about, written down."""
