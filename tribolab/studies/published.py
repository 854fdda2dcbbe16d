"""Published numbers as printed: text, value and precision."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

from tribolab.core.errors import AnalysisError, ReadError

# Printed units in SI; "h_rms" means multiples of the rms roughness.
_SI = {"1": 1.0, "m/s": 1.0, "h_rms": 1.0, "MPa": 1e6, "mm": 1e-3, "um": 1e-6, "mJ/m2": 1e-3}
_NUMBER = re.compile(r"\d+(?:\.(\d+))?(?:e([+-]?\d+))?")


@dataclass(frozen=True)
class Published:
    """Number as printed in a paper.

    Parameters
    ----------
    quantity, surface, condition
        Quantity, surface and condition of the value.
    text
        Printed text: a number, or words and numbers such as ``"about 8 %"``, ``"1.75 to 1.95"``.
    unit
        Unit of the numbers in the text.
    where
        Section of the paper.
    kind
        Origin in the paper (``"computed"``, ``"fit to measurement"``, ...).
    note
        A reader's remark.

    Examples
    --------
    >>> width = Published("hertz_contact_width", "Smooth", "", "7.43", "mm", "App. B", "", "")
    >>> f"{width.si:.5g} m, {width.last_digit:.0e}"
    '0.00743 m, 1e-05'
    """

    quantity: str
    surface: str
    condition: str
    text: str
    unit: str
    where: str
    kind: str
    note: str

    def __post_init__(self) -> None:
        """Raise an error if the text does not contain a usable number."""
        if self.unit not in _SI or not _NUMBER.search(self.text):
            raise ReadError(
                f"published {self.quantity}: '{self.text}' in '{self.unit}' is no number in a unit "
                f"that is known here: {', '.join(_SI)}"
            )

    @property
    def factor(self) -> float:
        """Value of the printed unit in SI."""
        return _SI[self.unit]

    @property
    def relation(self) -> str:
        """Words before the number: ``""``, ``"about"``, ``"at most"``, ``">"`` or ``"below"``."""
        return self.text[: self._number.start()].strip()

    @property
    def si(self) -> float:
        """The number in SI; for a printed range, its middle."""
        return sum(self.ends) / 2

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of a printed range in SI; equal for a single number."""
        numbers = [float(match[0]) * self._scale for match in _NUMBER.finditer(self.text)]
        return min(numbers), max(numbers)

    @property
    def last_digit(self) -> float:
        """One unit in the last printed digit, in SI."""
        match = self._number
        return 10.0 ** (int(match[2] or 0) - len(match[1] or "")) * self._scale

    @property
    def _number(self) -> re.Match[str]:
        match = _NUMBER.search(self.text)
        assert match is not None  # text without a number was refused when the object was created
        return match

    @property
    def _scale(self) -> float:
        return self.factor * (0.01 if "%" in self.text else 1.0)


def read_published(path: str | Path) -> tuple[Published, ...]:
    """Return the published numbers from a table.

    Parameters
    ----------
    path
        CSV with the columns quantity, surface, condition, published, unit, where, kind, note.

    Raises
    ------
    ReadError
        If a row's number or unit cannot be used.
    """
    with Path(path).open(encoding="utf-8", newline="") as file:
        return tuple(
            Published(text=row.pop("published"), **{k: v or "" for k, v in row.items()})
            for row in csv.DictReader(file)
        )


def find_published(
    table: tuple[Published, ...], quantity: str, surface: str, condition: str = ""
) -> Published:
    """Return the published number of a quantity and surface whose condition contains a text.

    Raises
    ------
    AnalysisError
        If no row or several rows match.
    """
    rows = [
        row
        for row in table
        if row.quantity == quantity and row.surface == surface and condition in row.condition
    ]
    if len(rows) != 1:
        raise AnalysisError(
            f"{len(rows)} published numbers for {quantity}, {surface}, '{condition}'; one is wanted"
        )
    return rows[0]
