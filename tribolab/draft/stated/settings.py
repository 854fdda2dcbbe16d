"""Single values beside the table: what the preamble and the file's name say, as proposals."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from tribolab.draft.file.layout import Layout
from tribolab.draft.file.marks import STEP_WORD
from tribolab.draft.words.levers import weight_on_lever
from tribolab.draft.words.named_radius import radius_in_name
from tribolab.draft.words.sentences import Phrase, label_of, phrases
from tribolab.draft.words.stated_words import (
    ACROSS,
    ARM,
    DIAMETER,
    FREQUENCY,
    HALF_STROKE,
    INTERVAL,
    LOAD,
    PITCH,
    PROFILE_LENGTH,
    RADIUS,
    RATE,
    STROKE,
    TIP,
    TURNING,
)
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.interpret.patterns import escaped
from tribolab.reading.interpret.unit_texts import DIMENSIONS, converts, is_unit
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, role_of, without_role
from tribolab.unit_names import WEIGHTS, unit_in_words

_MOST = 12  # a long preamble is not repeated in the dialect
_MOST_OF_SCAN = 200  # settings of a profilometer, among which the few that count may come last
# "# rate: 10 Hz", "Set Force = -200", "Disc track radius used (mm)<tab>21.232"
_SAID = (
    r"(?P<before>\W*(?P<key>[^\W\d][^:：=\t;{mark}]*?)(?:\"?\s*[:：=]?\s*[:：=\t;{mark}]\s*\"?|\s{{2,80}}))"
    r"(?:(?:\+/?-|±)\s?)?(?P<number>[-+]?\d[\d.{digits}]*(?:e[-+]?\d+)?)[\s;{mark}\"]*"
    r"(?P<unit>1/[^\W\d]\w*|[^\s\d;,\"][^\s;,\"]*)?"
    r"(?:[\s;,\t\"]*(?:\(.*\))?|(?:[,;]| [-–—]) ?[^\W\d][^\d:：=]*)$"
)
_SAYS = re.compile(_SAID.format(mark="", digits=","), re.IGNORECASE)
_IN_CELLS = re.compile(_SAID.format(mark=",", digits=""), re.IGNORECASE)  # "Dead weight,500,g"
_A_UNIT = (
    r"(?:unita|unites?|unidade?s?|units?|einheit(?:en)?|eenheid|enhet|jednostka|jednotka|单位|単位)"
)
_UNIT_OF = re.compile(  # "Stroke unit", "UnitaPasso"
    rf"^(?P<key>.+?){_A_UNIT}$"
    rf"|^{_A_UNIT}(?:of|de|du|di|del|della|der|des|von|van|for)?(?P<behind>.+)$"
)
_WORDS = re.compile(
    r"\W*(?P<key>[^\W\d][^:：=\t;]*?)(?:\"?\s*[:：=\t;]\s*|\s{2,80})[\"\[(]?(?P<text>[^\W\d].*)$"
)
_UNIT_SAID = re.compile(  # "Units um", "単位,μm"
    r"[\W_]*(?P<key>(?:units?|einheit(?:en)?|unit[éeà]s?|unidad(?:es)?|eenheid|jednostk[ai]|jednotk[ay]"
    r"|enhet|yksikkö|birim|egység|единиц[аы]|단위|单位|単位)(?:\s[^\W\d]{1,10})?|[^\W\d]\w{0,20}(?=\s*,))"
    r"(?:\s+|\"?\s*,\s*\"?)[\[(]?(?P<unit>[^\W\d]{1,20})[\])]?\W*$",
    re.IGNORECASE,
)
_LONGEST_ENTRY = 1000  # characters of a line with a key: searches take their square
_LONGEST = 200  # characters of a line that are looked at
_DRIVEN = re.compile(  # "reciprocating rig, crank drive"
    r"\b(?:crank|scotch[- ]yoke|eccentric|kurbel|exzenter)"
    r"[- ]?(?:driv\w*|(?:an)?trieb\w*|mechanism)"
    r"|\b(?:sinusoidal|sinusf[oö]rmige?|triangular|constant[- ]speed)"
    r" (?:motion|strokes?|bewegung)"
    r"|\b(?:movimi?ento|moto|mouvements?) (?:senoidal|sinuso[iï]d\w*|arm[oó]nico|harmonique)"
    r"|\bsinus(?:vormig\w*|formad\w*|formet\w*|oidaln\w*)"
    r"|\bsinusf[oö]rmig\w*|\bkurbel(?:schleife|schwinge)\b|\bkreuzschubkurbel\b"
    r"|\bcrank(?:[- ]slider)?\b|\b(?:excéntrica|exc[eê]ntrico|eccentrico|exzenter)\b"
    r"|\b(?:vevdriv\w+|vevdrift|veivdrift|krumtapdrift|kampikäyttö|biel\w+[- ]maniv\w+|manivelle"
    r"|krank[- ]biyel|sinüs\w* hareket\w*|korbow\w+|klikov\w+|кривошип\w*|forgattyús?\w*)"
    r"|曲柄|クランク|크랭크|正弦运动|正弦運動",
    re.IGNORECASE,
)
_BRACKETS = re.compile(r"[\[(]([^\[\]()]+)[\])]")
_EITHER_WAY = re.compile(r"^\s*(?:\+/?-|±)")
_SPEED_IN_NAME = re.compile(
    r"(?:^|[_\- ])(?P<number>\d+(?:\.\d+)?)(?P<unit>[mu]m)(?P<per>p?s|_s|-s| s)(?=[_\- .]|$)"
)
_STROKE_IN_NAME = re.compile(
    r"(?:^|(?<=[_\- ]))(?P<key>(?:stroke|hub|course|carrera|corsa|curso|slag|skok|zdvih|loket)"
    r"(?:length)?[_=-]?)(?P<number>\d+(?:[.,]\d+)?)[_ ]?(?P<unit>mm|cm)(?![^\W_])",
    re.IGNORECASE,
)
_HERTZ_IN_NAME = re.compile(r"(?:^|[_\- f])(?P<number>\d+(?:[.,]\d+)?)[_ ]?Hz(?![^\W_])")
_IN_NAME = re.compile(r"(?:^|_)(?P<number>\d+(?:\.\d+)?)(?P<unit>N|mN)(?=_|$)")
_SET = {"normal_force": "set_normal_force", "sliding_velocity": "set_speed"}


class Amount(NamedTuple):
    """One value as a dialect's [[value]] would say it; `own_unit` is as the file writes it.

    `key` is what the file calls it, squeezed; `guess` what of it is one.
    """

    name: str
    pattern: str
    unit: str | None
    to: str | None
    text: str
    source: str = "preamble"
    own_unit: str | None = None
    scale: float = 1.0
    key: str = ""
    guess: str = ""

    @property
    def number(self) -> float:
        """The number as the file has it; NaN where it is none."""
        match = re.search(self.pattern, self.text)
        try:
            return float(match[1].replace(",", ".")) if match else math.nan
        except ValueError:
            return math.nan


def _text_above(layout: Layout, *, bare: bool) -> tuple[str, ...]:
    lines = layout.text_above(bare=bare or layout.width == 1)
    return tuple(line[:_LONGEST_ENTRY] for line in lines)


def numeric_settings(layout: Layout, *, bare: bool = False) -> list[Amount]:
    """Find the single values that a file and its name state, a dozen at most of the former.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    bare
        Whether heights are meant: a table may have no header, and instruments write many settings.

    Returns
    -------
    list of Amount
        A dozen at most, of heights more.
    """
    values: dict[str, Amount] = {}
    name = layout.file.path.name
    if radius := radius_in_name(name):
        values["track_radius"] = Amount(
            *("track_radius", radius.pattern, radius.unit, "m", name, "file name", radius.unit),
            scale=radius.scale,
            key="trackradius",
            guess=radius.guess,
        )
    if speed := _speed_in_name(layout.file.path):
        values[speed.name] = speed
    values |= {value.name: value for value in _strokes_in_name(name)}
    in_name = _IN_NAME.search(layout.file.path.stem)
    if in_name:
        pattern = rf"_(\d+(?:\.\d+)?){in_name['unit']}(?:_|\.)"
        if re.search(pattern, layout.file.path.name):
            name = layout.file.path.name
            value = Amount("set_normal_force", pattern, in_name["unit"], None, name, "file name")
            values[value.name] = value
    units = _units_apart(layout, bare=bare)
    for line in _text_above(layout, bare=bare):
        said = _said(line.rstrip())
        if len(values) >= (_MOST_OF_SCAN if bare else _MOST):
            break
        # a digit before the colon: a time of day, if it is not the number of a step
        if said and (not said["key"][-1].isdigit() or _STEP_TITLE.match(said["key"])):
            _keep(values, _value(said, units))
        else:
            strokes = False
            for phrase in phrases(line):
                if strokes and not phrase.key:  # "stroke 5 mm at 2 Hz"
                    phrase = phrase._replace(key="frequency")
                if stated := _of_phrase(phrase):
                    _keep(values, stated)
                strokes = STROKE.search(phrase.key) is not None
    return [_of_steps(value, layout) for value in values.values() if _holds_on(value, layout)]


def _holds_on(value: Amount, layout: Layout) -> bool:
    """Whether no line between the rows states another: "Step 2: 30 rpm" below "Step 1: 10 rpm"."""
    if layout.skip_lines is None or value.source != "preamble":
        return True
    skipped = re.compile(layout.skip_lines)
    inside = [line for block in layout.blocks for line in layout.lines[block.start : block.stop]]
    texts = "\n".join(line for line in inside if line.strip() and skipped.match(line))
    said = {match[1] for match in re.finditer(value.pattern, texts, re.MULTILINE)}
    first = re.search(value.pattern, value.text)
    return not said - {first[1] if first else ""}


def _of_steps(value: Amount, layout: Layout) -> Amount:
    """Return a value as one of each step, where the text before later tables says another."""
    if not layout.repeats or value.source != "preamble":
        return value
    edges = [0, *(edge for block in layout.blocks for edge in (block.start, block.stop))]
    texts = ["\n".join(layout.lines[a:b]) for a, b in zip(edges[::2], edges[1::2], strict=False)]
    said = {match[1] for text in texts for match in re.finditer(value.pattern, text, re.MULTILINE)}
    return value._replace(source="step") if len(said) > 1 else value


def _speed_in_name(path: Path) -> Amount | None:
    """Return the speed that a file's name states: PTFE_3N_10mms.csv."""
    match = _SPEED_IN_NAME.search(path.stem)
    if match is None:
        return None
    pattern = rf"(?:^|[_\- ])(\d+(?:\.\d+)?){match['unit']}{match['per']}(?:[_\- .])"
    unit = f"{match['unit']}/s"
    key = "slidingspeed"
    return Amount("set_speed", pattern, unit, None, path.name, "file name", unit, key=key)


