"""Verification that results are unchanged, and reproducible from the raw files."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

from tribolab.app.run import run_campaign
from tribolab.archive.contents import campaign_of
from tribolab.archive.packing import problems_of
from tribolab.campaign.engine.stage import Progress
from tribolab.campaign.store.catalogue import CATALOGUE
from tribolab.campaign.store.data_files import digest
from tribolab.campaign.store.ledger import Ledger, repair
from tribolab.comparison.folder import open_folder
from tribolab.core.errors import ConfigError, OutputError, ReadError, brief
from tribolab.reading.netcdf.netcdf import read_groups
from tribolab.version import __version__

# entries of report.json that differ between equal analyses, e.g. date and duration
_PASSING = frozenset({"made_at", "versions", "seconds", "history", "reused"})
# lists of figure files: not compared, because a verification draws no figures
_DRAWN = frozenset({"figures", "surface_figures", "model_figures", "sliding_figures"})


def problems(results: Path) -> list[str]:
    """Return the changed or missing files of a results folder or archive."""
    if results.is_file():
        return problems_of(results)
    if not results.is_dir():
        raise ReadError(f"{results}: no such results folder or packed file")
    return Ledger.read(results).problems()


def mend(results: Path) -> None:
    """Write the lost .tribolab-results file of a results folder again.

    Raises
    ------
    ConfigError
        If it is not a results folder, or the file is not lost.
    """
    if not (results / CATALOGUE).is_file():
        raise ConfigError(f"{results}: not a results folder: it has no {CATALOGUE}")
    if Ledger.read(results).files:
        raise ConfigError(
            f"{results}: .tribolab-results exists; 'tribolab run' computes damaged results again"
        )
    try:
        repair(results)
    except OSError as error:
        raise OutputError(f"{results}: cannot be written ({brief(error)})") from error


def recomputed(
    results: Path,
    campaign: Path | None = None,
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
    trust: bool = False,
) -> list[str]:
    """Compute results again from the raw files, and return the files and places that differ.

    Parameters
    ----------
    results
        The results folder.
    campaign
        The campaign file, if it is not next to the results.
    jobs, progress, trust
        As in `run_campaign`.

    Raises
    ------
    ReadError
        If the report cannot be read.
    ConfigError
        If the campaign file is missing or has changed, or if another version made the results.
    """
    folder = open_folder(results)
    version = folder.report["versions"].get("tribolab", "")
    if version != __version__:
        raise ConfigError(
            f"{results}: made by tribolab {version}, this is {__version__}; versions may differ "
            "in their numbers, so recompute with the same version"
        )
    known = campaign_of(folder.path, folder.report, campaign)
    with tempfile.TemporaryDirectory() as temporary:
        again = Path(temporary) / "results"
        run_campaign(known, output=again, jobs=jobs, progress=progress, figures="none", trust=trust)
        wrong = []
        for kind in ("tables/*.csv", "tables/*.parquet", "data/*.nc", "report.json"):
            paths = {p.relative_to(place) for place in (results, again) for p in place.glob(kind)}
            for path in sorted(paths):
                name = path.as_posix()
                if ".changed-" not in name:
                    wrong += _differing(results / path, again / path, name)
    return wrong


def _differing(there: Path, made: Path, name: str) -> list[str]:
    if not (there.is_file() and made.is_file()):
        return [f"{name}: {'missing' if made.is_file() else 'the raw files give no such file'}"]
    try:
        if there.suffix == ".json":
            pair = [json.loads(path.read_text("utf-8")) for path in (there, made)]
            at = next(_differing_entries(pair[0], pair[1]), "")
        elif there.suffix == ".csv":
            lines = [path.read_text("utf-8").splitlines() for path in (there, made)]
            rows = enumerate(zip_longest(*lines), 1)
            at = next((f"line {number}" for number, (a, b) in rows if a != b), "")
        elif there.suffix == ".nc":
            at = _unlike_data(there, made)
        else:
            at = "" if there.read_bytes() == made.read_bytes() else "its numbers"
    except (OSError, ValueError, LookupError, ReadError) as error:
        return [f"{name}: cannot be read ({brief(error)})"]
    return [f"{name}: differs from the recomputed values, first at {at}"] if at else []


def _differing_entries(one: object, other: object, at: str = "") -> Iterator[str]:
    """Yield the path of each entry of report.json in which two analyses differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in sorted({*one, *other} - _PASSING - _DRAWN):
            yield from _differing_entries(
                one.get(key), other.get(key), f"{at}.{key}" if at else key
            )
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for place, pair in enumerate(zip(one, other, strict=True)):
            yield from _differing_entries(*pair, f"{at}[{place}]")
    elif one != other and not (one != one and other != other):
        yield at


def _unlike_data(there: Path, made: Path) -> str:
    one, other = (read_groups(path) for path in (there, made))
    if set(one) != set(other):
        return "its groups"
    unlike = (group for group in one if digest(one[group]) != digest(other[group]))
    return next((f"group {group or '/'}" for group in unlike), "")
