"""Stages whose records are stored unchanged in the catalogue, under the name of their task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar, Generic, Protocol, TypeVar

from tribolab.campaign.engine.stage import Stage
from tribolab.campaign.store.new_catalogue import Store
from tribolab.records.parts import Notice


class Named(Protocol):
    """Task with the name of its record and a checksum of everything that affects it."""

    @property
    def name(self) -> str:
        """Name of its record in the catalogue."""

    @property
    def fingerprint(self) -> str:
        """Checksum of everything that affects the record."""


Mine = TypeVar("Mine", bound=Named)
Settled = TypeVar("Settled")
Failure = TypeVar("Failure")


class Recorded(Stage[Mine, Settled | Failure, Settled | Failure], Generic[Mine, Settled, Failure]):
    """Stage whose records are reused if the fingerprint is the same.

    Parameters
    ----------
    store
        Known results, and storage of new ones.
    tasks
        Tasks, unless the stage plans them itself.

    Attributes
    ----------
    kind
        Kind of its records in the catalogue.
    record
        Type of the records. Other results of a task are returned but not stored.
    """

    kind: ClassVar[str]
    record: ClassVar[type]

    def __init__(self, store: Store, tasks: Sequence[Mine] = ()) -> None:
        self._store, self._tasks = store, tasks

    def plan(self) -> Sequence[Mine]:
        """Return the tasks."""
        return self._tasks

    def known(self, task: Mine, place: int) -> Settled | None:
        """Reuse the record of a task with the same fingerprint, if its files are intact."""
        earlier: Settled | None = self._store.same(
            self.kind, task.name, task.fingerprint, self.record
        )
        record = None if earlier is None else self.taken(task, earlier)
        if record is not None:
            self._store.put(self.kind, task.name, place, task.fingerprint, record)
        return record

    def taken(self, task: Mine, record: Settled) -> Settled | None:
        """Return an earlier record updated for the task; None to compute it again."""
        return record

    def linked(self, task: Mine, old: str, new: str) -> bool:
        """Link the data file of an earlier record into the new results; False if not intact."""
        return self._store.link(self.kind, task.name, old, new)

    def keep(self, task: Mine, place: int, record: Settled | Failure) -> Settled | Failure:
        """Store a record; a failed one is computed again next time."""
        if isinstance(record, self.record):
            mark = task.fingerprint if getattr(record, "done", True) else ""
            self._store.put(self.kind, task.name, place, mark, record)
        return record


def done_and_failed(came: Iterable[Settled | Notice]) -> tuple[list[Settled], list[Notice]]:
    """Split outcomes into records and notices of failures."""
    done: list[Settled] = []
    why: list[Notice] = []
    for record in came:
        if isinstance(record, Notice):
            why.append(record)
        else:
            done.append(record)
    return done, why
