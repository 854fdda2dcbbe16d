"""Times of alternating tasks, and the table row that says how they compare."""

from __future__ import annotations

import time
from collections.abc import Callable


def least_times(rounds: int, **tasks: Callable[[], object]) -> dict[str, float]:
    """Return the least processor time [s] of each task; they alternate, after a first round."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(rounds + 1):
        for name, task in tasks.items():
            start = time.process_time()
            task()
            times[name].append(time.process_time() - start)
    return {name: min(values[1:]) for name, values in times.items()}


def row(
    job: str, ours: float, peer: str, theirs: float, goal: float | None, unit: str = "s"
) -> None:
    """Print a row of docs/benchmarks.md: job, both numbers, their ratio and its goal."""
    numbers = f"{ours:.3g} {unit} | {peer} | {theirs:.3g} {unit} | {ours / theirs:.2f}"
    print(f"| {job} | {numbers} | {'none set' if goal is None else f'{goal:g}'} |", flush=True)
