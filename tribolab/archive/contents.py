"""Files of an archive: results, settings and raw files, each with a description."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.files import inputs_of
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.store.ledger import Ledger
from tribolab.core.errors import ConfigError, ReadError
from tribolab.core.provenance import as_text, sha256_of_file
from tribolab.core.untyped import Json
from tribolab.reading.dialect.zero_reading import parse_zero
from tribolab.report.campaign_tables import TABLES

_RESULTS = "published"  # not inside the results folder of `tribolab run`, which every run replaces
_OWN = ("catalogue.sqlite",)  # files for the next run only
_KINDS = {
    ".html": "text/html",
    ".json": "application/json",
    ".csv": "text/csv",
    ".parquet": "application/vnd.apache.parquet",
    ".nc": "application/x-netcdf",
    ".svg": "image/svg+xml",
    ".pdf": "application/pdf",
    ".toml": "application/toml",
    ".txt": "text/plain",
}


@dataclass(frozen=True)
class Item:
    """File of the archive: source path, name in the archive, description, media type."""

    source: Path
    name: str
    description: str
    kind: str


def campaign_of(results: Path, report: Json, stated: Path | None = None) -> Campaign:
    """Return the campaign that a results folder belongs to.

    Raises
    ------
    ConfigError
        If the campaign file is not next to the results, or has changed since.
    """
    file = report["campaign"]["file"]
    places = [stated] if stated else [results.parent / file, results / file]
    there = next((place for place in places if place.is_file()), None)
    if there is None:
        raise ConfigError(
            f"{results}: the campaign file {file} is not next to the results; say --campaign"
        )
    if sha256_of_file(there) != report["campaign"]["sha256"]:
        raise ConfigError(
            f"{there}: changed since these results were made; run 'tribolab run' once more"
        )
    return load_campaign(there)


def items_of(results: Path, campaign: Campaign, *, raw: bool) -> list[Item]:
    """Return the files of an archive.

    Parameters
    ----------
    results
        The results folder.
    campaign
        Campaign of the results.
    raw
        Whether to include raw files; else only their checksums, in the table of sources.

    Raises
    ------
    ReadError
        If a file of the results was changed.
    ConfigError
        If the paths in the campaign file would not work on another computer.
    """
    inputs = [(path, words) for path, words in inputs_of(campaign) if path.is_file()]
    if not raw:
        inputs = [pair for pair in inputs if pair[1] not in ("a raw file", "a scan")]
    elif Path(campaign.campaign.raw).is_absolute():
        raise ConfigError(
            f"{campaign.file}: campaign.raw is {campaign.campaign.raw}, which is nowhere else; "
            "name the folder relative to the campaign file"
        )
    else:
        zeros = [parse_zero(entry.zero).file for entry in campaign.run if entry.zero]
        blanks = [campaign.raw / name for name in filter(None, zeros)]
        inputs += [(blank, "a raw file") for blank in blanks if blank.is_file()]
    home = campaign.file.resolve().parent
    paths = [path.resolve() for path, _ in inputs]
    root = Path(os.path.commonpath([home, *(path.parent for path in paths)]))
    items = [
        Item(path, as_text(path.relative_to(root)), words.capitalize(), _kind(path))
        for path, (_, words) in zip(paths, inputs, strict=True)
    ]
    below = (home.relative_to(root) / _RESULTS).as_posix()
    return list({item.name: item for item in [*items, *_of_results(results, below)]}.values())


def _of_results(results: Path, below: str) -> list[Item]:
    ledger = Ledger.read(results)
    wrong = ledger.problems()
    if wrong:
        more = f" (and {len(wrong) - 1} more)" if len(wrong) > 1 else ""
        raise ReadError(f"{results}: {wrong[0]}{more}")
    items = []
    for name in sorted(ledger.files):
        path = results / name
        if path.name in _OWN or path.is_dir():
            continue
        items.append(Item(path, f"{below}/{name}", _described(name), _kind(path)))
    return items


def _kind(path: Path) -> str:
    return _KINDS.get(path.suffix.lower(), "application/octet-stream")


def _described(name: str) -> str:
    path = Path(name)
    if path.parts[0] == "tables":
        return f"Table: {TABLES.get(path.stem, path.stem.replace('_', ' '))}"
    if path.parts[0] == "data":
        return f"Data of {path.stem.replace('_', ' ')}, with units and origin"
    if path.parts[0] == "figures":
        return f"Figure {path.stem.replace('_', ' ')}"
    return {
        "report.html": "Report to read: what was measured, checks of every run, errors",
        "report.json": "The same numbers for programs",
    }.get(name, path.stem)
