"""Settings of containers: attributes, properties, metadata and single numbers."""

from __future__ import annotations

import re

import numpy as np

from tribolab.reading.raw.model import Place, Setting

_MAX_SETTING = 200  # most characters of a setting
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


def settings_of(key: str, value: object, path: str = "") -> list[Setting]:
    r"""Return an attribute as a setting; none if it is empty or has parts of its own.

    Parameters
    ----------
    key, value
        Name and value of the attribute.
    path
        Path of its group or dataset.

    Examples
    --------
    >>> [s.line for s in settings_of("gain_N_per_V", 12.5)]
    ['gain [N/V]: 12.5']
    >>> [s.line for s in settings_of("note", "first\nsecond")]
    ['note: first second']
    """
    value = plain(value)
    if isinstance(value, list | tuple):
        plain_ones = all(isinstance(each, str | int | float) for each in value)
        value = ", ".join(map(str, value)) if plain_ones else None
    if value is None or isinstance(value, dict) or not str(value).strip():
        return []
    name = _with_unit(key)
    text = " ".join(str(value).split())[: max(_MAX_SETTING - len(name), 0)]
    return [Setting(name, text, Place(path))]


def _with_unit(key: str) -> str:
    """Return a key that ends with a unit ratio with the unit in brackets."""
    key = " ".join(key.split())
    per = _PER.fullmatch(key)
    return f"{per['key']} [{per['unit']}/{per['other']}]" if per else key
