"""Settings that a file holds beside its columns, as the lines that a text file has above its table.

Attributes, properties, metadata and single numbers all become ``key: value``, so that whoever
reads the text above a table reads them, too.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import PurePath

import numpy as np

from tribolab.reading.lexicon.lexicon import keys_of

MOST_LINES = 200
_SHORT = 200  # characters of a setting
_DEEPEST = 6  # objects within objects
_PER = re.compile(  # fric_N_per_V, v_set_um_per_s
    r"(?P<key>\w+?)_+(?P<unit>[^\W\d_]{1,6})_per_(?P<other>[^\W\d_]{1,6}\d?)"
)


def plain(value: object) -> object:
    """Return a value of a file's library as one of Python: a number, a text or a list."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, np.ndarray | np.generic):
        value = value.item() if np.size(value) == 1 else value.tolist()
        return plain(value) if isinstance(value, bytes) else value
    return value


def setting_lines(key: str, value: object, depth: int = 0) -> list[str]:
    r"""Return the lines that say a setting; of an object, or its JSON, one for each that it holds.

    Examples
    --------
    >>> setting_lines("stroke_mm", 10.0), setting_lines("gain_N_per_V", 12.5)
    (['stroke_mm: 10.0'], ['gain [N/V]: 12.5'])
    >>> setting_lines("experiment", '{"track": {"radius": 18, "unit": "mm"}, "ok": null}')
    ['track radius: 18 mm']
    >>> setting_lines("note", "first\nsecond")
    ['note: first second']
    """
    value = plain(value)
    if isinstance(value, str) and value.lstrip()[:1] in ("{", "["):
        try:
            value = json.loads(value)
        except (ValueError, RecursionError):
            pass
    if isinstance(value, Mapping):
        return _of_object(key, value, depth) if depth < _DEEPEST else []
    if isinstance(value, list | tuple):
        plain_ones = all(isinstance(each, str | int | float) for each in value)
        value = ", ".join(map(str, value)) if plain_ones else None
    if value is None or not str(value).strip():
        return []
    text = " ".join(str(value).split())
    return [f"{_with_unit(key)}: {text}"[:_SHORT]]


def _of_object(key: str, value: Mapping[str, object], depth: int) -> list[str]:
    units = next((value[name] for name in keys_of("unit") if name in value), None)
    rest = {name: each for name, each in value.items() if name not in keys_of("unit")}
    numbers = [n for n, each in rest.items() if isinstance(each, int | float)]
    if isinstance(units, str) and len(numbers) == 1 and key:  # {"value": 18, "unit": "mm"}
        name = "" if numbers[0].lower() in keys_of("value") else f" {numbers[0]}"
        return [f"{key}{name}: {rest.pop(numbers[0])} {units}"[:_SHORT]]
    lines = []
    if isinstance(units, Mapping):  # units of what stands beside them, by name
        own = {n: u for n, u in units.items() if n in rest and isinstance(u, str)}
        rest |= {n: f"{rest[n]} {u}" for n, u in own.items()}
        left = {f"{n}_unit": u for n, u in units.items() if n not in own}
        lines += [line for n, u in left.items() for line in setting_lines(n, u, depth + 1)]
    elif units is not None:
        lines += setting_lines(f"{key}_unit" if key else "unit", units, depth + 1)
    for name, each in rest.items():
        lines += setting_lines(str(name), each, depth + 1)
    return lines


def _with_unit(key: str) -> str:
    """Return a key whose last words are a unit per another with that in brackets."""
    key = " ".join(key.split())
    told = _PER.fullmatch(key)
    return f"{told['key']} [{told['unit']}/{told['other']}]" if told else key


def text_of(lines: list[str]) -> str:
    """Return settings as a text of no more lines than a table has above it, each once."""
    return "\n".join(list(dict.fromkeys(lines))[:MOST_LINES])


def folder_and_leaf(name: str) -> tuple[str, str]:
    """Return the group or structure that a column lies in, and its own name.

    >>> folder_and_leaf("log/Fx"), folder_and_leaf("data.stage(2).force"), folder_and_leaf("F")
    (('log', 'Fx'), ('data.stage(2)', 'force'), ('', 'F'))
    """
    if "/" in name:
        path = PurePath(name)
        return str(path.parent), path.name
    folder, dot, own = name.rpartition(".")
    return (folder, own) if dot and " " not in name else ("", name)
