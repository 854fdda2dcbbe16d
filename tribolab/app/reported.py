"""Options common to several commands, and conversion of errors to messages and exit codes."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator
from typing import Annotated, Any, NoReturn, TypeVar

import typer

from tribolab.app.streams import Terminated, say
from tribolab.core.errors import ConfigError, TribolabError, UnitError

USAGE, UNREADABLE, _INTERRUPTED = 2, 3, 130

Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]
InstrumentOption = Annotated[
    str | None,
    typer.Option(
        "--instrument",
        "-i",
        help="Name of an instrument, or the .toml or .py file that reads its files.",
        show_default="recognised from the files",
    ),
]

Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Do not show progress bars.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        "--jobs", "-j", min=1, help="Number of processes.", show_default="one per processor"
    ),
]
_Given = TypeVar("_Given")


def leaving(name: str, instead: str) -> Any:
    """Return a deprecated option: it still works, with a warning, but is hidden in --help.

    Parameters
    ----------
    name
        Name of the option; for a switch both names, e.g. ``--repeats/--no-repeats``.
    instead
        Replacement in words.
    """

    def warned(context: typer.Context, option: typer.CallbackParam, given: _Given) -> _Given:
        source = context.get_parameter_source(option.name or "")
        if source is not None and source.name == "COMMANDLINE":
            _warn_of(name, instead)
        return given

    return typer.Option(name, hidden=True, callback=warned)


def renamed(command: Callable[..., None], old: str, new: str) -> Callable[..., None]:
    """Return a command for its old name, with a warning that states the new name."""

    @functools.wraps(command)
    def under_old_name(**given: Any) -> None:
        _warn_of(f"'tribolab {old}'", f"write 'tribolab {new}'")
        command(**given)

    return under_old_name


def _warn_of(old: str, instead: str) -> None:
    say(f"tribolab: {old} will be removed in the next release: {instead}", to_stderr=True)


@contextlib.contextmanager
def reported(debug: bool, audience: str = "terminal") -> Iterator[None]:
    """Print any error in this context as a short message, and exit with the code of this error."""
    try:
        yield
    except (ConfigError, UnitError) as error:
        fail(error.message_for(audience), USAGE, debug)
    except TribolabError as error:
        fail(error.message_for(audience), UNREADABLE, debug)
    except KeyboardInterrupt as stop:
        code = stop.code if isinstance(stop, Terminated) else _INTERRUPTED
        fail("interrupted; earlier results are unchanged", code, debug)
    except (typer.Exit, BrokenPipeError):
        raise
    except typer.Abort:
        fail("stopped at an unanswered question; nothing was written", _INTERRUPTED, debug)
    except Exception as error:  # a bug: one line, with a traceback on request
        # imported late for a quick start
        from tribolab.core.wording import explain

        fail(f"{explain(error)[0]} (--debug shows where)", UNREADABLE, debug)


def fail(message: str, code: int, debug: bool) -> NoReturn:
    """Print an error message to stderr and exit; raise the original error if `debug`."""
    if debug:
        raise
    say(f"tribolab: {message}", to_stderr=True)
    raise typer.Exit(code) from None
