"""Cases made from what the plugin recorded, and from the reference material."""

from __future__ import annotations

import json
import lzma
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from layouts import KINDS

from corpus.store import RIG, SHARED, Case, checksum

LARGEST = 500_000  # bytes of a file that is packed
LARGEST_PACKED = 40_000  # bytes that it packs to
MOST_OF_A_TEST = 30  # files of one test that draws them by lot
MOST_DAMAGED = 10  # files of one test that damages or invents them: they hardly pack
_HERE = b"pytest-of-"  # where tests write: a file that refers to another by its whole path
_DAMAGING = ("test_hostile", "test_io_bad_input", "test_robustness", "test_strange_files")
_NO_DATA = ("licen", "readme")
_DRAFTED = "# Drafted from "  # an instrument that a draft made: the file alone says it all


def shared_cases() -> list[Case]:
    """Return every file of the reference material as a case of its own."""
    return [
        Case(((path.name, place),), ways=("run", "modulus"), test="shared")
        for place, path in sorted(_shared().items())
    ]


def _shared() -> dict[str, Path]:
    files = (path for path in SHARED.rglob("*") if path.is_file())
    return {
        path.relative_to(SHARED).as_posix(): path
        for path in files
        if not path.stem.lower().startswith(_NO_DATA) and path.suffix not in (".md", ".toml")
    }


def made_cases() -> tuple[list[Case], dict[str, bytes]]:
    """Return the files that the rig writes, alone and with what has to be said of some."""
    cases, contents = [], {}
    for name, kind in KINDS.items():
        file, test = ((name, RIG + name),), "rig"
        cases.append(Case(file, ways=("run",), test=test))
        said = (("zero", kind.zero),) if kind.zero else ()
        instrument = checksum(kind.dialect.encode()) if kind.dialect else None
        if instrument is not None:
            contents[instrument] = kind.dialect.encode()
        if said or instrument:
            cases.append(Case(file, (), instrument, said, ("run",), test))
    return cases, contents


def recorded_cases(folder: Path) -> tuple[list[Case], dict[str, bytes], Counter[str]]:
    """Return the cases that were recorded in a folder, their contents, and why others are not."""
    places = {checksum(path.read_bytes()): place for place, path in _shared().items()}
    left: Counter[str] = Counter()
    contents: dict[str, bytes] = {}
    packed: dict[str, int] = {}
    merged: dict[str, Case] = {}
    for plain in _recorded(folder):
        case = _case(plain, places, folder, contents, left, packed)
        if case is None:
            continue
        if case.key in merged:
            known = merged[case.key]
            beside = dict((*known.beside, *case.beside))
            case = known._replace(
                beside=tuple(sorted(beside.items())),
                ways=tuple(sorted({*known.ways, *case.ways})),
                test=min(known.test, case.test),
            )
        merged[case.key] = case
    chosen = list(_chosen(merged, left))
    used = {name for case in chosen for _, name in (*case.files, *case.beside)}
    used |= {case.instrument for case in chosen if case.instrument is not None}
    return chosen, {name: contents[name] for name in sorted(used & contents.keys())}, left


def _recorded(folder: Path) -> Iterable[dict[str, Any]]:
    for path in sorted(folder.glob("cases_*.jsonl")):
        for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
            yield json.loads(line)


def _case(
    plain: dict[str, Any],
    places: dict[str, str],
    folder: Path,
    contents: dict[str, bytes],
    left: Counter[str],
    packed: dict[str, int],
) -> Case | None:
    files = tuple((name, content) for name, content in plain["files"])
    beside = tuple(sorted((name, content) for name, content in plain["beside"]))
    instrument = plain["instrument"]
    said = tuple(sorted(item for item in plain["said"].items() if item != ("pair", True)))
    if instrument is not None and instrument.startswith(_DRAFTED):
        left["read by a drafted description"] += 1
        return None
    if plain["test"].startswith("tests/instruments/test_file_kinds.py"):
        return None  # of the rig
    if any(not name.isprintable() or len(name.encode()) > 90 for name, _ in (*files, *beside)):
        left["a name that no archive holds"] += 1
        return None
    if all(content in places for _, content in files):
        if instrument is None and not said and len(files) == 1:
            return None  # each is a case anyhow
        files, beside = tuple((name, places[content]) for name, content in files), ()
    for _, content in (*files, *beside):
        if "/" in content:
            continue
        stored = folder / "files" / content
        if stored.stat().st_size > LARGEST:
            left[f"larger than {LARGEST // 1000} kB"] += 1
            return None
        if content not in packed:
            read = stored.read_bytes()
            if _HERE in read:
                left["names a folder of the machine"] += 1
                return None
            contents[content] = read
            packed[content] = len(lzma.compress(read, preset=1))
        if packed[content] > LARGEST_PACKED:
            left[f"packed larger than {LARGEST_PACKED // 1000} kB"] += 1
            return None
    if instrument is not None and "\n" in instrument or (instrument or "").startswith("{"):
        text = instrument.encode()
        instrument = checksum(text)
        contents[instrument] = text
    kind = "draft" if plain["kind"] == "peek" else plain["kind"]
    return Case(files, beside, instrument, said, (kind,), _test(plain["test"]))


def _test(name: str) -> str:
    return name.removeprefix("tests/").partition("[")[0]


def _chosen(cases: dict[str, Case], left: Counter[str]) -> Iterable[Case]:
    """Leave out a content that only has another name, and most files of a test with very many."""
    seen: set[tuple[Any, ...]] = set()
    count: Counter[str] = Counter()
    for _, case in sorted(cases.items()):
        inside = tuple((Path(name).suffix, content) for name, content in case.files)
        alike = (inside, case.instrument, case.said)
        if not case.beside and alike in seen:
            left["the same under another name"] += 1
            continue
        most = MOST_DAMAGED if case.test.startswith(_DAMAGING) else MOST_OF_A_TEST
        if count[case.test] >= most:
            left[f"more than {most} of one test"] += 1
            continue
        seen.add(alike)
        count[case.test] += 1
        yield case
