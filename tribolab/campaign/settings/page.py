"""Generate CAMPAIGN.md: all keys of a campaign file, and all quantities of columns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from tribolab.campaign.settings.config import campaign_schema
from tribolab.reading.dialect.uncertainty import NAMES
from tribolab.units.quantities import QUANTITIES, Quantity
from tribolab.units.reciprocals import reciprocal

CAMPAIGN_PAGE = "CAMPAIGN.md"
_HEAD = """# The campaign file

All tables and keys of a campaign file. Write a quantity as text, with any unit that converts to the
listed one: `"31 N"`, `"6 mm/min"`, `"20 °C"`. Defaults are in the listed unit. A key that is not
listed is an error. `campaign.schema.json` contains the same for editors. At the end:
[quantities of columns](#quantities-of-columns) and
[values in a header or file name](#values-in-a-header-or-file-name). This page is generated from the
code.
"""
_COLUMNS = """## Quantities of columns

`quantity` of a `[[column]]` in a dialect (see [README.md](README.md)). Signals of a run:
"""
_SCANS = """Heights of a scan:
"""
_VALUES = """## Values in a header or file name

`name` of a `[[value]]` in a dialect: a single value outside the table. Any name is possible; the
value becomes an attribute of the run: a number in SI with its unit in the name (`set_speed_m_s`),
or, without `unit`, a text. A name that is not a quantity also needs `to`, the SI unit in which to
keep it. The following names are used by the analysis:
"""

# Headings of tables whose subtables are named by the user, and of lists of tables.
_TABLE_NAMES = {
    "contact": "[contact] and [contact.NAME]",
    "medium": "[medium.NAME]",
    "surface": "[[surface]]",
    "run": "[[run]]",
    "uncertainty": "[uncertainty.NAME]",
}
_NAMES = "`NAME` is one of these; an instrument's file may have the same tables:\n"
_LAST_SIGNAL = "cycle"
_SCAN_COLUMNS = ("x", "y", "height")
_USED_VALUES = {
    "set_speed": (
        "m/s",
        "the sliding speed if the file records neither velocity nor position; the set-point in "
        "checks",
    ),
    "set_normal_force": (
        "N",
        "the load of the run if `[[run]]` states no `normal_force`; the set-point in checks",
    ),
    "recorded_at": ("", "date and time (ISO 8601), to match two clocks and for the report"),
    "track_radius": (
        "m",
        'the radius for `[speed] source = "rotation"` (or any name stated as `radius_value`)',
    ),
    "tip_radius": ("m", "scan: stylus radius, which limits the spectrum"),
    "stated_length": ("m", "scan: stated length, checked"),
    "stated_points": ("1", "scan: stated number of points, checked"),
    "stated_pitch": ("m", "scan: stated point spacing, checked"),
    "instrument_Ra": (
        "m",
        "scan: Ra computed by the instrument, checked; also `instrument_Rq`",
    ),
}


def campaign_page() -> str:
    """Return the text of CAMPAIGN.md: all tables and keys, and the quantities of columns.

    Examples
    --------
    >>> "## [contact]" in campaign_page()
    True
    """
    schema = campaign_schema()
    required = schema["required"]
    parts = [_HEAD]
    for name, field in schema["properties"].items():
        table = schema["$defs"][_reference(field)]
        title = _TABLE_NAMES.get(name, f"[{name}]")
        wanted = "At least one is required." if name == "run" else "Required."
        needed = f" {wanted}" if name in required else ""
        parts += [f"## {title}\n", f"{table['description']}{needed}\n"]
        if name == "uncertainty":
            stated = schema["$defs"]["StatedUncertainty"]
            parts += [*_keys(stated), _NAMES, *_names(table)]
        else:
            parts += _keys(table)
    names = list(QUANTITIES)
    signals = (*names[: names.index(_LAST_SIGNAL) + 1], "friction_coefficient")
    parts += [_COLUMNS, *_quantities(signals), _SCANS, *_quantities(_SCAN_COLUMNS), _VALUES]
    rows = [
        (f"`{name}`", unit or "text", "" if name in QUANTITIES or not unit else f'`"{unit}"`', text)
        for name, (unit, text) in _USED_VALUES.items()
    ]
    parts += _table(("name", "SI unit", "`to`", "used for"), rows)
    return "\n".join(parts)


def _reference(field: Mapping[str, Any]) -> str:
    """Return the name of the table to which a field of the schema refers."""
    inner = field.get("items") or field.get("additionalProperties") or field
    return str(inner["$ref"]).rpartition("/")[2]


def _keys(table: Mapping[str, Any]) -> list[str]:
    """Return the rows of a table's keys."""
    rows = []
    for name, field in table["properties"].items():
        what, example = _kind(field)
        required = name in table.get("required", ())
        default_text = "required" if required else _default(field.get("default"))
        rows.append((f"`{name}`", _flat(field["description"]), what, example, default_text))
    return _table(("key", "meaning", "unit or type", "example", "default"), rows)


def _names(table: Mapping[str, Any]) -> list[str]:
    """Return the rows of the allowed names of subtables."""
    rows = [
        (f"`{name}`", _flat(field["description"]), *map(str, NAMES[name]))
        for name, field in table["properties"].items()
    ]
    return _table(("NAME", "meaning", "SI unit", "varies with"), rows)


def _flat(text: str) -> str:
    """Return a text in one line, as a row of a Markdown table requires."""
    return " ".join(text.split())


def _kind(field: Mapping[str, Any]) -> tuple[str, str]:
    """Return unit or type of a key in words, and an example of a quantity."""
    kinds = [kind for kind in field.get("anyOf", [field]) if kind.get("type") != "null"]
    if len(kinds) > 1 and kinds[0]["type"] == "number":
        number, text = kinds
        return f"number{_bounds(number)}; or text", f'`"{text["examples"][0]}"`'
    if len(kinds) > 1 and "const" in kinds[1]:
        quantity, word = kinds
        return f'{quantity["unit"]}, or `"{word["const"]}"`', f'`"{quantity["examples"][0]}"`'
    if len(kinds) > 1:  # a text or a list of them
        return "text, or a list of texts", ""
    [kind] = kinds
    if "$ref" in kind:
        return f"table of the keys of `[{_reference(kind).lower()}]`", ""
    if "enum" in kind:
        return ", ".join(f'`"{value}"`' for value in kind["enum"]), ""
    if "prefixItems" in kind:
        ends = kind["prefixItems"]
        shown = ", ".join(f'"{end["examples"][0]}"' for end in ends)
        return f"two values in {ends[0]['unit']}", f"`[{shown}]`"
    if "unit" in kind:
        return kind["unit"], f'`"{kind["examples"][0]}"`'
    if kind["type"] == "object":
        inner = kind.get("additionalProperties", {})
        return f"table of {'texts' if inner.get('type') == 'string' else 'tables'}", ""
    if kind["type"] == "array":
        return "list of texts", ""
    words = {"string": "text", "boolean": "`true`, `false`"}
    return words.get(kind["type"], kind["type"]) + _bounds(kind), ""


def _bounds(kind: Mapping[str, Any]) -> str:
    signs = {"exclusiveMinimum": "&gt;", "minimum": "≥", "exclusiveMaximum": "&lt;", "maximum": "≤"}
    texts = [f"{sign} {kind[name]:g}" for name, sign in signs.items() if name in kind]
    return f", {' and '.join(texts)}" if texts else ""


def _default(default: Any) -> str:
    if default is None or default == {} or default == []:
        return ""
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default:g}`" if isinstance(default, float | int) else f'`"{default}"`'


def _quantities(names: Iterable[str]) -> list[str]:
    rows = [(f"`{name}`", QUANTITIES[name].unit, _meaning(QUANTITIES[name])) for name in names]
    return _table(("quantity", "SI unit", "meaning"), rows)


def _meaning(known: Quantity) -> str:
    """Meaning of a quantity, and whether a unit such as 1/s counts cycles."""
    if known.bare is None or known.unit == "1":
        return known.long_name
    if known.bare == "ask":
        return f"{known.long_name}; the unit must state whether it counts cycles or radians"
    bare = f"1/{inverse.per if (inverse := reciprocal(known.unit)) else 's'}"
    counted = "does not count cycles" if known.bare == "nothing" else f"counts {known.bare}"
    return f"{known.long_name}; `{bare}` {counted}"


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> list[str]:
    lines = [" | ".join(row) for row in (head, ("---",) * len(head), *rows)]
    return [*(f"| {line} |" for line in lines), ""]
