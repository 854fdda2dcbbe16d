"""No stroke of a triangular motion is lost when its speed is taken from the position."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import tribolab as tl

SWEEP = runpy.run_path(str(Path(__file__).parents[1] / "detection" / "stroke_patterns.py"))


@pytest.mark.parametrize("seed", [10012, 10019, 10026, 10048, 10054, 10073, 10115, 10143, 10458])
def test_strokes_of_few_blocks_with_dwells_are_all_found(seed: int) -> None:
    found = SWEEP["outcome_of"](SWEEP["pattern_of"](seed))
    assert (found.lost, found.extra) == (0, 0)
    assert found.mu == pytest.approx(SWEEP["MU"], rel=0.01)


def test_forward_strokes_in_whole_micrometres_are_not_taken_for_rest(shared_data: Path) -> None:
    run = tl.read(shared_data / "cases" / "strokes_taken_for_rest.csv")
    found = tl.find_segments(run)
    assert sorted(found["direction"].values) == [-1] * 12 + [1] * 12
    assert found["sliding_speed"].values == pytest.approx(5.5e-3, rel=0.01)
    mu = tl.friction_coefficient(run, found)["friction_coefficient"].values
    assert mu == pytest.approx(0.140, abs=0.001)


def test_strokes_that_have_no_segment_are_reported() -> None:
    run, _, _ = SWEEP["motion"](SWEEP["pattern_of"](10019))
    sound = tl.find_segments(run)
    # as if every fourth stroke were not found
    lost = np.arange(sound.sizes["segment"]) % 4 == 1
    own = [name for name in sound if sound[name].dims == ("segment",)]
    left = xr.Dataset({name: ("segment", sound[name].values[~lost]) for name in own})
    for end in ("start", "stop"):
        both = np.concatenate([sound[f"omitted_{end}"].values, sound[end].values[lost]])
        left[f"omitted_{end}"] = ("omitted", both)
    reasons = [*sound["omitted_reason"].values, *["ramp"] * int(lost.sum())]
    left["omitted_reason"] = ("omitted", np.array(reasons, dtype=object))
    left.attrs = sound.attrs
    statuses = []
    for segments in (sound, left):
        results = [r for rule, r in tl.check(run, segments).results if rule.name == "segments"]
        statuses.append(results[0].status)
    assert statuses == ["pass", "suspect"]
