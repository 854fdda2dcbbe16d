"""Settings in text: each line is parsed once, into numbers with units and texts with keys."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from tribolab.reading.interpret.amounts import Amount, Amounts
from tribolab.reading.interpret.names import matches, split_unit
from tribolab.reading.interpret.phrases import LONGEST_LINE, Phrase, label_of, phrases
from tribolab.reading.lexicon.lexicon import (
    alternatives,
    key_pattern,
    keys_of,
    normalise_label,
    part_pattern,
    plain_text,
    role_of,
    text_pattern,
    without_role,
)
from tribolab.reading.numbers import NUMBER, escaped
from tribolab.reading.unit_texts import (
    DIMENSIONS,
    converts,
    is_per_minute,
    is_unit,
    measures_something,
)
from tribolab.units.spellings import WEIGHTS, unit_in_words

_MAX_ENTRY = 1000  # characters of a line that are parsed, as searches take quadratic time
# "# rate: 10 Hz", "Set Force = -200", "Disc track radius used (mm)<tab>21.232"; of testXpert
# "Test speed";"mm/min";"100"
_ENTRY, _IN_CELLS = (  # `_IN_CELLS` is for commas: "Dead weight,500,g"
    re.compile(
        rf"(?P<before>\W*(?P<key>[^\W\d][^:：=\t;{mark}]*?)"
        rf"(?:\"?\s*[:：=]?\s*[:：=\t;{mark}]\s*\"?|\s{{2,80}})"
        rf"(?:(?P<ahead>[^\W\d][^\s;,\"]{{0,9}})\"?\s*[\t;{mark}]\s*\"?)?)"
        rf"(?:(?:\+/?-|±)\s?)?(?P<number>{number})[\s;{mark}\"]*"
        r"(?P<unit>1/[^\W\d]\w*|[^\s\d;,\"][^\s;,\"]*)?"
        r"(?:[\s;,\t\"]*(?:\(.*\))?|(?:[,;]| [-–—]) ?[^\W\d][^\d:：=]*)$"
    )
    for mark, number in (("", NUMBER), (",", NUMBER.replace(",", "")))
)
# TE 77: "Load (N),100,Frequency (Hz),10,Stroke (mm),15"; "x-velocity [mm/s]:<tab>100<tab>..."
# (liampond/EgbertsTribometer)
_PAIR = re.compile(
    r"(?:(?<=[;,\t])|^)\s*([^\W\d][^;,\t]{0,60}[\])]:?\s*[;,\t]\s*[-+\d.]+)(?=[;,\t\s]|$)"
)
_TURNS_FIRST = re.compile(  # "rpm 200"
    rf"(?P<before>\W*(?P<key>rpm)(?P<ahead>)\s+)(?P<number>{NUMBER})(?P<unit>)\s*$", re.IGNORECASE
)
_TEXT = re.compile(
    r"\W*(?P<key>[^\W\d][^:：=\t;]*?)(?:\"?\s*[:：=\t;]\s*|\s{2,80})[\"\[(]?(?P<text>[^\W\d].*)$"
)
_UNIT_ALONE = re.compile(  # "Units um", "Units,um"
    r"[\W_]*(?P<key>[^\W\d]\w{0,20}(?:\s[^\W\d]{1,10})?)(?P<gap>\s+|\"?\s*,\s*\"?)"
    r"[\[(]?(?P<unit>[^\W\d]{1,20})[\])]?\W*$"
)
_BRACKETS = re.compile(r"[\[(]([^\[\]()]+)[\])]")
_EITHER_WAY = re.compile(r"^\s*(?:\+/?-|±)")
_STEP_TITLE = re.compile(rf"\W*{alternatives('step')}\W*\d", re.IGNORECASE)
_STEP = re.compile(rf"{alternatives('step')}\d*n?")
_SET = {"normal_force": "set_normal_force", "sliding_velocity": "set_speed"}
# settings that are looked for in sentences, by the SI unit of the number
_WANTED = {
    "m": (
        *("track_radius", "track_diameter", "diameter", "outer_size", "turning", "tip_radius"),
        *("arm", "stroke", "half_stroke", "pitch", "profile_length"),
    ),
    "s": ("sampling_interval",),
    "m/s": ("sliding_speed", "machine_speed"),
    "rad/s": ("frequency", "rotation_speed"),
    "1/s": ("sampling_rate", "frequency", "rotation_speed"),
    "Hz": ("sampling_rate", "frequency", "rotation_speed"),
    "N": ("load", "zero"),
    "N m": ("zero",),
    "V": ("zero",),
}


@functools.lru_cache(maxsize=64)
def amounts_of(lines: tuple[str, ...], most: int) -> Amounts:
    """Return the amounts stated in lines of text, each with a unique name.

    Parameters
    ----------
    lines
        Lines above or below a table, or attributes of a container as ``key: value``.
    most
        Largest number of amounts.

    Examples
    --------
    >>> stated = amounts_of(("Track radius: 21,5 mm", "mean of 3, load of 2 kg on the arm"), 12)
    >>> [(a.key, a.number, a.own_unit) for a in stated]
    [('trackradius', 21.5, 'mm'), ('load', 2.0, 'kg')]
    >>> stated.only("load").si("N")
    19.6133
    """
    found: dict[str, Amount] = {}
    units = _separate_units(lines)
    for line in lines:
        if len(found) >= most:
            break
        line = line[:_MAX_ENTRY]
        entry = _entry(line.rstrip())
        # a digit before the colon means a time of day, unless it is a step number
        if entry and (not entry["key"][-1].isdigit() or _STEP_TITLE.match(entry["key"])):
            add_unique(found, _of_entry(entry, units))
            continue
        if pairs := _PAIR.findall(line):
            for pair in filter(None, map(_entry, pairs)):
                one = _of_entry(pair, units)
                start = one.pattern.removeprefix(r"^\s*")
                add_unique(found, one._replace(pattern=start, text=line.strip()))
            continue
        strokes = False
        for phrase in phrases(line):
            if strokes and not phrase.key:  # "stroke 5 mm at 2 Hz"
                phrase = phrase._replace(key="frequency")
            if amount := _of_phrase(phrase):
                add_unique(found, amount)
            strokes = key_pattern("stroke").search(phrase.key) is not None
    return Amounts(found.values())


@functools.lru_cache(maxsize=64)
def texts_of(lines: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    """Return pairs of key and text for settings in words; ``drive`` is the key of a stroke drive.

    >>> texts_of(("Drive: crank", "Units um", "an eccentric drive"))
    (('Drive', 'crank'), ('Units', 'um'), ('drive', 'crank'), ('drive', 'eccentric drive'))
    """
    lines = tuple(line[:_MAX_ENTRY] for line in lines)
    entries = (_TEXT.match(line.strip()) for line in lines)
    found = [(match["key"], match["text"].rstrip('"; ,')) for match in entries if match]
    alone = (_UNIT_ALONE.match(line.strip()) for line in lines)
    found += [(match["key"], match["unit"]) for match in alone if match and _names_a_unit(match)]
    drives = (_drive_in(line[:LONGEST_LINE]) for line in lines)
    return (*found, *(("drive", text) for text in drives if text))


def _drive_in(line: str) -> str:
    """Return the words of a line that name the drive of the strokes; "" if there are none.

    >>> _drive_in("Tribómetro biela-manivela")
    'biela-manivela'
    """
    match = text_pattern("drive").search(plain_text(line))
    words = list(re.finditer(r"[^\W_]+", line)) if match else []
    for place in reversed(range(len(words))):
        for last in words[place:]:
            text = line[words[place].start() : last.end()]
            if match and match[0].strip() in plain_text(text):
                return text
    return ""


def _names_a_unit(alone: re.Match[str]) -> bool:
    first, *more = alone["key"].lower().split()
    return first in keys_of("unit") or ("," in alone["gap"] and not more)


def _entry(line: str) -> re.Match[str] | None:
    entry = _ENTRY.match(line) or _IN_CELLS.match(line) or _TURNS_FIRST.match(line)
    # "Scan length 1.5 mm, 3000 points" is a sentence; "Load (steps 1 a 4);40 N" is not
    return None if entry and phrases(_BRACKETS.sub("", entry["key"])) else entry


def _separate_units(lines: tuple[str, ...]) -> dict[str, str]:
    """Return units stated in separate lines, by quantity: "Stroke unit: mm"."""
    unit = part_pattern("unit").pattern
    of = part_pattern("of").pattern
    apart = re.compile(rf"^(?P<key>.+?){unit}$|^{unit}(?:for|{of})?(?P<behind>.+)$")
    found = ((apart.match(normalise_label(key)), text) for key, text in texts_of(lines))
    return {match["key"] or match["behind"]: text.strip(" []()") for match, text in found if match}


def _of_entry(entry: re.Match[str], units: Mapping[str, str]) -> Amount:
    """Return the amount of a line that states one setting and nothing else."""
    key, unit = _key_and_unit(entry, units)
    digits = r"[-+\d.eE]+" if entry.re is _IN_CELLS else r"[-+\d.,eE]+"
    before = escaped(entry["before"].strip())
    if _STEP_TITLE.match(key):  # the step number in the key changes from step to step
        before = re.sub(r"\d+", r"\\d+", before)
    behind = entry.string[entry.end("before") :][:4]
    signs = r"(?:\+/?-|±)?\s*" if _EITHER_WAY.search(behind) else ""
    pattern = r"^\s*" + before + rf"\s*{signs}({digits})"
    plain = normalise_label(_BRACKETS.sub("", key))
    dimension = _dimension(unit)
    line = entry.string.strip()
    made = Amount(_name(key), pattern, unit, dimension, line, own_unit=unit, key=plain)
    if unit is None or dimension is None:
        return made._replace(unit=None, to=None)
    if dimension == "m/s" and made.means("machine_speed"):
        return made._replace(name="set_speed", to=None)
    options = matches(key, unit)
    if options and options[0].score > 0.5:
        quantity = _SET.get(options[0].quantity, options[0].quantity)
        bare = normalise_label(
            _BRACKETS.sub("", without_role(key) if role_of(key) == "set" else key)
        )
        made = made._replace(key=bare) if made._replace(key=bare).means("load") else made
        other = quantity == "set_normal_force" and not made.means("load")  # not a preload
        if quantity.startswith("set_") and not other:
            return made._replace(name=quantity, unit=options[0].unit or unit, to=None)
    return made


def _key_and_unit(entry: re.Match[str], units: Mapping[str, str]) -> tuple[str, str | None]:
    key, unit = entry["key"], entry["unit"] or entry["ahead"] or ""
    unit = unit_in_words(unit.strip("[]()")) or None
    bracket = _BRACKETS.search(key)
    if unit is None and bracket and measures_something(bracket[1]):
        unit, key = bracket[1], key[: bracket.start()]
    unit = unit or units.get(normalise_label(key))
    if unit is None and is_per_minute(key.strip()):
        return "rotation speed", key.strip()
    name, comma, behind = key.rpartition(",")
    if unit is None and comma and is_unit(behind.strip()):  # "Step, um: 0.5"
        return name, behind.strip()
    return split_unit(key) if unit is None and "_" in key else (key, unit)  # "stroke_mm=8"


def _of_phrase(phrase: Phrase) -> Amount | None:
    """Return the amount that a phrase states if a run or profile needs it, else None."""
    dimension = _dimension(phrase.unit)
    weight = phrase.unit in WEIGHTS
    wanted = _WANTED.get("N" if weight else dimension or "", ())
    label = label_of(phrase.line)
    if "load" in wanted and key_pattern("load").search(label) and _is_one_force(phrase):
        phrase = phrase._replace(key=label)  # "Load: dead weights of 5 kg"
    if "tip_radius" in wanted and key_pattern("tip_radius").search(label + phrase.key):
        phrase = phrase._replace(key=label + phrase.key)  # "Stylus: radius 2 um"
    speed = dimension == "m/s"
    made = Amount(
        "set_speed" if speed else _name(phrase.key),
        phrase.pattern,
        None if weight else phrase.unit,
        None if weight or speed else dimension,
        phrase.line,
        own_unit=phrase.unit,
        key=phrase.key,
    )
    turns = "rotation_speed" in wanted and _STEP.fullmatch(phrase.key)  # "Step 2: 30 rpm"
    return made if turns or made.means(*wanted) else None


def _is_one_force(phrase: Phrase) -> bool:
    """Whether a line states exactly one force or weight, with no number before it."""
    forces = [
        said for said in phrases(phrase.line) if converts(said.unit, "N") or said.unit in WEIGHTS
    ]
    before = phrase.line[: phrase.line.find(phrase.number)]
    return len(forces) == 1 and not re.search(r"\d", before)


def _dimension(unit: str | None) -> str | None:
    return next((d for d in DIMENSIONS if unit and converts(unit, d)), None)


def add_unique(found: dict[str, Amount], amount: Amount) -> None:
    """Add an amount to `found` under a unique name, unless it is there already."""
    if amount.name in found and amount.key == found[amount.name].key:
        return
    name, number = amount.name, 1
    while name in found and not amount.name.startswith("set_"):
        number += 1
        name = f"{amount.name}_{number}"
    found.setdefault(name, amount._replace(name=name))


def _name(key: str) -> str:
    words = (
        normalise_label(word).encode("ascii", "ignore").decode() for word in re.split(r"\W+|_", key)
    )
    return "_".join(filter(None, words)) or "value"
