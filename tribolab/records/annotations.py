"""What a type does not say of a field, for the schema that is generated from the records."""

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
    """Say which values a text may have, and what it means."""
    return Field(description=meaning, json_schema_extra={"enum": [*values]})


def means(meaning: str) -> FieldInfo:
    """Say what a field means."""
    return Field(description=meaning)


@dataclass(frozen=True, eq=False)  # as an annotation it has to have a hash
class Columns:
    """Which columns the rows of a table have; a column is a number, or null, unless it is said.

    Parameters
    ----------
    always, some
        Those that every row has, and those that it may lack. A mapping also says what they mean,
        where that is not plain.
    texts, counts, known
        Which of them are texts, whole numbers, and numbers that are always known.
    values
        What a column may hold, where that is little.
    row
        What a row is.
    open
        Whether rows may have more, of any kind.
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
        """Return what the schema says of a row."""
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
