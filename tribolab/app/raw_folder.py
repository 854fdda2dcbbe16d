"""Search for raw files in a folder, and sorting into runs, scans, moduli and tester results."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from tribolab.campaign.store.ledger import Ledger
from tribolab.reading.folder_content import contents_of, may_hold_data

_MAX_FILES = 5000  # most files of a campaign, so that a whole disk is not searched


class RawFiles(NamedTuple):
    """Raw files, sorted by content; `results` are those of roughness testers."""

    runs: list[Path]
    scans: list[Path]
    moduli: list[Path]
    results: list[Path]


def files_in(folder: Path) -> list[Path]:
    """Return the files of a folder and its subfolders that may contain data, sorted by name.

    Hidden files, results of `tribolab run`, and files without measurements are left out.
    """
    found: list[Path] = []
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or len(found) >= _MAX_FILES:
            continue
        if path.is_dir():
            found += [] if is_results_folder(path) else files_in(path)
        elif path.is_file() and may_hold_data(path):
            found.append(path)
    return found


def is_results_folder(path: Path) -> bool:
    """Whether a folder contains results of `tribolab run`."""
    return (path / "report.json").is_file() or bool(Ledger.read(path).files)


def sorted_by_content(
    groups: Sequence[Sequence[Path]], instrument: str | None = None
) -> tuple[list[list[Path]], RawFiles]:
    """Return the logs of each run, and all files sorted into runs, scans, moduli and results.

    Parameters
    ----------
    groups
        Groups of files; each group is one run if its files are logs.
    instrument
        Instrument of the raw files: a name, or the file of a dialect.
    """
    kinds = RawFiles([], [], [], [])
    runs: list[list[Path]] = []
    alone = contents_of((group[0] for group in groups if len(group) == 1), instrument)
    for group in groups:
        kind = "run" if len(group) > 1 else alone[group[0]]
        if kind == "run":
            runs.append(list(group))
            kinds.runs.extend(group)
        else:
            {"scan": kinds.scans, "modulus": kinds.moduli, "results": kinds.results}[kind].append(
                group[0]
            )
    return runs, kinds


def as_pattern(files: Sequence[Path], others: Iterable[Path], raw: Path) -> list[str]:
    """Return patterns that match exactly these files, relative to a folder.

    Examples
    --------
    >>> raw = Path("a")
    >>> as_pattern([raw / "x_1.csv", raw / "x_2.csv"], [raw / "y.csv"], raw)
    ['x_*.csv']
    >>> as_pattern([raw / "x_1.csv", raw / "z.csv"], [raw / "y.csv"], raw)
    ['x_1.csv', 'z.csv']
    """
    wanted, patterns = set(files), list[str]()
    everything = wanted | set(others)
    for name in ("*", *sorted({f"{file.stem.rstrip('0123456789')}*" for file in files})):
        for suffix in sorted({file.suffix for file in files}):
            for parent in sorted({file.parent for file in files}):
                where = parent.relative_to(raw).as_posix()
                pattern = f"{name}{suffix}" if where == "." else f"{where}/{name}{suffix}"
                own = {f for f in everything if f.parent == parent and f.match(f"{name}{suffix}")}
                if len(own & wanted) > 1 and own <= set(files) and not own.isdisjoint(wanted):
                    patterns.append(pattern)
                    wanted -= own
    return patterns + [file.relative_to(raw).as_posix() for file in files if file in wanted]
