"""Drafting of a dialect from an unknown raw file: its layout and the quantities of its columns."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

from tribolab.core.aliases import PathLike
from tribolab.core.errors import ConfigError, OutputError, ReadError, TribolabError, shown
from tribolab.reading.dialect.find import recognise
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.text.cells import split_name, split_row
from tribolab.reading.text.first_bytes import (
    File,
    is_results,
    is_surftest_results,
    named_values,
    peek,
    results_error,
)
from tribolab.reading.unknown.columns.labels import are_traces, side_by_side
from tribolab.reading.unknown.derivations.interpret_columns import understand
from tribolab.reading.unknown.layout.text_layout import Layout, find_layout
from tribolab.reading.unknown.model import DraftColumn, Understood
from tribolab.reading.unknown.proposal.model import SHOWN, Drafted
from tribolab.reading.unknown.proposal.questions import missing_height_unit
from tribolab.reading.unknown.proposal.show import draft_html

_LISTED = 8  # columns of a table that are named in a message


class Draft(Drafted):
    """Interpretation of an unknown file, see `Drafted`; a notebook shows it as a table."""

    def _repr_html_(self) -> str:
        return draft_html(self)


def draft_dialect(path: PathLike, name: str | None = None) -> Draft:
    r"""Draft a dialect from a raw file of an unknown instrument.

    Parameters
    ----------
    path
        The file: text, or columns with names (Excel, Parquet, Feather, HDF5, TDMS).
    name
        Name of the dialect; by default it is made from the file's name.

    Returns
    -------
    Draft
        What was understood and guessed, and the dialect as TOML. Columns whose quantity or unit is
        not known are comments in the TOML, ready to be filled in.

    Raises
    ------
    ReadError
        If the file is missing, is of no supported format, or contains no table of numbers.

    Notes
    -----
    Names are looked up in `tribolab.reading.interpret.names`; columns without a name
    are judged by their numbers, `tribolab.reading.unknown.columns.behaviour`.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "versuch.txt"
    >>> _ = file.write_text("Zeit [s];Reibkraft [N];Weg\n0,0;1,5;0,1\n0,1;1,6;0,2\n")
    >>> draft = draft_dialect(file)
    >>> draft.kind, [c.quantity for c in draft.understood.columns]
    ('run', ['time', 'friction_force', 'position'])
    >>> draft.to_fill_in
    {27: 'the unit of \'Weg\' (position), e.g. "m"'}
    """
    file = peek(path)
    name = dialect_name(file.path if name is None else name)
    with np.errstate(all="ignore"):  # an unknown file may contain any number
        return _drafted(file, name)


def _drafted(file: File, name: str) -> Draft:
    if is_results(file.head) and not _known(file):
        return _results(file, name)
    layout, understood = _understood(file)
    if understood.kind == "scan" and not any(column.used for column in understood.columns):
        understood = understood._replace(kind="table")
    draft = Draft(
        path=file.path,
        name=name,
        kind=understood.kind,
        layout=layout,
        understood=understood,
        answer="" if understood.kind != "table" else _answer(file, understood),
        cells=tuple(tuple(split_row(line, layout.delimiter)) for line in layout.rows(SHOWN)),
        known=_known(file),
    )
    if draft.kind == "table" and _is_heights(draft):
        counts = understood.columns[0].counted and understood.columns[0].unit is None
        draft = replace(draft, unsaid="count" if counts else "pitch")
        return replace(draft, answer=missing_height_unit(draft))
    return draft


def _understood(file: File) -> tuple[Layout, Understood]:
    if not file.container:
        layout = find_layout(file)
        return layout, understand(layout)
    # imported late for a quick start
    from tribolab.reading.unknown.layout.container_tables import (
        DRAFTED_FROM,
        as_held,
        layout_of_columns,
    )

    if file.container not in DRAFTED_FROM:
        raise ReadError(
            f"this is {file.format}; a dialect can be drafted from text and from columns with "
            "names only, for other formats follow an example in raw_data_schema/instruments",
            where=file.path,
        )
    layout, columns = layout_of_columns(file)
    assert layout.held is not None  # set by `layout_of_columns`
    return layout, as_held(understand(layout), columns, layout.held)


def save_draft(draft: Draft, path: PathLike, *, force: bool = False) -> Path:
    """Write a drafted dialect to a TOML file; an existing file is replaced only with `force`.

    Raises
    ------
    ConfigError
        If the file exists already, or its name does not end in ``.toml``.
    OutputError
        If the file cannot be written, or the draft has no dialect.
    """
    path = Path(path)
    if not draft.toml:
        raise OutputError(f"{path}: not written, {draft.path.name} has no dialect: {draft.answer}")
    check_target(path, force=force)
    try:
        with path.open("w" if force else "x", encoding="utf-8", newline="\n") as handle:
            handle.write(draft.toml)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {os.strerror(error.errno or 0)}") from error
    return path


def check_target(path: Path, *, force: bool = False) -> None:
    """Raise if a dialect cannot be written to a file, before the user has to answer questions.

    Raises
    ------
    ConfigError
        If the file exists already, or its name does not end in ``.toml``.
    OutputError
        If no file can have such a name.
    """
    if path.suffix != ".toml":
        raise ConfigError(f"{path}: the name of a dialect's file ends in .toml")
    try:
        there = path.exists()
    except OSError as error:  # the name is too long
        raise OutputError(f"{path}: cannot be written: {os.strerror(error.errno or 0)}") from error
    if there and not force:
        raise ConfigError(
            f"{path}: there is such a file already; --force replaces it, --output names another"
        )


def dialect_name(text: PathLike) -> str:
    """Return a valid name for a dialect, made from a file's name.

    >>> dialect_name("O-ring257_1bar.csv"), dialect_name("Größe 2.txt")
    ('o_ring257_1bar', 'gr_e_2')
    """
    stem = text.stem if isinstance(text, Path) else re.sub(r"\.\w{1,4}$", "", text)
    return re.sub(r"[^a-z0-9]+", "_", stem.lower()).strip("_") or "drafted"


def _known(file: File) -> str:
    try:
        return recognise(file.path).name
    except ReadError:  # no instrument fits, or several do
        return ""


def _is_heights(draft: Drafted) -> bool:
    """Whether a table contains heights without positions: one column, or numbered traces."""
    columns = draft.understood.columns if draft.understood else ()
    if side_by_side(list(columns)) and are_traces(list(columns)):
        return True
    if len(columns) != 1 or not columns[0].label:
        return False
    name, unit = split_name(columns[0].label)
    if unit is None and columns[0].file_unit is None:
        name, unit = split_unit(name)
    options = matches(name, columns[0].file_unit or unit, scan=True)
    return bool(options) and options[0].quantity == "height"


def as_profile(draft: Draft, pitch: str = "", unit: str | None = None) -> Draft:
    """Return the draft of heights without positions as that of a profile with a pitch.

    Parameters
    ----------
    draft
        Draft of a file with heights only, whose `unsaid` is set.
    pitch
        Distance between neighbouring heights, with its unit; "" if it is to be filled in.
    unit
        Unit of the heights; None if the file states it.
    """
    understood = draft.understood
    if understood is None:
        return draft
    heights = tuple(_as_height(column, unit) for column in understood.columns)
    whole = understood._replace(kind="scan", columns=heights, pitch=pitch)
    return replace(draft.with_understood(whole), answer="", unsaid="")


def _as_height(column: DraftColumn, unit: str | None) -> DraftColumn:
    said = unit or column.read_unit
    return column._replace(
        quantity="height",
        used=True,
        note="",
        options=(),
        unit=column.unit if said and said == column.file_unit else said or "um",
        guessed=() if said else ("height is in um",),
        fill_in="",
    )


def _answer(file: File, understood: Understood) -> str:
    """Return a description of a table that contains neither signals nor a profile."""
    # imported late for a quick start
    from tribolab.reading.scans.formats.profilometers import read_foreign

    labels = [column.label for column in understood.columns if column.label]
    if not labels:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # other tables than scans make it divide by zero
                scan = read_foreign(file.path)
        except TribolabError:
            return (
                "numbers without names, of which no column proceeds like time or a position; say "
                "in a dialect what is at which position: raw_data_schema/README.md shows how"
            )
        sizes = " x ".join(str(size) for size in scan.sizes.values())
        return (
            f"heights of a scan ({sizes} points, {scan.attrs['instrument']}); it is read without "
            "a dialect, by 'tribolab check' and under scans of a [[surface]]"
        )
    named = ", ".join(shown(label, 20) for label in labels[:_LISTED])
    named += f" and {len(labels) - _LISTED} more" if len(labels) > _LISTED else ""
    return (
        f"a table of {named}: no signals along time and no profile; if a column is a time, a "
        "position or a height, say so in its name, e.g. 'Time [s]'"
    )


def _results(file: File, name: str) -> Draft:
    lines = file.head.decode("latin-1").replace("\r", "").split("\n")
    if not is_surftest_results(file.head) and not named_values(file.head):
        answer = str(results_error(file.head, file.path))
        return Draft(path=file.path, name=name, kind="table", answer=answer, cells=())
    start = next((n for n, line in enumerate(lines) if line.startswith("// CalcResult")), 0) + 1
    rows = [line.split(";") for line in lines[start:] if line.strip()]
    if not is_surftest_results(file.head):
        rows = [list(row) for _, row in named_values(file.head)]
    return Draft(
        path=file.path,
        name=name,
        kind="table",
        answer=(
            f"{len(rows)} results of a roughness tester (name, value, unit, condition), without "
            "the profile; 'tribolab check' reads it without a dialect"
        ),
        cells=tuple(tuple(row) for row in rows[:SHOWN]),
    )
