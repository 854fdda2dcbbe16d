"""A small campaign whose runs repeat to 1 %, but for one that is 16 % off: is the pair named?"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import tribolab as tl
from tricky.agreement import HEAD, as_file
from tricky.contact import Law
from tricky.judge import Verdict
from tricky.lab import draw_lab, record
from tricky.motion import rest, strokes

CONDITIONS, REPEATABILITY = 9, 0.01
CAMPAIGNS = {"contradicting_repeats": 0.16, "sound_repeats": 0.0}  # by how much one run is off


def write_campaign(rng: np.random.Generator, folder: Path, off: float) -> tuple[Path, set[str]]:
    """Write two runs at each of nine loads, one of them `off`; return the pair that it spoils."""
    (folder / "raw").mkdir()
    lines, odd = [HEAD + '[[surface]]\nname = "S"\n[medium.oil]\n'], int(rng.integers(CONDITIONS))
    for number, load in enumerate(np.geomspace(5.0, 60.0, CONDITIONS)):
        lab = draw_lab(rng, load=(load, load), speed=(2e-3, 2e-3), mu=(0.2, 0.6), noises=("white",))
        for repeat in range(2):
            level = lab.mu * (1 + REPEATABILITY * rng.standard_normal())
            if number == odd and repeat == 1:
                level *= 1 + off * float(rng.choice([-1, 1]))
            legs = [rest(3.0), *strokes([lab.speed] * 3, 8.0, 0.5), rest(3.0)]
            law = Law(mu=level, at=lab.speed, build_up=0.02 * lab.speed)
            filed = as_file(record(rng, lab, legs, law, rate=20.0).dataset(), "repeats")
            [text], [toml] = filed.data.values(), filed.dialects.values()
            (folder / "raw" / f"c{number}_{repeat}.csv").write_text(text, "utf-8")
            (folder / "repeats.toml").write_text(toml, "utf-8")
        lines.append(
            f'[[run]]\nfiles = "c{number}_*.csv"\ninstrument = "repeats.toml"\n'
            f'surface = "S"\nmedium = "oil"\nnormal_force = "{load:.4g} N"'
        )
    (folder / "campaign.toml").write_text("\n".join(lines) + "\n", "utf-8")
    return folder / "campaign.toml", {f"raw/c{odd}_{repeat}.csv" for repeat in range(2)}


def judge_repeats(seed: int, folder: Path, off: float) -> Verdict:
    """Run such a campaign: a run that is off has to make its pair suspect, and no other."""
    file, pair = write_campaign(np.random.default_rng([seed, 16]), folder, off)
    outcome = tl.run_campaign(file, jobs=1, figures="none")
    doubted = {run.files[0] for run in outcome.runs if run.quality not in ("pass", "skipped")}
    words = f"suspect: {', '.join(sorted(doubted)) or 'no run'}; off: {', '.join(sorted(pair))}"
    if off:
        return Verdict("unsure" if doubted == pair else "wrong", "", True, False, words)
    return Verdict("right" if not doubted else "wrong", "", False, False, words)
