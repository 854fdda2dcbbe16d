"""Writing of a dialect as readable TOML, with remarks as comments."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from tribolab.reading.dialect.model import Dialect

FILL_IN = "FILL IN"
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f\u0085\u2028\u2029]+")
_BARE = re.compile(r"[A-Za-z0-9_-]+")


class Remarks(NamedTuple):
    """Comments for a dialect file, by the table or key to which they belong.

    A place is a table (``time``), one of several tables (``column.2``, from 0) or a key
    (``time.source``); the place of keys above all tables is ``""``.

    Attributes
    ----------
    above, below
        Lines above and below a table; below ``column`` means after the last column.
    behind
        Comments after a key, in its line.
    """

    above: Mapping[str, tuple[str, ...]] = {}
    below: Mapping[str, tuple[str, ...]] = {}
    behind: Mapping[str, str] = {}


def dialect_toml(dialect: Dialect, remarks: Remarks | None = None) -> str:
    """Return a dialect as TOML, with every key that was set.

    Examples
    --------
    >>> from tribolab.reading.dialect.find import load_dialect
    >>> print(dialect_toml(load_dialect("linear_slider"))[:22])
    name = "linear_slider"
    """
    remarks = remarks or Remarks()
    content = dialect.model_dump(mode="json", by_alias=True, exclude_unset=True)
    single = {key: value for key, value in content.items() if not isinstance(value, dict | list)}
    parts = [_part("", single, "", remarks)]
    for key in Dialect.model_fields:
        value = content.get(key)
        if isinstance(value, list):
            parts += [_part(f"[[{key}]]", v, f"{key}.{n}", remarks) for n, v in enumerate(value)]
            parts += remarks.below.get(key, ())
        elif isinstance(value, dict):
            parts.append(_part(f"[{key}]", value, key, remarks))
        elif key not in single:
            parts += remarks.below.get(key, ())
    text = "\n".join(part.rstrip("\n") + "\n" for part in parts if part)
    return plain(text)


def table_lines(heading: str, content: Mapping[str, Any], behind: Mapping[str, str]) -> list[str]:
    """Return a table of TOML as lines, with comments after its keys.

    >>> table_lines("[time]", {"source": "rate", "rate": "1 kHz"}, {"rate": "guessed"})
    ['[time]', 'source = "rate"', 'rate = "1 kHz"    # guessed']
    """
    plain = {key: value for key, value in content.items() if not isinstance(value, dict)}
    lines = [heading] if heading and (plain or not content) else []
    for key, value in plain.items():
        note = f"    # {comment(behind[key])}" if key in behind else ""
        lines.append(f"{key} = {_value(value)}{note}")
    for key, value in content.items():
        if isinstance(value, dict):
            name = key if _BARE.fullmatch(key) else quoted(key)
            lines += table_lines(f"[{heading.strip('[]')}.{name}]", value, {})
    return lines


def commented(lines: Iterable[str]) -> list[str]:
    """Return lines as comments."""
    return [f"# {line}".rstrip() for line in lines]


def plain(text: str) -> str:
    """Return text that can be encoded as UTF-8; file names may contain any bytes."""
    return text.encode("utf-8", "replace").decode()


def comment(text: str) -> str:
    """Return text in a form that is valid in a comment, on one line."""
    return _UNPRINTABLE.sub(" ", text)


def quoted(text: str) -> str:
    r"""Return text in quotation marks; backslashes of a pattern remain single if possible.

    >>> print(quoted("a 'b'"), quoted(r"load (\d+)"))
    "a 'b'" 'load (\d+)'
    """
    if "\\" in text and "'" not in text and text.isprintable():
        return f"'{text}'"
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _part(heading: str, content: Mapping[str, Any], place: str, remarks: Remarks) -> str:
    behind = {
        key: remarks.behind[at]
        for key in content
        if (at := f"{place}.{key}".lstrip(".")) in remarks.behind
    }
    lines = [*remarks.above.get(place, ()), *table_lines(heading, content, behind)]
    return "\n".join([*lines, *remarks.below.get(place, ())])


def _value(value: Any) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value)
