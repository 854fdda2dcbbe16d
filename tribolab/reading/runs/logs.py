"""Grouping of files into runs: two logs if the instrument writes two, else one."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tribolab.core.aliases import PathLike
from tribolab.core.provenance import as_text
from tribolab.reading.dialect.find import Dialect, Instrument, every_dialect, load_dialect


def group_files(
    paths: Iterable[PathLike], instrument: Instrument | None = None
) -> list[list[Path]]:
    """Group the files of each run: two logs if the instrument writes two, else one.

    Parameters
    ----------
    paths
        Raw files, in any order.
    instrument
        The instrument; by default the naming rules of all known instruments are tried.

    Returns
    -------
    list of list of Path
        One list for each run, in the order of their first file; the main log comes first. A file
        without its companion is a run of its own.

    Examples
    --------
    >>> files = ["a_31N_01_force.csv", "a_31N_01_motion.csv", "b.csv"]
    >>> [[path.name for path in group] for group in group_files(files)]
    [['a_31N_01_force.csv', 'a_31N_01_motion.csv'], ['b.csv']]
    """
    every = [load_dialect(instrument)] if instrument else every_dialect()
    rules = [dialect for dialect in every if dialect.pair is not None]
    files = list(dict.fromkeys(Path(path) for path in paths))
    present = set(files)
    partner: dict[Path, Path] = {}
    for file in files:
        for dialect in rules:
            other = companion_path(file, dialect)
            if other in present:
                partner[file] = other
    taken = set(partner.values())
    groups = {file: [file, partner[file]] if file in partner else [file] for file in files}
    first = {companion: main for main, companion in partner.items()}
    order = dict.fromkeys(first.get(file, file) for file in files)
    return [groups[file] for file in order if file not in taken]


def companion_path(path: Path, dialect: Dialect) -> Path | None:
    """Return the expected path of a file's second log; None if the name is not a main log's."""
    rule = dialect.pair
    if rule is None or not path.stem.endswith(rule.own):
        return None
    return path.with_name(path.stem.removesuffix(rule.own) + rule.other + path.suffix)


def companion_name(path: Path, dialect: Dialect) -> str:
    """Return the expected name of a file's second log; "" if the instrument writes one log only."""
    if dialect.pair is None:
        return ""
    other = companion_path(path, dialect)
    return as_text(other.name) if other else f"*{dialect.pair.other}.*"
