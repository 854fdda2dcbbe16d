"""Tables that are written otherwise than a row for each moment: turned, clocked apart, touching."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from tribolab.reading.raw.unit_endings import is_unit
from tribolab.reading.text.cells import split_name, split_row

_MARKS = ("\t", ";", ",", "whitespace")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?")
_NO_VALUE = re.compile(r"(?:nan|null|n/?a|-{1,3})?", re.IGNORECASE)
_WIDE = 30  # numbers of a signal that stands in a row
_FEWEST = 12  # rows that tell
_TELLING = 400  # rows that tell
_HAS_MARK = re.compile(r"\d[.,]\d")
_LONGEST = 4000  # characters of a line of names of columns that touch
_ROW = re.compile(r"[-+ .\deE]+")
_ABOVE = 4  # lines above the first row in which names stand
_CLOCK = re.compile(
    r"t[\s_#.]{0,2}\d{0,2}"  # and no T, which is a temperature
    r"|(?i:(?:elapsed )?time|zeit\w*|temps|tiempo|tempo|czas|[cč]as|tid|tijd|aika|zaman|id[őo]"
    r"|время|час|时间|時間|時刻|시간)(?:[\W_\d].*)?|.*[\s_](?i:time|zeit|temps|tiempo|tempo)"
)
_TIMES = frozenset(("s", "sec", "ms", "us", "µs", "μs", "min", "h"))


def signals_in_rows(lines: Sequence[str]) -> bool:
    """Whether each signal is a row: its name, perhaps its unit, and then its numbers.

    Parameters
    ----------
    lines
        The first ones of a file.
    """
    return _turned_mark(lines) != ""


def turned(lines: list[str]) -> list[str]:
    """Return lines in which each signal that is a row is a column.

    Parameters
    ----------
    lines
        Those of the whole file.

    Examples
    --------
    >>> rows = [["t", "s", *map(str, range(40))], ["F", "N", *map(str, range(40, 80))]]
    >>> turned(["Sample;A", *(";".join(row) for row in rows)])[:3]
    ['Sample;A', 't [s];F [N]', '0;40']
    """
    mark = _turned_mark(lines)
    if not mark:
        return lines
    signals = {n: signal for n, line in enumerate(lines) if (signal := _signal(line, mark))}
    length = Counter(len(numbers) for _, numbers in signals.values()).most_common(1)[0][0]
    kept = {n: signal for n, signal in signals.items() if len(signal[1]) == length}
    out = "\t" if mark == "whitespace" else mark
    names = [name for name, _ in kept.values()]
    rows = zip(*(numbers for _, numbers in kept.values()), strict=True)
    others = [line for n, line in enumerate(lines) if n not in signals and line.strip()]
    return [*others, out.join(names), *(out.join(row) for row in rows)]


def _turned_mark(lines: Sequence[str]) -> str:
    filled = [line for line in lines if line.strip()][:_TELLING]
    for mark in _MARKS:
        signals = [_signal(line, mark) for line in filled]
        told = [signal for signal in signals if signal]
        if len(told) < 2:
            continue
        lengths = Counter(len(numbers) for _, numbers in told)
        often = max(lengths.values())
        # the last row of what is looked at may be cut
        if often >= max(2, len(told) - 1) and len({name for name, _ in told}) == len(told):
            return mark
    return ""


def _signal(line: str, mark: str) -> tuple[str, list[str]] | None:
    """Return the name of a signal, with its unit in brackets, and its numbers."""
    if len(line) < 2 * _WIDE:
        return None
    cells = split_row(line, mark)
    while cells and not cells[-1]:
        cells.pop()
    first = next((n for n, cell in enumerate(cells) if _NUMBER.fullmatch(cell)), 0)
    numbers = cells[first:]
    if not first or len(numbers) < _WIDE or (mark != "whitespace" and first > 3):
        return None
    if not all(_NUMBER.fullmatch(cell) or _NO_VALUE.fullmatch(cell) for cell in numbers):
        return None
    words = [cell for cell in cells[:first] if cell]
    if not words or not any(map(str.isalpha, words[0])):
        return None
    if len(words) > 1 and split_name(words[-1])[0]:
        words = [*words[:-1], f"[{words[-1]}]"]
    return " ".join(words), numbers


def groups_with_clocks(cells: Sequence[str]) -> list[list[int]]:
    """Return the places of columns that have a column of time of their own before them.

    Parameters
    ----------
    cells
        The names above the numbers.

    Examples
    --------
    >>> groups_with_clocks(["t1 [s]", "F [N]", "t2 [s]", "x [mm]"])
    [[0, 1], [2, 3]]
    >>> groups_with_clocks(["Time", "F", "x"]), groups_with_clocks(["t", "F", "T_oil", "x"])
    ([], [])
    """
    groups: list[list[int]] = []
    for place, cell in enumerate(cells):
        if cell and _is_clock(cell):
            groups.append([place])
        elif groups and cell:
            groups[-1].append(place)
        elif cell:
            return []
    return groups if len(groups) > 1 and all(len(group) > 1 for group in groups) else []


def _is_clock(cell: str) -> bool:
    name, unit = split_name(cell)
    return _CLOCK.fullmatch(name) is not None and (unit is None or unit.lower() in _TIMES)


def rises(cells: Sequence[str]) -> bool:
    """Whether numbers of a column go on, as those of a clock do; what is empty does not count.

    >>> rises(["0", "0.1", "0.2", ""]), rises(["21.0", "20.9", "21.0"])
    (True, False)
    """
    told = np.array([_value(cell, "," in cell) for cell in cells])
    steps = np.diff(told[np.isfinite(told)])
    return bool(steps.size and (steps >= 0).mean() > 0.95 and (steps > 0).any())


def on_one_clock(lines: list[str], delimiter: str) -> list[str]:
    """Return lines whose columns are at the times of the group that has most of them.

    Parameters
    ----------
    lines
        Those of the whole file.
    delimiter
        What parts the cells.

    Notes
    -----
    Numbers of the other groups lie on the straight line between their own.
    """
    first = _first_row(lines, delimiter)
    for place in range(first - 1, max(first - _ABOVE, 0) - 1, -1):
        names = split_row(lines[place], delimiter)
        if groups := groups_with_clocks(names):
            break
    else:
        return lines
    body = [split_row(line, delimiter) for line in lines[first:] if line.strip()]
    body = [row + [""] * (len(names) - len(row)) for row in body]
    comma = any("," in cell for row in body[:_TELLING] for cell in row) and delimiter != ","
    numbers = np.array([[_value(c, comma) for c in row[: len(names)]] for row in body])
    known = [np.isfinite(numbers[:, group[0]]) for group in groups]
    main = max(range(len(groups)), key=lambda k: (known[k].sum(), -k))
    at = numbers[known[main], groups[main][0]]
    order = [groups[main][0], *(place for group in groups for place in group[1:])]
    columns = [at]
    for k, group in enumerate(groups):
        for column in group[1:]:
            own = known[k] & np.isfinite(numbers[:, column])
            when, values = numbers[own, group[0]], numbers[own, column]
            if k == main:
                columns.append(numbers[known[main], column])
            elif when.size:
                rank = np.argsort(when, kind="stable")
                columns.append(np.interp(at, when[rank], values[rank], np.nan, np.nan))
            else:
                columns.append(np.full(at.size, np.nan))
    mark = "\t" if delimiter == "whitespace" else delimiter
    heads = [split_row(line, delimiter) for line in lines[place:first] if line.strip()]
    heads[0][order[0]] = re.sub(r"(?<=[^\W\d])[\s_#.]*\d+(?=\s*(?:[\[(]|$))", "", names[order[0]])
    table = [mark.join(row[k] if k < len(row) else "" for k in order) for row in heads]
    table += [mark.join(_text(v, comma) for v in row) for row in zip(*columns, strict=True)]
    return [*lines[:place], *table]


def joined_names(above: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return names that the row above tells apart; as they are where it does not.

    Parameters
    ----------
    above, names
        Cells of both rows; an empty one above belongs to the group before.

    Examples
    --------
    >>> joined_names(["", "Tangential", "", "Normal", ""], ["t", "Force", "T", "Force", "x"])
    ['t', 'Tangential Force', 'T', 'Normal Force', 'x']
    >>> joined_names(["Test", "12"], ["t", "F"])
    ['t', 'F']
    """
    filled = [name for name in names if name]
    if len(set(filled)) == len(filled) or sum(map(bool, above)) < 2 or len(above) > len(names):
        return list(names)
    if any(_NUMBER.fullmatch(cell) for cell in above) or all(map(is_unit, filled)):
        return list(names)
    if 2 * len(above) < len(names):  # a line of settings, which does not reach over the columns
        return list(names)
    groups, group = [], ""
    for cell in [*above, *[""] * (len(names) - len(above))]:
        group = cell or group
        groups.append(group)
    joined = [
        f"{group} {name}".strip() if filled.count(name) > 1 else name
        for group, name in zip(groups, names, strict=True)
    ]
    filled = [name for name in joined if name]
    return joined if len(set(filled)) == len(filled) else list(names)


