"""Profiles in XML of any maker: the longest list of numbers is the heights."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from tribolab.errors import ReadError, UnitError, shown
from tribolab.reading import cures
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.raw.xml_safety import parsed
from tribolab.reading.scans.formats.profilometers import NotSaidError
from tribolab.reading.scans.grid import even
from tribolab.units import conversion

_FEWEST = 16  # numbers of a list that may be a profile
_PLACE = re.compile(r"(?i)^(x|pos(ition)?s?|abscissa|lateral|distance)")
_STEP = re.compile(
    r"(?i)^(dx|delta_?x|pitch|step(size)?|spacing_?x?|x?_?(spacing|increment|scale|step|pitch)"
    r"|(sampl\w*|point)_?(distance|interval|spacing|step|pitch)"
    r"|(punkt|mess\w*|abtast)_?(abstand|schritt(weite)?)|schrittweite|pas|paso|passo|krok|increment)$"
)
_UNIT = re.compile(r"(?i)unit|einheit|unidad|jednostka|jednotka")
_X_UNIT = re.compile(r"(?i)^(d?x|lateral|length|pitch|spacing|step|punktabstand)")
# decimal commas: none parts two numbers, for between those stands a blank or a semicolon
_COMMAS = re.compile(r"(?:[-+]?\d+,\d+(?:[eE][-+]?\d+)?(?:[\s;]+|$)){4}|(?:[-+]?\d+,\d+;)+")
_NUMBER = re.compile(r"\s*([-+]?\d[\d.,]*(?:[eE][-+]?\d+)?)\s*(\S*)\s*$")


_ANY_UNIT = ("unit", "units", "einheit", "einheiten", "unidad", "unité", "unita")


class _List(NamedTuple):
    """Numbers, and the units that stand beside them: of what lies across, and of heights."""

    name: str
    values: np.ndarray
    across: str = ""
    unit: str = ""


class _Leaf(NamedTuple):
    """A name with what stands there: an element's text, or an attribute of it; its x unit."""

    name: str
    text: str
    unit: str


def is_xml(head: bytes) -> bool:
    """Whether a file's first bytes are those of XML."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<?xml")


def read_xml_values(
    path: Path, x_unit: str | None = None, height_unit: str | None = None
) -> xr.Dataset:
    """Read a profile from XML: a list of heights, and the pitch or a list of positions.

    Parameters
    ----------
    path
        The file.
    x_unit, height_unit
        Units of pitch (or positions) and heights, for files that state none.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (x).

    Raises
    ------
    ReadError
        If it holds no list of numbers, or neither pitch nor positions.
    """
    root = parsed(path, path.read_bytes())
    lists = sorted(_lists(root), key=lambda some: -some.values.size)
    if not lists:
        raise ReadError(f"{path}: no list of numbers stands in this XML, so it holds no profile")
    longest = [some for some in lists if some.values.size == lists[0].values.size]
    places = [some for some in longest if _PLACE.match(some.name)]
    heights = next((some for some in longest if some not in places), longest[0])
    leaves = list(_leaves(root))
    z_scale = _scale(path, height_unit, heights.unit or _unit(leaves, lateral=False))
    if places and places[0] is not heights:
        x: np.ndarray = places[0].values * _scale(
            path, x_unit, places[0].across or _unit(leaves, lateral=True)
        )
    else:
        x = _pitch(path, leaves, x_unit) * np.arange(heights.values.size)
    pitch, values, evened = even(str(path), x, measurable(heights.values * z_scale))
    return xr.Dataset(
        {"height": ("x", values)},
        {"x": pitch * np.arange(values.size)},
        {"instrument": "list of values in XML", **evened},
    )


def _lists(root: ElementTree.Element) -> Iterator[_List]:
    """Numbers in one element's text, or in elements of one name beside each other."""
    for element in root.iter():
        values = _numbers(element.text or "")
        if values.size >= _FEWEST:
            yield _List(element.tag, values, *_units_of(element))
        children: dict[str, list[ElementTree.Element]] = {}
        for child in element:
            children.setdefault(str(child.tag), []).append(child)
        for name, some in children.items():
            if len(some) < _FEWEST:
                continue
            yield from _of_points(element, some)
            values = _numbers(" ".join((child.text or "nan").strip() or "nan" for child in some))
            if values.size == len(some):
                label = element.tag if name.lower() in ("v", "value", "datum") else name
                yield _List(label, values, *_units_of(some[0], element))


