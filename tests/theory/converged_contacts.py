"""How far friction of random contacts lies off that on many more cells, to 1 m/s.

Where the film would be no thinner than a tenth of the radius the theory ends, and so do the speeds.

Run from the project's root::

    OPENBLAS_NUM_THREADS=1 PYTHONPATH=.:tests python tests/theory/converged_contacts.py [16 [1]]

with the number of contacts and the seed. It exits with 1 if one of them is off by more than 0.3 %.
"""

from __future__ import annotations

import sys

import numpy as np
from contact_cases import random_contacts

from tribolab.contact.geometry import LineContact
from tribolab.core.errors import AnalysisError
from tribolab.lubrication.domain import film_estimate

SPEEDS = np.geomspace(1e-9, 1.0, 19)
FINE, WANTED = 420, 0.3  # cells, percent
RADIUS = 0.07  # m, of all contacts
THICK = 0.1  # films over the radius, from where on the gap is no parabola


def main(cases: int = 16, seed: int = 1) -> int:
    """Print the largest error of each contact; return the exit code."""
    worst = []
    for case in random_contacts(cases, seed):
        body = LineContact(RADIUS, 0.1, case.modulus, 0.5)
        films = [film_estimate(body, case.viscosity, case.load, float(v)) for v in SPEEDS]
        thin = SPEEDS[np.array(films) < THICK * RADIUS]
        try:
            ours, fine = (
                case.curve(thin, **more).friction_coefficient.values
                for more in ({}, {"cells": FINE})
            )
        except AnalysisError as error:
            print(f"  refused: {case}\n    {error}")
            continue
        off = 100 * (ours / fine - 1)
        place = int(np.argmax(np.abs(off)))
        worst.append(abs(off[place]))
        print(
            f"  {off[place]:+.3f} % at {thin[place]:.0e} of {thin[-1]:.0e} m/s: {case}", flush=True
        )
    print(f"{len(worst)} contacts, seed {seed}: largest {max(worst):.3f} %, "
          f"median {np.median(worst):.3f} % ({WANTED:g} % is wanted)")  # fmt: skip
    return int(max(worst) > WANTED)


if __name__ == "__main__":
    sys.exit(main(*(int(word) for word in sys.argv[1:])))
