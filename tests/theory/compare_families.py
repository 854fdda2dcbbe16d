"""How often a comparison of two campaigns errs where nothing differs, over a thousand pairs.

Run with ``PYTHONPATH=$PWD:$PWD/tests python tests/theory/compare_families.py``. Runs differ by
what all their points share and by what each point has of its own. The share of families with any
point called different is wanted between 3 and 6 %; without any adjustment it is printed beside.
Exits with 1 where that is missed.
"""

import argparse
import sys

import numpy as np

from tribolab.metrology.differences import differences_of_groups

# conditions, runs in each group, speeds
DESIGNS = [(1, 5, 9), (1, 6, 13), (4, 6, 6), (2, 8, 9), (4, 5, 6), (1, 4, 9), (1, 3, 9), (4, 3, 6)]


def families(conditions, runs, speeds, pairs, rng):
    wrong, alone, held = 0, 0, 0
    scale = np.linspace(1, 3, speeds)
    for _ in range(pairs):
        groups = [
            tuple(
                scale * (rng.normal(0, 0.7, (runs, 1)) + rng.normal(0, 0.7, (runs, speeds)))
                for _ in "ab"
            )
            for _ in range(conditions)
        ]
        compared = differences_of_groups(groups)
        wrong += (compared.adjusted_p_value <= 0.05).any()
        alone += (compared.p_value <= 0.05).any()
        held += ((compared.low <= 0) & (compared.high >= 0)).all()
    return compared.methods[0], wrong / pairs, alone / pairs, held / pairs


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=2026)
    chosen = parser.parse_args()
    rng = np.random.default_rng(chosen.seed)
    spread = 2 * np.sqrt(0.05 * 0.95 / chosen.pairs)
    fine = True
    for design in DESIGNS:
        method, wrong, alone, held = families(*design, chosen.pairs, rng)
        good = 0.03 <= wrong <= 0.06 and held >= 0.95 - spread
        fine &= good
        print(
            f"{design[0]} conditions, {design[1]} and {design[1]} runs, {design[2]} speeds: "
            f"{method}, "
            f"{wrong:.1%} err ({alone:.0%} unadjusted), intervals hold all in {held:.1%}"
            f"{'' if good else '  MISSED'}"
        )
    print("as wanted" if fine else "missed")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
