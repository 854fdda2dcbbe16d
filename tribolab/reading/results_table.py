"""Tables with one result per row, such as Ra of a scan or the peak force of a test."""

from __future__ import annotations

import functools
import re
from io import StringIO
from itertools import islice
from typing import NamedTuple

from tribolab.reading.lexicon.lexicon import Word, known_words, names, normalise_label, role_of
from tribolab.reading.numbers import PLAIN_NUMBER

_HEAD_LINES = 40  # lines above such a table
_MAX_ROWS = 2000  # longer tables are signals
_MAX_LINE = 2000  # characters; tables of results have few columns
_MIN_RESULT_NAMES = 2  # different names of results that a table must have
_NUMERIC = 0.5  # least share of numbers among the cells of a row
# parameters of ISO 21920 and ISO 25178, perhaps with a unit
_PARAMETER = re.compile(
    r"[RPWS](?:a|q|z|t|p|v|c|sk|ku|dq|dr|Sm|z1max|max|3z|k|pk|vk|pc)\d?\s*(?:[\[(/_ ].{0,12})?"
)
_CELLS = re.compile(r"\s*[;\t]\s*|\s*,(?!\d)\s*|\s{2,}")
_BLANKS = re.compile(r"[^\S\t]{3,}")  # shortened, as the search for cells takes quadratic time
_COMMAS = re.compile(r"\s*,\s*")
_LAST_BRACKET = re.compile(r"\s*[\[(][^\[(]*$")


class ResultsTable(NamedTuple):
    """Names of the results in a table, and its number of rows."""

    names: list[str]
    rows: int

    @property
    def words(self) -> str:
        """Description of the table for messages."""
        return (
            f"a table of results: {', '.join(self.names[:5])} of {self.rows} measurements, a row "
            "each, and neither a profile nor signals along time"
        )


def find_results_table(text: str) -> ResultsTable | None:
    r"""Return the table of results in a text; None if the text is no such table.

    Parameters
    ----------
    text
        The whole text, or its beginning.

    Examples
    --------
    >>> find_results_table("Sample;Ra [um];Rz [um]\nA1;0,41;3,1\nA2;0,43;3,3\n")
    ResultsTable(names=['Ra [um]', 'Rz [um]'], rows=2)
    >>> find_results_table("x [mm];z [um]\n0;0,41\n1;0,43\n") is None
    True
    >>> find_results_table("mass;mu_s;mu_d\n40;0.5;0.4\n80;0.6;0.4\n").names
    ['mu_s', 'mu_d']
    """
    lines = _first_lines(text, _MAX_ROWS + 1)
    if len(lines) > _MAX_ROWS:
        return None
    lines = [_BLANKS.sub("  ", line.strip('"')[: _MAX_LINE + 1]) for line in lines]
    for place, line in enumerate(lines[:_HEAD_LINES]):
        if len(line) > _MAX_LINE:
            return None
        for between in (_CELLS, _COMMAS):
            labels = [label.strip('"') for label in between.split(line)]
            names = _results(labels)
            if names and (rows := _rows(lines[place + 1 :], between, len(labels))):
                return ResultsTable(names, rows)
    return None


def find_other_test(text: str) -> str:
    r"""Return the name of a test without friction (creep, flow curve) that a text contains, or "".

    Parameters
    ----------
    text
        The whole text, or its beginning.

    Examples
    --------
    >>> find_other_test("Time [s];Compliance [1/Pa]\n0.1;2e-6\n")
    'a creep test'
    >>> find_other_test("Time [s];Shear rate [1/s];Friction force [N]\n0.1;1;2\n")
    ''
    """
    lines = _first_lines(text, _HEAD_LINES)
    for line in lines:
        for between in (_CELLS, _COMMAS) if len(line) <= _MAX_LINE else ():
            labels = [label.strip(' "') for label in between.split(_BLANKS.sub("  ", line))]
            if any(map(PLAIN_NUMBER.fullmatch, labels)):
                continue
            found = {name for name in _QUANTITIES if any(_is(label, name) for label in labels)}
            if {"shear_rate", "viscosity"} <= found:
                found.discard("normal_stress")  # that of the liquid; file: TRIOS, read-rheol
            if _has_moduli(labels, between, lines):
                return ""
            if found & _OF_FRICTION:
                continue
            for test, needed in _TESTS.items():
                if needed <= found:
                    return test
    return ""


