"""Assembly of a run from the contents of its files: joined columns on one clock, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from tribolab.arrays.chunks import chosen, concatenate_parts
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError, shown
from tribolab.core.provenance import CONVENTIONS, as_text, history_line
from tribolab.core.untyped import Json
from tribolab.reading.clocks.clock import join_clocks, mended_time, recorded_at, set_time
from tribolab.reading.dialect.column_rule import FRICTION_SIGNALS
from tribolab.reading.dialect.containers import PythonReader
from tribolab.reading.dialect.find import Dialect
from tribolab.reading.dialect.formula import names_in, parse_formula
from tribolab.reading.dialect.text_form import as_written
from tribolab.reading.dialect.zero_reading import free_while_zeroed, take_zeros, zeros_of_derived
from tribolab.reading.raw.source import read_unchanged
from tribolab.reading.runs.derived import add_derived
from tribolab.reading.runs.force_ratio import keep_forces_that_agree
from tribolab.reading.runs.row_counts import row_attributes
from tribolab.reading.runs.speed import add_speed, keep_settings
from tribolab.reading.runs.two_rates import sampled_together
from tribolab.reading.si_tables.model import Content
from tribolab.reading.si_tables.read_file import read_content
from tribolab.reading.si_tables.steps import oldest_first
from tribolab.reading.si_tables.values import add_assumed, single_values, step_values, tell_assumed
from tribolab.reading.signals import Signals
from tribolab.reading.text.first_bytes import peek
from tribolab.units.quantities import QUANTITIES

LogDialects = list[tuple[Path, Dialect]]

_WITHOUT_A_FILE = "described without a file of it: compare the columns with what you know"


def gather(logs: LogDialects, zero: str | None = None) -> Signals:
    """Return the signals of one run from the files of one instrument.

    Parameters
    ----------
    logs
        The files, each with its dialect.
    zero
        Source of the zero of the friction signals; takes precedence over the dialect.

    Raises
    ------
    ReadError
        If a file does not match its dialect, or the files do not form one run.
    """
    logs = [(path, as_written(path, dialect)) for path, dialect in logs]
    dialect = logs[0][1]
    several = len(logs) > 1 and not isinstance(dialect, PythonReader)
    size = sum(peek(path).size for path, _ in logs) if several else 0
    contents = [read_content(path, dialect, size) for path, _ in logs]
    for content in contents:
        set_time(content, dialect)
    contents = [oldest_first(content) for content in contents]
    starts = [content.pieces[0].started for content in contents]
    dated = [(start, content) for start, content in zip(starts, contents, strict=True) if start]
    if len(dated) == len(contents):
        contents = [content for _, content in sorted(dated, key=lambda pair: pair[0])]
    joined = join_clocks(contents, dialect)
    columns = _columns(contents, dialect)
    if "part" in joined and "step" not in columns:
        columns["step"] = np.asarray(joined["part"])
    more, step_attrs = step_values(contents, dialect)
    columns |= more
    attrs: Json = {**single_values(contents[0], dialect), **step_attrs}
    where = "; ".join(str(content.path) for content in contents)
    mended = mended_time(columns.pop("time"), where, dialect)
    time = mended.time
    if mended.keep is not None:
        time = chosen(time, mended.keep)
        for name in columns:  # one at a time, to free the memory of removed rows
            columns[name] = chosen(columns[name], mended.keep)
    rows = len(time)
    time, columns, together = sampled_together(columns, time)
    origin = float(time[0])
    time -= origin
    rules = {column.key: column.zero for column in dialect.column if column.zero}
    if zero is not None:
        rules |= {name: zero for name in FRICTION_SIGNALS if name in columns}

    def blank(name: str) -> Mapping[str, np.ndarray]:
        return _blank(contents[0].path, name, dialect)

    units = _symbols(contents, dialect)
    attrs |= take_zeros(columns, time, rules, blank, where, units)
    of_steps = keep_settings(columns, _symbols(contents, dialect), attrs, where, dialect)
    assumed = add_assumed(attrs, dialect)
    signals = {name: columns[name] for name in rules if name in units and name in columns}
    add_derived(columns, _symbols(contents, dialect), attrs, time.size, where, dialect)
    zeros_of_derived(columns, signals, attrs)
    read = take_zeros(columns, time, _zeros_of_formulas(attrs, dialect, zero), blank, where)
    if read:
        attrs |= read | {
            "zeros_read": RunAttributes.from_attrs(attrs).zeros_read | read["zeros_read"]
        }
    tell_assumed(attrs, assumed, dialect)
    keep_forces_that_agree(columns, attrs)
    add_speed(columns, attrs, time, where, dialect, of_steps)
    attrs |= free_while_zeroed(columns, time, attrs)
    _check_normal_force(columns, contents[0], where, dialect)
    attrs |= _attributes(contents, dialect, origin)
    attrs |= row_attributes(rows, contents, mended) | together
    if "joined" in joined:
        attrs["clock_joined"] = str(joined["joined"])
    return Signals(time, columns, attrs)


def _zeros_of_formulas(attrs: Json, dialect: Dialect, zero: str | None) -> dict[str, str]:
    """Return the interval in which the zero of each computed quantity is read, by quantity."""
    rules = {rule.quantity: rule.zero for rule in dialect.derived if rule.zero}
    rules |= {name: zero for name in FRICTION_SIGNALS if zero is not None}
    derived = RunAttributes.from_attrs(attrs).derived
    return {name: text for name, text in rules.items() if name in derived}


def _blank(run: Path, name: str, dialect: Dialect) -> dict[str, np.ndarray]:
    """Return the columns of a blank run in another file, with computed quantities."""
    path = run.parent / name
    content = read_unchanged([path], lambda: read_content(path, dialect))
    set_time(content, dialect)
    columns = _columns([content], dialect)
    if dialect.derived:
        attrs: Json = dict(single_values(content, dialect))
        add_assumed(attrs, dialect)
        rows = len(columns["time"])
        add_derived(columns, _symbols([content], dialect), attrs, rows, str(path), dialect)
    return columns


def _symbols(contents: list[Content], dialect: Dialect) -> dict[str, str]:
    """Return the SI units of symbols that are used in formulas only."""
    of_steps = {
        value.name: value.si_unit
        for value in dialect.value
        if value.source == "step"
        if value.unit is not None and value.name not in QUANTITIES
    }
    return of_steps | {k: v for content in contents for k, v in content.symbols.items()}


def _columns(contents: list[Content], dialect: Dialect) -> dict[str, np.ndarray]:
    """Return the arrays of the whole run; ``step`` and ``cycle`` number its tables and files."""
    pieces = [piece for content in contents for piece in content.pieces]
    lengths = [len(piece.columns["time"]) for piece in pieces]
    names = dict.fromkeys(name for piece in pieces for name in piece.columns)
    if len(pieces) == 1:
        columns = dict(pieces[0].columns)
    else:
        columns = {
            name: concatenate_parts(
                [
                    piece.columns.get(name, np.full(length, np.nan))
                    for piece, length in zip(pieces, lengths, strict=True)
                ]
            )
            for name in names
        }
    if pieces[0].step is not None and "step" not in columns:
        columns["step"] = np.repeat([piece.step for piece in pieces], lengths).astype(np.int32)
    if len(contents) > 1:
        numbers = [n for n, content in enumerate(contents, 1) for _ in content.pieces]
        columns["cycle"] = np.repeat(numbers, lengths).astype(np.int32)
    return columns


def _check_normal_force(
    columns: dict[str, np.ndarray], content: Content, where: str, dialect: Dialect
) -> None:
    force = columns.get("normal_force")
    if force is None or np.nanmax(force) > 0:
        return
    raise ReadError(
        f"{where}: the normal force ('{shown(content.labels['normal_force'])}') is nowhere above "
        f"zero (greatest {np.nanmax(force):.4g} N); if the instrument counts pressing as negative, "
        f"say sign = -1 for the column in the dialect '{dialect.name}'"
    )


_TIME_FROM = {
    "column": "recorded",
    "period": "recorded",
    "rate": "sample rate",
    "position": "position and a stated speed",
    "none": "row number",
}


def _speed_from(dialect: Dialect) -> str:
    """Return the source of the sliding speed; "stated" if a formula uses stated values only."""
    formulas = [rule.formula for rule in dialect.derived if rule.quantity == "sliding_velocity"]
    if not formulas:
        return dialect.speed.source
    texts = {rule.name for rule in dialect.value}
    stated = all(names_in(parse_formula(formula)) <= texts for formula in formulas)
    return "stated" if stated else "formula"


def _attributes(contents: list[Content], dialect: Dialect, origin: float) -> Json:
    """Return provenance and other information on the run's files."""
    # imported late: looks up the installed package
    from tribolab.version import __version__

    labels = {name: label for content in contents for name, label in content.labels.items()}
    unused = dict.fromkeys(name for content in contents for name in content.not_used)
    attrs: Json = {
        "source": "; ".join(as_text(content.path.name) for content in contents),
        "source_sha256": "; ".join(content.sha256 for content in contents),
        "tribolab_version": __version__,
        "history": history_line(f"read as {dialect.name}"),
        "Conventions": CONVENTIONS,
        "instrument": dialect.name,
        **({} if dialect.from_file else {"instrument_note": _WITHOUT_A_FILE}),
        "columns_used": labels,
        "columns_not_used": "; ".join(unused),
        "time_origin_s": origin,
        "time_source": _TIME_FROM[dialect.time.source],
        "speed_from": _speed_from(dialect),
    }
    attrs |= {"rows_are": dialect.rows.are} if dialect.rows.are != "samples" else {}
    recorded = recorded_at(contents[0].pieces[0].started, origin, dialect)
    if recorded is not None:
        attrs["recorded_at"] = recorded.isoformat()
    for column in dialect.column:
        if column.key in labels:
            attrs.update(column.attributes)
    turned = [c.key for c in dialect.column if c.sign == -1 and c.key in labels]
    attrs |= {"counted_negative": ", ".join(turned)} if turned else {}
    if stated := dialect.uncertainty.plain():
        attrs["uncertainty"] = stated
    for content in contents:
        attrs.update(content.notes)
    return attrs
