"""Annotations of record fields for the generated schema."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field, GetJsonSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema

from tribolab.core.untyped import Json

Natural = Annotated[int, Field(ge=0)]
_NUMBER = ["number", "null"]


def one_of(*values: str, meaning: str | None = None) -> FieldInfo:
    """Annotate a text with its possible values and their meaning."""
    return Field(description=meaning, json_schema_extra={"enum": [*values]})


def means(meaning: str) -> FieldInfo:
    """Annotate a field with its meaning."""
    return Field(description=meaning)


@dataclass(frozen=True, eq=False)  # annotations must be hashable
class Columns:
    """Types of the columns of a table; by default a number or null.

    Parameters
    ----------
    always, some
        Columns of every row, and optional ones. A mapping adds their meanings where needed.
    texts, counts, known
        Columns that are texts, whole numbers, and numbers that are never null.
    values
        Possible values of a column, if there are few.
    row
        Description of a row.
    open
        Whether rows may have further columns.
    """

    always: Collection[str]
    some: Collection[str] = ()
    texts: Collection[str] = ()
    counts: Collection[str] = ()
    known: Collection[str] = ()
    values: Mapping[str, Sequence[str | int]] | None = None
    row: str = ""
    open: bool = False

    def __get_pydantic_json_schema__(self, _: CoreSchema, handler: GetJsonSchemaHandler) -> Json:
        """Return the schema of a row."""
        columns = (*self.always, *self.some)
        return {
            "type": "object",
            "properties": {name: self._kind(name) | self._more(name) for name in columns},
            "required": [*self.always],
            "additionalProperties": {"type": [*_NUMBER, "string"]} if self.open else False,
        } | _description(self.row)

    def _kind(self, name: str) -> Json:
        for kind, names in (
            ("string", self.texts),
            ("integer", self.counts),
            ("number", self.known),
        ):
            if name in names:
                return {"type": kind}
        return {"type": _NUMBER}

    def _more(self, name: str) -> Json:
        meant = [group for group in (self.always, self.some) if isinstance(group, Mapping)]
        meaning = next((str(group[name]) for group in meant if name in group), "")
        values = (self.values or {}).get(name)
        return ({"enum": [*values]} if values else {}) | _description(meaning)


def _description(text: str) -> Json:
    return {"description": text} if text else {}
