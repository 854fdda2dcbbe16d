"""Reading of binary records that are described by a text header or by a dialect."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import ReadError
from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable, Setting
from tribolab.reading.unit_texts import is_unit_of_key, without_unit

_MAX_HEADER = 1 << 16  # most bytes of a header
_SETTING = re.compile(r"^[\s#;*%/!]*(?P<key>[^\W\d][\w .\-/]{0,40}?)\s*[=:]\s*(?P<value>\S.*?)\s*$")
_OFFSET = re.compile(r"(?:header|head|data)[ _-]?(?:bytes|size|length|offset|start)|offset")
_TYPE = re.compile(r"(?:data|sample|number|value|num)?[ _-]?(?:type|format)|dtype|datatype")
_ORDER = re.compile(r"byte[ _-]?order|endian(?:ness)?")
_COUNT = re.compile(r"(?:n|num|number of)?[ _-]?(?:channels|columns|fields)|nchan\w*")
_CHANNEL = re.compile(r"(?:ch|chan|channel|col|column|field|var|signal)[ _.-]?(?P<number>\d{1,3})")
_NAMES = re.compile(r"(?:channel|column|field|signal)?[ _-]?(?:names|channels|columns|fields)")
_LAYOUT = re.compile(r"layout|arrangement|order|storage|interleav\w*")
_APART = re.compile(r"non.?interleav|not interleav|planar|block|sequential|by.?channel", re.I)
_END = re.compile(
    r"^\W*(?:end[ _-]?(?:of[ _-]?)?head(?:er)?|header[ _-]?end|eoh"
    r"|(?:begin|start)[ _-]?(?:of[ _-]?)?data|data[ _-]?(?:begin|start)|data|binary)\W*$",
    re.IGNORECASE | re.MULTILINE,
)
_TYPES = {
    **dict.fromkeys(("int16", "i2", "short", "s16", "integer16", "i16"), "i2"),
    **dict.fromkeys(("uint16", "u2", "ushort", "u16", "unsigned short"), "u2"),
    **dict.fromkeys(("int32", "i4", "long", "s32", "i32", "int"), "i4"),
    **dict.fromkeys(("uint32", "u4", "ulong", "u32"), "u4"),
    **dict.fromkeys(("float32", "f4", "single", "float", "real32", "r4", "f32"), "f4"),
    **dict.fromkeys(("float64", "f8", "double", "real64", "r8", "f64"), "f8"),
}
_PAIR = re.compile(r"(?P<key>[^\W\d]\w*)\s*=\s*(?P<value>[^\s,;(]+)")
_UNIT, _SCALE = keys_of("unit"), ("scale", "gain", "factor", "slope", "mult", "multiplier")
_BIAS = ("bias", "offset", "intercept")
_FORMULA = re.compile(r"\(\s*\w+\s*(?P<sign>[-+])\s*(?:offset|bias|intercept)\s*\)\s*[*x×]", re.I)
_TURN = re.compile(
    r"(?P<counts>\d{2,9})\s*(?:counts|cts|ticks|pulses|increments|steps|lines)?\s*"
    r"(?:per|/|a|pro)\s*(?:turn|rev|revolution|umdrehung|tour)",
    re.IGNORECASE,
)
_WRAPS = re.compile(r"wrap|roll.?over|overflow|restarts|back to 0", re.IGNORECASE)
_WRAPS_AT = re.compile(
    r"(?:wraps?|roll.?over|overflows?)\s*(?:at|after|every)\s*(?P<at>\d{2,10})", re.I
)


class _Channel(NamedTuple):
    """Name, unit, scale and bias of a channel; for an encoder also counts per turn and wrap."""

    name: str
    unit: str
    scale: float
    bias: float
    turn: float = 0.0
    wrap: float = 0.0


class _Records(NamedTuple):
    """Header of binary records: settings, and offset [bytes], type and channels of numbers."""

    settings: list[Setting]
    offset: int
    kind: np.dtype[np.generic]
    channels: list[_Channel]
    interleaved: bool


def declares_records(head: bytes) -> bool:
    """Whether a file begins with a text header that declares the binary numbers after it."""
    return _declared(head) is not None


def read_declared_records(path: Path) -> RawFile:
    """Read a file of binary numbers that are declared by a text header.

    Raises
    ------
    ReadError
        If the header declares no records.

    Notes
    -----
    Counts of an encoder that wraps are unwrapped and converted to turns, assuming that it moves
    less than half of its range per row.
    """
    with path.open("rb") as file:
        records = _declared(file.read(_MAX_HEADER))
        size = file.seek(0, 2)
    if records is None:
        raise ReadError("no header says how its binary numbers are to be read", where=path)
    rows = (size - records.offset) // records.kind.itemsize // len(records.channels)
    shape = (rows, len(records.channels)) if records.interleaved else (len(records.channels), rows)
    raw = np.memmap(path, records.kind, "r", records.offset, shape) if rows else np.empty(shape)
    table = raw if records.interleaved else raw.T
    columns = tuple(
        RawColumn(channel.name, channel.unit or None, _in_units(table[:, place], channel))
        for place, channel in enumerate(records.channels)
    )
    return RawFile(path, "declared records", (RawTable("", columns),), tuple(records.settings))


def _in_units(raw: np.ndarray, channel: _Channel) -> np.ndarray:
    values = np.asarray(raw, dtype=float)
    if channel.turn and channel.wrap:
        values = np.unwrap(values, period=channel.wrap)
    with np.errstate(over="ignore", invalid="ignore"):  # damaged numbers may have any value
        values = values / channel.turn if channel.turn else values * channel.scale + channel.bias
    return np.where(np.isfinite(values), values, np.nan)


def _declared(head: bytes) -> _Records | None:
    first = head[:_MAX_HEADER]
    text = first.split(b"\0")[0].decode("latin-1")
    settings: dict[str, str] = {}
    for line in text.replace("\r", "").split("\n"):
        if (setting := _SETTING.match(line)) and line.isprintable():
            settings.setdefault(setting["key"].strip().lower(), setting["value"])
    kind = _kind(settings)
    end = _END.search(text)
    offset = _whole(_first(settings, _OFFSET)) or (_end_of_line(text, end) if end else 0)
    if kind is None or not offset or offset > len(head):
        return None
    above = text[: min(offset, end.start() if end else offset)]
    channels = _channels(settings, above)
    count = _whole(_first(settings, _COUNT))
    if not channels or (count and count != len(channels)):
        return None
    how = _first(settings, _LAYOUT)
    return _Records(_settings_in(above), offset, kind, channels, not _APART.search(how))


def _end_of_line(text: str, mark: re.Match[str]) -> int:
    """Return the offset after the line that ends the header; 0 if this line is incomplete."""
    end = text.find("\n", mark.start() + len(mark[0].rstrip()))
    return end + 1 if end >= 0 else 0


def _first(settings: dict[str, str], pattern: re.Pattern[str]) -> str:
    return next((v for k, v in settings.items() if pattern.fullmatch(k)), "")


def _whole(text: str) -> int:
    number = re.match(r"\d+", text)
    return int(number[0]) if number else 0


def _kind(settings: dict[str, str]) -> np.dtype[np.generic] | None:
    kind = _first(settings, _TYPE).lower().strip("\"' ")
    order = _first(settings, _ORDER).lower()
    big = bool(re.search(r"big|msb|motorola|be\b|>", order or kind))
    bare = re.sub(r"[<>=]|[ _-]?(?:le|be|little|big)(?:[ _-]?endian)?$", "", kind).strip()
    name = _TYPES.get(bare)
    return np.dtype((">" if big else "<") + name) if name else None


def _channels(settings: dict[str, str], text: str) -> list[_Channel]:
    numbered = {int(m["number"]): v for k, v in settings.items() if (m := _CHANNEL.fullmatch(k))}
    listed = [numbered[k] for k in sorted(numbered)]
    if not listed:
        text_of = next((v for k, v in settings.items() if _NAMES.fullmatch(k) and "," in v), "")
        listed = [name.strip() for name in text_of.split(",")] if text_of else []
    formula = _FORMULA.search(text)
    found = [_channel(declared, formula["sign"] if formula else "") for declared in listed]
    names = [channel.name for channel in found]
    return found if all(names) and len(set(names)) == len(names) else []


def _channel(declared: str, inside: str) -> _Channel:
    """Parse the declaration of a channel; `inside` is the sign in (raw - offset) * scale.

    >>> _channel("FT unit=N scale=0.1 bias=2", "")[:4], _channel("FN, N", "")[:2]
    (('FT', 'N', 0.1, 2.0), ('FN', 'N'))
    >>> _channel("enc unit=counts (4096 per turn, wraps to 0)", "")
    _Channel(name='angle', unit='turn', scale=1.0, bias=0.0, turn=4096.0, wrap=4096.0)
    """
    pairs = {m["key"].lower(): m["value"] for m in _PAIR.finditer(declared)}
    start = _PAIR.search(declared)
    plain = (declared[: start.start()] if start else declared).strip(" ,;\t\"'")
    name, unit = _split_name(plain)
    words = [word.strip() for word in re.split(r"[,;\t]", name)]
    unit = next((pairs[k] for k in _UNIT if k in pairs), unit)
    if not unit and len(words) > 1 and is_unit_of_key(words[1]):
        unit = words[1]
    scale = _number(next((pairs[k] for k in _SCALE if k in pairs), ""), 1.0)
    bias = _number(next((pairs[k] for k in _BIAS if k in pairs), ""), 0.0)
    bias = {"-": -bias * scale, "+": bias * scale}.get(inside, bias)
    turn = _TURN.search(declared)
    if turn and _WRAPS.search(declared):
        at = _WRAPS_AT.search(declared)
        counts = float(turn["counts"])
        wrap = float(at["at"]) if at else counts
        return _Channel("angle", "turn", 1.0, 0.0, counts, wrap)
    return _Channel(words[0], "" if unit == "-" else unit, scale, bias)


def _split_name(text: str) -> tuple[str, str]:
    """Return a name and the unit in brackets after it."""
    found = re.fullmatch(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]", text)
    return (found["name"], found["unit"].strip()) if found else (text, "")


def _number(text: str, otherwise: float) -> float:
    try:
        return float(text)
    except ValueError:
        return otherwise


def _settings_in(text: str) -> list[Setting]:
    """Return the lines of a header as settings, except those that declare channels."""
    found: list[Setting] = []
    for line in text.replace("\r", "").split("\n"):
        setting = _SETTING.match(line)
        if setting and _CHANNEL.fullmatch(setting["key"].lower()):
            continue
        if setting and re.fullmatch(r"[-+]?[\d.]+(?:e[-+]?\d+)?", setting["value"], re.IGNORECASE):
            key, unit = without_unit(setting["key"])
            found.append(Setting(key, f"{setting['value']} {unit}".rstrip()))
        elif line.strip():
            found.append(Setting("", line))
    return found


def read_records(path: Path, record: np.dtype[np.void], offset: int) -> RawFile:
    """Read a file of binary records of one type; each field is a column.

    Parameters
    ----------
    path
        The file.
    record
        Type of a record.
    offset
        Bytes before the first record.

    Raises
    ------
    ReadError
        If the file is shorter than one record.
    """
    size = path.stat().st_size - offset
    if size < record.itemsize:
        raise ReadError(
            f"the file has {max(size, 0)} bytes behind its header, a record has {record.itemsize}",
            where=path,
        )
    rows = np.memmap(path, record, "r", offset, shape=size // record.itemsize)
    names = record.names or ()
    columns = tuple(RawColumn(name, None, rows[name], path=name) for name in names)
    return RawFile(path, "binary", (RawTable("", columns),))
