"""What a volt or a count of a column is worth, where its own name or a line of the text says so.

"LVDT (2.50 mm/V)", "Bridge (100 N = 2.013 mV/V, 5 V)"; "cell_T: 51300 counts/N" above "cell_T";
"Friction sensitivity: 0.42 mV/N" where one column is the friction in volts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import COUNTS, matches
from tribolab.reading.interpret.patterns import number_pattern
from tribolab.reading.interpret.rules import si_unit
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.reading.text.cells import split_name
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.header.counts import COUNT_WORD, stated_offset
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.unit_names import WEIGHTS, unit_in_words

_LONGEST = 300  # characters of a line that are looked at
_KNOWN = 0.3  # share of a name that a known word makes up: its factor says of what kind it is
SYMBOLS = {
    "friction_force": "friction_signal",
    "normal_force": "load_signal",
    "position": "way_signal",
    "rotation_speed": "turn_signal",
}
FORCES = ("friction_force", "normal_force")
_NUMBER = r"(?<![\d.,A-Za-z_])(?P<number>\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)"
_UNIT = r"[^\W\d_]{1,5}"
_RAW = rf"(?:[mµμu]?V|{COUNT_WORD})"
_PER = r"\s?(?:/|per|pro|par|por|al|a|na|на)\s?"
_GAIN = re.compile(rf"{_NUMBER}\s?(?P<unit>{_UNIT}){_PER}(?P<raw>{_RAW})(?![\w/])", re.IGNORECASE)
_SENSITIVITY = re.compile(
    rf"{_NUMBER}\s?(?P<raw>{_RAW}){_PER}(?P<unit>{_UNIT})(?![\w/])", re.IGNORECASE
)
# "Calibration factor reibkraft [N/mV];2.350": the unit stands in the name of the line
_UNIT_FIRST = re.compile(
    r"[\[(](?P<one>[mkµu]?[A-Za-z]{1,3})\s?/\s?(?P<other>[mkµu]?[A-Za-z]{1,3})[\])]\W{1,3}"
    + _NUMBER
)
_RATED_OUTPUT = re.compile(rf"{_NUMBER}\s?mV\s?/\s?V(?![\w/])")
_RATED_LOAD = re.compile(rf"{_NUMBER}\s?(?P<unit>[kmM]?N|k?gf?|kp|lbf?)(?![\w/])")
_EXCITATION = re.compile(rf"{_NUMBER}\s?V(?![\w/])")
_FACTOR_OF = (
    r"(?i:(?:gain|factor|sensitivity|scale|calibration(?: factor)?|faktor|verst[äa]rkung"
    r"|empfindlichkeit|kalibrier\w*)\s(?:of\s|for\s|von\s|f[üu]r\s)?)?"
)
_ENDS = re.compile(r";|\s{3,}")


class Calibration(NamedTuple):
    """What a signal makes: its column, and the members of the rule that makes it.

    `members` are amounts by what they are, as a formula calls them, with the value that a line
    states; None of one that stands in the column's name.
    """

    quantity: str
    column: DraftColumn
    members: tuple[tuple[str, str, Amount | None], ...]
    text: str


class _Text(NamedTuple):
    """A text that speaks of a column: the line that it stands in ("" if the name), and where."""

    text: str
    line: str = ""
    place: int = 0


def find_calibrations(layout: Layout, columns: Sequence[DraftColumn]) -> list[Calibration]:
    """Return what volts and counts make, by their columns' names or lines of the text.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        As they are understood. A quantity that a column holds already is not made.

    Returns
    -------
    list of Calibration
        At most one of each quantity; none of a quantity that two columns would make, or of which
        several factors are stated.
    """
    held = {c.quantity for c in columns if c.quantity and (c.used or c.fill_in)}
    found: dict[str, list[Calibration]] = {}
    bare = [bare_name(column)[0].strip() for column in columns]
    for column in columns:
        if column.used or column.form or not (raw := _raw_of(column)):
            continue
        names = [split_name(column.label)[0]]
        if bare.count(bare[column.place - 1]) == 1 and raw == "V":
            names.append(bare[column.place - 1])
        made = (
            _calibration(column, raw, text)
            for text in _texts(layout, column, list(dict.fromkeys(names)))
        )
        first = next((one for one in made if one is not None), None)
        if first is not None:
            found.setdefault(first.quantity, []).append(first)
    for force in FORCES:
        in_volts = column_in_volts(columns, force)
        if force not in found and in_volts is not None:
            found[force] = _by_name_of_force(layout, in_volts, force)
    return [made[0] for quantity, made in found.items() if len(made) == 1 and quantity not in held]


def column_in_volts(columns: Sequence[DraftColumn], force: str) -> DraftColumn | None:
    """Return the one column of a force's volts, whatever one of them is worth.

    Parameters
    ----------
    columns
        As they are understood.
    force
        "friction_force" or "normal_force".
    """
    mine = [c for c in columns if not c.used and _raw_of(c) == "V" and _named_force(c) == force]
    return mine[0] if len(mine) == 1 else None


def _named_force(column: DraftColumn) -> str:
    options = matches(bare_name(column)[0], None)
    return options[0].quantity if options and options[0].quantity in FORCES else ""


def _by_name_of_force(layout: Layout, column: DraftColumn, force: str) -> list[Calibration]:
    """Return what the lines make of a column in volts that speak of its force, or of none."""
    made = []
    for line in layout.text_above():
        line = line[:_LONGEST]
        key = re.split(r"[\[(:;=\t]|\s\d", line, maxsplit=1)[0]
        options = [o.quantity for o in matches(key, None) if o.quantity in FORCES]
        if not options or options[0] == force:
            one = _calibration(column, "V", _Text(line, line), force)
            made += [one] if one is not None else []
    return made


def _raw_of(column: DraftColumn) -> str:
    """Return "V" of a column in volts, "count" of plain numbers; "" of any other.

    The N behind a stroke below may be the name's own: "cell_N" beside "cell_T".
    """
    _, unit, _ = bare_name(column)
    said = column.file_unit or column.unit or split_name(column.label)[1]
    if unit is None or unit == COUNTS or (not said and not converts(unit, "V")):
        return "count" if column.label else ""
    return "V" if converts(unit, "V") else ""


def _texts(layout: Layout, column: DraftColumn, names: Sequence[str]) -> Iterator[_Text]:
    """Yield what the column is called, and what lines above say of its names."""
    yield _Text(column.label)
    lines = [line[:_LONGEST] for line in layout.text_above()]
    for name in names:
        plain = [word for word in re.split(r"[\s_]+", name) if word]
        if not plain or not any(plain[0] in line for line in lines):
            continue
        words = [re.escape(word) for word in plain]
        # "Fx: 10 N/V", "Gain Fx: 10 N/V", "load, sensitivity: 10 N/V"
        named = re.compile(
            rf"(?:^[^\w]*|[;,|]\s*|\s{{2,}}){_FACTOR_OF}{r'[ _]*'.join(words)}(?![^\W_])"
        )
        for line in lines:
            if match := named.search(line):
                end = _ENDS.search(line, match.end())
                yield _Text(line[match.end() : end.start() if end else None], line, match.end())
    for line in lines:  # "motor: 400 steps/mm" of a column "steps"
        for match in _SENSITIVITY.finditer(line):
            if normalise_label(match["raw"]) == normalise_label(names[0]):
                yield _Text(line[match.start() :], line, match.start())


def _calibration(
    column: DraftColumn, raw: str, text: _Text, quantity: str = ""
) -> Calibration | None:
    """Return what a text makes of a signal; None if it says nothing, or too much to be sure."""
    found = _by_factor(column, raw, text, quantity)
    found = found or (_by_bridge(column, text, quantity) if raw == "V" else None)
    if found is None:
        return None
    made, members, end = found
    offset = _offset(text, end, raw, made)
    if offset is None:
        return None
    unit = column.unit or bare_name(column)[1]
    own = column if column.file_unit is not None else column._replace(unit=unit)
    own = own if raw == "V" else column._replace(unit="1")
    return Calibration(made, own, (*members, *offset), text.line.strip())


_Members = tuple[tuple[str, str, Amount | None], ...]


def _by_factor(
    column: DraftColumn, raw: str, text: _Text, quantity: str
) -> tuple[str, _Members, int] | None:
    """Return what one ratio makes of a signal: "2.5 mm/V", "51300 counts/N"."""
    for pattern in (_GAIN, _SENSITIVITY, _UNIT_FIRST):
        match = pattern.search(text.text)
        if match is None:
            continue
        if pattern is _UNIT_FIRST:
            gain = converts(match["other"], "V")
            signal, unit = match["other" if gain else "one"], match["one" if gain else "other"]
        else:
            gain, signal, unit = pattern is _GAIN, match["raw"], match["unit"]
        unit = unit_in_words(unit)
        unit = WEIGHTS.get(unit, unit)
        made = quantity or _quantity(column, text.text[: match.start()], unit)
        in_volts = converts(signal, "V")
        if not made or in_volts != (raw == "V") or not converts(unit, si_unit(made)):
            continue
        per = signal if in_volts else "1"
        whole = (unit if per == "1" else f"{unit}/{per}") if gain else f"{per}/{unit}"
        si, si_raw = si_unit(made), "V" if in_volts else "1"
        to = (si if si_raw == "1" else f"{si}/{si_raw}") if gain else f"{si_raw}/{si}"
        role = "gain" if gain else "sensitivity"
        name = f"{SYMBOLS[made]}_factor"
        return made, ((role, *_amount(match, text, whole, name, to)),), match.end()
    return None


def _by_bridge(column: DraftColumn, text: _Text, quantity: str) -> tuple[str, _Members, int] | None:
    """Return what a bridge's rated load and output make of its signal: "100 N = 2 mV/V, 5 V"."""
    output, rated = _RATED_OUTPUT.search(text.text), _RATED_LOAD.search(text.text)
    fed = list(_EXCITATION.finditer(text.text))
    if output is None or rated is None or len(fed) != 1:
        return None
    unit = WEIGHTS.get(rated["unit"], rated["unit"])
    words = text.text[: min(output.start(), rated.start())]
    made = quantity or _quantity(column, words, unit)
    if not made:
        return None
    name = SYMBOLS[made]
    members = (
        ("rated_load", *_amount(rated, text, unit, f"{name}_rated_load", "N")),
        ("rated_output", *_amount(output, text, "mV/V", f"{name}_rated_output", "1")),
        ("excitation", *_amount(fed[0], text, "V", f"{name}_excitation", "V")),
    )
    return made, members, max(match.end() for match in (rated, output, fed[0]))


