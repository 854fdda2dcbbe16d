"""What a volt or a count of a column is worth, where its own name or a line that names it says so.

"LVDT (2.50 mm/V)", "Bridge (100 N = 2.013 mV/V, 5 V)"; "cell_T: 51300 counts/N" above "cell_T".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.counts import COUNT_WORD, stated_offset
from tribolab.io.dialects.cells import split_name
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.names import COUNTS, matches
from tribolab.reading.interpret.patterns import number_pattern
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label
from tribolab.unit_names import WEIGHTS, unit_in_words

_LONGEST = 300  # characters of a line that are looked at
_KNOWN = 0.3  # share of a name that a known word makes up: its factor says of what kind it is
# symbols of signals, by what they are
SYMBOLS = {
    "friction_force": "friction_signal",
    "normal_force": "load_signal",
    "position": "way_signal",
    "rotation_speed": "turn_signal",
}
_SI_UNITS = {
    "friction_force": "N",
    "normal_force": "N",
    "position": "m",
    "rotation_speed": "rad/s",
}
_NUMBER = r"(?<![\d.,A-Za-z_])(?P<number>\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)"
_UNIT = r"[^\W\d_]{1,5}"
_RAW = rf"(?:[mµμu]?V|{COUNT_WORD})"
_PER = r"\s?(?:/|per|pro|par|por|al|a|na|на)\s?"
_WORTH = re.compile(rf"{_NUMBER}\s?(?P<unit>{_UNIT}){_PER}(?P<raw>{_RAW})(?![\w/])", re.IGNORECASE)
_SO_MANY = re.compile(
    rf"{_NUMBER}\s?(?P<raw>{_RAW}){_PER}(?P<unit>{_UNIT})(?![\w/])", re.IGNORECASE
)
# a bridge: what it gives at its rated load, of each volt that feeds it
_OUTPUT = re.compile(rf"{_NUMBER}\s?mV\s?/\s?V(?![\w/])")
_RATED = re.compile(rf"{_NUMBER}\s?(?P<unit>[kmM]?N|k?gf?|kp|lbf?)(?![\w/])")
_FACTOR_OF = (
    r"(?i:(?:gain|factor|sensitivity|scale|calibration(?: factor)?|faktor|verst[äa]rkung"
    r"|empfindlichkeit|kalibrier\w*)\s(?:of\s|for\s|von\s|f[üu]r\s)?)?"
)
_ENDS = re.compile(r";|\s{3,}")
_FED = re.compile(rf"{_NUMBER}\s?V(?![\w/])")


_ZeroOf = Literal["signal", "ratio", "made"]


class Gain(NamedTuple):
    """A signal that makes a quantity: its column, the formula, and what the latter rests on."""

    quantity: str
    column: DraftColumn
    formula: str
    about: str
    values: tuple[Amount, ...] = ()

    @property
    def symbol(self) -> str:
        """What the column is called in the formula."""
        return SYMBOLS[self.quantity]


class _Said(NamedTuple):
    """A text that speaks of a column: the line that it stands in ("" if the name), and where."""

    text: str
    line: str = ""
    place: int = 0


def stated_gains(layout: Layout, columns: Sequence[DraftColumn]) -> list[Gain]:
    """Return what volts and counts make, where a name or a line that names the column tells it.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        As they are understood. A quantity that a column holds already is not made.

    Returns
    -------
    list of Gain
        At most one of each quantity; none of a quantity that two columns would make.
    """
    held = {c.quantity for c in columns if c.quantity and (c.used or c.fill_in)}
    found: dict[str, list[Gain]] = {}
    bare = [bare_name(column)[0].strip() for column in columns]
    for column in columns:
        if column.used or column.form or not (raw := _raw_of(column)):
            continue
        label = split_name(column.label)[0]
        alone = bare.count(bare[column.place - 1]) == 1 and raw == "V"
        names = dict.fromkeys([label, bare[column.place - 1]] if alone else [label])
        gains = (_gain(column, raw, said) for said in _texts(layout, column, list(names)))
        gain = next((gain for gain in gains if gain is not None), None)
        if gain is not None and gain.quantity not in held:
            gain = gain._replace(column=with_unit(column) if raw == "V" else _counted(column))
            found.setdefault(gain.quantity, []).append(gain)
    return [gains[0] for gains in found.values() if len(gains) == 1]


def _raw_of(column: DraftColumn) -> str:
    """Return "V" of a column in volts, "count" of plain numbers; "" of any other.

    The N behind a stroke below may be the name's own: "cell_N" beside "cell_T".
    """
    _, unit, _ = bare_name(column)
    said = column.file_unit or column.unit or split_name(column.label)[1]
    if unit is None or unit == COUNTS or (not said and not converts(unit, "V")):
        return "count" if column.label else ""
    return "V" if converts(unit, "V") else ""


def with_unit(column: DraftColumn) -> DraftColumn:
    """Return a column with the unit that its name ends in, where nothing else says it: "load V"."""
    unit = column.unit or bare_name(column)[1]
    return column if column.file_unit is not None else column._replace(unit=unit)


def _counted(column: DraftColumn) -> DraftColumn:
    return column._replace(unit="1")


def _texts(layout: Layout, column: DraftColumn, names: Sequence[str]) -> Iterator[_Said]:
    """Go through what the column is called, and through what lines above say of its names."""
    yield _Said(column.label)
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
            if told := named.search(line):
                end = _ENDS.search(line, told.end())
                yield _Said(line[told.end() : end.start() if end else None], line, told.end())
    for line in lines:  # "motor: 400 steps/mm" of a column "steps"
        for match in _SO_MANY.finditer(line):
            if normalise_label(match["raw"]) == normalise_label(names[0]):
                yield _Said(line[match.start() :], line, match.start())


def _gain(column: DraftColumn, raw: str, said: _Said) -> Gain | None:
    return _by_ratio(column, raw, said) or (_by_bridge(column, said) if raw == "V" else None)


def _by_ratio(column: DraftColumn, raw: str, said: _Said) -> Gain | None:
    """Return what one ratio makes of a signal: "2.5 mm/V", "51300 counts/N"."""
    each, many = _WORTH.search(said.text), _SO_MANY.search(said.text)
    for match, multiplies in ((each, True), (many, False)):
        if match is None:
            continue
        unit = unit_in_words(match["unit"])
        unit = WEIGHTS.get(unit, unit)
        in_volts = converts(match["raw"], "V")
        quantity = _quantity(column, said.text[: match.start()], unit)
        if not quantity or in_volts != (raw == "V"):
            continue
        per = match["raw"] if in_volts else "1"
        whole = f"{unit}/{per}" if multiplies else f"{per}/{unit}"
        whole = unit if multiplies and per == "1" else whole
        number, values = _number(
            match, said, whole, f"{SYMBOLS[quantity]}_factor", _to(quantity, whole)
        )
        sign = "*" if multiplies else "/"
        name = SYMBOLS[quantity]
        zero = _zero_of(said, match, raw, quantity)
        if zero is None:
            return Gain(quantity, column, f"{name} {sign} {number}", _about(said), values)
        text, more, of = zero
        if of == "ratio":
            return None
        formula = f"({name} - {text}) {sign} {number}"
        formula = formula if of == "signal" else f"{name} {sign} {number} - {text}"
        return Gain(quantity, column, formula, _about(said), (*values, *more))
    return None


def _zero_of(
    said: _Said, factor: re.Match[str], raw: str, quantity: str
) -> tuple[str, tuple[Amount, ...], _ZeroOf] | None:
    """Return the zero that stands beside a factor: "0.0015 N/count, zero 118 counts".

    Returns
    -------
    tuple or None
        As a formula has it, the value that it rests on, and what it is one of: of the signal, of
        its ratio to what feeds a bridge, or of what the signal makes.
    """
    match = stated_offset(said.text, factor.end())
    if match is None or not float(match["number"].replace(",", ".")):
        return None
    unit = unit_in_words(match["unit"] or "")
    name = f"{SYMBOLS[quantity]}_zero"
    if converts(unit, _SI_UNITS[quantity]) and unit:
        return *_number(match, said, unit, name, _SI_UNITS[quantity]), "made"
    if "/" in unit and converts(unit, "1"):
        return *_number(match, said, unit, name, "1"), "ratio"
    if raw == "V":
        unit = unit if converts(unit, "V") else "V"
        return *_number(match, said, unit, name, "V"), "signal"
    return *_number(match, said, "1", name, "1"), "signal"


def _by_bridge(column: DraftColumn, said: _Said) -> Gain | None:
    """Return what a bridge's rated load and output make of its signal: "100 N = 2 mV/V, 5 V"."""
    output, rated = _OUTPUT.search(said.text), _RATED.search(said.text)
    fed = [match for match in _FED.finditer(said.text)]
    if output is None or rated is None or len(fed) != 1:
        return None
    unit = WEIGHTS.get(rated["unit"], rated["unit"])
    quantity = _quantity(column, said.text[: min(output.start(), rated.start())], unit)
    if not quantity:
        return None
    name = SYMBOLS[quantity]
    parts = [
        _number(rated, said, unit, f"{name}_rated_load", "N"),
        _number(output, said, "mV/V", f"{name}_rated_output", "1"),
        _number(fed[0], said, "V", f"{name}_excitation", "V"),
    ]
    load, gives, feeds = (text for text, _ in parts)
    values = tuple(value for _, more in parts for value in more)
    last = max((rated, output, fed[0]), key=lambda match: match.start())
    formula = f"{name} / {gives} / {feeds} * {load}"
    if (zero := _zero_of(said, last, "V", quantity)) is not None:
        text, more, of = zero
        values = (*values, *more)
        formula = {
            "signal": f"({name} - {text}) / {gives} / {feeds} * {load}",
            "ratio": f"({name} / {feeds} - {text}) / {gives} * {load}",
            "made": f"{formula} - {text}",
        }[of]
    return Gain(quantity, column, formula, _about(said), values)


