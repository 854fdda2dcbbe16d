"""Workbooks in XML, as written by Excel 2003 and instruments, with calamine's interface."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from tribolab.core.errors import ReadError
from tribolab.reading.raw.xml_safety import parsed

_MARK = b"urn:schemas-microsoft-com:office:spreadsheet"
_END = b"Workbook>"
_HEAD = 4096  # bytes at either end sufficient to recognise it
_MAX_CELLS = 5_000_000  # all cells are in memory at once
Cell = str | float


def is_xml_workbook(head: bytes) -> bool:
    """Whether a file begins like a workbook in XML."""
    return _MARK in head[:_HEAD] and b"<" in head[:64]


def refuse_cut_short(path: Path) -> None:
    """Raise if a workbook in XML is incomplete, before reading all of it.

    Raises
    ------
    ReadError
        If its last bytes do not close a workbook.
    """
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - _HEAD, 0))
        if _END not in file.read():
            raise ReadError("the workbook is cut short: its end is missing", where=path)


class XmlSheet:
    """Cells of one sheet."""

    def __init__(self, rows: list[list[Cell]]) -> None:
        self._rows = rows
        self.total_height = len(rows)
        self.total_width = max(map(len, rows), default=0)

    def to_python(self, skip_empty_area: bool = False, nrows: int | None = None) -> list[Any]:
        """Return rows of equal width, empty cells as ""."""
        return [row + [""] * (self.total_width - len(row)) for row in self._rows[:nrows]]


class XmlWorkbook:
    """Sheets of a workbook in XML.

    Raises
    ------
    ReadError
        If it is not well-formed XML, or is larger than a table of numbers.
    """

    def __init__(self, path: Path) -> None:
        refuse_cut_short(path)
        self._path, self._cells = path, 0
        sheets = parsed(path, path.read_bytes()).iter("Worksheet")
        self._sheets = {
            _attribute(sheet, "Name") or str(number): self._rows(sheet)
            for number, sheet in enumerate(sheets, 1)
        }

    @property
    def sheet_names(self) -> list[str]:
        """Names of the sheets in order."""
        return list(self._sheets)

    def get_sheet_by_name(self, name: str) -> XmlSheet:
        """Return one of the sheets."""
        return XmlSheet(self._sheets[name])

    def _rows(self, sheet: Element) -> list[list[Cell]]:
        rows: list[list[Cell]] = []
        for row in sheet.iter("Row"):
            self._fill(rows, row, [])
            rows.append([])
            for cell in row.iter("Cell"):
                self._fill(rows[-1], cell, "")
                rows[-1].append(_value(cell.find("Data")))
        return rows

    def _fill(self, cells: list[Any], element: Element, empty: object) -> None:
        """Append the empty cells or rows that an explicit index, from 1, skips."""
        index = _attribute(element, "Index")
        gap = int(index) - 1 - len(cells) if index.isdecimal() else 0
        self._cells += max(gap, 0) + 1
        if self._cells > _MAX_CELLS:
            raise ReadError("the workbook is larger than a table of numbers", where=self._path)
        cells.extend([empty] * gap)


def _attribute(element: Element, name: str) -> str:
    """Return an XML attribute by its name, in any namespace."""
    return next((v for key, v in element.attrib.items() if key.rpartition("}")[2] == name), "")


def _value(data: Element | None) -> Cell:
    text = "" if data is None else "".join(data.itertext()).strip()
    number = data is not None and text and _attribute(data, "Type") == "Number"
    return float(text) if number else text
