"""Workbooks in XML, as written by Excel 2003 and instruments, with calamine's interface."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.parsers import expat

from tribolab.core.errors import ReadError

_MARK = b"urn:schemas-microsoft-com:office:spreadsheet"
_END = b"Workbook>"
_HEAD = 4096  # bytes at either end sufficient to recognise it
_MAX_CELLS = 5_000_000  # all cells are in memory at once
_BLOCK = 1 << 20
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
        If it is not well-formed XML, declares entities, or is larger than a table of numbers.
    """

    def __init__(self, path: Path) -> None:
        refuse_cut_short(path)
        self._path = path
        self._sheets: dict[str, list[list[Cell]]] = {}
        self._rows: list[list[Cell]] = []
        self._row: list[Cell] = []
        self._text: list[str] | None = None
        self._is_number = False
        self._place = self._cells = 0
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler = self._begin
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._add_text
        parser.EntityDeclHandler = self._refuse  # entities are not expanded
        try:
            with path.open("rb") as file:
                while block := file.read(_BLOCK):
                    parser.Parse(block, False)
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise ReadError(f"the workbook is damaged: {error}", where=path) from error

    @property
    def sheet_names(self) -> list[str]:
        """Names of the sheets in order."""
        return list(self._sheets)

    def get_sheet_by_name(self, name: str) -> XmlSheet:
        """Return one of the sheets."""
        return XmlSheet(self._sheets[name])

    def _refuse(self, *_: object) -> None:
        raise ReadError("its XML defines entities, as no instrument writes them", where=self._path)

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        kind = tag.rpartition(" ")[2]
        values = {name.rpartition(" ")[2]: value for name, value in attributes.items()}
        if kind == "Worksheet":
            self._rows = self._sheets.setdefault(values.get("Name", str(len(self._sheets) + 1)), [])
        elif kind == "Row":
            self._row, self._place = [], 0
            self._fill(self._rows, values.get("Index"), [])
        elif kind == "Cell":
            self._fill(self._row, values.get("Index"), "")
            self._row.append("")
            self._cells += 1
            if self._cells > _MAX_CELLS:
                raise ReadError("the workbook is larger than a table of numbers", where=self._path)
        elif kind == "Data":
            self._is_number, self._text = values.get("Type") == "Number", []

    def _fill(self, cells: list[Any], index: str | None, empty: object) -> None:
        """Add the empty cells or rows before one with an explicit number, from 1."""
        if index is not None and re.fullmatch(r"\d{1,7}", index):
            self._cells += max(int(index) - 1 - len(cells), 0)
            if self._cells > _MAX_CELLS:
                raise ReadError("the workbook is larger than a table of numbers", where=self._path)
            cells.extend([empty] * (int(index) - 1 - len(cells)))

    def _add_text(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def _end(self, tag: str) -> None:
        kind = tag.rpartition(" ")[2]
        if kind == "Data" and self._text is not None and self._row:
            text = "".join(self._text).strip()
            self._row[-1] = float(text) if self._is_number and text else text
            self._text = None
        elif kind == "Row":
            self._rows.append(self._row)
