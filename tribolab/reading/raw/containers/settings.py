"""Settings of containers: attributes, properties, metadata and single numbers."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

import numpy as np

from tribolab.reading.lexicon.lexicon import keys_of
from tribolab.reading.raw.model import Place, Setting

_MAX_SETTING = 200  # most characters of a setting
_DEEPEST = 6  # deepest nesting of objects
_PER = re.compile(  # fric_N_per_V, v_set_um_per_s
    r"(?P<key>\w+?)_+(?P<unit>[^\W\d_]{1,6})_per_(?P<other>[^\W\d_]{1,6}\d?)"
)


def plain(value: object) -> object:
    """Return a library's value as a Python number, text or list."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, np.ndarray | np.generic):
        value = value.item() if np.size(value) == 1 else value.tolist()
        return plain(value) if isinstance(value, bytes) else value
    return value


def settings_of(key: str, value: object, path: str = "", depth: int = 0) -> list[Setting]:
    r"""Return an attribute as settings; for an object, or its JSON, one for each value.

    Parameters
    ----------
    key, value
        Name and value of the attribute.
    path
        Path of its group or dataset.
    depth
        Nesting depth.

    Examples
    --------
    >>> [s.line for s in settings_of("gain_N_per_V", 12.5)]
    ['gain [N/V]: 12.5']
    >>> [s.line for s in settings_of("rig", '{"track": {"radius": 18, "unit": "mm"}, "ok": null}')]
    ['track radius: 18 mm']
    >>> [s.line for s in settings_of("note", "first\nsecond")]
    ['note: first second']
    """
    value = plain(value)
    if isinstance(value, str) and value.lstrip()[:1] in ("{", "["):
        try:
            value = json.loads(value)
        except (ValueError, RecursionError):
            pass
    if isinstance(value, Mapping):
        return _of_object(key, value, path, depth) if depth < _DEEPEST else []
    if isinstance(value, list | tuple):
        plain_ones = all(isinstance(each, str | int | float) for each in value)
        value = ", ".join(map(str, value)) if plain_ones else None
    if value is None or not str(value).strip():
        return []
    name = _with_unit(key)
    text = " ".join(str(value).split())[: max(_MAX_SETTING - len(name), 0)]
    return [Setting(name, text, Place(path))]


def _of_object(key: str, value: Mapping[str, object], path: str, depth: int) -> list[Setting]:
    units = next((value[name] for name in keys_of("unit") if name in value), None)
    rest = {name: each for name, each in value.items() if name not in keys_of("unit")}
    numbers = [n for n, each in rest.items() if isinstance(each, int | float)]
    if isinstance(units, str) and len(numbers) == 1 and key:  # {"value": 18, "unit": "mm"}
        name = "" if numbers[0].lower() in keys_of("value") else f" {numbers[0]}"
        text = f"{rest.pop(numbers[0])} {units}"[:_MAX_SETTING]
        return [Setting(f"{key}{name}", text, Place(path))]
    found = []
    if isinstance(units, Mapping):  # units of other values, by name
        own = {n: u for n, u in units.items() if n in rest and isinstance(u, str)}
        rest |= {n: f"{rest[n]} {u}" for n, u in own.items()}
        left = {f"{n}_unit": u for n, u in units.items() if n not in own}
        found += [s for n, u in left.items() for s in settings_of(n, u, path, depth + 1)]
    elif units is not None:
        found += settings_of(f"{key}_unit" if key else "unit", units, path, depth + 1)
    for name, each in rest.items():
        found += settings_of(str(name), each, path, depth + 1)
    return found


def _with_unit(key: str) -> str:
    """Return a key that ends with a unit ratio with the unit in brackets."""
    key = " ".join(key.split())
    per = _PER.fullmatch(key)
    return f"{per['key']} [{per['unit']}/{per['other']}]" if per else key
