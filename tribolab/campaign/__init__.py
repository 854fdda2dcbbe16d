"""Campaigns: files of settings, and the stages over runs, curves, surfaces and models."""
