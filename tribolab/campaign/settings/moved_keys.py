"""Old keys of campaign files and the keys that replace them."""

from __future__ import annotations

from collections.abc import Iterator

from tribolab.core.untyped import Json
from tribolab.friction.segments.limits import DETECTION

MOVED = {  # old key: new key; keys move out of [[run]] only if all runs have the same value
    "joint.together": "model.together",
    "joint.dry": "model.dry_medium",
    "contact.area": "model.area",
    "contact.normal_forces": "model.normal_forces",
    **{f"run.{key}": f"run.labels.{key}" for key in ("operator", "mount", "day", "specimen")},
    "run.labels_in_name": "campaign.files_named",
    **{f"segments.{key}": f"qc.limits.segments.{key}" for key in DETECTION},
    **{f"run.segments.{key}": f"qc.limits.segments.{key}" for key in DETECTION},
}
_TO_INSTRUMENT = ("moving_mass", "rectified")  # keys of [[run]] that its file can state
_COMPUTE = {"always": True, "two loads": True, "never": False}  # values of the old [joint] compute


def move_keys(content: Json) -> list[str]:
    """Move old keys in the content of a campaign file, and return a line for each.

    An old key that contradicts the new one is not moved; it is then an unknown key.

    Examples
    --------
    >>> content = {"joint": {"compute": "never"}, "contact": {"area": "persson"}}
    >>> for line in move_keys(content):
    ...     print(line)
    [joint] compute will be removed in the next release: write [model] joint = false
    [contact] area will be removed in the next release: write [model] area
    >>> content
    {'contact': {}, 'model': {'joint': False, 'area': 'persson'}}
    """
    lines = []
    for table in _tables(content, "joint"):
        joint = _COMPUTE.get(str(table.get("compute")))
        if joint is not None and _set(content, "model.joint", joint):
            del table["compute"]
            lines.append(_line("joint.compute", f"[model] joint = {str(joint).lower()}"))
    for old, new in MOVED.items():
        place, _, key = old.rpartition(".")
        found = [table for table in _tables(content, place) if key in table]
        within = new.startswith(f"{place}.")
        runs = [*_tables(content, "run")] if place[:3] == "run" else found
        agree = len(found) == len(runs) and all(t[key] == found[0][key] for t in found)
        moved = [
            table.pop(key)
            for table in found
            if (within or agree)
            and _set(
                table if within else content, new.removeprefix(f"{place}." * within), table[key]
            )
        ]
        if moved:
            lines.append(_line(old, _words(new)))
    if content.get("joint") == {}:
        del content["joint"]
    for key in _TO_INSTRUMENT:
        if any(key in run for run in _tables(content, "run")):
            lines.append(_line(f"run.{key}", f"{key} in the instrument's file"))
    return lines


def _tables(content: Json, place: str) -> Iterator[Json]:
    """Yield the tables at a path: every [[run]]; for "contact" also every [contact.NAME]."""
    name, _, inner = place.partition(".")
    found = content.get(name)
    tables = found if isinstance(found, list) else [found]
    if name == "contact" and isinstance(found, dict):
        tables = [found, *found.values()]
    for table in tables:
        if isinstance(table, dict):
            yield from _tables(table, inner) if inner else (table,)


def _set(content: Json, place: str, value: object) -> bool:
    """Set a key unless it has another value; return whether it now has the given value."""
    *names, key = place.split(".")
    table: object = content
    for name in names:
        table = table.setdefault(name, {}) if isinstance(table, dict) else None
    return isinstance(table, dict) and bool(table.setdefault(key, value) == value)


def _words(place: str) -> str:
    table, _, key = place.partition(".")
    return f"[[run]] {key}" if table == "run" else f"[{table}] {key}"


def _line(old: str, now: str) -> str:
    return f"{_words(old)} will be removed in the next release: write {now}"
