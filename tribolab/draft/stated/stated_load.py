"""The load that the text before a table states, and the number of what any text states."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tribolab.draft.file.layout import Layout
from tribolab.draft.stated.settings import Amount
from tribolab.draft.words.stated_words import LOAD
from tribolab.io.dialects.patterns import guarded
from tribolab.reading.interpret.unit_texts import converts
from tribolab.unit_names import WEIGHTS
from tribolab.units import conversion

_ALIKE = 0.01  # relative difference of a weight and of the force of it, both rounded


def find_load(values: Sequence[Amount]) -> Amount | None:
    """Return the load that the text before the table states, as a force; None if none, or several.

    Where the text states none, that of the file's name. A load of zero is none.

    Parameters
    ----------
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    """
    fitting = []
    of_name = [v for v in values if v.source == "file name" and v.name == "set_normal_force"]
    for value in values:
        if value.source == "file name" or not LOAD.search(value.key):
            continue
        if value.source != "step" and stated_number(value) == 0.0:
            continue  # "step 0: no contact (load 0 N)": nothing that friction is divided by
        unit = WEIGHTS.get(value.own_unit or "", value.own_unit or "")
        if converts(unit, "N"):
            fitting.append(value._replace(name="set_normal_force", unit=unit, to=None))
    if not fitting and len(of_name) == 1:
        return of_name[0]
    if len(fitting) == 2 and _are_one(*fitting):
        return fitting[fitting[0].unit in WEIGHTS.values()]  # the force, as it is stated
    return fitting[0] if len(fitting) == 1 else None


def _are_one(one: Amount, other: Amount) -> bool:
    """Whether two loads are a weight and the force of it, as "2.5 kg" and "24.5 N"."""
    if "step" in (one.source, other.source) or one.unit == other.unit:
        return False
    sizes = [stated_number(v) * conversion(v.unit or "N", "N")[0] for v in (one, other)]
    return abs(sizes[0] - sizes[1]) <= _ALIKE * max(sizes)


def lifted_on_return(layout: Layout) -> bool:
    """Whether the text says that nothing presses on the way back: a sled that is lifted.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    lines = (line[:_LONGEST] for line in layout.text_above())
    return any(_says_lifted(line) and _BACK.search(line) for line in lines)


def _says_lifted(line: str) -> bool:
    """Whether a line says so, and no word before it denies it.

    >>> _says_lifted("Sled lifted, cell not tared"), _says_lifted("The sled is not lifted")
    (True, False)
    """
    lifted = _LIFTED.search(line)
    return lifted is not None and not _NOT.search(line[: lifted.start()][-_NEAR:])


_LONGEST = 300  # characters of a line that are looked at
_NEAR = 12  # characters before a word that may deny it
_LIFTED = re.compile(
    r"lift|rais(?:ed|ing)|unload|off the (?:surface|sample|film|table)|(?:ab|an)gehoben|hebt"
    r"|entlastet|unbelastet|soulev|relev|d[ée]charg|[àa] vide|levantad|elevad|sin carga|descarg"
    r"|sollevat|alzat|scaric|a vuoto|opgetild|onbelast|lyft|l[øo]ftet|uniesion|podniesion|zvednut"
    r"|odlehč|kaldır|emel|подн|приподн|без нагруз|抬|提起|卸载|持ち上げ|離し|浮か|들어",
    re.IGNORECASE,
)
_BACK = re.compile(
    r"return|way back|backward|revers|r[üu]ck(?:weg|lauf|hub|fahrt|w[äa]rts)|retour|arri[èe]re"
    r"|regres|retorn|vuelta|ritorno|terug|retur|tillbaka|tilbage|powr[oó]t|zp[ěe]t|d[öo]n[üu][şs]"
    r"|visszafel|paluu|возврат|обратн|返回|回程|回退|戻り|復路|복귀",
    re.IGNORECASE,
)
_NOT = re.compile(
    r"\b(?:not|never|without|nicht|kein\w*|pas|sans|non|no|n[ãa]o|sin|nie|не|inte|ikke)\b|未|不",
    re.IGNORECASE,
)


def stated_number(value: Amount) -> float:
    """Return the number that a value's text states, in the value's unit.

    Parameters
    ----------
    value
        From `tribolab.draft.stated.settings.numeric_settings`.
    """
    stated = guarded(value.pattern).first(value.text) or "nan"
    return value.scale * float(stated.rstrip(".,").replace(",", "."))
