"""Notation of the lines of a text file: encoding, line ends, delimiter, decimal mark."""

from __future__ import annotations

import codecs
import functools
import re
from collections import Counter
from collections.abc import Sequence

from tribolab.reading.lexicon.lexicon import eastern_words, known_words
from tribolab.reading.text.cells import split_row
from tribolab.reading.text.first_bytes import HEAD, wide_encoding
from tribolab.units.spellings import MICRO

_EASTERN = ("gb18030", "cp932", "big5", "cp949", "cp1251")
_BLANKS = 1.02  # factor by which blanks must give more numbers than another delimiter
_VOTERS = 300  # lines at each end of the file from which the delimiter is found
DELIMITERS = {"\t": "tab", ";": "semicolon", ",": "comma", "|": "bar", "whitespace": "blanks"}
_NUMBER = {
    ".": r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?",  # digits are never given back
    ",": r"[+-]?(?:\d++(?:,\d*+)?|,\d++)(?:[eE][+-]?\d++)?",
}
# text in place of a number, dates, and times of day
_INSTEAD = rf"nan|[+-]?inf|null|n/?a|-{{1,8}}|[*#][*.#]*[a-z{MICRO}]*!?|err\w*|over\w*|ovl|none"
_MISSING = re.compile(rf"(?i){_INSTEAD}")
_NO_NUMBER = re.compile(
    rf"(?i){_INSTEAD}|"
    r"\d{1,4}[-./]\d{1,2}[-./]\d{1,4}(?:[T ]\d.*)?|"
    r"\d{1,2}:\d\d(?::\d\d)?(?:[.,]\d+)?(?: ?[ap]\.?m\.?)?"
)


_HALVES = re.compile(r"([+-]?\d+),(\d+)")
_ROWS = 16  # fewest rows for a decision
_ONE_NAME = re.compile(r"[^\[\](),;\t]+[\[(][^\[\](),;\t]+[\])]")  # a header such as "Height [nm]"


