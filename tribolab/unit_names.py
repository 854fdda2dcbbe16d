"""Units as instruments of many countries spell them, in the names that the library of units has."""

from __future__ import annotations

import re

_SAME = {
    "s": "Sec SEC Secs Seconds Second sekunde sekunden Sekunde Sekunden sek Sek segundo segundos "
    "seconde secondes secondo secondi с сек 秒 sn",
    "ms": "millisekunden Millisekunden millisecondes milisegundos msek мс 毫秒",
    "min": "Min minuten Minuten minutos minuti dk dak dakika perc хв мин 分 分钟 분",
    "h": "Std std Stunden heures horas ore ч 小时 時間",
    "day": "jours dias tage Tage giorni",
    "N": "Newton Newtons newtons Н 牛 牛顿",
    "kN": "KN кН 千牛",
    "mN": "мН",
    "force_kilogram": "kp Kgf kgF KGF кгс",
    "force_gram": "grf pond гс",
    "force_pound": "Lbf LBF lbF lbsf",
    "m": "metre metres mètre mètres metro metros metri м 米",
    "mm": "Millimeter millimetres millimètres milimetros millimetri MM мм 毫米",
    "um": "UM Micron Microns MICRONS mikrometer Mikrometer micromètres micras mkm мкм 微米",
    "nm": "нм 纳米",
    "cm": "см 厘米",
    "degC": "Celsius celsius oC DegC ℃ grdC degrC °c °С",
    "degF": "℉ Fahrenheit fahrenheit",
    "K": "Kelvin",
    "psi": "PSI Psi",
    "torr": "Torr",
    "Pa": "Па 帕",
    "kPa": "кПа 千帕",
    "MPa": "МПа 兆帕",
    "bar": "Bar",
    "poise": "Poise",
    "cP": "cp",
    "V": "Volts В 伏",
    "mV": "мВ",
    "ohm": "Ohm OHM Ohms OHMS Ω Ω Ом 欧姆",
    "kohm": "kOhm kOHM KOhm Kohm кОм",
    "mohm": "mOhm мОм",
    "Mohm": "MOhm MOHM МОм",
    "uohm": "uOhm",
    "Hz": "Гц 赫兹",
    "rev": "об оборот vuelta vueltas dev devir ot otáček omdr omdrejninger kierr ford fordulat "
    "转 轉 回転 Umdrehungen Umdr",
    "rpm": "RPMs Rpm vpm",
}
_NAMES = {said: name for name, words in _SAME.items() for said in words.split()}
# what is told by the unit as a whole, with its blanks and points
_WHOLE = {
    **dict.fromkeys(
        ("deg C", "Deg C", "deg. C", "Deg. C", "grd C", "grados C", "degrees C"), "degC"
    ),
    **dict.fromkeys(("deg F", "Deg F", "deg. F", "F", "degrees F"), "degF"),
    **dict.fromkeys(("none", "n/a", "unitless", "adim", "adim.", "sans unité", "ohne"), ""),
    **{f"{p}Pas": f"{p}Pa*s" for p in ("", "m", "u")},
    **{f"N{length}-2": f"N/{length}**2" for length in ("m", "cm", "mm")},
    **dict.fromkeys(("mil", "mils"), "thou"),
    **dict.fromkeys(("u-inch", "uinch", "uin", "micro inch", "micro-inch", "uin."), "microinch"),
    **{"sec.": "s", "min.": "min", "mm.": "mm", "N.": "N", '"': "inch", "fpm": "ft/min"},
    **{"ips": "in/s", "lb-f": "force_pound", "kg-f": "force_kilogram", "gram-force": "force_gram"},
    **dict.fromkeys(("kg/cm2", "kg/cm²", "kg/cm^2"), "force_kilogram/cm**2"),
    **dict.fromkeys(("kg/mm2", "kg/mm²", "kg/mm^2"), "force_kilogram/mm**2"),
}
_PREFIXES = {"nano": "n", "micro": "u", "milli": "m", "kilo": "k"}
_APART = re.compile(rf"(?i:(?P<prefix>{'|'.join(_PREFIXES)}))[\s-]+(?=(?:N|Pa|V|A|g|m|s)(?![a-z]))")
_WRITTEN = re.compile(
    r"(?i)(?P<prefix>nano|micro|milli|centi|kilo|mega|giga)?(?P<unit>met(?:er|re)|newton|pascal|"
    r"volt|hertz|second|minute|hour|inch|angstr(?:o|ö|oe|ø)m|ångstr(?:ö|o)m|radian|degree)(?:e?s)?"
)
_WRITTEN_AS = {"metre": "meter"} | dict.fromkeys(
    ("angström", "angstroem", "angstrøm", "ångström", "ångstrom"), "angstrom"
)
_NAME = re.compile(r"[°]?[^\W\d_]+|℃|℉")
# a weight on an arm: pounds, ounces, grams and kilograms stand for their weight in a torque
_WEIGHTS = {"kg": "force_kilogram", "g": "force_gram", "lb": "force_pound", "oz": "force_ounce"}
_WEIGHTS |= {"lbf": "force_pound", "ozf": "force_ounce", "kgf": "force_kilogram"}
_WEIGHTS |= {"gf": "force_gram", "kp": "force_kilogram", "lbs": "force_pound"}
_ARM = r"(?P<arm>mm|cm|m|in|inch|ft)"
_WEIGHT = rf"(?P<weight>{'|'.join(sorted(_WEIGHTS, key=len, reverse=True))})"
_TIMES = r"\s?[-·⋅・∙•.* ]?\s?"
_TORQUES = tuple(
    re.compile(form) for form in (rf"{_WEIGHT}{_TIMES}{_ARM}", rf"{_ARM}{_TIMES}{_WEIGHT}")
)


def plain_unit(unit: str) -> str:
    """Return a unit in the names of the library of units, as far as it is spelt otherwise.

    Examples
    --------
    >>> plain_unit("kOhm"), plain_unit("deg C"), plain_unit("мм/с"), plain_unit("lb-in")
    ('kohm', 'degC', 'mm/s', 'force_pound*in')
    >>> plain_unit("mm/s"), plain_unit("Fx"), plain_unit("micro N.m")
    ('mm/s', 'Fx', 'uN.m')
    """
    text = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    if text in _WHOLE:
        return _WHOLE[text]
    if (apart := _APART.match(text)) is not None:
        text = _PREFIXES[apart["prefix"].lower()] + text[apart.end() :]
    for form in _TORQUES:
        if (torque := form.fullmatch(text)) and torque["arm"] + torque["weight"] != "mg":
            return f"{_WEIGHTS[torque['weight']]}*{torque['arm']}"
    text = re.sub("(?<=/)Nm$", "(N*m)", text)
    return _NAME.sub(lambda name: _NAMES.get(name[0]) or _in_full(name[0]), text)


def _in_full(name: str) -> str:
    """Return a unit that is written out, in whatever letters, as the library of units has it.

    >>> _in_full("Nanometres"), _in_full("INCHES"), _in_full("Ångström"), _in_full("Fx")
    ('nanometer', 'inch', 'angstrom', 'Fx')
    """
    told = _WRITTEN.fullmatch(name)
    if told is None:
        return name
    unit = told["unit"].lower()
    return (told["prefix"] or "").lower() + _WRITTEN_AS.get(unit, unit)
