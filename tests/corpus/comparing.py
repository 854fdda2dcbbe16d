"""How what is read now differs from what was read, by class."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from corpus.store import HERE, Read

RELATIVE = 1e-9  # of the number, and of the largest magnitude of a signal
OUTCOME = "outcome"  # read, asked about, refused
MEANING = "unit or role"
NUMBER = "number"
QUESTION = "question"
SETTING = "setting"
WORDING = "wording"  # of a message, or the name of a setting: told, but no test fails
CLASSES = (OUTCOME, MEANING, NUMBER, QUESTION, SETTING, WORDING)


class Difference(NamedTuple):
    """One difference: its class, in what, and both values."""

    kind: str
    where: str
    was: Any
    now: Any

    def __str__(self) -> str:
        return f"{self.kind}: {self.where}: {_short(self.was)} -> {_short(self.now)}"


def differences(was: Read, now: Read) -> list[Difference]:
    """Return how two readings of a case differ; of one that ends otherwise only that."""
    if was["outcome"] != now["outcome"]:
        both = [f"{one['outcome']} {one.get('why', '')}".strip() for one in (was, now)]
        return [Difference(OUTCOME, "outcome", *both)]
    return list(_within(was, now))


def _within(was: Read, now: Read) -> Iterator[Difference]:
    for name, kind in (("kind", OUTCOME), ("known", OUTCOME), ("missing", QUESTION)):
        if was.get(name) != now.get(name):
            yield Difference(kind, name, was.get(name), now.get(name))
    yield from _questions(was.get("asked", []), now.get("asked", []))
    yield from _columns(was.get("columns", []), now.get("columns", []))
    yield from _signals(was.get("signals", {}), now.get("signals", {}))
    yield from _scans(was.get("scans", []), now.get("scans", []))
    yield from _settings(was.get("results", {}), now.get("results", {}))
    yield from _settings(was.get("settings", {}), now.get("settings", {}))
    if was.get("why") != now.get("why"):
        yield Difference(WORDING, "why", was.get("why"), now.get("why"))


def _questions(was: list[Any], now: list[Any]) -> Iterator[Difference]:
    for gone in was:
        if gone not in now:
            yield Difference(QUESTION, gone[0], gone[1:], "not asked so")
    for new in now:
        if new not in was:
            yield Difference(QUESTION, new[0], "not asked so", new[1:])


def _columns(was: list[Any], now: list[Any]) -> Iterator[Difference]:
    if len(was) != len(now):
        yield Difference(MEANING, "columns", len(was), len(now))
        return
    for place, (one, other) in enumerate(zip(was, now, strict=True), 1):
        if [*one[:3], *one[4:]] != [*other[:3], *other[4:]] or not near(one[3], other[3]):
            yield Difference(MEANING, f"column {place}", one, other)


def _signals(was: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[Difference]:
    for name in sorted(was.keys() | now.keys()):
        one, other = was.get(name), now.get(name)
        if one is None or other is None or one[0] != other[0]:
            yield Difference(MEANING, name, one, other)
        elif not _alike(one[1:], other[1:]):
            yield Difference(NUMBER, name, one[1:], other[1:])


def _scans(was: list[Any], now: list[Any]) -> Iterator[Difference]:
    if len(was) != len(now):
        yield Difference(NUMBER, "scans", len(was), len(now))
        return
    for count, (one, other) in enumerate(zip(was, now, strict=True), 1):
        where = f"scan {count}, "
        if one["shape"] != other["shape"]:
            yield Difference(NUMBER, where + "shape", one["shape"], other["shape"])
            continue
        heights = ({"heights": scan["heights"]} for scan in (one, other))
        yield from (found._replace(where=where + found.where) for found in _signals(*heights))
        peak = one["heights"][-1] if len(one["heights"]) > 3 else 0.0
        if not near(one["Rq"], other["Rq"], peak):
            yield Difference(NUMBER, where + "Rq", one["Rq"], other["Rq"])
        told = _settings(one["settings"], other["settings"])
        yield from (found._replace(where=where + found.where) for found in told)


def _settings(was: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[Difference]:
    new = {name: now[name] for name in sorted(now.keys() - was.keys())}
    for name in sorted(was):
        if name in now:
            if not _same(was[name], now[name]):
                text = name != "columns_used" and isinstance(was[name], str | Mapping)
                kind = MEANING if name == "columns_used" else WORDING if text else SETTING
                yield Difference(kind, name, was[name], now[name])
            continue
        unit = name.rpartition("_")[2]
        called = [n for n in new if n.rpartition("_")[2] == unit and _same(was[name], new[n])]
        if called:
            new.pop(called[0])
            yield Difference(WORDING, "name of a setting", name, called[0])
        else:
            yield Difference(SETTING, name, was[name], None)
    for name, value in new.items():
        yield Difference(SETTING, name, None, value)


def _alike(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Whether summaries agree: counts exactly, numbers but for rounding."""
    if len(one) != len(other) or list(one[:2]) != list(other[:2]):
        return False
    peak = one[-1] if len(one) > 2 else 0.0
    return all(near(*pair, peak) for pair in zip(one[2:], other[2:], strict=True))


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_same(one[name], other[name]) for name in one)
    return near(one, other)


def near(one: Any, other: Any, peak: Any = 0.0) -> bool:
    """Whether two numbers agree but for rounding; what is no number, exactly."""
    if not all(isinstance(value, int | float) for value in (one, other)):
        return bool(one == other)
    largest = abs(peak) if isinstance(peak, int | float) else 0.0
    return abs(one - other) <= RELATIVE * max(abs(one), abs(other), largest)


def judged() -> dict[tuple[str, str], str]:
    """Return the differences that are judged right: a case, in what, and why."""
    lines = (HERE / "judged.jsonl").read_text(encoding="utf-8").splitlines()
    told = [json.loads(line) for line in lines if line.strip()]
    return {(one["case"], one["where"]): one["why"] for one in told}


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 160 else f"{text[:160]} ..."
