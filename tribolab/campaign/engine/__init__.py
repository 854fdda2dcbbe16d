"""Where and how work is done: stages, executors, pools and clusters."""
