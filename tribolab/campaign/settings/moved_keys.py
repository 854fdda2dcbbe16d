"""Keys of older campaign files, moved to their present place."""

from __future__ import annotations

from tribolab.core.untyped import Json

_TO_MODEL = {  # table and key before: key in [model] now
    ("joint", "together"): "together",
    ("joint", "dry"): "dry_medium",
    ("contact", "area"): "area",
    ("contact", "normal_forces"): "normal_forces",
}
_COMPUTE = {"always": True, "two loads": True, "never": False}  # [joint] compute, before
_LABELS = ("operator", "mount", "day", "specimen")  # keys of [[run]], before


def move_keys(content: Json) -> list[str]:
    """Move old keys in the content of a campaign file, and return a line for each.

    A key that contradicts its present place remains where it is, and is then an unknown key.

    Examples
    --------
    >>> content = {"joint": {"compute": "never"}}
    >>> move_keys(content)
    ['[joint] compute will be removed in the next release: write [model] joint = false']
    >>> content
    {'model': {'joint': False}}
    """
    return _move_labels(content) + _move_to_model(content)


def _move_to_model(content: Json) -> list[str]:
    lines: list[str] = []
    model = content.get("model", {})
    if not isinstance(model, dict):
        return lines
    for (table, old), new in _TO_MODEL.items():
        for name, before in _tables(content, table):
            if old in before and model.get(new, before[old]) == before[old]:
                model[new] = before.pop(old)
                lines.append(_line(f"[{name}] {old}", f"[model] {new}"))
    for name, before in _tables(content, "joint"):
        now = _COMPUTE.get(str(before.get("compute")))
        if now is not None and model.get("joint", now) == now:
            model["joint"] = now
            del before["compute"]
            lines.append(_line(f"[{name}] compute", f"[model] joint = {str(now).lower()}"))
    if content.get("joint") == {}:
        del content["joint"]
    if model:
        content["model"] = model
    return lines


def _move_labels(content: Json) -> list[str]:
    lines: list[str] = []
    runs = content.get("run")
    tables = [run for run in runs if isinstance(run, dict)] if isinstance(runs, list) else []
    for key in _LABELS:
        moved = False
        for run in tables:
            labels = run.get("labels", {})
            if key in run and isinstance(labels, dict) and key not in labels:
                run["labels"] = {**labels, key: run.pop(key)}
                moved = True
        if moved:
            lines.append(_line(f"[[run]] {key}", f"[[run]] labels.{key}"))
    return lines


def _tables(content: Json, name: str) -> list[tuple[str, Json]]:
    """Return a table and its named tables, [contact.NAME], with their names."""
    table = content.get(name)
    if not isinstance(table, dict):
        return []
    named = [(f"{name}.{key}", of) for key, of in table.items() if isinstance(of, dict)]
    return [(name, table), *named]


def _line(old: str, now: str) -> str:
    return f"{old} will be removed in the next release: write {now}"
