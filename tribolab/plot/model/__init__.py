"""Figures of mixed lubrication: beside the measurement, across the film, fitted jointly."""
