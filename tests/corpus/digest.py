"""What reading makes of a case, in few numbers and words."""

from __future__ import annotations

import json
import multiprocessing
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from corpus.store import Case, Read, contents_of, write_case
from tribolab.core.errors import TribolabError
from tribolab.reading.dialect.find import Dialect
from tribolab.reading.run_files import read as read_run
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.results import read_tester_results
from tribolab.reading.unknown.proposal.draft import Draft
from tribolab.reading.unknown.proposal.questions import missing_words, questions
from tribolab.reading.unknown_run import draft_of
from tribolab.rubber.modulus import read_modulus

# Of the version, the moment and the machine, or the words of a cure: not what was read.
_ASIDE = {
    "Conventions",
    "drafted_layout",
    "history",
    "instrument_note",
    "source",
    "source_sha256",
    "to_keep_it",
    "tribolab_version",
}
_LONGEST = 200  # letters of a message


def read_all(
    cases: Mapping[str, Case], contents: Mapping[str, bytes], jobs: int = 1
) -> Iterator[tuple[str, Read, float]]:
    """Read cases; say how far it is, and how long each took to compute."""
    tasks = [(key, case, contents_of(case, contents)) for key, case in cases.items()]
    if jobs == 1:
        yield from _told(map(_work, tasks), len(tasks))
        return
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=spawn) as pool:
        yield from _told(pool.map(_work, tasks, chunksize=8), len(tasks))


def _told(done: Iterator[tuple[str, Read, float]], total: int) -> Iterator[tuple[str, Read, float]]:
    start = time.monotonic()
    for count, one in enumerate(done, 1):
        if count % 50 == 0 or count == total:
            print(f"{count} of {total} after {time.monotonic() - start:.0f} s", file=sys.stderr)
        yield one


def _work(task: tuple[str, Case, Mapping[str, bytes]]) -> tuple[str, Read, float]:
    key, case, contents = task
    start = time.process_time()
    try:
        read = read_case(case, contents)
    except Exception as error:  # noqa: BLE001 - a crash is an outcome, too
        read = {"outcome": "crash", "why": {"crash": f"{type(error).__name__}: {error}"[:200]}}
    return key, read, time.process_time() - start


def read_case(case: Case, contents: Mapping[str, bytes]) -> Read:
    """Read a case with the code as it is.

    Returns
    -------
    dict
        ``outcome``: run, scan, modulus, results, asked or refused; ``why`` the first line of what
        a refusal says; ``asked`` the questions; ``columns`` how those of an unknown file are
        understood; ``signals``, ``settings`` and ``scans`` what was read, in SI.
    """
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        folder = Path(name).resolve()
        paths = write_case(case, contents, folder)
        found = _read(case, paths, _instrument(case, contents, folder))
        text = json.dumps(found, ensure_ascii=True)
        for place in {str(folder), str(paths[0].parent)}:
            text = text.replace(json.dumps(place + os.sep)[1:-1], "")
        return json.loads(text)


def _instrument(case: Case, contents: Mapping[str, bytes], folder: Path) -> Any:
    if case.instrument not in contents:
        return case.instrument
    text = contents[case.instrument]
    if text.startswith(b"{"):
        return Dialect.model_validate_json(text)
    return folder / "instrument.toml"


def _read(case: Case, paths: Sequence[Path], instrument: Any) -> Read:
    said = dict(case.said)
    if instrument is not None or said or len(paths) > 1:
        return _described(case, paths, instrument, said)
    (path,) = paths
    draft = draft_of(path)
    found: Read = {} if draft is None else _understood(draft)
    ways: list[tuple[str, Callable[[], Read]]] = [("run", lambda: _run(read_run(path)))]
    scan = lambda: _scans(read_scans(path, stack=False))  # noqa: E731 - beside the others
    ways.append(("scan", scan))
    ways.append(("results", lambda: _results(read_tester_results(path))))
    if "modulus" in case.ways:
        ways.append(("modulus", lambda: _modulus(path, {})))
    if "run" not in case.ways:  # what is read as the test reads it comes first
        ways.sort(key=lambda way: way[0] not in case.ways)
    return found | _first(ways, asked=bool(found.get("asked") or found.get("missing")))


