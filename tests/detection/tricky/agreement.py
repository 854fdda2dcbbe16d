"""Do `tribolab check` and `tribolab run` say the same of one run?"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

import tribolab as tl
from tribolab.core.errors import TribolabError
from tricky.files import Column, dialect, table
from tricky.judge import Verdict, main_file, write_dialects
from tricky.trial import Trial

HEAD = '[campaign]\nname = "Other labs"\n[model]\ncompute = false\n'


class Ran(NamedTuple):
    """What a campaign says of a run: its status ("refused" if it failed) and coefficients."""

    status: str
    reason: str
    mu: tuple[float, ...]


def as_campaign(trials: Mapping[str, Trial], folder: Path) -> dict[str, Ran]:
    """Analyse some trials as one campaign; those whose drafted dialect asks are left out."""
    lines, names = [HEAD], {}
    for name, trial in trials.items():
        place = folder / "raw" / name
        place.mkdir(parents=True)
        filed = trial if not isinstance(trial.data, xr.Dataset) else as_file(trial.data, name)
        for file, text in filed.data.items():
            (place / file).write_text(text, "utf-8")
        try:
            instrument = write_dialects(filed, place)
        except TribolabError:
            continue
        lines.append(f'[[run]]\nfiles = "{name}/{main_file(filed)}"\ninstrument = "{instrument}"')
        names[f"raw/{name}/{main_file(filed)}"] = name
    (folder / "campaign.toml").write_text("\n".join(lines) + "\n", "utf-8")
    outcome = tl.run_campaign(folder / "campaign.toml", jobs=1)
    ran = {}
    for run in outcome.runs:
        name = names[run.files[0]]
        if not run.done:
            ran[name] = Ran("refused", run.reason, ())
            continue
        with xr.open_dataset(outcome.folder / run.data_file, group="friction") as friction:
            known = "friction_coefficient" in friction
            mu = friction["friction_coefficient"].values if known else np.empty(0)
        ran[name] = Ran(run.quality, "", tuple(mu.tolist()))
    return ran


def as_file(run: xr.Dataset, name: str) -> Trial:
    """Write a dataset as a table that loses no digit."""
    columns = [
        Column(str(name), str(name), run[name].attrs["units"], run[name].values, ".17g")
        for name in ("time", *run.data_vars)
    ]
    speed = "" if "sliding_velocity" in run else 'source = "position"'
    return Trial({"run.csv": table(columns)}, None, {name: dialect(name, columns, speed=speed)})


def difference(verdict: Verdict, ran: Ran) -> str:
    """Say where campaign and functions differ; "" where they agree."""
    if verdict.status != ran.status:
        return f"check says {verdict.status}, the campaign {ran.status} {ran.reason}".strip()
    if ran.status == "refused":
        return ""
    mu = np.array(verdict.mu)[np.isfinite(verdict.mu)]
    theirs = np.array(ran.mu)[np.isfinite(ran.mu)]
    if mu.size != theirs.size or not np.allclose(mu, theirs):
        return "the coefficients of campaign and functions differ"
    return ""
