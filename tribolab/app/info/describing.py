"""Description of unknown instruments, from their files and from answers in a terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import count
from pathlib import Path

import typer

from tribolab.app.console import console
from tribolab.app.questions.asking import ask_about
from tribolab.app.questions.dialect import try_on
from tribolab.app.reported import UNREADABLE, fail
from tribolab.app.streams import say
from tribolab.reading.unknown.proposal.draft import (
    Draft,
    as_profile,
    check_target,
    draft_dialect,
    save_draft,
)
from tribolab.reading.unknown.proposal.show import print_draft, print_next, print_signals


def describe(
    files: Sequence[Path], target: Path | None, name: str | None, *, force: bool, ask: bool | None
) -> None:
    """Write a description of the instrument of some files, test it, and print the next steps.

    Parameters
    ----------
    files
        Files of one instrument.
    target, name
        File of the description, and the name in it; by default after the first file.
    force
        Whether to replace an existing description.
    ask
        Whether to ask for missing information; None asks in a terminal.
    """
    draft = draft_dialect(files[0], name)
    target = target or Path(f"{draft.name}.toml")
    asking = ask or (ask is None and is_terminal())
    print_draft(draft, console(), rows=not asking)
    if draft.dialect is not None:
        check_target(target, force=force)
    if asking:
        draft = _asked(draft)
    if draft.unsaid == "pitch":
        check_target(target, force=force)
        draft = as_profile(draft)
    if draft.dialect is None:
        why = draft.answer or (
            "the units of its columns are not stated; run this in a terminal to answer questions"
        )
        fail(f"{files[0]}: no dialect is written: {why}", UNREADABLE, debug=False)
    _write(files, draft, target, force=force)
    print_next(draft, target, console())


def describe_by_questions(files: Sequence[Path], *, keep: bool) -> Path | None:
    """Ask questions about an unknown instrument in a terminal, and write its description.

    Parameters
    ----------
    files
        Raw files.
    keep
        Whether to write the description without asking for its path.

    Returns
    -------
    Path or None
        Path of the description; None without a terminal or open questions, or if it is discarded.
    """
    if not is_terminal() or not files or not all(map(_leaves_open, files)):
        return None
    draft = draft_dialect(files[0])
    print_draft(draft, console(), rows=False)
    draft = _asked(draft)
    if draft.dialect is None:
        return None
    names = (f"{draft.name}{'' if n == 1 else f'_{n}'}.toml" for n in count(1))
    target = next(name for name in names if not Path(name).exists())
    if not keep:
        target = _prompt("file name for this description? (- to discard it)", target).strip()
        if target == "-":
            return None
    check_target(Path(target))
    _write(files, draft, Path(target))
    return Path(target)


def is_terminal() -> bool:
    """Whether questions can be asked in a terminal."""
    return sys.stdin.isatty() and sys.stdout.isatty()


def _leaves_open(path: Path) -> bool:
    # imported late for a quick start
    from tribolab.reading.kinds import kind_of
    from tribolab.reading.moduli import is_modulus_file
    from tribolab.reading.unknown_run import draft_of, left_open

    if not path.is_file() or path.suffix == ".toml" or kind_of(path) != "unknown":
        return False
    draft = None if is_modulus_file(path) else draft_of(path)
    return draft is not None and left_open(draft) is not None


def _asked(draft: Draft) -> Draft:
    asked = ask_about(draft, _prompt, say)
    print_signals(asked, console())
    return asked


def _write(files: Sequence[Path], draft: Draft, target: Path, *, force: bool = False) -> None:
    written = save_draft(draft, target, force=force)
    for line in try_on(files, written, draft.kind):
        say(line)


def _prompt(question: str, default: str) -> str:
    return str(typer.prompt(question, default=default))