def _described(case: Case, paths: Sequence[Path], instrument: Any, said: dict[str, Any]) -> Read:
    if "scan" in case.ways:
        units = {"x_unit": said.get("x_unit"), "height_unit": said.get("height_unit")}
        scans = lambda: _scans(  # noqa: E731 - beside the other
            read_scans(paths, instrument, stack=False, **units)
        )
        return _first([("scan", scans)])
    if case.ways == ("modulus",):
        return _first([("modulus", lambda: _modulus(paths[0], said))])
    given = paths[0] if len(paths) == 1 else paths
    return _first([("run", lambda: _run(read_run(given, instrument, **said)))])


def _first(ways: Sequence[tuple[str, Callable[[], Read]]], asked: bool = False) -> Read:
    """Read in the first way that succeeds; else say why the first one did not."""
    refusals: dict[str, str] = {}
    for way, read in ways:
        try:
            return {"outcome": way, **read()}
        except TribolabError as error:
            words = (str(error).strip().splitlines() or [""])[0][:_LONGEST]
            refusals[way] = f"{type(error).__name__}: {words}"
    refusals = {way: why for way, why in refusals.items() if way in ("run", "scan", "modulus")}
    return {"outcome": "asked" if asked else "refused", "why": refusals}


def _understood(draft: Draft) -> Read:
    """Return how the columns of an unknown file are understood, and what is asked of it."""
    found: Read = {"kind": draft.kind}
    if draft.known:
        found["known"] = draft.known
        return found
    asked = [[question.about, question.guess, *question.options] for question in questions(draft)]
    if asked:
        found["asked"] = asked
    if missing := missing_words(draft):
        found["missing"] = missing
    if draft.understood is not None:
        found["columns"] = [
            [
                column.label,
                column.quantity if column.used else None,
                column.read_unit,
                _rounded(column.sign * column.scale),
                *([column.said] if column.said else []),
            ]
            for column in draft.understood.columns
        ]
    return found


def _run(run: xr.Dataset) -> Read:
    found: Read = {"signals": {}}
    for name in sorted(map(str, run.variables)):
        if "time" in run[name].dims:
            found["signals"][name] = _numbers(run[name])
    return found | {"settings": _settings(run.attrs)}


def _scans(scans: Sequence[xr.Dataset]) -> Read:
    found = []
    for scan in scans:
        height = scan["height"]
        values = height.values[np.isfinite(height.values)]
        rq = float(np.sqrt(np.mean((values - values.mean()) ** 2))) if values.size else np.nan
        one: Read = {"shape": dict(zip(map(str, height.dims), height.shape, strict=True))}
        one["heights"] = _numbers(height)
        one["Rq"] = _rounded(rq)
        found.append(one | {"settings": _settings(scan.attrs)})
    return {"scans": found}


def _results(results: xr.Dataset) -> Read:
    numbers = {str(name): _rounded(float(results[name])) for name in sorted(results.data_vars)}
    return {"results": numbers, "settings": _settings(results.attrs)}


def _modulus(path: Path, said: Mapping[str, Any]) -> Read:
    table = read_modulus(path, **said)
    signals = {
        "angular_frequency": ["rad/s", *_summary(table.angular_frequency)],
        "storage": ["Pa", *_summary(table.storage)],
        "loss": ["Pa", *_summary(table.loss)],
    }
    return {"signals": signals}


def _numbers(signal: xr.DataArray) -> list[Any]:
    return [str(signal.attrs.get("units", "")), *_summary(signal.values)]


def _summary(values: np.ndarray) -> list[Any]:
    """Return the number of values and of missing ones; first, median, last, largest magnitude."""
    if values.dtype.kind not in "fiub":
        return [values.size, 0, *map(str, values.ravel()[[0, -1]] if values.size else ())]
    flat = np.asarray(values, dtype=float).ravel()
    present = flat[np.isfinite(flat)]
    if not present.size:
        return [flat.size, flat.size]
    told = (flat[0], np.median(present), flat[-1], np.abs(present).max())
    return [flat.size, int(flat.size - present.size), *map(_rounded, told)]


def _settings(attrs: Mapping[str, Any]) -> dict[str, Any]:
    return {
        str(name): _setting(value)
        for name, value in sorted(attrs.items(), key=lambda item: str(item[0]))
        if name not in _ASIDE
    }


def _setting(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _setting(part) for name, part in value.items()}
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | float | np.number):
        return _rounded(float(value))
    if isinstance(value, list | tuple | np.ndarray):
        return [_setting(part) for part in value]
    return str(value)[:_LONGEST]


def _rounded(value: float) -> float | str:
    """Return a number to 12 digits: three more than are compared."""
    number = float(f"{value:.12g}")
    return number if np.isfinite(number) else str(number)