def _strokes_in_name(name: str) -> list[Amount]:
    """Return the stroke that a file's name states, and how often it comes: stroke8mm_2Hz.csv."""
    stroke, often = _STROKE_IN_NAME.search(name), _HERTZ_IN_NAME.search(name)
    if stroke is None:  # frequencies alone may be how often samples are taken
        return []
    key, unit = re.escape(stroke["key"]), stroke["unit"]
    pattern = rf"{key}(\d+(?:[.,]\d+)?)[_ ]?{unit}"
    found = [Amount("stroke", pattern, unit, "m", name, "file name", unit, key="stroke")]
    if often is not None:
        pattern, said = r"(?:^|[_\- f])(\d+(?:[.,]\d+)?)[_ ]?Hz", "frequency"
        found.append(Amount(said, pattern, "Hz", "Hz", name, "file name", "Hz", key=said))
    return found


def _keep(values: dict[str, Amount], value: Amount) -> None:
    """Keep a value, under a name of its own: letters of the east make none."""
    if value.name in values and value.key == values[value.name].key:
        return
    name, number = value.name, 1
    while name in values and not value.name.startswith("set_"):
        number += 1
        name = f"{value.name}_{number}"
    values.setdefault(name, value._replace(name=name))


def text_settings(layout: Layout, *, bare: bool = False) -> list[tuple[str, str]]:
    """Return what the text before the table says in words: "Drive: crank" as ("Drive", "crank").

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    bare
        Whether to look above a table without a header, too.
    """
    above = _text_above(layout, bare=bare)
    said = (_WORDS.match(line.strip()) for line in above)
    told = [(match["key"], match["text"]) for match in said if match]
    cells = (_UNIT_SAID.match(line.strip()) for line in above)
    told += [(match["key"], match["unit"]) for match in cells if match]
    drives = (_DRIVEN.search(line[:_LONGEST]) for line in above)
    told = [(key, text.rstrip('"; ,')) for key, text in told]
    return told + [("drive", match[0]) for match in drives if match]


