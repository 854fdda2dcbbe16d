"""Single values beside the table: what the preamble and the file's name say, as proposals."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.words import matches, squeezed
from tribolab.draft.file.header import DIMENSIONS, converts, escaped, is_unit
from tribolab.draft.file.layout import Layout

_MOST = 12  # a long preamble is not repeated in the dialect
# "# rate: 10 Hz", "Set Force = -200", "Disc track radius used (mm)<tab>21.232"
_SAID = (
    r"(?P<before>\W*(?P<key>[^\W\d][^:=\t;{mark}]*?)\s*[:=\t;{mark}]\s*)"
    r"(?P<number>[-+]?\d[\d.{digits}]*(?:e[-+]?\d+)?)[\s;{mark}]*(?P<unit>[^\s\d;,][^\s;,]*)?"
    r"\s*[;,\t]*\s*(?:\(.*\))?$"
)
_SAYS = re.compile(_SAID.format(mark="", digits=","), re.IGNORECASE)
_IN_CELLS = re.compile(_SAID.format(mark=",", digits=""), re.IGNORECASE)  # "Dead weight,500,g"
_WORDS = re.compile(r"\W*(?P<key>[^\W\d][^:=\t;]*?)\s*[:=\t;]\s*(?P<text>[^\W\d].*)$")
_BRACKETS = re.compile(r"[\[(]([^\[\]()]+)[\])]")
_IN_NAME = re.compile(r"(?:^|_)(?P<number>\d+(?:\.\d+)?)(?P<unit>N|mN)(?=_|$)")
# a sample rate by its name; "Frequency" alone may be that of the strokes
_RATE = re.compile(
    r"^(?:rate|fs|daqrate)$|(?:sampl|abtast|acquisition|scan|log|data|mess).*(?:rate|freq)"
    r"|abtastrate|echantillonnage|muestreo|campionamento|采样|サンプリング"
)
# what passes from one sample to the next
_INTERVAL = re.compile(
    r"^(?:dt|deltat|timestep|timeinterval|zeitschritt|tsample|ts)$"
    r"|^(?:sampl|scan|log|mess|abtast|record|acquisition|data|zeit)\w*"
    r"(?:interval|period|time|intervall|periode|schritt|spacing)$"
    r"|intervallodicampionamento|perioded?echantillonnage|采样间隔|采样周期|サンプリング(?:間隔|周期)"
)
# the distance of a profile's points by its name
_PITCH = re.compile(
    r"^(?:d?x|deltax|pitch|spacing|increment|step|stepsize|interval|xscale|schritt\w*|pas|paso|passo)$"
    r"|(?:sampl|point|mess|punkt|data|x|lateral|measur|echantillon)\w*"
    r"(?:pitch|spacing|increment|step|interval|distance|abstand|schritt\w*|intervall)"
    r"|(?:pitch|spacing|increment|interval)(?:x|between\w*)?$"
)
_RADIUS = re.compile("radius|rayon|radio|raggio")
_FACTOR = re.compile(
    r"lever|hebel|arm\w*ratio|ratio\w*arm|levier|palanca|leva(?!l)|mechanicaladvantage"
    r"|scal(?:e|ing)(?:factor)?(?!d)|gain|multiplier|amplification|calibrationfactor|calfactor"
    r"|verstaerkung|skalierung|kalibrierfaktor|倍率|增益"
)
_OTHER_RADIUS = re.compile("ball|tip|sphere|kugel|probe|pin|stylus|cylinder|bille|bola|sfera")
# of the track, not of a ball or a disc
_DIAMETER = re.compile(
    r"(?:track|wear|spur|laufbahn|reib|friction|path|piste|traccia).*"
    r"(?:dia|durchmesser)|dia(?:m\w*)?.*(?:track|piste|traccia)"
)
_SET = {"normal_force": "set_normal_force", "sliding_velocity": "set_speed"}


class DraftValue(NamedTuple):
    """One value as a dialect's [[value]] would say it; `own_unit` is as the file writes it."""

    name: str
    pattern: str
    unit: str | None
    to: str | None
    text: str
    source: str = "preamble"
    own_unit: str | None = None
    scale: float = 1.0


def find_values(layout: Layout, *, bare: bool = False) -> list[DraftValue]:
    """Find the single values that a file and its name state, a dozen at most of the former.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    bare
        Whether to look above a table without a header, too.

    Returns
    -------
    list of DraftValue
        A dozen at most.
    """
    values: dict[str, DraftValue] = {}
    in_name = _IN_NAME.search(layout.file.path.stem)
    if in_name:
        pattern = rf"_(\d+(?:\.\d+)?){in_name['unit']}(?:_|\.)"
        if re.search(pattern, layout.file.path.name):
            name = layout.file.path.name
            value = DraftValue(
                "set_normal_force", pattern, in_name["unit"], None, name, "file name"
            )
            values[value.name] = value
    above = layout.blocks[0].start if bare and layout.blocks else 0
    stop = layout.heading.names if layout.heading else above
    for line in layout.lines[:stop]:
        said = _said(line.rstrip())
        # a digit before the colon: a time of day
        if len(values) >= _MOST:
            break
        if said and not said["key"][-1].isdigit():
            value = _value(said)
            values.setdefault(value.name, value)
    return list(values.values())


