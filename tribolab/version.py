"""The version of tribolab, which every product names."""

__version__ = "0.1.0"
