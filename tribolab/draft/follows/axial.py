"""Contacts that lie at an angle: what presses along the axis is not the load on them.

A ball on three plates, or one ball on three others, wedges itself in: the normal forces of all
contacts together are the axial force over the cosine of the angle between them and the axis.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.errors import shown
from tribolab.reading.interpret.amounts import Amount
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label

_LONGEST = 300  # characters of a line that are looked at
_ON = (
    r"[\s_/\-–]*(?:on|in|auf|gegen|sur|dans|sobre|en|em|su|in|na|w|v|op|på|mod|mot|vs|на|по|上)?[\s_/\-–]*"
    r"(?:the |der |die |den |les |las |los |le |as )?"
)
_BALL = r"(?:balls?|kugeln?|billes?|bolas?|esferas?|sfer[ae]|kul[aeiky]*|golyó|шар\w*|球|ボール|볼)"
_THREE = (
    r"(?:3|three|drei|trois|tr[eê]s|tre|trzech|trzy|t[rř]ech|tři|három|drie|tr[eé]s|тр[её]х|三|３)"
)
_PLATES = (
    r"(?:plates?|pins?|platten?|plättchen|stifte?n?|plaqu\w+|plans?|pions|placas?|pastillas?|piastr\w+|lastre"
    r"|perni|pinos|pinnen|płyt\w*|trzpien\w*|desk\w*|пластин\w*|плоскост\w*|штифт\w*|板|盘|销|プレート|ピン|판|핀)"
)
_PYRAMID = r"(?:pyramid\w*|piramid\w*|пирамид\w*|ピラミッド|棱锥)"
_PLATES_CELL = re.compile(
    rf"{_BALL}{_ON}{_THREE}[\s_\-]*{_PLATES}|{_BALL}{_ON}{_PYRAMID}|球.{{0,2}}三板"
    r"|(?<![^\W_])BC\s?(?:12[.,]7|6[.,]35)(?!\d)|(?<![^\W_])T-?PTD(?![^\W\d_])",
    re.IGNORECASE,
)
_FOUR_BALL = re.compile(
    r"(?<![^\W_])(?:4|four|vier|quatre|cuatro|quattro|quatro|czter\w+|[cč]ty[rř]\w*|négy|neljä\w*|fire|fyra"
    r"|d[oö]rt|четыр\w*)[\s_\-]*(?:ball|kugel|bille|bolas?|esferas?|sfere|kul\w*|golyós?\w*|bilye|шарик\w*|шаров\w*)"
    r"(?!s)(?!\w*[\s\-](?:bearing|lager|screw))"
    rf"|{_BALL}{_ON}{_THREE}[\s_\-]*{_BALL}|(?<![^\W_])VKA(?![^\W_])|四球|四ボール|4球|사구",
    re.IGNORECASE,
)
# inclined contacts, too, at an angle that is no usual one
_INCLINED = re.compile(
    rf"{_BALL}{_ON}(?:cone|kegel|konus\w*|c[oô]nes?|conos?|stożk\w*|kužel\w*|конус\w*|圆锥|円錐)"
    rf"|(?:cone|kegel|konus|c[oô]ne|cono|конус\w*){_ON}{_THREE}?[\s_\-]*{_BALL}"
    r"|(?<![^\W_])(?:vee|v)[\s_\-]*(?:blocks?|groove\w*|nut(?:en)?|prism\w*)(?![^\W_])|V型块|Vブロック"
    r"|rainure en v|ranura en v|scanalatura a v",
    re.IGNORECASE,
)
_DEGREES = re.compile(
    r"(?<![\d.,])(?P<angle>\d{1,2}(?:[.,]\d+)?)\s?(?:°|º|deg(?:rees?)?\b|grad\b|gradi\b|grados\b|度)(?!\s?[CFK])",
    re.IGNORECASE,
)
_ANGLE_LINE = re.compile(
    r"contact\s?angle|kontaktwinkel|neigung|inclin|angle de contact|angolo di contatto|tilt", re.I
)
_USUAL = 45.0  # degrees of plates and pyramids
_COS_OF_FOUR = math.sqrt(2 / 3)  # the centres of four equal balls make a regular tetrahedron
_SIN_OF_FOUR = math.sqrt(1 / 3)
_OF_CONTACTS = re.compile(r"contact|kontakt|^fl$|perball|perplate|perpin|接触")
_ONE_BALL = re.compile(
    r"ball|kugel|bille|bola|esfera|sfera|kul[aek]|golyo|шар|球|ボール|^d$|^(?:dia\w*|durchmesser)$"
)


class Inclined(NamedTuple):
    """Contacts at an angle: where it is said, and the cosine and sine of their angle to the axis.

    Both are 0 where the angle is neither stated nor usual; with `guess` it is to be asked.
    """

    text: str
    cosine: float
    sine: float
    guess: str = ""

    def load(self, axial: str) -> str:
        """Return the formula of the load on all contacts from that of the axial force."""
        return f"{axial} / {self.cosine:.6g}"


def find_inclined(layout: Layout) -> Inclined | None:
    """Return the inclined contacts that the text above a table, or the file's name, speaks of.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    """
    lines = [line.strip()[:_LONGEST] for line in layout.text_above()]
    texts = (*lines, layout.file.path.stem)
    of_four = next((text for text in texts if _FOUR_BALL.search(text)), "")
    if of_four:
        return Inclined(of_four, _COS_OF_FOUR, _SIN_OF_FOUR)
    plates = next((text for text in texts if _PLATES_CELL.search(text)), "")
    text = plates or next((text for text in texts if _INCLINED.search(text)), "")
    if not text:
        return None
    told = [_DEGREES.search(line) for line in (text, *filter(_ANGLE_LINE.search, lines))]
    angle = next((float(match["angle"].replace(",", ".")) for match in told if match), None)
    angle = _USUAL if plates and angle is None else angle
    if angle is None:
        guess = (
            f"'{shown(text, 40)}': the load on inclined contacts is the axial force over the "
            "cosine of their angle, which is not said; the force is read as it stands"
        )
        return Inclined(text, 0.0, 0.0, guess)
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    sure = plates and angle == _USUAL
    guess = f"'{shown(text, 40)}': the load on the contacts is the axial force / {cosine:.4g}"
    return Inclined(text, cosine, sine, "" if sure else guess)