def _said(line: str) -> re.Match[str] | None:
    said = _SAYS.match(line) or _IN_CELLS.match(line)
    # "Scan length 1.5 mm, 3000 points": a sentence; "Load (steps 1 a 4);40 N": none
    return None if said and phrases(_BRACKETS.sub("", said["key"])) else said


def _units_apart(layout: Layout, *, bare: bool) -> dict[str, str]:
    """Return units that stand in lines of their own, by whose they are: "Stroke unit: mm"."""
    said = [
        (_UNIT_OF.match(normalise_label(key)), text)
        for key, text in text_settings(layout, bare=bare)
    ]
    return {match["key"] or match["behind"]: text.strip(" []()") for match, text in said if match}


def _value(said: re.Match[str], units: Mapping[str, str]) -> Amount:
    key, unit = said["key"], unit_in_words((said["unit"] or "").strip("[]()")) or None
    bracket = _BRACKETS.search(key)
    if unit is None and bracket and is_unit(bracket[1]):
        unit, key = bracket[1], key[: bracket.start()]
    unit = unit or units.get(normalise_label(key))
    name, comma, behind = key.rpartition(",")
    if unit is None and comma and is_unit(behind.strip()):  # "Step, um: 0.5"
        key, unit = name, behind.strip()
    if unit is None and "_" in key:  # "stroke_mm=8"
        key, unit = split_unit(key)
    digits = r"[-+\d.eE]+" if said.re is _IN_CELLS else r"[-+\d.,eE]+"
    before = escaped(said["before"].strip())
    if _STEP_TITLE.match(key):  # the next step has another number
        before = re.sub(r"\d+", r"\\d+", before)
    signs = r"(?:\+/?-|±)?\s*" if _EITHER_WAY.search(said.string[said.end("before") :][:4]) else ""
    pattern = r"^\s*" + before + rf"\s*{signs}({digits})"
    line = said.string.strip()
    plain = normalise_label(_BRACKETS.sub("", key))
    dimension = next((d for d in DIMENSIONS if unit and converts(unit, d)), None)
    if unit is None or dimension is None:
        return Amount(_name(key), pattern, None, None, line, own_unit=unit, key=plain)
    if dimension == "m/s" and _MACHINE_SPEED.search(plain):
        return Amount("set_speed", pattern, unit, None, line, own_unit=unit, key=plain)
    options = matches(key, unit)
    if options and options[0].score > 0.5:
        quantity = _SET.get(options[0].quantity, options[0].quantity)
        name = without_role(key) if role_of(key) == "set" else key
        bare = normalise_label(_BRACKETS.sub("", name))
        plain = bare if LOAD.search(bare) else plain
        other = quantity == "set_normal_force" and not LOAD.search(plain)  # a preload is none
        if quantity.startswith("set_") and not other:
            read_as = options[0].unit or unit
            return Amount(quantity, pattern, read_as, None, line, own_unit=unit, key=plain)
    return Amount(_name(key), pattern, unit, dimension, line, own_unit=unit, key=plain)


