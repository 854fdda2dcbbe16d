"""Names of runs and result files, made from the names of raw files."""

from __future__ import annotations

import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

_MAX_NAME = 100


def unique_names(groups: Iterable[Iterable[Path]]) -> list[str]:
    """Return a unique name for each run, from the common part of its file names.

    Examples
    --------
    >>> unique_names([[Path("a/x_1_force.csv"), Path("a/x_1_motion.csv")], [Path("b/x_1.csv")]])
    ['a_x_1', 'b_x_1']
    """
    members = [list(group) for group in groups]
    names = [safe_name(common_name(files)) for files in members]
    taken = Counter(name.casefold() for name in names)
    names = [
        safe_name(f"{files[0].parent.name}_{name}") if taken[name.casefold()] > 1 else name
        for name, files in zip(names, members, strict=True)
    ]
    return distinct(names)


def distinct(names: Iterable[str]) -> list[str]:
    """Add numbers to repeated names; upper and lower case count as equal, as on some disks.

    Examples
    --------
    >>> distinct(["a", "A", "b"])
    ['a', 'A_2', 'b']
    """
    seen: set[str] = set()
    result = []
    for name in names:
        candidate, number = name, 2
        while candidate.casefold() in seen:
            candidate, number = f"{name}_{number}", number + 1
        seen.add(candidate.casefold())
        result.append(candidate)
    return result


def common_name(files: Sequence[Path]) -> str:
    """Return the common beginning of the names of a run's files, without extensions."""
    stems = [file.stem for file in files]
    if len(stems) == 1:
        return stems[0]
    prefix = os.path.commonprefix(stems)
    if any(len(stem) > len(prefix) and stem[len(prefix)].isalnum() for stem in stems):
        prefix = re.sub(r"[^\W_]+$", "", prefix)  # not in the middle of a word or number
    return prefix.rstrip(" _-.") or stems[0]


def safe_name(name: str) -> str:
    """Return a name that is valid on any file system.

    Examples
    --------
    >>> safe_name("Sb-R, glycerol 5 µm/s")
    'Sb-R_glycerol_5_um_s'
    """
    plain = unicodedata.normalize("NFKD", name.replace("µ", "u").replace("μ", "u"))
    plain = plain.encode("ascii", "ignore").decode()
    plain = re.sub(r"[^A-Za-z0-9._-]+", "_", plain).strip("._")[:_MAX_NAME] or "run"
    # other results have names with "curve_" or "surface_"; the rest are devices on Windows
    clash = re.match(r"(?i)(curve_|surface_|(con|prn|aux|nul|com\d|lpt\d)(\.|$))", plain)
    return f"run_{plain}" if clash else plain
