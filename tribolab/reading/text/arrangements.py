"""Text whose numbers do not stand below a line of names, put such as they do."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Literal

from tribolab.reading.text.cells import split_row
from tribolab.reading.text.column_legend import explained
from tribolab.reading.text.long_table import one_channel_to_a_column
from tribolab.reading.text.transposed import on_one_clock, parted, turned, with_joined_names

Arrangement = Literal[
    "below names",
    "columns listed",
    "names in rows",
    "names explained",
    "side by side",
    "names in two rows",
    "a channel to a row",
    "a signal to a row",
    "clocks of their own",
    "touching",
    "json",
    "declared records",
]

_MARK = ";"  # between the cells of rows that hold names
_LONGEST = 1000  # characters of a line that are looked at
_NUMBER = r"[-+]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][-+]?\d+)?"
_NAME = r"[^\W\d][\w%°]{0,30}(?: [\w%°]{1,20}){0,3}"
_VALUE = rf"(?:0x[0-9a-f]+|{_NUMBER}|nan|inf|null|none|ovf|ovl|err\w*|---*)"
_PAIR = re.compile(
    rf"\"?(?P<name>{_NAME})\"? {{0,3}}[:=] {{0,3}}\"?(?P<value>{_VALUE})(?![\d_.:])"
    r" ?\[?(?P<unit>[^\W\d_][\w/°%²³·*^-]{0,8}|°[CFK]|%)?\]?\"?(?=$|[\s,;|}\])])"
    r"(?![ ]{0,3}[:=])",
    re.IGNORECASE,
)
_STAMP = re.compile(
    r"\W{0,3}(?P<time>(?:\d{4}-\d\d-\d\d[ T])?\d{1,2}:\d\d:\d\d(?:[.,]\d+)?)"
    r"(?:Z|[+-]\d\d:?\d\d)?(?: ?->|\]|[\s,;|])\s*"
)
# what a log says of a line before its message: "[daq] DATA", "INFO main:", "<7> adc[12]:"
_TAGS = re.compile(
    r"(?:(?:\[[^\]]{1,30}\]|\([^)]{1,30}\)|<[^>]{1,30}>|[^\W\d][\w./-]{0,30}(?:\[\d{1,9}\])?:?"
    r"(?=[ \t]))[ \t]+){1,5}(?=[^\W\d]\w*[:=])"
)
_SETTING = re.compile(
    r"(?P<name>[^\W\d][\w.-]{0,40})=(?P<value>[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)?"
    r"(?P<text>[^\s,;|]*)"
)
_PARTS = re.compile(r"[\s,;|{}\[\]]*")
_OWN_CLOCK = re.compile(
    r"t|ts|ms|us|s|time\w*|zeit\w*|temps|tiempo|tempo|millis|micros", re.IGNORECASE
)
_FEWEST = 12  # rows that tell
_MOST_ABOVE = 500  # lines above a table that are looked at
_NEAR = 4  # lines above the first row in one of which the names stand
_MOST_COLUMNS = 512  # that are listed, or of tables side by side
_LISTED = re.compile(
    r"^\W{0,4}(?P<word>[^\W\d]{0,20})[\W_]{0,3}(?P<number>\d{1,2})"
    r"[\])]?\s{0,3}(?:[=:;,.)\t-]|\s{2,9})\s{0,3}(?P<name>[^\W\d].{0,80}?)\s*$"
)
_COLUMNS = re.compile(
    r"\W*(?:(?:data|table) )?(?:columns?|cols?|channels?|fields?|spalten|kan[äa]le"
    r"|colonnes?|columnas?|colunas?|colonne|kolommen|sloupce|kolumny|kolumner|sarakkeet|столбцы|列)"
    r"(?: (?:are|is|sind|names|order))?\s?[:=]\s?(?P<names>[^\W\d].*)$",
    re.IGNORECASE,
)
_COUNTED = re.compile(r"(?<![\w.,])(\d{1,2})\s?[=:.)]\s?([^\W\d][^;,|=]*?)\s*(?=[;,|]|$)")
_NUMBER_BEHIND = re.compile(r"[\s_#.-]{0,3}\(?\d{1,3}\)?$")
_LONGEST_NUMBER = 10  # characters of it
_UNIT_BEHIND = re.compile(r"^(?P<name>.*?)\s*[;,\t|]\s*\"?\[?(?P<unit>[^\s;,\]\"]{1,12})\]?\"?$")


def below_names(text: str, arrangement: Arrangement, delimiter: str) -> str:
    r"""Return a text whose numbers stand below a line of their names, with LF.

    Parameters
    ----------
    text
        The whole file, with LF.
    arrangement
        How the numbers stand: each column is listed on a line of its own above them, each number
        stands behind its name, tables of the same columns stand side by side, short names are
        explained above the table or told apart by the row above, each row holds a moment, a
        channel's name and its number, or a whole signal, or columns have clocks of their own or
        touch one another.
    delimiter
        What parts the cells; of "names in rows" it is the semicolon thereafter.

    Examples
    --------
    >>> below_names("ch1: t;ms\nch2: Ft;N\n1;2\n3;4\n", "columns listed", ";").splitlines()[2:]
    ['t [ms];Ft [N]', '1;2', '3;4']
    """
    if arrangement == "below names":
        return text
    lines = text.split("\n")
    if arrangement == "columns listed":
        return "\n".join(_headed(lines, delimiter))
    if arrangement == "names explained":
        return "\n".join(_explained(lines, delimiter))
    if arrangement == "names in rows":
        return "\n".join(_without_names(lines))
    if arrangement == "a channel to a row":
        return "\n".join(one_channel_to_a_column(lines))
    if arrangement == "a signal to a row":
        return "\n".join(turned(lines))
    if arrangement == "touching":
        return "\n".join(parted(lines))
    if arrangement == "clocks of their own":
        return "\n".join(on_one_clock(lines, delimiter))
    if arrangement == "names in two rows":
        return "\n".join(with_joined_names(lines, delimiter))
    return "\n".join(_below_each_other(lines, delimiter))


def listed_columns(lines: Sequence[str], width: int) -> list[str]:
    """Return the names of columns, with units in brackets, that are listed above a table.

    Parameters
    ----------
    lines
        Those above the first row.
    width
        Columns of the table.

    Returns
    -------
    list of str
        Empty where no list counts as many from 0 or 1.
    """
    lines = lines[-_MOST_ABOVE:] if width <= _MOST_COLUMNS else ()
    for start in range(len(lines) - width, -1, -1):
        said = [_LISTED.match(line[:_LONGEST]) for line in lines[start : start + width]]
        found = [match for match in said if match]
        if len(found) < width or len({match["word"].lower() for match in found}) != 1:
            continue
        first = int(found[0]["number"])
        if first in (0, 1) and [int(m["number"]) for m in found] == [*range(first, first + width)]:
            return [_named(match["name"]) for match in found]
    for line in reversed(lines):
        if names := _in_one_line(line[:_LONGEST], width):
            return names
    return []


def _in_one_line(line: str, width: int) -> list[str]:
    """Return the names of columns that one line lists.

    >>> _in_one_line("# Columns: time (s), friction (N)", 2)
    ['time (s)', 'friction (N)']
    >>> _in_one_line("1 = t [s]; 2 = Ft [N]", 2), _in_one_line("Load: 20 N, dry", 2)
    (['t [s]', 'Ft [N]'], [])
    """
    counted = _COUNTED.findall(line)
    if [int(number) for number, _ in counted] == [*range(1, width + 1)]:
        return [name.strip() for _, name in counted]
    said = _COLUMNS.match(line)
    for mark in (";", ",", "|", "\t") if said else ():
        names = [name.strip() for name in said["names"].rstrip(" .;,").split(mark)] if said else []
        if len(names) == width and all(names):
            return names
    return []


def is_listed(line: str) -> bool:
    """Whether a line may be one of a list of columns: "Channel 2: force;N".

    Parameters
    ----------
    line
        One line above a table.
    """
    return _LISTED.match(line[:_LONGEST]) is not None


def holds_names(lines: Sequence[str]) -> bool:
    """Whether most rows say the name of each number: "t:1873 F:1.3 rpm:0.0".

    Parameters
    ----------
    lines
        The first ones of a file.
    """
    filled = [line for line in lines if line.strip()]
    rows = [names for line in filled if (names := tuple(name for name, *_ in _pairs(line)))]
    if len(rows) < max(_FEWEST, len(filled) // 2):
        return False
    names, often = Counter(rows).most_common(1)[0]
    return len(names) > 1 and often >= len(rows) // 2


def groups_beside(cells: Sequence[str]) -> int:
    """Return how many tables of the same columns stand side by side under a line of names.

    Parameters
    ----------
    cells
        The names; an empty one may part the tables.

    Examples
    --------
    >>> groups_beside(["t", "x", "F", "t", "x", "F"]), groups_beside(["t 1", "F 1", "t 2", "F 2"])
    (2, 2)
    >>> groups_beside(["t", "F", "N"]), groups_beside(["F1", "F2"])
    (1, 1)
    """
    names = [_common(cell) for cell in cells]
    while names and not names[-1]:
        names.pop()
    names = names if len(names) <= _MOST_COLUMNS else []
    for width in range(2, (len(names) + 1) // 2 + 1):
        own = names[:width]
        bare = own if own[-1] else own[:-1]
        if "" in bare or len(bare) < 2 or len(set(bare)) != len(bare):
            continue
        whole = names + [""] * (-len(names) % width)
        if all(whole[k : k + width] == own for k in range(0, len(whole), width)):
            return len(whole) // width
    return 1


def _common(cell: str) -> str:
    return _without_number(cell.strip().strip('"')).lower()


def _without_number(name: str) -> str:
    """Return a name without the number of its table.

    >>> _without_number("Force (2)"), _without_number("t_1"), _without_number("F")
    ('Force', 't', 'F')
    """
    number = _NUMBER_BEHIND.search(name[-_LONGEST_NUMBER:])
    return name[: len(name) - len(number[0])] if number else name


def _named(text: str) -> str:
    """Return a name with its unit in brackets."""
    text = text.strip().rstrip(";,\t ")
    behind = None if text.endswith(("]", ")")) else _UNIT_BEHIND.match(text)
    return f"{behind['name']} [{behind['unit']}]" if behind else text


def _headed(lines: list[str], delimiter: str) -> list[str]:
    """Put a line of names above the first row."""
    for place, line in enumerate(lines):
        cells = split_row(line, delimiter)
        if len(cells) < 2 or not all(re.fullmatch(_NUMBER, cell) for cell in cells):
            continue
        names = listed_columns(lines[:place], len(cells))
        if not names:
            return lines
        if delimiter == "whitespace":
            names = [_one_word(name) for name in names]
        else:
            names = [name.replace(delimiter, " ") for name in names]
        mark = "\t" if delimiter == "whitespace" else delimiter
        return [*lines[:place], mark.join(names), *lines[place:]]
    return lines


def _explained(lines: list[str], delimiter: str) -> list[str]:
    """Put what the text above says of them in place of the names above the first row."""
    first = next((n for n, line in enumerate(lines) if _is_row(line, delimiter)), 0)
    for place in range(first - 1, max(first - _NEAR, 0) - 1, -1):
        names = split_row(lines[place], delimiter)
        told = explained(lines[:place], names) if len(names) > 1 else names
        if told != names:
            mark = "\t" if delimiter == "whitespace" else delimiter
            told = [
                _one_word(name) if delimiter == "whitespace" else name.replace(mark, " ")
                for name in told
            ]
            return [*lines[:place], mark.join(told), *lines[place + 1 :]]
    return lines


def _is_row(line: str, delimiter: str) -> bool:
    cells = split_row(line, delimiter)
    numbers = sum(bool(re.fullmatch(_NUMBER, cell)) for cell in cells)
    return len(cells) > 1 and numbers > 0 and 2 * numbers >= len(cells)


def _one_word(name: str) -> str:
    return re.sub(r"\s+(?![\[(])", "_", name).replace(" ", "")


def _pairs(line: str) -> list[tuple[str, str, str]]:
    """Return names, numbers and units of a row that holds nothing else but a time of day."""
    stamp = _STAMP.match(line[:_LONGEST])
    place = stamp.end() if stamp else _blanks(line, 0)
    tags = _TAGS.match(line[:_LONGEST], place) if stamp else None
    place = tags.end() if tags else place
    found = []
    while place < min(len(line), _LONGEST):
        pair = _PAIR.match(line, place)
        if pair is None:
            return []
        hexadecimal = pair["value"].lower().startswith("0x")
        value = str(int(pair["value"], 16)) if hexadecimal else pair["value"]
        found.append((pair["name"], value, pair["unit"] or ""))
        place = _blanks(line, pair.end())
    return found


def _blanks(line: str, place: int) -> int:
    parts = _PARTS.match(line, place)
    return parts.end() if parts else place


def _without_names(lines: list[str]) -> list[str]:
    """Put the names of the commonest row above all; what is no row below the first is left out."""
    rows = [(place, pairs) for place, line in enumerate(lines) if (pairs := _pairs(line))]
    often = Counter(tuple(name for name, *_ in pairs) for _, pairs in rows)
    if not often:
        return lines
    names = often.most_common(1)[0][0]
    first, told = next((p, row) for p, row in rows if tuple(n for n, *_ in row) == names)
    clock = not any(_OWN_CLOCK.fullmatch(name) for name in names)
    stamped = clock and _STAMP.match(lines[first]) is not None
    head = [f"{name} [{unit}]" if unit else name for name, _, unit in told]
    table = [_MARK.join([*(["Time"] if stamped else []), *head])]
    for place, pairs in rows:
        values = {name: value for name, value, _ in pairs}
        if place < first or not set(names) <= values.keys():
            continue  # cut off, and so may be the last of its numbers
        time = _STAMP.match(lines[place]) if stamped else None
        cells = [time["time"]] if time else [""] if stamped else []
        table.append(_MARK.join([*cells, *(values[name] for name in names)]))
    above = [
        line[stamp.end() :] if (stamp := _STAMP.match(line)) else line for line in lines[:first]
    ]
    return [*(said for line in above for said in _settings(line)), *table]


def _settings(line: str) -> list[str]:
    """Put each of several settings of a line on a line of its own, its unit apart.

    >>> _settings("INFO config: pin=steel track_radius=8.5mm"), _settings("rate = 5 Hz")
    (['INFO config:', 'pin: steel', 'track_radius: 8.5 mm'], ['rate = 5 Hz'])
    """
    said = list(_SETTING.finditer(line[:_LONGEST]))
    found = [f"{s['name']}: {' '.join(filter(None, (s['value'], s['text'])))}" for s in said]
    return [_SETTING.sub("", line).rstrip(), *found] if found else [line]


def _below_each_other(lines: list[str], delimiter: str) -> list[str]:
    """Put tables that stand side by side below each other, each under its names."""
    split = (split_row(line, delimiter) for line in lines)
    place, names = next(
        ((n, cells) for n, cells in enumerate(split) if groups_beside(cells) > 1), (0, [])
    )
    groups = groups_beside(names)
    if groups < 2:
        return lines
    while not names[-1]:
        names.pop()
    width = -(-len(names) // groups)
    table = [split_row(line, delimiter) for line in lines[place + 1 :] if line.strip()]
    titles = split_row(lines[place - 1], delimiter) if place else []
    above = lines[: place - 1] if sum(map(bool, titles)) == groups else lines[:place]
    mark = "\t" if delimiter == "whitespace" else delimiter
    found = list(above)
    for group in range(groups):
        part = slice(group * width, (group + 1) * width)
        title = "".join(titles[part]) if above != lines[:place] else ""
        head = [_without_number(name) for name in names[:width]]
        found += ["", title, mark.join(head)]
        rows = (row[part] for row in table if len(row) >= width)
        found += [mark.join(row) for row in rows if any(row)]
    return found