def _number(
    match: re.Match[str], said: _Said, unit: str, name: str, to: str
) -> tuple[str, tuple[Amount, ...]]:
    """Return a number as a formula has it, and the value that it is where a line states it."""
    if not said.line:  # the column's name: a file of another number has another column
        return f"'{match['number'].replace(',', '.')} {unit}'", ()
    pattern = number_pattern(said.line[: said.place + match.start("number")])
    value = Amount(
        name, pattern, unit, to, said.line.strip(), own_unit=unit, key=normalise_label(name)
    )
    return name, (value,)


def _to(quantity: str, unit: str) -> str:
    """Return the SI unit of a factor."""
    si_unit = _SI_UNITS[quantity]
    forms = (si_unit, f"{si_unit}/V", f"V/{si_unit}", f"1/{si_unit}")
    return next(form for form in forms if converts(unit, form))


def _about(said: _Said) -> str:
    return f"a signal, and '{said.line.strip()}'" if said.line else "a signal, and its own name"


def _quantity(column: DraftColumn, words: str, unit: str) -> str:
    """Return what a column makes in a unit, by its name or by words; "" if that is not told."""
    kinds = [name for name, si_unit in _SI_UNITS.items() if converts(unit, si_unit)]
    if kinds in (["position"], ["rotation_speed"]):
        return kinds[0]
    name = bare_name(column)[0]
    for text in (name, words, *re.findall(r"[^\W\d_]{4,}", words)):
        options = [option for option in matches(text, None) if option.score >= _KNOWN]
        if options and options[0].quantity in kinds:
            return options[0].quantity
    return ""
