"""Units as suffixes of keys: "contact_radius_mm"."""

from __future__ import annotations

from tribolab.reading.unit_texts import converts, measures_something

_LOWER_CASE_UNITS = {"hz": "Hz", "khz": "kHz", "n": "N", "mn": "mN", "kn": "kN"}  # in keys
_NO_UNIT = frozenset(("percent", "%", "-", "1"))


def is_unit(text: str) -> bool:
    """Whether a text is a unit of a recorded quantity.

    >>> is_unit("mm/s"), is_unit("degC"), is_unit("raw"), is_unit("3")
    (True, True, False, False)
    """
    if text.lower() in _NO_UNIT or text == "A" or converts(text, "rad"):
        return True
    return measures_something(text) and not converts(text, "1")


def without_unit(key: str) -> tuple[str, str]:
    """Split a key into name and unit suffix.

    >>> without_unit("contact_radius_mm"), without_unit("speed_mm_s"), without_unit("stroke")
    (('contact_radius', 'mm'), ('speed', 'mm/s'), ('stroke', ''))
    >>> without_unit("sample_rate_hz")
    ('sample_rate', 'Hz')
    """
    words = key.split("_")
    for count, mark in ((2, "/"), (1, "")):
        unit = mark.join(words[-count:])
        unit = _LOWER_CASE_UNITS.get(unit, unit)
        if len(words) > count and is_unit(unit):
            return "_".join(words[:-count]), unit
    return key, ""
