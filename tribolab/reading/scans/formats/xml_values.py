"""Profiles in XML of any maker: the longest list of numbers is the heights."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from tribolab.core.errors import ReadError, UnitError, shown
from tribolab.reading import cures
from tribolab.reading.raw.containers.xml_workbook import is_xml_workbook
from tribolab.reading.raw.missing_marks import measurable
from tribolab.reading.raw.xml_safety import parsed
from tribolab.reading.scans.formats.array_units import stated_unit
from tribolab.reading.scans.formats.profilometers import NotSaidError
from tribolab.reading.scans.grid import even
from tribolab.reading.scans.header import map_header
from tribolab.units.conversion import conversion

_MIN_NUMBERS = 16  # numbers of a list that may be a profile
_MAX_TEXT = 100  # letters of a text that says something
_PLACE = re.compile(r"(?i)^(x|pos(ition)?s?|abscissa|lateral|distance)")
# decimal commas: none parts two numbers, for between those stands a blank or a semicolon
_COMMAS = re.compile(r"(?:[-+]?\d+,\d+(?:[eE][-+]?\d+)?(?:[\s;]+|$)){4}|(?:[-+]?\d+,\d+;)+")


class _List(NamedTuple):
    """Numbers, and what the attributes beside them say."""

    name: str
    values: np.ndarray
    attrs: dict[str, str]


def is_xml(head: bytes) -> bool:
    """Whether a file's first bytes are those of XML, but not those of a workbook."""
    if is_xml_workbook(head):
        return False
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
        raise ReadError(f"{path}: this XML contains no list of numbers, so it holds no profile")
    longest = [some for some in lists if some.values.size == lists[0].values.size]
    places = [some for some in longest if _PLACE.match(some.name)]
    heights = next((some for some in longest if some not in places), longest[0])
    texts = {f"{number}/{name}": text for number, (name, text, _) in enumerate(_leaves(root))}
    usual = {axis: stated_unit(texts, axis) for axis in "xz"}
    z_scale = _scale(path, height_unit, stated_unit(heights.attrs, "z") or usual["z"])
    if places and places[0] is not heights:
        own = stated_unit(places[0].attrs, "x") or usual["x"]
        x: np.ndarray = places[0].values * _scale(path, x_unit, own)
    else:
        lines = [f"{name}: {text} {unit or ''}" for name, text, unit in _leaves(root)]
        shape = 1, heights.values.size
        header = map_header(lines, shape, ".", x_unit=usual["x"] or x_unit or "")
        if header.without_unit:
            _scale(path, x_unit, usual["x"])
        if header.dx is None:
            raise ReadError(
                f"{path}: the XML holds a list of heights, but neither positions nor the distance "
                "between its points (pitch, spacing, increment); export the profile as text (csv)"
            )
        x = header.dx * np.arange(heights.values.size)
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
        if values.size >= _MIN_NUMBERS:
            yield _List(element.tag, values, dict(element.attrib))
        children: dict[str, list[ElementTree.Element]] = {}
        for child in element:
            children.setdefault(str(child.tag), []).append(child)
        for name, some in children.items():
            if len(some) < _MIN_NUMBERS:
                continue
            yield from _of_points(element, some)
            values = _numbers(" ".join((child.text or "nan").strip() or "nan" for child in some))
            if values.size == len(some):
                label = element.tag if name.lower() in ("v", "value", "datum") else name
                yield _List(label, values, {**element.attrib, **some[0].attrib})


def _of_points(above: ElementTree.Element, points: list[ElementTree.Element]) -> Iterator[_List]:
    """Numbers of points of which each holds its own: <P><x>1</x><z>2</z></P>, <P x="1" z="2"/>."""
    for name in points[0].keys():
        texts = [point.get(name) for point in points]
        yield from _list_of(name, texts, (points[0], above))
    for child in points[0]:
        own = [point.findtext(str(child.tag)) for point in points]
        yield from _list_of(str(child.tag), own, (child, above))


def _list_of(
    name: str, texts: list[str | None], said: tuple[ElementTree.Element, ElementTree.Element]
) -> Iterator[_List]:
    values = _numbers(" ".join((text or "").strip() or "nan" for text in texts))
    if values.size == len(texts):
        first, above = said
        yield _List(name, values, {**above.attrib, **first.attrib})


def _numbers(text: str) -> np.ndarray:
    text = text.strip(" \r\n\t,;")
    if _COMMAS.match(text):
        cells = [cell.replace(",", ".") for cell in re.split(r"[\s;]+", text)]
    else:
        cells = re.split(r"[\s;]+" if ";" in text else r"[\s,;]+", text)
    if len(cells) < _MIN_NUMBERS:
        return np.empty(0)
    try:
        return np.array([float(cell) for cell in cells])
    except ValueError:
        return np.empty(0)


def _leaves(root: ElementTree.Element) -> Iterator[tuple[str, str, str | None]]:
    """Give names with what they say, an element's text or an attribute of it, and its x unit."""
    for element in root.iter():
        unit = stated_unit(element.attrib, "x")
        if len(element) == 0 and element.text and len(element.text) < _MAX_TEXT:
            yield element.tag, element.text.strip(), unit
        for name, text in element.attrib.items():
            yield name.rpartition("}")[2], text.strip(), unit


def _scale(path: Path, given: str | None, said: str | None) -> float:
    unit = said or given
    if not unit:
        raise NotSaidError("the XML states no units", where=path, cure=cures.MEND_UNITS)
    try:
        return conversion(unit, "m")[0]
    except UnitError as error:
        raise ReadError(f"{path}: '{shown(unit)}' in its XML is no unit of length") from error
