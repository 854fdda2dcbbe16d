"""Tables of one number to a row, beside its moment and the name of its channel."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from tribolab.reading.text.cells import split_row
from tribolab.reading.text.column_legend import explained

_MARKS = ("\t", ";", ",", "|")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?")
_NAME = re.compile(r"[^\W\d][^\s].{0,78}|[^\W\d]")
_VALUE = re.compile(
    r"val\w*|wert|messwert|valeur|valor|valore|waarde|v[aä]rde|wartość|hodnota|значение|值|数值|reading",
    re.IGNORECASE,
)
_CHANNEL = re.compile(
    r"(?:tag|channel|signal|variable|sensor|point|parameter|quantity|kanal|signal|messgr[oö](?:ss|ß)e"
    r"|messstelle|voie|canal|grandeur|canale|grandezza|se[nñ]al|通道|信号)(?:[ _]?(?:name|id))?",
    re.IGNORECASE,
)
_FEWEST = 24  # rows that tell
_OFTEN = 5  # times that each of two channels has to come
_MOST = 200  # channels
_TELLING = 2000  # rows that tell what each cell is
_RARE = 0.1  # share of the rows of the commonest channel: rarer ones are kept when they change
_TIME = "time"


class _Places(NamedTuple):
    """In which line the names stand (from 0), what parts the cells, and what each cell is."""

    names: int
    mark: str
    width: int
    time: int
    channel: int
    value: int
    unit: int


def is_long(lines: Sequence[str]) -> bool:
    """Whether most lines hold one number beside its moment and the name of its channel.

    Parameters
    ----------
    lines
        The first ones of a file.
    """
    return _places(lines) is not None


def one_channel_to_a_column(lines: list[str]) -> list[str]:
    """Return lines in which each channel has a column.

    Parameters
    ----------
    lines
        Those of the whole file.

    Notes
    -----
    The moments are those of the commonest channel. Numbers of another one lie on the straight line
    between its own; of one that comes less than a tenth as often, as a set value that is written
    when it changes, the last holds on.
    """
    places = _places(lines)
    if places is None:
        return lines
    rows = [
        cells
        for line in lines[places.names + 1 :]
        if len(cells := split_row(line, places.mark)) == places.width
        and cells[places.time]
        and cells[places.channel]
    ]
    comma = _has_commas([row[places.value] for row in rows])
    order = Counter(row[places.channel] for row in rows)
    main = order.most_common(1)[0][0]
    when = _moments([row[places.time] for row in rows])
    names = np.array([row[places.channel] for row in rows], dtype=object)
    values = np.array([_number(row[places.value], comma) for row in rows])
    own = np.flatnonzero(names == main)
    at = when[own]
    columns = []
    for name in order:
        chosen = np.flatnonzero((names == name) & np.isfinite(values) & np.isfinite(when))
        chosen = chosen[np.argsort(when[chosen], kind="stable")]
        if name == main:
            columns.append(values[own])
        elif chosen.size:
            columns.append(_at(at, when[chosen], values[chosen], order[name] < _RARE * order[main]))
        else:
            columns.append(np.full(at.size, np.nan))
    mark = ";" if comma else places.mark
    units = _units(rows, places)
    head = split_row(lines[places.names], places.mark)[places.time]
    titles = [
        f"{short} [{units[name]}]" if units[name] else short
        for name, short in zip(order, _short(list(order)), strict=True)
    ]
    titles = explained(lines[: places.names], titles)
    table = [mark.join([head, *(title.replace(mark, " ") for title in titles)])]
    texts = [[_text(value, comma) for value in column] for column in columns]
    moments = [rows[k][places.time] for k in own]
    table += [mark.join(cells) for cells in zip(moments, *texts, strict=True)]
    return [*lines[: places.names], *table]


def _places(lines: Sequence[str]) -> _Places | None:
    filled = [(n, line) for n, line in enumerate(lines[: 2 * _TELLING]) if line.strip()]
    for mark in _MARKS:
        split = [(n, split_row(line, mark)) for n, line in filled[:_TELLING] if mark in line]
        widths = Counter(len(cells) for _, cells in split)
        if not widths:
            continue
        width, often = widths.most_common(1)[0]
        if not 3 <= width <= 12 or often < max(_FEWEST, 0.8 * min(len(filled), _TELLING) - 20):
            continue
        table = [(n, cells) for n, cells in split if len(cells) == width]
        first, head = table[0]
        body = [cells for _, cells in table[1:]]
        places = _kinds(head, body)
        if places is not None:
            return _Places(first, mark, width, *places)
    return None


def _kinds(head: list[str], body: list[list[str]]) -> tuple[int, int, int, int] | None:
    """Return where the moment, the channel, its number and its unit (-1: nowhere) stand."""
    if any(_NUMBER.fullmatch(cell) for cell in head) or not all(head[:2]):
        return None
    columns = list(zip(*body, strict=True))
    numeric = [
        k for k, cells in enumerate(columns) if _share(cells, lambda c: bool(_NUMBER.fullmatch(c)))
    ]
    timed = [k for k, cells in enumerate(columns) if k in numeric or _share(cells, _is_moment)]
    named = [k for k, cells in enumerate(columns) if k not in timed and _is_channel(cells)]
    if not named or not timed:
        return None
    channel = max(named, key=lambda k: (len(set(columns[k])), -k))
    rising = [k for k in timed if _rises(columns[k])]
    values = [k for k in numeric if k not in rising[:1]]
    if not rising or not values:
        return None
    value = next((k for k in values if _VALUE.fullmatch(head[k])), values[0])
    spread = [k for k in named if k != channel and _follows(columns[channel], columns[k])]
    unit = spread[0] if spread else -1
    # what alternates beside one quantity is a direction, and no channel's name
    several = unit >= 0 and len(set(columns[unit])) > 1
    if not (several or _VALUE.fullmatch(head[value]) or _CHANNEL.fullmatch(head[channel])):
        return None
    return rising[0], channel, value, unit


def _share(cells: Sequence[str], told: object) -> bool:
    filled = [cell for cell in cells if cell]
    assert callable(told)
    return len(filled) > 0 and sum(map(told, filled)) >= 0.95 * len(cells)


def _is_moment(cell: str) -> bool:
    return np.isfinite(_moment(cell))


def _is_channel(cells: Sequence[str]) -> bool:
    """Whether cells are a few names that come again and again, in turns."""
    told = Counter(cells)
    if not all(_NAME.fullmatch(cell) or cell in "-%" for cell in told):
        return False
    often = [count for count in told.values() if count >= _OFTEN]
    turns = sum(a != b for a, b in zip(cells, cells[1:], strict=False))
    return 2 <= len(told) <= _MOST and len(often) >= 2 and turns > 0.2 * len(cells)


def _rises(cells: Sequence[str]) -> bool:
    when = _moments(list(cells))
    steps = np.diff(when[np.isfinite(when)])
    return bool(steps.size and (steps >= 0).mean() > 0.95 and (steps > 0).any())


def _follows(channels: Sequence[str], cells: Sequence[str]) -> bool:
    """Whether each channel has one unit."""
    pairs = set(zip(channels, cells, strict=True))
    return len(pairs) == len(set(channels))


def _units(rows: list[list[str]], places: _Places) -> dict[str, str]:
    units: dict[str, str] = {}
    for row in rows:
        unit = row[places.unit].strip("[]()") if places.unit >= 0 else ""
        units.setdefault(row[places.channel], "" if unit == "-" else unit)
    return units


def _short(names: Sequence[str]) -> list[str]:
    """Return names without what a controller puts before them, if they are still told apart.

    >>> _short(["DB1.FT", "SYS.T"]), _short(["A.F", "B.F"]), _short(["F_T"])
    (['FT', 'T'], ['A.F', 'B.F'], ['F_T'])
    """
    short = [re.sub(r"^.*[./:\\\\!](?=[^\W\d])", "", name) for name in names]
    return short if len(set(short)) == len(names) else list(names)


def _has_commas(cells: list[str]) -> bool:
    return any("," in cell for cell in cells) and not any("." in cell for cell in cells)


def _number(cell: str, comma: bool) -> float:
    try:
        return float(cell.replace(",", ".") if comma else cell)
    except ValueError:
        return float("nan")


def _text(value: float, comma: bool) -> str:
    if not np.isfinite(value):
        return ""
    text = f"{value:.17g}"
    return text.replace(".", ",") if comma else text


def _moment(cell: str) -> float:
    try:
        moment = datetime.fromisoformat(cell.replace(",", "."))
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError, OSError):
        pass
    clock = re.fullmatch(r"(\d{1,2}):(\d\d):(\d\d(?:[.,]\d+)?)", cell)
    if clock is None:
        return float("nan")
    return 3600 * int(clock[1]) + 60 * int(clock[2]) + float(clock[3].replace(",", "."))


def _moments(cells: list[str]) -> np.ndarray:
    """Return moments as numbers; their order in the file where they are written otherwise."""
    comma = _has_commas(cells)
    plain = np.array([_number(cell, comma) for cell in cells])
    if np.isfinite(plain).mean() > 0.9:
        return plain
    dated = np.array([_moment(cell) for cell in cells])
    return dated if np.isfinite(dated).mean() > 0.9 else np.arange(float(len(cells)))


def _at(at: np.ndarray, when: np.ndarray, values: np.ndarray, held: bool) -> np.ndarray:
    """Return the numbers of a channel at other moments; none before it begins or after its end."""
    if held:
        last = np.searchsorted(when, at, side="right") - 1
        return np.where(last >= 0, values[last.clip(0)], np.nan)
    return np.interp(at, when, values, left=np.nan, right=np.nan)
