"""Axes of a force sensor that text above a table explains: "Fx = vertical; Fz = tangential"."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import NO_NUMBERS, DraftColumn
from tribolab.errors import shown
from tribolab.reading.interpret.names import matches
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label

_LONGEST = 300  # characters of a line that are looked at
_AXIS = re.compile(r"(?:f|force|kraft|sila|forza)?(?:[xyz]|[1-3])")  # names of a sensor's axes
_WORDS = (
    r"(?:[^\W\d][^;|,；，]|[぀-ヿ一-鿿가-힣])[^;|,；，]{1,60}"  # two of such letters make a word
)
_NAMED = 4  # letters of a name that a text speaks of
_TOLD = 0.3  # share of an explanation that a known word makes up
_NORMAL = re.compile(
    r"normal|vertical|vertik|senkrecht|lotrecht|press|loodrecht|pionow|svisl|kolm|pystysuor|fueggoleges"
    r"|dueşey|duesey|dikey|нормал|вертикал|垂直|法向|法线|竖直|수직|법선|load|last|charge|carga|carico|belast"
)
_ALONG = re.compile(
    r"friction|frict|longitud|laengs|lengs|along|tangent|traction|drag|reib|frott|roz|attrit|atrito|wrijv|friktion|friksjon|tecn|tren"
    r"|tarci|styczn|kitka|surlod|erint|teğet|teget|suertuen|surtun|трени|касател|тангенц|摩擦|切向|接線|마찰|접선"
)
_ACROSS = re.compile(
    r"radial|lateral|quer|across|transvers|zijde|bocz|poprzec|pricn|sivu|keresztir|yanal|radyal|радиал"
    r"|попереч|径向|横向|横方向|半径方向"
)


def as_explained(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Take forces of short names for what the text above the table says that they are.

    Where it explains them in words that are not known, what their names would mean is a guess.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        As they are understood by their names.
    """
    lines = [line[:_LONGEST] for line in layout.text_above()]
    told = {
        column.place: (_meant(about), about)
        for column in columns
        if _is_force(column) and (about := _explanation(column, lines))
    }
    forces = {quantity for quantity, _ in told.values()} & {"friction_force", "normal_force"}
    if not told:
        return list(columns)
    return [_said(column, forces, *told.get(column.place, ("", ""))) for column in columns]


def left_aside(layout: Layout, columns: Sequence[DraftColumn], used: Collection[int]) -> list[str]:
    """Say which columns in units of a force are not used, of which the text above speaks.

    Something may have to be taken off, or be added.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        As they are understood.
    used
        Places of those that a formula uses.
    """
    lines = [line[:_LONGEST] for line in layout.text_above()]
    said = []
    for column in columns:
        name, unit, _ = bare_name(column)
        short = normalise_label(name)
        if column.used or column.place in used or len(short) < _NAMED:
            continue
        if unit is None or not converts(unit, "N") or column.note.startswith(NO_NUMBERS):
            continue
        line = next((line for line in lines if short in normalise_label(line)), "")
        if line:
            what = f"column {column.place} '{shown(name, 20)}' is not used, of which the text says "
            said.append(f"{what}'{shown(line.strip(), 60)}'")
    return said


def _is_force(column: DraftColumn) -> bool:
    name, unit, _ = bare_name(column)
    return bool(_AXIS.fullmatch(normalise_label(name))) and unit is not None and converts(unit, "N")


def _explanation(column: DraftColumn, lines: Sequence[str]) -> str:
    """Return what a line says a name is: "Fx = vertical", or "vertical force (Fx)"."""
    name = re.escape(bare_name(column)[0].strip())
    behind = re.compile(
        rf"(?<![^\W_]){name}(?![^\W_])\s{{0,3}}[=:：＝–—-]\s{{0,3}}(?P<about>{_WORDS})"
    )
    before = re.compile(rf"(?P<about>[^\W\d][^;|,()]{{2,40}})\(\s*{name}\s*\)")
    for line in lines:
        if match := behind.search(line) or before.search(line):
            return match["about"].strip()
    return ""


def _meant(about: str) -> str:
    """Return the force that an explanation is of; "across" the motion, "" if it is not told.

    >>> _meant("vertical (normal) force"), _meant("tangential"), _meant("radial"), _meant("left")
    ('normal_force', 'friction_force', 'across', '')
    """
    words = normalise_label(about)
    kinds = [
        kind
        for kind, pattern in (
            ("normal_force", _NORMAL),
            ("friction_force", _ALONG),
            ("across", _ACROSS),
        )
        if pattern.search(words)
    ]
    if len(kinds) == 1:
        return kinds[0]
    options = [option for option in matches(about, "N") if option.score >= _TOLD]
    return options[0].quantity if options and options[0].quantity in kinds else ""


def _said(column: DraftColumn, forces: set[str], quantity: str, about: str) -> DraftColumn:
    if quantity in forces:
        unit = bare_name(column)[1]
        own = column.unit if column.file_unit is not None else unit
        return column._replace(
            quantity=quantity, unit=own, used=True, guessed=(), options=(), fill_in="", note=""
        )
    taken = column.quantity in forces
    if taken or (quantity == "across" and column.used and _is_force(column)):
        note = f"the text says what it is: '{shown(about, 40)}'" if about else "another is it"
        return column._replace(
            quantity=None, used=False, guessed=(), options=(), fill_in="", note=note
        )
    if about and column.used and not quantity:
        guess = f"it is so, for all that the text says of it: '{shown(about, 40)}'"
        return column._replace(guessed=(*column.guessed, guess))
    return column
