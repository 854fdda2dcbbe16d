"""Standard output and error of the command line, and clean exit after signals."""

from __future__ import annotations

import codecs
import contextlib
import io
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from types import FrameType
from typing import NoReturn

from tribolab.core.errors import harmless

_PLAIN = str.maketrans(
    {"–": "-", "−": "-", "±": "+-", "µ": "u", "μ": "u", "×": "x", "…": "...", "’": "'", "·": "*"}
    | {"²": "2", "³": "3", "η": "eta", "σ": "sigma", "°": " deg ", "≤": "<=", "≥": ">="}
)
_ERRORS = "tribolab_plain"
_Hook = Callable[["sys.UnraisableHookArgs"], object]
_RESEND_DELAY = 0.01  # s before a signal is sent again; compiled code has returned by then
_UNWRITABLE = 3  # exit code, as for results that cannot be written


def say(text: str, *, to_stderr: bool = False) -> None:
    """Print a line; control characters are escaped, so that a file cannot steer the terminal."""
    print(harmless(text), file=sys.stderr if to_stderr else sys.stdout, flush=True)


class Terminated(KeyboardInterrupt):
    """Exception raised by SIGTERM or SIGHUP, so that the program cleans up as after Ctrl-C."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number, self.code = number, 128 + number


class _Pipe(io.RawIOBase):
    """Stream to a file descriptor that ignores a closed pipe.

    Hence ``| head -1`` shortens the output, but the command completes with its exit code. Other
    errors, e.g. a full disk, are in `failed`.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self.failed: OSError | None = None

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._number

    def isatty(self) -> bool:
        return os.isatty(self._number)

    def write(self, data: object) -> int:
        view = memoryview(data)  # type: ignore[arg-type]
        try:
            return os.write(self._number, view)
        except OSError as error:
            self.failed = None if isinstance(error, BrokenPipeError) else error
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._number)
            os.close(nowhere)
            return view.nbytes


def _plain(error: UnicodeError) -> tuple[str, int]:
    """Return an ASCII replacement for characters that the encoding of a stream does not have."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object[error.start : error.end].translate(_PLAIN)
    return text.encode("ascii", "backslashreplace").decode("ascii"), error.end


@contextlib.contextmanager
def prepared() -> Iterator[None]:
    """Configure stdout and stderr for all text, and clean up on SIGTERM and SIGHUP.

    If standard output could not be written, e.g. to a full disk, the exit code is 3. Streams
    replaced by others, e.g. by tests and notebooks, are left unchanged.
    """
    codecs.register_error(_ERRORS, _plain)
    # numpy's warnings are not needed, because checks report damaged numbers
    warnings.filterwarnings("ignore", category=RuntimeWarning)
    warnings.formatwarning = lambda message, *_, **__: f"tribolab: {message}\n"
    pipes = {}
    for name, number in (("stdout", 1), ("stderr", 2)):
        stream = getattr(sys, name)
        if stream is None:  # closed by the shell
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115, PTH123 - as long as we live
        elif stream is getattr(sys, f"__{name}__"):
            stream.flush()
            pipes[name] = _Pipe(number)
            opened = io.TextIOWrapper(
                io.BufferedWriter(pipes[name]),
                encoding=stream.encoding,
                errors=_ERRORS,
                line_buffering=stream.isatty() or number == 2,
            )
            setattr(sys, name, opened)
    before = {}
    ignored = sys.unraisablehook
    sys.unraisablehook = partial(_resend, ignored)
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_DFL:  # nohup ignores SIGHUP on purpose
            before[number] = signal.signal(number, _stop)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        sys.unraisablehook = ignored
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        if "stdout" in pipes and (error := pipes["stdout"].failed):
            say(f"tribolab: standard output cannot be written ({error.strerror})", to_stderr=True)
            raise SystemExit(_UNWRITABLE) from None


def _stop(number: int, frame: FrameType | None) -> NoReturn:
    signal.signal(number, signal.SIG_IGN)  # a second signal must not interrupt the cleanup
    raise Terminated(number)


def _resend(before: _Hook, unraisable: sys.UnraisableHookArgs) -> None:
    """Send a signal again if compiled code has swallowed the exception that it raised."""
    error = unraisable.exc_value
    if not isinstance(error, KeyboardInterrupt):
        before(unraisable)
        return
    number = signal.SIGINT
    if isinstance(error, Terminated):
        number = signal.Signals(error.number)
        signal.signal(number, _stop)
    send: Callable[[], object] = partial(signal.raise_signal, number)
    if hasattr(signal, "pthread_kill"):  # wakes a waiting thread
        send = partial(signal.pthread_kill, threading.get_ident(), number)
    threading.Timer(_RESEND_DELAY, send).start()
