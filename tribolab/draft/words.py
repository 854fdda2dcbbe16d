"""The one vocabulary of column names, English and German, from which quantities are proposed."""

from __future__ import annotations

import re
from typing import NamedTuple

from tribolab.draft.header import converts, is_unit
from tribolab.quantities import quantity


class Word(NamedTuple):
    """A quantity and how columns that hold it are called.

    Symbols are whole names; stems may stand anywhere in a name. Both are written small, without
    blanks and umlauts; of two symbols for one quantity the first is the better.
    """

    quantity: str
    symbols: tuple[str, ...]
    stems: tuple[str, ...]


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


RUN_WORDS = (
    Word(
        "time",
        _words("t time zeit"),
        _words("steptime testtime elapsedtime time zeit elapsed dauer uhr seconds sekunden"),
    ),
    Word(
        "friction_force",
        _words("fx ff fr ft freib ffric fq"),
        _words(
            "frictionforce frictionalforce tangentialforce lateralforce tractionforce shearforce "
            "reibkraft reibungskraft tangentialkraft querkraft friction traction reibung force "
            "kraft"
        ),
    ),
    Word(
        "normal_force",
        _words("fn fz fnorm fnormal w l"),
        _words(
            "normalforce normalload verticalforce balload ballload appliedload contactforce "
            "normalkraft anpresskraft auflast normallast load last belastung"
        ),
    ),
    Word(
        "friction_coefficient",
        _words("mu cof my mue ffn fxfz"),
        _words(
            "frictioncoefficient frictioncoeff coefficientoffriction coeffoffriction coffriction "
            "coefffriction tractioncoefficient tractioncoeff reibwert reibungszahl reibzahl "
            "reibungskoeffizient reibkoeffizient friction cof reibung"
        ),
    ),
    Word(
        "sliding_velocity",
        _words("v vx vel us"),
        _words(
            "slidingspeed slidingvelocity slipspeed gleitgeschwindigkeit velocity geschwindigkeit "
            "speed"
        ),
    ),
    Word(
        "position",
        _words("x s pos xpos"),
        _words(
            "position displacement displ stroke slidingdistance distance verschiebung auslenkung "
            "gleitweg strecke weg hub travel"
        ),
    ),
    Word(
        "set_speed",
        _words("vset vsoll"),
        _words("setspeed setvelocity targetspeed speedset sollgeschwindigkeit geschwindigkeitsoll"),
    ),
    Word(
        "set_normal_force",
        _words("fset fsoll fzset fnset"),
        _words("setload setforce setnormalforce targetload targetforce sollkraft solllast"),
    ),
    Word(
        "rolling_speed", (), _words("rollingspeed entrainmentspeed entrainment rollgeschwindigkeit")
    ),
    Word("slide_roll_ratio", ("srr",), _words("slideroll slidetoroll schlupf")),
    Word("rotation_speed", _words("rpm n omega"), _words("rotation drehzahl rotary angularspeed")),
    Word(
        "normal_stress", ("sigman",), _words("normalstress normalspannung contactpressure pressung")
    ),
    Word("shear_stress", ("tau",), _words("shearstress frictionstress schubspannung stress")),
    Word("shear_rate", (), _words("shearrate scherrate schergefaelle")),
    Word("viscosity", ("eta",), _words("viscosity viskositaet")),
    Word(
        "temperature",
        _words("t temp theta"),
        _words("lubetemp lubertdtemp contacttemp temperature temperatur temp"),
    ),
    Word(
        "ambient_pressure", ("p",), _words("ambientpressure airpressure luftdruck pressure druck")
    ),
    Word("film_thickness", (), _words("filmthickness averagefilm schmierfilm filmdicke film")),
    Word("height_displacement", ("z",), _words("height wear verschleiss depth lvdt hoehe")),
    Word(
        "electrical_contact_resistance", ("ecr",), _words("contactresistance uebergangswiderstand")
    ),
    Word("voltage", ("u",), _words("voltage spannung")),
    Word("step", _words("step schritt segment stage"), _words("stepno stepnumber")),
    Word("cycle", _words("cycle zyklus lap laps revolution"), _words("cycleno cyclenumber")),
)

SCAN_WORDS = (
    Word(
        "x", ("x",), _words("lateral position distance messweg weg strecke laenge length abstand")
    ),
    Word("y", ("y",), ()),
    Word(
        "height",
        _words("z h"),
        _words("height hoehe profile profil amplitude topography depth tiefe raw"),
    ),
)

_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "µ": "mu", "μ": "mu"})
# what a unit means for a quantity in this SI unit: weights for forces
_MEANT = {"N": {"g": "gf", "kg": "kgf"}}


class Match(NamedTuple):
    """A quantity that a name may stand for; the higher the score, the surer."""

    quantity: str
    score: float
    unit: str | None  # if it has to be read otherwise than it is written: g as gf


def squeezed(name: str) -> str:
    """Return a name without blanks, signs, capitals and umlauts.

    >>> squeezed("# Höhe_1")
    'hoehe1'
    """
    return re.sub(r"[^a-z0-9]", "", name.lower().translate(_UMLAUTS))


def split_unit(label: str) -> tuple[str, str | None]:
    """Separate a unit at the end of a name that has no brackets: 'Lateral um', 'Force/N'.

    >>> split_unit("Lateral um"), split_unit("F_x"), split_unit("Force/N")
    (('Lateral', 'um'), ('F_x', None), ('Force', 'N'))
    """
    known = {symbol for word in (*RUN_WORDS, *SCAN_WORDS) for symbol in word.symbols}
    if squeezed(label) in known:
        return label, None
    for gap in re.finditer(r"\s+in\s+|[\s_/,]+", label.strip()):
        name, unit = label.strip()[: gap.start()], label.strip()[gap.end() :]
        for text in (unit, unit.lower() if len(unit) > 3 else unit):
            # what has no dimension is part of the name: the N/N of F_N/N
            unitless = converts(text, "1") and text != "%"
            if name and not unitless and is_unit(text):
                return name, text
    return label, None


def matches(name: str, unit: str | None, *, scan: bool = False) -> list[Match]:
    """Return the quantities that a column may hold, the likeliest first.

    Parameters
    ----------
    name
        Name of the column without its unit.
    unit
        Its unit; None if it has none. A quantity of another dimension is left out.
    scan
        Whether the file holds a profile and not a run.

    Examples
    --------
    >>> matches("Reibkraft", "N")[0].quantity, matches("T", "degC")[0].quantity
    ('friction_force', 'temperature')
    """
    text = squeezed(name)
    if not text:
        return []
    options = []
    for word in SCAN_WORDS if scan else RUN_WORDS:
        score = _score(text, word)
        known = quantity(word.quantity)
        read_as = _MEANT.get(known.unit, {}).get(unit or "")
        if score and (unit is None or converts(read_as or unit, known.unit, known.bare)):
            options.append(Match(word.quantity, score, read_as))
    return sorted(options, key=lambda match: -match.score)


def _score(text: str, word: Word) -> float:
    if text in word.symbols:
        return 1.0 - 0.01 * word.symbols.index(text)
    covered = max((len(stem) for stem in word.stems if stem in text), default=0)
    return covered / len(text) if covered else 0.0
