"""Commands that inspect raw files."""

from __future__ import annotations

import contextlib
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tribolab.app.progress import progress_bars
from tribolab.app.questions.stated import (
    LoadOption,
    RadiusOption,
    RateOption,
    SpeedOption,
    Stated,
    describe_with,
)
from tribolab.app.reported import (
    UNREADABLE,
    Debug,
    InstrumentOption,
    Jobs,
    Quiet,
    leaving,
    reported,
)
from tribolab.app.streams import say

if TYPE_CHECKING:
    from concurrent.futures import Executor

_MIN_FILES_IN_PARALLEL = 12  # number of files above which other processes are worthwhile


def check(
    files: Annotated[
        list[Path],
        typer.Argument(
            help="Files of runs (two logs may belong to one run) or scans, folders, or campaign "
            "files."
        ),
    ],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON document to standard output.")
    ] = False,
    fail_on: Annotated[
        str, typer.Option(help="Lowest status that gives exit code 1: suspect, fail or never.")
    ] = "fail",
    instrument: InstrumentOption = None,
    load: LoadOption = None,
    radius: RadiusOption = None,
    speed: SpeedOption = None,
    rate: RateOption = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Also show notes and passed checks.")
    ] = False,
    repeats: Annotated[
        bool | None,
        leaving(
            "--repeats/--no-repeats", "files whose names differ only in the last number are repeats"
        ),
    ] = None,
    notes: Annotated[bool, leaving("--notes", "write --verbose")] = False,
    everything: Annotated[bool, leaving("--all", "write --verbose")] = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Check whether runs and scans are usable, while the sample is still mounted.

    Reports each problem with its place, severity and remedy. Nothing is written. For a folder or a
    campaign file, its raw files are checked; limits and segments of a campaign apply in `tribolab
    run`.

        tribolab check raw/friction/sb-r_dry_31N_01_*.csv

        tribolab check raw/profiles/*.csv --json --fail-on suspect
    """
    with reported(debug):
        # imported late for a quick start
        from tribolab.app.quick import importing, plain_arrays_only

        with importing():
            plain_arrays_only()
            # imported late for a quick start
            from tribolab.app import check_output, checks

        stated = Stated.of(load, radius, speed, rate)
        parts = checks.raw_files_of(files)
        files = [file for part, _ in parts for file in part]
        instrument = instrument or describe_with(stated, files)
        code = check_output.code_of([], fail_on)  # a wrong `fail_on` must raise before the work
        with progress_bars(quiet) as progress, _pool(jobs, files) as pool:
            checked = [
                one
                for part, named in parts
                for one in checks.check_files(
                    part, instrument or named, repeats=repeats, executor=pool, progress=progress
                )
            ]
        code = check_output.code_of(checked, fail_on)
        if as_json:
            say(check_output.as_json(checked, fail_on))
        else:
            check_output.show(checked, notes=notes, everything=verbose or everything)
    raise typer.Exit(code)


def info(
    files: Annotated[list[Path], typer.Argument(help="Raw files.")],
    instrument: InstrumentOption = None,
    load: LoadOption = None,
    radius: RadiusOption = None,
    speed: SpeedOption = None,
    rate: RateOption = None,
    write: Annotated[
        Path | None,
        typer.Option(
            help="Write a dialect (TOML): a description of the files of an unknown instrument.",
            show_default=False,
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Overwrite an existing .toml file.")
    ] = False,
    ask: Annotated[
        bool | None,
        typer.Option(
            "--ask/--no-ask",
            help="With --write: ask for the meaning of columns; Enter accepts the suggestion.",
            show_default="in a terminal",
        ),
    ] = None,
    jobs: Jobs = None,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Show how raw files are understood, before anything is computed.

    With --write it asks for missing information, describes the instrument in a TOML file, tests
    that on the files, and names the lines to be completed. Columns that are missing in some of the
    files are optional. The raw files are never changed.

        tribolab info raw/friction/*.csv

        tribolab info odd.txt --write my_tribometer.toml

        tribolab info odd.txt --instrument my_tribometer.toml
    """
    with reported(debug):
        if write is not None:
            from tribolab.app.info.describing import describe  # imported late for a quick start

            describe(files, write, write.stem, force=force, ask=ask)
            return
        options = {
            "instrument": instrument,
            "load": load,
            "radius": radius,
            "speed": speed,
            "rate": rate,
        }
        instrument = instrument or describe_with(Stated.of(load, radius, speed, rate), files)
        # imported late for a quick start
        from tribolab.app.quick import importing

        with importing():
            # imported late for a quick start
            from tribolab.app.info.file_info import Descriptions
            from tribolab.campaign.engine.stage import perform
            from tribolab.reading.moduli import is_modulus_file

        with progress_bars(quiet) as progress, _pool(jobs, files) as pool:
            described = perform(Descriptions(files, instrument), pool, progress)
        for description in described:
            if description.error:
                say(f"tribolab: {description.error}", to_stderr=True)
            else:
                say("\n".join(description.lines))
        if instrument is None and all(description.error for description in described):
            from tribolab.app.info.describing import describe_by_questions  # imported late

            if describe_by_questions(files, keep=False) is not None:
                raise typer.Exit
        alone = len(described) == 1 and not described[0].error
        if alone and not is_modulus_file(described[0].file):
            file = shlex.quote(str(described[0].file))
            file += "".join(f" --{name} {shlex.quote(x)}" for name, x in options.items() if x)
            say(f"next: tribolab check {file} (is it usable?), tribolab run {file} (its results)")
    raise typer.Exit(UNREADABLE if any(description.error for description in described) else 0)


def dialect(
    files: Annotated[list[Path], typer.Argument(help="Raw files of one unknown instrument.")],
    output: Annotated[Path | None, typer.Option("--output", "-o")] = None,
    name: Annotated[str | None, typer.Option()] = None,
    force: Annotated[bool, typer.Option("--force")] = False,
    ask: Annotated[bool | None, typer.Option("--ask/--no-ask")] = None,
    debug: Debug = False,
) -> None:
    """Describe an unknown instrument: as `tribolab info FILE --write NAME.toml`."""
    with reported(debug):
        from tribolab.app.info.describing import describe  # imported late for a quick start

        describe(files, output, name, force=force, ask=ask)


def _pool(
    jobs: int | None, files: Sequence[Path]
) -> contextlib.AbstractContextManager[Executor | None]:
    """Return worker processes for many files; a few files are read faster in this process."""
    # imported late for a quick start
    from tribolab.app.needed import FILES
    from tribolab.campaign.engine.executor import workers

    jobs = 1 if jobs is None and len(files) < _MIN_FILES_IN_PARALLEL else jobs
    return workers(jobs, modules=FILES)