def _offset(text: _Text, end: int, raw: str, made: str) -> _Members | None:
    """Return the zero that stands behind a factor: "0.0015 N/count, zero 118 counts".

    Returns
    -------
    tuple or None
        Empty without one; None of one that no rule takes off.
    """
    match = stated_offset(text.text, end)
    if match is None or not float(match["number"].replace(",", ".")):
        return ()
    unit = unit_in_words(match["unit"] or "")
    in_unit_of_signal = converts(unit, "V") if raw == "V" else not converts(unit, si_unit(made))
    if unit and not in_unit_of_signal:
        return None
    unit, to = (unit or "V", "V") if raw == "V" else ("1", "1")
    return (("tare", *_amount(match, text, unit, f"{SYMBOLS[made]}_zero", to)),)


def _amount(
    match: re.Match[str], text: _Text, unit: str, name: str, to: str
) -> tuple[str, Amount | None]:
    """Return a number as a formula has it, and the value that it is where a line states it."""
    if not text.line:  # the column's name: a file of another number has another column
        return f"'{match['number'].replace(',', '.')} {unit}'", None
    pattern = number_pattern(text.line[: text.place + match.start("number")])
    key = normalise_label(name)
    return name, Amount(name, pattern, unit, to, text.line.strip(), own_unit=unit, key=key)


def _quantity(column: DraftColumn, words: str, unit: str) -> str:
    """Return what a column makes in a unit, by its name or by words; "" if that is not known."""
    kinds = [name for name in SYMBOLS if converts(unit, si_unit(name))]
    if kinds in (["position"], ["rotation_speed"]):
        return kinds[0]
    name = bare_name(column)[0]
    for text in (name, words, *re.findall(r"[^\W\d_]{4,}", words)):
        options = [option for option in matches(text, None) if option.score >= _KNOWN]
        if options and options[0].quantity in kinds:
            return options[0].quantity
    return ""
