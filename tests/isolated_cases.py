"""Functions that run in a child process, some of which end badly."""

import ctypes
import os
from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.raw.opening import isolated


@isolated()
def read_bytes(path: Path, times: int = 1):
    return {"pid": os.getpid(), "text": path.read_text(), "values": np.arange(4.0 * times)}


@isolated()
def crash(path: Path):
    ctypes.string_at(0)


@isolated()
def fill_memory(path: Path):
    return len(b"x" * (64 << 30))


@isolated()
def write_too_much(path: Path):
    return np.zeros(40_000_000)


@isolated()
def never_end(path: Path):
    while True:
        pass


@isolated()
def leave_a_trace(path: Path):
    path.with_name("trace").write_text("was called")


@isolated()
def complain(path: Path):
    raise ReadError("no table", where=path, cure="describe it")


@isolated("a_library_that_is_not_there")
def need(path: Path):
    return 1


class Sly:
    def __reduce__(self):
        return os.system, ("touch /tmp/tribolab-was-here",)


@isolated()
def answer_with_a_command(path: Path):
    return Sly()


@isolated()
def meet_the_unexpected(path: Path):
    return [][0]
