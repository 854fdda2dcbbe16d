"""Stages whose records stand in the catalogue as they are, under the name of their task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar, Generic, Protocol, TypeVar

from tribolab.campaign.engine.stage import Stage
from tribolab.campaign.store.catalogue import Store
from tribolab.records.parts import Notice


class Named(Protocol):
    """A task with the name of its record and the checksum of all that shapes it."""

    @property
    def name(self) -> str:
        """Of its record in the catalogue."""

    @property
    def fingerprint(self) -> str:
        """Another one when anything is that the record follows from."""


Mine = TypeVar("Mine", bound=Named)
Settled = TypeVar("Settled")
Failure = TypeVar("Failure")


class Recorded(Stage[Mine, Settled | Failure, Settled | Failure], Generic[Mine, Settled, Failure]):
    """A stage whose records are taken over where the fingerprint is the same.

    Parameters
    ----------
    store
        What is known, and where it is written down.
    tasks
        What is to be done, unless the stage finds it out itself.

    Attributes
    ----------
    kind
        Of its records in the catalogue.
    record
        What they are. What came of a task instead is handed on, and written down nowhere.
    """

    kind: ClassVar[str]
    record: ClassVar[type]

    def __init__(self, store: Store, tasks: Sequence[Mine] = ()) -> None:
        self._store, self._tasks = store, tasks

    def plan(self) -> Sequence[Mine]:
        """Return what is to be done."""
        return self._tasks

    def known(self, task: Mine, place: int) -> Settled | None:
        """Take over the record of a task that is made of the same, if its files are there."""
        earlier: Settled | None = self._store.same(
            self.kind, task.name, task.fingerprint, self.record
        )
        record = None if earlier is None else self.taken(task, earlier)
        if record is not None:
            self._store.put(self.kind, task.name, place, task.fingerprint, record)
        return record

    def taken(self, task: Mine, record: Settled) -> Settled | None:
        """Return an earlier record as it is now, its files among the new; None: done anew."""
        return record

    def linked(self, task: Mine, old: str, new: str) -> bool:
        """Have the data file of an earlier record among the new ones; False if it is not whole."""
        return self._store.link(self.kind, task.name, old, new)

    def keep(self, task: Mine, place: int, record: Settled | Failure) -> Settled | Failure:
        """Write a record down; one that says of itself that it failed is done anew next time."""
        if isinstance(record, self.record):
            mark = task.fingerprint if getattr(record, "done", True) else ""
            self._store.put(self.kind, task.name, place, mark, record)
        return record


def done_and_failed(came: Iterable[Settled | Notice]) -> tuple[list[Settled], list[Notice]]:
    """Return what was done, and why the rest was not."""
    done: list[Settled] = []
    why: list[Notice] = []
    for record in came:
        if isinstance(record, Notice):
            why.append(record)
        else:
            done.append(record)
    return done, why
