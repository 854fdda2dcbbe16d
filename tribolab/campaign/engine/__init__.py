"""Execution of work: stages, executors, pools and clusters."""
