"""Figures of stick-slip: traces, events, spectra, and what oscillates when."""