class Grammar:
    """One way to read lines: a delimiter and a decimal mark."""

    def __init__(self, delimiter: str, decimal: str):
        self.delimiter, self.decimal = delimiter, decimal
        self._mark = None if delimiter == "whitespace" else delimiter
        number = _NUMBER[decimal]
        self._number = re.compile(number)
        gap = r"\s+" if delimiter == "whitespace" else re.escape(delimiter)
        cell = f"(?:{number})" if delimiter == "whitespace" else f" *(?:{number})? *"
        self._plain = re.compile(f"{cell}(?:{gap}{cell})*")

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line."""
        return split_row(line, self.delimiter)

    def is_number(self, cell: str) -> bool:
        """Whether a cell is a number."""
        return self._number.fullmatch(cell) is not None

    def merit(self, line: str) -> tuple[int, int]:
        """Return the number of cells of a line, and how many more of them are numbers than text.

        The second value is 0 if the line is no row of a table, else at least 1.
        """
        if self.is_plain(line):
            parts = line.split(self._mark)
            return len(parts), sum(1 for part in parts if part.strip())
        cells = self.cells(line)
        filled = [cell for cell in cells if cell]
        others = [cell for cell in filled if not self.is_number(cell)]
        numbers = len(filled) - len(others)
        text = sum(1 for cell in others if not _NO_NUMBER.fullmatch(cell))
        is_row = numbers > 0 and 2 * (len(filled) - text) > len(filled)
        return len(cells), max(numbers - text, 1) if is_row else 0

    def is_plain(self, line: str) -> bool:
        """Whether a line consists of numbers and empty cells."""
        stripped = line.strip() if self.delimiter == "whitespace" else line
        return bool(self._plain.fullmatch(stripped)) and any(map(str.isdigit, stripped))

    def plain_width(self, line: str) -> int:
        """Return the number of cells of a line of numbers and empty cells; 0 for any other line."""
        return len(line.split(self._mark)) if self.is_plain(line) else 0

    def width(self, line: str) -> int:
        """Return the number of cells of a row of numbers; 0 for any other line."""
        width, merit = self.merit(line)
        return width if merit else 0

    def filled(self, line: str) -> int:
        """Return the number of cells of a line up to the last that is not empty."""
        if self._mark is None:
            return len(self.cells(line))
        return len(line.rstrip(f"{self._mark} ").split(self._mark))

    def is_footer(self, line: str) -> bool:
        """Whether a line begins with a word, such as "Mean" below a column of times."""
        first = self.cells(line)[0]
        return bool(first) and not self.is_number(first) and not _NO_NUMBER.fullmatch(first)

    def goes_on(self, line: str, width: int) -> bool:
        """Whether a line can be a row of a table although up to half of its cells are text."""
        cells = self.cells(line)
        if width == 1:  # a missing value; it is kept so that the rows remain counted
            return len(cells) == 1 and bool(_MISSING.fullmatch(cells[0]))
        numbers = sum(map(self.is_number, cells))
        filled = sum(1 for cell in cells if cell)
        return len(cells) == width and self.is_number(cells[0]) and 2 * numbers >= filled


def find_encoding(head: bytes) -> tuple[str, list[str]]:
    """Return the encoding of a file, and a list of guesses about it (numbers are not affected).

    For text that is not UTF-8, this is the encoding that gives the most known words; if there are
    none, the Western European one.
    """
    if wide := wide_encoding(head):
        return wide, []
    try:
        # the head may end inside a character
        head[: max(len(head) - 3, 0) if len(head) == HEAD else None].decode("utf-8")
    except UnicodeDecodeError:
        if eastern := _eastern(head):
            return eastern, [f"the encoding is {eastern}: names of columns are words in it"]
        name = _of_single_bytes(head)
        return name, [f"the encoding is {name}: the file is not UTF-8"]
    return "utf-8", []


_BEGINNING = 1 << 15  # bytes that contain settings and names
_SINGLE_BYTES = (
    *("latin-1", "cp1252", "cp1250", "iso8859-2", "cp1254", "cp1251", "koi8-r", "cp1253"),
    *("cp437", "cp852", "cp866", "mac-roman"),
)
# units that show the encoding if no word is known
_EASTERN_UNITS = re.compile(rf"(?<!\w)(?:{MICRO[1]}m|\u2103)(?!\w)")


@functools.cache
def _terms_with_own_letters() -> frozenset[str]:
    every = (t.lower() for word in known_words() for terms in word.terms.values() for t in terms)
    return frozenset(term for term in every if not term.isascii() and len(term) > 2)


def _of_single_bytes(head: bytes) -> str:
    """Return the single-byte encoding that gives the most words of the lexicon."""
    said = {}
    for name in _SINGLE_BYTES:
        text = head[:_BEGINNING].decode(name, errors="replace").lower()
        said[name] = sum(len(term) for term in _terms_with_own_letters() if term in text)
    best = max(said, key=lambda name: said[name])  # the first of equally good ones
    if said[best]:
        return best
    return "cp1252" if re.search(rb"[\x80-\x9f]", head) else "latin-1"


def _eastern(head: bytes) -> str:
    """Return the East Asian or Cyrillic encoding that gives known words; "" if there is none."""
    known: dict[str, int] = {}
    for name in _EASTERN:
        try:
            text = codecs.getincrementaldecoder(name)().decode(head, final=len(head) < HEAD)
        except UnicodeDecodeError:
            continue
        written = "".join(text.lower().split())  # in the notation of the lexicon
        known[name] = 2 * sum(word in written for word in eastern_words())
        known[name] += bool(_EASTERN_UNITS.search(text)) and name != "cp1251"
    best = max(known, key=lambda name: known[name], default="")
    return best if best and known[best] else ""


def find_line_ends(raw: bytes) -> str:
    """Return the kinds of line ends in a file, the most common first: "CR LF and LF"."""
    twice = raw.count(b"\r\r\n")
    both = raw.count(b"\r\n") - twice
    counts = {
        "LF": raw.count(b"\n") - both - twice,
        "CR LF": both,
        "CR": raw.count(b"\r") - both - 2 * twice,
        "CR CR LF": twice,
    }
    ends = sorted((name for name in counts if counts[name]), key=lambda name: -counts[name])
    return " and ".join(ends) or "none"


def find_grammar(lines: Sequence[str]) -> Grammar | None:
    """Return the delimiter and decimal mark that give the most numbers; None without numbers."""
    filled = [line for line in lines if line.strip()]
    voters = filled[:_VOTERS] + filled[max(_VOTERS, len(filled) - _VOTERS) :]
    best, highest = None, 0
    alone = False  # whether a delimiter that no line contains was tried: all give the same
    for delimiter in DELIMITERS:
        if delimiter != "whitespace" and not any(delimiter in line for line in voters):
            if alone:
                continue
            alone = delimiter != ","
        for decimal in (".", ","):
            if delimiter == decimal:
                continue
            grammar = Grammar(delimiter, decimal)
            votes: Counter[int] = Counter()
            for line in voters:
                width, merit = grammar.merit(line)
                votes[width] += merit
            top = max(votes.values(), default=0)
            # blanks must be clearly better, because they split lines at tabs, too
            if top > (_BLANKS if delimiter == "whitespace" else 1.0) * highest:
                best, highest = grammar, top
    return Grammar("\t", ",") if best and _one_column(best, voters) else best


def _one_column(grammar: Grammar, voters: Sequence[str]) -> bool:
    """Whether commas are decimal marks of one column instead of delimiters of two columns.

    They are if the header names one column, or if a zero follows the comma in some rows (3,05).
    """
    if grammar.delimiter != ",":
        return False
    halves = [_HALVES.fullmatch(line.strip()) for line in voters]
    parts = [match for match in halves if match]
    if len(parts) < _ROWS or 2 * len(parts) < len(voters):
        return False
    first = next(place for place, match in enumerate(halves) if match)
    if first and _ONE_NAME.fullmatch(voters[first - 1].strip()):
        return True
    # no integer is written as 0312
    leading = sum(match[2].startswith("0") and len(match[2]) > 1 for match in parts)
    return 50 * leading >= len(parts)