class Sampling(NamedTuple):
    """What the text before the table says of the distance of samples, and what of it is guessed.

    `unit` is one of frequency, or of time where it is an interval.
    """

    value: DraftValue
    unit: str
    guess: str = ""


def find_sampling(layout: Layout) -> Sampling | None:
    """Return the sample rate, or the interval of samples, before the table; None if there is none.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    for value in find_values(layout):
        said = _said(value.text)
        if said is None or value.source != "preamble":
            continue
        key, unit = squeezed(_BRACKETS.sub("", said["key"])), value.unit or value.own_unit
        interval = _INTERVAL.search(key) is not None
        if not interval and not _RATE.search(key):
            continue
        if unit and any(converts(unit, si_unit) for si_unit in ("Hz", "s")):
            return Sampling(value, unit)
        if unit is None:
            kind, si_unit = ("interval of samples", "s") if interval else ("sample rate", "Hz")
            return Sampling(value, si_unit, f"'{value.text}' is the {kind} in {si_unit}")
    return None


def find_factors(layout: Layout) -> list[DraftValue]:
    """Return what signals may still have to be multiplied by: levers, gains, scales; but not one.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    factors = []
    for value in find_values(layout):
        said = _said(value.text)
        if said and value.unit is None and _FACTOR.search(squeezed(said["key"])):
            number = float(said["number"].replace(",", "."))
            factors += [value] if number != 1 else []
    return factors


def words_said(layout: Layout) -> list[tuple[str, str]]:
    """Return what the text before the table says in words: "Drive: crank" as ("Drive", "crank").

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    stop = layout.heading.names if layout.heading else 0
    said = (_WORDS.match(line.strip()) for line in layout.lines[:stop])
    return [(match["key"], match["text"]) for match in said if match]


def key_of(value: DraftValue) -> str:
    """Return what a file calls a value, without its unit.

    Parameters
    ----------
    value
        From `find_values`.
    """
    said = _said(value.text)
    return _BRACKETS.sub("", said["key"]).strip() if said else ""


def find_pitch(layout: Layout) -> DraftValue | None:
    """Return the distance of a profile's points that the text before the heights states, or None.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    for value in find_values(layout, bare=True):
        key = _said(value.text)
        named = key is not None and _PITCH.search(squeezed(_BRACKETS.sub("", key["key"])))
        if named and value.source == "preamble" and value.unit and converts(value.unit, "m"):
            return value._replace(name="pitch", to="m")
    return None


def find_radius(values: Sequence[DraftValue]) -> DraftValue | None:
    """Return the radius of the track, if just one of a file's values is one, or its diameter.

    Parameters
    ----------
    values
        From `find_values`.
    """
    radii = [v for v in values if v.to == "m" and _RADIUS.search(v.name)]
    tracks = [v for v in radii if not _OTHER_RADIUS.search(v.name)]
    if not tracks:
        across = [v for v in values if v.to == "m" and _DIAMETER.search(squeezed(v.name))]
        tracks = [v._replace(name="track_radius", scale=0.5) for v in across]
    return tracks[0] if len(tracks) == 1 else None


def _said(line: str) -> re.Match[str] | None:
    return _SAYS.match(line) or _IN_CELLS.match(line)


def _value(said: re.Match[str]) -> DraftValue:
    key, unit = said["key"], (said["unit"] or "").strip("[]()") or None
    bracket = _BRACKETS.search(key)
    if unit is None and bracket and is_unit(bracket[1]):
        unit, key = bracket[1], key[: bracket.start()]
    digits = r"[-+\d.eE]+" if said.re is _IN_CELLS else r"[-+\d.,eE]+"
    pattern = r"^\s*" + escaped(said["before"].strip()) + rf"\s*({digits})"
    line = said.string.strip()
    dimension = next((d for d in DIMENSIONS if unit and converts(unit, d)), None)
    if unit is None or dimension is None:
        return DraftValue(_name(key), pattern, None, None, line, own_unit=unit)
    options = matches(key, unit)
    if options and options[0].score > 0.5:
        quantity = _SET.get(options[0].quantity, options[0].quantity)
        if quantity.startswith("set_"):
            read_as = options[0].unit or unit
            return DraftValue(quantity, pattern, read_as, None, line, own_unit=unit)
    return DraftValue(_name(key), pattern, unit, dimension, line, own_unit=unit)


def _name(key: str) -> str:
    words = [squeezed(word).encode("ascii", "ignore").decode() for word in re.split(r"\W+|_", key)]
    return "_".join(word for word in words if word) or "value"
