"""Share of random contacts whose Stribeck curve converges, and what is said of the others.

Run from the project's root::

    PYTHONPATH=tests:. python tests/theory/random_contacts.py [cases [seed]]
"""

from __future__ import annotations

import sys
import time
from collections import Counter

import numpy as np
from contact_cases import RandomContact, random_contacts

from tribolab.core.errors import AnalysisError


def fate(case: RandomContact) -> tuple[str, str]:
    """Whether the curve is solved and proven, refused in words, or neither."""
    try:
        curve = case.curve()
    except AnalysisError as error:
        return "refused", str(error)
    proof = max(
        float(curve.residual.max()),
        float(np.abs(curve.load_balance).max()),
        float(curve.flux_variation.max()) / 100,
    )
    film = curve.minimum_separation.values
    rising = bool(np.all(np.diff(film) > -1e-9 * film[1:]))
    if proof < 1e-8 and rising:
        return "converged", ""
    return "bad", f"proof {proof:.0e}, film {'rises' if rising else 'does not rise'} with speed"


def main(cases: int = 200, seed: int = 2026) -> None:
    """Print the share that converges and every case that does not."""
    fates, start = Counter(), time.perf_counter()
    for case in random_contacts(cases, seed):
        outcome, words = fate(case)
        fates[outcome] += 1
        if words:
            print(f"  {outcome}: {case}\n    {words}", flush=True)
    took = time.perf_counter() - start
    print(f"{cases} random contacts, seed {seed}, {took:.0f} s:")
    print(f"  {fates['converged'] / cases:.1%} converge at all of their 33 speeds, with the proof")
    print(f"  {fates['refused']} are refused with a reason, {fates['bad']} are bad")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
