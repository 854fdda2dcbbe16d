"""Keys of older campaign files, moved to their present place with a warning for each."""

from __future__ import annotations

import multiprocessing
import warnings
from pathlib import Path

from tribolab.core.untyped import Json

_TO_MODEL = {  # table and key before: key in [model] now
    ("joint", "together"): "together",
    ("joint", "dry"): "dry_medium",
    ("contact", "area"): "area",
    ("contact", "normal_forces"): "normal_forces",
}
_COMPUTE = {"always": True, "two loads": True, "never": False}  # [joint] compute, before


def move_keys(path: Path, content: Json) -> None:
    """Move old keys in the content of a campaign file to their present place.

    A key that contradicts its present place remains where it is, and is then an unknown key.

    Examples
    --------
    >>> content = {"joint": {"compute": "never"}}
    >>> with warnings.catch_warnings(record=True) as said:
    ...     warnings.simplefilter("always")
    ...     move_keys(Path("campaign.toml"), content)
    >>> content
    {'model': {'joint': False}}
    >>> print(said[0].message)
    campaign.toml: [joint] compute will be removed in the next release: write [model] joint = false
    """
    model = content.get("model", {})
    if not isinstance(model, dict):
        return
    for (table, old), new in _TO_MODEL.items():
        for name, before in _tables(content, table):
            if old in before and model.get(new, before[old]) == before[old]:
                model[new] = before.pop(old)
                _warn(path, f"[{name}] {old}", f"[model] {new}")
    for name, before in _tables(content, "joint"):
        now = _COMPUTE.get(str(before.get("compute")))
        if now is not None and model.get("joint", now) == now:
            model["joint"] = now
            del before["compute"]
            _warn(path, f"[{name}] compute", f"[model] joint = {str(now).lower()}")
    if content.get("joint") == {}:
        del content["joint"]
    if model:
        content["model"] = model


def _tables(content: Json, name: str) -> list[tuple[str, Json]]:
    """Return a table and its named tables, [contact.NAME], with their names."""
    table = content.get(name)
    if not isinstance(table, dict):
        return []
    named = [(f"{name}.{key}", of) for key, of in table.items() if isinstance(of, dict)]
    return [(name, table), *named]


def _warn(path: Path, old: str, now: str) -> None:
    """Warn of an old key, but not in every worker."""
    if multiprocessing.parent_process() is None:
        text = f"{path}: {old} will be removed in the next release: write {now}"
        warnings.warn(text, FutureWarning, stacklevel=5)