def with_joined_names(lines: list[str], delimiter: str) -> list[str]:
    """Return lines in which names of two rows are in one.

    Parameters
    ----------
    lines
        Those of the whole file.
    delimiter
        What parts the cells.
    """
    first = _first_row(lines, delimiter)
    for place in range(first - 1, max(first - _ABOVE, 1) - 1, -1):
        names = split_row(lines[place], delimiter)
        joined = joined_names(split_row(lines[place - 1], delimiter), names)
        if joined != names:
            return [*lines[: place - 1], delimiter.join(joined), *lines[place + 1 :]]
    return lines


def _first_row(lines: Sequence[str], delimiter: str) -> int:
    for number, line in enumerate(lines):
        cells = [cell for cell in split_row(line, delimiter) if cell]
        numbers = sum(_NUMBER.fullmatch(cell) is not None for cell in cells)
        if len(cells) > 1 and numbers > 0.5 * len(cells):
            return number
    return 0


def fields_that_touch(lines: Sequence[str]) -> list[int]:
    """Return where the columns of a table end whose numbers touch; empty where blanks part them.

    Parameters
    ----------
    lines
        Those of a file: right above the rows stand names or units, each above the end (or all
        above the beginning) of its column.
    """
    found = _fields(lines)
    return found[1] if found else []


