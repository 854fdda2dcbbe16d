"""Interpretation of the lines above a map: pitch, size, units, counts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, part_pattern, words_of
from tribolab.reading.numbers import PLAIN_NUMBER, decimal, numbers_in
from tribolab.reading.scans.grid import rounder_pitch
from tribolab.reading.scans.limits import SAME_RANGE
from tribolab.reading.scans.unit_words import (
    AXES,
    IN_BRACKETS,
    WORD,
    axes_of,
    height_unit,
    is_about_heights,
    metres,
    only_one,
    stated_units,
)
from tribolab.units.spellings import unit_of_length

_MAX_COUNT = 1e9  # most steps of a height resolution
_MAX_LINE = 300  # most characters of a line
_MAX_NUMBERS = 2  # most numbers in an entry; more are a date, a time, or a row of results
_BLANKED = str.maketrans(";[](){}", "       ")  # marks that may stand between a number and its unit
_COMMA = re.compile(r"(?<!\d),|,(?!\d)")


class MapHeader(NamedTuple):
    """Contents of a header: pitch along x and y [m], unit of heights [m], rows and columns.

    Missing or contradictory values are None. `along` [m] is the unit of positions. `stated` are
    names and numbers without units. `gauge_step` [m] is the height of one count, if heights are
    counts. `without_unit` is a pitch or extent without unit, e.g. "cellsize 0.005". `doubt`
    describes an assumption. `sizes` are numbers on the heights with their unit [m], e.g. a range.
    """

    dx: float | None
    dy: float | None
    height: float | None
    rows: int | None
    columns: int | None
    along: float | None = None
    stated: tuple[tuple[str, float], ...] = ()
    gauge_step: float | None = None
    without_unit: str = ""
    doubt: str = ""
    sizes: tuple[tuple[float, float], ...] = ()


class _Entry(NamedTuple):
    """Name and numbers in a header, with units of length; `per_point` as in "0.5 um/pixel"."""

    key: str
    numbers: tuple[float, ...]
    units: tuple[str, ...]
    per_point: bool

    def means(self, concept: str) -> bool:
        """Whether the name matches a concept of the lexicon, with or without its axis."""
        pattern = key_pattern(concept)
        return any(pattern.search(name) for name in _names(self.key))

    @property
    def bare(self) -> str:
        """Name for display."""
        return " ".join(self.key.strip(" #%;,:=\t").split())


def map_header(
    lines: Iterable[str],
    shape: tuple[int, int],
    mark: str,
    *,
    commas_part: bool = False,
    x_unit: str = "",
) -> MapHeader:
    """Interpret the lines above a map.

    Parameters
    ----------
    lines
        The lines.
    shape
        Rows and columns of the map, to convert an extent to a pitch.
    mark
        Decimal mark of the map; the lines above may use the other one.
    commas_part
        Whether commas separate cells instead of being decimal marks.
    x_unit
        Unit of a pitch or extent that is stated without a unit.

    Examples
    --------
    >>> header = map_header(["Field of view: 20 x 10 um", "Heights [nm]"], (5, 10), ".")
    >>> round(header.dx * 1e6, 9), round(header.dy * 1e6, 9), header.height
    (2.0, 2.0, 1e-09)
    >>> round(map_header(["XYResolution X,0.625,[um]"], (5, 10), ".").dx * 1e6, 9)
    0.625
    """
    texts = [
        part
        for line in lines
        for part in _split_entries(
            line[:_MAX_LINE].replace('"', " ").strip(), commas_part=commas_part
        )
    ]
    entries = [e for text in texts if (e := _entry(text, mark, commas_part=commas_part))]
    bare = [entry for entry in entries if _lacks_unit(entry)]
    if x_unit:
        entries = [
            e._replace(units=(x_unit,) * len(e.numbers)) if e in bare else e for e in entries
        ]
    pitch = _pitch_along_axes([e for e in entries if _is_pitch(e)], (1, 1))
    extent = _pitch_along_axes([e for e in entries if _is_extent(e)], shape)
    dx, dy = (first or second for first, second in zip(pitch, extent, strict=True))
    doubt = ""
    if dx and dy is None and not any(_names_axis(e, "y") for e in entries if any(e.units)):
        dy, doubt = dx, "only the distance of points along x is stated: taken along y, too"
    rows, columns = _counts(entries)
    steps = [e.numbers[0] * metres(e.units[0]) for e in entries if _is_gauge_step(e)]
    units = [unit for text in texts for unit in stated_units(text)]
    scaled = any(_is_factor(entry) for entry in entries)
    return MapHeader(
        dx,
        dy,
        None if scaled else height_unit(units),
        rows,
        columns,
        only_one({metres(u.unit) for u in units if axes_of(u.words) & {"x", "y"}}),
        tuple((e.bare, e.numbers[0]) for e in entries if len(e.numbers) == 1 and not e.units[0]),
        max(steps, default=None),
        f"{bare[0].bare} {bare[0].numbers[0]:g}" if bare else "",
        doubt,
        () if scaled else tuple((e.numbers[0], metres(e.units[0])) for e in entries if _is_size(e)),
    )


def unit_of_range(header: MapHeader, heights: np.ndarray) -> float | None:
    """Return the unit [m] in which the range of the heights equals the stated one; else None.

    WSxM writes "Z Amplitude: 41.2 nm" above a matrix without a unit.
    """
    known = heights[np.isfinite(heights)]
    reach = float(np.ptp(known)) if known.size else 0.0
    fitting = {unit for size, unit in header.sizes if abs(reach - size) <= SAME_RANGE.value * size}
    return only_one(fitting)


def unit_of_resolution(header: MapHeader, heights: np.ndarray) -> float | None:
    """Return the unit [m] of a stated height resolution if the heights are its multiples.

    File: an area of an Olympus OLS5000, "ZResolution,0.001,[um]"
    (jarredclloyd/GeochemistryTools.jl).
    """
    known = heights[np.isfinite(heights)]
    for size, unit in header.sizes if known.size else ():
        counts = known / size
        whole = np.abs(counts).max() < _MAX_COUNT and np.allclose(counts, counts.round(), atol=1e-3)
        if whole and np.gcd.reduce(counts.round().astype(np.int64)) == 1:
            return unit
    return None


def _split_entries(text: str, *, commas_part: bool) -> list[str]:
    """Split a header line about one axis into entries; any other line is returned unchanged.

    >>> _split_entries("Axe X;Points;256;Pas;3,2;um", commas_part=False)
    ['x Points: 256', 'x Pas: 3,2 um']
    >>> _split_entries("Axe Z;Unit;um;Step;0,1;nm", commas_part=False)
    ['z Unit: um', 'z Step: 0,1 nm']
    """
    cells = [cell.strip() for cell in re.split(r"[;\t,]" if commas_part else r"[;\t]", text)]
    words = words_of(cells[0])
    about = [word for word in words if word in ("x", "y", "z")]
    if len(about) != 1 or len(words) > 2 or len(cells) < 4:
        return [text]
    entries: list[list[str]] = []
    for cell in cells[1:]:
        is_value = PLAIN_NUMBER.fullmatch(cell) or unit_of_length(cell)
        if not entries or (len(entries[-1]) > 1 and not is_value):
            entries.append([cell])
        else:
            entries[-1].append(cell)
    return [f"{about[0]} {key}: {' '.join(rest)}" for key, *rest in entries if rest]


def _entry(text: str, mark: str, *, commas_part: bool) -> _Entry | None:
    """Return name and numbers of a line; None if it has no number or more than two."""
    apart = _COMMA.sub(" ", text.translate(_BLANKED))
    found = numbers_in(apart.replace(",", " ") if commas_part else apart)
    if not found or len(found) > _MAX_NUMBERS:
        return None
    key = text[: found[0].start]
    behind = [number.unit.partition("/") for number in found]
    units = [unit_of_length(unit) for unit, _, _ in behind]
    in_key = [stated.unit for stated in stated_units(key)]
    usual = units[-1] or (in_key[-1] if in_key else "")
    per = part_pattern("pixel"), part_pattern("points_at_end")
    per_point = any(
        unit and any(p.search(normalise_label(point)) for p in per)
        for (_, _, point), unit in zip(behind, units, strict=True)
    )
    numbers = tuple(_number(number.text, mark) for number in found)
    return _Entry(key, numbers, tuple(unit or usual for unit in units), per_point)


def _number(text: str, mark: str) -> float:
    """Return a number; NaN if its comma or point may separate thousands, e.g. 1,024.

    >>> _number("2,5", "."), _number("1,024", ","), _number("1,024", ".")
    (2.5, 1.024, nan)
    """
    thousands = re.fullmatch(r"[-+]?[1-9]\d{0,2}[.,]\d{3}", text) and mark not in text
    return float("nan") if thousands else decimal(text)


def _names(key: str) -> Iterator[str]:
    """Yield the normalised forms of a name without its unit: with and without its axis."""
    name = WORD.sub(lambda word: "" if _is_bracketed(key, word) else word[0], key)
    yield normalise_label(name)
    if words := [word for word in words_of(name) if word not in AXES]:
        yield normalise_label(" ".join(words))
        if unit_of_length(words[-1]) and len(words) > 1:  # "pitch_um", "Pas um"
            yield normalise_label(" ".join(words[:-1]))


def _is_bracketed(text: str, word: re.Match[str]) -> bool:
    """Whether a word is a unit in brackets."""
    opened = IN_BRACKETS.search(text[: word.start()]) is not None
    return opened and bool(unit_of_length(word[0]))


def _names_axis(entry: _Entry, axis: str) -> bool:
    letters = axes_of(entry.key) & {"x", "y"}
    return axis in letters if letters else entry.means(f"{'across' if axis == 'x' else 'down'}_map")


def _is_pitch(entry: _Entry) -> bool:
    """Whether an entry is a lateral pitch."""
    axes = axes_of(entry.key)
    if "z" in axes or entry.means("vertical"):
        return entry.means("pitch") and bool(axes & {"x", "y"})
    bare = axes and not any(word in AXES for word in words_of(entry.key))  # e.g. "dx"
    return entry.per_point or bool(bare) or entry.means("pitch") or entry.means("lines_pitch")


def _is_extent(entry: _Entry) -> bool:
    """Whether an entry is the extent of the map."""
    axes = axes_of(entry.key)
    if "z" in axes or _is_pitch(entry):
        return False
    return entry.means("map_extent") or bool(axes and entry.means("side"))


def _lacks_unit(entry: _Entry) -> bool:
    """Whether an entry is a lateral pitch or extent without a unit."""
    whole = all(map(float.is_integer, entry.numbers)) and entry.means("map_points")
    return not any(entry.units) and not whole and (_is_pitch(entry) or _is_extent(entry))


def _is_gauge_step(entry: _Entry) -> bool:
    """Whether an entry is the height of one count of a gauge, e.g. "dz: 0.01 um", "LSB: 2 nm"."""
    step = entry.means("gauge_step") or "z" in axes_of(entry.key) - set(words_of(entry.key))
    return bool(entry.units[0]) and step and (is_about_heights(entry.key) or entry.means("lsb"))


def _is_size(entry: _Entry) -> bool:
    """Whether an entry is a length in height direction."""
    single = len(entry.numbers) == 1 and bool(entry.units[0]) and entry.numbers[0] > 0
    return single and is_about_heights(entry.key)


def _is_factor(entry: _Entry) -> bool:
    """Whether the heights must be multiplied by an entry's number."""
    if entry.numbers[0] == 1.0:
        return False
    if is_about_heights(entry.key) and entry.means("height_factor"):
        return True
    across = axes_of(entry.key) & {"x", "y"} or entry.means("along") or entry.means("of_pixel")
    return not entry.units[0] and not across and entry.means("any_factor")


