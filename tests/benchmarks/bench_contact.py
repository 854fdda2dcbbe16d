"""Times of the contact room, as ratios against named alternatives measured in the same run.

Run from the project's root::

    OPENBLAS_NUM_THREADS=1 PYTHONPATH=tests python tests/benchmarks/bench_contact.py
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from contact_cases import CONTACT, E_STAR, SURFACES, reference_psd
from scipy.integrate import quad
from scipy.special import erf

from tribolab.contact.gap import gap_distribution
from tribolab.contact.line import rough_line_contact
from tribolab.contact.persson import contact_area_ratio, mean_separation
from tribolab.contact.separation import separation_table
from tribolab.rubber.friction import viscoelastic_friction
from tribolab.rubber.modulus import PDMS_STAND_IN
from tribolab.surface.moments import cumulative_at, spectrum_arrays, spectrum_at

PRESSURES = np.geomspace(1e3, 1e5, 50)
SPEEDS = np.geomspace(1e-6, 1e-2, 13)


def best(call: Callable[[], object], repeats: int = 7) -> float:
    """Return the shortest of several times [s], after one call that warms up."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def area_by_quad(q: np.ndarray, c: np.ndarray) -> np.ndarray:
    """A/A0 the plain way: adaptive quadrature of Eq. (7) in ln q, once for all pressures."""

    def integrand(log_q: float) -> float:
        return np.exp(4 * log_q) * float(spectrum_at(np.exp(log_q), q, c))

    edges = np.log(q)
    slope = sum(
        quad(integrand, a, b, epsrel=1e-8)[0] for a, b in zip(edges[:-1], edges[1:], strict=True)
    )
    return erf(PRESSURES / (E_STAR * np.sqrt(np.pi * slope)))


def separation_by_quad(pressure: float, q: np.ndarray, c: np.ndarray) -> float:
    """u(p) the plain way: adaptive double quadrature, over wavenumber and pressure."""

    def outer(log_q: float) -> float:
        at = np.exp(log_q)
        w = 1 / (E_STAR * np.sqrt(np.pi * float(cumulative_at(at, q, c, 3))))
        start, stop = np.log(pressure * w), np.log(7.0)
        if start >= stop:
            return 0.0
        inner = quad(
            lambda t: (0.45 + 1.65 * erf(np.exp(t)) ** 2) * np.exp(-np.exp(2 * t)),
            start,
            stop,
            epsrel=1e-7,
        )[0]
        return np.sqrt(np.pi) * at**3 * float(spectrum_at(at, q, c)) * w * E_STAR * inner

    edges = np.log([q[0] * (1 + 1e-9), 1.1 * q[0], 10 * q[0], *q[1:]])
    return sum(
        quad(outer, a, b, epsrel=1e-6)[0] for a, b in zip(edges[:-1], edges[1:], strict=True)
    )


def row(what: str, seconds: float, against: str = "", slow: float = np.nan) -> None:
    """Print one line; the ratio is the alternative's time over ours."""
    tail = f"  {slow / seconds:7.0f} x faster than {against}" if against else ""
    print(f"  {what:52} {1e3 * seconds:8.3f} ms{tail}")


def measure(name: str) -> None:
    """Print the times of one surface, on 1201 wavenumbers; the alternatives get three."""
    psd = reference_psd(name, 1201)
    q, c = spectrum_arrays(reference_psd(name))
    print(name)
    row(
        "A/A0, 50 pressures",
        best(lambda: contact_area_ratio(PRESSURES, psd, E_STAR), 50),
        "one adaptive quadrature of Eq. (7)",
        best(lambda: area_by_quad(q, c)),
    )
    table = separation_table(psd, E_STAR)
    at = np.geomspace(1e2, 1e5, 5)
    start = time.perf_counter()
    exact = np.array([separation_by_quad(p, q, c) for p in at])
    one = (time.perf_counter() - start) / at.size
    entries = table.table_pressure.size
    row(
        f"table of u(p), {entries} pressures",
        best(lambda: separation_table(psd, E_STAR)),
        f"{entries} adaptive double quadratures",
        one * entries,
    )
    print(
        f"    differs from that quadrature by {np.abs(table.separation(at) / exact - 1).max():.0e}"
    )
    pressure = np.geomspace(1.0, 1e5, 400)
    u = table.separation(pressure)
    row(
        "p(u) and dp/du, 400 separations",
        best(lambda: table.pressure_and_slope(u), 50),
        "u(p) without a table",
        best(lambda: mean_separation(pressure, psd, E_STAR)),
    )
    for variant in ("flow", "plain"):
        row(
            f"P(u), 50 pressures, {variant}",
            best(lambda v=variant: gap_distribution(PRESSURES, psd, E_STAR, v), 3),
        )
    row(
        "dry line contact, 401 cells, its table included",
        best(lambda: rough_line_contact(310.0, CONTACT, psd), 5),
    )
    row(
        "hysteretic friction, 13 speeds",
        best(lambda: viscoelastic_friction(SPEEDS, 4.17e4, psd, PDMS_STAND_IN), 5),
    )


if __name__ == "__main__":
    for surface in SURFACES:
        measure(surface)