def _of_points(above: ElementTree.Element, points: list[ElementTree.Element]) -> Iterator[_List]:
    """Numbers of points of which each holds its own: <P><x>1</x><z>2</z></P>, <P x="1" z="2"/>."""
    for name in points[0].keys():
        texts = [point.get(name) for point in points]
        yield from _list_of(name, texts, (points[0], above))
    for child in points[0]:
        own = [point.findtext(str(child.tag)) for point in points]
        yield from _list_of(str(child.tag), own, (child, above))


def _list_of(
    name: str, texts: list[str | None], said: tuple[ElementTree.Element, ...]
) -> Iterator[_List]:
    values = _numbers(" ".join((text or "").strip() or "nan" for text in texts))
    if values.size == len(texts):
        yield _List(name, values, *_units_of(*said))


def _numbers(text: str) -> np.ndarray:
    text = text.strip(" \r\n\t,;")
    if _COMMAS.match(text):
        cells = [cell.replace(",", ".") for cell in re.split(r"[\s;]+", text)]
    else:
        cells = re.split(r"[\s;]+" if ";" in text else r"[\s,;]+", text)
    if len(cells) < _FEWEST:
        return np.empty(0)
    try:
        return np.array([float(cell) for cell in cells])
    except ValueError:
        return np.empty(0)


def _units_of(*elements: ElementTree.Element) -> tuple[str, str]:
    """Units across and of heights that attributes say, of the first element that says them."""
    said = [
        (name, text.strip())
        for element in elements
        for name, text in element.attrib.items()
        if _UNIT.search(name)
    ]
    across = [text for name, text in said if _X_UNIT.match(name)]
    heights = [text for name, text in said if not _X_UNIT.match(name)]
    bare = [text for name, text in said if name.lower() in _ANY_UNIT]
    return next(iter([*across, *bare]), ""), next(iter(heights), "")


def _leaves(root: ElementTree.Element) -> Iterator[_Leaf]:
    for element in root.iter():
        if len(element) == 0 and element.text and len(element.text) < 100:
            yield _Leaf(element.tag, element.text.strip(), _units_of(element)[0])
        for name, text in element.attrib.items():
            yield _Leaf(name.rpartition("}")[2], text.strip(), _units_of(element)[0])


def _unit(leaves: list[_Leaf], *, lateral: bool) -> str:
    """Return the unit that stands in an element of its own."""
    said = [leaf for leaf in leaves if _UNIT.search(leaf.name)]
    mine = [leaf.text for leaf in said if bool(_X_UNIT.match(leaf.name)) == lateral]
    if not mine:  # one for both
        mine = [leaf.text for leaf in said if leaf.name.lower() in _ANY_UNIT]
    return mine[0] if len(set(mine)) == 1 else ""


def _pitch(path: Path, leaves: list[_Leaf], x_unit: str | None) -> float:
    for leaf in leaves:
        told = _NUMBER.match(leaf.text) if _STEP.match(leaf.name) else None
        if told:
            said = told[2] or leaf.unit or _unit(leaves, lateral=True)
            return float(told[1].replace(",", ".")) * _scale(path, x_unit, said)
    raise ReadError(
        f"{path}: the XML holds a list of heights, but neither positions nor the distance between "
        "its points (pitch, spacing, increment); export the profile as text (csv)"
    )


def _scale(path: Path, given: str | None, said: str) -> float:
    unit = said or given
    if not unit:
        raise NotSaidError("the XML states no units", where=path, cure=cures.MEND_UNITS)
    try:
        return conversion(unit, "m")[0]
    except UnitError as error:
        raise ReadError(f"{path}: '{shown(unit)}' in its XML is no unit of length") from error
