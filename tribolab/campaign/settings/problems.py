"""Messages on errors in a campaign file: file, line, key, cure."""

from __future__ import annotations

import re
import tomllib
import types
import typing
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from pydantic import BaseModel, ValidationError

from tribolab.campaign.settings.toml_lines import line_of
from tribolab.core.errors import nearest, shown

if TYPE_CHECKING:
    pass

_SHOWN = 5
_HINTED = 100  # largest number of mistakes for which a similar key is suggested
# blank lines and comments, then a key or the name of a table
_FIRST_KEY = re.compile(r"""(?:[ \t]*(?:#.*)?\r?\n)*[ \t]*(?:\[|["'A-Za-z0-9_.-]+[ \t]*=)""")


class SettingsProblem(NamedTuple):
    """Error in a settings file: path of the key (names and indices), and description."""

    where: tuple[str | int, ...]
    what: str


def message(problems: Iterable[SettingsProblem], path: Path, text: str) -> str:
    """Return the message on all problems, one line each, in the order of the file."""
    lines = []
    for problem in problems:
        line = line_of(text, problem.where)
        where = f"{path}, line {line}" if line else f"{path}"
        key = _key(problem.where)
        lines.append(
            (line or 0, f"{where}: {key}: {problem.what}" if key else f"{where}: {problem.what}")
        )
    lines.sort(key=lambda pair: pair[0])
    shown = [line for _, line in lines[:_SHOWN]]
    if len(lines) > _SHOWN:
        shown.append(f"... and {len(lines) - _SHOWN} more")
    return "\n".join(shown)


def _key(where: tuple[str | int, ...]) -> str:
    """``("run", 1, "files")`` as people count: ``run 2, files``."""
    text = ""
    for part in where:
        if isinstance(part, int):
            text += f" {part + 1}"
        else:
            name = shown(part)
            text += f", {name}" if text[-1:].isdigit() else f".{name}" if text else name
    return text


def unreadable(error: Exception) -> str:
    """Return the reason why the parser cannot read a TOML text that may be valid."""
    if isinstance(error, RecursionError):
        return "its lists or tables lie hundreds deep in one another; write them flat"
    return "a number in it has thousands of digits; write it shorter"


def toml_error(error: tomllib.TOMLDecodeError, text: str, kind: str) -> str:
    """Return the message of the TOML parser, with the line that it refers to.

    The line is shown only of a text that is a TOML file to its first key or table: of another
    file nothing is told.
    """
    message_text = str(error)
    if not _FIRST_KEY.match(text):
        return f"{message_text.split(' (at')[0]}; is it a {kind} file?"
    if match := re.search(r"\(at line (\d+), column \d+\)", message_text):
        number = int(match[1])
        line = text.splitlines()[number - 1].strip() if number <= len(text.splitlines()) else ""
        return f"line {number}: {message_text[: match.start()].strip()} in: {shown(line)}"
    if message_text.endswith("(at end of document)"):
        return f"line {len(text.splitlines())}: {message_text}"
    return message_text


def from_pydantic(error: ValidationError, model: type[BaseModel]) -> list[SettingsProblem]:
    """Return the errors that pydantic found as problems with a cure."""
    problems: dict[tuple[str | int, ...], SettingsProblem] = {}
    items = error.errors(include_url=False)
    for item in items:
        if item["type"] == "too_short" and any(_is_below(item["loc"], o["loc"]) for o in items):
            continue  # a list whose only element is wrong is not empty
        where, table = _walk(model, item["loc"])
        if len(problems) >= _HINTED:
            table = None
        problems.setdefault(where, SettingsProblem(where, _words(item, table)))
    return list(problems.values())


def _is_below(outer: tuple[str | int, ...], inner: tuple[str | int, ...]) -> bool:
    """Whether the location `inner` is inside the location `outer`."""
    return len(inner) > len(outer) and inner[: len(outer)] == outer


def _words(item: Any, table: type[BaseModel] | None) -> str:
    kind, value = item["type"], item.get("input")
    key = str(item["loc"][-1]) if item["loc"] else ""
    unknown = table is not None and kind == "model_type" and key not in table.model_fields
    if table is not None and (kind == "extra_forbidden" or unknown):
        known = [field.alias or name for name, field in table.model_fields.items()]
        return f"unknown key{nearest(key, known)}"
    if kind == "missing":
        if item["loc"] == ("campaign",):
            return 'is missing; add [campaign] with name = "..." at the top'
        return (
            'is missing; add [[run]] with files = "..."'
            if item["loc"] == ("run",)
            else "is missing"
        )
    if kind == "value_error":
        return str(item["ctx"]["error"])
    if kind == "literal_error":
        known = re.findall(r"'([^']*)'", item["ctx"]["expected"])
        hint = nearest(str(value), known)
        return f"{shown(repr(value))} is not one of {', '.join(map(repr, known))}" + (
            hint if "did you mean" in hint else ""
        )
    if kind == "model_type":
        return f"a table is wanted, not {shown(repr(value))}"
    if kind == "too_short":
        return "is empty"
    text = item["msg"][0].lower() + item["msg"][1:]
    return f"{text}; got {shown(repr(value))}"


def _walk(
    model: type[BaseModel], location: tuple[str | int, ...]
) -> tuple[tuple[str | int, ...], type[BaseModel] | None]:
    """Return the path of a pydantic location in the file, and the table that contains its key."""
    where: list[str | int] = []
    here: Any = model
    table: type[BaseModel] | None = None
    for part in location:
        here = _bare(here)
        if isinstance(here, type) and issubclass(here, BaseModel):
            table = here
            where.append(part)
            field = here.model_fields.get(str(part))
            here = field.annotation if field else getattr(table, "named_table", None)
        elif typing.get_origin(here) in (dict, tuple):
            table = None
            where.append(part)
            inner = typing.get_args(here)
            place = 1 if typing.get_origin(here) is dict else 0
            if isinstance(part, int) and Ellipsis not in inner and part < len(inner):
                place = part
            here = inner[place]
        else:
            break
    return tuple(where), table


def _bare(annotation: Any) -> Any:
    """Strip ``| None`` and ``Annotated``."""
    while True:
        origin = typing.get_origin(annotation)
        if origin is typing.Annotated:
            annotation = typing.get_args(annotation)[0]
        elif origin in (typing.Union, types.UnionType):
            annotation = next(a for a in typing.get_args(annotation) if a is not type(None))
        else:
            return annotation
