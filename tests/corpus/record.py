"""A pytest plugin that writes down every file that tests hand to reading, as it then is.

    TRIBOLAB_RECORD=FOLDER PYTHONPATH=.:tests \
        python -m pytest -p corpus.record tests/questions/test_draft.py
    TRIBOLAB_RECORD=FOLDER PYTHONPATH=.:tests python -m corpus.record tests/robustness/scan_kinds.py

The functions below are watched wherever they were imported to: their code is replaced, not their
name. A file goes to ``FOLDER/files`` under its checksum, and a line to a list of cases: the name,
the checksum, the instrument, what else was said, the files beside it that were looked at, the test.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import runpy
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from types import FunctionType
from typing import Any

from corpus.store import checksum
from tribolab.core.errors import ReadError

LARGEST = 4_000_000  # bytes of a file that is kept while recording
_WATCHED = (
    ("tribolab.reading.unknown_run", "read_run", "run"),
    ("tribolab.reading.unknown_run", "read_log", "run"),
    ("tribolab.reading.unknown_run", "draft_of", "draft"),
    ("tribolab.reading.runs.read_run", "read_run", "run"),
    ("tribolab.reading.runs.read_run", "read_log", "run"),
    ("tribolab.reading.scan_files", "read_scans", "scan"),
    ("tribolab.reading.scans.read_scan", "read_known_scans", "scan"),
    ("tribolab.reading.unknown.proposal.draft", "draft_dialect", "draft"),
    ("tribolab.app.info.file_info", "file_lines", "draft"),
    ("tribolab.reading.scans.results", "read_tester_results", "results"),
    ("tribolab.rubber.modulus", "read_modulus", "modulus"),
    ("tribolab.reading.text.first_bytes", "peek", "peek"),
)


class Recorder:
    """Keeps what was read; one for each process."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "files").mkdir(parents=True, exist_ok=True)
        self.list = folder / f"cases_{os.getpid()}.jsonl"
        self.process = os.getpid()
        self.seen: set[str] = set()
        self.inside: dict[str, Any] | None = None
        self.only_record = "TRIBOLAB_RECORD_ONLY" in os.environ

    def watch(
        self, kind: str, original: FunctionType, args: tuple[Any, ...], named: dict[str, Any]
    ) -> Any:
        """Record a call of a watched function, and call it."""
        if os.getpid() != self.process:
            return original(*args, **named)
        if self.inside is not None:
            if kind == "peek":
                self._beside(args, named)
            return original(*args, **named)
        case = self._case(kind, original, args, named)
        if case is None:
            return original(*args, **named)
        if self.only_record:
            self._write(case)
            raise ReadError("recorded, not read")
        self.inside = case
        try:
            return original(*args, **named)
        finally:
            self.inside = None
            self._write(case)

    def _case(
        self, kind: str, original: FunctionType, args: tuple[Any, ...], named: dict[str, Any]
    ) -> dict[str, Any] | None:
        try:
            said = inspect.signature(original).bind(*args, **named).arguments
            given = said.pop("path", None) or said.pop("paths", None)
            said.update(said.pop("said", {}))
            paths = list(_paths(given))
            instrument = _instrument(said.pop("instrument", None))
        except (TypeError, ValueError, OSError):
            return None
        said = {key: value for key, value in said.items() if _is_plain(value)}
        for key in ("name", "binary", "stack"):
            said.pop(key, None)
        files = [self._keep(path) for path in paths]
        if not files or not all(files):
            return None
        place = paths[0].parent
        return {
            "kind": kind,
            "files": files,
            "beside": [],
            "instrument": instrument,
            "said": said,
            "place": str(place),
            "test": os.environ.get("PYTEST_CURRENT_TEST", "").split(" ")[0],
        }

    def _beside(self, args: tuple[Any, ...], named: dict[str, Any]) -> None:
        case = self.inside
        assert case is not None
        path = Path(args[0] if args else named["path"])
        if str(path.parent) != case["place"]:
            return
        kept = self._keep(path)
        if kept and kept not in case["files"] and kept not in case["beside"]:
            case["beside"].append(kept)

    def _keep(self, path: Path) -> list[str] | None:
        try:
            if not path.is_file():
                return None
            size = path.stat().st_size
            if size > LARGEST:
                with (self.folder / f"too_large_{self.process}.txt").open("a") as notes:
                    test = os.environ.get("PYTEST_CURRENT_TEST", "")
                    notes.write(f"{path.name}\t{size}\t{test}\n")
                return None
            content = path.read_bytes()
        except OSError:
            return None
        name = checksum(content)
        stored = self.folder / "files" / name
        if not stored.exists():
            stored.write_bytes(content)
        return [path.name, name]

    def _write(self, case: dict[str, Any]) -> None:
        case.pop("place")
        line = json.dumps(case, sort_keys=True, ensure_ascii=False)
        if line not in self.seen:
            self.seen.add(line)
            with self.list.open("a", encoding="utf-8", errors="surrogatepass") as cases:
                cases.write(line + "\n")


def _paths(given: Any) -> Iterable[Path]:
    """Return the files that are given: one, a list, or those of a pattern."""
    if isinstance(given, str | Path):
        path = Path(given)
        if "*" in path.name:
            return sorted(path.parent.glob(path.name))
        return [path]
    return [path for one in given for path in _paths(one)]


def _instrument(given: Any) -> str | None:
    """Return an instrument as text: its name, or its description as TOML or JSON."""
    if given is None:
        return None
    if hasattr(given, "model_dump_json"):
        return str(given.model_dump_json(exclude_defaults=True, by_alias=True))
    if str(given).endswith(".toml"):
        return Path(given).read_text(encoding="utf-8")
    return str(given)


def _is_plain(value: Any) -> bool:
    return isinstance(value, str | float | int | bool)


def install(folder: Path) -> None:
    """Watch the functions that read."""
    recorder = Recorder(folder)
    for module, name, kind in _WATCHED:
        _watch(getattr(importlib.import_module(module), name), kind, recorder.watch)


def _watch(function: FunctionType, kind: str, watch: Callable[..., Any]) -> None:
    """Have a function tell of its calls, whoever has imported it already."""
    original = FunctionType(
        function.__code__,
        function.__globals__,
        function.__name__,
        function.__defaults__,
        function.__closure__,
    )
    original.__kwdefaults__ = function.__kwdefaults__
    key = f"_recorded_{function.__name__}"
    function.__globals__[key] = lambda args, named: watch(kind, original, args, named)
    made: dict[str, Any] = {}
    exec(f"def told(*args, **named):\n    return {key}(args, named)", made)
    function.__signature__ = inspect.signature(original)  # type: ignore[attr-defined]
    function.__code__ = made["told"].__code__
    function.__defaults__, function.__kwdefaults__ = None, None  # type: ignore[assignment]


if "TRIBOLAB_RECORD" in os.environ:
    install(Path(os.environ["TRIBOLAB_RECORD"]))

if __name__ == "__main__":
    _, script, *_ = sys.argv
    os.environ["PYTEST_CURRENT_TEST"] = Path(script).name
    sys.argv = sys.argv[1:]
    runpy.run_path(str(Path(script).resolve()), run_name="__main__")