def lines_without_unit(layout: Layout, *, bare: bool = False) -> list[str]:
    """Return the lines that state a length, a load or how often strokes come, but no unit of it.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    bare
        Whether heights are meant: lines that state how far they lie apart, or how long they are.
    """
    wanted = (PITCH, PROFILE_LENGTH) if bare else (RADIUS, DIAMETER, ARM, STROKE, FREQUENCY, LOAD)
    return [
        value.text
        for value in numeric_settings(layout, bare=bare)
        if value.own_unit is None and any(words.search(value.key) for words in wanted)
    ]


def _of_phrase(phrase: Phrase) -> Amount | None:
    """Return what a sentence states, if it is one of the things that a run or profile needs."""
    dimension = next((d for d in DIMENSIONS if converts(phrase.unit, d)), None)
    weight = phrase.unit in WEIGHTS
    wanted = _WANTED.get("N" if weight else dimension or "", ())
    label = label_of(phrase.line)
    if LOAD in wanted and LOAD.search(label) and _one_force(phrase):
        phrase = phrase._replace(key=label)  # "Load: dead weights of 5 kg"
    if TIP in wanted and TIP.search(label + phrase.key):
        phrase = phrase._replace(key=label + phrase.key)  # "Stylus: radius 2 um"
    if not any(words.search(phrase.key) for words in wanted):
        return None
    lever = weight_on_lever(phrase.line) if weight else 0.0
    speed = dimension == "m/s"
    return Amount(
        "set_speed" if speed else _name(phrase.key),
        phrase.pattern,
        None if weight else phrase.unit,
        None if weight or speed else dimension,
        phrase.line,
        own_unit=phrase.unit,
        scale=lever or 1.0,
        key=phrase.key,
    )