def _pitch_along_axes(
    entries: Iterable[_Entry], shape: tuple[int, int]
) -> tuple[float | None, float | None]:
    """Return the pitch along x and y [m]; a length for both axes only if an axis has no other."""
    rows, columns = (max(number, 1) for number in shape)
    own: dict[str, set[float]] = {"x": set(), "y": set()}
    both: set[float] = set()
    for entry in entries:
        if not all(entry.units):
            continue
        lengths = [n * metres(u) for n, u in zip(entry.numbers, entry.units, strict=True)]
        if not min(lengths) > 0:
            continue
        x, y = (_names_axis(entry, axis) for axis in "xy")
        if len(lengths) == 2:
            own["x"].add(rounder_pitch(lengths[0], columns))
            own["y"].add(rounder_pitch(lengths[1], rows))
        elif x != y:
            own["x" if x else "y"].add(rounder_pitch(lengths[0], columns if x else rows))
        elif rows == columns:  # for a rectangular field, a single length is ambiguous
            both.add(rounder_pitch(lengths[0], columns))
    dx, dy = (only_one(stated or both) for stated in own.values())
    return dx, dy


def _counts(entries: Iterable[_Entry]) -> tuple[int | None, int | None]:
    """Return the stated numbers of rows and columns; None if missing or contradictory."""
    rows: set[float] = set()
    columns: set[float] = set()
    for entry in entries:
        whole = all(n > 0 and n.is_integer() for n in entry.numbers) and not any(entry.units)
        of_row = entry.means("per_line")
        if not whole or not (of_row or entry.means("map_points")):
            continue
        x, y = (_names_axis(entry, axis) for axis in "xy")
        if len(entry.numbers) == 2:
            columns.add(entry.numbers[0])
            rows.add(entry.numbers[1])
        elif of_row or x != y:
            (columns if of_row or x else rows).add(entry.numbers[0])
    both = (only_one(rows), only_one(columns))
    return (None if both[0] is None else int(both[0]), None if both[1] is None else int(both[1]))
