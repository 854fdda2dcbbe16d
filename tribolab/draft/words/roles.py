"""Words of a name that say how a number came about: it was set, measured, or worked out."""

from __future__ import annotations

import re
from typing import Literal

Role = Literal["", "set", "measured", "derived", "extreme"]
_TOKENS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+")
_SET = frozenset(
    "set setpoint setp sp soll sollwert target nominal nom command commanded cmd demand demanded "
    "desired programmed prescribed requested consigne nominale objetivo nennwert "
    "satt innstilt inställd inställt indstillet ingesteld ingestelde zadane zadané nastavené "
    "nastaveno "
    "asetettu asetus beállított ayar ayarlanan ajustado ajustada impostato impostata réglé "
    "réglée".split()
)
_MEASURED = frozenset(
    "actual act measured meas ist istwert real current gemessen gemessene mesuré mesurée réel "
    "réelle medida medido misurata misurato feedback enc encoder "
    "målt målte uppmätt uppmätta gemeten zmierzone zmierzona naměřené naměřeno mitattu mért "
    "ölçülen medida".split()
)
_DERIVED = frozenset(
    "filtered filt smoothed average averaged avg mean rms "
    "median gefiltert mittel mittelwert filtré filtrée moyenne media".split()
)
_EXTREME = frozenset(
    "max min maximum minimum peak std stdev sd spitze spitzenwert streuung massimo minimo máximo "
    "mínimo pic crête breakaway static haft".split()
)
_ROLES: tuple[tuple[Role, frozenset[str], re.Pattern[str]], ...] = (
    ("set", _SET, re.compile(r"^(?:soll|nenn)\w{3}|设定|設定|目标|目標|指令")),
    (
        "measured",
        _MEASURED,
        re.compile(r"^ist(?:kraft|last|wert|geschw|dreh|moment)|实际|实测|実測"),
    ),
    ("extreme", _EXTREME, re.compile(r"最大|最小")),
    ("derived", _DERIVED, re.compile(r"平均")),
)


_EASTERN = re.compile(
    r"设定|設定|目标|目標|指令|实际|实测|実測|実際"
)  # written with the name in one word


def role_of(name: str) -> Role:
    """Tell by a column's name how its numbers came about.

    >>> role_of("Velocity setpoint"), role_of("ActualSpeed"), role_of("Mean COF"), role_of("Offset")
    ('set', 'measured', 'derived', '')
    >>> role_of("Peak force")
    'extreme'
    """
    tokens = [token.lower() for token in _TOKENS.findall(name)]
    for role, words, compound in _ROLES:
        if any(token in words or compound.search(token) for token in tokens):
            return role
    return ""


def without_role(name: str) -> str:
    """Return a name without the words that say that its numbers were set or measured.

    >>> without_role("Actual velocity"), without_role("Set Speed"), without_role("速度指令")
    ('velocity', 'Speed', '速度')
    """
    words = _SET | _MEASURED
    kept = [_EASTERN.sub("", t) for t in _TOKENS.findall(name) if t.lower() not in words]
    return " ".join(token for token in kept if token) or name