def axial_force_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the one column of the force along the axis, if it is not called that on the contacts.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    held = [c for c in columns if c.used and c.quantity == "normal_force" and not c.optional]
    named = [c for c in held if not _OF_CONTACTS.search(normalise_label(bare_name(c)[0]))]
    return named[0] if len(held) == len(named) == 1 else None


def guesses_of_inclined(layout: Layout, columns: Sequence[DraftColumn]) -> list[str]:
    """Say what has to be guessed of the load on inclined contacts; nothing if it is known.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    """
    inclined = find_inclined(layout)
    held = {column.quantity for column in columns if column.used}
    if inclined is None or "friction_coefficient" in held:
        return []
    if inclined.guess:
        return [inclined.guess]
    if "friction_force" in held and axial_force_of(columns) is not None:
        where = shown(inclined.text, 40)
        return [f"'{where}': the normal force is the axial one, of which the contacts carry more"]
    return []


def radius_of_ball(inclined: Inclined, values: Sequence[Amount]) -> Amount | None:
    """Return the radius at which a ball touches at an angle, from its stated size.

    Parameters
    ----------
    inclined
        From `find_inclined`.
    values
        From `tribolab.draft.stated.settings.numeric_settings`.
    """
    sizes = [v for v in values if _is_size(v) and _ONE_BALL.search(v.key)]
    if len(sizes) != 1 or not inclined.sine:
        return None
    half = 0.5 if sizes[0].means("diameter") or not re.search("radi|rayon", sizes[0].key) else 1.0
    scale = float(f"{half * inclined.sine:.6g}")
    return sizes[0]._replace(name="track_radius", to="m", scale=scale)


def _is_size(value: Amount) -> bool:
    return bool(value.unit and converts(value.unit, "m"))
