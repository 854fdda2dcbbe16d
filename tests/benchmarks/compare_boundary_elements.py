"""Contact area and mean separation against exact numerics: boundary elements on random surfaces.

Run with ``PYTHONPATH=. python tests/benchmarks/compare_boundary_elements.py [points] [seeds]``;
it takes one to two minutes. The numerics are the ContactMechanics package's (Polonsky and Keer's
conjugate gradients on a periodic elastic half-space), installed with tribolab's extra ``test`` or
by ``pip install ContactMechanics``.

A rigid random surface, 512 x 512 points, with a roll-off at 8 times the lowest wavenumber and no
waves shorter than 8 points, is pressed against the half-space. The theory gets the spectrum that
the surface was drawn from, and nothing else: no parameter of it is chosen here.

Pixels at the rim of a contact patch count whole in the numerics although part of each is out of
contact. The area is corrected for that as in Yastrebov, Anciaux and Molinari, J. Mech. Phys. Solids
107, 469 (2017), doi:10.1016/j.jmps.2017.07.016: the true area is smaller by
(pi - 1 + ln 2)/24 times the discrete perimeter times the pitch. Both areas are printed.

What differs, and why. The theory's contact area is low, by some 15 to 40 %: its boundary condition,
no stress at vanishing pressure, is exact in complete contact only, and contact at the tops of
asperities has more area than a diffusing stress leaves. At small load the area is kappa p/(E* xi)
with kappa = sqrt(8/pi) = 1.60 in the theory, and 2 to 2.3 in numerics. The separation, an integral
over the elastic energy that gamma = 0.45 corrects for just that, agrees within some 10 % until the
contact is nearly complete, where u is small beside h_rms and the single surface's longest waves,
of which there are few, decide it.
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np

from tribolab.contact.persson import contact_area_ratio, mean_separation
from tribolab.surface.self_affine import SelfAffine, rms_roughness, rms_slope, tabulate
from tribolab.surface.synthesis import synthesise_map

PITCH, MODULUS = 1e-6, 2e6  # [m], E* [Pa]: the contact scales with both
REDUCED_PRESSURES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3)  # p / (E* xi)
RIM = (np.pi - 1 + np.log(2)) / 24


def rough_surface(points: int, slope: float = 0.1) -> SelfAffine:
    """Spectrum of the surface: H = 0.8, roll-off at 8 q0, no wave shorter than 8 points."""
    low = 2 * np.pi / (points * PITCH)
    one = SelfAffine(0.8, rolloff=8 * low, plateau=1.0, low=low, high=np.pi / (4 * PITCH))
    plateau = (slope / rms_slope(one)) ** 2
    return SelfAffine(0.8, rolloff=one.rolloff, plateau=plateau, low=low, high=one.high)


def rim_correction(contact: np.ndarray) -> float:
    """Share of the area by which the pixels of a contact reach beyond it."""
    perimeter = sum((contact != np.roll(contact, 1, axis)).sum() for axis in (0, 1))
    return float(RIM * perimeter / contact.size)


def compare(points: int, seed: int) -> list[tuple[float, ...]]:
    """Press one surface, print each pressure's line, return the ratios theory / numerics."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        from ContactMechanics import PeriodicFFTElasticHalfSpace, make_system
        from SurfaceTopography import Topography

    spectrum = rough_surface(points)
    height = synthesise_map(spectrum, points=points, pitch=PITCH, rng=seed).height.values
    psd, xi, rms = tabulate(spectrum), rms_slope(spectrum), rms_roughness(spectrum)
    size = (points * PITCH,) * 2
    system = make_system(
        substrate=PeriodicFFTElasticHalfSpace((points, points), MODULUS, size),
        surface=Topography(height, size, periodic=True),
    )
    print(f"seed {seed}: h_rms drawn / spectrum {height.std() / rms:.3f}")
    print("  p/(E* xi)   A/A0 pixels  corrected   ours  ratio    u/h_rms   ours  ratio  steps   s")
    rows, start = [], None
    for reduced in REDUCED_PRESSURES:
        began = time.perf_counter()
        pressure = reduced * MODULUS * xi
        solved = system.minimize_proxy(
            external_force=pressure * size[0] * size[1], initial_displacements=start, maxiter=5000
        )
        if not solved.success:
            raise SystemExit(f"the boundary elements did not converge: {solved.message}")
        start = solved.x
        touching = np.asarray(solved.jac) > 0
        pixels = float(touching.mean())
        exact = pixels - rim_correction(touching)
        gap = float((solved.x - height - solved.offset).mean())
        area = contact_area_ratio(pressure, psd, MODULUS)
        separation = mean_separation(pressure, psd, MODULUS)
        rows.append((area / pixels, area / exact, separation / gap))
        print(
            f"  {reduced:9.3g} {pixels:13.4f} {exact:10.4f} {area:6.4f} {area / exact:6.3f}"
            f" {gap / rms:10.4f} {separation / rms:6.4f} {separation / gap:6.3f}"
            f" {solved.nit:6d} {time.perf_counter() - began:3.0f}"
        )
    return rows


def main(points: int = 512, seeds: int = 2) -> None:
    """Compare each seed and print the mean ratios."""
    try:
        import ContactMechanics
    except ModuleNotFoundError:
        raise SystemExit(
            "the ContactMechanics package is not installed: pip install ContactMechanics"
        ) from None
    print(
        f"{points} x {points}, ContactMechanics {ContactMechanics.__version__}, "
        f"xi = {rms_slope(rough_surface(points)):.3g}, ratios are ours / boundary elements"
    )
    mean = np.mean([compare(points, seed) for seed in range(1, seeds + 1)], axis=0)
    print("mean over the seeds\n  p/(E* xi)   A/A0 (pixels)   A/A0 (corrected)   u")
    for reduced, (pixels, exact, gap) in zip(REDUCED_PRESSURES, mean, strict=True):
        print(f"  {reduced:9.3g} {pixels:15.3f} {exact:18.3f} {gap:5.3f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
