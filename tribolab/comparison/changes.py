"""Changes between two campaigns: settings, decisions, code and data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from tribolab.comparison.folder import Folder
from tribolab.core.untyped import Json
from tribolab.core.wording import number

_NAMED_BY = {"run": "files", "surface": "name"}  # key that identifies the entries of a list


@dataclass(frozen=True)
class Change:
    """One change: its kind, the item that changed, and both values."""

    kind: str
    what: str
    first: str
    second: str


def changes_between(first: Folder, second: Folder) -> list[Change]:
    """Return the changes of settings, decisions, code and raw data between two results."""
    return [
        *_settings(first, second),
        *_decisions(first, second),
        *_pairs("code", first.report["versions"], second.report["versions"]),
        *_data(first, second),
    ]


def _settings(first: Folder, second: Folder) -> list[Change]:
    flat = [_flat_settings(folder) for folder in (first, second)]
    return _pairs("settings", *flat)


def _flat_settings(folder: Folder) -> dict[str, str]:
    """Return the values of all keys of the campaign file, including defaults, in SI."""
    if folder.campaign is None:
        return {"the campaign file": f"as of {folder.report['campaign']['sha256'][:12]}"}
    return dict(_flat(folder.campaign.model_dump(mode="json"), ""))


def _flat(value: Any, where: str) -> Iterable[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(inner, f"{where}.{key}" if where else str(key))
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        key = _NAMED_BY.get(where, "")
        for place, inner in enumerate(value):
            name = _text(inner.get(key, place + 1))
            yield from _flat({k: v for k, v in inner.items() if k != key}, f"{where} {name}")
            yield f"{where} {name}", "there"
    else:
        yield where, _text(value)


def _text(value: Any) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value))
    if isinstance(value, bool) or not isinstance(value, int | float):
        return "–" if value in (None, "") else str(value)
    return number(value, 6)


def _pairs(kind: str, first: Mapping[str, str], second: Mapping[str, str]) -> list[Change]:
    return [
        Change(kind, key, first.get(key, "–"), second.get(key, "–"))
        for key in dict.fromkeys([*first, *second])
        if first.get(key, "–") != second.get(key, "–")
    ]


def _decisions(first: Folder, second: Folder) -> list[Change]:
    decisions = [
        {run["name"]: _decision_text(run) for run in folder.report["runs"]}
        for folder in (first, second)
    ]
    both = [name for name in decisions[0] if name in decisions[1]]
    return _pairs("decisions", *({name: of[name] for name in both} for of in decisions))


def _decision_text(run: Json) -> str:
    rows = run.get("decisions") or []
    return "; ".join(_text([v for k, v in row.items() if k != "number"]) for row in rows) or "none"


def _data(first: Folder, second: Folder) -> list[Change]:
    known = [
        {source["file"]: source["sha256"] for source in folder.report["sources"]}
        for folder in (first, second)
    ]
    contents = [set(of.values()) for of in known]
    shared = contents[0] & contents[1]
    if contents[0] == contents[1]:
        return []
    if not shared:
        counts = [f"{len(of)} files" for of in known]
        return [Change("data", "raw files: none in common", *counts)]
    changed = [
        Change("data", name, known[0][name][:12], known[1][name][:12])
        for name in known[0]
        if name in known[1] and known[0][name] != known[1][name]
    ]
    alone = [len([1 for name, sha in of.items() if sha not in shared]) for of in known]
    words = [f"{count} of their own" for count in alone]
    return [*changed, Change("data", f"raw files: {len(shared)} in common", *words)]
