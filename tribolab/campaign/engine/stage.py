"""Interface of all stages of a campaign, and their execution.

Runs, curves, surfaces, models and figures are stages. A stage defines its tasks, reuses known
results, has a pure function for workers (from task to record), and makes a record of a failure. The
work is done in any `concurrent.futures.Executor`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future
from typing import ClassVar, Generic, TypeVar

from tribolab.campaign.engine.executor import completed
from tribolab.core.errors import OutputError

Task = TypeVar("Task")
Record = TypeVar("Record")
Done = TypeVar("Done")
Progress = Callable[[str, int, int], None]


class Stage(ABC, Generic[Task, Record, Done]):
    """Kind of work in a campaign.

    Attributes
    ----------
    name
        Name in the progress display.
    """

    name: ClassVar[str]

    @staticmethod
    @abstractmethod
    def work(task: Task) -> Record:
        """Do one task; static, so that it can be sent to a worker.

        Errors of the task itself are recorded; only `OutputError` is raised, if results cannot be
        written.
        """

    @abstractmethod
    def plan(self) -> Sequence[Task]:
        """Return the tasks in the order of the results."""

    def known(self, task: Task, place: int) -> Done | None:
        """Reuse a known result and return its outcome; None if there is none."""
        return None

    def prepared(self, task: Task) -> Task:
        """Return a task for a worker, with reusable parts of earlier results."""
        return task

    def order(self, tasks: Sequence[tuple[int, Task]]) -> list[tuple[int, Task]]:
        """Return the tasks in the order in which they should start."""
        return list(tasks)

    @abstractmethod
    def failed(self, task: Task, error: BaseException) -> Record:
        """Return the record of a task whose worker died."""

    @abstractmethod
    def keep(self, task: Task, place: int, record: Record) -> Done:
        """Store a record, and return what later stages need of it."""


def silent(stage: str, done: int, total: int) -> None:
    """Show no progress."""


def perform(
    stage: Stage[Task, Record, Done], executor: Executor | None = None, tell: Progress | None = None
) -> list[Done]:
    """Do the work of a stage, and return the outcome of each task in the order of the plan.

    Parameters
    ----------
    stage
        The stage.
    executor
        Executor; None does the work here, task by task.
    tell
        Called as ``tell(stage, done, total)``; None shows no progress.

    Raises
    ------
    OutputError
        If results cannot be written. Other errors are in the records.
    """
    return begun(stage, executor, tell)()


def begun(
    stage: Stage[Task, Record, Done], executor: Executor | None = None, tell: Progress | None = None
) -> Callable[[], list[Done]]:
    """Start the work of a stage, and return a function that waits for its outcomes.

    The caller can work in the meantime; without an executor the work is done when it is waited for.

    Parameters
    ----------
    stage, executor, tell
        As for `perform`.
    """
    tasks = stage.plan()
    tell = tell or silent
    came: dict[int, Done] = {}
    left = []
    for place, task in enumerate(tasks):
        known = stage.known(task, place)
        if known is None:
            left.append((place, stage.prepared(task)))
        else:
            came[place] = known
    if came:
        tell(stage.name, len(came), len(tasks))
    coming = answers(type(stage).work, stage.order(left), executor)

    def ended() -> list[Done]:
        for place, task, answer in coming:
            if isinstance(answer, OutputError):
                raise answer
            if isinstance(answer, BaseException):
                answer = stage.failed(task, answer)
            came[place] = stage.keep(task, place, answer)
            tell(stage.name, len(came), len(tasks))
        return [came[place] for place in range(len(tasks))]

    return ended


def answers(
    work: Callable[[Task], Record],
    tasks: Sequence[tuple[int, Task]],
    executor: Executor | None,
) -> Iterator[tuple[int, Task, Record | BaseException]]:
    """Yield (index, task, record or error) as the tasks end; results are not kept in memory."""
    places = {id(task): place for place, task in tasks}
    return _answered(places, completed(executor, work, [task for _, task in tasks]))


def _answered(
    places: Mapping[int, int], done: Iterable[tuple[Task, Future[Record]]]
) -> Iterator[tuple[int, Task, Record | BaseException]]:
    for task, future in done:
        error = future.exception()
        yield places[id(task)], task, error if error is not None else future.result()
