"""Conversion of attributes for netCDF: unsupported types become JSON text."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from tribolab.core.untyped import Json

_MARK, _TUPLE = "json:", "json-tuple:"


def encoded(attrs: Mapping[Any, Any]) -> Json:
    """Return attributes in types that netCDF supports.

    True, False, None, dicts and lists become JSON text with the prefix ``json:``, tuples with
    ``json-tuple:``.

    Examples
    --------
    >>> encoded({"trim": 0.1, "known": None})
    {'trim': 0.1, 'known': 'json:null'}
    """
    return {str(name): _encode(value) for name, value in attrs.items()}


def decoded(attrs: Mapping[Any, Any]) -> Json:
    """Return the original attributes; inverse of `encoded`.

    Examples
    --------
    >>> decoded({"trim": 0.1, "known": "json:null"})
    {'trim': 0.1, 'known': None}
    """
    return {str(name): _decode(value) for name, value in attrs.items()}


def _encode(value: Any) -> Any:
    if isinstance(value, str):
        # text that happens to begin with the prefix must be restored as text
        return _MARK + json.dumps(value) if value.startswith((_MARK, _TUPLE)) else value
    if isinstance(value, np.bool_):
        value = bool(value)
    if isinstance(value, np.ndarray | np.generic):
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    mark = _TUPLE if isinstance(value, tuple) else _MARK
    return mark + json.dumps(value, ensure_ascii=False, default=_plain)


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    return str(value)


def _decode(value: Any) -> Any:
    if isinstance(value, str) and value.startswith(_TUPLE):
        return tuple(json.loads(value.removeprefix(_TUPLE)))
    if isinstance(value, str):
        return json.loads(value.removeprefix(_MARK)) if value.startswith(_MARK) else value
    if isinstance(value, np.integer):
        return int(value)
    if isinstance(value, np.floating):
        return float(value)
    return value
