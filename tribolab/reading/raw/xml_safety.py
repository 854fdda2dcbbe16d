"""Safe parsing of XML: no external entities, no expanding entities, limited depth."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from pathlib import Path
from typing import Never
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from tribolab.core.errors import ReadError, brief, shown
from tribolab.reading.raw.limits import LETTERS_OF_DEFAULTS, LETTERS_OF_ENTITY, XML_DEPTH
from tribolab.reading.raw.opening import RefusedError

_BLOCK = 1 << 16


class _RootReachedError(Exception):
    """Raised to stop parsing at the root element, after all declarations."""


def parsed(path: Path, text: bytes) -> ElementTree.Element:
    """Return the root element of XML; namespaces, which differ by maker, are removed from tags.

    An internal DTD with plain-text entities is allowed, as in ISO softgauges.

    Raises
    ------
    ReadError
        If the file is damaged, or declares an external entity or one that expands others.
    """
    refuse_deep(path, path.name, [text])
    try:
        _check_declarations(path, text)
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, expat.ExpatError, ValueError, LookupError) as error:
        raise ReadError(f"{path}: its XML is damaged: {brief(error)}; export it again") from error
    for element in root.iter():
        if isinstance(element.tag, str):
            element.tag = element.tag.rpartition("}")[2]
    return root


def _check_declarations(path: Path, text: bytes) -> None:
    """Raise if XML declares entities or default attributes other than short text."""
    letters = 0

    def refuse(what: str) -> Never:
        raise ReadError(
            f"its XML defines {what}, as no instrument writes it",
            where=path,
            cure="export it again, or remove its <!DOCTYPE ...]>",
        )

    def entity(name: str, is_parameter: bool, value: str | None, *_: str | None) -> None:
        if value is None:
            refuse(f"an entity from outside the file ('{shown(name, 40)}')")
        if not is_parameter and ("&" in value or len(value) > LETTERS_OF_ENTITY.value):
            refuse(f"an entity that expands to more ('{shown(name, 40)}')")

    def attribute(_: str, name: str, __: str, default: str | None, ___: bool) -> None:
        nonlocal letters
        letters += len(default or "")
        if letters > LETTERS_OF_DEFAULTS.value:
            refuse(f"an attribute that each element takes ('{shown(name, 40)}')")

    def root_reached(*_: object) -> Never:
        raise _RootReachedError

    parser = expat.ParserCreate()
    parser.EntityDeclHandler = entity
    parser.AttlistDeclHandler = attribute
    parser.StartElementHandler = root_reached
    with contextlib.suppress(_RootReachedError):
        for start in range(0, len(text), _BLOCK):
            parser.Parse(text[start : start + _BLOCK], False)


def refuse_deep(path: Path, name: str, blocks: Iterable[bytes]) -> None:
    """Raise if XML, given in blocks, is nested too deeply.

    Raises
    ------
    ReadError
        If it is nested too deeply.
    """
    depth = 0
    for block in blocks:
        steps = _steps(block)
        if depth + steps.cumsum().max(initial=0) > XML_DEPTH.value:
            raise RefusedError(
                f"{path}: in '{shown(name)}' more than {XML_DEPTH.value:g} elements lie in one "
                "another, as no office program writes it; export the profile as text (csv)"
            )
        depth += int(steps.sum())


def _steps(block: bytes) -> np.ndarray:
    """Return the depth change, +1 or -1, of each tag in a block."""
    letters = np.frombuffer(block, dtype=np.uint8)
    starts = np.flatnonzero(letters[:-1] == ord("<"))
    second = letters[starts + 1]
    steps = np.ones(starts.size, dtype=np.int64)
    steps[second == ord("/")] = -1
    steps[(second == ord("?")) | (second == ord("!"))] = 0
    ends = np.flatnonzero(letters[1:] == ord(">"))
    ends = ends[letters[ends] == ord("/")]  # end of an empty element: <a/>
    empty = np.searchsorted(starts, ends) - 1
    steps[empty[empty >= 0]] = 0
    return steps
