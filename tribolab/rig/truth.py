"""True values of a simulated campaign, stored with its raw files; the analysis ignores them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from tribolab.core.errors import ReadError
from tribolab.core.untyped import Json


@dataclass(frozen=True)
class Truth:
    """True values of a simulated campaign.

    Parameters
    ----------
    facts
        Content of ``truth.json``: seed, the rig's parameters, surfaces; law, offsets and clocks of
        each run under ``facts["runs"][name]``; the faults of each scan, with check and severity,
        under ``facts["scans"][file name]``.
    segments
        True values of the segments of each run, by name of the run.

    Examples
    --------
    >>> import tempfile
    >>> from tribolab import rig
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = rig.simulate_campaign(Path(folder) / "demo", small=True, surfaces=["Sb-R"])
    ...     truth = read_truth(file.parent)
    >>> sorted(truth.segments) == sorted(truth.facts["runs"]), len(truth.segments)
    (True, 4)
    """

    facts: Json
    segments: dict[str, pd.DataFrame]


def read_truth(folder: str | Path) -> Truth:
    """Return the true values of the simulated campaign in a folder.

    Parameters
    ----------
    folder
        The campaign's folder (with ``campaign.toml``).

    Raises
    ------
    ReadError
        If the folder contains no truth.

    Examples
    --------
    >>> import tempfile
    >>> from tribolab import rig
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = rig.simulate_campaign(Path(folder) / "demo", small=True, surfaces=["Sb-R"])
    ...     truth = read_truth(file.parent)
    >>> truth.segments["sb-r_dry_31N_01"].friction_coefficient.abs().round(3).tolist()[:2]
    [1.112, 1.112]
    """
    path = Path(folder) / "truth"
    if not (path / "truth.json").is_file():
        raise ReadError(
            f"{path / 'truth.json'} does not exist; only simulated campaigns have a truth"
        )
    facts = json.loads((path / "truth.json").read_text(encoding="utf-8"))
    segments = {
        name: pd.read_csv(path / f"{name}.csv", keep_default_na=False, na_values=[""])
        for name in facts["runs"]
    }
    return Truth(facts, segments)
