"""Archive of a campaign in one file, from which others can repeat the analysis."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
import zipfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

from tribolab.archive.contents import Item, campaign_of, items_of
from tribolab.archive.crate import (
    METADATA,
    PACKAGE,
    CrateFacts,
    People,
    crate_metadata,
    data_package,
)
from tribolab.campaign.settings.naming.run_names import safe_name
from tribolab.comparison.folder import open_folder
from tribolab.core.errors import OutputError, ReadError, brief
from tribolab.core.untyped import Json
from tribolab.reading.raw.opening import largest_unpacked
from tribolab.reading.raw.unpacked import ZIP_DAMAGE
from tribolab.report import tables
from tribolab.report.results_folder import Results

_BLOCK = 1 << 20


def pack(
    results: str | Path | Results,
    output: str | Path | None = None,
    *,
    raw: bool = False,
    campaign: str | Path | None = None,
    author: str = "",
    publisher: str = "",
    licence: str = "",
) -> Path:
    """Pack results with their settings and raw data into one file for a data repository.

    Parameters
    ----------
    results
        The results folder.
    output
        The ``.zip`` file; by default named after the campaign, next to the results.
    raw
        Whether to include raw files; else the table of sources has their checksums.
    campaign
        The campaign file, if it is not next to the results.
    author, publisher, licence
        Author, publisher and licence (its SPDX name, e.g. ``CC-BY-4.0``, or its URL).

    Returns
    -------
    pathlib.Path
        The file: an RO-Crate 1.2 with ``ro-crate-metadata.json`` and, for its tables,
        ``datapackage.json``. It is verified before it gets its final name. With `raw`,
        ``tribolab run`` in the unpacked folder repeats the analysis.

    Raises
    ------
    ReadError
        If a file of the results was changed.
    ConfigError
        If the campaign file is missing, or has changed since.
    OutputError
        If the file cannot be written.

    Examples
    --------
    >>> import tribolab as tl
    >>> try:
    ...     tl.archive.pack("nothing")
    ... except tl.TribolabError as error:
    ...     print(str(error)[:30])
    nothing: no folder of results:
    """
    folder = open_folder(results.folder if isinstance(results, Results) else results)
    known = campaign_of(folder.path, folder.report, Path(campaign) if campaign else None)
    items = items_of(folder.path, known, raw=raw)
    target = Path(output) if output else folder.path.parent / f"{safe_name(folder.title)}.zip"
    draft = target.with_name(f".{target.name}.part")
    people = People(author, publisher, licence)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED) as archive:
            facts = {item.name: _add(archive, item) for item in items}
            listed = {
                item.name: tables.read_csv(item.source)
                for item in items
                if "/tables/" in item.name and item.name.endswith(".csv")
            }
            package = _add_text(archive, PACKAGE, data_package(folder.report, listed, facts))
            described = Item(Path(), PACKAGE, "What is in the tables", "application/json")
            crate = crate_metadata(
                folder.report, known, [*items, described], facts | {PACKAGE: package}, people
            )
            _add_text(archive, METADATA, crate)
        wrong = problems_of(draft)
        if wrong:
            raise OutputError(f"{target}: not written, as it would be wrong: {wrong[0]}")
        draft.replace(target)
    except OSError as error:
        raise OutputError(f"{target}: cannot be written ({brief(error)})") from error
    finally:
        draft.unlink(missing_ok=True)
    return target


def problems_of(path: str | Path) -> list[str]:
    """Return the problems of an archive: missing, changed or undescribed files.

    Raises
    ------
    ReadError
        If it is not such an archive.
    """
    path = Path(path)
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(info.file_size for info in archive.infolist())  # bytes after unpacking
            if size > largest_unpacked(path.stat().st_size):
                raise ReadError(
                    f"{path}: it unpacks to {size / 1e6:.0f} MB, more than "
                    "results can hold; unpack it yourself if you trust where it is from"
                )
            names = [info.filename for info in archive.infolist() if not info.is_dir()]
            if METADATA not in names:
                raise ReadError(f"{path}: nothing was packed here: it has no {METADATA}")
            graph = json.loads(archive.read(METADATA))["@graph"]
            files = {unquote(part["@id"]): part for part in graph if part.get("@type") == "File"}
            wrong = [f"{name} is missing" for name in files if name not in names]
            wrong += [
                f"{name} is not described" for name in names if name not in {*files, METADATA}
            ]
            for name in names:
                if name in files and not _is_as_described(archive, name, files[name]):
                    wrong.append(f"{name} is not as it was packed")
            return wrong + _dangling(graph)
    except (*ZIP_DAMAGE, LookupError, TypeError) as error:
        raise ReadError(f"{path}: cannot be read as a packed file ({brief(error)})") from error


def _is_as_described(archive: zipfile.ZipFile, name: str, part: Json) -> bool:
    digest, size = hashlib.sha256(), 0
    try:
        with archive.open(name) as file:
            while block := file.read(_BLOCK):
                digest.update(block)
                size += len(block)
    except ZIP_DAMAGE:  # the list of checksums is itself damaged
        return False
    return digest.hexdigest() == part["sha256"] and str(size) == part["contentSize"]


def _dangling(graph: Sequence[Json]) -> list[str]:
    """Return references to entries without a description, except external URLs."""
    known = {part["@id"] for part in graph}
    wanted: dict[str, None] = {}
    for part in graph:
        for value in part.values():
            for inner in value if isinstance(value, list) else [value]:
                if isinstance(inner, dict) and set(inner) == {"@id"}:
                    wanted[inner["@id"]] = None
    lost = [name for name in wanted if name not in known and not name.startswith("http")]
    return [f"{name} is referred to and not described" for name in lost]


def _add(archive: zipfile.ZipFile, item: Item) -> CrateFacts:
    """Add a file in its present state to an archive, and return its size and checksum."""
    digest, size = hashlib.sha256(), 0
    info = zipfile.ZipInfo.from_file(item.source, item.name, strict_timestamps=False)
    info.compress_type = zipfile.ZIP_DEFLATED
    with item.source.open("rb") as file, archive.open(info, "w") as packed:
        while block := file.read(_BLOCK):
            digest.update(block)
            size += len(block)
            packed.write(block)
    return CrateFacts(size, digest.hexdigest())


def _add_text(archive: zipfile.ZipFile, name: str, content: Json) -> CrateFacts:
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False).encode()
    now = dt.datetime.now(dt.UTC).timetuple()[:6]
    info = zipfile.ZipInfo(str(PurePosixPath(name)), now)
    info.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(info, text)
    return CrateFacts(len(text), hashlib.sha256(text).hexdigest())
