"""Provenance of a result: checksums, versions and a history line."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

CONVENTIONS = "CF-1.11"


def sha256_of_file(path: str | Path) -> str:
    """Return the SHA-256 of a file's bytes as hex text."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sha256_of(value: Any) -> str:
    """Return the SHA-256 of a JSON value, independent of the order of its keys."""
    text = json.dumps(value, sort_keys=True, default=str, ensure_ascii=False)
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()


# control characters (C0, C1), line and paragraph separators, overrides of text direction
_STEERS = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")


def as_text(path: str | Path) -> str:
    r"""Return a path or name as text without characters that control a terminal or a page.

    Bytes that are not UTF-8, control characters and direction overrides are escaped.

    Examples
    --------
    >>> as_text("raw/\x1b[31mred\n.csv")
    'raw/\\x1b[31mred\\n.csv'
    >>> as_text("raw/Öl.csv"), as_text(os.fsdecode(b"raw/\xd6l.csv"))
    ('raw/Öl.csv', 'raw/\\xd6l.csv')
    """
    text = os.fsencode(path).decode("utf-8", "backslashreplace")
    return _STEERS.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def escape_controls(text: str) -> str:
    r"""Return a text with its control characters escaped, except tabs and line ends.

    Examples
    --------
    >>> escape_controls("\x1b[31mred\n")
    '\\x1b[31mred\n'
    """
    return _STEERS.sub(lambda found: found[0] if found[0] in "\t\n\r" else as_text(found[0]), text)


def history_line(action: str) -> str:
    """Return a line for the ``history`` attribute: UTC time, version, action."""
    # imported late: the import looks up the installed package
    from tribolab.version import __version__

    now = dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return f"{now} tribolab {__version__}: {action}"


def made(
    action: str,
    *,
    source: str = "",
    source_sha256: str = "",
    config_sha256: str = "",
) -> dict[str, str]:
    """Return the attributes that state how a result was made.

    Parameters
    ----------
    action
        Action in a few words, for the history line.
    source, source_sha256
        Names of the raw files and their checksums, each joined by ``"; "``. Products of published
        constants have a citation as source, without a checksum.
    config_sha256
        Checksum of the settings that affect the product.

    Examples
    --------
    >>> sorted(made("contact of the reference system", source="Xu et al. (2026)"))
    ['Conventions', 'history', 'source', 'tribolab_version']
    """
    # imported late: the import looks up the installed package
    from tribolab.version import __version__

    attrs = {
        "source": source,
        "source_sha256": source_sha256,
        "tribolab_version": __version__,
        "config_sha256": config_sha256,
        "history": history_line(action),
        "Conventions": CONVENTIONS,
    }
    return {name: value for name, value in attrs.items() if value}


def join_sources(products: Iterable[Mapping[Any, Any]]) -> dict[str, str]:
    """Return ``source`` and ``source_sha256`` of a result made from several others.

    Checksums are left out if one of the products has none, to keep names and checksums paired.

    Parameters
    ----------
    products
        Attributes of each of these results.

    Examples
    --------
    >>> join_sources([{"source": "a.csv", "source_sha256": "1f"}, {"source": "b.csv"}])
    {'source': 'a.csv; b.csv'}
    """
    pairs = dict.fromkeys(
        (str(attrs.get("source", "")), str(attrs.get("source_sha256", ""))) for attrs in products
    )
    columns = zip(*pairs, strict=True)
    return {
        name: "; ".join(values)
        for name, values in zip(("source", "source_sha256"), columns, strict=False)
        if all(values)
    }


def provenance(sources: Iterable[str | Path], action: str) -> dict[str, str]:
    """Return the provenance attributes of a result made from raw files.

    Parameters
    ----------
    sources
        The raw files that the product was made from.
    action
        Action in a few words, for the history line.

    Returns
    -------
    dict
        ``source``, ``source_sha256``, ``tribolab_version``, ``history`` and ``Conventions``;
        several sources are joined by ``"; "``.
    """
    paths = [Path(source) for source in sources]
    return made(
        action,
        source="; ".join(as_text(path.name) for path in paths),
        source_sha256="; ".join(sha256_of_file(path) for path in paths),
    )


def source_attributes(sources: Iterable[tuple[str, str, int]]) -> dict[str, str]:
    """Return ``source`` and ``source_sha256`` from the names, checksums and sizes of files."""
    labels, sums = [], []
    for label, checksum, _ in sources:
        labels.append(label)
        sums.append(checksum)
    return {"source": "; ".join(labels), "source_sha256": "; ".join(sums)}