def parted(lines: list[str]) -> list[str]:
    r"""Return lines with tabs between the columns of a table whose numbers touch.

    Parameters
    ----------
    lines
        Those of the whole file.

    Examples
    --------
    >>> rows = [f"{n:6.2f}{-100.25:7.2f}{n:6.2f}" for n in range(20)]
    >>> parted(["   t/s    F/N  x/mm", *rows])[:2]
    ['t/s\tF/N\tx/mm', '0.00\t-100.25\t0.00']
    """
    found = _fields(lines)
    if not found:
        return lines
    first, ends = found
    head = first
    while head and len(lines[head - 1].split()) == len(ends):
        head -= 1
    heads = ["\t".join(line.split()) for line in lines[head:first]]
    table = [
        "\t".join(_cut(line, ends)) if line.strip() and _is_fields(line, ends) else line
        for line in lines[first:]
    ]
    return [*lines[:head], *heads, *table]


def _fields(lines: Sequence[str]) -> tuple[int, list[int]] | None:
    """Return the first row of a table whose numbers touch, and where its columns end."""
    for place in range(1, min(len(lines), _TELLING)):
        above = lines[place - 1][:_LONGEST]
        if not any(map(str.isalpha, above)) or not _ROW.fullmatch(lines[place].rstrip()):
            continue
        rows = [line.rstrip() for line in lines[place : place + _TELLING] if line.strip()]
        words = list(re.finditer(r"\S+", above))
        if len(rows) < _FEWEST or len(words) < 2 or _NUMBER.fullmatch(words[0][0]):
            continue
        # blanks part them all: nothing touches
        if all(len(row.split()) == len(words) for row in rows[:-1]):
            return None
        starts = [word.start() for word in words[1:]]
        longest = max(map(len, rows))
        for ends in ([word.end() for word in words], [*starts, longest]):
            fitting = sum(_is_fields(row, ends) for row in rows)
            if fitting >= 0.95 * len(rows) - 1:
                return place, ends
    return None


def _cut(line: str, ends: Sequence[int]) -> list[str]:
    return [line[a:b].strip() for a, b in zip([0, *ends[:-1]], ends, strict=True)]


def _is_fields(line: str, ends: Sequence[int]) -> bool:
    line = line.rstrip()
    if len(line) > ends[-1] or not all(map(_NUMBER.fullmatch, _cut(line, ends))):
        return False
    # where no blank parts two, each has its own decimal mark, or the second its sign
    raw = [line[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]
    return all(
        left[-1:].isspace()
        or right[:1].isspace()
        or right.startswith(("-", "+"))
        or (_HAS_MARK.search(left) and _HAS_MARK.search(right))
        for left, right in zip(raw[:-1], raw[1:], strict=True)
    )


def _value(cell: str, comma: bool) -> float:
    try:
        return float(cell.replace(",", ".") if comma else cell)
    except ValueError:
        return float("nan")


def _text(value: float, comma: bool) -> str:
    text = f"{value:.17g}" if np.isfinite(value) else ""
    return text.replace(".", ",") if comma else text
