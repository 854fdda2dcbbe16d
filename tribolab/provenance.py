"""Where a result comes from: checksums, versions and one history line."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

CONVENTIONS = "CF-1.11"


def sha256_of_file(path: str | Path) -> str:
    """Return the SHA-256 of a file's bytes as hex text."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sha256_of(value: Any) -> str:
    """SHA-256 of anything that JSON can hold; the order of keys does not matter."""
    text = json.dumps(value, sort_keys=True, default=str, ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()


def history_line(action: str) -> str:
    """Return one line for the ``history`` attribute: time in UTC, version, what was done."""
    from tribolab import __version__

    now = dt.datetime.now(dt.UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return f"{now} tribolab {__version__}: {action}"


def provenance(
    sources: Iterable[str | Path], action: str, config: Mapping[str, Any] | None = None
) -> dict[str, str]:
    """Return the attributes that every product carries.

    Parameters
    ----------
    sources
        The raw files that the product was made from.
    action
        What was done, in a few words, for the history line.
    config
        The settings that shaped the product, if any.

    Returns
    -------
    dict
        ``source``, ``source_sha256``, ``tribolab_version``, ``history``, ``Conventions`` and,
        with `config`, ``config_sha256``. Several sources are joined by ``"; "``.
    """
    from tribolab import __version__

    paths = [Path(source) for source in sources]
    attrs = {
        "source": "; ".join(path.name for path in paths),
        "source_sha256": "; ".join(sha256_of_file(path) for path in paths),
        "tribolab_version": __version__,
        "history": history_line(action),
        "Conventions": CONVENTIONS,
    }
    if config is not None:
        attrs["config_sha256"] = sha256_of(config)
    return attrs
