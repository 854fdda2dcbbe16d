"""One engine does every kind of work: known is taken over, failures are recorded, order holds."""

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from tribolab.campaign.engine.stage import Stage, begun, perform
from tribolab.core.errors import OutputError


class Squares(Stage):
    """Squares numbers; it refuses seven, cannot write thirteen, and knows what it is told."""

    name = "squares"

    def __init__(self, tasks, known=()):
        self.tasks, self.told, self.kept = tasks, known, []

    def plan(self):
        return self.tasks

    def known(self, task, place):
        return f"known {task}" if task in self.told else None

    def order(self, tasks):
        return sorted(tasks, key=lambda pair: -pair[1])  # the largest first

    @staticmethod
    def work(task):
        if task == 13:
            raise OutputError("the disk is full")
        if task == 7:
            raise ZeroDivisionError("seven")
        return task**2

    def failed(self, task, error):
        return f"{type(error).__name__}: {error}"

    def keep(self, task, place, record):
        self.kept.append((place, record))
        return record


@pytest.fixture(params=["here", "threads"])
def executor(request):
    if request.param == "here":
        yield None
    else:
        with ThreadPoolExecutor(3) as threads:
            yield threads


def test_answers_stand_in_the_order_of_the_plan_whichever_came_first(executor):
    told = []
    stage = Squares([3, 9, 7, 1, 5], known={9, 5})
    came = perform(stage, executor, lambda *call: told.append(call))
    assert came == [9, "known 9", "ZeroDivisionError: seven", 1, "known 5"]
    # only what was done is kept, at its place
    assert sorted(stage.kept, key=lambda pair: pair[0]) == [
        (0, 9),
        (2, "ZeroDivisionError: seven"),
        (3, 1),
    ]
    assert told == [("squares", done, 5) for done in (2, 3, 4, 5)]


def test_work_begins_in_the_order_of_the_stage():
    stage = Squares([3, 1, 8])
    assert perform(stage, None, lambda *_: None) == [9, 1, 64]
    assert [place for place, _ in stage.kept] == [2, 0, 1]


class Knocking(Squares):
    """Says that it works."""

    heard = threading.Event()

    @staticmethod
    def work(task):
        Knocking.heard.set()
        return task


def test_what_was_begun_is_worked_on_before_anyone_waits_for_it():
    stage = Knocking([3, 9], known={9})
    with ThreadPoolExecutor(1) as threads:
        wait = begun(stage, threads)
        assert Knocking.heard.wait(10)
        assert not stage.kept  # written down by whoever waits
        assert wait() == [3, "known 9"]


def test_results_that_cannot_be_written_end_the_campaign(executor):
    stage = Squares([2, 13, 4])
    with pytest.raises(OutputError, match="the disk is full"):
        perform(stage, executor, lambda *_: None)


def test_nothing_to_do_is_done(executor):
    assert perform(Squares([]), executor, lambda *_: None) == []
