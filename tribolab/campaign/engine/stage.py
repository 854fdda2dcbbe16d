"""One way to do every kind of work: plan it, take over what is known, do the rest, record failures.

Runs, curves, surfaces, models and figures are stages. A stage says what is to be done, what is
known of it already, what a worker does (pure: a task in, a record out), and what stands in the
place of a record when that failed. Where the work is done is any `concurrent.futures.Executor`.
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
Came = TypeVar("Came")
Progress = Callable[[str, int, int], None]


class Stage(ABC, Generic[Task, Record, Came]):
    """One kind of work in a campaign.

    Attributes
    ----------
    name
        What the progress calls it.
    """

    name: ClassVar[str]

    @staticmethod
    @abstractmethod
    def work(task: Task) -> Record:
        """Do one task; static, that it may travel to a worker.

        What goes wrong with the task itself is in the record; it raises `OutputError` where
        results cannot be written, and nothing else on purpose.
        """

    @abstractmethod
    def plan(self) -> Sequence[Task]:
        """Return what is to be done, in the order of the results."""

    def known(self, task: Task, place: int) -> Came | None:
        """Take over what is known, and return what it came to; None if it has to be done."""
        return None

    def prepared(self, task: Task) -> Task:
        """Return a task as a worker gets it, with what is known of a part of it."""
        return task

    def order(self, tasks: Sequence[tuple[int, Task]]) -> list[tuple[int, Task]]:
        """Return tasks in the order in which they should begin."""
        return list(tasks)

    @abstractmethod
    def failed(self, task: Task, error: BaseException) -> Record:
        """Return the record of a task whose worker could not even say what went wrong."""

    @abstractmethod
    def keep(self, task: Task, place: int, record: Record) -> Came:
        """Write a record down; return the little that the next stages have to know of it."""


def silent(stage: str, done: int, total: int) -> None:
    """Say nothing of the progress."""


def perform(
    stage: Stage[Task, Record, Came], executor: Executor | None = None, tell: Progress | None = None
) -> list[Came]:
    """Do the work of a stage, and return what each task came to, in the order of the plan.

    Parameters
    ----------
    stage
        What is to be done.
    executor
        Where; None does it here, task by task.
    tell
        Called as ``tell(stage, done, total)``; None says nothing.

    Raises
    ------
    OutputError
        If results cannot be written. What else goes wrong is in the records.
    """
    return begun(stage, executor, tell)()


def begun(
    stage: Stage[Task, Record, Came], executor: Executor | None = None, tell: Progress | None = None
) -> Callable[[], list[Came]]:
    """Begin the work of a stage, and return what waits for it and gives what `perform` gives.

    What is called in between is done while workers work; without an executor nothing is done
    before it is waited for.

    Parameters
    ----------
    stage, executor, tell
        As for `perform`.
    """
    tasks = stage.plan()
    tell = tell or silent
    came: dict[int, Came] = {}
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

    def ended() -> list[Came]:
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
    """Give (place, task, record or error) as the tasks end; nothing of them is held here."""
    places = {id(task): place for place, task in tasks}
    return _answered(places, completed(executor, work, [task for _, task in tasks]))


def _answered(
    places: Mapping[int, int], done: Iterable[tuple[Task, Future[Record]]]
) -> Iterator[tuple[int, Task, Record | BaseException]]:
    for task, future in done:
        error = future.exception()
        yield places[id(task)], task, error if error is not None else future.result()