def _one_force(phrase: Phrase) -> bool:
    """Whether the only force or weight of a line is the first number in it: no range of several."""
    forces = [
        said for said in phrases(phrase.line) if converts(said.unit, "N") or said.unit in WEIGHTS
    ]
    before = phrase.line[: phrase.line.find(phrase.number)]
    return len(forces) == 1 and not re.search(r"\d", before)


_STEP_TITLE = re.compile(rf"\W*{STEP_WORD}\W*\d", re.IGNORECASE)
_R = re.compile(r"^(?:r|d|ø|⌀|od)$|(?:ring|roller|wheel)od$")
_SPEED = key_pattern("sliding_speed")
# how fast a machine pulls or drives, in any of its languages
_MACHINE_SPEED = key_pattern("machine_speed")
_TURNS = re.compile(rf"{key_pattern('rotation_speed').pattern}|^{STEP_WORD}\d*n?$")
_WANTED = {
    "m": (
        *(RADIUS, DIAMETER, ACROSS, _R, TURNING, TIP),
        *(ARM, STROKE, HALF_STROKE, PITCH, PROFILE_LENGTH),
    ),
    "s": (INTERVAL,),
    "m/s": (_SPEED, _MACHINE_SPEED),
    "rad/s": (FREQUENCY, _TURNS),
    "1/s": (RATE, FREQUENCY, _TURNS),
    "Hz": (RATE, FREQUENCY, _TURNS),
    "N": (LOAD,),
}


def _name(key: str) -> str:
    words = [
        normalise_label(word).encode("ascii", "ignore").decode() for word in re.split(r"\W+|_", key)
    ]
    return "_".join(word for word in words if word) or "value"
