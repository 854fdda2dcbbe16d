"""What is true of a simulated campaign: kept beside the raw files, never read by the analysis."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from tribolab.core.errors import ReadError
from tribolab.core.untyped import Json


@dataclass(frozen=True)
class Truth:
    """The truth of a campaign.

    Parameters
    ----------
    facts
        What stands in ``truth.json``: seed, the rig's parameters, surfaces, and for each run its
        law, offsets and clocks under ``facts["runs"][name]``; for each scan with faults those, the
        check that has to find them and how grave they are under ``facts["scans"][file name]``.
    segments
        For each run's name the table of its constant-speed segments.

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
    """Read the truth of a simulated campaign.

    Parameters
    ----------
    folder
        The campaign's folder (the one that holds ``campaign.toml``).

    Raises
    ------
    ReadError
        If there is no truth in the folder.

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
