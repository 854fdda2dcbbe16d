"""Typed records of runs, curves, surfaces and models."""
