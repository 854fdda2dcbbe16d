"""Files named in a campaign file: the files that match patterns, and their labels in reports."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from tribolab.campaign.settings.problems import SettingsProblem
from tribolab.campaign.settings.review import REVIEW_FILE
from tribolab.core.errors import nearest, shown
from tribolab.core.provenance import as_text, sha256_of_file
from tribolab.reading.dialect.zero_reading import parse_zero

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign
    from tribolab.campaign.settings.measured import Surface

_OWN = (".toml", ".py")  # files that describe or read an instrument


def scan_files(campaign: Campaign) -> list[Path]:
    """Return the topography scans of all surfaces."""
    return [path for surface in campaign.surface for path in scans_of(campaign, surface)]


def modulus_files(campaign: Campaign) -> list[Path]:
    """Return the modulus files named in the contact tables, each once."""
    named = (contact.modulus_file for contact in campaign.contact.by_name.values())
    return [campaign.raw / name for name in dict.fromkeys(named) if name is not None]


def flow_curve_files(campaign: Campaign) -> list[Path]:
    """Return the flow-curve files named in the medium tables, each once."""
    named = (medium.flow_curve for medium in campaign.medium.values())
    return [campaign.raw / name for name in dict.fromkeys(named) if name is not None]


def scans_of(campaign: Campaign, surface: Surface) -> list[Path]:
    """Return the topography scans of one surface, each once."""
    named = (
        path for pattern in surface.scans or () for path in matching_files(campaign.raw, pattern)
    )
    return list(dict.fromkeys(named))


def inputs_of(campaign: Campaign) -> list[tuple[Path, str]]:
    """Return every file that a campaign reads, with its kind in words."""
    inputs = [(campaign.file, "the campaign file")]
    inputs.append((campaign.file.parent / REVIEW_FILE, "the review file"))
    for entry in campaign.run:
        inputs += [(f, "a raw file") for p in entry.files for f in matching_files(campaign.raw, p)]
    inputs += [(file, "a scan") for file in scan_files(campaign)]
    inputs += [(file, "the modulus file") for file in modulus_files(campaign)]
    inputs += [(file, "a flow curve") for file in flow_curve_files(campaign)]
    for instrument in _instruments(campaign):
        if instrument.endswith(_OWN):
            words = "a reader in Python" if instrument.endswith(".py") else "a dialect"
            inputs.append((Path(instrument_of(campaign, instrument)), words))
    return inputs


def inputs_outside(campaign: Campaign) -> list[Path]:
    """Return the files that a campaign reads outside its own folder and its raw folder.

    Links are followed. Publishing the results of someone else's campaign exposes these files.
    """
    homes = [campaign.file.resolve().parent, campaign.raw.resolve()]
    named = [path for path, _ in inputs_of(campaign)]
    for entry in campaign.run:
        if entry.zero and (blank := parse_zero(entry.zero).file):
            runs = [file for p in entry.files for file in matching_files(campaign.raw, p)]
            named += [run.parent / blank for run in runs]
    files = dict.fromkeys(path.resolve() for path in named if path.is_file())
    return [file for file in files if not any(file.is_relative_to(home) for home in homes)]


def instrument_of(campaign: Campaign, name: str) -> str:
    """Return the name of an instrument; a file gets its path relative to the campaign file."""
    return str(campaign.file.parent / name) if name.endswith(_OWN) else name


def own_python(campaign: Campaign) -> list[str]:
    """Return the Python files that a campaign names as readers."""
    return [name for name in _instruments(campaign) if name.endswith(".py")]


def _instruments(campaign: Campaign) -> list[str]:
    """Return the instruments that a campaign names, each once."""
    named = [entry.instrument for entry in campaign.run]
    named += [surface.instrument for surface in campaign.surface]
    return list(dict.fromkeys(name for name in named if name))


def resolve_patterns(
    raw: Path,
    patterns: Iterable[str],
    where: tuple[str | int, ...],
    problems: list[SettingsProblem],
) -> list[Path]:
    """Return the files that match patterns, each once; a pattern without files adds a problem."""
    files: dict[Path, None] = {}
    for pattern in patterns:
        matching = matching_files(raw, pattern)
        if not matching:
            problems.append(
                SettingsProblem(
                    where, f"nothing matches '{shown(pattern)}' in {raw}{_there(raw, pattern)}"
                )
            )
        files.update(dict.fromkeys(matching))
    return list(files)


def matching_files(raw: Path, pattern: str) -> list[Path]:
    """Return the files in the raw folder that match a pattern, in natural order."""
    exact = raw / pattern
    try:
        if exact.is_file():  # brackets in the name of an existing file are not wildcards
            return [exact]
        files = [path for path in raw.glob(pattern) if path.is_file()]
    except (OSError, ValueError, NotImplementedError):  # absolute, empty, or too long a name
        return []
    return sorted(files, key=lambda path: _natural(str(path)))


def _natural(text: str) -> list[tuple[bool, int, str]]:
    """Return a sort key that puts cycle 2 before cycle 10."""
    return [
        (part.isdigit(), int(part) if part.isdigit() else 0, part)
        for part in re.split(r"(\d+)", text)
    ]


def _there(raw: Path, pattern: str) -> str:
    """Return a hint on why a pattern matches nothing, e.g. the files in the folder."""
    parts = Path(pattern).parts
    if _is_special(raw / pattern):
        return "; it is no regular file (a pipe, socket or device): write its content to a file"
    if len(parts) > 1 and parts[0] == raw.name and not _is_folder(raw / parts[0]):
        return f"; patterns are relative to {raw.name}/: leave '{raw.name}/' out"
    folder = raw
    for part in Path(pattern).parts[:-1]:
        if not _is_folder(folder / part):
            break
        folder /= part
    names = sorted(f"{p.name}/" if p.is_dir() else p.name for p in folder.iterdir())
    if not names:
        return f"; {folder} is empty"
    hint = nearest(Path(pattern).name, names)
    listed = ", ".join(map(shown, names[:5])) + (
        f", ... ({len(names)} in all)" if len(names) > 5 else ""
    )
    in_folder = "" if folder == raw else f" in {folder.relative_to(raw)}/"
    return f"; there is{in_folder} {listed}" + (hint if "did you mean" in hint else "")


def _is_special(path: Path) -> bool:
    try:
        return path.exists() and not path.is_dir()
    except (OSError, ValueError):
        return False


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):  # not a possible name of a folder
        return False


def sha256_of_dialect(instrument: str) -> str:
    """Return the checksum of the dialect or reader of an instrument."""
    # imported late for a quick start
    from tribolab.reading.dialect.find import known_dialects
    from tribolab.reading.raw.readers import is_reader, source_of

    known = known_dialects()
    own = source_of(instrument) if instrument not in known and is_reader(instrument) else instrument
    return sha256_of_file(known.get(instrument, own))


def label_of(campaign: Campaign, file: Path) -> str:
    """Return the path of a file relative to the campaign file, as reports show it."""
    return as_text(Path(os.path.relpath(file, campaign.file.parent)).as_posix())
