"""Speed of the adhesive contact against the textbook relaxation, on one thread, in one run.

Both solve Eqs. (11) and (12) on the same 200 nodes with the same first-passage equation: here as
one bracketed root for each pressure, there by turns between gamma_eff and P, relaxed by one half,
until gamma_eff changes by less than 1e-10. The two are about as fast; the root is there because the
relaxation does not settle where gamma_eff(1) is about to lift off from zero. Run it as::

    OPENBLAS_NUM_THREADS=1 python tests/benchmarks/bench_adhesion.py
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from adhesion_cases import relaxed  # noqa: E402  the path has to be set first
from contact_cases import E_STAR, SURFACES, reference_psd  # noqa: E402

from tribolab.contact.adhesion_balance import rough_interface  # noqa: E402
from tribolab.contact.adhesion_error import adhesion_uncertainty  # noqa: E402
from tribolab.contact.adhesive_contact import adhesion  # noqa: E402


def best(call, repeats=3):
    """Shortest of some runs [s]."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


def main():
    """Print seconds and ratios for each reference surface."""
    curve = np.geomspace(3e3, 5e5, 40)
    loads = np.array([41.7e3, 71.4e3, 92e3, 109e3])
    print("milliseconds; ratio: relaxation / root (the residual is the relaxation's last change)")
    print(
        "surface   root 1  relaxation 1  ratio   root 40  relaxation 40  ratio  (residual)  spread"
    )
    for name in SURFACES:
        psd = reference_psd(name)
        surface = rough_interface(psd, E_STAR, 0.4, 1.0, 200)
        adhesion(1e5, psd, E_STAR, 51e-3)  # imports and caches
        row = []
        for pressure in (loads[:1], curve):
            root = best(lambda p=pressure, psd=psd: adhesion(p, psd, E_STAR, 51e-3))
            old = best(lambda p=pressure, s=surface: relaxed(s, p, 51e-3, "dry"))
            row += [1e3 * root, 1e3 * old, old / root]
        left = relaxed(surface, curve, 51e-3, "dry")[1].max()
        spread = 1e3 * best(lambda psd=psd: adhesion_uncertainty(loads, psd, E_STAR))
        print(
            f"{name:7} {row[0]:8.0f} {row[1]:13.0f} {row[2]:6.1f} {row[3]:9.0f} {row[4]:14.0f} "
            f"{row[5]:6.1f} {left:11.0e} {spread:7.0f}"
        )


if __name__ == "__main__":
    main()