def _first_lines(text: str, count: int) -> list[str]:
    """Return the first `count` lines that are not blank, without surrounding blanks."""
    lines = (line.strip() for line in StringIO(text, newline=None))
    return list(islice(filter(None, lines), count))


def _has_moduli(labels: list[str], between: re.Pattern[str], lines: list[str]) -> bool:
    """Whether a table has columns of storage and loss modulus that contain numbers.

    File: a Malvern Kinexus writes the columns of all its tests in each file; those of other tests
    are empty (bsaintmichel/read-rheol).
    """
    bare = [normalise_label(_LAST_BRACKET.sub("", label)) for label in labels]
    moduli = map(names, ("storage_modulus", "loss_modulus"))
    places = [next((p for p, x in enumerate(bare) if x in known), -1) for known in moduli]
    rows = (between.split(line) for line in lines if min(places) >= 0)
    rows = (row for row in rows if len(row) > max(places))
    return any(all(PLAIN_NUMBER.fullmatch(row[p].strip()) for p in places) for row in rows)


# files: krlennon/mastercurves (creep, relaxation), bsaintmichel/read-rheol and
# desdelgado/rheology-data-toolkit (flow)
_TESTS = {
    "a table of shift factors of a master curve": {"temperature", "shift_factor"},
    "a creep test": {"time", "compliance"},
    "a test of stress relaxation": {"time", "relaxation_modulus"},
    "a flow curve": {"shear_rate", "shear_stress"},
    "a flow curve of viscosity": {"shear_rate", "viscosity"},
}
_OF_FRICTION = {"friction_force", "friction_coefficient", "normal_stress"}
_QUANTITIES = {*_OF_FRICTION, *(name for needed in _TESTS.values() for name in needed)}


_STATIC = re.compile(r"static|haft|mu_s$", re.IGNORECASE)
_KINETIC = re.compile(r"kinetic|dynamic|gleit|mu_[dk]$", re.IGNORECASE)


def _results(labels: list[str]) -> list[str]:
    """Return the column names that mean results; empty if the table is no table of results."""
    parameters = [label for label in labels if _PARAMETER.fullmatch(label)]
    if len(set(parameters)) >= _MIN_RESULT_NAMES:  # "Pa" twice is a row of units
        return parameters
    peaks = [
        label for label in labels if role_of(label) == "extreme" and _is(label, "shear_stress")
    ]
    loads = [label for label in labels if _is(label, "normal_stress")]
    ratios = [label for label in labels if _is(label, "friction_coefficient")]
    if any(map(_STATIC.search, ratios)) and any(map(_KINETIC.search, ratios)):
        return ratios  # ASTM D1894 reports both of each specimen, an inclined plane of each test
    times = any(_is(label, "time") for label in labels)
    return [*loads, *peaks] if peaks and loads and not times else []


@functools.lru_cache(maxsize=1024)
def _is(label: str, quantity: str) -> bool:
    word = _words()[quantity]
    name = normalise_label(label)
    bare = normalise_label(re.split(r"\s*[\[(]", label)[0])
    return bare in word.symbols or any(stem in name for stem in word.stems)


@functools.cache
def _words() -> dict[str, Word]:
    return {word.quantity: word for of in ("run", "rheology") for word in known_words(of)}


def _rows(lines: list[str], between: re.Pattern[str], width: int) -> int:
    """Return the number of rows if all lines (after one of units) are rows of numbers, else 0."""
    cells = [between.split(line) for line in lines]
    if cells and not any(map(PLAIN_NUMBER.fullmatch, cells[0])):
        cells = cells[1:]
    for row in cells:
        numbers = sum(PLAIN_NUMBER.fullmatch(cell.strip('" ')) is not None for cell in row)
        if len(row) != width or numbers < _NUMERIC * width:
            return 0
    return len(cells)
